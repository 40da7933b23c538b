#include "sweep/sweep_plan.h"
#include "settings/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "base/error.h"
#include "base/file.h"
#include "base/json_nesting.h"
#include "base/json_text.h"
#include "base/nearest_name.h"
#include "settings/params.h"
#include "sweep/sweep_inputs.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Values = std::vector<std::pair<std::string, std::string>>;

constexpr std::pair<const char*, SweepCommand> kCommands[] = {{"simulate", SweepCommand::kSimulate},
                                                              {"print", SweepCommand::kPrint},
                                                              {"orient", SweepCommand::kOrient}};

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const auto& [name, command] : kCommands) names.emplace_back(name);
  return names;
}

SweepCommand command_of(const std::string& wanted) {
  for (const auto& [name, command] : kCommands)
    if (name == wanted) return command;
  throw InputError("a sweep knows no command '" + wanted + "'; plan it again");
}

std::string name_of(SweepCommand wanted) {
  for (const auto& [name, command] : kCommands)
    if (command == wanted) return name;
  return "";
}

constexpr int kSchemaVersion = 2;
constexpr std::size_t kMostRuns = 1000000;
constexpr const char* kModel = "model";
constexpr const char* kModelFile = "object.file";

// The file's tables, with words for what is wrong in them.
class SweepFile {
 public:
  explicit SweepFile(const fs::path& file) : file_(file), json_(Json::parse(toml_as_json(file))) {
    require_known(json_, "", {"sweep", "set", "vary", "run"});
    if (json_.contains("sweep"))
      require_known(table("sweep"), "sweep.",
                    {"command", "method", "runs", "seed", "quality", "job", "models", "keep"});
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", file_.string(), what));
  }

  bool has(const std::string& name) const { return json_.contains(name); }
  bool says(const char* key) const { return table("sweep").contains(key); }

  const Json& table(const std::string& name) const {
    static const Json empty = Json::object();
    if (!json_.contains(name)) return empty;
    if (!json_[name].is_object()) refuse(fmt::format("{} has to be a table: [{}]", name, name));
    return json_[name];
  }

  const Json& runs() const {
    static const Json empty = Json::array();
    if (!json_.contains("run")) return empty;
    const Json& runs = json_["run"];
    if (!runs.is_array() || !std::ranges::all_of(runs, [](const Json& r) { return r.is_object(); }))
      refuse("write each run as a table of its own: [[run]]");
    return runs;
  }

  std::string choice(const char* key, const std::vector<std::string>& choices) const {
    const Json& sweep = table("sweep");
    if (!sweep.contains(key)) return choices.front();
    std::string value = sweep[key].is_string() ? sweep[key].get<std::string>() : "";
    if (std::ranges::find(choices, value) != choices.end()) return value;
    std::string list;
    for (const std::string& c : choices) list += (list.empty() ? "" : ", ") + c;
    refuse(fmt::format("sweep.{}: must be one of {}, not {}{}", key, list, sweep[key].dump(),
                       did_you_mean(value, choices)));
  }

  std::uint64_t whole(const char* key, std::uint64_t otherwise, std::uint64_t least,
                      std::uint64_t most) const {
    const Json& sweep = table("sweep");
    if (!sweep.contains(key)) return otherwise;
    if (!sweep[key].is_number_integer() || sweep[key].get<std::int64_t>() < std::int64_t(least) ||
        sweep[key].get<std::uint64_t>() > most)
      refuse(fmt::format("sweep.{}: must be a whole number from {} to {}, not {}", key, least, most,
                         sweep[key].dump()));
    return sweep[key].get<std::uint64_t>();
  }

  // Files that the table names, as they are to be found from `folder`.
  std::string file_at(const Json& value, const std::string& where, const fs::path& folder) const {
    if (!value.is_string() || value.get<std::string>().empty())
      refuse(where + ": must be a file name");
    const fs::path path = file_.parent_path() / value.get<std::string>();
    std::error_code error;
    if (!fs::is_regular_file(path, error))
      refuse(fmt::format("{}: there is no file {}", where, path.string()));
    return from_folder(path, folder);
  }

