// How much a board tells about a film: expected standard deviations of z_stretch, ln ratio and nu
// with 0.05 mm of noise on each coordinate of each corner, by the model's own sensitivities.
// `bench_board [ELEMENTS]` asks it of the boards below; `bench_board ELEMENTS -` of those on the
// standard input, a line each: side of a square, inks of a quarter of its period (0 to 255, row by
// row: the board is symmetric), shapes with their depths, as in "5 255,3,0,3,0,0,0,0,3 pyramid@22".
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <sstream>

#include "base/run_scope.h"
#include "calibrate/expectation.h"

namespace hydrodip {
namespace {

constexpr double kNoise_mm = 0.05;
const FilmParameters kTruths[] = {
    {0.65, 30, 0.1}, {0.8, 150, 0.2}, {0.65, 600, 0}, {0.65, 3, 0.1}, {0.65, 3000, 0}};
std::vector<std::string> kit() {
  std::vector<std::string> names;
  for (const KitShape& shape : kit_shapes()) names.emplace_back(shape.name);
  return names;
}

// A board that looks the same in mirrors and after a quarter turn, about the middle of a dark
// square, from the inks of its first half period's squares and one more along both axes.
Board symmetric(double square_mm, const std::vector<int>& quarter) {
  const int half = int(std::lround(std::sqrt(double(quarter.size())))) - 1;
  const int period = std::max(1, 2 * half);
  Board board = {"symmetric", square_mm, true, period, {}};
  for (int row = 0; row < period; ++row)
    for (int column = 0; column < period; ++column) {
      const int a = std::min(row, period - row), b = std::min(column, period - column);
      board.ink.push_back(std::uint8_t(quarter[std::size_t(a * (half + 1) + b)]));
    }
  return board;
}

class Study {
 public:
  explicit Study(int elements) {
    const double coarser = std::sqrt(config_.design.film.elements / double(elements));
    config_.design.film.elements = elements;
    config_.design.dip.step_mm *= 2 * coarser;
  }

  // With only the first of the films.
  void show(const std::string& name, const Board& board, const std::vector<std::string>& shapes,
            std::size_t films = std::size(kTruths)) {
    const RunScope scope(context_);
    std::vector<CalibrationObject> objects;
    for (const std::string& shape : shapes)
      objects.push_back(calibration_object(shape, config_, context_));
    const CheckeredFilm film = checkered_film(config_.design, board);
    std::string text = fmt::format("| {:g} mm, {} |", board.square_mm, name);
    std::size_t corners = 0;
    for (std::size_t f = 0; f < films; ++f) {
      const Expectation found =
          expect(objects, film, config_.design, kTruths[f], kNoise_mm, context_);
      text +=
          fmt::format(" {:.4f} {:.3f} {:.4f} |", found.z_stretch, found.ln_ratio, found.poisson);
      corners = found.corners;
    }
    fmt::print("{} {} |\n", text, corners);
    std::fflush(stdout);
  }

 private:
  RunContext context_;
  JobConfig config_;
};

void show_boards(Study& study) {
  study.show("black", black_board(5), kit());
  study.show("tints", tint_board(5), kit());
  study.show("tints", tint_board(4), kit());
  study.show("tints, samples' sizes", tint_board(5), {"sphere", "pyramid", "ellipsoid"});
  // The half of the pale squares that touch dark ones' edges tinted, or blank.
  study.show("255,0,3", symmetric(5, {255, 0, 255, 0, 0, 3, 255, 3, 255}), kit());
}

void show_lines(Study& study, std::istream& lines) {
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    double square_mm = 0;
    std::string inks;
    if (!(words >> square_mm >> inks)) continue;
    std::vector<int> quarter;
    std::istringstream values(inks);
    for (std::string value; std::getline(values, value, ',');)
      quarter.push_back(std::clamp(atoi(value.c_str()), 0, 255));
    const std::vector<std::string> shapes{std::istream_iterator<std::string>(words), {}};
    study.show(inks, symmetric(square_mm, quarter), shapes.empty() ? kit() : shapes, 3);
  }
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  using namespace hydrodip;
  Study study(argc > 1 ? std::max(1000, atoi(argv[1])) : 10000);
  std::string films, line;
  for (const FilmParameters& truth : kTruths) {
    films +=
        fmt::format(" {:g}, {:g}, {:g} |", truth.z_stretch, truth.stiffness_ratio, truth.poisson);
    line += "---|";
  }
  fmt::print("| board |{} corners |\n|---|{}---|\n", films, line);
  if (argc > 2)
    show_lines(study, std::cin);
  else
    show_boards(study);
  return 0;
}
