#include "object/surface.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace hydrodip {
namespace {

// Of unit squares in z = 0, cut along their diagonals: enough for its tree to be built meanwhile.
std::shared_ptr<const TriangleMesh> large_square(int side = 80) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x) mesh->positions.emplace_back(x, y, 0);
  const auto at = [&](int x, int y) { return std::int32_t(y * (side + 1) + x); };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      mesh->triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh->triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  return mesh;
}

// Threads that ask at once, right after it was made, all get the answers that geometry gives.
TEST(Surface, AnswersTheFirstQuestionsOfManyThreads) {
  for (const int threads : {0, 1}) {
    const RunScope scope(RunContext().with_threads(threads));
    const Surface surface(large_square());
    std::atomic<int> right = 0;
    parallel_for(6400, 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        const Vec3 above(double(n % 80) + 0.75, std::floor(double(n) / 80) + 0.25, 3);
        const auto hit = surface.first_hit(above, -Vec3::UnitZ(), 0, 10);
        const auto nearest = surface.closest_point(above, 10);
        if (hit && nearest && hit->triangle == int(2 * n) && nearest->triangle == int(2 * n) &&
            std::abs(hit->t - 3) < 1e-9 && std::abs(nearest->t - 3) < 1e-9)
          ++right;
      }
    });
    EXPECT_EQ(right, 6400);
  }
}

TEST(Surface, OfACancelledJobAnswersNothing) {
  const RunContext context;
  const RunScope scope(context);
  const auto mesh = large_square();
  context.cancel();
  const auto ask = [&] {
    const Surface surface(mesh);
    return surface.is_hit({0.5, 0.25, 1}, -Vec3::UnitZ(), 0, 10);
  };
  EXPECT_THROW(ask(), Cancelled);
  { const Surface never_asked(mesh); }
}

// Objects are kept for the next question: the job that made one may be cancelled meanwhile.
TEST(Surface, AnswersOthersWhenTheJobThatMadeItWasCancelled) {
  if (available_threads() < 2) GTEST_SKIP() << "one thread";
  const RunContext context;
  context.cancel();
  std::optional<Surface> surface;
  {
    const RunScope scope(context);
    surface.emplace(large_square());
  }
  EXPECT_TRUE(surface->is_hit({0.75, 0.25, 1}, -Vec3::UnitZ(), 0, 10));
}

TEST(Surface, LeavesAllThreadsToOthersWhileItLives) {
  const int before = available_threads();
  const Surface surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_EQ(available_threads(), before);
}

// Embree would end the process.
TEST(Surface, NothingIsMetFromWhatIsNoPlaceOrInNoDirection) {
  const Surface surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const Vec3 above(0.2, 0.2, 1), down = -Vec3::UnitZ();
  ASSERT_TRUE(surface.first_hit(above, down, 0, 2));
  ASSERT_TRUE(surface.is_hit(above, down, 0, 2));
  for (const double none : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 place = above, way = down;
      place[axis] = way[axis] = none;
      EXPECT_FALSE(surface.first_hit(place, down, 0, 2));
      EXPECT_FALSE(surface.is_hit(place, down, 0, 2));
      EXPECT_FALSE(surface.first_hit(above, way, 0, 2));
      EXPECT_FALSE(surface.is_hit(above, way, 0, 2));
      EXPECT_FALSE(surface.closest_point(place, 2));
    }
}

}  // namespace
}  // namespace hydrodip