  // As --set takes it, but for files, which are named as file_at() does.
  std::string text(const Json& value, const std::string& name, const fs::path& folder) const {
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

 private:
  void require_known(const Json& object, const std::string& prefix,
                     const std::vector<std::string>& names) const {
    for (const auto& [key, value] : object.items())
      if (std::ranges::find(names, key) == names.end())
        refuse(fmt::format("unknown '{}{}'{}", prefix, key, did_you_mean(key, names)));
  }

  fs::path file_;
  Json json_;
};

using Entries = std::vector<std::pair<std::string, Json>>;

bool has_entry(const Entries& entries, const std::string& name) {
  return std::ranges::any_of(entries, [&](const auto& entry) { return entry.first == name; });
}

void flatten(const SweepFile& file, const Json& table, const std::string& prefix,
             Entries& entries) {
  for (const auto& [key, value] : table.items()) {
    const std::string name = prefix + key;
    if (value.is_object() && !value.contains("from")) {
      flatten(file, value, name + ".", entries);
      continue;
    }
    if (has_entry(entries, name))
      file.refuse(fmt::format("{} stands twice in one table: leave out one of them", name));
    entries.emplace_back(name, value);
  }
}

// TOML's [vary.material] z_stretch = ... and "material.z_stretch" = ... are the same.
Entries flat(const SweepFile& file, const Json& table) {
  Entries entries;
  flatten(file, table, "", entries);
  return entries;
}

// Values that a parameter takes: a list, or a range.
struct Axis {
  std::string name;
  std::vector<std::string> list;
  double from = 0, to = 0;
  int count = 0;  // of a range in a grid
  bool log = false, whole = false;

  bool is_range() const { return list.empty(); }

  // part in [0, 1].
  std::string at(double part) const {
    double value = log ? from * std::pow(to / from, part) : from + part * (to - from);
    if (whole) value = std::round(value);
    return fmt::format("{:.12g}", value);
  }
};

// 0: it does not say.
int range_count(const SweepFile& file, const std::string& name, const Json& range) {
  if (!range.contains("count")) return 0;
  const Json& count = range["count"];
  if (!count.is_number_integer() || count.get<std::int64_t>() < 2 ||
      count.get<std::int64_t>() > std::int64_t(kMostRuns))
    file.refuse(
        fmt::format("vary.{}: count must be a whole number from 2 to {}, as a sweep has at "
                    "most so many runs, not {}",
                    name, kMostRuns, count.dump()));
  return int(count.get<std::int64_t>());
}

Axis read_axis(const SweepFile& file, const std::string& name, const Json& value,
               const fs::path& folder) {
  const Parameter& parameter = find_parameter(name, "[vary]");
  Axis axis;
  axis.name = name;
  if (value.is_array() && !value.empty()) {
    for (const Json& item : value) axis.list.push_back(file.text(item, name, folder));
    return axis;
  }
  if (!value.is_object())
    file.refuse(fmt::format(
        "vary.{}: write a list of values, or {{ from = ..., to = ..., count = ... }}", name));
  for (const auto& [key, ignored] : value.items())
    if (key != "from" && key != "to" && key != "count" && key != "log")
      file.refuse(
          fmt::format("vary.{}: unknown '{}'; a range has from, to, count and log", name, key));
  const auto bound = [&](const char* key) {
    if (!value.contains(key) || !value[key].is_number())
      file.refuse(fmt::format("vary.{}: a range needs numbers for from and to", name));
    return value[key].get<double>();
  };
  axis.from = bound("from");
  axis.to = bound("to");
  axis.count = range_count(file, name, value);
  if (value.contains("log")) {
    if (!value["log"].is_boolean())
      file.refuse(
          fmt::format("vary.{}: log must be true or false, not {}", name, value["log"].dump()));
    axis.log = value["log"].get<bool>();
  }
  axis.whole = parameter.type == ParameterType::kInteger;
  if (parameter.type != ParameterType::kNumber && !axis.whole)
    file.refuse(fmt::format("vary.{}: only a number has a range; list its values", name));
  if (axis.log && !(axis.from > 0 && axis.to > 0))
    file.refuse(fmt::format("vary.{}: equal factors need from and to above 0", name));
  return axis;
}

std::vector<Axis> read_axes(const SweepFile& file, const fs::path& folder) {
  const Entries held = flat(file, file.table("set"));
  std::vector<Axis> axes;
  for (const auto& [name, value] : flat(file, file.table("vary"))) {
    if (has_entry(held, name))
      file.refuse(fmt::format(
          "{} stands under [set], which holds for all runs, and under [vary]: leave out one of "
          "them",
          name));
    axes.push_back(read_axis(file, name, value, folder));
  }
  return axes;
}

void require_few_enough(const SweepFile& file, double runs) {
  if (runs > double(kMostRuns))
    file.refuse(fmt::format("that would be {:.0f} runs; a sweep has at most {}", runs, kMostRuns));
}

// Every combination; the last axis changes fastest.
std::vector<Values> grid(const SweepFile& file, std::vector<Axis> axes, const RunContext& context) {
  double runs = 1;
  for (Axis& axis : axes) {
    if (axis.is_range()) {
      if (axis.count < 2)
        file.refuse(fmt::format("vary.{}: say how many values, as in count = 5", axis.name));
      for (int i = 0; i < axis.count; ++i)
        axis.list.push_back(axis.at(double(i) / double(axis.count - 1)));
      axis.list.erase(std::unique(axis.list.begin(), axis.list.end()), axis.list.end());
    }
    runs *= double(axis.list.size());
    require_few_enough(file, runs);
  }
  std::vector<Values> all = {{}};
  for (const Axis& axis : axes) {
    std::vector<Values> longer;
    for (const Values& values : all)
      for (const std::string& value : axis.list) {
        context.check_cancelled();
        longer.push_back(values);
        longer.back().emplace_back(axis.name, value);
      }
    all = std::move(longer);
  }
  return all;
}

// Uniform in [0, 1), the same on every machine.
double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1p-53; }

