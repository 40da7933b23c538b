#include "settings/profiles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "base/nearest_name.h"
#include "settings/job_file.h"
#include "settings/params.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".toml";

bool is_plain(const std::string& name) {
  return !name.empty() && name.front() != '.' && std::ranges::all_of(name, [](const char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
  });
}

void require_reusable(const Setting& setting) {
  const bool is_jobs_own = setting.name.find('[') != std::string::npos ||
                           setting.name.starts_with("art.") || setting.name == "object.file" ||
                           setting.name == "path";
  if (is_jobs_own)
    throw InputError(
        fmt::format("{}: {} belongs to one job, not to a profile for many; keep it in the job's "
                    "file",
                    setting.origin, setting.name));
}

std::vector<std::string> names_of(const std::vector<Setting>& settings) {
  std::vector<std::string> names;
  for (const Setting& setting : settings) {
    require_reusable(setting);
    names.push_back(find_parameter(setting.name, setting.origin).name);
  }
  return names;
}

}  // namespace

fs::path profile_path(const fs::path& folder, const std::string& name) {
  if (!is_plain(name))
    throw InputError(fmt::format(
        "'{}' cannot be a profile's name: use letters, digits, '-', '_' and '.'", name));
  return folder / (name + kExtension);
}

std::vector<std::string> profile_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path file = entry->path();
    if (file.extension() == kExtension && is_plain(file.stem().string()))
      names.push_back(file.stem().string());
  }
  std::ranges::sort(names);
  return names;
}

fs::path find_profile(const std::string& name_or_file, const fs::path& folder) {
  std::error_code ignored;
  const bool is_path = name_or_file.find('/') != std::string::npos ||
                       fs::path(name_or_file).extension() == kExtension;
  if (is_path || !is_plain(name_or_file)) return name_or_file;
  fs::path own = profile_path(folder, name_or_file);
  if (fs::exists(own, ignored)) return own;
  if (fs::is_regular_file(name_or_file, ignored)) return name_or_file;
  const std::vector<std::string> names = profile_names(folder);
  const std::string hint = did_you_mean(name_or_file, names);
  throw InputError(fmt::format(
      "--profile {}: there is neither a profile of that name in {} nor such a file{}", name_or_file,
      folder.string(), hint.empty() ? "; 'hydrodip profile list' shows what there is" : hint));
}

std::string edited_profile(const fs::path& before, const ProfileEdit& edit) {
  JobConfig config;
  std::vector<std::string> names;
  const auto add = [&](const std::vector<Setting>& settings) {
    const std::vector<std::string> more = names_of(settings);
    apply_settings(config, settings);
    names.insert(names.end(), more.begin(), more.end());
  };
  if (!before.empty()) add(read_settings(before));
  add(edit.add.quality);
  for (const auto* files : {&edit.add.profiles, &edit.add.configs})
    for (const fs::path& file : *files) add(read_settings(file));
  add(edit.add.options);
  add(edit.add.sets);
  for (const std::string& name : edit.remove)
    std::erase(names, find_parameter(name, "--unset").name);
  return "# A profile for hydrodip: --profile NAME, or this file\n" + settings_file(config, names);
}

std::vector<std::string> names_in_profile(const fs::path& file) {
  const std::vector<Setting> settings = read_settings(file);
  std::vector<std::string> names = names_of(settings);
  JobConfig checked;
  apply_settings(checked, settings);
  return names;
}

}  // namespace hydrodip
