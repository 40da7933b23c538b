#include "plan/trial.h"
#include "plan/hold.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "dip/zoo_shapes.h"
#include "plan/choice.h"
#include "plan/search.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

// The sample sphere over a disc of film clamped at 100 mm, for which the film's strain is known.
class SphereTrial : public testing::Test {
 protected:
  SphereTrial() {
    film_.shape = FilmShape::kDisc;
    film_.width_mm = film_.height_mm = 220;
    film_.elements = 10000;
    dip_.step_mm = 0.5;
  }

  TrialTask task() const { return {sphere_, targets_, film_, dip_, BathOptions{}}; }
  // As a job dips it.
  DippedObject dipped_to(double depth_mm) const {
    Timings timings;
    return dip_object(PosedObject(sphere_, {}),
                      std::make_shared<const FilmMesh>(make_film_mesh(film_)),
                      Trajectory::straight_down(depth_mm), dip_, timings, context_);
  }

  std::shared_ptr<const Object> sphere_ = std::make_shared<const Object>(make_sample("sphere"));
  Targets targets_ = spread_targets(*sphere_, 4000);
  FilmOptions film_;
  DipOptions dip_;
  RunContext context_;
};

// Film of z stretch 0.65 that bears 1.4 stays whole up to a height of 13.645 mm: a cap of 2572 mm2,
// 22.7 % of the sphere (docs/model.md).
TEST_F(SphereTrial, FindsTheDepthAtWhichFilmTears) {
  const auto trial = try_pose(task(), {}, 0, context_);
  ASSERT_TRUE(trial);
  EXPECT_NEAR(trial->depth_mm, 13.645, 1);
  EXPECT_NEAR(trial->figures.covered_share, 0.2274, 0.015);
  EXPECT_EQ(trial->figures.torn_share, 0);
}

TEST_F(SphereTrial, TellsDepthsInTenths) {
  dip_.step_mm = 0.3;
  for (const double limit : {1.25, 1.3, 1.35, 1.4}) {
    dip_.material.tear_stretch = limit;
    const auto trial = try_pose(task(), {}, 0, context_);
    ASSERT_TRUE(trial);
    EXPECT_EQ(trial->depth_mm, std::stod(fmt::format("{:.1f}", trial->depth_mm)));
  }
}

// Down to all that fits, too, whose depth has as many digits as a number can; nothing tears there.
TEST_F(SphereTrial, TellsNoDepthWithMoreDigitsThanAPersonReads) {
  TrialTask small = task();
  small.dip.material.tear_stretch = 2.5;
  for (const double most_mm : {7.123456789, 8.0 / 3, 12.3}) {
    const auto trial = try_pose(small, {}, most_mm, context_);
    ASSERT_TRUE(trial);
    EXPECT_EQ(trial->depth_mm, std::stod(fmt::format("{:.2f}", trial->depth_mm)));
    EXPECT_NEAR(trial->depth_mm, most_mm, 0.01);
    EXPECT_LE(trial->depth_mm, most_mm);
  }
}

TEST_F(SphereTrial, IsWorthLessAsTheFilmIsStretched) {
  const auto trial = try_pose(task(), {}, 0, context_);
  ASSERT_TRUE(trial);
  const double low = sphere_->bounds().min.z();
  for (std::size_t i = 0; i < targets_.list.size(); ++i) {
    const double height = targets_.list[i].position.z() - low;
    if (height < 6) {
      EXPECT_EQ(trial->worth[i], 1.0F);
    }
    if (height > trial->depth_mm + 0.5) {
      EXPECT_EQ(trial->worth[i], 0.0F);
    }
    if (height > 12 && height < trial->depth_mm - 1.5) {
      EXPECT_LT(trial->worth[i], 0.99F);
    }
  }
  EXPECT_LT(trial->figures.score, trial->figures.covered_share);
}

TEST_F(SphereTrial, KeepsTheDepthThatIsAskedFor) {
  TrialTask given = task();
  given.depth_mm = 7;
  const auto trial = try_pose(given, {}, 0, context_);
  ASSERT_TRUE(trial);
  EXPECT_EQ(trial->depth_mm, 7);
  EXPECT_NEAR(trial->figures.covered_share, 7.0 / 60, 0.01);  // 2 pi R h of 4 pi R^2
}

