// What must not change the film: turning, mirroring, scaling moduli, threads; and dips whose result
// is known without any computation.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>

#include "base/parallel.h"
#include "exact/dipping.h"

namespace hydrodip {
namespace {

using exact::dip_shape;
using exact::disc_film;
using exact::untearing;
using shapes::Shape;

FilmMesh square_film(int elements, double side_mm = 200) {
  return make_film_mesh(
      {.width_mm = side_mm + 20, .height_mm = side_mm + 20, .margin_mm = 10, .elements = elements});
}

// Half an ellipsoid, tilted, and a box beside it: no symmetry at all.
Shape lopsided() {
  Shape shape = shapes::revolve(
      [](double s) {
        const double angle = s * M_PI;
        return Vec2(22 * std::sin(angle), 14 * (1 - std::cos(angle)));
      },
      60, 90);
  const Eigen::AngleAxisd tilt(0.35, Vec3(0.6, 0.8, 0));
  double bottom = 1e300;
  for (Vec3& p : shape.positions) {
    p = tilt * p + Vec3(-7.3, 4.1, 0);
    bottom = std::min(bottom, p.z());
  }
  for (Vec3& p : shape.positions) p.z() -= bottom;
  shape.append(shapes::box(Vec3(14.2, -21.7, 2.1), Vec3(31.9, -3.3, 12)));
  return shape;
}

Shape moved(const Shape& shape, const Mat3& motion, bool mirrors) {
  Shape result = shape;
  for (Vec3& p : result.positions) p = (motion * p).eval();
  if (mirrors)
    for (Triangle& t : result.triangles) std::swap(t[1], t[2]);
  return result;
}

DippedFilm dip_lopsided(const Shape& shape, const FilmMesh& film) {
  return dip_shape(shape, film, untearing(0.25, 11));
}

std::int32_t vertex_at(const FilmMesh& film, const Vec2& u) {
  for (std::size_t v = 0; v < film.u.size(); ++v)
    if ((film.u[v] - u).norm() < 1e-9) return std::int32_t(v);
  return -1;
}

// Largest distance between the moved film and the film over the moved object.
double distance_after(const Mat3& motion, bool mirrors) {
  const FilmMesh film = square_film(2000);
  const DippedFilm before = dip_lopsided(lopsided(), film);
  const DippedFilm after = dip_lopsided(moved(lopsided(), motion, mirrors), film);
  double largest = 0;
  int attached = 0;
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    const std::int32_t w = vertex_at(film, motion.topLeftCorner<2, 2>() * film.u[v]);
    if (w < 0) return 1e300;
    if (before.state[v] != after.state[std::size_t(w)]) return 1e300;
    attached += before.state[v] == VertexState::kAttached;
    largest =
        std::max(largest, (motion * before.position[v] - after.position[std::size_t(w)]).norm());
  }
  EXPECT_GT(attached, 100);
  return largest;
}

// Moving coordinates changes rounding, and where within its tolerance (1e-5 mm) each relaxation
// ends. A vertex that touches just as a step ends may then attach with the next one.
constexpr double kRounding_mm = 5e-4;

TEST(Invariance, TurningTheObjectTurnsTheFilm) {
  Mat3 quarter_turn;
  quarter_turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_LT(distance_after(quarter_turn, false), kRounding_mm);
}

TEST(Invariance, MirroringTheObjectMirrorsTheFilm) {
  EXPECT_LT(distance_after(Vec3(-1, 1, 1).asDiagonal(), true), kRounding_mm);
  EXPECT_LT(distance_after(Vec3(1, -1, 1).asDiagonal(), true), kRounding_mm);
}

TEST(Invariance, ThreadsDoNotChangeABit) {
  const FilmMesh film = square_film(4000);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return dip_lopsided(lopsided(), film);
  };
  const DippedFilm one = with_threads(1), two = with_threads(2);
  ASSERT_EQ(one.position.size(), two.position.size());
  EXPECT_EQ(std::memcmp(one.position.data(), two.position.data(), sizeof(Vec3) * film.u.size()), 0);
  EXPECT_EQ(one.state, two.state);
  EXPECT_EQ(one.torn, two.torn);
  EXPECT_EQ(one.stretch, two.stretch);
  EXPECT_EQ(one.area_ratio, two.area_ratio);
}

// Only ratios of moduli matter. Newton stops within 1e-5 mm, which then decides nothing that shows.
TEST(Invariance, StiffeningAllFilmAlikeChangesNothing) {
  const FilmMesh film = square_film(2000);
  auto options = untearing(0.25, 11);
  options.modulus.assign(film.triangles.size(), 1.0);
  const DippedFilm soft = dip_shape(lopsided(), film, options);
  options.modulus.assign(film.triangles.size(), 7.0);
  const DippedFilm stiff = dip_shape(lopsided(), film, options);
  EXPECT_EQ(soft.state, stiff.state);
  for (std::size_t v = 0; v < film.u.size(); ++v)
    EXPECT_LT((soft.position[v] - stiff.position[v]).norm(), 1e-5);
}

