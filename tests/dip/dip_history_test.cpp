#include "dip/dip_history.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

// Three vertices: one clamped, one that floats, one that is attached from step `contact` on.
DipHistory watched(int frames, int steps, int contact) {
  DipHistory history(frames);
  for (int step = 0; step <= steps; ++step) {
    const double level = 0.1 * step;
    const bool attached = step >= contact;
    history.record(step, steps, Moment::at_depth(level),
                   {{9, 0, 0}, {1, 0, level}, {2, 0, attached ? 0.1 * contact : level}},
                   {VertexState::kClamped, VertexState::kUnattached,
                    attached ? VertexState::kAttached : VertexState::kUnattached});
  }
  return history;
}

TEST(DipHistory, KeepsTheEndsAndAboutEvenlyWhatIsBetween) {
  const DipHistory history = watched(5, 1000, 500);
  ASSERT_EQ(history.frames().size(), 5u);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(history.frames()[i].moment.level_mm, 25.0 * double(i), 0.11);
  EXPECT_EQ(history.frames().back().moment.level_mm, 100);
}

TEST(DipHistory, KeepsEveryStepOfAShortDip) {
  EXPECT_EQ(watched(32, 1, 1).frames().size(), 2u);
  EXPECT_EQ(watched(32, 7, 1).frames().size(), 8u);
}

TEST(DipHistory, KnowsWhenFilmWasAttached) {
  const DipHistory history = watched(11, 100, 35);
  EXPECT_EQ(history.attached_from()[0], history.frames().size());
  EXPECT_EQ(history.attached_from()[1], history.frames().size());
  EXPECT_EQ(history.attached_from()[2], 4);  // frames every 10 steps: 40 is the first after 35
}

TEST(DipHistory, TheRimStaysAtTheWater) {
  const DipHistory history = watched(4, 30, 5);
  for (const DipFrame& frame : history.frames()) {
    EXPECT_EQ(frame.position[0][2], float(frame.moment.level_mm));
  }
}

TEST(DipHistory, ANewDipReplacesTheOld) {
  DipHistory history = watched(5, 100, 50);
  history.record(0, 2, Moment{}, {{0, 0, 0}}, {VertexState::kUnattached});
  EXPECT_EQ(history.frames().size(), 1u);
  EXPECT_EQ(history.attached_from().size(), 1u);
}

TEST(DipHistory, ALargeFilmGetsFewerFrames) {
  DipHistory history(32);
  const std::size_t vertices = 100000;
  for (int step = 0; step <= 100; ++step) {
    history.record(step, 100, Moment::at_depth(step), std::vector<Vec3>(vertices, Vec3::Zero()),
                   std::vector<VertexState>(vertices, VertexState::kUnattached));
  }
  EXPECT_LE(history.frames().size(), 7u);
  EXPECT_GE(history.frames().size(), 2u);
}

}  // namespace
}  // namespace hydrodip
