#include "sweep/sweep_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "settings/params.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = SweepFile::Json;

// Values that a parameter takes: a list, or a range.
struct SweepAxis {
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

SweepAxis read_axis(const SweepFile& file, const std::string& name, const Json& value,
                    const fs::path& folder) {
  const Parameter& parameter = find_parameter(name, "[vary]");
  SweepAxis axis;
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

std::vector<SweepAxis> read_axes(const SweepFile& file, const fs::path& folder) {
  const SweepFile::Entries held = file.entries(file.table("set"));
  std::vector<SweepAxis> axes;
  for (const auto& [name, value] : file.entries(file.table("vary"))) {
    if (has_entry(held, name))
      file.refuse(fmt::format(
          "{} stands under [set], which holds for all runs, and under [vary]: leave out one of "
          "them",
          name));
    axes.push_back(read_axis(file, name, value, folder));
  }
  return axes;
}

// A latin hypercube's ranges have as many values as there are runs.
std::vector<SweepAxis> read_latin_axes(const SweepFile& file, const fs::path& folder) {
  std::vector<SweepAxis> axes = read_axes(file, folder);
  for (const SweepAxis& axis : axes)
    if (axis.count > 0)
      file.refuse(fmt::format(
          "vary.{}: with method = \"latin\", runs under [sweep] says how many; leave out count",
          axis.name));
  return axes;
}

// Uniform in [0, 1), the same on every machine.
double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1p-53; }

}  // namespace

std::vector<RunValues> grid_runs(const SweepFile& file, const fs::path& folder,
                                 const RunContext& context) {
  std::vector<SweepAxis> axes = read_axes(file, folder);
  double runs = 1;
  for (SweepAxis& axis : axes) {
    if (axis.is_range()) {
      if (axis.count < 2)
        file.refuse(fmt::format("vary.{}: say how many values, as in count = 5", axis.name));
      for (int i = 0; i < axis.count; ++i)
        axis.list.push_back(axis.at(double(i) / double(axis.count - 1)));
      axis.list.erase(std::unique(axis.list.begin(), axis.list.end()), axis.list.end());
    }
    runs *= double(axis.list.size());
    file.require_few_enough(runs);
  }
  std::vector<RunValues> all = {{}};
  for (const SweepAxis& axis : axes) {
    std::vector<RunValues> longer;
    for (const RunValues& values : all)
      for (const std::string& value : axis.list) {
        context.check_cancelled();
        longer.push_back(values);
        longer.back().emplace_back(axis.name, value);
      }
    all = std::move(longer);
  }
  return all;
}

std::vector<RunValues> latin_runs(const SweepFile& file, const fs::path& folder, std::size_t runs,
                                  std::uint64_t seed) {
  const std::vector<SweepAxis> axes = read_latin_axes(file, folder);
  std::vector<RunValues> all(runs);
  std::mt19937_64 random(seed);
  for (const SweepAxis& axis : axes) {
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

}  // namespace hydrodip