TEST_F(SphereTrial, SaysTheSameOfADipThatWasMade) {
  TrialTask given = task();
  given.depth_mm = 12;
  const auto trial = try_pose(given, {}, 0, context_);
  ASSERT_TRUE(trial);
  const DippedObject dipped = dipped_to(12);
  const Trial judged = judge_dip(given, {}, dipped);
  EXPECT_EQ(judged.worth, trial->worth);
  EXPECT_NEAR(judged.figures.score, trial->figures.score, 1e-9);
  // What a trial tells of a dip is what the job's report will say of it.
  for (const TrialFigures& figures : {judged.figures, trial->figures}) {
    EXPECT_EQ(figures.covered_share, dipped.coverage.covered_share());
    EXPECT_EQ(figures.doubtful_share, dipped.coverage.doubtful_share());
    EXPECT_EQ(figures.torn_share, dipped.coverage.torn_share());
  }
}

// Film is torn along lines inside triangles: what a trial counts is what the job's report will say.
TEST_F(SphereTrial, CountsWhatIsTornAsTheJobDoes) {
  TrialTask given = task();
  given.depth_mm = 16;
  const auto trial = try_pose(given, {}, 0, context_);
  ASSERT_TRUE(trial);
  const DippedObject dipped = dipped_to(16);
  ASSERT_GT(dipped.coverage.torn_share(), 0.05);
  for (const TrialFigures& figures : {judge_dip(given, {}, dipped).figures, trial->figures}) {
    EXPECT_NEAR(figures.torn_share, dipped.coverage.torn_share(), 1e-9);
    EXPECT_NEAR(figures.covered_share, dipped.coverage.covered_share(), 1e-9);
    EXPECT_NEAR(figures.doubtful_share, dipped.coverage.doubtful_share(), 1e-9);
  }
}

// By the area that was printed for it, parts of triangles with their part.
TEST_F(SphereTrial, PaysForTheFilmThatTears) {
  const DippedObject dipped = dipped_to(16);
  const DippedFilm& film = *dipped.film;
  double torn_mm2 = 0;
  for (std::size_t t = 0; t < film.torn.size(); ++t) {
    const Triangle& v = film.mesh().triangles[t];
    const Vec2& a = film.mesh().u[std::size_t(v[0])];
    const double flat_mm2 = 0.5 * std::abs(cross2(film.mesh().u[std::size_t(v[1])] - a,
                                                  film.mesh().u[std::size_t(v[2])] - a));
    if (film.torn[t])
      torn_mm2 += flat_mm2;
    else if (film.lies_on_object(t))
      torn_mm2 += flat_mm2 * (1 - film.whole_part(t).share);
  }
  TrialTask free_of_charge = task(), paid = task();
  free_of_charge.torn_price = 0;
  paid.torn_price = 1;
  const double price = judge_dip(free_of_charge, {}, dipped).figures.score -
                       judge_dip(paid, {}, dipped).figures.score;
  EXPECT_GT(price, 0.01);
  EXPECT_NEAR(price, torn_mm2 / targets_.area, 1e-9);
}

// A picture drawn from the film shows what the figures say.
TEST_F(SphereTrial, KeepsTheFilmAsItLiesAtItsDepth) {
  TrialTask keeping = task();
  keeping.keep_film = true;
  const auto trial = try_pose(keeping, {}, 0, context_);
  ASSERT_TRUE(trial && trial->film);
  EXPECT_EQ(trial->film->depth_mm, trial->depth_mm);
  const PosedObject posed(sphere_, trial->pose);
  EXPECT_EQ(worth_at(task(), posed, *trial->film), trial->worth);
  // The dip went deeper, and that much tore.
  for (std::size_t t = 0; t < trial->film->torn.size(); ++t) EXPECT_FALSE(trial->film->torn[t]);
}

// A sphere that leans is the same sphere.
TEST_F(SphereTrial, AnotherWayInIsDippedToo) {
  TrialTask given = task();
  given.depth_mm = 10;
  const auto straight = try_pose(given, {}, 0, context_);
  given.way.tilt_deg = 25;
  given.way.tilt_toward_deg = 40;
  const auto leaning = try_pose(given, {}, 0, context_);
  given.way = {.path = {{}, {.lower_mm = 10}}};
  given.depth_mm = 0;
  const auto path = try_pose(given, {}, 0, context_);
  ASSERT_TRUE(straight && leaning && path);
  EXPECT_EQ(leaning->depth_mm, 10);
  EXPECT_NEAR(leaning->figures.covered_share, straight->figures.covered_share, 0.004);
  EXPECT_NEAR(leaning->figures.score, straight->figures.score, 0.006);
  EXPECT_NEAR(path->figures.score, straight->figures.score, 1e-6);
  EXPECT_EQ(path->path.size(), 2U);
}

