// The closed loop by simulation: a film model that is wrong, and prints that are corrected by what
// came of them.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "dip/dip.h"
#include "exact/shapes.h"
#include "register/displacement_fit.h"
#include "transfer/film_map.h"

namespace hydrodip::fixtures {

struct LoopOptions {
  int elements = 4000;
  double step_mm = 1;
  double noise_mm = 0.05;
  double drift_mm = 1;
  int rounds = 2;
  int scans = 1;  // of each print
};

class ClosedLoop {
 public:
  explicit ClosedLoop(const LoopOptions& options)
      : options_(options),
        shape_(shapes::full_sphere(30, 60, 80)),
        surface_(shape_.positions, shape_.triangles),
        random_(5) {
    mesh_.positions = shape_.positions;
    mesh_.triangles = shape_.triangles;
  }

  // RMS of where colours land off their place on the sheet: of the first print, then of each
  // corrected one.
  std::vector<double> run() {
    // What the job believes of its film, ink included.
    const Dipped model = dipped({}, 0.65, 600);
    std::vector<double> errors;
    FilmCorrection correction;
    std::vector<CorrectionSample> samples;
    for (int round = 0;; ++round) {
      const Dipped truth = dipped(correction, 0.8, 200);
      errors.push_back(error(model, truth, correction));
      if (round == options_.rounds) return errors;
      for (int scan = 0; scan < options_.scans; ++scan) look(model, truth, samples);
      correction = fit_displacements(samples, {Vec2(-60, -60), Vec2(60, 60)}).field;
    }
  }

 private:
  // A dip of a print that is corrected like that, in printed coordinates.
  struct Dipped {
    std::shared_ptr<const DippedFilm> film;
    std::shared_ptr<const FilmMap> map;
  };

  // Ink by where the job means it to be.
  static double density(const Vec2& u) {
    return 0.25 * (1 + std::sin(u.x() / 7) * std::cos(u.y() / 9));
  }
  // Film drifts unevenly before the object comes.
  Vec2 drift(const Vec2& u) const {
    return options_.drift_mm *
           Vec2(0.8 + 0.4 * std::sin(u.y() / 28), -0.5 + 0.4 * std::cos(u.x() / 33 + u.y() / 50));
  }

  Dipped dipped(const FilmCorrection& correction, double z_stretch, double ratio) const {
    const FilmMesh film = make_film_mesh(
        {.width_mm = 160, .height_mm = 160, .margin_mm = 10, .elements = options_.elements});
    DipOptions options;
    options.step_mm = options_.step_mm;
    options.material.tear_stretch = 0;
    options.material.z_stretch = z_stretch;
    for (const Triangle& t : film.triangles) {
      const Vec2 u =
          (film.u[std::size_t(t[0])] + film.u[std::size_t(t[1])] + film.u[std::size_t(t[2])]) / 3;
      options.modulus.push_back(1 + (ratio - 1) * density(model_of(u, correction)));
    }
    const RunContext context;
    Dipped result;
    result.film = std::make_shared<const DippedFilm>(
        dip(film, shape_.positions, shape_.triangles, surface_,
            make_trajectory({.depth_mm = 12}, shape_.positions), options, context)
            .film);
    result.map = std::make_shared<const FilmMap>(mesh_, surface_, *result.film);
    return result;
  }

  static Vec2 model_of(const Vec2& printed, const FilmCorrection& correction) {
    Vec2 model = printed;
    for (int i = 0; i < 30; ++i) model = printed - correction.at(model);
    return model;
  }

  // Which place of the sheet lands there in truth.
  std::optional<Vec2> printed_at(const Dipped& truth, const Vec3& position,
                                 const Vec3& normal) const {
    const auto film = truth.map->to_film(position, normal);
    if (!film) return std::nullopt;
    Vec2 printed = *film;
    for (int i = 0; i < 30; ++i) printed = *film + drift(printed);
    return printed;
  }

  template <class Visit>
  void on_object(const Visit& visit) const {
    for (double x = -24; x <= 24; x += 3)
      for (double y = -24; y <= 24; y += 3) {
        const auto hit = surface_.first_hit(Vec3(x, y, -1), Vec3::UnitZ(), 0, 100);
        if (hit && Vec2(x, y).norm() < 23) visit(surface_.position(*hit), surface_.normal(*hit));
      }
  }

  double error(const Dipped& model, const Dipped& truth, const FilmCorrection& correction) const {
    double square = 0, count = 0;
    on_object([&](const Vec3& position, const Vec3& normal) {
      const auto meant = model.map->to_film(position, normal);
      const auto is = printed_at(truth, position, normal);
      if (!meant || !is) return;
      square += (*is - *meant - correction.at(*meant)).squaredNorm();
      ++count;
    });
    return std::sqrt(square / count);
  }

  // Marks every 3 mm of the object, measured with noise.
  void look(const Dipped& model, const Dipped& truth, std::vector<CorrectionSample>& samples) {
    std::normal_distribution<double> noise(0, options_.noise_mm);
    on_object([&](const Vec3& position, const Vec3& normal) {
      const auto is = printed_at(truth, position, normal);
      const Vec3 seen = position + Vec3(noise(random_), noise(random_), noise(random_));
      const auto near = surface_.closest_point(seen, 2);
      if (!is || !near) return;
      const auto meant = model.map->to_film(surface_.position(*near), surface_.normal(*near));
      if (meant) samples.push_back({*meant, *is - *meant});
    });
  }

  LoopOptions options_;
  shapes::Shape shape_;
  Surface surface_;
  TriangleMesh mesh_;
  std::mt19937 random_;
};

}  // namespace hydrodip::fixtures
