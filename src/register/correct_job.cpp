#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "image/files.h"
#include "register/arrow_map.h"
#include "register/displacement_fit.h"
#include "register/place_table.h"
#include "register/printed_film.h"
#include "register/register.h"
#include "scan/read_scan.h"
#include "scan/registration.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFile = "correction.json";
constexpr const char* kPicture = "correction.png";
// Points of a scan lie so near to the object.
constexpr double kReach_mm = 2;
// A place that lies farther off was not recognised for what it is.
constexpr double kFarthest_mm = 20;

// One place of the sheet that was seen on the object.
struct Landed {
  Vec2 printed = Vec2::Zero();   // where it was on the sheet
  Vec3 position = Vec3::Zero();  // where it lies: posed-object frame
};

GridLanding landing_of(const PrintedFilm& film, double square_mm) {
  return [&film, square_mm](const GridPlace& place) -> std::optional<Vec3> {
    const auto at = film.map->to_object(square_mm * Vec2(place[0], place[1]));
    if (!at) return std::nullopt;
    return position_at(film.posed.mesh(), *at);
  };
}

std::vector<Landed> read_grid(const std::filesystem::path& file, const PrintedFilm& film,
                              const FilmOptions& sheet, const CorrectRequest& request) {
  const Scan scan = read_scan(file, {request.scan_units, request.square_mm, false});
  const GridLanding landing = landing_of(film, request.square_mm);
  const GridMatch match = match_grid(scan.grid, landing, reach_of(sheet, request.square_mm),
                                     request.square_mm, file.string());
  if (match.mirrored)
    throw InputError(
        fmt::format("{}: only the scan's mirror image fits the object; save it without mirroring",
                    file.string()));
  const CornerGrid grid =
      request.aligned
          ? scan.grid
          : moved(scan.grid, align(scan.grid, match, film.posed.surface(), landing).pose);
  std::vector<Landed> landed;
  for (std::size_t i = 0; i < grid.position.size(); ++i)
    if (match.place[i])
      landed.push_back(
          {request.square_mm * Vec2((*match.place[i])[0], (*match.place[i])[1]), grid.position[i]});
  return landed;
}

struct DipSeen {
  std::filesystem::path file;
  std::vector<CorrectionSample> samples;
  Vec2 mean_off = Vec2::Zero();  // from what the print meant, on the sheet
  double rms_off_mm = 0;
  double rms_on_object_mm = 0;
};

DipSeen seen_by(const std::filesystem::path& file, const PrintedFilm& film,
                const FilmOptions& sheet, const CorrectRequest& request) {
  std::vector<Landed> landed;
  const bool is_table = is_place_table(file);
  if (is_table)
    for (const PlaceRow& row : read_place_table(file))
      landed.push_back({row.on_sheet, row.position});
  else
    landed = read_grid(file, film, sheet, request);
  DipSeen dip{file, {}, {}, 0, 0};
  double square = 0, on_object = 0, on_object_count = 0;
  for (const Landed& place : landed) {
    const auto near = film.posed.surface().closest_point(place.position, kReach_mm);
    if (!near) continue;
    const auto meant =
        film.map->to_film(film.posed.surface().position(*near), film.posed.surface().normal(*near));
    if (!meant) continue;
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
  if (dip.samples.empty())
    throw InputError(
        fmt::format("{}: none of its places lies on the film of this job; check that it is a dip "
                    "of this job's object in its pose",
                    file.string()));
  dip.mean_off /= double(dip.samples.size());
  // The kit's usual board has a square's middle where the black one has a corner.
  constexpr double kNearlyHalf = 0.4;
  if (!is_table && (dip.mean_off.cwiseAbs().array() > kNearlyHalf * request.square_mm).all())
    throw InputError(fmt::format(
        "{}: its corners lie half a square beside their places; dip the board whose corner is the "
        "film's centre (hydrodip calibrate kit --board black), or tell places in a table",
        file.string()));
  dip.rms_off_mm = std::sqrt(square / double(dip.samples.size()));
  if (on_object_count > 0) dip.rms_on_object_mm = std::sqrt(on_object / on_object_count);
  return dip;
}

// What differs from dip to dip cannot be corrected: the mean distance of a dip's shift from that of
// all.
double between_dips_mm(const std::vector<DipSeen>& dips) {
  Vec2 mean = Vec2::Zero();
  for (const DipSeen& dip : dips) mean += dip.mean_off / double(dips.size());
  double square = 0;
  for (const DipSeen& dip : dips) square += (dip.mean_off - mean).squaredNorm();
  return dips.size() > 1 ? std::sqrt(square / double(dips.size() - 1)) : 0;
}

Json pair_of(const Vec2& v) { return {v.x(), v.y()}; }

Json json_of(const std::vector<DipSeen>& dips, const std::vector<CorrectionSample>& samples,
             const DisplacementFit& fit) {
  Json seen = Json::array(), moves = Json::array(), kept = Json::array();
  for (const DipSeen& dip : dips)
    seen.push_back({{"file", dip.file.string()},
                    {"places", dip.samples.size()},
                    {"mean_off_mm", pair_of(dip.mean_off)},
                    {"rms_on_sheet_mm", dip.rms_off_mm},
                    {"rms_on_object_mm", dip.rms_on_object_mm}});
  for (const Vec2& move : fit.field.move) moves.push_back(pair_of(move));
  for (const CorrectionSample& s : samples)
    kept.push_back({{"model_mm", pair_of(s.model_mm)}, {"move_mm", pair_of(s.move_mm)}});
  return {{"schema_version", 1},
          {"generator", "hydrodip correct"},
          {"dips", seen},
          {"between_dips_mm", between_dips_mm(dips)},
          {"smooth_mm", fit.smooth_mm},
          {"noise_mm", fit.noise_mm},
          {"left_out_rms_mm", fit.left_out_rms_mm},
          {"grid",
           {{"first_mm", pair_of(fit.field.first)},
            {"pitch_mm", fit.field.pitch_mm},
            {"nx", fit.field.nx},
            {"ny", fit.field.ny},
            {"move_mm", moves},
            {"sigma_mm", fit.sigma_mm}}},
          {"samples", kept}};
}

// Arrows where the field is known.
Image draw_field(const DisplacementFit& fit, const FilmOptions& film, double before_mm) {
  std::vector<Arrow> arrows;
  constexpr int kEvery = 2;
  double least = 1e300;
  for (const double sigma : fit.sigma_mm) least = std::min(least, sigma);
  for (int j = 0; j < fit.field.ny; j += kEvery)
    for (int i = 0; i < fit.field.nx; i += kEvery) {
      const std::size_t at = std::size_t(j) * std::size_t(fit.field.nx) + std::size_t(i);
      const Vec2 u = fit.field.first + fit.field.pitch_mm * Vec2(i, j);
      if (is_free(film, u) && fit.sigma_mm[at] < std::max(0.1, 3 * least))
        arrows.push_back({u, fit.field.move[at]});
    }
  return draw_arrow_map(
      film.width_mm, film.height_mm, film.margin_mm, arrows, "How much farther to print",
      {fmt::format("off by {:.2f} mm rms on this print", before_mm),
       fmt::format("places left out are foretold to {:.2f} mm", fit.left_out_rms_mm),
       "arrows where the field is known"});
}

}  // namespace

