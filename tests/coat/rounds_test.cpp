// What a round of ink says of itself: how far the film moved, how much is printed, and that mixing
// rounds settles what else takes longer.
#include <gtest/gtest.h>

#include <utility>

#include "coat/design.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

DesignOptions coarse() {
  DesignOptions options;
  options.film.width_mm = options.film.height_mm = 120;
  options.film.elements = 3000;
  options.dip.step_mm = 1;
  options.dip.material.tear_stretch = 0;
  options.dpi = 72;
  options.inverse.samples_per_axis = 1;
  return options;
}

Designed designed(const std::string& sample, const DesignOptions& options,
                  const FirstDip* first = nullptr) {
  RunContext context;
  Timings timings;
  const auto shared = std::make_shared<const Object>(make_sample(sample));
  const PosedObject posed(shared, {});
  return design({posed, *model_paint(shared), Allotment(), *make_device_model(), options, first},
                timings, context);
}

// Film that floats leaves no trace: only what lies on the object after both dips counts.
TEST(InkRound, MovesTheFilmThatLiesThereInBothDips) {
  DesignOptions options = coarse();
  options.trajectory.depth_mm = 8;
  options.rounds_max = 1;
  const Designed first = designed("sphere", options);
  options.rounds_max = 2;
  const Designed second = designed("sphere", options);
  ASSERT_EQ(second.ink.rounds.size(), 2U);
  const DippedFilm &from = *first.dipped.film, &to = *second.dipped.film;
  std::vector<std::uint8_t> lies(from.position.size(), 0);
  for (std::size_t t = 0; t < from.mesh().triangles.size(); ++t)
    if (from.lies_on_object(t) && to.lies_on_object(t))
      for (const std::int32_t v : from.mesh().triangles[t]) lies[std::size_t(v)] = 1;
  double sum = 0, all = 0, count = 0;
  for (std::size_t v = 0; v < lies.size(); ++v) {
    const double way = (to.position[v] - from.position[v]).norm();
    all += way / double(lies.size());
    if (!lies[v]) continue;
    sum += way;
    ++count;
  }
  ASSERT_GT(count, 20);
  EXPECT_NEAR(second.ink.rounds[1].change_mm, sum / count, 1e-12);
  EXPECT_GT(std::abs(sum / count - all), 1e-4);  // or this would tell nothing
}

// The first round is the dip without ink: whoever has it already need not make it again.
TEST(InkRound, OfADipThatWasMadeIsThatDip) {
  DesignOptions options = coarse();
  options.trajectory.depth_mm = 6;
  options.rounds_max = 1;
  const Designed alone = designed("sphere", options);
  options.rounds_max = 3;
  const Designed anew = designed("sphere", options);
  const FirstDip blank{alone.dipped, {}};
  const Designed going_on = designed("sphere", options, &blank);
  EXPECT_EQ(anew.dipped.film->position, going_on.dipped.film->position);
  EXPECT_EQ(anew.ink.ink.inking.inks.cmyk, going_on.ink.ink.inking.inks.cmyk);
}

// The dip with its first ink is the second round, whether or not the first one was made before.
TEST(InkRound, WithTheFirstInkIsTheSecond) {
  DesignOptions options = coarse();
  options.trajectory.depth_mm = 6;
  options.rounds_max = 1;
  const Designed alone = designed("sphere", options);
  options.rounds_max = 2;
  const Designed second = designed("sphere", options);
  ASSERT_NE(alone.dipped.film->position, second.dipped.film->position);
  const RunContext context;
  const auto shared = std::make_shared<const Object>(make_sample("sphere"));
  const PosedObject posed(shared, {});
  const FirstDip blank{alone.dipped, {}};
  for (const FirstDip* from : {static_cast<const FirstDip*>(nullptr), &blank}) {
    const FirstDip inked = dip_with_first_ink(
        {posed, *model_paint(shared), Allotment(), *make_device_model(), options, from}, context);
    EXPECT_EQ(inked.dipped.film->position, second.dipped.film->position);
    ASSERT_EQ(inked.modulus.size(), inked.dipped.film->mesh().triangles.size());
  }
}

