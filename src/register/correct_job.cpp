#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "image/files.h"
#include "job/correction_fit.h"
#include "register/arrow_map.h"
#include "register/displacement_fit.h"
#include "register/place_table.h"
#include "register/printed_film.h"
#include "register/register.h"
#include "scan/board.h"
#include "scan/read_scan.h"
#include "scan/registration.h"
#include "settings/settings.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kStem = "correction";
// Points of a scan lie so near to the object.
constexpr double kReach_mm = 2;
// A place that lies farther off was not recognised for what it is.
constexpr double kFarthest_mm = 20;

// One place of the sheet that was seen on the object.
struct Landed {
  Vec2 printed = Vec2::Zero();   // where it was on the sheet
  Vec3 position = Vec3::Zero();  // where it lies: posed-object frame
};

GridLanding landing_of(const PrintedFilm& film, const Board& board) {
  return [&film, board](const GridPlace& place) -> std::optional<Vec3> {
    const auto at = film.map->to_object(board.on_film(place));
    if (!at) return std::nullopt;
    return position_at(film.posed.mesh(), *at);
  };
}

// A scan, taken for one of a board.
struct Reading {
  Board board;
  std::vector<std::optional<GridPlace>> place;
  CornerGrid grid;  // posed-object frame
  bool turned = false, mirrored = false;
  double off_mm = 0;  // rms of the corners from where the job lays them
};

double distance_mm(const Reading& reading, const GridLanding& landing) {
  double square = 0, count = 0;
  for (std::size_t c = 0; c < reading.place.size(); ++c) {
    if (!reading.place[c]) continue;
    const auto lands = landing(*reading.place[c]);
    if (!lands) continue;
    square += (*lands - reading.grid.position[c]).squaredNorm();
    ++count;
  }
  return std::sqrt(square / count);
}

Reading reading_as(const Board& board, const CornerGrid& scan, const PrintedFilm& film,
                   const FilmOptions& sheet, bool aligned, const std::string& name) {
  const GridLanding landing = landing_of(film, board);
  const GridPlace reach = reach_of(sheet, board.square_mm);
  Reading reading{board, {}, scan};
  reading.place.resize(scan.position.size());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (!aligned) {
    const GridMatch match = match_grid(scan, landing, reach, board.square_mm, name);
    pose = align(scan, match, film.posed.surface(), landing).pose;
    reading.place = match.place;
    reading.turned = match.turned;
    reading.mirrored = match.mirrored;
  }
  place_patches(scan, pose, reading.turned, landing, reach, board.square_mm, reading.place);
  if (std::none_of(reading.place.begin(), reading.place.end(),
                   [](const auto& place) { return place.has_value(); }))
    throw InputError(fmt::format(
        "{}, taken for the {} board: {}", name, board.name,
        why_unplaced(moved(scan, pose), film.posed.surface(), landing, reach, board.square_mm)));
  reading.grid = moved(scan, pose);
  reading.off_mm = distance_mm(reading, landing);
  return reading;
}

// The boards lie half a square beside each other along both axes. One is believed that fits clearly
// better, and so well that film that lay that far off is not taken for the other one.
bool is_clear(const Reading& best, const Reading& other) {
  constexpr double kClearlyBetter = 0.7, kLargestOff_squares = 0.25;
  return best.off_mm < kClearlyBetter * other.off_mm &&
         best.off_mm < kLargestOff_squares * best.board.square_mm;
}

Reading best_reading(const std::vector<Board>& boards, const CornerGrid& scan,
                     const PrintedFilm& film, const FilmOptions& sheet, bool aligned,
                     const std::string& name) {
  std::vector<Reading> readings;
  std::string refusal;
  for (const Board& board : boards) {
    try {
      readings.push_back(reading_as(board, scan, film, sheet, aligned, name));
    } catch (const InputError& error) {
      refusal = error.what();
    }
  }
  if (readings.empty()) throw InputError(refusal);
  std::sort(readings.begin(), readings.end(),
            [](const Reading& a, const Reading& b) { return a.off_mm < b.off_mm; });
  if (readings.size() > 1 && !is_clear(readings[0], readings[1]))
    throw InputError(
        fmt::format("{}: could be of the {} board, {:.2f} mm off, or of the {} one, {:.2f} mm off; "
                    "say which one "
                    "was dipped, with --board tints (what the kit prints) or --board black",
                    name, readings[0].board.name, readings[0].off_mm, readings[1].board.name,
                    readings[1].off_mm));
  return readings[0];
}

