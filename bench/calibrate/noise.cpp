// How near a calibration comes to the truth, and whether its intervals hold it: synthetic sets of
// scans of the three shapes with 0.05 mm of noise, in random poses, computed on nine times the
// triangles of the film that they are fitted on, with half the step: more than twice the triangles
// of the finest film that the fit uses, and not halvings of its cells. Simulations know nothing of
// the noise, so that all seeds share them; they are kept in FOLDER. `bench_calibrate [SEEDS
// [ELEMENTS [FOLDER]]]`.
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "base/run_scope.h"
#include "calibrate/search.h"
#include "calibrate/synthetic.h"
#include "scan/read_scan.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

constexpr double kNoise_mm = 0.05;
const FilmParameters kTruths[] = {{0.65, 600, 0}, {0.65, 30, 0.1}, {0.8, 150, 0.2}};
// A grid's point near each of them.
const FilmParameters kStarts[] = {{0.7, 192, 0}, {0.7, 24, 0.2}, {0.85, 192, 0.2}};

struct Shapes {
  Shapes(const JobConfig& config, const RunContext& context) {
    for (const KitShape& kit : kit_shapes()) {
      Subject subject;
      subject.name = kit.name;
      subject.object = calibration_object(kit.name, config, context);
      subject.surface = std::make_unique<Surface>(subject.object.object.positions,
                                                  subject.object.object.triangles);
      subject.fingerprint =
          std::string(kit.name) + "-" + std::to_string(config.design.film.elements);
      list.push_back(std::move(subject));
    }
  }
  std::vector<Subject> list;
};

struct Found {
  FilmParameters parameters, low, high;
};

class Study {
 public:
  Study(const std::filesystem::path& folder, int elements)
      : folder_(folder), board_(tint_board(5)), store_(folder / "simulations.jsonl", {}) {
    config_.design.dip.step_mm *= std::sqrt(double(config_.design.film.elements) / elements);
    config_.design.film.elements = elements;
    options_.z_stretch = {0.4, 0.9};
    options_.stiffness_ratio = {1, 1e5};
    options_.poisson = {0, 0.4};
  }

  Found calibrate(const FilmParameters& truth, const FilmParameters& start, std::uint64_t seed) {
    const RunScope scope(context_);
    const Shapes shapes(config_, context_);
    DesignOptions finest = config_.design;
    finest.film.elements *= 9;
    finest.dip.step_mm /= 2;
    Simulations fine(shapes.list, finest, board_, "truth", store_);
    std::vector<SimulationRequest> requests;
    for (std::size_t s = 0; s < shapes.list.size(); ++s) requests.push_back({s, truth});
    const std::vector<SimulationResult> truths = fine.get(requests, "truth", context_);
    std::vector<std::string> texts;
    for (std::size_t s = 0; s < truths.size(); ++s) {
      const std::filesystem::path file = folder_ / (shapes.list[s].name + ".csv");
      const GridLanding landing = [&](const GridPlace& place) -> std::optional<Vec3> {
        const Landing* found = truths[s]->find(place);
        return found != nullptr ? std::optional<Vec3>(found->position) : std::nullopt;
      };
      write_scan_table(file,
                       synthetic_scan(landing, truths[s]->reach,
                                      {.noise_mm = kNoise_mm, .seed = 100 * seed + s}),
                       kSyntheticMark);
      texts.push_back(shapes.list[s].name + "=" + file.string());
    }
    const std::vector<Subject> subjects =
        load_subjects(texts, {{}, board_, false}, config_, context_);
    const Answer answer =
        Search(subjects, config_.design, board_, options_, store_).fit_from(start, context_);
    return {answer.parameters, answer.certainty.low, answer.certainty.high};
  }

 private:
  std::filesystem::path folder_;
  RunContext context_;
  JobConfig config_;
  Board board_;
  GridSearchOptions options_;
  SimulationStore store_;
};

struct Parameter {
  const char* name;
  double FilmParameters::*member;
};
constexpr Parameter kParameters[] = {{"z_stretch", &FilmParameters::z_stretch},
                                     {"ratio", &FilmParameters::stiffness_ratio},
                                     {"nu", &FilmParameters::poisson}};

bool near_enough(const FilmParameters& found, const FilmParameters& truth, int k) {
  if (k == 0) return std::abs(found.z_stretch - truth.z_stretch) <= 0.004;
  if (k == 1)
    return std::abs(std::log(found.stiffness_ratio / truth.stiffness_ratio)) <= std::log(1.2);
  return std::abs(found.poisson - truth.poisson) <= 0.04;
}

void study(Study& study, const FilmParameters& truth, const FilmParameters& start, int seeds) {
  fmt::print("\nTruth: z_stretch {}, ratio {}, nu {}\n\n", truth.z_stretch, truth.stiffness_ratio,
             truth.poisson);
  fmt::print(
      "| seed | z_stretch | 95 % | ratio | 95 % | nu | 95 % |\n|---|---|---|---|---|---|---|\n");
  std::array<int, 3> near{}, held{};
  std::array<std::vector<double>, 3> values;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Found found = study.calibrate(truth, start, std::uint64_t(seed));
    std::string row = fmt::format("| {} |", seed);
    for (int k = 0; k < 3; ++k) {
      const auto member = kParameters[k].member;
      near[std::size_t(k)] += near_enough(found.parameters, truth, k);
      held[std::size_t(k)] +=
          found.low.*member <= truth.*member && truth.*member <= found.high.*member;
      values[std::size_t(k)].push_back(found.parameters.*member);
      row += fmt::format(" {:.4g} | {:.4g} to {:.4g} |", found.parameters.*member,
                         found.low.*member, found.high.*member);
    }
    fmt::print("{}\n", row);
    std::fflush(stdout);
  }
  fmt::print("\n");
  for (int k = 0; k < 3; ++k) {
    auto& list = values[std::size_t(k)];
    std::nth_element(list.begin(), list.begin() + std::ptrdiff_t(list.size() / 2), list.end());
    fmt::print("{}: near enough in {}, held by the interval in {} of {} seeds, median {:.4g}\n",
               kParameters[k].name, near[std::size_t(k)], held[std::size_t(k)], seeds,
               list[list.size() / 2]);
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  using namespace hydrodip;
  const int seeds = argc > 1 ? std::max(1, atoi(argv[1])) : 20;
  const int elements = argc > 2 ? std::max(1000, atoi(argv[2])) : 40000;
  const TemporaryFolder own;
  Study all(argc > 3 ? std::filesystem::path(argv[3]) : own.path(), elements);
  for (std::size_t t = 0; t < std::size(kTruths); ++t) study(all, kTruths[t], kStarts[t], seeds);
  return 0;
}
