#include "image/resize.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "image/shown_columns.h"
#include "image/to_byte.h"

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

using Premultiplied = std::array<float, 4>;  // linear red, green, blue; and alpha

// A row of the source in the target's columns.
class ReducedRow {
 public:
  ReducedRow(const Image& image, const std::vector<Span>& columns)
      : image_(image), columns_(columns), pixels_(columns.size()) {}

  void reduce(int row) {
    if (row == row_) return;
    row_ = row;
    const Columns seen = shown_columns(image_, row);
    const auto shows = [&](std::size_t x) {
      return columns_[x].first < seen.end && columns_[x].end() > seen.begin;
    };
    begin_ = 0;
    while (begin_ < columns_.size() && !shows(begin_)) ++begin_;
    for (end_ = begin_; end_ < columns_.size() && shows(end_); ++end_)
      pixels_[end_] = mean_of(columns_[end_]);
  }

  void add_to(std::vector<Premultiplied>& sums, float weight) const {
    for (std::size_t x = begin_; x < end_; ++x)
      for (std::size_t k = 0; k < 4; ++k) sums[x][k] += weight * pixels_[x][k];
  }

 private:
  Premultiplied mean_of(const Span& span) const {
    const std::array<float, 256>& decode = srgb8_table();
    float r = 0, g = 0, b = 0, a = 0;
    const std::uint8_t* p = image_.pixel(span.first, row_);
    for (const float share : span.weights) {
      const float weight = share * float(p[3]);
      r += weight * decode[p[0]];
      g += weight * decode[p[1]];
      b += weight * decode[p[2]];
      a += weight;
      p += 4;
    }
    return {r, g, b, a};
  }

  const Image& image_;
  const std::vector<Span>& columns_;
  std::vector<Premultiplied> pixels_;
  std::size_t begin_ = 0, end_ = 0;  // outside of them nothing shows
  int row_ = -1;
};

void store(const Premultiplied& sum, std::uint8_t* out) {
  const float alpha = sum[3];
  if (!(alpha > 0)) return;  // it is blank
  for (std::size_t k = 0; k < 3; ++k) out[k] = linear_to_srgb8(sum[k] / alpha);
  out[3] = to_byte(alpha / 255.0F);
}

}  // namespace

Image resize(const Image& image, int width_px, int height_px) {
  const std::vector<Span> columns = spans(image.width_px, width_px);
  const std::vector<Span> rows = spans(image.height_px, height_px);
  Image result(width_px, height_px);
  parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
    // The last row of one is often the first one of the next.
    ReducedRow reduced(image, columns);
    std::vector<Premultiplied> sums(columns.size());
    for (std::size_t y = begin; y < end; ++y) {
      std::fill(sums.begin(), sums.end(), Premultiplied{});
      for (std::size_t j = 0; j < rows[y].weights.size(); ++j) {
        reduced.reduce(rows[y].first + int(j));
        reduced.add_to(sums, rows[y].weights[j]);
      }
      for (std::size_t x = 0; x < columns.size(); ++x) store(sums[x], result.pixel(int(x), int(y)));
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