// Object triangles say where the surface is, not what the film does: quarter each of them.
TEST(Invariance, RefiningTheObjectsMeshChangesNothing) {
  const Shape coarse = lopsided();
  Shape fine;
  fine.positions = coarse.positions;
  for (const Triangle& t : coarse.triangles) {
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const Vec3 p = 0.5 * (coarse.positions[std::size_t(a)] + coarse.positions[std::size_t(b)]);
      return fine.add(p.x(), p.y(), p.z());
    };
    const std::int32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    fine.triangles.insert(fine.triangles.end(),
                          {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
  }
  const FilmMesh film = square_film(2000);
  const DippedFilm a = dip_lopsided(coarse, film), b = dip_lopsided(fine, film);
  EXPECT_EQ(a.state, b.state);
  for (std::size_t v = 0; v < film.u.size(); ++v)
    EXPECT_LT((a.position[v] - b.position[v]).norm(), kRounding_mm);
}

// With its rest shape's height taken away, the film does not know that it is lifted.
TEST(KnownDips, WithoutZStretchFilmIsProjectedVertically) {
  const FilmMesh film = disc_film(4000);
  auto options = untearing(0.2, 11);
  options.material.z_stretch = 0;
  for (const Shape& shape : {shapes::sphere_bowl(30, 29), shapes::cone(32, 2), lopsided()}) {
    const DippedFilm dipped = dip_shape(shape, film, options);
    int attached = 0;
    for (std::size_t v = 0; v < film.u.size(); ++v) {
      if (dipped.state[v] != VertexState::kAttached) continue;
      ++attached;
      EXPECT_LT((dipped.position[v].head<2>() - film.u[v]).norm(), 2e-3) << film.u[v].transpose();
    }
    EXPECT_GT(attached, 20);
  }
}

TEST(KnownDips, FlatBottomTakesTheFilmAsItIs) {
  const Shape box = shapes::box(Vec3(-20, -14, 0), Vec3(23, 17, 10));
  const FilmMesh film = square_film(4000);
  const DippedFilm dipped = dip_shape(box, film, untearing(0.5, 8));
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    const Vec2& u = film.u[v];
    if (u.x() < -20 || u.x() > 23 || u.y() < -14 || u.y() > 17) continue;
    ASSERT_EQ(dipped.state[v], VertexState::kAttached);
    EXPECT_LT((dipped.position[v] - Vec3(u.x(), u.y(), 0)).norm(), 1e-6);
  }
  for (std::size_t t = 0; t < film.triangles.size(); ++t) {
    bool on_bottom = true;
    for (const std::int32_t v : film.triangles[t])
      on_bottom = on_bottom && dipped.position[std::size_t(v)].z() < 1e-6 &&
                  dipped.state[std::size_t(v)] == VertexState::kAttached;
    EXPECT_TRUE(!on_bottom || dipped.lies_on_object(t));
  }
}

// Over sharp edges, too: film on one mesh settles as the steps get shorter.
TEST(InvarianceSlow, FilmOverEdgesDoesNotDependOnTheStep) {
  const Shape shape = shapes::pyramid(35, 0.8);
  const FilmMesh film = square_film(5000);
  const auto dipped = [&](double step_mm) {
    return dip_shape(shape, film, untearing(step_mm, 24)).position;
  };
  std::vector<Vec3> before = dipped(0.2);
  for (const double step_mm : {0.1, 0.05, 0.025}) {
    const std::vector<Vec3> now = dipped(step_mm);
    double sum = 0, largest = 0;
    int count = 0;
    for (std::size_t v = 0; v < now.size(); ++v) {
      // In one of the two dips it still floats, perhaps.
      if (std::max(now[v].z(), before[v].z()) > 23.5) continue;
      const double moved_mm = (now[v] - before[v]).norm();
      sum += moved_mm * moved_mm;
      largest = std::max(largest, moved_mm);
      ++count;
    }
    EXPECT_GT(count, 200);
    EXPECT_LT(std::sqrt(sum / count), 0.01) << step_mm;
    EXPECT_LT(largest, 0.03) << step_mm;
    before = now;
  }
}

// The rim is taped to the bath: it rises with nothing.
TEST(KnownDips, RimStaysWhereItIsTaped) {
  const FilmMesh film = square_film(1000);
  const DippedFilm dipped = dip_lopsided(lopsided(), film);
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    if (!film.on_rim[v]) continue;
    EXPECT_EQ(dipped.state[v], VertexState::kClamped);
    EXPECT_EQ(dipped.position[v].head<2>(), film.u[v]);
  }
}

}  // namespace
}  // namespace hydrodip