TEST_F(SphereTrial, TheDepthOfALeaningWayIsLookedFor) {
  TrialTask leaning = task();
  leaning.film.elements = 2000;
  leaning.dip.step_mm = 1;
  leaning.way.tilt_deg = 25;
  const auto trial = try_pose(leaning, {}, 0, context_);
  ASSERT_TRUE(trial);
  EXPECT_NEAR(trial->depth_mm, 13.6, 4);
  EXPECT_GT(trial->figures.score, 0.15);
}

TEST_F(SphereTrial, WhatDoesNotFitIsNotTried) {
  TrialTask small = task();
  small.film.width_mm = small.film.height_mm = 60;  // 40 mm of free film
  const auto trial = try_pose(small, {}, 0, context_);
  // A cap of it does.
  ASSERT_TRUE(trial);
  EXPECT_LE(trial->depth_mm, 30 - std::sqrt(900.0 - 400) + 0.1);
  small.depth_mm = 20;
  EXPECT_FALSE(try_pose(small, {}, 0, context_));
}

TEST_F(SphereTrial, EveryHoldOfASphereIsAlike) {
  const auto one = try_pose(task(), {}, 0, context_);
  const auto other = try_pose(task(), hold({}, Vec3(1, 2, 3), 77), 0, context_);
  ASSERT_TRUE(one && other);
  EXPECT_NEAR(one->figures.score, other->figures.score, 0.01);
  EXPECT_NEAR(one->depth_mm, other->depth_mm, 1);
}

// Six caps of 58 degrees cover a sphere: 54.7 degrees from the corners of an octahedron would do.
TEST_F(SphereTrial, DipsAreChosenTogether) {
  TrialTask whole = trial_task(task());
  std::vector<PoseOptions> poses;
  for (const Vec3& down : spread_directions(26)) poses.push_back(hold({}, down, 0));
  std::vector<Trial> trials;
  for (auto& trial : try_poses(whole, poses, context_)) trials.push_back(std::move(*trial));
  ChoiceOptions options;
  options.better = false;
  double before = 0;
  for (int dips = 1; dips <= 6; ++dips) {
    options.dips = dips;
    const std::vector<Trial> chosen = choose_dips(whole, trials, options, context_).dips;
    ASSERT_EQ(int(chosen.size()), dips);
    std::vector<const Trial*> list;
    for (const Trial& trial : chosen) list.push_back(&trial);
    const double covered = covered_share_of(targets_, list);
    EXPECT_GT(covered, before);
    before = covered;
  }
  EXPECT_GT(before, 0.97);
}

// Caps around the axes leave gaps between them that others need not.
TEST_F(SphereTrial, PosesLikeTheChosenOnesCoverMore) {
  TrialTask whole = trial_task(task());
  whole.film.elements = 2000;
  std::vector<PoseOptions> poses;
  for (const Vec3& down : spread_directions(6)) poses.push_back(hold({}, down, 0));
  std::vector<Trial> trials;
  for (auto& trial : try_poses(whole, poses, context_)) trials.push_back(std::move(*trial));
  const auto covered = [&](bool better) {
    const std::vector<Trial> chosen =
        choose_dips(whole, trials, {.dips = 5, .kept = {}, .better = better}, context_).dips;
    std::vector<const Trial*> list;
    for (const Trial& trial : chosen) list.push_back(&trial);
    return covered_share_of(targets_, list);
  };
  EXPECT_GT(covered(true), covered(false) + 0.01);
}

// A trial that reaches the targets from one share of the list to another.
Trial reaching(const Targets& targets, double from, double to, float worth = 1) {
  Trial trial;
  trial.depth_mm = 1;
  const double count = double(targets.list.size());
  for (std::size_t i = 0; i < targets.list.size(); ++i)
    trial.worth.push_back(double(i) >= from * count && double(i) < to * count ? worth : 0.0F);
  return trial;
}

