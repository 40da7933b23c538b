// The film after a dip, as arrays: where every bit of it lies, and how far it is stretched.
#include <hydrodip/hydrodip.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

int main() {
  // A sphere of radius 30 mm, dipped 15 mm deep: its lowest point is the origin.
  const hydrodip::PosedObject posed = hydrodip::pose(hydrodip::sample("sphere"));
  hydrodip::SimulationOptions options;
  options.film = {.width_mm = 120, .height_mm = 120, .elements = 10000};
  options.trajectory.depth_mm = 15;
  options.dip.material.tear_stretch = 0;  // whatever it takes
  const hydrodip::DippedObject dipped = hydrodip::simulate(posed, options);

  // Vertices: u is where it was printed, position where it has come to.
  const hydrodip::DippedFilm& film = *dipped.film;
  const hydrodip::FilmMesh& mesh = film.mesh();
  const hydrodip::Vec3 centre(0, 0, 30);
  std::size_t attached = 0;
  double off_mm = 0;
  for (std::size_t v = 0; v < mesh.u.size(); ++v) {
    if (film.state[v] != hydrodip::VertexState::kAttached) continue;
    ++attached;
    off_mm = std::max(off_mm, std::abs((film.position[v] - centre).norm() - 30));
  }

  // Triangles: their area now, and as they were printed, where they lie on the object.
  double area_mm2 = 0, printed_mm2 = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    const auto a = std::size_t(mesh.triangles[t][0]), b = std::size_t(mesh.triangles[t][1]),
               c = std::size_t(mesh.triangles[t][2]);
    const hydrodip::Vec3 ab = film.position[b] - film.position[a];
    const hydrodip::Vec3 ac = film.position[c] - film.position[a];
    area_mm2 += ab.cross(ac).norm() / 2;
    printed_mm2 += hydrodip::cross2(mesh.u[b] - mesh.u[a], mesh.u[c] - mesh.u[a]) / 2;
  }

  std::printf("film: %zu vertices, %zu triangles\n", mesh.u.size(), mesh.triangles.size());
  std::printf("attached: %zu vertices, at most %.4f mm off the sphere\n", attached, off_mm);
  std::printf("on the sphere: %.1f mm2 of film, printed on %.1f mm2\n", area_mm2, printed_mm2);
  std::printf("area ratio: %.6f on average; coverage says %.6f\n", area_mm2 / printed_mm2,
              dipped.coverage.area_ratio_mean);
}
