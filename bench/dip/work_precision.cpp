// Error against time: the paper's scheme and the default one, on the shapes whose dip is exactly
// known. Prints the table of docs/accuracy.md and draws its plot.
//
//   bench_work_precision [PLOT.svg [LARGEST_MESH]]

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "dip/dip.h"
#include "exact/shapes.h"
#include "exact/solutions.h"
#include "settings/config.h"
#include "settings/settings.h"

namespace hydrodip {
namespace {

constexpr double kDiscRadius = 100, kZStretch = 0.65, kFrom = 3, kTo = 28;

struct Case {
  std::string name;
  shapes::Shape shape;
  std::function<double(double)> tan_theta;
};

std::vector<Case> cases() {
  return {{"sphere", shapes::sphere_bowl(30, 28.6),
           [](double a) { return a / std::sqrt(900 - a * a); }},
          {"cone", shapes::cone(29, 1), [](double) { return 1.0; }}};
}

// u_a at evenly spaced radii, for linear interpolation: the exact solution is costly.
class ExactTable {
 public:
  explicit ExactTable(const Case& c) {
    for (int i = 0; i <= kSamples; ++i)
      u_.push_back(exact::revolution(radius(i), kDiscRadius, kZStretch, c.tan_theta));
  }
  double operator()(double a) const {
    const double at = (a - kFrom) / (kTo - kFrom) * kSamples;
    const int i = std::clamp(static_cast<int>(at), 0, kSamples - 1);
    return u_[std::size_t(i)] + (at - i) * (u_[std::size_t(i) + 1] - u_[std::size_t(i)]);
  }

 private:
  static constexpr int kSamples = 2500;  // error of the interpolation: below 1e-5 mm
  static double radius(int i) { return kFrom + (kTo - kFrom) * i / kSamples; }
  std::vector<double> u_;
};

struct Result {
  std::string shape, scheme;
  std::size_t triangles = 0;
  int steps = 0;
  long iterations = 0;  // of all relaxations
  double seconds = 0;
  // |u_a - exact|, mm: largest and mean over all vertices between kFrom and kTo; mean with its sign
  // over the last millimetre.
  double worst = 0, mean = 0, at_end = 0;
};

Result measure(const Case& c, const ExactTable& exact, DipScheme scheme, int elements,
               double step_mm = DipOptions{}.step_mm) {
  FilmOptions options{.width_mm = 220, .height_mm = 220, .shape = FilmShape::kDisc};
  options.elements = elements;
  if (scheme == DipScheme::kPaper) options.grading = 1;
  const FilmMesh film = make_film_mesh(options);
  const Surface surface(c.shape.positions, c.shape.triangles);
  DipOptions dip_options;
  dip_options.scheme = scheme;
  dip_options.step_mm = step_mm;
  dip_options.material.tear_stretch = 0;
  RunContext context;
  const auto start = std::chrono::steady_clock::now();
  const DipResult result = dip(film, c.shape.positions, c.shape.triangles, surface,
                               make_trajectory({}, c.shape.positions), dip_options, context);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  Result r{c.name, scheme == DipScheme::kPaper ? "paper" : "contact-line", film.triangles.size()};
  r.steps = result.statistics.steps;
  r.iterations = result.statistics.iterations;
  r.seconds = seconds;
  double count = 0, count_at_end = 0;
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    const double a = result.film.position[v].head<2>().norm();
    if (result.film.state[v] != VertexState::kAttached || a < kFrom || a > kTo) continue;
    const double error = film.u[v].norm() - exact(a);
    r.worst = std::max(r.worst, std::abs(error));
    r.mean += std::abs(error);
    ++count;
    if (a < kTo - 1) continue;
    r.at_end += error;
    ++count_at_end;
  }
  r.mean /= count;
  r.at_end /= count_at_end;
  return r;
}

void print_header() {
  fmt::print(
      "| shape | scheme | triangles | time (s) | ms a step | iterations a step | largest (mm) | "
      "mean (mm) | mean at {:g} to {:g} mm |\n|---|---|---|---|---|---|---|---|---|\n",
      kTo - 1, kTo);
}

void print_row(const Result& r) {
  fmt::print("| {} | {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.4f} | {:.4f} | {:+.4f} |\n", r.shape,
             r.scheme, r.triangles, r.seconds, 1e3 * r.seconds / r.steps,
             double(r.iterations) / r.steps, r.worst, r.mean, r.at_end);
  std::fflush(stdout);
}

// ---- the plot: error against time, both axes logarithmic ----

struct Axis {
  double from, to;    // decades (log10)
  double start, end;  // pixels
  double at(double value) const {
    return start + (std::log10(value) - from) / (to - from) * (end - start);
  }
};

Axis axis_over(const std::vector<double>& values, double start, double end) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {std::floor(std::log10(*low)), std::ceil(std::log10(*high)), start, end};
}