// The largest first, and then one for another, ends at 90 %: two have to be exchanged at once.
TEST_F(SphereTrial, TheBestPairIsFoundWhereGreedIsMisled) {
  const std::vector<Trial> trials = {reaching(targets_, 0.1, 0.8), reaching(targets_, 0.8, 1),
                                     reaching(targets_, 0, 0.5, 0.9F),
                                     reaching(targets_, 0.5, 1, 0.9F)};
  const auto chosen =
      choose_dips(task(), trials, {.dips = 2, .kept = {}, .better = false}, context_).dips;
  ASSERT_EQ(chosen.size(), 2U);
  EXPECT_NEAR(covered_share_of(targets_, {&chosen[0], &chosen[1]}), 1, 1e-9);
}

TEST_F(SphereTrial, NoDipIsMadeForNothing) {
  const std::vector<Trial> trials = {reaching(targets_, 0, 0.4), reaching(targets_, 0.2, 0.6),
                                     reaching(targets_, 0, 1), reaching(targets_, 0.5, 0.9)};
  const auto chosen =
      choose_dips(task(), trials, {.dips = 3, .kept = {}, .better = false}, context_).dips;
  ASSERT_EQ(chosen.size(), 1U);
  EXPECT_EQ(chosen[0].worth, trials[2].worth);
}

TEST_F(SphereTrial, KeptDipsComeFirstAndStay) {
  TrialTask whole = trial_task(task());
  std::vector<PoseOptions> poses;
  for (const Vec3& down : spread_directions(14)) poses.push_back(hold({}, down, 0));
  std::vector<Trial> trials;
  for (auto& trial : try_poses(whole, poses, context_)) trials.push_back(std::move(*trial));
  ChoiceOptions options;
  options.dips = 3;
  options.better = false;
  options.kept = {trials[9]};
  const std::vector<Trial> chosen = choose_dips(whole, trials, options, context_).dips;
  ASSERT_EQ(chosen.size(), 3U);
  EXPECT_EQ(chosen[0].pose.rotate_deg, trials[9].pose.rotate_deg);
  EXPECT_EQ(chosen[0].worth, trials[9].worth);
}

// A cup keeps its air where it opens down, and none where it opens up.
TEST(CupTrial, AirThatIsShutInCountsAgainstIt) {
  const shapes::Shape shape = shapes::cup();
  auto cup = std::make_shared<Object>();
  cup->positions = shape.positions;
  cup->triangles = shape.triangles;
  cup->materials.emplace_back();
  cup->material_of.assign(cup->triangles.size(), 0);
  const Targets targets = spread_targets(*cup, 2000);
  TrialTask task{cup, targets, {}, {}, {}};
  task.film.elements = 2000;
  task.dip.step_mm = 1;
  task.dip.material.tear_stretch = 0;
  task.depth_mm = 8;
  const RunContext context;
  const auto without = try_pose(task, {}, 0, context);
  task.air.cells = 20000;
  const auto opening_down = try_pose(task, {}, 0, context);
  const auto opening_up = try_pose(task, hold({}, Vec3(0, 0, 1), 0), 0, context);
  ASSERT_TRUE(without && opening_down && opening_up);
  EXPECT_EQ(without->figures.air_mm2, 0);
  EXPECT_GT(opening_down->figures.air_mm2, 500);
  EXPECT_EQ(opening_up->figures.air_mm2, 0);
  EXPECT_GT(opening_up->figures.score, opening_down->figures.score);
}

// A table, between whose legs film hangs when it has torn.
class TableTrial : public testing::Test {
 protected:
  TableTrial() {
    shapes::Shape shape = shapes::box({-25, -20, 22}, {25, 20, 26});
    for (const double x : {-22.0, 17.0})
      for (const double y : {-17.0, 12.0}) shape.append(shapes::box({x, y, 0}, {x + 5, y + 5, 23}));
    auto object = std::make_shared<Object>();
    object->positions = shape.positions;
    object->triangles = shape.triangles;
    object->materials.emplace_back();
    object->material_of.assign(object->triangles.size(), 0);
    table_ = object;
    targets_ = spread_targets(*table_, 2000);
    film_.elements = 3000;
    dip_.step_mm = 0.5;
  }

  TrialTask task() const { return {table_, targets_, film_, dip_, BathOptions{}}; }

  Trial job(double depth_mm) const {
    Timings timings;
    return judge_dip(
        task(), {},
        dip_object(PosedObject(table_, {}), std::make_shared<const FilmMesh>(make_film_mesh(film_)),
                   Trajectory::straight_down(depth_mm), dip_, timings, context_));
  }

  std::shared_ptr<const Object> table_;
  Targets targets_;
  FilmOptions film_;
  DipOptions dip_;
  RunContext context_;
};