std::vector<Board> boards_asked(const CorrectRequest& request) {
  if (!request.board.empty()) return {board_named(request.board, request.square_mm)};
  return {tint_board(request.square_mm > 0 ? request.square_mm : kTintSquare_mm),
          black_board(request.square_mm > 0 ? request.square_mm : kBlackSquare_mm)};
}

// What a dip came to.
struct Landings {
  std::vector<Landed> places;
  std::string board;  // whose corners these are; empty: places from a table
  double square_mm = 0;
};

Landings read_grid(const std::filesystem::path& file, const PrintedFilm& film,
                   const FilmOptions& sheet, const CorrectRequest& request,
                   const RunContext& context) {
  const std::vector<Board> boards = boards_asked(request);
  const Scan scan = read_scan(file, {request.scan_units, boards.front().square_mm, false}, context);
  const Reading reading =
      best_reading(boards, scan.grid, film, sheet, request.aligned, file.string());
  if (reading.mirrored)
    throw InputError(
        fmt::format("{}: only the scan's mirror image fits the object; save it without mirroring",
                    file.string()));
  if (reading.turned)
    throw InputError(fmt::format(
        "{}: rows and columns run the wrong way round: its faces look into the object, or it is a "
        "mirror image, of which the correction would be wrong; turn its faces outwards, or save it "
        "without mirroring",
        file.string()));
  Landings landings{{}, reading.board.name, reading.board.square_mm};
  for (std::size_t i = 0; i < reading.place.size(); ++i)
    if (reading.place[i])
      landings.places.push_back(
          {reading.board.on_film(*reading.place[i]), reading.grid.position[i]});
  return landings;
}

Landings read_table(const std::filesystem::path& file, const CorrectRequest& request) {
  if ((!request.scan_units.empty() && request.scan_units != "mm") || !request.board.empty() ||
      request.square_mm > 0)
    throw InputError(fmt::format(
        "{}: a table of places is in mm and of no board: leave out --scan-units, --board and "
        "--square",
        file.string()));
  Landings landings;
  for (const PlaceRow& row : read_place_table(file))
    landings.places.push_back({row.on_sheet, row.position});
  return landings;
}

struct DipSeen {
  std::filesystem::path file;
  std::string board;  // as of its landings
  double square_mm = 0;
  std::vector<CorrectionSample> samples;
  Vec2 mean_off = Vec2::Zero();  // from what the print meant, on the sheet
  double rms_off_mm = 0;
  double rms_on_object_mm = 0;
};

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

