#include "sweep/sweep_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "base/nearest_name.h"
#include "settings/settings.h"
#include "sweep/sweep_inputs.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;

}  // namespace

SweepFile::SweepFile(const fs::path& file) : file_(file), json_(Json::parse(toml_as_json(file))) {
  require_known(json_, "", {"sweep", "set", "vary", "run"});
  if (json_.contains("sweep"))
    require_known(table("sweep"), "sweep.",
                  {"command", "method", "runs", "seed", "quality", "job", "models", "keep"});
}

void SweepFile::refuse(const std::string& what) const {
  throw InputError(fmt::format("{}: {}", file_.string(), what));
}

void SweepFile::require_few_enough(double runs) const {
  if (runs > double(kMostRuns))
    refuse(fmt::format("that would be {:.0f} runs; a sweep has at most {}", runs, kMostRuns));
}

const SweepFile::Json& SweepFile::table(const std::string& name) const {
  static const Json empty = Json::object();
  if (!json_.contains(name)) return empty;
  if (!json_[name].is_object()) refuse(fmt::format("{} has to be a table: [{}]", name, name));
  return json_[name];
}

SweepFile::Entries SweepFile::entries(const Json& table) const {
  Entries entries;
  flatten(table, "", entries);
  return entries;
}

void SweepFile::flatten(const Json& table, const std::string& prefix, Entries& entries) const {
  for (const auto& [key, value] : table.items()) {
    const std::string name = prefix + key;
    if (value.is_object() && !value.contains("from")) {
      flatten(value, name + ".", entries);
      continue;
    }
    if (has_entry(entries, name))
      refuse(fmt::format("{} stands twice in one table: leave out one of them", name));
    entries.emplace_back(name, value);
  }
}

const SweepFile::Json& SweepFile::runs() const {
  static const Json empty = Json::array();
  if (!json_.contains("run")) return empty;
  const Json& runs = json_["run"];
  if (!runs.is_array() || !std::ranges::all_of(runs, [](const Json& r) { return r.is_object(); }))
    refuse("write each run as a table of its own: [[run]]");
  return runs;
}

std::string SweepFile::choice(const char* key, const std::vector<std::string>& choices) const {
  const Json& sweep = table("sweep");
  if (!sweep.contains(key)) return choices.front();
  std::string value = sweep[key].is_string() ? sweep[key].get<std::string>() : "";
  if (std::ranges::find(choices, value) != choices.end()) return value;
  std::string list;
  for (const std::string& c : choices) list += (list.empty() ? "" : ", ") + c;
  refuse(fmt::format("sweep.{}: must be one of {}, not {}{}", key, list, sweep[key].dump(),
                     did_you_mean(value, choices)));
}

std::uint64_t SweepFile::whole(const char* key, std::uint64_t otherwise, std::uint64_t least,
                               std::uint64_t most) const {
  const Json& sweep = table("sweep");
  if (!sweep.contains(key)) return otherwise;
  if (!sweep[key].is_number_integer() || sweep[key].get<std::int64_t>() < std::int64_t(least) ||
      sweep[key].get<std::uint64_t>() > most)
    refuse(fmt::format("sweep.{}: must be a whole number from {} to {}, not {}", key, least, most,
                       sweep[key].dump()));
  return sweep[key].get<std::uint64_t>();
}

std::string SweepFile::file_at(const Json& value, const std::string& where,
                               const fs::path& folder) const {
  if (!value.is_string() || value.get<std::string>().empty())
    refuse(where + ": must be a file name");
  const fs::path path = file_.parent_path() / value.get<std::string>();
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    refuse(fmt::format("{}: there is no file {}", where, path.string()));
  return from_folder(path, folder);
}

std::string SweepFile::text(const Json& value, const std::string& name,
                            const fs::path& folder) const {
  if (value.is_string()) {
    const auto given = value.get<std::string>();
    return names_file(name, given) ? file_at(value, name, folder) : given;
  }
  if (value.is_boolean())
    if (const auto as_text = switch_text(name, value.get<bool>())) return *as_text;
  if (value.is_null()) refuse(fmt::format("{}: inf and nan are no values of a parameter", name));
  if (value.is_number_integer()) return fmt::format("{}", value.get<std::int64_t>());
  if (value.is_number()) return fmt::format("{}", value.get<double>());
  if (value.is_array() && !value.empty() &&
      std::ranges::all_of(value, [](const Json& v) { return v.is_number(); })) {
    std::string list;
    for (const Json& v : value) list += (list.empty() ? "" : ",") + text(v, name, folder);
    return list;
  }
  refuse(fmt::format("{}: {} is no value of a parameter", name, value.dump()));
}

void SweepFile::require_known(const Json& object, const std::string& prefix,
                              const std::vector<std::string>& names) const {
  for (const auto& [key, value] : object.items())
    if (std::ranges::find(names, key) == names.end())
      refuse(fmt::format("unknown '{}{}'{}", prefix, key, did_you_mean(key, names)));
}

bool has_entry(const SweepFile::Entries& entries, const std::string& name) {
  return std::ranges::any_of(entries, [&](const auto& entry) { return entry.first == name; });
}

}  // namespace hydrodip
