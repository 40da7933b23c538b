#include "image/resize.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "image/blank_image.h"
#include "image/shown_columns.h"

namespace hydrodip {
namespace {

// Source pixels [first, first + weights.size()) with their shares of one target pixel.
struct Span {
  int first = 0;
  std::vector<float> weights;  // sum to 1
  int end() const { return first + int(weights.size()); }
};

std::vector<Span> spans(int source, int target) {
  std::vector<Span> list(static_cast<std::size_t>(target));
  const double scale = double(source) / target;
  for (int i = 0; i < target; ++i) {
    const double begin = i * scale, end = (i + 1) * scale;
    Span& span = list[static_cast<std::size_t>(i)];
    span.first = std::min(static_cast<int>(begin), source - 1);
    const int last = std::clamp(static_cast<int>(std::ceil(end)) - 1, span.first, source - 1);
    float sum = 0;
    for (int s = span.first; s <= last; ++s) {
      const double share = std::min(end, s + 1.0) - std::max(begin, double(s));
      span.weights.push_back(static_cast<float>(std::max(share, 1e-9)));
      sum += span.weights.back();
    }
    for (float& weight : span.weights) weight /= sum;
  }
  return list;
}

// Outside of them no row of the span shows anything.
Columns shown(const Image& image, const Span& rows) {
  Columns all{image.width_px, 0};
  for (int y = rows.first; y < rows.end(); ++y) {
    const Columns row = shown_columns(image, y);
    if (!row.empty()) all = {std::min(all.begin, row.begin), std::max(all.end, row.end)};
  }
  return all;
}

void average_into(const Image& image, const Span& columns, const Span& rows, std::uint8_t* out) {
  const std::array<float, 256>& decode = srgb8_table();
  std::array<float, 3> sum{};
  float alpha = 0;
  for (std::size_t j = 0; j < rows.weights.size(); ++j)
    for (std::size_t i = 0; i < columns.weights.size(); ++i) {
      const std::uint8_t* p = image.pixel(columns.first + int(i), rows.first + int(j));
      if (p[3] == 0) continue;
      const float weight = rows.weights[j] * columns.weights[i] * float(p[3]) / 255.0f;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * decode[p[k]];
      alpha += weight;
    }
  for (std::size_t k = 0; k < 3; ++k) out[k] = alpha > 0 ? linear_to_srgb8(sum[k] / alpha) : 0;
  out[3] = static_cast<std::uint8_t>(std::lround(255.0f * std::min(alpha, 1.0f)));
}

}  // namespace

Image resize(const Image& image, int width_px, int height_px) {
  const std::vector<Span> columns = spans(image.width_px, width_px);
  const std::vector<Span> rows = spans(image.height_px, height_px);
  Image result = blank_image(width_px, height_px);
  parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const Columns seen = shown(image, rows[y]);
      for (std::size_t x = 0; x < columns.size(); ++x)
        if (columns[x].first < seen.end && columns[x].end() > seen.begin)
          average_into(image, columns[x], rows[y], result.pixel(int(x), int(y)));
    }
  });
  return result;
}

Image shrink_to(const Image& image, int max_side_px) {
  const int side = std::max(image.width_px, image.height_px);
  if (side <= max_side_px) return image;
  const auto scaled = [&](int length) {
    return std::max(1, static_cast<int>(std::lround(double(length) * max_side_px / side)));
  };
  return resize(image, scaled(image.width_px), scaled(image.height_px));
}

}  // namespace hydrodip
