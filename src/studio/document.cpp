#include "studio/document.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/parse_double.h"
#include "base/text.h"
#include "settings/artwork_tables.h"
#include "settings/params.h"
#include "settings/settings.h"
#include "studio/api_error.h"

namespace hydrodip {
namespace {

constexpr const char* kOrigin = "this job";
constexpr std::size_t kMostForPage = std::size_t(64) << 10U;

[[noreturn]] void refuse(const std::string& field, const std::string& sentence) {
  throw ApiError(422, "bad-value", sentence, field);
}

// ---- reading ----

class Reader {
 public:
  Reader(const Json& document, const JobFiles& files) : document_(document), files_(files) {}

  JobConfig read() {
    if (!document_.is_object()) refuse("", "A job is an object of groups.");
    for (const auto& [key, value] : document_.items()) take(key, value);
    try {
      settle(config_, given_);
    } catch (const InputError& error) {
      refuse("", error.what());
    }
    return std::move(config_);
  }

 private:
  void take(const std::string& key, const Json& value) {
    if (value.is_null()) return;
    if (key == "name") return check_name(value);
    if (key == "page") return check_page(value);
    if (key == "path") return apply(key, rows(key, value));
    if (key == "artwork" || key == "dips") return take_list(key, value);
    if (!value.is_object()) refuse(key, fmt::format("{} is no group of a job's values.", key));
    for (const auto& [inner, own] : value.items()) {
      const std::string name = fmt::format("{}.{}", key, inner);
      if (is_of_the_machine(name)) refuse(name, name + " belongs to the machine, not to a job.");
      if (!own.is_null()) apply(name, own);
    }
  }

  static void check_name(const Json& value) {
    if (!value.is_string() || value.get<std::string>().size() > kLongestName)
      refuse("name", fmt::format("A job's name is text of at most {} bytes.", kLongestName));
  }

  static void check_page(const Json& value) {
    if (!value.is_object() || text_of(value).size() > kMostForPage)
      refuse("page", "What the page keeps is an object of at most 64 kB.");
  }

  void take_list(const std::string& key, const Json& value) {
    const std::string table = key == "dips" ? "dip" : key;
    if (!value.is_array()) refuse(key, key + " is a list.");
    for (std::size_t n = 0; n < value.size(); ++n) {
      const std::string prefix = fmt::format("{}[{}].", table, n + 1);
      if (!value[n].is_object()) refuse(prefix, key + " is a list of objects.");
      // A dip of which nothing is said is one all the same.
      if (key == "dips") apply(prefix + "locked", false);
      for (const auto& [inner, own] : value[n].items())
        if (!own.is_null()) apply(prefix + inner, inner == "path" ? rows(prefix, own) : own);
    }
  }

  // [[0, 0, 0, 0, 0, 0], ...] one after the other.
  static Json rows(const std::string& field, const Json& value) {
    Json all = Json::array();
    if (!value.is_array()) refuse(field, "A way into the water is a list of rows of six numbers.");
    for (const Json& row : value) {
      if (!row.is_array() || row.size() != 6)
        refuse(field, "A way into the water has rows of six numbers.");
      for (const Json& number : row) all.push_back(number);
    }
    return all;
  }

  bool is_path(const std::string& name) const {
    if (name.starts_with("artwork[")) return is_artwork_path(name);
    if (name.starts_with("dip[")) return name.ends_with("].correction");
    return find_parameter(name, kOrigin).type == ParameterType::kPath;
  }

  void apply(const std::string& name, const Json& value) {
    try {
      Setting setting{name, std::string(), true, "'" + text_of(value) + "'", kOrigin};
      if (value.is_number()) {
        setting.value = value.get<double>();
      } else if (value.is_boolean()) {
        const bool flag = value.get<bool>();
        setting.value = switch_text(name, flag).value_or(flag ? "true" : "false");
      } else if (value.is_string()) {
        const auto text = value.get<std::string>();
        if (text.empty() && (is_path(name) || !name.starts_with("artwork["))) return;
        setting.value = is_path(name) ? files_.find(text).string() : text;
      } else if (value.is_array()) {
        std::vector<double> numbers;
        for (const Json& number : value) {
          if (!number.is_number()) refuse(name, fmt::format("{} has numbers in it.", name));
          numbers.push_back(number.get<double>());
        }
        setting.value = numbers;
      } else {
        refuse(name, fmt::format("{} is a number, text or a list of numbers.", name));
      }
      apply_settings(config_, {setting});
      given_.push_back(std::move(setting));
    } catch (const InputError& error) {
      refuse(name, error.what());
    } catch (const ApiError& error) {
      if (!error.field.empty() || error.code != "bad-value") throw;
      refuse(name, error.what());
    }
  }

