#include "model_io/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hydrodip {

void refuse_model(const std::string& path, const std::string& what) {
  throw InputError(fmt::format("{}: {}; export the model again.", path, what));
}

void refuse_line(const std::string& path, long line, const std::string& what) {
  throw InputError(fmt::format("{}, line {}: {}; export the model again.", path, line, what));
}

LinearColor linear_from_srgb(float r, float g, float b, float a) {
  const auto unit = [](float value) {
    return std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 1.0F;
  };
  return {srgb_to_linear(unit(r)), srgb_to_linear(unit(g)), srgb_to_linear(unit(b)), unit(a)};
}

void check_count(const std::string& path, std::size_t count) {
  if (count <= std::size_t(1) << 30) return;
  throw InputError(fmt::format("{}: too many vertices; simplify the model.", path));
}

}  // namespace hydrodip
