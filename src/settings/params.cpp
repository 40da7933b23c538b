#include "settings/params.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/json_text.h"
#include "base/nearest_name.h"
#include "base/parse_double.h"
#include "base/text.h"
#include "settings/artwork_tables.h"
#include "settings/dip_tables.h"
#include "settings/hex_color.h"
#include "settings/part_tables.h"
#include "settings/path_file.h"
#include "settings/refuse_value.h"
#include "settings/table_key.h"

namespace hydrodip {
namespace {

// The whole text as a finite number.
std::optional<double> parse_number(const std::string& untrimmed) {
  std::string text(trimmed(untrimmed));
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.erase(0, 1);
  double value = 0;
  const auto [end, error] = parse_double(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::optional<std::vector<double>> parse_numbers(const std::string& text) {
  std::vector<double> values;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto value = parse_number(text.substr(begin, end - begin));
    if (!value || values.size() == 3) return {};
    values.push_back(*value);
    begin = end + 1;
  }
  return values;
}

std::string with_unit(const std::string& text, const Parameter& p) {
  return p.unit.empty() ? text : text + " " + p.unit;
}

std::string quoted_list(const std::vector<std::string>& items) {
  std::string list;
  for (const std::string& item : items)
    list += (list.empty() ? "" : ", ") + (item.empty() ? std::string("\"\"") : item);
  return list;
}

// What the value has to be, to follow "must be".
std::string expectation(const Parameter& p) {
  const std::string range = with_unit(fmt::format("{} to {}", p.min, p.max), p);
  const std::string or_zero = (p.zero.empty() ? "" : fmt::format(", or 0 ({})", p.zero)) +
                              (p.word.empty() ? "" : fmt::format(", or {}", p.word));
  switch (p.type) {
    case ParameterType::kNumber:
      return "a number from " + range + or_zero;
    case ParameterType::kInteger:
      return "a whole number from " + range + or_zero;
    case ParameterType::kChoice:
      return "one of " + quoted_list(p.choices);
    case ParameterType::kText:
      return "text of one line";
    case ParameterType::kPath:
      return "a file name";
    case ParameterType::kColor:
      return "a colour such as #ffcc00";
    case ParameterType::kVector:
      return "three numbers X,Y,Z, each from " + range + or_zero;
    case ParameterType::kWayIn:
      return "the name of a CSV file, or in a configuration rows of six numbers (lower, shift x, "
             "shift y, turn x, turn y, turn z)";
  }
  return "";
}

[[noreturn]] void refuse(const Parameter& p, const Setting& setting) {
  const bool number = p.type == ParameterType::kNumber || p.type == ParameterType::kInteger;
  refuse_value(setting, number ? Wanted::kNumber : Wanted::kOther, expectation(p));
}

bool in_range(const Parameter& p, double value) {
  return std::isfinite(value) &&
         ((value >= p.min && value <= p.max) || (value == 0 && !p.zero.empty()));
}

double checked_number(const Parameter& p, const Setting& setting) {
  std::optional<double> value;
  if (const double* number = std::get_if<double>(&setting.value))
    value = *number;
  else if (const std::string* text = std::get_if<std::string>(&setting.value);
           text && !setting.typed)
    value = parse_number(*text);
  if (!value || !in_range(p, *value)) refuse(p, setting);
  if (p.type == ParameterType::kInteger && *value != std::floor(*value)) refuse(p, setting);
  return *value + 0.0;  // -0 becomes 0
}

std::array<double, 3> checked_vector(const Parameter& p, const Setting& setting) {
  std::optional<std::vector<double>> values;
  if (const auto* array = std::get_if<std::vector<double>>(&setting.value))
    values = *array;
  else if (const auto* text = std::get_if<std::string>(&setting.value))
    values = parse_numbers(*text);
  if (!values || values->size() != 3) refuse(p, setting);
  for (const double value : *values)
    if (!in_range(p, value)) refuse(p, setting);
  return {(*values)[0] + 0.0, (*values)[1] + 0.0, (*values)[2] + 0.0};
}

// What is wrong with it is told with the place that names it, which may be one of many.
std::vector<Keyframe> path_in_file(const std::string& file, const Setting& setting) {
  try {
    return read_path(file);
  } catch (const InputError& error) {
    if (!setting.typed) throw;
    throw InputError(fmt::format("{}: {}: {}", setting.origin, told_name(setting), error.what()));
  }
}

// A text with ';' is the rows themselves, as reports have them, and else the name of a file.
std::string checked_path(const Parameter& p, const Setting& setting) {
  if (const auto* text = std::get_if<std::string>(&setting.value)) {
    if (text->find('\0') != std::string::npos) refuse(p, setting);
    if (text->empty()) return "";
    return rows_of(text->find(';') == std::string::npos ? path_in_file(*text, setting)
                                                        : path_of_rows(*text, setting.origin));
  }
  const auto* values = std::get_if<std::vector<double>>(&setting.value);
  if (!values || values->empty() || values->size() % 6 != 0) refuse(p, setting);
  std::vector<Keyframe> keyframes;
  for (auto v = values->begin(); v != values->end(); v += 6)
    keyframes.push_back({v[0], v[1], v[2], v[3], v[4], v[5]});
  check_path(keyframes, setting.origin);
  return rows_of(keyframes);
}

std::string checked_text(const Parameter& p, const Setting& setting) {
  const std::string* text = std::get_if<std::string>(&setting.value);
  if (!text) refuse(p, setting);
  if (text->find('\0') != std::string::npos) refuse(p, setting);
  if (p.type == ParameterType::kText && text->find_first_of("\n\r") != std::string::npos)
    refuse(p, setting);
  if (p.type == ParameterType::kChoice &&
      std::find(p.choices.begin(), p.choices.end(), *text) == p.choices.end())
    refuse(p, setting);
  if (p.type == ParameterType::kColor && !parse_color(*text)) refuse(p, setting);
  return *text;
}

bool is_word(const Parameter& p, const Setting& setting) {
  const auto* text = std::get_if<std::string>(&setting.value);
  return text && !p.word.empty() && trimmed(*text) == p.word;
}

ParameterValue checked(const Parameter& p, const Setting& setting) {
  if (is_word(p, setting)) return p.word;
  switch (p.type) {
    case ParameterType::kNumber:
    case ParameterType::kInteger:
      return checked_number(p, setting);
    case ParameterType::kVector:
      return checked_vector(p, setting);
    case ParameterType::kWayIn:
      return checked_path(p, setting);
    default:
      return checked_text(p, setting);
  }
}

const char* type_name(ParameterType type) {
  switch (type) {
    case ParameterType::kNumber:
      return "number";
    case ParameterType::kInteger:
      return "integer";
    case ParameterType::kChoice:
      return "choice";
    case ParameterType::kText:
      return "text";
    case ParameterType::kPath:
      return "path";
    case ParameterType::kColor:
      return "color";
    case ParameterType::kVector:
      return "vector";
    case ParameterType::kWayIn:
      return "keyframes";
  }
  return "";
}

std::string plain_value(const ParameterValue& value) {
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const auto& v = std::get<std::array<double, 3>>(value);
  return fmt::format("{},{},{}", v[0], v[1], v[2]);
}

// Where letters alone do not tell it: other words, and names that several groups have.
std::string usually_meant(const std::string& name) {
  static const std::vector<std::pair<std::string, std::string>> meant = {
      {"depth", "dip.depth_mm"},
      {"width", "film.width_mm"},
      {"height", "film.height_mm"},
      {"resolution", "print.dpi"},
      {"print.resolution", "print.dpi"}};
  for (const auto& [word, parameter] : meant)
    if (name == word) return parameter;
  return "";
}

}  // namespace

const Parameter& find_parameter(const std::string& name, const std::string& origin) {
  std::vector<std::string> names;
  for (const Parameter& p : parameters()) {
    if (p.name == name) return p;
    names.push_back(p.name);
  }
  const std::string meant = usually_meant(name);
  const std::string hint =
      meant.empty() ? did_you_mean(name, names) : "; did you mean '" + meant + "'?";
  std::string brief = name.substr(0, 100);
  std::replace(brief.begin(), brief.end(), '\0', '?');  // a sentence would end there
  throw InputError(fmt::format("{}: unknown parameter '{}'{}", origin, brief,
                               hint.empty() ? "; 'hydrodip params' lists them all" : hint));
}

bool is_on_off(const Parameter& parameter) {
  static const std::vector<std::string> on_off = {"on", "off"};
  return std::ranges::is_permutation(parameter.choices, on_off);
}

std::optional<std::string> switch_text(const std::string& name, bool value) {
  const auto dip = table_key("dip", name);
  if (is_artwork_switch(name) || (dip && dip->key == "locked")) return value ? "true" : "false";
  for (const Parameter& p : parameters())
    if (p.name == name && is_on_off(p)) return value ? "on" : "off";
  return {};
}

std::string told_name(const Setting& setting) {
  return setting.told.empty() ? setting.name : setting.told;
}

void apply_settings(JobConfig& config, const std::vector<Setting>& settings) {
  for (const Setting& setting : settings) {
    if (apply_artwork_setting(config, setting) || apply_part_setting(config, setting) ||
        apply_dip_setting(config, setting))
      continue;
    const Parameter& p = find_parameter(setting.name, setting.origin);
    p.set(config, checked(p, setting));
  }
}

std::string show_value(const Parameter& p, const ParameterValue& value) {
  const double* number = std::get_if<double>(&value);
  if (number && *number == 0 && !p.zero.empty()) return "0 (" + p.zero + ")";
  return with_unit(plain_value(value), p);
}

std::string show_range(const Parameter& p) {
  switch (p.type) {
    case ParameterType::kNumber:
    case ParameterType::kInteger:
    case ParameterType::kVector:
      return with_unit(fmt::format("{} to {}", p.min, p.max), p) +
             (p.zero.empty() ? "" : fmt::format(", or 0 ({})", p.zero)) +
             (p.word.empty() ? "" : fmt::format(", or {}", p.word));
    case ParameterType::kChoice: {
      std::string list;
      for (const std::string& choice : p.choices)
        list += (list.empty() ? "" : " | ") + (choice.empty() ? std::string("\"\"") : choice);
      return list;
    }
    default:
      return type_name(p.type);
  }
}

std::string parameters_table() {
  std::size_t name_width = 0, value_width = 0;
  for (const Parameter& p : parameters()) {
    name_width = std::max(name_width, p.name.size());
    value_width = std::max(value_width, with_unit(plain_value(p.default_value()), p).size());
  }
  std::string table, group;
  for (const Parameter& p : parameters()) {
    const std::string this_group = p.name.substr(0, p.name.find('.'));
    if (!group.empty() && group != this_group) table += '\n';
    group = this_group;
    std::string value = plain_value(p.default_value());
    if (value.empty()) value = "\"\"";
    table += fmt::format("{:<{}}  {:<{}}  {}\n{:<{}}  {:<{}}  [{}]\n", p.name, name_width,
                         with_unit(value, p), value_width, p.help, "", name_width, "", value_width,
                         show_range(p));
  }
  return table;
}

std::string parameters_json() {
  using json = nlohmann::ordered_json;
  json list = json::array();
  for (const Parameter& p : parameters()) {
    json entry;
    entry["name"] = p.name;
    entry["type"] = type_name(p.type);
    entry["unit"] = p.unit;
    const ParameterValue value = p.default_value();
    if (p.type == ParameterType::kInteger)
      entry["default"] = static_cast<long>(std::get<double>(value));
    else
      std::visit([&](const auto& v) { entry["default"] = v; }, value);
    if (p.type == ParameterType::kNumber || p.type == ParameterType::kVector) {
      entry["min"] = p.min;
      entry["max"] = p.max;
    } else if (p.type == ParameterType::kInteger) {
      entry["min"] = static_cast<long>(p.min);
      entry["max"] = static_cast<long>(p.max);
    } else if (p.type == ParameterType::kChoice) {
      entry["choices"] = p.choices;
    }
    if (!p.zero.empty()) entry["zero_means"] = p.zero;
    if (!p.word.empty()) entry["word"] = p.word;
    entry["help"] = p.help;
    list.push_back(std::move(entry));
  }
  return json_text({{"schema_version", 1}, {"parameters", std::move(list)}});
}

}  // namespace hydrodip