// Each axis is cut into as many parts as there are runs, and each part is used once.
std::vector<Values> latin(const std::vector<Axis>& axes, std::size_t runs, std::uint64_t seed) {
  std::vector<Values> all(runs);
  std::mt19937_64 random(seed);
  for (const Axis& axis : axes) {
    std::vector<std::size_t> order(runs);
    for (std::size_t i = 0; i < runs; ++i) order[i] = i;
    for (std::size_t i = runs; i > 1; --i)
      std::swap(order[i - 1], order[std::size_t(uniform(random) * double(i))]);
    for (std::size_t i = 0; i < runs; ++i) {
      const double part = (double(order[i]) + uniform(random)) / double(runs);
      const std::string value =
          axis.is_range() ? axis.at(part) : axis.list[std::size_t(part * double(axis.list.size()))];
      all[i].emplace_back(axis.name, value);
    }
  }
  return all;
}

struct Listed {
  std::vector<Values> values;
  std::vector<std::string> models;
};

Listed listed(const SweepFile& file, const fs::path& folder) {
  Listed list;
  for (const Json& run : file.runs()) {
    list.values.emplace_back();
    list.models.emplace_back();
    for (const auto& [name, value] : flat(file, run)) {
      if (name == kModel)
        list.models.back() = file.file_at(value, "run.model", folder);
      else
        list.values.back().emplace_back(name, file.text(value, name, folder));
    }
  }
  return list;
}

std::vector<std::string> models_of(const SweepFile& file, const fs::path& folder) {
  const Json& sweep = file.table("sweep");
  std::vector<std::string> models;
  if (!sweep.contains("models")) return models;
  if (!sweep["models"].is_array()) file.refuse("sweep.models: must be a list of files");
  for (const Json& model : sweep["models"])
    models.push_back(file.file_at(model, "sweep.models", folder));
  return models;
}

Values held_values(const SweepFile& file, const fs::path& folder) {
  Values held;
  for (const auto& [name, value] : flat(file, file.table("set")))
    held.emplace_back(name, file.text(value, name, folder));
  return held;
}

