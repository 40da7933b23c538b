#include "settings/part_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/parse_double.h"
#include "settings/refuse_value.h"
#include "settings/table_key.h"

namespace hydrodip {
namespace {

constexpr int kMostCopies = 100;

PartEntry& numbered(JobConfig& config, std::size_t number, const Setting& setting) {
  if (number > std::min(config.parts.size() + 1, kMostParts))
    throw InputError(fmt::format("{}: {}: the job has {} parts, and at most {}", setting.origin,
                                 setting.name, config.parts.size(), kMostParts));
  if (number > config.parts.size()) config.parts.emplace_back();
  return config.parts[number - 1];
}

int count_of(const Setting& setting) {
  double value = 0;
  if (const auto* number = std::get_if<double>(&setting.value)) value = *number;
  if (const auto* text = std::get_if<std::string>(&setting.value); text && !setting.typed)
    parse_double(text->data(), text->data() + text->size(), value);
  if (!(value >= 1 && value <= kMostCopies && value == std::floor(value)))
    refuse_value(setting, Wanted::kNumber, fmt::format("a whole number from 1 to {}", kMostCopies));
  return int(value);
}

}  // namespace

bool apply_part_setting(JobConfig& config, const Setting& setting) {
  const auto at = table_key("part", setting.name);
  if (!at) return false;
  PartEntry& part = numbered(config, at->number, setting);
  if (at->key == "job") {
    const auto* text = std::get_if<std::string>(&setting.value);
    if (!text || text->empty() || text->find('\0') != std::string::npos)
      refuse_value(setting, Wanted::kOther, "a file name, of a model or a job");
    part.job = *text;
  } else if (at->key == "count") {
    part.count = count_of(setting);
  } else {
    throw InputError(fmt::format("{}: unknown '{}': a part has a job and a count{}", setting.origin,
                                 setting.name, did_you_mean(at->key, {"job", "count"})));
  }
  return true;
}

}  // namespace hydrodip
