// How good the search for a pose is: against 200 random ones at the job's quality, and against its
// own trial dips.
//
//   bench_random_poses MODEL [SIZE_MM [COUNT [FILM_ELEMENTS]]]
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cstdlib>
#include <random>

#include "base/context.h"
#include "model_io/load.h"
#include "object/paint.h"
#include "plan/search.h"
#include "settings/config.h"

namespace hydrodip {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<PoseOptions> random_poses(const PoseOptions& base, int count) {
  std::mt19937 random(1);
  const auto unit = [&] { return double(random()) / 4294967296.0; };
  std::vector<PoseOptions> poses;
  for (int i = 0; i < count; ++i) {
    const double z = 2 * unit() - 1, around = 2 * M_PI * unit(), r = std::sqrt(1 - z * z);
    poses.push_back(hold(base, {r * std::cos(around), r * std::sin(around), z}, 360 * unit()));
  }
  return poses;
}

void show(const char* what, const Trial& trial) {
  fmt::print(
      "{:<10} score {:.4f}  covered {:.2f} %  doubtful {:.2f} %  torn {:.2f} %  {:5.1f} mm  {} "
      "({})\n",
      what, trial.figures.score, 100 * trial.figures.covered_share,
      100 * trial.figures.doubtful_share, 100 * trial.figures.torn_share, trial.depth_mm,
      hold_options(trial.pose), describe_hold(trial.pose, ModelSide::kPlusY));
}

// As `print` with the options that are recommended dips it.
double score_in_the_job(const TrialTask& task, const Trial& trial) {
  const PosedObject posed(task.object, trial.pose);
  Timings unheard;
  const DippedObject dipped =
      dip_object(posed, std::make_shared<const FilmMesh>(make_film_mesh(task.film)),
                 Trajectory::straight_down(trial.depth_mm), task.dip, unheard, RunContext());
  return judge_dip(task, trial.pose, dipped).figures.score;
}

int run(int argc, char** argv) {
  JobConfig config;
  const double size_mm = argc > 2 ? std::atof(argv[2]) : 0;
  const int count = argc > 3 ? std::atoi(argv[3]) : 200;
  if (argc > 4) config.design.film.elements = std::atoi(argv[4]);
  RunContext context;
  const auto object = std::make_shared<const Object>(load_object(argv[1], {}, context).object);
  Targets targets = spread_targets(*object);
  weigh_by_paint(targets, *model_paint(object));
  PoseOptions pose;
  pose.size_mm = size_mm;
  const TrialTask task{object, targets, config.design.film, config.design.dip, config.bath};

  auto start = std::chrono::steady_clock::now();
  double first_s = 0;
  const SearchResult found = search_holds(task, pose, {}, context, [&](const Trial&) {
    if (first_s == 0) first_s = seconds_since(start);
  });
  fmt::print("search: {:.2f} s, {} trial dips, first answer after {:.2f} s\n", seconds_since(start),
             found.trials.size(), first_s);
  for (std::size_t i = 0; i < found.best.size(); ++i) {
    show(i < found.drafted.size() ? "found" : "trial", found.best[i]);
    if (i >= found.drafted.size()) continue;
    fmt::print("           its trial dip said {:.4f} ({:+.2f} %)\n", found.drafted[i],
               100 * (found.drafted[i] / found.best[i].figures.score - 1));
    const double again = score_in_the_job(task, found.best[i]);
    fmt::print("           the job's dip comes to {:.4f} ({:+.2f} %)\n", again,
               100 * (found.best[i].figures.score / again - 1));
  }

  start = std::chrono::steady_clock::now();
  std::optional<Trial> best;
  double sum = 0;
  int tried = 0;
  for (const auto& trial : try_poses(task, random_poses(pose, count), context)) {
    if (!trial) continue;
    ++tried;
    sum += trial->figures.score;
    if (!best || trial->figures.score > best->figures.score) best = trial;
  }
  fmt::print("{} random poses at the job's quality: {:.1f} s, mean score {:.4f}\n", tried,
             seconds_since(start), sum / std::max(1, tried));
  if (best) {
    show("best", *best);
    fmt::print("the best random pose over the one found: {:+.2f} %\n",
               100 * (best->figures.score / found.best.front().figures.score - 1));
  }
  return 0;
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  return hydrodip::run(argc, argv);
}
