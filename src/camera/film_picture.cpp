#include "camera/film_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace hydrodip {
namespace {

// Light and water change a photo from here to there: what is compared are details of that size.
constexpr double kCell_mm = 1;
constexpr int kAround = 8;
// Of what is seen around a place, for it to be of use, in levels of 255.
constexpr double kLeastContrast = 8;
constexpr std::size_t kLeastCells = 400;
constexpr double kLeastSeen = 0.5;

// Means of brightness over cells of the free film.
struct Cells {
  int columns, rows;
  std::vector<double> sum, count;

  Cells(int wide, int high)
      : columns(wide), rows(high), sum(std::size_t(wide) * std::size_t(high)), count(sum.size()) {}

  std::size_t at(int column, int row) const {
    return std::size_t(row) * std::size_t(columns) + std::size_t(column);
  }
  // From the free film's corner.
  void add(const Vec2& mm, double value) {
    const double column = std::floor(mm.x() / kCell_mm), row = std::floor(mm.y() / kCell_mm);
    if (!(column >= 0 && row >= 0 && column < columns && row < rows)) return;
    const std::size_t cell = at(int(column), int(row));
    sum[cell] += value;
    ++count[cell];
  }
  double mean(std::size_t cell) const { return sum[cell] / count[cell]; }
};

Cells cells_of_picture(const FilmPicture& picture, int columns, int rows) {
  Cells cells(columns, rows);
  const Vec2 mm_per_px(picture.width_mm / picture.gray.width_px,
                       picture.height_mm / picture.gray.height_px);
  for (int y = 0; y < picture.gray.height_px; ++y)
    for (int x = 0; x < picture.gray.width_px; ++x)
      cells.add(Vec2((x + 0.5) * mm_per_px.x(), picture.height_mm - (y + 0.5) * mm_per_px.y()) -
                    Vec2::Constant(picture.margin_mm),
                picture.gray.at(x, y));
  return cells;
}

// Some pixels of each cell.
Cells cells_of_photo(const GrayImage& photo, const FilmPose& pose, const Tank& tank,
                     const FilmPicture& picture, int columns, int rows) {
  Cells cells(columns, rows);
  const double turn = pose.turn_deg * std::numbers::pi / 180;
  const double place_turn = tank.place.turn_deg * std::numbers::pi / 180;
  const Eigen::Rotation2Dd back(-turn), place_back(-place_turn);
  const Vec2 corner =
      0.5 * Vec2(picture.width_mm, picture.height_mm) - Vec2::Constant(picture.margin_mm);
  const auto on_sheet = [&](const Vec2& px) -> Vec2 {
    const Vec2 on_water = View::on_water(pose.view.values, px);
    const Vec2 from_place = place_back * (on_water - tank.place.middle_mm);
    return (back * (from_place - pose.shift_mm)).cwiseQuotient(pose.swelling);
  };
  const Vec2 middle(0.5 * photo.width_px, 0.5 * photo.height_px);
  const double px_mm = (on_sheet(middle + Vec2(1, 0)) - on_sheet(middle)).norm();
  const int step = std::max(1, int(kCell_mm / (3 * std::max(px_mm, 1e-3))));
  for (int y = step / 2; y < photo.height_px; y += step)
    for (int x = step / 2; x < photo.width_px; x += step) {
      const Vec2 at = on_sheet(Vec2(x + 0.5, y + 0.5));
      if (at.allFinite()) cells.add(at + corner, photo.at(x, y));
    }
  return cells;
}

// Of a picture and of a photo, what goes together where both are seen.
struct Moments {
  double n = 0, p = 0, q = 0, pp = 0, qq = 0, pq = 0;

  void add(double picture, double photo) {
    ++n;
    p += picture;
    q += photo;
    pp += picture * picture;
    qq += photo * photo;
    pq += picture * photo;
  }
  double picture_variance() const { return pp / n - p / n * (p / n); }
};

}  // namespace

std::optional<double> film_likeness(const GrayImage& photo, const FilmPose& pose, const Tank& tank,
                                    const FilmPicture& picture) {
  const int columns = int((picture.width_mm - 2 * picture.margin_mm) / kCell_mm);
  const int rows = int((picture.height_mm - 2 * picture.margin_mm) / kCell_mm);
  if (columns <= 0 || rows <= 0) return std::nullopt;
  const Cells printed = cells_of_picture(picture, columns, rows);
  const Cells seen = cells_of_photo(photo, pose, tank, picture, columns, rows);
  std::size_t telling = 0, compared = 0;
  Moments all;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const std::size_t cell = seen.at(column, row);
      if (printed.count[cell] == 0) continue;
      Moments around, both;
      for (int j = std::max(0, row - kAround); j <= std::min(rows - 1, row + kAround); ++j)
        for (int i = std::max(0, column - kAround); i <= std::min(columns - 1, column + kAround);
             ++i) {
          const std::size_t other = seen.at(i, j);
          if (printed.count[other] == 0) continue;
          around.add(printed.mean(other), 0);
          if (seen.count[other] > 0) both.add(printed.mean(other), seen.mean(other));
        }
      if (around.picture_variance() < kLeastContrast * kLeastContrast) continue;
      ++telling;
      if (seen.count[cell] == 0) continue;
      ++compared;
      all.add(printed.mean(cell) - both.p / both.n, seen.mean(cell) - both.q / both.n);
    }
  if (telling < kLeastCells || double(compared) < kLeastSeen * double(telling)) return std::nullopt;
  if (!(all.pp > 0)) return std::nullopt;
  // A photo in which nothing is to be seen there shows another film.
  return all.qq > 0 ? all.pq / std::sqrt(all.pp * all.qq) : 0;
}

}  // namespace hydrodip
