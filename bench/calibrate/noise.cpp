// Whether a calibration's stated uncertainty covers the truth: 20 synthetic sets of scans with 0.05
// mm of noise, in random poses. Simulations do not depend on the noise, so that all seeds share
// those of one stencil around the truth. `bench_calibrate [SEEDS]`.
#include <fmt/format.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include "base/file.h"
#include "calibrate/fit.h"
#include "calibrate/resolution.h"
#include "calibrate/subject.h"
#include "calibrate/synthetic.h"
#include "scan/read_scan.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

constexpr double kNoise_mm = 0.05;
constexpr double kSquare_mm = 5;
const FilmParameters kTruth{0.65, 30, 0.15};
// Wide enough for what noise of this size moves.
const FitPoint kStep(0.03, 0.08, 0.12);

// The dip refers to its neighbours, so it stays where it was made.
struct Shape {
  CalibrationObject object;
  Surface surface;
  CheckerboardDip truth;

  Shape(const std::string& name, const CheckeredFilm& film, const DipOptions& dip,
        const JobConfig& config, const RunContext& context)
      : object(calibration_object(name, config, context)),
        surface(object.object.positions, object.object.triangles),
        truth(dip_checkerboard(film, object, surface, kTruth, dip, context)) {}
};

JobConfig search_config() {
  JobConfig config;
  config.design.film.width_mm = config.design.film.height_mm = 130;
  config.design.film.elements = 10000;
  config.design.dip.step_mm = 0.2;
  return config;
}

// Dips at points of the fit, each computed once.
class Dips {
 public:
  Dips(const DesignOptions& design, const RunContext& context)
      : options_(design.dip), film_(checkered_film(design, kSquare_mm)), context_(context) {}

  const CheckerboardDip& at(const std::string& name, const CalibrationObject& object,
                            const Surface& surface, const FitPoint& point) {
    auto& dip = dips_[{name, {point[0], point[1], point[2]}}];
    if (!dip)
      dip = std::make_unique<CheckerboardDip>(
          dip_checkerboard(film_, object, surface, from_fit(point), options_, context_));
    return *dip;
  }

 private:
  DipOptions options_;
  CheckeredFilm film_;
  const RunContext& context_;
  std::map<std::pair<std::string, std::array<double, 3>>, std::unique_ptr<CheckerboardDip>> dips_;
};

class Study {
 public:
  explicit Study(const std::filesystem::path& folder)
      : folder_(folder),
        config_(search_config()),
        search_(config_.design, context_),
        fine_(finer_film(config_.design), context_),
        finest_(finer_film(finer_film(config_.design)), context_) {
    const DesignOptions truth = finer_film(finer_film(finer_film(config_.design)));
    const CheckeredFilm film = checkered_film(truth, kSquare_mm);
    for (const KitShape& kit : kit_shapes())
      shapes_.push_back(std::make_unique<Shape>(kit.name, film, truth.dip, config_, context_));
  }

