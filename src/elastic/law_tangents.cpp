#include "elastic/law_tangents.h"

#include "base/parallel.h"
#include "elastic/material_law.h"

namespace hydrodip {

std::vector<std::int32_t> LawTangents::update(const FilmEnergy& energy, const FilmMesh& mesh,
                                              const GridField& u, bool definite, double tolerance) {
  const std::size_t triangles = mesh.triangles.size();
  kept_.resize(triangles, Part{});
  std::vector<std::uint8_t> differs(triangles, 0);
  parallel_for(triangles, kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const RestTriangle rest = energy.rest(t);
      Part part{};
      if (rest.area > 0) {
        const std::array<Vec2, 3> at = energy.grid().corners(mesh.triangles[t], u);
        const LawStiffness stiffness(
            law_state(*energy.law(), deformation_gradient(rest, at[0], at[1], at[2])), definite);
        const double weight = rest.area * energy.modulus(t);
        for (Eigen::Index a = 0; a < 3; ++a)
          for (Eigen::Index b = 0; b < 3; ++b) {
            const Mat2 K = weight * stiffness.block(rest.gradient.row(a), rest.gradient.row(b));
            part[std::size_t(3 * a + b)] = {float(K(0, 0)), float(K(0, 1)), float(K(1, 0)),
                                            float(K(1, 1))};
          }
      }
      double apart = 0, size = 0;
      for (std::size_t n = 0; n < 9; ++n)
        for (std::size_t e = 0; e < 4; ++e) {
          const double d = double(part[n][e]) - double(kept_[t][n][e]);
          apart += d * d;
          size += double(part[n][e]) * double(part[n][e]);
        }
      differs[t] = apart > tolerance * tolerance * size;
      if (differs[t]) kept_[t] = part;
    }
  });
  std::vector<std::int32_t> list;
  for (std::size_t t = 0; t < triangles; ++t)
    if (differs[t]) list.push_back(std::int32_t(t));
  return list;
}

}  // namespace hydrodip
