#include "settings/dip_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/nearest_name.h"
#include "settings/refuse_value.h"
#include "settings/table_key.h"

namespace hydrodip {
namespace {

// The value as that parameter of a single dip would take it.
JobConfig checked_as(const std::string& parameter, const Setting& setting) {
  Setting renamed = setting;
  renamed.told = told_name(setting);
  renamed.name = parameter;
  JobConfig config;
  apply_settings(config, {renamed});
  return config;
}

bool checked_flag(const Setting& setting) {
  const auto* text = std::get_if<std::string>(&setting.value);
  if (text && (*text == "true" || *text == "false")) return *text == "true";
  refuse_value(setting, Wanted::kOther, "true or false");
}

}  // namespace

const std::vector<std::string>& dip_keys() {
  static const std::vector<std::string> keys = {"down", "rotate_deg", "depth_mm",
                                                "path", "locked",     "correction"};
  return keys;
}

bool apply_dip_setting(JobConfig& config, const Setting& setting) {
  const auto at = table_key("dip", setting.name);
  if (!at) return false;
  if (at->number > kMostDips)
    throw InputError(fmt::format("{}: a job has at most {} dips", setting.origin, kMostDips));
  if (std::find(dip_keys().begin(), dip_keys().end(), at->key) == dip_keys().end())
    throw InputError(fmt::format(
        "{}: unknown value '{}' of a [[dip]] table{}; it has down, rotate_deg, depth_mm, path, "
        "locked and correction, and what holds for all dips is given with --set or in a profile",
        setting.origin, at->key, did_you_mean(at->key, dip_keys())));
  if (config.dips.size() < at->number) config.dips.resize(at->number);
  DipEntry& dip = config.dips[at->number - 1];
  if (at->key == "down") {
    dip.down = checked_as("object.down", setting).object.pose.down;
  } else if (at->key == "rotate_deg") {
    const JobConfig value = checked_as("object.rotate_deg", setting);
    dip.rotate_deg.reset();
    dip.find_rotation = value.plan.find_pose;
    if (!value.plan.find_pose) dip.rotate_deg = value.object.pose.rotate_deg;
  } else if (at->key == "depth_mm") {
    const JobConfig value = checked_as("dip.depth_mm", setting);
    dip.depth_mm.reset();
    if (!value.plan.find_depth) dip.depth_mm = value.design.trajectory.depth_mm;
  } else if (at->key == "path") {
    dip.path = checked_as("path", setting).design.trajectory.path;
  } else if (at->key == "correction") {
    dip.correction = checked_as("film.correction", setting).correction;
  } else {
    dip.locked = checked_flag(setting);
  }
  return true;
}

std::string path_text(const std::vector<Keyframe>& path) {
  std::string rows;
  for (const Keyframe& k : path)
    rows += fmt::format("{}[{}, {}, {}, {}, {}, {}]", rows.empty() ? "" : ", ", k.lower_mm,
                        k.shift_x_mm, k.shift_y_mm, k.turn_x_deg, k.turn_y_deg, k.turn_z_deg);
  return "[" + rows + "]";
}

std::string dip_tables_toml(
    const std::vector<DipEntry>& dips,
    const std::function<std::string(const std::filesystem::path&)>& correction_text) {
  std::string text;
  for (const DipEntry& dip : dips) {
    text += "\n[[dip]]\n";
    if (dip.down) text += fmt::format("down = \"{}\"\n", side_name(*dip.down));
    if (dip.find_rotation) text += "rotate_deg = \"auto\"\n";
    if (dip.rotate_deg)
      text += fmt::format("rotate_deg = [{}, {}, {}]\n", dip.rotate_deg->x(), dip.rotate_deg->y(),
                          dip.rotate_deg->z());
    if (dip.depth_mm) text += fmt::format("depth_mm = {}\n", *dip.depth_mm);
    if (!dip.path.empty()) text += fmt::format("path = {}\n", path_text(dip.path));
    if (dip.locked) text += "locked = true\n";
    if (!dip.correction.empty())
      text += fmt::format("correction = {}\n", correction_text(dip.correction));
  }
  return text;
}

}  // namespace hydrodip
