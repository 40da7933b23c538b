// Rounds of ink and film: when they settle.
#include "coat/design.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "samples/samples.h"

namespace hydrodip {
namespace {

// Film on 120 x 120 mm, of so many triangles.
DesignOptions quick(int elements) {
  DesignOptions options;
  options.film.width_mm = options.film.height_mm = 120;
  options.film.elements = elements;
  options.dip.step_mm = 0.5;
  options.dpi = 72;
  options.inverse.samples_per_axis = 1;
  return options;
}

// Adds the sample sphere, squeezed to these half axes, around a centre.
void add_ball(Object& object, const Vec3& centre, const Vec3& half_axes) {
  const Object ball = make_sample("sphere");
  const Box3 bounds = ball.bounds();
  const Vec3 middle = 0.5 * (bounds.min + bounds.max);
  const auto first = std::int32_t(object.positions.size());
  for (const Vec3& p : ball.positions)
    object.positions.push_back(
        centre + (2 * (p - middle)).cwiseQuotient(bounds.size()).cwiseProduct(half_axes));
  for (const Triangle& t : ball.triangles)
    object.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(object.material_of, ball.material_of);
  append(object.uvs, ball.uvs);
  object.materials = ball.materials;
  object.textures = ball.textures;
}

// Film that has torn between the legs hangs on the body in flaps.
Object beast_on_four_legs() {
  Object object;
  for (const double x : {-14.0, 14.0})
    for (const double y : {-7.0, 7.0}) add_ball(object, {x, y, 10}, {4, 4, 10});
  add_ball(object, {0, 0, 26}, {24, 14, 13});
  return object;
}

struct Settled {
  DippedObject dipped;
  InkResult result;
  std::vector<std::string> warnings = {};
};

Settled settled(Object object, const DesignOptions& options) {
  RunContext context;
  Timings timings;
  const auto shared = std::make_shared<const Object>(std::move(object));
  const PosedObject posed(shared, {});
  Designed made = design({posed, *model_paint(shared), Allotment(), *make_device_model(), options},
                         timings, context);
  return {std::move(made.dipped), std::move(made.ink), context.warnings()};
}

// Film that has torn takes no part in the measure, and what tears in one round tears in all that
// follow, so that the rest all but settles: a hundredth of what a hand misses by.
TEST(InkRoundsSlow, ComeToRestOnFilmThatTears) {
  const Settled torn = settled(beast_on_four_legs(), quick(7900));
  EXPECT_GT(torn.dipped.coverage.torn_mm2, 0);
  EXPECT_LT(torn.result.last_change_mm(), 30 * kSettled_mm);
}

TEST(InkRoundsSlow, SettleWhereATearLineCrossesThePicture) {
  DesignOptions options = quick(8000);
  options.dip.material.tear_stretch = 1.2;
  const Settled all = settled(make_sample("ellipsoid"), options);
  EXPECT_GT(all.dipped.coverage.torn_mm2, 0);
  ASSERT_GT(all.result.rounds.size(), 2U);
  EXPECT_EQ(all.result.rounds.front().mean_modulus, 1);
  EXPECT_TRUE(all.result.settled);
  EXPECT_LT(all.result.last_change_mm(), kSettled_mm);
}

// What is not kept gives its place to what is made of it.
TEST(Design, IsTheSameWhateverIsKeptOfTheFilmImage) {
  DesignOptions options = quick(3000);
  options.dip.step_mm = 2;
  options.trajectory.depth_mm = 8;
  options.rounds_max = 1;
  const RunContext context;
  const auto object = std::make_shared<const Object>(make_sample("sphere"));
  const PosedObject posed(object, {});
  const auto paint = model_paint(object);
  const auto model = make_device_model();
  const auto made = [&](const KeptImages& kept) {
    Timings timings;
    return design({.posed = posed,
                   .paint = *paint,
                   .allotment = Allotment(),
                   .model = *model,
                   .options = options,
                   .kept = kept},
                  timings, context)
        .ink;
  };
  const InkResult all = made({});
  ASSERT_FALSE(all.ink.wanted.empty());
  for (const KeptImages kept : {KeptImages{false, false}, {true, false}, {false, true}}) {
    const InkResult some = made(kept);
    EXPECT_EQ(some.ink.wanted.rgba, kept.wanted ? all.ink.wanted.rgba : BlankArray<std::uint8_t>());
    EXPECT_EQ(some.ink.stretch.area_ratio,
              kept.stretch ? all.ink.stretch.area_ratio : BlankArray<float>());
    EXPECT_EQ(some.ink.stretch.on_object,
              kept.stretch ? all.ink.stretch.on_object : BlankArray<std::uint8_t>());
    EXPECT_EQ(some.ink.inking.inks.cmyk, all.ink.inking.inks.cmyk);
    EXPECT_EQ(some.ink.on_object.rgba, all.ink.on_object.rgba);
    EXPECT_EQ(some.reach.out_of_reach, all.reach.out_of_reach);
    EXPECT_EQ(some.reach.mean, all.reach.mean);
  }
}

TEST(InkRounds, AreMadeAtMostAsOftenAsAsked) {
  DesignOptions options = quick(8000);
  options.dip.step_mm = 2;
  options.trajectory.depth_mm = 8;
  options.rounds_max = 2;
  const Settled all = settled(make_sample("sphere"), options);
  EXPECT_EQ(all.result.rounds.size(), 2U);
  EXPECT_EQ(all.result.last_change_mm(), all.result.rounds.back().change_mm);
}

// A thousandth of a millimetre is no news, though it is not settled; some tenths are.
TEST(InkRounds, WarnOfWhatIsSeen) {
  DesignOptions options = quick(3000);
  options.trajectory.depth_mm = 8;
  options.rounds_max = 4;
  options.settled_mm = 1e-9;
  const Settled calm = settled(make_sample("sphere"), options);
  EXPECT_FALSE(calm.result.settled);
  EXPECT_LT(calm.result.last_change_mm(), kUnseen_mm);
  EXPECT_EQ(calm.warnings, std::vector<std::string>());
  options.trajectory.depth_mm = 0;
  options.rounds_max = 2;
  const Settled moved = settled(beast_on_four_legs(), options);
  EXPECT_GT(moved.result.last_change_mm(), kUnseen_mm);
  ASSERT_EQ(moved.warnings.size(), 1U);
  EXPECT_EQ(moved.warnings.front().rfind("after 2 rounds the ink still moves the film by ", 0), 0U);
}

// What is said to settle is the ink: that its last dip goes in finer steps than the rounds moves
// the film besides, and is no news of the ink.
TEST(InkRounds, TellWhatTheInkMovesAndNotWhatOtherStepsDo) {
  DesignOptions options = quick(3000);
  options.dip.step_mm = 0.5;
  options.trajectory.depth_mm = 20;
  options.rounds_step_mm = 4;
  options.rounds_max = 6;
  options.settled_mm = 0.01;
  const InkResult made = settled(make_sample("sphere"), options).result;
  ASSERT_TRUE(made.settled);
  ASSERT_GT(made.rounds.size(), 3U);
  EXPECT_EQ(made.rounds.back().step_mm, 0.5);
  EXPECT_GT(made.rounds.back().change_mm, options.settled_mm);
  EXPECT_LT(made.last_change_mm(), options.settled_mm);
}

}  // namespace
}  // namespace hydrodip
