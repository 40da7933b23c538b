// Which board tells most about a film: expected standard deviations of z_stretch, ln ratio and nu
// with 0.05 mm of noise on each coordinate of each corner, by the model's own sensitivities, for
// boards of repeating squares. `bench_board [RANDOM_CANDIDATES]`.
#include <fmt/format.h>
#include <stdlib.h>

#include <cmath>
#include <functional>
#include <random>

#include "base/run_scope.h"
#include "calibrate/expectation.h"

namespace hydrodip {
namespace {

constexpr double kNoise_mm = 0.05;
const FilmParameters kTruths[] = {{0.65, 3, 0.1}, {0.65, 30, 0.1}, {0.65, 600, 0}, {0.65, 3000, 0}};

class Study {
 public:
  Study() {
    config_.design.film.elements = 5000;
    config_.design.dip.step_mm = 0.6;
    for (const KitShape& kit : kit_shapes())
      objects_.push_back(calibration_object(kit.name, config_, context_));
  }

  void show(const Board& board) {
    const CheckeredFilm film = checkered_film(config_.design, board);
    std::string ink;
    if (board.period <= 8)
      for (const auto value : board.ink) ink += fmt::format("{} ", value);
    std::string text = fmt::format("| {} {} |", board.name, ink);
    double score = 0;
    std::size_t corners = 0;
    const RunScope scope(context_);
    for (const FilmParameters& truth : kTruths) {
      const Expectation found = expect(objects_, film, config_.design, truth, kNoise_mm, context_);
      const Expectation aligned =
          expect(objects_, film, config_.design, truth, kNoise_mm, context_, true);
      text += fmt::format(" {:.4f} {:.3f} {:.4f} ({:.4f} {:.3f} {:.4f}) |", found.z_stretch,
                          found.ln_ratio, found.poisson, aligned.z_stretch, aligned.ln_ratio,
                          aligned.poisson);
      score += std::log(found.ln_ratio) + 0.5 * std::log(found.poisson);
      corners = found.corners;
    }
    fmt::print("{} {} | {:.3f}\n", text, corners, score / 4);
    std::fflush(stdout);
  }

 private:
  RunContext context_;
  JobConfig config_;
  std::vector<CalibrationObject> objects_;
};

// A board that looks the same in mirrors and after a quarter turn, from the inks of the squares
// {a, b} with b <= a <= period / 2.
Board symmetric(const std::string& name, bool about_square, int period,
                const std::function<int(int, int)>& ink) {
  Board board = {name, 5, about_square, period, {}};
  for (int row = 0; row < period; ++row)
    for (int column = 0; column < period; ++column) {
      const int a = std::min(row, period - row), b = std::min(column, period - column);
      board.ink.push_back(std::uint8_t(ink(std::max(a, b), std::min(a, b))));
    }
  return board;
}

void run(int random) {
  Study study;
  const auto isolated = [&](int a, int b, int c) {
    study.show(symmetric("isolated", true, 4, [&](int i, int j) {
      return i % 2 == 0 && j % 2 == 0 ? 255 : i == 1 && j == 1 ? c : i == 2 ? b : a;
    }));
  };
  // Dark and faint squares in turn, two kinds of faint ones.
  const auto checkered = [&](int a, int b) {
    study.show(symmetric("checkered", true, 4, [&](int i, int j) {
      return (i + j) % 2 == 0 ? 255 : i == 2 ? b : a;
    }));
  };
  isolated(3, 3, 0);
  checkered(0, 3);
  checkered(0, 10);
  checkered(3, 10);
  checkered(1, 5);
  isolated(0, 3, 0);
  study.show(black_board(5));
  std::mt19937 chance(7);
  const int inks[] = {0, 0, 1, 3, 5, 10, 20, 40};
  for (int i = 0; i < random; ++i) {
    const int period = i % 2 ? 6 : 4;
    std::vector<int> level(64);
    for (int& l : level) l = inks[chance() % 8];
    study.show(symmetric("random", true, period, [&](int a, int b) {
      return a % 2 == 0 && b % 2 == 0 ? 255 : level[std::size_t(8 * a + b)];
    }));
  }
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  hydrodip::run(argc > 1 ? atoi(argv[1]) : 20);
  return 0;
}
