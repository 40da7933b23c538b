#include "sweep/sweep_inputs.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/file.h"
#include "base/json_text.h"
#include "model_io/load.h"
#include "settings/artwork_tables.h"
#include "settings/params.h"
#include "settings/path_file.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const Parameter* known_parameter(const std::string& name) {
  for (const Parameter& parameter : parameters())
    if (parameter.name == name) return &parameter;
  return nullptr;
}

// The model and what it refers to, as from the sweep's folder.
std::vector<std::string> files_of_model(const fs::path& model, const fs::path& folder,
                                        const RunContext& context) {
  std::vector<std::string> names = {from_folder(model, folder)};
  try {
    for (const fs::path& file : load_object(model, {}, context.quiet()).files)
      if (const std::string name = from_folder(file, folder); name != names.front())
        names.push_back(name);
  } catch (const InputError&) {
    // Its run says what is wrong with it.
  }
  return names;
}

// Beside the model's: in this order.
std::vector<std::string> named_files(const JobConfig& config, const fs::path& folder) {
  std::vector<std::string> files;
  const auto add = [&](const fs::path& file) {
    if (!file.empty()) files.push_back(from_folder(file, folder));
  };
  for (const Parameter& parameter : parameters())
    if (parameter.type == ParameterType::kPath && parameter.name != "object.file")
      add(std::get<std::string>(parameter.get(config)));
  for (const ArtworkLayer& layer : config.object.artwork) add(layer.image);
  for (const DipEntry& dip : config.dips) add(dip.correction);
  for (const fs::path& file : config.settings_files) add(file);
  return files;
}

// Ways into the water come from files, too, that are read already.
std::vector<std::string> ways_of(const JobConfig& config) {
  std::vector<std::string> ways = {rows_of(config.design.trajectory.path)};
  for (const DipEntry& dip : config.dips) ways.push_back(rows_of(dip.path));
  return ways;
}

// The values as they will hold, so that 0.5 and "0.50" are one.
Json effective_values(const SweepRun& run, const JobConfig& config) {
  std::map<std::string, std::string> values;
  for (const auto& [name, text] : run.values) {
    if (names_file(name, text)) continue;  // its content is what counts
    const Parameter* parameter = known_parameter(name);
    values[name] = parameter ? show_value(*parameter, parameter->get(config)) : text;
  }
  return values;
}

template <class Hash>
std::string id_of(const SweepPlan& plan, const SweepRun& run, const JobConfig& config,
                  const fs::path& folder, const Hash& hash) {
  Json model = Json::array(), named = Json::array();
  for (const std::string& file : plan.model_files.at(from_folder(config.model, folder)))
    model.push_back(hash(file));
  for (const std::string& file : named_files(config, folder)) named.push_back(hash(file));
  const Json content = {{"command", int(plan.command)},
                        {"quality", plan.quality},
                        {"model", model},
                        {"files", named},
                        {"ways", ways_of(config)},
                        {"values", effective_values(run, config)}};
  const std::string text = json_line(content);
  return sha256_hex(text).substr(0, kIdDigits);
}

bool is_as_planned(const SweepPlan& plan, const std::string& file, const fs::path& folder,
                   FileHashes& hashes) {
  const auto planned = plan.inputs.find(file);
  return planned != plan.inputs.end() && hashes.of(folder / file) == planned->second;
}

[[noreturn]] void refuse_changed(const std::string& file) {
  throw ChangedInput(fmt::format(
      "{} has changed since the sweep was planned; plan it again, and what is the same is not done "
      "again",
      file));
}

}  // namespace

std::string from_folder(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path relative = fs::relative(file, folder, error);
  return error || relative.empty() ? fs::absolute(file).string() : relative.string();
}

bool names_file(const std::string& setting, const std::string& text) {
  const Parameter* parameter = known_parameter(setting);
  const bool is_way = parameter ? parameter->type == ParameterType::kWayIn
                                : setting.starts_with("dip[") && setting.ends_with("].path");
  const bool is_path = parameter ? parameter->type == ParameterType::kPath
                                 : is_artwork_path(setting) || (setting.starts_with("dip[") &&
                                                                setting.ends_with("].correction"));
  // A way with ';' is its rows themselves.
  return !text.empty() && (is_path || (is_way && text.find(';') == std::string::npos));
}

std::string FileHashes::of(const fs::path& file) {
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  const auto size = error ? std::uintmax_t{0} : fs::file_size(file, error);
  if (error) return "";
  {
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(file.string());
    if (known != known_.end() && known->second.written == written && known->second.size == size)
      return known->second.hash;
  }
  try {
    std::string hash = sha256_hex(read_file(file));
    const std::lock_guard lock(mutex_);
    known_[file.string()] = {written, size, hash};
    return hash;
  } catch (const InputError&) {
    return "";
  }
}

void note_inputs(SweepPlan& plan, SweepRun& run, const fs::path& folder, FileHashes& hashes,
                 const RunContext& context) {
  const JobConfig config = sweep_config(plan, run, folder);  // says what is wrong
  const std::string model = from_folder(config.model, folder);
  if (!plan.model_files.contains(model))
    plan.model_files[model] = files_of_model(config.model, folder, context);
  run.id = id_of(plan, run, config, folder, [&](const std::string& file) -> const std::string& {
    const auto [noted, is_new] = plan.inputs.try_emplace(file);
    if (is_new) noted->second = hashes.of(folder / file);
    return noted->second;
  });
}

void require_unchanged(const SweepPlan& plan, const SweepRun& run, const fs::path& folder,
                       FileHashes& hashes) {
  // Before it is read: it may be no job any more.
  if (!plan.job.empty() && !is_as_planned(plan, plan.job, folder, hashes))
    refuse_changed((folder / plan.job).string());
  const JobConfig config = [&] {
    try {
      return sweep_config(plan, run, folder);
    } catch (const InputError& error) {  // of which the plan had nothing to say
      throw ChangedInput(error.what());
    }
  }();
  const std::string edited =
      fmt::format("{}: run {} is not what was planned under that id; plan the sweep again",
                  (folder / "sweep.json").string(), run.id);
  if (!plan.model_files.contains(from_folder(config.model, folder))) throw ChangedInput(edited);
  const std::string id = id_of(plan, run, config, folder, [&](const std::string& file) {
    const auto planned = plan.inputs.find(file);
    if (planned == plan.inputs.end()) throw ChangedInput(edited);
    if (hashes.of(folder / file) != planned->second) refuse_changed((folder / file).string());
    return planned->second;
  });
  if (id != run.id) throw ChangedInput(edited);
}

void require_as_planned(const SweepPlan& plan, const std::string& report, const fs::path& folder) {
  const Json json = Json::parse(report);
  if (!json.contains("inputs")) return;
  // What a machine brings along, as fonts, is not the sweep's.
  const std::set<std::string> own = {"model", "model data", "material", "texture"};
  for (const Json& input : json["inputs"]) {
    const std::string file = input.at("path").get<std::string>();
    const auto planned = plan.inputs.find(from_folder(file, folder));
    const bool is_known = planned != plan.inputs.end();
    if (is_known ? planned->second != input.at("sha256").get<std::string>()
                 : own.contains(input.at("role").get<std::string>()))
      refuse_changed(file);
  }
}

}  // namespace hydrodip
