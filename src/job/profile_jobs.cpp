#include "job/profile_jobs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/folder_lock.h"
#include "base/json_text.h"
#include "base/made_folder.h"
#include "base/nearest_name.h"
#include "base/output_folder.h"
#include "base/shell_word.h"
#include "settings/params.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string text_of(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = read_file(file);
  return {bytes.begin(), bytes.end()};
}

fs::path known_profile(const fs::path& folder, const std::string& name) {
  fs::path file = profile_path(folder, name);
  std::error_code ignored;
  if (fs::exists(file, ignored)) return file;
  const std::vector<std::string> names = profile_names(folder);
  const std::string hint = did_you_mean(name, names);
  throw InputError(fmt::format(
      "there is no profile '{}' in {}{}", name, folder.string(),
      hint.empty() ? "; 'hydrodip profile save " + name + " --set NAME=VALUE' makes it" : hint));
}

// "film (4 values), cost (2)": the tables that it sets.
std::string summary(const std::vector<std::string>& names) {
  std::vector<std::pair<std::string, int>> tables;
  for (const std::string& name : names) {
    const std::string table = name.substr(0, name.find('.'));
    const auto known =
        std::ranges::find_if(tables, [&](const auto& entry) { return entry.first == table; });
    if (known == tables.end())
      tables.emplace_back(table, 1);
    else
      ++known->second;
  }
  std::vector<std::string> parts;
  parts.reserve(tables.size());
  for (const auto& [table, count] : tables)
    parts.push_back(count == 1 ? table : fmt::format("{} ({} values)", table, count));
  return parts.empty() ? "sets nothing" : fmt::format("{}", fmt::join(parts, ", "));
}

// The folder while a profile is read, changed and written: what another process changes meanwhile
// would be lost. Who writes into it says what is wrong with it.
class ProfilesInHand {
 public:
  explicit ProfilesInHand(const fs::path& folder)
      : made_(folder), lock_(FolderLock::waited_for(folder)) {}

 private:
  MadeFolder made_;
  FolderLock lock_;
};

JobResult written(const char* command, const fs::path& file, const std::string& what,
                  const std::string& text) {
  OutputFolder output(file.parent_path());
  const std::string name = file.filename().string();
  write_file(output.path(name), text);
  output.commit();
  JobResult result;
  result.folder = file.parent_path();
  result.files = {name};
  result.text = fmt::format("{} {}\nuse it with --profile {}\n", what, file.string(),
                            shell_word(file.stem().string()));
  result.json = json_answer(
      command, {{"name", file.stem().string()}, {"file", file.string()}, {"text", text}});
  return result;
}

// --profile takes "shop.toml" for a file.
void require_bare_name(const std::string& name) {
  if (fs::path(name).extension() == ".toml")
    throw InputError(fmt::format("a profile goes by a name without .toml: '{}'",
                                 fs::path(name).stem().string()));
}

// What is set now and is not there; a file that goes later is the job's to say.
void require_files(const ProfileEdit& edit) {
  JobConfig config;
  apply_sources(config, edit.add);
  for (const auto* settings : {&edit.add.options, &edit.add.sets})
    for (const Setting& setting : *settings) {
      const Parameter& parameter = find_parameter(setting.name, setting.origin);
      if (parameter.type != ParameterType::kPath) continue;
      const fs::path file = std::get<std::string>(parameter.get(config));
      std::error_code ignored;
      if (!file.empty() && !fs::exists(file, ignored))
        throw InputError(fmt::format("{}: there is no file {}", setting.origin, file.string()));
    }
}

}  // namespace

JobResult list_profiles(const fs::path& folder) {
  JobResult result;
  Json list = Json::array();
  const std::vector<std::string> names = profile_names(folder);
  for (const std::string& name : names) {
    const fs::path file = profile_path(folder, name);
    Json entry = {{"name", name}, {"file", file.string()}};
    std::string what;
    try {
      const std::vector<std::string> sets = names_in_profile(file);
      what = summary(sets);
      entry["sets"] = sets;
    } catch (const InputError& error) {
      what = fmt::format("cannot be used: {}", error.what());
      entry["error"] = error.what();
    }
    list.push_back(entry);
    result.text += fmt::format("{:<20} {}\n", name, what);
  }
  if (names.empty())
    result.text = fmt::format(
        "no profiles in {} yet; 'hydrodip profile save shop --film a3 --set film.margin_mm=12' "
        "makes one\n",
        folder.string());
  result.json = json_answer("profile list", {{"folder", folder.string()}, {"profiles", list}});
  return result;
}

JobResult show_profile(const fs::path& folder, const std::string& name) {
  const fs::path file = known_profile(folder, name);
  names_in_profile(file);  // nobody is to copy one that cannot be used
  JobResult result;
  result.text = text_of(file);
  result.json =
      json_answer("profile show", {{"name", name}, {"file", file.string()}, {"text", result.text}});
  return result;
}

JobResult save_profile(const fs::path& folder, const std::string& name, const ProfileEdit& edit) {
  require_bare_name(name);
  const fs::path file = profile_path(folder, name);
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {  // refused before a folder is made
    if (!edit.remove.empty()) known_profile(folder, name);
    edited_profile({}, edit);
    require_files(edit);
  }
  const ProfilesInHand in_hand(folder);
  const bool exists = fs::exists(file, ignored);
  const std::string text = edited_profile(exists ? file : fs::path(), edit);
  require_files(edit);
  return written("profile save", file, exists ? "changed" : "made", text);
}

JobResult import_profile(const fs::path& folder, const fs::path& file, const std::string& name) {
  require_bare_name(name);
  const fs::path to = profile_path(folder, name.empty() ? file.stem().string() : name);
  const std::string text = edited_profile(file, {});
  const ProfilesInHand in_hand(folder);
  std::error_code ignored;
  if (fs::exists(to, ignored))
    throw InputError(fmt::format(
        "there is a profile '{}' already; import it under another name: 'hydrodip profile import "
        "{} NAME'",
        to.stem().string(), file.string()));
  return written("profile import", to, "imported it to", text);
}

}  // namespace hydrodip
