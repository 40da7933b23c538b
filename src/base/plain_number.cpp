#include "base/plain_number.h"

#include <fmt/format.h>

#include <cmath>

#include "base/parse_double.h"

namespace hydrodip {

std::string percent(double share) {
  const double value = 100 * share;
  if (value == 0) return "0 %";
  if (value > 0 && value < 0.1) return "under 0.1 %";
  return value < 9.95 ? fmt::format("{:.1f} %", value) : fmt::format("{:.0f} %", value);
}

std::string plain_number(double value) {
  if (value == 0) return "0";
  if (value > 0 && value < 0.01) return "under 0.01";
  return value < 0.995  ? fmt::format("{:.2f}", value)
         : value < 9.95 ? fmt::format("{:.1f}", value)
                        : fmt::format("{:.0f}", value);
}

std::string three_digits(double value) {
  const double rounded = rounded_to_digits(value, 3);
  if (std::abs(rounded) < 1e-4) return "0";
  return std::abs(rounded) < 1000 ? fmt::format("{:.3g}", rounded) : fmt::format("{:.0f}", rounded);
}

double rounded_to_digits(double value, int digits) {
  const std::string text = fmt::format("{:.{}g}", value, digits);
  double rounded = value;  // stays if it is no number
  parse_double(text.data(), text.data() + text.size(), rounded);
  return rounded;
}

}  // namespace hydrodip
