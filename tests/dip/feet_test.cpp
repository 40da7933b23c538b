// Feet while the object turns under the film.
#include "dip/feet.h"

#include <gtest/gtest.h>

#include <limits>

#include "exact/shapes.h"

namespace hydrodip {
namespace {

// The tip of a flat cone has touched the middle vertex of film that lies even, and then turns in
// place: the film that was laid around the tip turns along. Where nothing is gained by height, the
// way along the object is the way seen from above, and no ghost lies further from its vertex than
// half of that.
TEST(Feet, GhostsStayByTheirVertexHoweverTheObjectTurns) {
  constexpr double kSlope = 0.3, kRadius_mm = 2;
  const shapes::Shape cone = shapes::cone(20, kSlope);
  const Surface surface(cone.positions, cone.triangles);
  const FilmMesh film = make_film_mesh(
      {.width_mm = 80, .height_mm = 80, .margin_mm = 10, .elements = 450, .grading = 1});
  ASSERT_GT(film.cell_mm, 1.5 * kRadius_mm);
  DipOptions options;
  options.material.z_stretch = 0;
  const RunContext context;
  for (const double turn_deg : {0.0, 8.0, 60.0, 90.0, -90.0}) {
    const double level_mm = kSlope * kRadius_mm;
    const Travel travel(
        Trajectory::through(
            {{}, {.lower_mm = level_mm}, {.lower_mm = 1.01 * level_mm, .turn_z_deg = turn_deg}}),
        cone.positions, cone.triangles);
    Moment touched = travel.at(0);
    for (double way = 0; way < travel.length_mm() && touched.t < 0.499; way += 0.01)
      touched = travel.at(way);
    DipState state;
    for (std::size_t v = 0; v < film.u.size(); ++v) {
      state.position.emplace_back(film.u[v].x(), film.u[v].y(), 0);
      state.state.push_back(film.on_rim[v] ? VertexState::kClamped : VertexState::kUnattached);
    }
    state.torn.assign(film.triangles.size(), 0);
    state.torn_at_mm.assign(film.triangles.size(), std::numeric_limits<double>::infinity());
    state.moment = touched;
    const DipSetting setting{film,    cone.positions, cone.triangles, surface,
                             options, travel,         context};
    FloatingSheet sheet(setting, state);
    Feet feet(setting, state);
    Waterline line(cone.positions, cone.triangles, film.cell_mm);
    line.move_to(touched);

    const std::int32_t tip =
        film.vertex_at[std::size_t(film.ny / 2) * std::size_t(film.nx) + std::size_t(film.nx / 2)];
    ASSERT_LT(film.u[std::size_t(tip)].norm(), 1e-9);
    const std::vector<Touch> touches = {{tip, {Vec3::Zero(), Vec3(0, 0, -1)}}};
    const std::vector<Foot> created = feet.created_for(touches, sheet, line, touched);
    state.state[std::size_t(tip)] = VertexState::kAttached;
    state.position[std::size_t(tip)] = Vec3::Zero();
    sheet.attach_at(tip, Vec2::Zero());
    for (auto n = film.incident_begin[std::size_t(tip)];
         n < film.incident_begin[std::size_t(tip) + 1]; ++n)
      sheet.update_load(std::size_t(film.incident[std::size_t(n)]));
    feet.replace(created, sheet);

    const double start_mm = touched.travelled_mm;
    constexpr int kSteps = 12;
    for (int n = 1; n <= kSteps; ++n) {
      const Moment to = travel.at(start_mm + (travel.length_mm() - start_mm) * n / kSteps);
      line.move_to(to);
      feet.climb(sheet, line, to);
      state.moment = to;
    }
    ASSERT_EQ(feet.line_triangles().size(), 8U);
    for (const std::size_t t : feet.line_triangles())
      for (std::size_t k = 0; k < 3; ++k) {
        if (film.triangles[t][k] != tip) continue;
        const auto ghost = feet.ghost(t, k);
        ASSERT_TRUE(ghost);
        EXPECT_LT(ghost->norm(), turn_deg == 0 ? 1e-6 : 0.51 * kRadius_mm) << turn_deg;
      }
  }
}

}  // namespace
}  // namespace hydrodip
