#include "register/seen_dip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"

namespace hydrodip {
namespace {

// Points of a scan lie so near to the object.
constexpr double kReach_mm = 2;
// A place that lies farther off was not recognised for what it is.
constexpr double kFarthest_mm = 20;

// Places that lie elsewhere are left out; of another dip nearly all do.
void require_most(const std::filesystem::path& file, std::size_t used, std::size_t of,
                  const RunContext& context) {
  constexpr double kLeast = 0.5, kUsual = 0.9;
  const std::string said =
      fmt::format("{}: {} of its {} places lie on the film of this job", file.string(), used, of);
  if (double(used) < kLeast * double(of))
    throw InputError(said + "; check that it is a dip of this job's object in its pose, in mm");
  if (double(used) < kUsual * double(of)) context.warn(said + "; the others are left out.");
}

// Where places were printed, told by where the job means them to be: the linear map that fits best.
// Nothing if they are too few or too near to each other to tell.
std::optional<Mat2> printed_by_meant(const std::vector<Vec2>& printed,
                                     const std::vector<Vec2>& meant) {
  constexpr std::size_t kLeastPlaces = 6;
  constexpr double kLeastSpread_mm = 2;
  if (meant.size() < kLeastPlaces) return std::nullopt;
  Vec2 p0 = Vec2::Zero(), m0 = Vec2::Zero();
  for (const Vec2& p : printed) p0 += p / double(printed.size());
  for (const Vec2& m : meant) m0 += m / double(meant.size());
  Mat2 across = Mat2::Zero(), spread = Mat2::Zero();
  for (std::size_t i = 0; i < meant.size(); ++i) {
    across += (printed[i] - p0) * (meant[i] - m0).transpose() / double(meant.size());
    spread += (meant[i] - m0) * (meant[i] - m0).transpose() / double(meant.size());
  }
  const double half = 0.5 * spread.trace();
  const double least = half - std::sqrt(std::max(0.0, half * half - spread.determinant()));
  if (!(least > kLeastSpread_mm * kLeastSpread_mm)) return std::nullopt;
  return across * spread.inverse();
}

// Film stretches and shifts; it is not turned over, and hardly turned.
void require_likely(const std::filesystem::path& file, const std::vector<Vec2>& printed,
                    const std::vector<Vec2>& meant, const RunContext& context) {
  constexpr double kMuch = 0.15;
  const std::optional<Mat2> map = printed_by_meant(printed, meant);
  if (!map) return;
  if (map->determinant() < 0)
    throw InputError(fmt::format(
        "{}: its places on the sheet are the mirror image of where this job printed them: u and v "
        "are swapped, or one of them has the wrong sign",
        file.string()));
  if ((*map - Mat2::Identity()).norm() > kMuch)
    context.warn(fmt::format(
        "{}: its places on the sheet are turned or scaled against where this job printed them, "
        "more than film stretches; check that they are in mm, from the sheet's middle, and of "
        "this print.",
        file.string()));
}

}  // namespace

SeenDip seen_dip(const std::filesystem::path& file, const SeenPlaces& seen, const PrintedFilm& film,
                 const RunContext& context) {
  SeenDip dip{file, seen.board, seen.square_mm, {}, {}, 0, 0};
  double square = 0, on_object = 0, on_object_count = 0;
  std::vector<Vec2> printed, meant_at;
  for (const SeenPlace& place : seen.places) {
    const auto near = film.posed.surface().closest_point(place.position, kReach_mm);
    if (!near) continue;
    const auto meant =
        film.map->to_film(film.posed.surface().position(*near), film.posed.surface().normal(*near));
    if (!meant) continue;
    printed.push_back(place.printed);
    meant_at.push_back(*meant);
    const Vec2 model = film.to_model(*meant), off = place.printed - *meant;
    if (!(off.norm() < kFarthest_mm)) continue;
    dip.samples.push_back({model, place.printed - model});
    dip.mean_off += off;
    square += off.squaredNorm();
    if (const auto lands = film.map->to_object(place.printed)) {
      on_object += (position_at(film.posed.mesh(), *lands) - place.position).squaredNorm();
      ++on_object_count;
    }
  }
  require_likely(file, printed, meant_at, context);
  if (dip.samples.empty())
    throw InputError(
        fmt::format("{}: none of its places lies on the film of this job; check that it is a dip "
                    "of this job's object in its pose",
                    file.string()));
  require_most(file, dip.samples.size(), seen.places.size(), context);
  dip.mean_off /= double(dip.samples.size());
  dip.rms_off_mm = std::sqrt(square / double(dip.samples.size()));
  if (on_object_count > 0) dip.rms_on_object_mm = std::sqrt(on_object / on_object_count);
  return dip;
}

void require_different(const std::vector<SeenDip>& dips) {
  const auto same = [](const CorrectionSample& a, const CorrectionSample& b) {
    return a.model_mm == b.model_mm && a.move_mm == b.move_mm;
  };
  for (std::size_t i = 0; i < dips.size(); ++i)
    for (std::size_t j = i + 1; j < dips.size(); ++j)
      if (std::ranges::equal(dips[i].samples, dips[j].samples, same))
        throw InputError(fmt::format("{} and {} say the same, place by place: give each dip once",
                                     dips[i].file.string(), dips[j].file.string()));
}

double between_dips_mm(const std::vector<SeenDip>& dips) {
  Vec2 mean = Vec2::Zero();
  for (const SeenDip& dip : dips) mean += dip.mean_off / double(dips.size());
  double square = 0;
  for (const SeenDip& dip : dips) square += (dip.mean_off - mean).squaredNorm();
  return dips.size() > 1 ? std::sqrt(square / double(dips.size() - 1)) : 0;
}

SeenMisfit misfit_of(const std::vector<SeenDip>& dips) {
  double square = 0, on_object = 0, count = 0;
  for (const SeenDip& dip : dips) {
    const auto n = double(dip.samples.size());
    square += n * dip.rms_off_mm * dip.rms_off_mm;
    on_object += n * dip.rms_on_object_mm * dip.rms_on_object_mm;
    count += n;
  }
  return {count, std::sqrt(square / count), std::sqrt(on_object / count)};
}

}  // namespace hydrodip
