#include "tags/seen_marks.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "tags/apriltag.h"

namespace hydrodip {
namespace {

// Of a checker square's side of kMarkCells / 2 cells: what of it the corner is looked for by.
constexpr double kWindow_cells = 0.35 * kMarkCells;
constexpr double kLeastWindow_px = 3, kMostWindow_px = 14;
// The corner lies where the tag says to within this.
constexpr double kAstray_cells = 1.2;
constexpr int kMostRefinements = 30;
constexpr double kStill_px = 1e-3;
constexpr double kLeastContrast = 18;  // between black and white squares, of 255

Vec2 apply(const Mat3& h, const Vec2& p) { return (h * p.homogeneous()).hnormalized(); }

double bilinear(const GrayImage& image, const Vec2& px) {
  const double x = px.x() - 0.5, y = px.y() - 0.5;
  const double fx = std::floor(x), fy = std::floor(y);
  const int i = int(fx), j = int(fy);
  const double a = x - fx, b = y - fy;
  return (1 - b) * ((1 - a) * image.at(i, j) + a * image.at(i + 1, j)) +
         b * ((1 - a) * image.at(i, j + 1) + a * image.at(i + 1, j + 1));
}

bool holds(const GrayImage& image, const Vec2& px, double reach) {
  return px.allFinite() && px.x() > reach + 2 && px.y() > reach + 2 &&
         px.x() < image.width_px - reach - 2 && px.y() < image.height_px - reach - 2;
}

// Every edge near the corner runs through it: its gradients are at right angles to the way there.
// (Förstner and Gülch, "A fast operator for detection and precise location of distinct points,
// corners and centres of circular features", 1987.) Nothing if the corner runs away.
std::optional<Vec2> refine(const GrayImage& image, Vec2 corner, double window_px) {
  const int reach = int(std::ceil(window_px));
  const Vec2 start = corner;
  for (int turn = 0; turn < kMostRefinements; ++turn) {
    if (!holds(image, corner, reach + 1.0)) return std::nullopt;
    Mat2 sum = Mat2::Zero();
    Vec2 right = Vec2::Zero();
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        const Vec2 from(i, j);
        const double weight = std::exp(-2 * from.squaredNorm() / (window_px * window_px));
        const Vec2 at = corner + from;
        const Vec2 gradient =
            0.5 * Vec2(bilinear(image, at + Vec2::UnitX()) - bilinear(image, at - Vec2::UnitX()),
                       bilinear(image, at + Vec2::UnitY()) - bilinear(image, at - Vec2::UnitY()));
        const Mat2 product = weight * gradient * gradient.transpose();
        sum += product;
        right += product * from;
      }
    if (!(sum.determinant() > 1e-3 * sum.trace() * sum.trace())) return std::nullopt;
    const Vec2 step = sum.inverse() * right;
    corner += step;
    if (!((corner - start).norm() < 1.5 * window_px)) return std::nullopt;
    if (step.norm() < kStill_px) return corner;
  }
  return corner;
}

// Around the corner it has to be dark, light, dark, light, as the tag says where.
bool is_checker(const GrayImage& image, const Mat3& to_px, const Vec2& cells, const Vec2& corner) {
  const Vec2 shift = corner - apply(to_px, cells);
  constexpr double kOut_cells = 0.2 * kMarkCells;
  double dark_most = 0, light_least = 255;
  for (const auto& [x, y, dark] : {std::tuple{-1, -1, true}, std::tuple{1, -1, false},
                                   std::tuple{1, 1, true}, std::tuple{-1, 1, false}}) {
    const Vec2 at = apply(to_px, cells + kOut_cells * Vec2(x, y)) + shift;
    if (!holds(image, at, 1)) return false;
    const double value = bilinear(image, at);
    if (dark)
      dark_most = std::max(dark_most, value);
    else
      light_least = std::min(light_least, value);
  }
  return light_least - dark_most >= kLeastContrast;
}

std::optional<SeenMark> mark_beside(const GrayImage& image, const SeenTag& tag) {
  const Vec2 cells(kMarkCells, 0);
  const Vec2 guess = apply(tag.to_px, cells);
  const double cell_px = (apply(tag.to_px, Vec2(4, 0)) - apply(tag.to_px, Vec2(-4, 0))).norm() / 8;
  const double cell_down_px =
      (apply(tag.to_px, Vec2(0, 4)) - apply(tag.to_px, Vec2(0, -4))).norm() / 8;
  const double window_px =
      std::clamp(kWindow_cells * std::min(cell_px, cell_down_px), kLeastWindow_px, kMostWindow_px);
  const std::optional<Vec2> corner = refine(image, guess, window_px);
  if (!corner || (*corner - guess).norm() > kAstray_cells * std::max(cell_px, cell_down_px) ||
      !is_checker(image, tag.to_px, cells, *corner))
    return std::nullopt;
  return SeenMark{tag.id, *corner, 0.5 * (cell_px + cell_down_px)};
}

}  // namespace

GrayImage gray_of(const Image& image) {
  GrayImage gray{image.width_px, image.height_px, {}};
  gray.value.resize(std::size_t(image.width_px) * std::size_t(image.height_px));
  for (std::size_t i = 0; i < gray.value.size(); ++i) {
    const std::uint8_t* p = image.rgba.data() + 4 * i;
    const int luma = (54 * p[0] + 183 * p[1] + 19 * p[2]) >> 8;
    gray.value[i] = std::uint8_t(255 - ((255 - luma) * p[3] + 127) / 255);
  }
  return gray;
}

GrayImage mirrored(const GrayImage& image) {
  GrayImage result = image;
  for (int y = 0; y < image.height_px; ++y) {
    const auto row = result.value.begin() + std::ptrdiff_t(y) * image.width_px;
    std::reverse(row, row + image.width_px);
  }
  return result;
}

std::vector<SeenMark> find_marks(const GrayImage& image, const RunContext& context) {
  context.check_cancelled();
  std::vector<SeenMark> marks;
  // The library wants room for a tag.
  if (image.width_px < 32 || image.height_px < 32) return marks;
  for (const SeenTag& tag : find_tags(image))
    if (const auto mark = mark_beside(image, tag)) marks.push_back(*mark);
  std::sort(marks.begin(), marks.end(), [](const SeenMark& a, const SeenMark& b) {
    return std::tuple(a.id, a.corner_px.x(), a.corner_px.y()) <
           std::tuple(b.id, b.corner_px.x(), b.corner_px.y());
  });
  context.check_cancelled();
  return marks;
}

}  // namespace hydrodip