JobResult correct_job(const RigJob& job, const CorrectRequest& request, const RunContext& context) {
  const RunScope scope(context.with_threads(job.config.threads));
  OutputFolder output(job.folder);
  std::vector<std::filesystem::path> inputs = request.scans;
  if (!job.config.correction.empty()) inputs.push_back(job.config.correction);
  output.announce({kFile, kPicture}, inputs);
  context.progress("reading the dips", 0);
  const PrintedFilm film = read_printed_film(job, context);
  const FilmOptions& sheet = job.config.design.film;
  std::vector<DipSeen> dips;
  std::vector<CorrectionSample> samples;
  double square = 0, on_object = 0, count = 0;
  for (const std::filesystem::path& scan : request.scans) {
    dips.push_back(seen_by(scan, film, sheet, request));
    const DipSeen& dip = dips.back();
    const auto n = double(dip.samples.size());
    samples.insert(samples.end(), dip.samples.begin(), dip.samples.end());
    square += n * dip.rms_off_mm * dip.rms_off_mm;
    on_object += n * dip.rms_on_object_mm * dip.rms_on_object_mm;
    count += n;
  }
  // What earlier dips said counts as much.
  if (film.correction)
    for (const CorrectionSample& s : read_correction(job.config.correction).samples)
      samples.push_back(s);
  context.progress("fitting the correction", 0.3);
  const Vec2 half = 0.5 * Vec2(sheet.width_mm, sheet.height_mm);
  const DisplacementFit fit = fit_displacements(samples, {-half, half});
  const double before_mm = std::sqrt(square / count);

  JobResult result;
  result.json = json_of(dips, samples, fit).dump(-1) + "\n";
  write_file(output.path(kFile), result.json);
  save_png(output.path(kPicture), draw_field(fit, sheet, before_mm));
  context.progress("fitting the correction", 1);
  output.commit();
  result.folder = job.folder;
  result.files = {kFile, kPicture};
  result.text = fmt::format(
      "{} dips, {:.0f} places: off by {:.3f} mm rms on the sheet, {:.3f} mm on the object\n"
      "corrected, places that were left out are foretold to {:.3f} mm, of which {:.3f} mm are "
      "noise; it changes over {:g} mm\n",
      dips.size(), count, before_mm, std::sqrt(on_object / count), fit.left_out_rms_mm,
      std::sqrt(2.0) * fit.noise_mm, fit.smooth_mm);
  if (dips.size() > 1)
    result.text += fmt::format(
        "from dip to dip the film lay {:.3f} mm elsewhere: no correction takes that out\n",
        between_dips_mm(dips));
  result.text += fmt::format("wrote {0}/{1} and {0}/{2}\nprint again with --correction {0}/{1}\n",
                             job.folder.string(), kFile, kPicture);
  return result;
}

}  // namespace hydrodip
