#include "calibrate/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/plain_number.h"
#include "render/canvas.h"
#include "render/color_ramp.h"

namespace hydrodip {
namespace {

constexpr int kMargin = 36, kGap = 40, kHeader = 64, kFooter = 70;
constexpr int kSurfacePanel = 560, kMapPanel = 500;
constexpr LinearColor kUnknown{0.55f, 0.55f, 0.55f, 1};
constexpr LinearColor kMark{0.75f, 0.0f, 0.05f, 1};
constexpr LinearColor kWhite{1, 1, 1, 1};

const ColorRamp& surface_ramp() {
  static const ColorRamp ramp({0.94, 0.09, 140}, {0.70, 0.11, 205}, {0.33, 0.12, 280});
  return ramp;
}

const ColorRamp& error_ramp() {
  static const ColorRamp ramp({0.80, 0.04, 230}, {0.66, 0.17, 60}, {0.38, 0.16, 15});
  return ramp;
}

// ---- the error over the parameters ----

struct Axis {
  std::string name;
  std::vector<double> values;
  std::size_t nearest(double value) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < values.size(); ++i)
      if (std::abs(values[i] - value) < std::abs(values[best] - value)) best = i;
    return best;
  }
};

double value_of(const FilmParameters& parameters, int axis) {
  return axis == 0   ? parameters.z_stretch
         : axis == 1 ? parameters.stiffness_ratio
                     : parameters.poisson;
}

// Least error over the third parameter; NaN where no dip is comparable.
std::vector<double> profile(const std::vector<GridPointError>& grid,
                            const std::array<Axis, 3>& axes, int x, int y) {
  const std::size_t width = axes[std::size_t(x)].values.size();
  std::vector<double> least(width * axes[std::size_t(y)].values.size(),
                            std::numeric_limits<double>::quiet_NaN());
  for (const GridPointError& point : grid) {
    if (std::isnan(point.all_mm)) continue;
    const std::size_t i = axes[std::size_t(x)].nearest(value_of(point.parameters, x));
    const std::size_t j = axes[std::size_t(y)].nearest(value_of(point.parameters, y));
    double& cell = least[j * width + i];
    if (!(cell <= point.all_mm)) cell = point.all_mm;
  }
  return least;
}

void outline(Image& page, int x0, int y0, int x1, int y1, int thick, const LinearColor& color) {
  fill(page, x0, y0, x1, y0 + thick, color);
  fill(page, x0, y1 - thick, x1, y1, color);
  fill(page, x0, y0, x0 + thick, y1, color);
  fill(page, x1 - thick, y0, x1, y1, color);
}

// One heat map with its figures; (left, top) is the panel's corner.
void draw_surface(Image& page, int left, int top, const std::array<Axis, 3>& axes, int x, int y,
                  const std::vector<double>& cells, const FilmParameters& answer) {
  constexpr int kAxis = 88;
  const Axis &across = axes[std::size_t(x)], &up = axes[std::size_t(y)];
  const int width = int(across.values.size()), height = int(up.values.size());
  const int x0 = left + kAxis, y1 = top + kSurfacePanel - kAxis;
  const double cell_w = double(kSurfacePanel - kAxis) / width;
  const double cell_h = double(kSurfacePanel - kAxis) / height;
  double low = 1e300, high = 0;
  for (const double v : cells)
    if (!std::isnan(v)) low = std::min(low, v), high = std::max(high, v);
  const auto column = [&](int i) { return x0 + int(std::lround(i * cell_w)); };
  const auto row = [&](int j) { return y1 - int(std::lround(j * cell_h)); };
  const double size = std::clamp(std::min(cell_w / 5.5, cell_h / 2.2), 5.0, 17.0);
  int best = 0;
  for (int k = 0; k < width * height; ++k)
    if (cells[std::size_t(k)] < cells[std::size_t(best)] || std::isnan(cells[std::size_t(best)]))
      best = k;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const double v = cells[std::size_t(j * width + i)];
      // Even steps of colour for even factors: the valley's floor is what matters.
      const double t = high > low ? std::log(v / low) / std::log(high / low) : 0;
      fill(page, column(i), row(j + 1), column(i + 1), row(j),
           std::isnan(v) ? kUnknown : surface_ramp().at(t));
      if (!std::isnan(v) && size >= 7)
        draw_centered(page, fmt::format("{:.3f}", v), 0.5 * (column(i) + column(i + 1)),
                      0.5 * (row(j) + row(j + 1)) + 0.5 * size,
                      text_style(size, t > 0.55 ? kWhite : kTitleInk));
    }
  const int bi = best % width, bj = best / width;
  outline(page, column(bi), row(bj + 1), column(bi + 1), row(bj), 3, kMark);
  for (int i = 0; i < width; ++i)
    draw_centered(page, fmt::format("{:g}", across.values[std::size_t(i)]),
                  0.5 * (column(i) + column(i + 1)), y1 + 26, text_style(13, kLabelInk));
  for (int j = 0; j < height; ++j) {
    const std::string label = fmt::format("{:g}", up.values[std::size_t(j)]);
    draw_text(page, label, x0 - 10 - text_width_px(label, text_style(13, kLabelInk)),
              0.5 * (row(j) + row(j + 1)) + 6, text_style(13, kLabelInk));
  }
  draw_centered(page, across.name + ", found " + three_digits(value_of(answer, x)),
                0.5 * (x0 + left + kSurfacePanel), y1 + 60, text_style(16, kTitleInk));
  draw_text(page, up.name + ", found " + three_digits(value_of(answer, y)), left + 4, top - 14,
            text_style(16, kTitleInk));
}