std::string plot(const std::vector<Result>& results) {
  std::vector<double> seconds, errors;
  for (const Result& r : results) {
    seconds.push_back(r.seconds);
    errors.push_back(r.worst);
  }
  const Axis x = axis_over(seconds, 80, 600), y = axis_over(errors, 340, 30);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"830\" height=\"400\" "
      "font-family=\"sans-serif\" font-size=\"13\">\n"
      "<rect width=\"830\" height=\"400\" fill=\"#ffffff\"/>\n";
  const auto grid_line = [&](double x1, double y1, double x2, double y2) {
    svg += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#d8d8d8\"/>\n", x1,
        y1, x2, y2);
  };
  const auto text = [&](double tx, double ty, const char* anchor, const std::string& what) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", tx, ty,
                       anchor, what);
  };
  for (int d = static_cast<int>(x.from); d <= static_cast<int>(x.to); ++d) {
    grid_line(x.at(std::pow(10, d)), y.start, x.at(std::pow(10, d)), y.end);
    text(x.at(std::pow(10, d)), y.start + 20, "middle", fmt::format("{:g} s", std::pow(10, d)));
  }
  for (int d = static_cast<int>(y.from); d <= static_cast<int>(y.to); ++d) {
    grid_line(x.start, y.at(std::pow(10, d)), x.end, y.at(std::pow(10, d)));
    text(x.start - 8, y.at(std::pow(10, d)) + 4, "end", fmt::format("{:g} mm", std::pow(10, d)));
  }
  text(0.5 * (x.start + x.end), 388, "middle", "time of the whole dip");
  text(x.start, 18, "start", "largest error of the film coordinate, 3 mm to 28 mm from the axis");
  double legend = 60;
  for (const char* scheme : {"paper", "contact-line"})
    for (const char* shape : {"sphere", "cone"}) {
      const char* color = std::string(scheme) == "paper" ? "#b35806" : "#2166ac";
      const char* dash = std::string(shape) == "cone" ? "6 4" : "none";
      std::string points;
      for (const Result& r : results) {
        if (r.scheme != scheme || r.shape != shape) continue;
        points += fmt::format("{:.1f},{:.1f} ", x.at(r.seconds), y.at(r.worst));
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n",
                           x.at(r.seconds), y.at(r.worst), color);
      }
      const auto line = [&](const std::string& through) {
        svg += fmt::format(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" "
            "stroke-dasharray=\"{}\"/>\n",
            through, color, dash);
      };
      line(points);
      line(fmt::format("615,{:.0f} 645,{:.0f}", legend, legend));
      text(652, legend + 4, "start", fmt::format("{}, {}", scheme, shape));
      legend += 22;
    }
  return svg + "</svg>\n";
}

// What --quality's levels cost and how exact they are, each with its own step.
void print_qualities() {
  fmt::print(
      "\n| quality | shape | triangles | step (mm) | time (s) | largest (mm) | mean (mm) |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const Case& c : cases()) {
    const ExactTable exact(c);
    for (const char* quality : {"draft", "normal", "fine"}) {
      JobConfig config;
      apply_settings(config, quality_settings(quality));
      const Result r = measure(c, exact, DipScheme::kContactLine, config.design.film.elements,
                               config.design.dip.step_mm);
      fmt::print("| {} | {} | {} | {} | {:.2f} | {:.4f} | {:.4f} |\n", quality, c.name, r.triangles,
                 config.design.dip.step_mm, r.seconds, r.worst, r.mean);
      std::fflush(stdout);
    }
  }
}

int run(int argc, char** argv) {
  const std::filesystem::path plot_file = argc > 1 ? argv[1] : "out/bench/work-precision.svg";
  const int largest = argc > 2 ? std::atoi(argv[2]) : 160000;
  std::vector<Result> results;
  print_header();
  for (const Case& c : cases()) {
    const ExactTable exact(c);
    for (DipScheme scheme : {DipScheme::kPaper, DipScheme::kContactLine})
      for (int elements : {10000, 40000, 160000}) {
        if (elements > largest) continue;
        print_row(results.emplace_back(measure(c, exact, scheme, elements)));
      }
  }
  if (!results.empty()) {
    if (plot_file.has_parent_path()) std::filesystem::create_directories(plot_file.parent_path());
    std::ofstream(plot_file) << plot(results);
    fmt::print("plot: {}\n", plot_file.string());
  }
  print_qualities();
  return 0;
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) { return hydrodip::run(argc, argv); }
