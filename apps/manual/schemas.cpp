#include "schemas.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "base/json_text.h"
#include "base/parse_double.h"
#include "settings/artwork_tables.h"
#include "settings/dip_tables.h"
#include "settings/params.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDraft = "https://json-schema.org/draft/2020-12/schema";

Json array_of(Json items, int least, int most) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}, {"maxItems", most}};
}

Json text(const char* type) { return {{"type", type}}; }

// Beside what `schema` allows.
Json or_else(Json schema, const Json& other) {
  if (!schema.contains("anyOf")) schema = {{"anyOf", Json::array({std::move(schema)})}};
  schema["anyOf"].push_back(other);
  return schema;
}

Json number_schema(const Parameter& p) {
  Json schema = text(p.type == ParameterType::kInteger ? "integer" : "number");
  schema["minimum"] = p.min;
  schema["maximum"] = p.max;
  if (!p.zero.empty()) schema = or_else(std::move(schema), {{"const", 0}});
  return schema;
}

// A keyframe as TOML's row of six numbers.
Json rows_of_keyframes() {
  Json rows = {{"type", "array"}, {"items", array_of(text("number"), 6, 6)}, {"minItems", 1}};
  return rows;
}

// A parameter's value, without what it means.
Json value_schema(const Parameter& p) {
  Json schema;
  switch (p.type) {
    case ParameterType::kNumber:
    case ParameterType::kInteger:
      schema = number_schema(p);
      break;
    case ParameterType::kChoice:
      schema = {{"enum", p.choices}};
      break;
    case ParameterType::kText:
    case ParameterType::kPath:
      schema = text("string");
      break;
    case ParameterType::kColor:
      schema = {{"type", "string"}, {"pattern", "^#[0-9A-Fa-f]{6}$"}};
      break;
    case ParameterType::kVector:
      schema = array_of({{"type", "number"}, {"minimum", p.min}, {"maximum", p.max}}, 3, 3);
      break;
    case ParameterType::kWayIn:
      schema = or_else(text("string"), rows_of_keyframes());
      break;
  }
  if (!p.word.empty()) schema = or_else(std::move(schema), {{"const", p.word}});
  return schema;
}

// In a file, vectors may be text as for --set too, and what is on or off true or false.
Json file_schema(const Parameter& p) {
  Json schema = value_schema(p);
  if (is_on_off(p))
    for (const bool value : {true, false}) schema["enum"].push_back(value);
  if (p.type == ParameterType::kVector) schema = or_else(std::move(schema), text("string"));
  schema["description"] = p.help + (p.unit.empty() ? "" : " (" + p.unit + ")");
  const ParameterValue usual = p.default_value();
  std::visit([&](const auto& value) { schema["default"] = value; }, usual);
  return schema;
}

// Of what the program writes: keys that a later version adds are no mistake of its reader.
Json open_object(Json properties) {
  return {{"type", "object"}, {"properties", std::move(properties)}};
}

// Of what people write: an editor shows a mistyped name.
Json closed_object(Json properties) {
  Json object = open_object(std::move(properties));
  object["additionalProperties"] = false;
  return object;
}

std::vector<std::string> words_of(const std::string& list) {
  std::vector<std::string> words(1);
  for (const char c : list) {
    if (c == ',')
      words.emplace_back();
    else if (c != ' ')
      words.back() += c;
  }
  return words;
}

// "a number from 0 to 360"; nothing of other ranges.
std::optional<std::pair<double, double>> bounds_of(std::string_view range) {
  constexpr std::string_view kFrom = "a number from ", kTo = " to ";
  const std::size_t to = range.find(kTo);
  if (!range.starts_with(kFrom) || to == std::string_view::npos) return {};
  std::pair<double, double> bounds;
  const auto is_number = [&](std::size_t begin, std::size_t end, double& value) {
    return parse_double(range.data() + begin, range.data() + end, value).ec == std::errc();
  };
  if (!is_number(kFrom.size(), to, bounds.first) ||
      !is_number(to + kTo.size(), range.size(), bounds.second))
    return {};
  return bounds;
}