  std::vector<Subject> scan(std::uint64_t seed) {
    std::vector<std::string> texts;
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
      const Shape& shape = *shapes_[s];
      const std::filesystem::path file = folder_ / (shape.object.name + ".csv");
      write_scan_table(file,
                       synthetic_scan(shape.truth, shape.object, {20, 20},
                                      {.noise_mm = kNoise_mm, .seed = 100 * seed + s}),
                       kSyntheticMark);
      texts.push_back(shape.object.name + "=" + file.string());
    }
    return load_subjects(texts, {}, config_, context_);
  }

  // Length errors of all subjects, one behind the other.
  Eigen::VectorXd errors(Dips& dips, const std::vector<Subject>& subjects, const FitPoint& point) {
    std::vector<double> all;
    for (const Subject& subject : subjects) {
      const Comparison comparison = compare(subject, dip_of(dips, subject, point));
      const auto errors = errors_by_length(subject, comparison.warped, kSquare_mm);
      all.insert(all.end(), errors.begin(), errors.end());
    }
    return Eigen::Map<Eigen::VectorXd>(all.data(), Eigen::Index(all.size()));
  }

  std::pair<Fit, Certainty> calibrate(std::uint64_t seed) {
    const std::vector<Subject> subjects = scan(seed);
    const FitPoint start = to_fit(kTruth);
    const auto fit_with = [&](const Eigen::VectorXd& lacking) {
      FitOptions options;
      options.low = FitPoint::Zero();  // all three are to be found
      options.high = FitPoint::Ones();
      options.step = kStep;
      options.rounds_max = 1;
      options = without_bounds(options);
      return fit_parameters(
          start,
          [&](const std::vector<FitPoint>& points) {
            Eigen::MatrixXd matrix(lacking.size(), Eigen::Index(points.size()));
            for (std::size_t p = 0; p < points.size(); ++p)
              matrix.col(Eigen::Index(p)) = errors(search_, subjects, points[p]) + lacking;
            return matrix;
          },
          options);
    };
    const Correction lacking =
        correction(errors(search_, subjects, start), errors(fine_, subjects, start),
                   errors(finest_, subjects, start));
    Fit fit = fit_with(lacking.all);
    // At the truth, not at each seed's answer: all share the dips.
    const Eigen::MatrixXd here = gradient(subjects, start);
    Fit at_truth = fit;
    at_truth.point = start;
    fit.point -= noise_bias(
        at_truth, certainty(fit, here).noise_mm,
        [&](const FitPoint& point) { return gradient(subjects, point); }, kStep);
    return {fit, certainty(fit, here, lacking.doubt)};
  }

 private:
  const CheckerboardDip& dip_of(Dips& dips, const Subject& subject, const FitPoint& point) {
    for (const auto& shape : shapes_)
      if (shape->object.name == subject.name)
        return dips.at(subject.name, shape->object, shape->surface, point);
    throw std::logic_error("no such shape");
  }

  Eigen::MatrixXd gradient(const std::vector<Subject>& subjects, const FitPoint& point) {
    std::vector<Eigen::MatrixXd> parts;
    Eigen::Index rows = 0, columns = 0;
    for (const Subject& subject : subjects) {
      const CheckerboardDip& dip = dip_of(search_, subject, point);
      parts.push_back(noise_gradient_of(subject, dip, compare(subject, dip)));
      rows += parts.back().rows();
      columns += parts.back().cols();
    }
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows, columns);
    rows = columns = 0;
    for (const Eigen::MatrixXd& part : parts) {
      all.block(rows, columns, part.rows(), part.cols()) = part;
      rows += part.rows();
      columns += part.cols();
    }
    return all;
  }

  std::filesystem::path folder_;
  RunContext context_;
  JobConfig config_;
  std::vector<std::unique_ptr<Shape>> shapes_;
  Dips search_, fine_, finest_;
};

std::string interval(double low, double high) { return fmt::format("{:.3g} .. {:.3g}", low, high); }

void run(int seeds) {
  const TemporaryFolder folder;
  Study study(folder.path());
  fmt::print("truth: z_stretch {}, ratio {}, poisson {}; noise {} mm\n\n", kTruth.z_stretch,
             kTruth.stiffness_ratio, kTruth.poisson, kNoise_mm);
  fmt::print(
      "| seed | z_stretch | 95 % | ratio | 95 % | poisson | 95 % | noise (mm) |\n"
      "|---|---|---|---|---|---|---|---|\n");
  std::array<int, 3> covered{};
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto [fit, sure] = study.calibrate(std::uint64_t(seed));
    const FilmParameters found = from_fit(fit.point.cwiseMax(FitPoint(0, 0.01, 0)));
    const auto inside = [&](double FilmParameters::*member) {
      return sure.low.*member <= kTruth.*member && kTruth.*member <= sure.high.*member;
    };
    covered[0] += inside(&FilmParameters::z_stretch);
    covered[1] += inside(&FilmParameters::stiffness_ratio);
    covered[2] += inside(&FilmParameters::poisson);
    fmt::print("| {} | {:.4f} | {} | {:.1f} | {} | {:.3f} | {} | {:.3f} |\n", seed, found.z_stretch,
               interval(sure.low.z_stretch, sure.high.z_stretch), found.stiffness_ratio,
               interval(sure.low.stiffness_ratio, sure.high.stiffness_ratio), found.poisson,
               interval(sure.low.poisson, sure.high.poisson), sure.noise_mm);
    std::fflush(stdout);
  }
  fmt::print(
      "\nThe 95 % intervals hold the truth in {} (z_stretch), {} (ratio) and {} (poisson) of "
      "{} seeds.\n",
      covered[0], covered[1], covered[2], seeds);
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  hydrodip::run(argc > 1 ? std::max(1, atoi(argv[1])) : 20);
  return 0;
}
