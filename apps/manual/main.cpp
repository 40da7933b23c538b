// hydrodip_manual FOLDER RELEASE DATE: everything that is said about the program by the program's
// own tables, for the package and the documentation's site.
#include <exception>
#include <filesystem>
#include <iostream>

#include "base/file.h"
#include "completion.h"
#include "describe.h"
#include "man_pages.h"
#include "pages.h"
#include "schemas.h"

namespace hydrodip {
namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  write_file(file, text);
}

void write_all(const std::filesystem::path& folder, const std::string& release,
               const std::string& date) {
  const std::vector<CommandText> commands = describe_commands();
  for (const ManPage& page : man_pages(commands, release, date))
    write(folder / ("man/man" + page.file.substr(page.file.rfind('.') + 1)) / page.file, page.text);
  write(folder / "bash-completion/completions/hydrodip", bash_completion(commands));
  write(folder / "zsh/vendor-completions/_hydrodip", zsh_completion(commands));
  write(folder / "fish/vendor_completions.d/hydrodip.fish", fish_completion(commands));
  write(folder / "hydrodip/schemas/job.schema.json", job_schema());
  write(folder / "hydrodip/schemas/parameters.schema.json", parameters_schema());
  write(folder / "pages/commands.md", commands_page(commands));
  write(folder / "pages/parameters.md", parameters_reference());
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: hydrodip_manual FOLDER RELEASE DATE\n";
    return 2;
  }
  try {
    hydrodip::write_all(argv[1], argv[2], argv[3]);
  } catch (const std::exception& error) {
    std::cerr << "hydrodip_manual: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
