#include "rig/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hydrodip {
namespace {

constexpr double kWidth = 720, kHeight = 300;
constexpr double kLeft = 56, kRight = 16, kTop = 30, kBottom = 40;

struct Range {
  double min = 1e300, max = -1e300;
  void add(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
  }
  double span() const { return std::max(max - min, 1e-9); }
};

// 1, 2 or 5 times a power of ten, so that about five fit.
double tick_step(double span) {
  const double rough = span / 5;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10 * power;
}

class Plot {
 public:
  Plot(const Trace& trace, bool down_is_plus) : trace_(trace), down_is_plus_(down_is_plus) {
    for (const TracePoint& point : trace) {
      time_.add(point.time_s);
      place_.add(point.commanded_mm);
      place_.add(point.reported_mm);
    }
    const double room = 0.05 * place_.span();
    place_.add(place_.min - room);
    place_.add(place_.max + room);
  }

  std::string draw() {
    svg_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
        "height=\"{1:g}\" font-family=\"sans-serif\" font-size=\"12\">\n"
        "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#fff\"/>\n",
        kWidth, kHeight);
    draw_axes();
    draw_phases();
    draw_curve(&TracePoint::commanded_mm, "#999", 4);
    draw_curve(&TracePoint::reported_mm, "#b3261e", 1.5);
    draw_legend();
    return svg_ + "</svg>\n";
  }

 private:
  double x(double time_s) const {
    return kLeft + (time_s - time_.min) / time_.span() * (kWidth - kLeft - kRight);
  }
  double y(double place_mm) const {
    const double share = (place_mm - place_.min) / place_.span();
    return kTop + (down_is_plus_ ? share : 1 - share) * (kHeight - kTop - kBottom);
  }

  void text(double at_x, double at_y, const char* anchor, const std::string& words,
            const char* color = "#444") {
    svg_ +=
        fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n",
                    at_x, at_y, anchor, color, words);
  }

  void line(double x1, double y1, double x2, double y2, const char* color) {
    svg_ += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1, y1,
        x2, y2, color);
  }

  void draw_axes() {
    const double time_step = tick_step(time_.span()), place_step = tick_step(place_.span());
    for (double t = std::ceil(time_.min / time_step) * time_step; t <= time_.max; t += time_step) {
      line(x(t), kTop, x(t), kHeight - kBottom, "#eee");
      text(x(t), kHeight - kBottom + 16, "middle", fmt::format("{:g}", t + 0.0));
    }
    for (double p = std::ceil(place_.min / place_step) * place_step; p <= place_.max;
         p += place_step) {
      line(kLeft, y(p), kWidth - kRight, y(p), "#eee");
      text(kLeft - 6, y(p) + 4, "end", fmt::format("{:g}", p + 0.0));
    }
    text(kWidth - kRight, kHeight - 8, "end", "time, s");
    text(8, kTop - 12, "start", "position, mm");
  }

  void draw_phases() {
    for (std::size_t i = 0; i < trace_.size(); ++i) {
      if (i > 0 && trace_[i].phase == trace_[i - 1].phase) continue;
      double end_s = trace_[i].time_s;
      for (std::size_t k = i; k < trace_.size() && trace_[k].phase == trace_[i].phase; ++k)
        end_s = trace_[k].time_s;
      if (i > 0) line(x(trace_[i].time_s), kTop, x(trace_[i].time_s), kHeight - kBottom, "#ccc");
      // Names that would run into the next are left to the CSV.
      if (x(end_s) - x(trace_[i].time_s) > 7.0 * double(trace_[i].phase.size()))
        text(x(trace_[i].time_s) + 4, kTop + 12, "start", trace_[i].phase, "#888");
    }
  }

  void draw_curve(double TracePoint::*value, const char* color, double width) {
    svg_ += fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\" points=\"",
                        color, width);
    for (const TracePoint& point : trace_)
      svg_ += fmt::format("{:.1f},{:.1f} ", x(point.time_s), y(point.*value));
    svg_ += "\"/>\n";
  }

  void draw_legend() {
    text(kWidth - kRight - 90, kTop - 12, "end", "commanded", "#777");
    text(kWidth - kRight, kTop - 12, "end", "reported", "#b3261e");
  }

  const Trace& trace_;
  bool down_is_plus_;
  Range time_, place_;
  std::string svg_;
};

}  // namespace

std::optional<SpeedCheck> check_speed(const Trace& trace, const std::string& phase,
                                      double commanded_mm_per_min) {
  Range way;
  std::vector<const TracePoint*> points;
  SpeedCheck check{commanded_mm_per_min};
  for (const TracePoint& point : trace) {
    if (point.phase != phase) continue;
    points.push_back(&point);
    way.add(point.reported_mm);
    check.largest_deviation_mm =
        std::max(check.largest_deviation_mm, std::abs(point.reported_mm - point.commanded_mm));
  }
  double n = 0, t = 0, p = 0, tt = 0, tp = 0;
  for (const TracePoint* point : points) {
    const double share = (point->reported_mm - way.min) / way.span();
    if (share < 0.1 || share > 0.9) continue;
    const double time_s = point->time_s - points.front()->time_s;
    n += 1;
    t += time_s;
    p += point->reported_mm;
    tt += time_s * time_s;
    tp += time_s * point->reported_mm;
  }
  const double spread = n * tt - t * t;
  if (n < 3 || !(spread > 0)) return {};
  check.measured_mm_per_min = 60 * std::abs((n * tp - t * p) / spread);
  return check;
}

std::string trace_csv(const Trace& trace) {
  std::string csv = "phase,time_s,commanded_mm,reported_mm\n";
  for (const TracePoint& point : trace)
    csv += fmt::format("{},{:.4f},{:.6f},{:.6f}\n", point.phase, point.time_s, point.commanded_mm,
                       point.reported_mm);
  return csv;
}

std::string trace_svg(const Trace& trace, bool down_is_plus) {
  return Plot(trace, down_is_plus).draw();
}

}  // namespace hydrodip