DipSeen seen_by(const std::filesystem::path& file, const PrintedFilm& film,
                const FilmOptions& sheet, const CorrectRequest& request,
                const RunContext& context) {
  const Landings landings = is_place_table(file) ? read_table(file, request)
                                                 : read_grid(file, film, sheet, request, context);
  DipSeen dip{file, landings.board, landings.square_mm, {}, {}, 0, 0};
  double square = 0, on_object = 0, on_object_count = 0;
  std::vector<Vec2> printed, meant_at;
  for (const Landed& place : landings.places) {
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
  require_most(file, dip.samples.size(), landings.places.size(), context);
  dip.mean_off /= double(dip.samples.size());
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

Json json_of(const CorrectedDip& of) {
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i)
    rows.push_back({of.to_posed(i, 0), of.to_posed(i, 1), of.to_posed(i, 2)});
  return {{"model",
           {{"path", of.model}, {"sha256", of.model_sha256}, {"shape_sha256", of.shape_sha256}}},
          {"to_posed", rows},
          {"size_mm", {of.size_mm.x(), of.size_mm.y(), of.size_mm.z()}},
          {"depth_mm", of.depth_mm},
          {"film",
           {{"width_mm", of.film_mm.x()},
            {"height_mm", of.film_mm.y()},
            {"margin_mm", of.margin_mm},
            {"swelling_x", of.swelling.x()},
            {"swelling_y", of.swelling.y()}}},
          {"material",
           {{"z_stretch", of.z_stretch},
            {"poisson", of.poisson},
            {"ink_stiffness_ratio", of.ink_stiffness_ratio}}},
          {"way", of.way}};
}

Json json_of(const CorrectedDip& of, const std::vector<DipSeen>& dips,
             const std::vector<CorrectionSample>& samples, const DisplacementFit& fit) {
  Json seen = Json::array(), moves = Json::array(), kept = Json::array();
  for (const DipSeen& dip : dips)
    seen.push_back({{"file", dip.file.string()},
                    {"board", dip.board},
                    {"square_mm", dip.square_mm},
                    {"places", dip.samples.size()},
                    {"mean_off_mm", pair_of(dip.mean_off)},
                    {"rms_on_sheet_mm", dip.rms_off_mm},
                    {"rms_on_object_mm", dip.rms_on_object_mm}});
  for (const Vec2& move : fit.field.move) moves.push_back(pair_of(move));
  for (const CorrectionSample& s : samples)
    kept.push_back({{"model_mm", pair_of(s.model_mm)}, {"move_mm", pair_of(s.move_mm)}});
  return {{"schema_version", kCorrectionSchemaVersion},
          {"generator", "hydrodip correct"},
          {"of", json_of(of)},
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

// The same dip twice is no second witness.
void require_different(const std::vector<DipSeen>& dips) {
  const auto same = [](const CorrectionSample& a, const CorrectionSample& b) {
    return a.model_mm == b.model_mm && a.move_mm == b.move_mm;
  };
  for (std::size_t i = 0; i < dips.size(); ++i)
    for (std::size_t j = i + 1; j < dips.size(); ++j)
      if (std::ranges::equal(dips[i].samples, dips[j].samples, same))
        throw InputError(fmt::format("{} and {} say the same, place by place: give each dip once",
                                     dips[i].file.string(), dips[j].file.string()));
}

// Beyond its places a correction goes on as it was.
void require_moderate(const DisplacementFit& fit) {
  if (fit.field.farthest_mm() > kFarthestCorrection_mm)
    throw InputError(fmt::format(
        "the places that were seen ask for the print to be moved by {:.0f} mm somewhere, which is "
        "no correction: check that they are of this print and its object, in mm",
        fit.field.farthest_mm()));
}

// What its files are called: a correction that this print was made with stays, as the film is
// where that one put it.
std::string free_stem(const RigJob& job) {
  std::error_code ignored;
  const auto is_used = [&](const std::string& stem) {
    return std::filesystem::equivalent(job.folder / (stem + ".json"), job.config.correction,
                                       ignored);
  };
  std::string stem = kStem;
  for (int number = 2; is_used(stem); ++number) stem = fmt::format("{}-{}", kStem, number);
  return stem;
}

// The file with a table for each of several dips, where paths are relative to it. Empty: there is
// none any more.
std::filesystem::path job_file_of(const RigJob& job) {
  std::filesystem::path found;
  for (const std::filesystem::path& file : job.settings_files) try {
      const std::vector<Setting> settings = read_settings(file);
      if (std::ranges::any_of(settings,
                              [](const Setting& s) { return s.name.starts_with("dip["); }))
        found = file;
    } catch (const InputError&) {
      // Gone, or something else by now.
    }
  return found;
}

std::string how_to_print(const RigJob& job, const std::string& file) {
  const std::filesystem::path path = job.folder / file;
  if (job.earlier_dips == 0 && job.next_dip == 0) return "--correction " + path.string();
  const std::filesystem::path job_file = job_file_of(job);
  if (job_file.empty())
    return fmt::format("correction = \"{}\" in this dip's [[dip]] table of the job file",
                       std::filesystem::absolute(path).lexically_normal().string());
  const std::filesystem::path folder = std::filesystem::absolute(job_file).parent_path();
  return fmt::format("correction = \"{}\" in the [[dip]] table {} of {}",
                     std::filesystem::proximate(path, folder).string(), job.earlier_dips + 1,
                     job_file.string());
}

// Places are looked up on the model as it is now.
void warn_of_change(const RigJob& job, const CorrectedDip& of, const RunContext& context) {
  if (of.model_sha256.empty() || job.model_sha256.empty() || of.model_sha256 == job.model_sha256)
    return;
  context.warn(fmt::format(
      "{} has changed since it was printed: if its shape has, print it again first.", of.model));
}

}  // namespace

JobResult correct_job(const RigJob& job, const CorrectRequest& request, const RunContext& context) {
  const RunScope scope(context.with_threads(job.config.threads));
  const std::string stem = free_stem(job), file = stem + ".json", picture = stem + ".png";
  OutputFolder output(job.folder, job.config.earlier_result);
  std::vector<std::filesystem::path> inputs = request.scans;
  if (!job.config.correction.empty()) inputs.push_back(job.config.correction);
  output.announce({file, picture}, inputs);
  context.progress("reading the dips", 0);
  const PrintedFilm film = read_printed_film(job, context);
  require_correction_fits(job.config, film.posed, job.depth_mm);
  const CorrectedDip of = corrected_dip(job.config, film.posed, job.depth_mm);
  warn_of_change(job, of, context);
  const FilmOptions& sheet = job.config.design.film;
  std::vector<DipSeen> dips;
  std::vector<CorrectionSample> samples;
  double square = 0, on_object = 0, count = 0;
  for (const std::filesystem::path& scan : request.scans) {
    dips.push_back(seen_by(scan, film, sheet, request, context));
    const DipSeen& dip = dips.back();
    const auto n = double(dip.samples.size());
    samples.insert(samples.end(), dip.samples.begin(), dip.samples.end());
    square += n * dip.rms_off_mm * dip.rms_off_mm;
    on_object += n * dip.rms_on_object_mm * dip.rms_on_object_mm;
    count += n;
  }
  require_different(dips);
  // What earlier dips said counts as much.
  if (film.correction)
    for (const CorrectionSample& s : read_correction(job.config.correction).samples)
      samples.push_back(s);
  context.progress("fitting the correction", 0.3);
  const Vec2 half = 0.5 * Vec2(sheet.width_mm, sheet.height_mm);
  const DisplacementFit fit = fit_displacements(samples, {-half, half});
  const double before_mm = std::sqrt(square / count);
  require_moderate(fit);

  JobResult result;
  result.json = json_line(json_of(of, dips, samples, fit)) + "\n";
  write_file(output.path(file), result.json);
  save_png(output.path(picture), draw_field(fit, sheet, before_mm));
  context.progress("fitting the correction", 1);
  output.commit();
  result.folder = job.folder;
  result.files = {file, picture};
  result.text = fmt::format(
      "{}, {:.0f} places: off by {:.3f} mm rms on the sheet, {:.3f} mm on the object\n"
      "corrected, places that were left out are foretold to {:.3f} mm, of which {:.3f} mm are "
      "noise; it changes over {:g} mm\n",
      dips.size() == 1 ? "1 dip" : fmt::format("{} dips", dips.size()), count, before_mm,
      std::sqrt(on_object / count), fit.left_out_rms_mm,
      // Both are estimates; of what is left, no more than all of it.
      std::min(fit.left_out_rms_mm, std::sqrt(2.0) * fit.noise_mm), fit.smooth_mm);
  if (dips.size() > 1)
    result.text += fmt::format(
        "from dip to dip the film lay {:.3f} mm elsewhere: no correction takes that out\n",
        between_dips_mm(dips));
  for (const DipSeen& dip : dips)
    if (!dip.board.empty() && request.board.empty())
      result.text += fmt::format("{}: taken for the {} board\n", dip.file.string(), dip.board);
  for (const std::string& warning : context.warnings())
    result.text += fmt::format("warning: {}\n", warning);
  result.text += output.told_replaced();
  result.text += fmt::format("wrote {0}/{1} and {0}/{2}\nprint again with {3}\n",
                             job.folder.string(), file, picture, how_to_print(job, file));
  return result;
}

}  // namespace hydrodip
