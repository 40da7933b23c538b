#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/parse_double.h"
#include "base/text.h"
#include "calibrate/calibrate.h"

namespace hydrodip {
namespace {

constexpr std::size_t kMostValues = 1000;
// A last step that misses the end by rounding still reaches it.
constexpr double kSlack = 1e-6;

bool parse(std::string_view text, double& value) {
  const auto [end, error] = parse_double(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

// To so many digits that 0.1 + 0.2 is 0.3.
double rounded(double value) { return std::round(value * 1e9) / 1e9; }

std::vector<double> stepped(double from, double to, double step) {
  std::vector<double> values;
  for (std::size_t i = 0; i <= kMostValues; ++i) {
    const double value = from + double(i) * step;
    if (value > to + kSlack * step) break;
    values.push_back(rounded(value));
  }
  return values;
}

std::vector<double> multiplied(double from, double to, double factor) {
  std::vector<double> values;
  for (double value = from; value <= to * (1 + kSlack) && values.size() <= kMostValues;
       value *= factor)
    values.push_back(rounded(value));
  return values;
}

}  // namespace

std::vector<double> parse_range(const std::string& text, const std::string& option, double least,
                                double most) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format(
        "{} '{}': {}; give FROM:TO:STEP, FROM:TO:xFACTOR, values with commas, or one value", option,
        text, why));
  };
  std::vector<double> values;
  const std::vector<std::string_view> parts = split(text, ':');
  if (parts.size() == 3) {
    double from = 0, to = 0, step = 0;
    const bool times = !parts[2].empty() && parts[2].front() == 'x';
    if (!parse(parts[0], from) || !parse(parts[1], to) ||
        !parse(times ? parts[2].substr(1) : parts[2], step))
      refuse("not a range of numbers");
    if (!(to >= from)) refuse("it ends before it begins");
    if (times && !(from > 0)) refuse("no factor leads on from there: begin above 0");
    if (!(step > (times ? 1 : 0)))
      refuse(times ? "its factor has to be above 1" : "its step has to be above 0");
    values = times ? multiplied(from, to, step) : stepped(from, to, step);
  } else if (parts.size() == 1) {
    for (const std::string_view part : split(text, ',')) {
      double value = 0;
      if (!parse(part, value)) refuse("not numbers");
      if (!values.empty() && !(value > values.back())) refuse("values have to rise");
      values.push_back(value);
    }
  } else {
    refuse("not a range");
  }
  if (values.size() > kMostValues) refuse("more than a thousand values");
  if (values.front() < least || values.back() > most)
    refuse(fmt::format("its values have to lie between {:g} and {:g}", least, most));
  return values;
}

}  // namespace hydrodip
