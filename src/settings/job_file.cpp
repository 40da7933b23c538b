#include "settings/job_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "settings/dip_tables.h"
#include "settings/params.h"

namespace hydrodip {
namespace {

// What belongs to the run or to the machine, not to the job.
bool is_left_out(const Parameter& p) {
  return p.name.starts_with("run.") || p.name.starts_with("stage.") ||
         p.name.starts_with("output.") || p.name == "plan.dips";
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

}  // namespace

std::string job_file(const JobConfig& config, const std::filesystem::path& folder) {
  std::string text = "# A job for hydrodip: hydrodip print THIS_FILE\n", group;
  if (!config.design.trajectory.path.empty())
    text += fmt::format("path = {}\n", path_text(config.design.trajectory.path));
  for (const Parameter& p : parameters()) {
    const ParameterValue value = p.get(config);
    if (p.type == ParameterType::kWayIn || value == p.default_value() || is_left_out(p)) continue;
    const std::size_t dot = p.name.find('.');
    // [dip] and [[dip]] cannot stand in one file: [dips] is what holds for all of them.
    std::string own = p.name.substr(0, dot);
    if (own == "dip" && !config.dips.empty()) own = "dips";
    if (own != group) text += fmt::format("\n[{}]\n", own);
    group = own;
    text += fmt::format("{} = {}\n", p.name.substr(dot + 1), value_text(p, value, folder));
  }
  return text + dip_tables_toml(config.dips);
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
