#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parse_double.h"
#include "sweep/sweep_table.h"

namespace hydrodip {
namespace {

struct PlotFigure {
  const char* name;  // in the table
  const char* title;
};
constexpr PlotFigure kPlots[] = {{"coverage.covered_share", "covered, share"},
                                 {"coverage.torn_mm2", "torn, mm²"},
                                 {"coverage.doubtful_mm2", "doubtful, mm²"},
                                 {"stretch.stretch_max", "largest stretch"},
                                 {"figures.color_difference", "colour error, CIEDE2000"},
                                 {"air.area_mm2", "trapped air, mm²"}};

struct Dot {
  double x = 0, y = 0;
};

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = parse_double(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

// Empty unless every run that has the value has a number, and the figures differ.
std::vector<Dot> dots_of(const SweepTable& table, const std::string& axis, std::size_t figure) {
  std::vector<Dot> dots;
  for (const SweepRow& row : table.rows) {
    if (row.state != RunState::kDone || !row.figures[figure]) continue;
    const auto x = number_of(value_of(*row.run, axis));
    if (!x) return {};
    dots.push_back({*x, *row.figures[figure]});
  }
  if (std::ranges::all_of(dots, [&](const Dot& dot) { return dot.y == dots.front().y; })) return {};
  std::ranges::stable_sort(dots, {}, &Dot::x);
  return dots;
}

// At most so many places from left to right.
std::vector<Dot> means_of(const std::vector<Dot>& dots) {
  constexpr std::size_t kPlaces = 24;
  const std::size_t width = std::max<std::size_t>(1, (dots.size() + kPlaces - 1) / kPlaces);
  std::vector<Dot> means;
  for (std::size_t begin = 0; begin < dots.size();) {
    std::size_t end = std::min(begin + width, dots.size());
    while (end < dots.size() && dots[end].x == dots[end - 1].x) ++end;
    Dot mean;
    for (std::size_t i = begin; i < end; ++i) {
      mean.x += dots[i].x / double(end - begin);
      mean.y += dots[i].y / double(end - begin);
    }
    means.push_back(mean);
    begin = end;
  }
  return means;
}

class ResponsePicture {
 public:
  static constexpr double kPlotWidth = 240, kPlotHeight = 150, kLeft = 64, kTop = 34, kGap = 56;

  void plot(std::size_t column, std::size_t row, const std::string& title, const std::string& axis,
            const std::vector<Dot>& dots) {
    columns_ = std::max(columns_, column + 1);
    rows_ = std::max(rows_, row + 1);
    const double left = kLeft + double(column) * (kPlotWidth + kGap + 8);
    const double top = kTop + double(row) * (kPlotHeight + kGap);
    const auto [least_x, most_x] = limits(dots, &Dot::x);
    const auto [least_y, most_y] = limits(dots, &Dot::y);
    const auto x = [&, lo = least_x, hi = most_x](double value) {
      return left + 6 + (kPlotWidth - 12) * (value - lo) / (hi - lo);
    };
    const auto y = [&, lo = least_y, hi = most_y](double value) {
      return top + kPlotHeight - 6 - (kPlotHeight - 12) * (value - lo) / (hi - lo);
    };
    body_ += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:g}\" height=\"{:g}\" fill=\"#f6f7f9\"/>\n"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"t\">{}</text>\n",
        left, top, kPlotWidth, kPlotHeight, left, top - 8, title);
    for (const Dot& dot : dots)
      body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"/>\n", x(dot.x), y(dot.y));
    body_ += "<polyline points=\"";
    for (const Dot& mean : means_of(dots))
      body_ += fmt::format("{:.1f},{:.1f} ", x(mean.x), y(mean.y));
    body_ += "\"/>\n";
    label(left - 6, y(least_y) + 4, least_y, "e");
    label(left - 6, y(most_y) + 4, most_y, "e");
    label(left + 6, top + kPlotHeight + 15, least_x, "s");
    label(left + kPlotWidth - 6, top + kPlotHeight + 15, most_x, "e");
    body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"m\">{}</text>\n",
                         left + kPlotWidth / 2, top + kPlotHeight + 29, axis);
  }

  std::string svg() const {
    if (columns_ == 0) return "";
    const double width = kLeft + double(columns_) * (kPlotWidth + kGap + 8);
    const double height = kTop + double(rows_) * (kPlotHeight + kGap);
    return fmt::format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" "
               "width=\"{0:g}\" height=\"{1:g}\">\n"
               "<!-- made by hydrodip sweep collect -->\n<style>text{{font:12px sans-serif;"
               "fill:#333}}.t{{font-weight:bold}}.m{{text-anchor:middle}}.e{{text-anchor:end}}"
               "circle{{fill:#2a6f97;fill-opacity:.45}}polyline{{fill:none;stroke:#c1440e;"
               "stroke-width:1.6}}</style>\n<rect width=\"100%\" height=\"100%\" "
               "fill=\"white\"/>\n",
               width, height) +
           body_ + "</svg>\n";
  }

 private:
  static std::pair<double, double> limits(const std::vector<Dot>& dots, double Dot::*of) {
    double least = dots.front().*of, most = least;
    for (const Dot& dot : dots) {
      least = std::min(least, dot.*of);
      most = std::max(most, dot.*of);
    }
    if (most > least) return {least, most};
    const double room = least != 0 ? 0.1 * std::abs(least) : 1;  // all the same
    return {least - room, most + room};
  }

  void label(double x, double y, double value, const char* anchor) {
    body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\">{:.4g}</text>\n", x, y,
                         anchor, value);
  }

  std::string body_;
  std::size_t columns_ = 0, rows_ = 0;
};

}  // namespace

std::string response_svg(const SweepTable& table, const SweepPlan& plan) {
  ResponsePicture picture;
  std::size_t row = 0;
  for (const PlotFigure& plotted : kPlots) {
    const auto found = std::ranges::find(table.figure_names, plotted.name);
    if (found == table.figure_names.end()) continue;
    const auto figure = std::size_t(found - table.figure_names.begin());
    std::size_t column = 0;
    for (const std::string& axis : plan.varied)
      if (const std::vector<Dot> dots = dots_of(table, axis, figure); dots.size() > 1)
        picture.plot(column++, row, plotted.title, axis, dots);
    if (column > 0) ++row;
  }
  return picture.svg();
}

}  // namespace hydrodip
