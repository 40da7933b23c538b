#include "settings/job_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "settings/artwork_tables.h"
#include "settings/dip_tables.h"
#include "settings/params.h"

namespace hydrodip {
namespace {

// What belongs to the run, not to the job. A stage's limits go along: without them it would hit.
bool is_left_out(const Parameter& p) {
  return p.name.starts_with("run.") || p.name.starts_with("output.") || p.name == "plan.dips";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (byte < 0x20 || byte == 0x7f)
      out += fmt::format("\\u{:04x}", byte);
    else
      out += c;
  }
  return out + "\"";
}

// From no folder: absolute.
std::string from_folder(const std::string& file, const std::filesystem::path& folder) {
  if (folder.empty()) return file.empty() ? "" : std::filesystem::absolute(file).string();
  std::error_code error;
  const auto path = std::filesystem::relative(file, folder, error);
  return error || path.empty() ? std::filesystem::absolute(file).string() : path.string();
}

std::string value_text(const Parameter& p, const ParameterValue& value,
                       const std::filesystem::path& folder) {
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&value))
    return quoted(p.type == ParameterType::kPath ? from_folder(*text, folder) : *text);
  const auto& v = std::get<std::array<double, 3>>(value);
  return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}

// A layer's value, which is text, as TOML has it.
std::string layer_value_text(LayerKey::Kind kind, const std::string& value,
                             const std::filesystem::path& folder) {
  switch (kind) {
    case LayerKey::Kind::kPath:
      return quoted(from_folder(value, folder));
    case LayerKey::Kind::kText:
      return quoted(value);
    case LayerKey::Kind::kFlag:
      return value;
    case LayerKey::Kind::kNumbers:
      break;
  }
  return value.find(',') == std::string::npos ? value : "[" + value + "]";
}

std::string artwork_tables_toml(const std::vector<ArtworkLayer>& layers,
                                const std::filesystem::path& folder) {
  std::string text;
  const std::vector<std::string> usual = layer_values({});
  for (const ArtworkLayer& layer : layers) {
    text += "\n[[artwork]]\n";
    const std::vector<std::string> values = layer_values(layer);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const LayerKey& key = layer_keys()[k];
      if (values[k] != usual[k])
        text += fmt::format("{} = {}\n", key.name, layer_value_text(key.kind, values[k], folder));
    }
  }
  return text;
}

}  // namespace

std::string job_file(const JobConfig& config, const std::filesystem::path& folder,
                     const std::vector<std::string>& of_the_run) {
  std::string text = "# A job for hydrodip: hydrodip print THIS_FILE\n", group;
  if (!config.design.trajectory.path.empty())
    text += fmt::format("path = {}\n", path_text(config.design.trajectory.path));
  for (const Parameter& p : parameters()) {
    const ParameterValue value = p.get(config);
    const bool is_asked_for =
        std::find(of_the_run.begin(), of_the_run.end(), p.name) != of_the_run.end();
    if (p.type == ParameterType::kWayIn || value == p.default_value()) continue;
    if (is_left_out(p) && !is_asked_for) continue;
    const std::size_t dot = p.name.find('.');
    // [dip] and [[dip]] cannot stand in one file: [dips] is what holds for all of them.
    std::string own = p.name.substr(0, dot);
    if (own == "dip" && !config.dips.empty()) own = "dips";
    if (own != group) text += fmt::format("\n[{}]\n", own);
    group = own;
    text += fmt::format("{} = {}\n", p.name.substr(dot + 1), value_text(p, value, folder));
  }
  const auto beside = [&folder](const std::filesystem::path& file) {
    return quoted(from_folder(file.string(), folder));
  };
  return text + artwork_tables_toml(config.object.artwork, folder) +
         dip_tables_toml(config.dips, beside);
}

std::string settings_file(const JobConfig& config, const std::vector<std::string>& names) {
  std::string text, table;
  for (const Parameter& p : parameters()) {
    if (std::find(names.begin(), names.end(), p.name) == names.end()) continue;
    const std::size_t dot = p.name.find('.');
    const std::string own = p.name.substr(0, dot);
    if (own != table) text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", own);
    table = own;
    text += fmt::format("{} = {}\n", p.name.substr(dot + 1), value_text(p, p.get(config), {}));
  }
  return text;
}

}  // namespace hydrodip