// What let go in the second round is not whole in any that follows, however the ink changes how
// film stretches.
TEST(InkRound, TearsFilmWhereTheSecondDid) {
  DesignOptions options = coarse();
  options.dip.material.safe_stretch = 1.05;
  options.dip.material.tear_stretch = 1.08;
  options.dip.material.lost_stretch = 1.12;
  options.trajectory.depth_mm = 15;
  options.rounds_max = 2;
  const Designed second = designed("sphere", options);
  options.rounds_max = 4;
  options.settled_mm = 0;
  const Designed fourth = designed("sphere", options);
  ASSERT_EQ(fourth.ink.rounds.size(), 4U);
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(fourth.ink.rounds[n].tears_kept, n >= 2) << n;
  int let_go = 0;
  for (std::size_t t = 0; t < second.dipped.film->torn_at_mm.size(); ++t) {
    if (!std::isfinite(second.dipped.film->torn_at_mm[t])) continue;
    ++let_go;
    EXPECT_TRUE(fourth.dipped.film->torn[t]) << t;
  }
  EXPECT_GT(let_go, 20);
}

// Rounds in longer steps only look for the ink; the film is the dip's own.
TEST(InkRound, InLongerStepsLeadsToTheSameFilm) {
  DesignOptions options = coarse();
  options.dip.step_mm = 0.2;
  options.trajectory.depth_mm = 6;
  const Designed own = designed("sphere", options);
  options.rounds_step_mm = 1;
  const Designed longer = designed("sphere", options);
  ASSERT_GT(longer.ink.rounds.size(), 3U);
  // In the beginning, where the water gains fast, all steps are short.
  const int short_steps = own.ink.rounds.front().dip.steps;
  EXPECT_GE(short_steps, 6 / 0.4);
  EXPECT_EQ(longer.ink.rounds.front().dip.steps, short_steps);
  // Of the second it is seen what tears.
  EXPECT_NEAR(longer.ink.rounds[1].dip.steps, short_steps, 2);
  EXPECT_LT(longer.ink.rounds[2].dip.steps, short_steps / 2);
  EXPECT_NEAR(longer.ink.rounds.back().dip.steps, short_steps, 2);
  for (std::size_t v = 0; v < own.dipped.film->position.size(); ++v)
    EXPECT_LT((own.dipped.film->position[v] - longer.dipped.film->position[v]).norm(), 0.05);
}

// The flat bottom of the sample box, 40 x 40 mm, and half a millimetre of its walls; film ends less
// than a cell before the edge.
TEST(InkRound, PrintsTheAreaOfTheSlabInSquareMillimetres) {
  for (const double dpi : {72.0, 150.0}) {
    DesignOptions options = coarse();
    options.trajectory.depth_mm = 0.5;
    options.rounds_max = 1;
    options.inverse.bleed_mm = 0;
    options.dpi = dpi;
    const Designed box = designed("box", options);
    const double least_mm = 40 - 2 * box.dipped.film->mesh().cell_mm;
    EXPECT_GT(box.ink.rounds[0].printed_mm2, least_mm * least_mm) << dpi;
    EXPECT_LT(box.ink.rounds[0].printed_mm2, 40 * 40 + 4 * 40 * 0.5) << dpi;
  }
}

// The paper's measure, on samples that go under as a whole: each round's film by less than 1e-4 mm
// from the one before, the ink being changed less than seven times. At the pyramid's edges film may
// take the one side once and then the other.
TEST(InkRoundsSlow, OfTheSamplesSettle) {
  for (const auto& [sample, most] :
       {std::pair{"sphere", 7}, std::pair{"ellipsoid", 7}, std::pair{"pyramid", 8}}) {
    DesignOptions options;
    options.film.width_mm = 215.9;
    options.film.height_mm = 279.4;
    const Designed made = designed(sample, options);
    EXPECT_TRUE(made.ink.settled) << sample;
    EXPECT_LT(made.ink.rounds.back().change_mm, 1e-4) << sample;
    EXPECT_LE(int(made.ink.rounds.size()), most) << sample;
  }
}

}  // namespace
}  // namespace hydrodip
