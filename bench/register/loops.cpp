#include "loops.h"

#include <fmt/format.h>

#include "exact/shapes.h"
#include "register/loop.h"

namespace hydrodip {
namespace {

struct Film {
  std::shared_ptr<const DippedFilm> film;
  std::shared_ptr<const FilmMap> map;
};

Film dipped(const FilmOptions& options, double step_mm, const shapes::Shape& shape,
            const TriangleMesh& mesh, const Surface& surface) {
  DipOptions dip_options;
  dip_options.step_mm = step_mm;
  dip_options.material.tear_stretch = 0;
  Film result;
  result.film = std::make_shared<const DippedFilm>(
      dip(make_film_mesh(options), shape.positions, shape.triangles, surface,
          make_trajectory({.depth_mm = 14}, shape.positions), dip_options, RunContext())
          .film);
  result.map = std::make_shared<const FilmMap>(mesh, surface, *result.film);
  return result;
}

}  // namespace

void closed_loop() {
  fixtures::LoopOptions options;
  options.elements = 20000;
  options.step_mm = 0.4;
  const std::vector<double> error = fixtures::ClosedLoop(options).run();
  fmt::print(
      "closed loop: truth z_stretch 0.8 (believed 0.65), ink ratio 200 (600), drift of 1 mm; "
      "0.05 mm of noise\n  RMS off {:.3f} mm; after one correction {:.3f} (a {:.0f}th; goal: a "
      "fifth), after two {:.3f} (a {:.0f}th; goal: a tenth)\n",
      error[0], error[1], error[0] / error[1], error[2], error[0] / error[2]);
}

void swollen_film() {
  constexpr double x = 1.025, y = 1.015;
  const shapes::Shape shape = shapes::full_sphere(30, 120, 160);
  TriangleMesh mesh;
  mesh.positions = shape.positions;
  mesh.triangles = shape.triangles;
  const Surface surface(shape.positions, shape.triangles);
  const FilmOptions sheet{.width_mm = 210, .height_mm = 297, .margin_mm = 10, .elements = 40000};
  FilmOptions swells = sheet;
  swells.swelling_x = x;
  swells.swelling_y = y;
  FilmOptions large = sheet;
  large.width_mm = 190 * x + 20;
  large.height_mm = 277 * y + 20;
  large.elements = 120000;
  const Film design = dipped(swells, 0.1, shape, mesh, surface);
  const Film naive = dipped(sheet, 0.1, shape, mesh, surface);
  const Film truth = dipped(large, 0.05, shape, mesh, surface);
  double worst = 0, worst_naive = 0, square = 0, count = 0;
  for (double a = 1; a < 25; a += 1)
    for (int k = 0; k < 16; ++k) {
      const Vec2 at = a * Vec2(std::cos(k * M_PI / 8), std::sin(k * M_PI / 8));
      const auto hit = surface.first_hit(Vec3(at.x(), at.y(), -1), Vec3::UnitZ(), 0, 100);
      if (!hit) continue;
      const Vec3 position = surface.position(*hit), normal = surface.normal(*hit);
      const auto lands = [&](const Film& film) -> std::optional<double> {
        const auto printed = film.map->to_film(position, normal);
        if (!printed) return std::nullopt;
        const auto on = truth.map->to_object(printed->cwiseProduct(Vec2(x, y)));
        if (!on) return std::nullopt;
        return (position_at(mesh, *on) - position).norm();
      };
      const auto off = lands(design), off_naive = lands(naive);
      if (!off || !off_naive) continue;
      worst = std::max(worst, *off);
      worst_naive = std::max(worst_naive, *off_naive);
      square += *off * *off;
      ++count;
    }
  fmt::print(
      "designed for film swollen by 2.5 x 1.5 %, dipped so: {:.0f} places land off by {:.4f} "
      "mm rms, worst {:.4f} (goal: 0.05); designed for dry film: worst {:.2f} mm\n",
      count, std::sqrt(square / count), worst, worst_naive);
}

}  // namespace hydrodip
