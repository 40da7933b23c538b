// Parameters as records: name, unit, type, range, default and help live in one place (the tables in
// settings/parameter_table.cpp) and drive validation, `hydrodip params`, configuration files and
// reports.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "settings/config.h"

namespace hydrodip {

enum class ParameterType { kNumber, kInteger, kChoice, kText, kPath, kColor, kVector, kWayIn };

// A checked value: a number (kNumber, kInteger), text (kChoice, kText, kPath, kColor; of kWayIn the
// rows of keyframes, as rows_of() writes them) or three numbers (kVector).
using ParameterValue = std::variant<double, std::string, std::array<double, 3>>;

struct Parameter {
  std::string name;  // "film.width_mm"
  std::string unit;  // "mm", "deg", "px", ...; "" for none
  ParameterType type = ParameterType::kNumber;
  double min = 0, max = 0;           // inclusive; of numbers and vector components
  std::string zero;                  // what 0 stands for where it is allowed beside the range
  std::string word;                  // what may stand instead of a value: "auto"; mostly empty
  std::vector<std::string> choices;  // of kChoice
  std::string help;                  // one line
  std::function<ParameterValue(const JobConfig&)> get;
  std::function<void(JobConfig&, const ParameterValue&)> set;  // the value has been checked

  ParameterValue default_value() const { return get(JobConfig{}); }
};

// All of them, in the order in which people should read them.
const std::vector<Parameter>& parameters();

// Throws InputError with the nearest known name; `origin` says where the name came from.
const Parameter& find_parameter(const std::string& name, const std::string& origin);

// Whether it is either on or off, which a file may also say as true or false.
bool is_on_off(const Parameter& parameter);

// What true or false in a file means for that parameter or table's key, as its text: "on",
// "false". Nothing where it is no value.
std::optional<std::string> switch_text(const std::string& name, bool value);

// One "name = value" from an option (--set, --size: text) or a file (typed).
struct Setting {
  std::string name;
  std::variant<std::string, double, std::vector<double>> value;
  bool typed = false;  // from TOML: text stays text, and a number must be a number
  std::string shown;   // the value as the user wrote it, for messages
  std::string origin;  // "--set", "jobs/a.toml:3"
  // What messages call it, as its file does: "[[dip]] 2: depth_mm"; empty: its name.
  std::string told = {};
};

std::string told_name(const Setting& setting);

// Checks every setting and applies them in order, so that later ones win. "dip[2].rotate_deg" is
// the second of the job's dips, which is made if it is new. Throws InputError naming
// parameter, value, range and origin.
void apply_settings(JobConfig& config, const std::vector<Setting>& settings);

// "60 mm", "contact-line", "0,0,90 deg".
std::string show_value(const Parameter& parameter, const ParameterValue& value);
// "10 to 3000 mm, or 0 (keep the model's size)", "rectangle | disc", "text".
std::string show_range(const Parameter& parameter);

// The table of `hydrodip params` and its JSON form (schema_version, parameters).
std::string parameters_table();
std::string parameters_json();

}  // namespace hydrodip