std::vector<std::string> varied_names(const std::vector<SweepRun>& runs) {
  std::vector<std::string> names;
  std::map<std::string, std::set<std::string>> seen;
  for (const SweepRun& run : runs) {
    seen[kModel].insert(run.model);
    for (const auto& [name, value] : run.values) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
      seen[name].insert(value);
    }
  }
  // What some runs do not set at all differs as well.
  for (const std::string& name : names)
    for (const SweepRun& run : runs)
      if (std::ranges::none_of(run.values, [&](const auto& v) { return v.first == name; }))
        seen[name].insert("");
  std::erase_if(names, [&](const std::string& name) { return seen[name].size() < 2; });
  if (seen[kModel].size() > 1) names.insert(names.begin(), kModel);
  return names;
}

// What the method would pass over has no place in the file.
void require_heard(const SweepFile& file, const std::string& method) {
  if (method == "list" && file.has("vary"))
    file.refuse(
        "[[run]] tables name each run, [vary] makes runs of its own: keep one of the two, and put "
        "what holds for all under [set]");
  if (method != "list" && file.has("run"))
    file.refuse(fmt::format(
        "[[run]] tables are for method = \"list\", not \"{}\": leave out the one or the other",
        method));
  for (const char* key : {"runs", "seed"})
    if (method != "latin" && file.says(key))
      file.refuse(fmt::format("sweep.{}: is for method = \"latin\", and this sweep's is \"{}\"",
                              key, method));
}

// A latin hypercube's ranges have as many values as there are runs.
std::vector<Axis> read_latin_axes(const SweepFile& file, const fs::path& folder) {
  std::vector<Axis> axes = read_axes(file, folder);
  for (const Axis& axis : axes)
    if (axis.count > 0)
      file.refuse(fmt::format(
          "vary.{}: with method = \"latin\", runs under [sweep] says how many; leave out count",
          axis.name));
  return axes;
}

// Files are named as from the sweep's folder.
std::string as_from_here(const std::string& name, const std::string& value,
                         const fs::path& folder) {
  return names_file(name, value) ? (folder / value).string() : value;
}

bool sets(const SweepRun& run, const std::string& name) {
  return std::ranges::any_of(run.values, [&](const auto& value) { return value.first == name; });
}

}  // namespace

SweepPlan read_sweep(const fs::path& file, const fs::path& folder, const RunContext& context) {
  const SweepFile sweep(file);
  SweepPlan plan;
  plan.command = command_of(sweep.choice("command", command_names()));
  plan.quality = sweep.choice("quality", {"normal", "draft", "fine"});
  plan.keep_files = sweep.choice("keep", {"report", "all"}) == "all";
  const std::string method =
      sweep.choice("method", {sweep.has("run") ? "list" : "grid", "grid", "list", "latin"});
  require_heard(sweep, method);
  if (sweep.says("job")) plan.job = sweep.file_at(sweep.table("sweep")["job"], "sweep.job", folder);

  Listed runs;
  if (method == "list")
    runs = listed(sweep, folder);
  else if (method == "latin")
    runs.values = latin(read_latin_axes(sweep, folder), sweep.whole("runs", 100, 1, kMostRuns),
                        sweep.whole("seed", 1, 0, ~std::uint64_t{0} >> 1));
  else
    runs.values = grid(sweep, read_axes(sweep, folder), context);
  if (runs.values.empty()) sweep.refuse("there are no runs in it: write [[run]] tables");
  runs.models.resize(runs.values.size());

  std::vector<std::string> models = models_of(sweep, folder);
  if (models.empty()) models.emplace_back();
  require_few_enough(sweep, double(models.size()) * double(runs.values.size()));
  const Values held = held_values(sweep, folder);
  FileHashes hashes;
  std::set<std::string> ids;
  for (const std::string& model : models)
    for (std::size_t i = 0; i < runs.values.size(); ++i) {
      context.check_cancelled();
      SweepRun run;
      run.model = runs.models[i].empty() ? model : runs.models[i];
      run.values = held;
      run.values.insert(run.values.end(), runs.values[i].begin(), runs.values[i].end());
      note_inputs(plan, run, folder, hashes, context);  // says what is wrong
      if (ids.insert(run.id).second)
        plan.runs.push_back(std::move(run));
      else
        ++plan.same;
    }
  plan.varied = varied_names(plan.runs);
  return plan;
}