  const Json& document_;
  const JobFiles& files_;
  JobConfig config_;
  std::vector<Setting> given_;
};

// ---- writing ----

Json rows_of_path(const std::vector<Keyframe>& path) {
  Json rows = Json::array();
  for (const Keyframe& k : path)
    rows.push_back(
        {k.lower_mm, k.shift_x_mm, k.shift_y_mm, k.turn_x_deg, k.turn_y_deg, k.turn_z_deg});
  return rows;
}

Json json_of(const Parameter& p, const ParameterValue& value, JobFiles& files) {
  if (const double* number = std::get_if<double>(&value))
    return p.type == ParameterType::kInteger ? Json(long(*number)) : Json(*number);
  if (const auto* text = std::get_if<std::string>(&value))
    return p.type == ParameterType::kPath && !text->empty() ? Json(files.grant(*text))
                                                            : Json(*text);
  return Json(std::get<std::array<double, 3>>(value));
}

Json numbers_of(const std::string& text) {
  Json list = Json::array();
  for (const std::string_view part : split(text, ',')) {
    double number = 0;
    parse_double(part.data(), part.data() + part.size(), number);
    list.push_back(number);
  }
  return list.size() == 1 ? list.front() : list;
}

Json json_of(LayerKey::Kind kind, const std::string& value, JobFiles& files) {
  switch (kind) {
    case LayerKey::Kind::kPath:
      return files.grant(value);
    case LayerKey::Kind::kText:
      return value;
    case LayerKey::Kind::kFlag:
      return value == "true";
    case LayerKey::Kind::kNumbers:
      break;
  }
  return numbers_of(value);
}

Json layer_json(const ArtworkLayer& layer, JobFiles& files) {
  Json json = Json::object();
  const std::vector<std::string> values = layer_values(layer), usual = layer_values({});
  for (std::size_t k = 0; k < values.size(); ++k) {
    const LayerKey& key = layer_keys()[k];
    if (values[k] != usual[k]) json[key.name] = json_of(key.kind, values[k], files);
  }
  return json;
}

Json dip_json(const DipEntry& dip, JobFiles& files) {
  Json json = Json::object();
  if (dip.down) json["down"] = side_name(*dip.down);
  if (dip.rotate_deg)
    json["rotate_deg"] = {dip.rotate_deg->x(), dip.rotate_deg->y(), dip.rotate_deg->z()};
  if (dip.depth_mm) json["depth_mm"] = *dip.depth_mm;
  if (!dip.path.empty()) json["path"] = rows_of_path(dip.path);
  if (dip.locked) json["locked"] = true;
  if (!dip.correction.empty()) json["correction"] = files.grant(dip.correction.string());
  return json;
}

}  // namespace

bool is_of_the_machine(const std::string& name) {
  return name.starts_with("run.") || name.starts_with("stage.") || name.starts_with("output.");
}

JobConfig config_of(const Json& document, const JobFiles& files) {
  return Reader(document, files).read();
}

Json document_of(const JobConfig& config, JobFiles& files) {
  if (!config.parts.empty())
    throw InputError(
        "this job puts several parts on a sheet, and the studio works on one object: open the job "
        "of one part, or print them all with 'hydrodip nest'");
  Json document = Json::object();
  for (const Parameter& p : parameters()) {
    const ParameterValue value = p.get(config);
    const std::size_t dot = p.name.find('.');
    if (value == p.default_value() || is_of_the_machine(p.name) || dot == std::string::npos)
      continue;
    document[p.name.substr(0, dot)][p.name.substr(dot + 1)] = json_of(p, value, files);
  }
  if (!config.design.trajectory.path.empty())
    document["path"] = rows_of_path(config.design.trajectory.path);
  for (const ArtworkLayer& layer : config.object.artwork)
    document["artwork"].push_back(layer_json(layer, files));
  for (const DipEntry& dip : config.dips) document["dips"].push_back(dip_json(dip, files));
  return document;
}

Json values_of(const JobConfig& config, const std::vector<std::string>& names, JobFiles& files) {
  Json patch = Json::object();
  for (const std::string& name : names) {
    const Parameter& p = find_parameter(name, kOrigin);
    const std::size_t dot = p.name.find('.');
    if (dot == std::string::npos || is_of_the_machine(p.name)) continue;
    patch[p.name.substr(0, dot)][p.name.substr(dot + 1)] = json_of(p, p.get(config), files);
  }
  return patch;
}

Json machine_values_of(const JobConfig& config) {
  Json values = Json::object();
  for (const Parameter& p : parameters()) {
    const ParameterValue value = p.get(config);
    if (!is_of_the_machine(p.name) || value == p.default_value()) continue;
    std::visit([&](const auto& own) { values[p.name] = own; }, value);
  }
  return values;
}

void apply_machine_values(const Json& values, JobConfig& config) {
  for (const auto& [name, value] : values.items()) {
    if (!is_of_the_machine(name)) continue;
    Setting setting{name, std::string(), true, "'" + text_of(value) + "'", kOrigin};
    if (value.is_number()) setting.value = value.get<double>();
    if (value.is_string()) setting.value = value.get<std::string>();
    try {
      apply_settings(config, {setting});
    } catch (const InputError& error) {
      refuse(name, error.what());
    }
  }
}

void each_side_file(JobConfig& config, const std::function<void(std::filesystem::path&)>& visit) {
  for (const Parameter& p : parameters()) {
    if (p.type != ParameterType::kPath || p.name == "object.file") continue;
    std::filesystem::path file = std::get<std::string>(p.get(config));
    if (file.empty()) continue;
    visit(file);
    p.set(config, file.string());
  }
  for (ArtworkLayer& layer : config.object.artwork)
    if (!layer.image.empty()) visit(layer.image);
  for (DipEntry& dip : config.dips)
    if (!dip.correction.empty()) visit(dip.correction);
}

std::string name_of_job(const Json& document) {
  const auto text = [](const Json& value) {
    return value.is_string() ? value.get<std::string>() : std::string();
  };
  std::string given = text(document.value("name", Json()));
  if (!given.empty()) return given;
  const Json object = document.value("object", Json::object());
  const std::string model = object.is_object() ? text(object.value("file", Json())) : "";
  return model.empty() ? "untitled" : std::filesystem::path(model).stem().string();
}

}  // namespace hydrodip
