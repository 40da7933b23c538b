#include "calibrate/expectation.h"

#include <Eigen/Dense>
#include <memory>

#include "base/parallel.h"
#include "calibrate/misfit.h"

namespace hydrodip {
namespace {

// Over which differences are taken; of 1 / sqrt(ratio), a share.
constexpr double kStretchStep = 0.02, kRatioStep = 0.15, kPoissonStep = 0.05;

// Corners that all of some dips lay down.
std::vector<GridPlace> common_corners(const std::vector<const Landings*>& dips) {
  std::vector<GridPlace> places;
  const GridPlace reach = dips.front()->reach;
  for (int row = -reach[1]; row <= reach[1]; ++row)
    for (int column = -reach[0]; column <= reach[0]; ++column) {
      bool everywhere = true;
      for (const Landings* dip : dips) everywhere &= dip->find({column, row}) != nullptr;
      if (everywhere) places.push_back({column, row});
    }
  return places;
}

// What one scan adds to the information, by FitPoint; noise of 1.
Eigen::Matrix3d information(const Board& board, const std::vector<const Landings*>& dips,
                            const FitPoint& step, const std::vector<GridPlace>& places,
                            bool pose_known) {
  Eigen::MatrixXd slope(3 * Eigen::Index(places.size()), 3);
  for (std::size_t c = 0; c < places.size(); ++c)
    for (std::size_t k = 0; k < 3; ++k)
      slope.block<3, 1>(3 * Eigen::Index(c), Eigen::Index(k)) =
          (dips[2 * k + 2]->find(places[c])->position -
           dips[2 * k + 1]->find(places[c])->position) /
          (2 * step[Eigen::Index(k)]);
  const Eigen::MatrixXd left =
      without(slope, orthonormal(open_motions(board, *dips[0], places, pose_known)));
  return left.transpose() * left;
}

}  // namespace

Expectation expect(const std::vector<CalibrationObject>& objects, const CheckeredFilm& film,
                   const DesignOptions& design, const FilmParameters& truth, double noise_mm,
                   const RunContext& context, bool pose_known) {
  const FitPoint center = to_fit(truth);
  const FitPoint step(kStretchStep, kRatioStep * center[1], kPoissonStep);
  std::vector<FitPoint> points = {center};
  for (int k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0})
      points.push_back(center + side * step[k] * FitPoint::Unit(k));

  std::vector<std::unique_ptr<Surface>> surfaces;
  surfaces.reserve(objects.size());
  for (const CalibrationObject& object : objects)
    surfaces.push_back(std::make_unique<Surface>(object.object.positions, object.object.triangles));
  const GridPlace reach = reach_of(design.film, film.board.square_mm);
  std::vector<Landings> all(objects.size() * points.size());
  parallel_for(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    const ThreadLimit alone(1);  // one dip per thread
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t s = i / points.size();
      const CheckerboardDip dip =
          dip_checkerboard(film, objects[s], *surfaces[s], from_fit(points[i % points.size()]),
                           design.dip, context.quiet());
      all[i] = landings_of(dip, objects[s], reach);
    }
  });

  Expectation result;
  result.truth = truth;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t s = 0; s < objects.size(); ++s) {
    std::vector<const Landings*> dips;
    for (std::size_t p = 0; p < points.size(); ++p) dips.push_back(&all[s * points.size() + p]);
    const std::vector<GridPlace> places = common_corners(dips);
    result.corners += places.size();
    sum += information(film.board, dips, step, places, pose_known);
  }
  const Eigen::Vector3d deviation = noise_mm * sum.inverse().diagonal().cwiseSqrt();
  result.z_stretch = deviation[0];
  result.ln_ratio = 2 * deviation[1] / center[1];
  result.poisson = deviation[2];
  return result;
}

}  // namespace hydrodip