std::string value_of(const SweepRun& run, const std::string& name) {
  if (name == kModel) return run.model;
  std::string value;
  for (const auto& [own, text] : run.values)
    if (own == name) value = text;  // the last one counts
  return value;
}

JobConfig sweep_config(const SweepPlan& plan, const SweepRun& run, const fs::path& folder) {
  if (!run.model.empty() && sets(run, kModelFile))
    throw InputError(fmt::format(
        "{} and models under [sweep] (or model in a [[run]]) both name the model of a run: leave "
        "out one of them",
        kModelFile));
  JobConfig config;
  SettingSources sources;
  if (!plan.quality.empty()) sources.quality = quality_settings(plan.quality);
  if (!plan.job.empty()) sources.configs.push_back(folder / plan.job);
  // A sweep's poses are its own.
  sources.options.push_back({"plan.suggest", std::string("off"), false, "'off'", "sweep"});
  if (!plan.keep_files)
    sources.options.push_back({"preview.pictures", std::string("off"), false, "'off'", "sweep"});
  for (const auto& [name, value] : run.values)
    sources.sets.push_back(
        {name, as_from_here(name, value, folder), false, "'" + value + "'", "the sweep"});
  apply_sources(config, sources);
  if (!run.model.empty()) config.model = folder / run.model;
  if (config.model.empty())
    throw InputError(
        "the sweep names no model: write models = [\"FILE\"] under [sweep], or a job with one");
  return config;
}

std::string manifest_json(const SweepPlan& plan) {
  Json runs = Json::array();
  for (const SweepRun& run : plan.runs) {
    Json values = Json::object();
    for (const auto& [name, value] : run.values) values[name] = value;
    runs.push_back({{"id", run.id}, {"model", run.model}, {"values", values}});
  }
  const Json json = {{"hydrodip_sweep", kSchemaVersion},
                     {"command", name_of(plan.command)},
                     {"quality", plan.quality},
                     {"job", plan.job},
                     {"keep", plan.keep_files ? "all" : "report"},
                     {"varied", plan.varied},
                     {"inputs", plan.inputs},
                     {"model_files", plan.model_files},
                     {"runs", runs}};
  return json_text(json);
}

SweepPlan read_manifest(const fs::path& folder) {
  const fs::path file = folder / "sweep.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    throw InputError(
        fmt::format("{}: there is no sweep.json; 'hydrodip sweep plan FILE.toml -o DIR' makes one",
                    folder.string()));
  const std::vector<std::uint8_t> bytes = read_file(file);
  try {
    const Json json = parsed_json<Json>(bytes);
    if (json.at("hydrodip_sweep").get<int>() != kSchemaVersion)
      throw InputError(
          fmt::format("{}: made by another version; plan the sweep again", file.string()));
    SweepPlan plan;
    plan.command = command_of(json.at("command").get<std::string>());
    plan.quality = json.at("quality").get<std::string>();
    plan.job = json.at("job").get<std::string>();
    plan.keep_files = json.at("keep") == "all";
    plan.varied = json.at("varied").get<std::vector<std::string>>();
    plan.inputs = json.at("inputs").get<decltype(plan.inputs)>();
    plan.model_files = json.at("model_files").get<decltype(plan.model_files)>();
    for (const Json& entry : json.at("runs")) {
      SweepRun run;
      run.id = entry.at("id").get<std::string>();
      if (run.id.size() != kIdDigits ||
          run.id.find_first_not_of("0123456789abcdef") != std::string::npos)
        throw InputError(fmt::format("{}: '{}' is no run's id", file.string(), run.id));
      run.model = entry.at("model").get<std::string>();
      for (const auto& [name, value] : entry.at("values").items())
        run.values.emplace_back(name, value.get<std::string>());
      plan.runs.push_back(std::move(run));
    }
    return plan;
  } catch (const Json::exception&) {
    throw InputError(
        fmt::format("{}: this is no sweep's manifest; plan the sweep again", file.string()));
  }
}

}  // namespace hydrodip
