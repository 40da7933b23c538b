#include "ink/stiffness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace hydrodip {

namespace {

constexpr std::size_t kBandGrain = 64;

// Columns [x0, x1) and rows [y0, y1) of an image.
struct PixelBox {
  int x0, y0, x1, y1;
};

bool is_blank_in(const InkImage& image, const PixelBox& box) {
  const int x0 = std::max(box.x0, 0), x1 = std::min(box.x1, image.width_px);
  const int y0 = std::max(box.y0, 0), y1 = std::min(box.y1, image.height_px);
  if (x0 >= x1) return true;
  for (int y = y0; y < y1; ++y) {
    unsigned laid = 0;
    const std::uint8_t* ink = image.pixel(x0, y);
    for (int k = 0; k < 4 * (x1 - x0); ++k) laid |= ink[k];
    if (laid != 0) return false;
  }
  return true;
}

// Over the pixels around one triangle: S, the density summed over everything left of and above a
// point, and Q, its integral from the left. S is bilinear within a pixel, so both are known
// everywhere from their values at the pixels' corners.
class Sums {
 public:
  // What lies off the image is blank.
  Sums(const InkImage& image, const PixelBox& box)
      : x0_(box.x0), y0_(box.y0), stride_(std::size_t(box.x1 - box.x0) + 1) {
    const std::size_t rows = std::size_t(box.y1 - box.y0) + 1;
    s_.assign(stride_ * rows, 0);
    q_.assign(stride_ * rows, 0);
    for (int y = box.y0; y < box.y1; ++y) {
      const std::size_t above = std::size_t(y - box.y0) * stride_;
      std::int64_t row = 0;
      for (int x = box.x0; x < box.x1; ++x) {
        row += density(image, x, y);
        const std::size_t i = above + std::size_t(x - box.x0) + 1;
        s_[i + stride_] = s_[i] + double(row);
        q_[i + stride_] = q_[i + stride_ - 1] + 0.5 * (s_[i + stride_ - 1] + s_[i + stride_]);
      }
    }
  }

  // Along the straight way from `from` to `to` (in pixels): the integral of Q dy. Between two
  // crossings of pixel edges Q is a cubic of the way, which two Gauss points integrate exactly.
  double along(const Vec2& from, const Vec2& to) const {
    const Vec2 way = to - from;
    if (way.y() == 0) return 0;
    Crossings x(from.x(), way.x()), y(from.y(), way.y());
    double sum = 0, begin = 0;
    while (begin < 1) {
      const double end = std::min({x.next(begin), y.next(begin), 1.0});
      const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
      const Vec2 center = from + middle * way;
      const auto column = int(std::floor(center.x())), row = int(std::floor(center.y()));
      const double offset = half / std::sqrt(3.0);
      sum += half * (q(from + (middle - offset) * way, column, row) +
                     q(from + (middle + offset) * way, column, row));
      begin = end;
    }
    return sum * way.y();
  }

 private:
  static int density(const InkImage& image, int x, int y) {
    if (x < 0 || y < 0 || x >= image.width_px || y >= image.height_px) return 0;
    const std::uint8_t* ink = image.pixel(x, y);
    return ink[0] + ink[1] + ink[2] + ink[3];
  }

  // Where a coordinate that runs linearly over [0, 1] passes whole numbers, in order.
  class Crossings {
   public:
    Crossings(double start, double way) : start_(start), way_(way) {
      line_ = way > 0 ? std::floor(start) + 1 : std::ceil(start) - 1;
    }
    double next(double after) {
      if (way_ == 0) return std::numeric_limits<double>::infinity();
      while (at() <= after) line_ += way_ > 0 ? 1 : -1;
      return at();
    }

   private:
    double at() const { return (line_ - start_) / way_; }
    double start_, way_, line_;
  };

  // Q at a point of the pixel (column, row).
  double q(const Vec2& point, int column, int row) const {
    const double fx = point.x() - column, fy = point.y() - row;
    const std::size_t i = std::size_t(row - y0_) * stride_ + std::size_t(column - x0_);
    const auto on_row = [&](std::size_t j) {
      return q_[j] + fx * (s_[j] + 0.5 * fx * (s_[j + 1] - s_[j]));
    };
    return (1 - fy) * on_row(i) + fy * on_row(i + stride_);
  }

  int x0_, y0_;
  std::size_t stride_;
  std::vector<double> s_, q_;
};

}  // namespace

double mean_density(const InkImage& image, const SheetRaster& raster,
                    const std::array<Vec2, 3>& triangle, double filter_mm) {
  std::array<Vec2, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) corner[k] = raster.to_pixel(triangle[k]);
  const double side = filter_mm * raster.dpi / kMmPerInch, half = 0.5 * side;
  const Vec2 low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]) - Vec2::Constant(half);
  const Vec2 high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]) + Vec2::Constant(half);
  // A pixel more on each side: rounding may put a point just outside.
  const PixelBox box{int(std::floor(low.x())) - 1, int(std::floor(low.y())) - 1,
                     int(std::ceil(high.x())) + 1, int(std::ceil(high.y())) + 1};
  if (is_blank_in(image, box)) return 0;
  const Sums sums(image, box);

  // The mean over the box around a point comes from S at its four corners; the integral of S over
  // the triangle, by Green's theorem, from Q along its edges.
  double total = 0;
  for (const int right : {1, -1})
    for (const int below : {1, -1}) {
      const Vec2 shift(right * half, below * half);
      for (std::size_t k = 0; k < 3; ++k)
        total += right * below * sums.along(corner[k] + shift, corner[(k + 1) % 3] + shift);
    }
  const double area = 0.5 * cross2(corner[1] - corner[0], corner[2] - corner[0]);
  return std::clamp(total / (area * side * side * 255), 0.0, 4.0);
}

std::vector<double> film_modulus(const FilmMesh& film, const InkImage& image,
                                 const SheetRaster& raster, const StiffnessOptions& options) {
  std::vector<double> modulus(film.triangles.size());
  parallel_for(modulus.size(), kBandGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& v = film.triangles[t];
      const double density = mean_density(
          image, raster,
          {film.u[std::size_t(v[0])], film.u[std::size_t(v[1])], film.u[std::size_t(v[2])]},
          options.filter_mm);
      modulus[t] = 1 + density * (options.ratio - 1);
    }
  });
  return modulus;
}

}  // namespace hydrodip