// ---- how well pairs of parameters are known ----

constexpr const char* kAxisNames[3] = {"z_stretch", "ink_stiffness_ratio", "poisson"};
// Of the distance in joint_distance, for two parameters.
constexpr double kHalf = 1.177, kNearlyAll = 2.448;

// A fitted parameter along an axis of the picture: as the film's parameter grows, from 0 to 1.
struct Along {
  double low = 0, high = 0;  // fitted
  bool falls = false;        // as the film's parameter grows
  double at(double share) const { return low + (falls ? 1 - share : share) * (high - low); }
  double share_of(double value) const {
    const double share = (value - low) / (high - low);
    return falls ? 1 - share : share;
  }
};

// The 95 % interval of one parameter, as the fit has it.
std::pair<double, double> fitted_interval(const Certainty& certainty, int k) {
  const double a = to_fit(certainty.low)[k], b = to_fit(certainty.high)[k];
  return {std::min(a, b), std::max(a, b)};
}

// Wide enough for both regions and the interval, and not beyond what a film can be.
Along along(const Answer& answer, int k) {
  const double deviation = std::sqrt(answer.certainty.covariance(k, k));
  const double middle = answer.fit.point[k];
  const auto [low, high] = fitted_interval(answer.certainty, k);
  const double far = std::max({3.5 * deviation, 1.1 * (middle - low), 1.1 * (high - middle)});
  // Ink does not soften film, and Poisson's ratio is a material's.
  constexpr std::array<double, 3> kMost = {1e300, 1, 0.5};
  return {std::max(0.0, middle - far), std::min(kMost[std::size_t(k)], middle + far), k == 1};
}

// The film's own figure for a fitted one.
std::string label_of(int k, double value) {
  if (k != 1) return fmt::format("{:.4g}", value);
  return value > 0 ? three_digits(1 / (value * value)) : "no end";
}

void draw_region(Image& page, int left, int top, const Answer& answer, int x, int y) {
  constexpr int kAxis = 88, kSide = kSurfacePanel - kAxis, kCell = 6, kBar = 5;
  const Along across = along(answer, x), up = along(answer, y);
  const int x0 = left + kAxis, y1 = top + kSide;
  for (int i = 0; i < kSide; i += kCell)
    for (int j = 0; j < kSide; j += kCell) {
      const double distance =
          joint_distance(answer.fit, answer.certainty.noise_mm, x,
                         across.at((i + 0.5 * kCell) / kSide), y, up.at((j + 0.5 * kCell) / kSide));
      const double t = distance <= kHalf ? 1 : distance <= kNearlyAll ? 0.5 : 0.02;
      fill(page, x0 + i, y1 - j - kCell, x0 + i + kCell, y1 - j, surface_ramp().at(t));
    }
  const auto column = [&](double share) { return x0 + int(std::lround(kSide * share)); };
  const auto row = [&](double share) { return y1 - int(std::lround(kSide * share)); };
  const int mark_x = column(across.share_of(answer.fit.point[x]));
  const int mark_y = row(up.share_of(answer.fit.point[y]));
  fill(page, mark_x - 7, mark_y - 1, mark_x + 8, mark_y + 2, kMark);
  fill(page, mark_x - 1, mark_y - 7, mark_x + 2, mark_y + 8, kMark);
  // The intervals, beside the axes.
  const auto ends = [&](const Along& axis, int k) {
    const auto [low, high] = fitted_interval(answer.certainty, k);
    const double a = std::clamp(axis.share_of(low), 0.0, 1.0);
    const double b = std::clamp(axis.share_of(high), 0.0, 1.0);
    return std::pair(std::min(a, b), std::max(a, b));
  };
  const auto [from_x, to_x] = ends(across, x);
  const auto [from_y, to_y] = ends(up, y);
  fill(page, column(from_x), y1 + 3, column(to_x), y1 + 3 + kBar, kMark);
  fill(page, x0 - 3 - kBar, row(to_y), x0 - 3, row(from_y), kMark);
  for (const double share : {0.0, 0.5, 1.0}) {
    draw_centered(page, label_of(x, across.at(share)), column(share), y1 + 30,
                  text_style(13, kLabelInk));
    const std::string text = label_of(y, up.at(share));
    draw_text(page, text, x0 - 14 - text_width_px(text, text_style(13, kLabelInk)), row(share) + 6,
              text_style(13, kLabelInk));
  }
  draw_centered(page, kAxisNames[x], x0 + 0.5 * kSide, y1 + 60, text_style(16, kTitleInk));
  draw_text(page, kAxisNames[y], left + 4, top - 14, text_style(16, kTitleInk));
}

