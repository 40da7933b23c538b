#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "base/shell_word.h"
#include "job/jobs.h"
#include "samples/samples.h"

namespace hydrodip {

JobResult sample_job(const std::string& name, const std::filesystem::path& folder,
                     const RunContext& context, EarlierResult earlier) {
  const RunScope scope(context);
  const Object sample = make_sample(name);  // refuses unknown names before a folder is made
  OutputFolder output(folder, earlier);
  const std::string model = name + ".obj";
  JobResult result;
  result.folder = folder;
  result.files = write_sample(name, sample, output.path(model).parent_path());
  for (const std::string& file : result.files)
    if (file != model) output.path(file);
  output.announce(result.files, {});
  context.check_cancelled();
  output.commit();

  result.text = output.told_replaced();
  for (const std::string& file : result.files)
    result.text += fmt::format("wrote {}\n", (folder / file).string());
  result.text += fmt::format("try: hydrodip print {}\n", shell_word((folder / model).string()));
  result.json = json_answer("sample", {{"folder", folder.string()}, {"files", result.files}});
  return result;
}

JobResult list_samples() {
  JobResult result;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SampleInfo& sample : samples()) {
    result.text += fmt::format("{:<10} {}\n", sample.name, sample.description);
    list.push_back({{"name", sample.name}, {"description", sample.description}});
  }
  result.json = json_answer("sample", {{"samples", list}});
  return result;
}

}  // namespace hydrodip