// From what a value of a layer "has to be", in words.
Json layer_schema(const LayerKey& key) {
  if (const auto bounds = bounds_of(key.range))
    return {{"type", "number"}, {"minimum", bounds->first}, {"maximum", bounds->second}};
  if (key.range.starts_with("three numbers X,Y,Z")) return array_of(text("number"), 3, 3);
  constexpr std::string_view kSizes = "W or W,H, each ";
  if (key.range.starts_with(kSizes)) {
    const auto bounds = bounds_of("a number " + key.range.substr(kSizes.size())).value();
    const Json length = {{"type", "number"}, {"minimum", bounds.first}, {"maximum", bounds.second}};
    return or_else(length, array_of(length, 1, 2));
  }
  if (key.range.starts_with("one of ")) return {{"enum", words_of(key.range.substr(7))}};
  if (key.range == "text" || key.range == "a file name") return text("string");
  if (key.range == "true or false") return {{"enum", {true, false, "true", "false"}}};
  if (key.range.starts_with("a colour"))
    return {{"type", "string"}, {"pattern", "^#[0-9A-Fa-f]{6}$"}};
  throw std::logic_error("no JSON Schema for artwork's " + key.name + ": " + key.range);
}

Json artwork_schema() {
  Json properties = Json::object();
  for (const LayerKey& key : layer_keys()) {
    properties[key.name] = layer_schema(key);
    properties[key.name]["description"] = key.help;
  }
  return {{"type", "array"}, {"items", closed_object(std::move(properties))}};
}

// A dip's values are those of a single dip's parameters.
Json dips_schema() {
  Json properties = Json::object();
  for (const std::string& key : dip_keys()) {
    if (key == "locked") {
      properties[key] = {{"enum", {true, false, "true", "false"}},
                         {"description", "planning leaves this dip as it is"}};
      continue;
    }
    const std::string name = key == "path"         ? key
                             : key == "depth_mm"   ? "dip." + key
                             : key == "correction" ? "film." + key
                                                   : "object." + key;
    properties[key] = file_schema(find_parameter(name, "job_schema"));
    properties[key].erase("default");
  }
  return {{"type", "array"}, {"items", closed_object(std::move(properties))}};
}

Json parts_schema() {
  Json part = closed_object(
      {{"job", {{"type", "string"}, {"minLength", 1}, {"description", "a model, or a job's file"}}},
       {"count", {{"type", "integer"}, {"minimum", 1}, {"maximum", 100}}}});
  part["required"] = {"job"};
  return {{"type", "array"}, {"items", std::move(part)}};
}

}  // namespace

std::string job_schema() {
  Json properties = Json::object();
  for (const Parameter& p : parameters()) {
    const std::size_t dot = p.name.find('.');
    if (dot == std::string::npos) {
      properties[p.name] = file_schema(p);
      continue;
    }
    Json& group = properties[p.name.substr(0, dot)];
    if (group.is_null()) group = closed_object(Json::object());
    group["properties"][p.name.substr(dot + 1)] = file_schema(p);
  }
  properties["artwork"] = artwork_schema();
  // A job has parameters for a single dip, [dip], or tables for several, [[dip]].
  properties["dips"] = properties["dip"];  // what holds for all of several dips
  properties["dip"] = {{"anyOf", {properties["dip"], dips_schema()}}};
  properties["part"] = parts_schema();
  Json schema = {{"$schema", kDraft},
                 {"$id", "job.schema.json"},
                 {"title", "A hydrodip job file, configuration or profile: TOML, read as JSON"}};
  schema.update(closed_object(std::move(properties)));
  return json_text(schema);
}

std::string parameters_schema() {
  Json properties = Json::object();
  for (const Parameter& p : parameters()) {
    Json entry = open_object(
        {{"value", value_schema(p)},
         {"unit", {{"const", p.unit}}},
         {"changed", {{"type", "boolean"}, {"description", "differs from the default"}}}});
    entry["required"] = {"value", "unit", "changed"};
    entry["description"] = p.help;
    properties[p.name] = std::move(entry);
  }
  Json schema = {{"$schema", kDraft},
                 {"$id", "parameters.schema.json"},
                 {"title", "Every parameter of a job, as report.json has it"}};
  schema.update(open_object(std::move(properties)));
  // Artwork, dips and parts are there by number.
  schema["patternProperties"] = {{R"(^(artwork|dip|part)\[[0-9]+\]\.)", Json::object()}};
  return json_text(schema);
}

}  // namespace hydrodip