// ---- the error over the film ----

void blend(Image& page, int x, int y, double coverage, const LinearColor& color) {
  std::uint8_t* p = page.pixel(x, y);
  const float c = float(coverage);
  const float mixed[3] = {color.r, color.g, color.b};
  for (int k = 0; k < 3; ++k)
    p[k] = linear_to_srgb8((1 - c) * srgb8_to_linear(p[k]) + c * mixed[k]);
}

// A round-ended line, antialiased.
void draw_line(Image& page, const Vec2& from, const Vec2& to, double width_px,
               const LinearColor& color) {
  const double half = 0.5 * width_px;
  const Vec2 way = to - from;
  const double squared = way.squaredNorm();
  const Vec2 low = from.cwiseMin(to) - Vec2::Constant(half + 1);
  const Vec2 high = from.cwiseMax(to) + Vec2::Constant(half + 1);
  for (int y = std::max(0, int(low.y())); y <= std::min(page.height_px - 1, int(high.y())); ++y)
    for (int x = std::max(0, int(low.x())); x <= std::min(page.width_px - 1, int(high.x())); ++x) {
      const Vec2 p(x + 0.5, y + 0.5);
      const double t = squared > 0 ? std::clamp((p - from).dot(way) / squared, 0.0, 1.0) : 0;
      const double distance = (p - from - t * way).norm();
      const double coverage = std::clamp(half - distance + 0.5, 0.0, 1.0);
      if (coverage > 0) blend(page, x, y, coverage, color);
    }
}

Box2 bounds_of(const std::vector<std::vector<ErrorMap>>& rows) {
  Box2 box;
  for (const auto& row : rows)
    for (const ErrorMap& map : row)
      for (const auto& corner : map.warped)
        if (corner) box.add(*corner);
  return box;
}

// The end of the scale: a round figure that nearly all errors stay below.
double scale_end_mm(const std::vector<std::vector<ErrorMap>>& rows) {
  std::vector<double> errors;
  for (const auto& row : rows)
    for (const ErrorMap& map : row)
      for (const LengthError& error : map.errors) errors.push_back(std::abs(error.error_mm));
  if (errors.empty()) return 1;
  const auto at = errors.begin() + std::ptrdiff_t(0.98 * double(errors.size() - 1));
  std::nth_element(errors.begin(), at, errors.end());
  const double most = std::max(*at, 1e-4);
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double step : {1.0, 2.0, 5.0, 10.0})
    if (most <= step * power) return step * power;
  return 10 * power;
}

void draw_map(Image& page, int left, int top, const ErrorMap& map, const Box2& box, double end_mm) {
  const Vec2 size = (box.max - box.min).cwiseMax(1e-3);
  const double px_per_mm = (kMapPanel - 20) / size.maxCoeff();
  const Vec2 middle = 0.5 * (box.min + box.max);
  const auto pixel = [&](const Vec2& u) {
    const Vec2 d = px_per_mm * (u - middle);
    return Vec2(left + 0.5 * kMapPanel + d.x(), top + 0.5 * kMapPanel - d.y());
  };
  for (const bool diagonal : {true, false})
    for (const LengthError& error : map.errors) {
      if (error.length.diagonal != diagonal) continue;
      draw_line(page, pixel(*map.warped[std::size_t(error.length.from)]),
                pixel(*map.warped[std::size_t(error.length.to)]), diagonal ? 1.6 : 4.5,
                error_ramp().at(std::abs(error.error_mm) / end_mm));
    }
  draw_centered(page, map.title, left + 0.5 * kMapPanel, top - 16, text_style(19, kTitleInk));
  draw_centered(page, map.figure, left + 0.5 * kMapPanel, top + kMapPanel + 26,
                text_style(15, kLabelInk));
}