// Film whose place hangs on how torn film falls is worth nothing, in a trial as in the job.
TEST_F(TableTrial, PromisesWhatTheJobDoes) {
  TrialTask given = task();
  given.depth_mm = 26;
  const auto trial = try_pose(given, {}, 0, context_);
  ASSERT_TRUE(trial);
  EXPECT_EQ(trial->worth, job(26).worth);
}

class BoxSearch : public testing::Test {
 protected:
  std::shared_ptr<const Object> box_ = std::make_shared<const Object>(make_sample("box"));
  Targets targets_ = spread_targets(*box_, 1000);
  FilmOptions film_;
  DipOptions dip_;
  RunContext context_;
};

TEST_F(BoxSearch, TheSameForAnyNumberOfThreads) {
  film_.elements = 2000;
  const TrialTask task{box_, targets_, film_, dip_, BathOptions{}};
  SearchOptions options = quick_search();
  const auto with = [&](int threads) {
    RunContext context = context_.with_threads(threads);
    return search_holds(task, {}, options, context).best.front();
  };
  const Trial one = with(1), two = with(2);
  EXPECT_EQ(one.pose.rotate_deg, two.pose.rotate_deg);
  EXPECT_EQ(one.depth_mm, two.depth_mm);
  EXPECT_EQ(one.figures.score, two.figures.score);
  EXPECT_EQ(one.worth, two.worth);
}

// Not the best alone: trial dips, in coarser film and longer steps, know little of what tears.
TEST(MaskSearch, TellsOfAllThatItFindsWhatTheirOwnDipsComeTo) {
  const auto mask = std::make_shared<const Object>(make_sample("mask"));
  const Targets targets = spread_targets(*mask, 1000);
  FilmOptions film;
  film.elements = 20000;
  DipOptions dip;
  dip.step_mm = 0.5;
  const RunContext context;
  const std::vector<Trial> best = search_holds({mask, targets, film, dip, BathOptions{}}, {},
                                               {.best = 3, .directions = 14, .refined = 0}, context)
                                      .best;
  ASSERT_GT(best.size(), 1U);
  for (const Trial& told : best) {
    Timings timings;
    const DippedObject dipped = dip_object(
        PosedObject(mask, told.pose), std::make_shared<const FilmMesh>(make_film_mesh(film)),
        Trajectory::straight_down(told.depth_mm), dip, timings, context);
    EXPECT_NEAR(told.figures.torn_share, dipped.coverage.torn_share(), 0.01);
    EXPECT_NEAR(told.figures.covered_share, dipped.coverage.covered_share(), 0.01);
  }
}

TEST_F(BoxSearch, CanBeCancelled) {
  const TrialTask task{box_, targets_, film_, dip_, BathOptions{}};
  context_.cancel();
  EXPECT_THROW(search_holds(task, {}, {}, context_), Cancelled);
}

TEST(SimplifiedForTrials, KeepsTheShapeOfAScan) {
  auto scan = std::make_shared<Object>(make_sample("sphere"));
  if (scan->triangles.size() <= 60000) {
    EXPECT_EQ(simplified_for_trials(scan), scan);
  }
  // Cut every triangle in four, until there are too many.
  while (scan->triangles.size() <= 60000) {
    Object finer;
    finer.materials = scan->materials;
    for (const Triangle& t : scan->triangles) {
      std::array<Vec3, 6> p;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = scan->positions[std::size_t(t[k])];
        p[3 + k] = 0.5 * (p[k] + scan->positions[std::size_t(t[(k + 1) % 3])]);
      }
      const auto base = std::int32_t(finer.positions.size());
      finer.positions.insert(finer.positions.end(), p.begin(), p.end());
      for (const Triangle& q :
           {Triangle{0, 3, 5}, Triangle{3, 1, 4}, Triangle{5, 4, 2}, Triangle{3, 4, 5}})
        finer.triangles.push_back({base + q[0], base + q[1], base + q[2]});
    }
    finer.material_of.assign(finer.triangles.size(), 0);
    *scan = finer;
  }
  const auto simple = simplified_for_trials(scan);
  EXPECT_LE(simple->triangles.size(), 60000U);
  const Vec3 difference = simple->bounds().size() - scan->bounds().size();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 0.01 * scan->bounds().size().x());
  for (const Vec3& p : simple->positions)
    EXPECT_NEAR((p - scan->bounds().center()).norm(), 30, 0.3);
}

}  // namespace
}  // namespace hydrodip
