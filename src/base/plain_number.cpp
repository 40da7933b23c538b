#include "base/plain_number.h"

#include <fmt/format.h>

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

}  // namespace hydrodip