void draw_scale(Image& page, int y, double end_mm) {
  const int width = std::min(500, page.width_px - 2 * kMargin), x0 = (page.width_px - width) / 2;
  for (int x = 0; x < width; ++x)
    fill(page, x0 + x, y, x0 + x + 1, y + 22, error_ramp().at((x + 0.5) / width));
  for (int k = 0; k <= 4; ++k)
    draw_centered(page, fmt::format("{:g}", 0.25 * k * end_mm), x0 + 0.25 * k * width, y + 46,
                  text_style(14, kLabelInk));
  draw_centered(page, "error of a length on the film, mm (thick: edges, thin: diagonals)",
                0.5 * page.width_px, y - 12, text_style(15, kLabelInk));
}

}  // namespace

Image draw_error_surface(const GridSearchOptions& options, const std::vector<GridPointError>& grid,
                         const FilmParameters& answer, const std::string& caption) {
  const std::array<Axis, 3> axes = {{{"z_stretch", options.z_stretch},
                                     {"ink_stiffness_ratio", options.stiffness_ratio},
                                     {"poisson", options.poisson}}};
  Image page = blank_page(2 * kMargin + 3 * kSurfacePanel + 2 * kGap,
                          kHeader + 30 + kSurfacePanel + kFooter);
  draw_centered(page, "Eq. 4 of all scans, mm: over two parameters, the third at its best",
                0.5 * page.width_px, 40, text_style(22, kTitleInk));
  int left = kMargin;
  for (const auto& [x, y] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
    draw_surface(page, left, kHeader + 30, axes, x, y, profile(grid, axes, x, y), answer);
    left += kSurfacePanel + kGap;
  }
  const TextStyle small = text_style(15, kLabelInk);
  draw_centered(page, fit_text(caption, small, page.width_px - 2.0 * kMargin), 0.5 * page.width_px,
                page.height_px - 24, small);
  return page;
}

Image draw_joint_regions(const Answer& answer, const std::string& caption) {
  std::vector<std::pair<int, int>> pairs;
  for (const auto& pair : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
    if (answer.certainty.covariance(pair.first, pair.first) > 0 &&
        answer.certainty.covariance(pair.second, pair.second) > 0)
      pairs.push_back(pair);
  const int panels = std::max(1, int(pairs.size()));
  Image page = blank_page(2 * kMargin + panels * (kSurfacePanel + kGap) - kGap,
                          kHeader + 30 + kSurfacePanel + kFooter);
  draw_centered(page,
                pairs.empty()
                    ? "Fewer than two parameters were looked for"
                    : "Where two parameters can be together, by noise alone: dark 50 %, blue 95 %",
                0.5 * page.width_px, 40, text_style(22, kTitleInk));
  int left = kMargin;
  for (const auto& [x, y] : pairs) {
    draw_region(page, left, kHeader + 30, answer, x, y);
    left += kSurfacePanel + kGap;
  }
  const TextStyle small = text_style(15, kLabelInk);
  const std::string words =
      "Red bars: 95 % of each by itself, with what simulations add. " + caption;
  draw_centered(page, fit_text(words, small, page.width_px - 2.0 * kMargin), 0.5 * page.width_px,
                page.height_px - 24, small);
  return page;
}

Image draw_error_maps(const std::vector<std::vector<ErrorMap>>& rows, const std::string& caption) {
  std::size_t columns = 1;
  for (const auto& row : rows) columns = std::max(columns, row.size());
  constexpr int kRow = kMapPanel + 90, kScale = 110;
  Image page = blank_page(2 * kMargin + int(columns) * (kMapPanel + kGap) - kGap,
                          30 + int(rows.size()) * kRow + kScale + kFooter);
  const double end_mm = scale_end_mm(rows);
  const Box2 box = bounds_of(rows);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < rows[r].size() && !box.empty(); ++c)
      draw_map(page, kMargin + int(c) * (kMapPanel + kGap), 60 + int(r) * kRow, rows[r][c], box,
               end_mm);
  draw_scale(page, 30 + int(rows.size()) * kRow + 34, end_mm);
  const TextStyle small = text_style(15, kLabelInk);
  draw_centered(page, fit_text(caption, small, page.width_px - 2.0 * kMargin), 0.5 * page.width_px,
                page.height_px - 24, small);
  return page;
}

}  // namespace hydrodip
