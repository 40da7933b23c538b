#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/made_folder.h"
#include "base/output_folder.h"
#include "base/plain_number.h"
#include "base/run_scope.h"
#include "calibrate/calibrate.h"
#include "calibrate/pictures.h"
#include "calibrate/search.h"
#include "calibrate/tear_limit.h"
#include "image/files.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kStoreName = "simulations.jsonl";
constexpr int kSchemaVersion = 2;  // 2: board, curvature, by_ink,
                                   // stiffness_table, film_off_mm, swelling
constexpr std::size_t kMostGridPoints = 100000;

GridSearchOptions search_options(const CalibrationRequest& request) {
  GridSearchOptions options;
  options.z_stretch = parse_range(request.z_stretch, "--z-stretch", 0, 5);
  options.stiffness_ratio = parse_range(request.stiffness_ratio, "--ratio", 1, 1e6);
  options.poisson = parse_range(request.poisson, "--poisson", 0, 0.48);
  const std::size_t points =
      options.z_stretch.size() * options.stiffness_ratio.size() * options.poisson.size();
  if (points > kMostGridPoints)
    throw InputError(fmt::format("the grid has {} points; {} are the most: take larger steps",
                                 points, kMostGridPoints));
  return options;
}

// A folder stands for the store in it.
std::vector<std::filesystem::path> store_files(const std::vector<std::string>& merged) {
  std::vector<std::filesystem::path> files;
  files.reserve(merged.size());
  std::error_code ignored;
  for (const std::filesystem::path path : merged)
    files.push_back(std::filesystem::is_directory(path, ignored) ? path / kStoreName : path);
  return files;
}

// ---- what is told ----

std::string plain(double value) { return std::isfinite(value) ? three_digits(value) : "unbounded"; }

std::string interval(double low, double high) {
  return fmt::format("{} to {}", plain(low), plain(high));
}

struct ParameterText {
  const char* name;
  double FilmParameters::*member;
};
constexpr ParameterText kParameters[] = {{"z_stretch", &FilmParameters::z_stretch},
                                         {"ink_stiffness_ratio", &FilmParameters::stiffness_ratio},
                                         {"poisson", &FilmParameters::poisson}};

// An interval that takes in a good part of what is possible says little.
bool poorly_determined(const Answer& answer, int k) {
  if (!answer.fit.free[std::size_t(k)]) return false;
  constexpr double kWide = 0.2, kWideFactor = 4;
  const FilmParameters &low = answer.certainty.low, &high = answer.certainty.high;
  if (k == 1) return !(high.stiffness_ratio < kWideFactor * low.stiffness_ratio);
  return high.*kParameters[k].member - low.*kParameters[k].member > kWide;
}

std::string describe(const Answer& answer) {
  std::string text;
  for (int k = 0; k < 3; ++k) {
    const ParameterText& p = kParameters[k];
    text += fmt::format("  {:<20} {:>8}", p.name, plain(answer.parameters.*p.member));
    if (answer.fit.free[std::size_t(k)])
      text += fmt::format(
          "   95 %: {}", interval(answer.certainty.low.*p.member, answer.certainty.high.*p.member));
    else
      text += "   given";
    if (poorly_determined(answer, k)) text += "   (hardly determined by these scans)";
    text += "\n";
  }
  return text;
}

Json json_of(const FilmParameters& parameters) {
  Json json;
  for (const ParameterText& p : kParameters)
    json[p.name] = std::isfinite(parameters.*p.member) ? Json(parameters.*p.member) : Json(nullptr);
  return json;
}

Json json_of(const Answer& answer) {
  Json correlation = Json::array();
  const Eigen::Matrix3d& c = answer.certainty.covariance;
  for (int a = 0; a < 3; ++a) {
    Json row = Json::array();
    for (int b = 0; b < 3; ++b) {
      const double scale = std::sqrt(c(a, a) * c(b, b));
      row.push_back(scale > 0 ? Json(c(a, b) / scale) : Json(nullptr));
    }
    correlation.push_back(row);
  }
  Json at_edge = Json::array();
  for (std::size_t k = 0; k < 3; ++k)
    if (answer.fit.at_bound[k]) at_edge.push_back(kParameters[k].name);
  const auto at = [&](double quantile) {
    const FitPoint half = quantile * c.diagonal().cwiseSqrt();
    const FitPoint point = answer.fit.point + FitPoint(half[0], -half[1], half[2]);
    FilmParameters result = from_fit(point);
    if (point[1] <= 0) result.stiffness_ratio = std::numeric_limits<double>::infinity();
    return json_of(result);
  };
  return {{"parameters", json_of(answer.parameters)},
          {"low_95", json_of(answer.certainty.low)},
          {"high_95", json_of(answer.certainty.high)},
          {"curvature_low_95", at(-1.96)},
          {"curvature_high_95", at(1.96)},
          {"correlation", correlation},
          {"noise_mm", answer.certainty.noise_mm},
          {"rms_mm", answer.fit.rms_mm},
          {"rounds", answer.fit.rounds},
          {"settled", answer.fit.settled},
          {"at_edge_of_range", at_edge}};
}

Json json_of(const GridError& error) {
  return {{"rms_mm", error.rms_mm},
          {"literal_mm05", error.literal},
          {"edge_rms_mm", error.edge_rms_mm},
          {"diagonal_rms_mm", error.diagonal_rms_mm},
          {"mean_mm", error.mean_mm},
          {"worst_mm", error.worst_mm},
          {"edges", error.edges},
          {"diagonals", error.diagonals}};
}

std::string source_of(const std::vector<Subject>& subjects) {
  std::string text = fmt::format("{} scan{}", subjects.size(), subjects.size() == 1 ? "" : "s");
  if (!any_synthetic(subjects)) return text;
  return text + (subjects.size() == 1 ? ", which was computed, not scanned"
                                      : ", of which some were computed, not scanned");
}

bool swells(const FilmOptions& film) { return film.swelling_x != 1 || film.swelling_y != 1; }

// The parameters are those of film that swells so: whoever prints with them wants both.
std::string swelling_toml(const FilmOptions& film) {
  if (!swells(film)) return {};
  return fmt::format(
      "\n# As the film of these dips had swollen; a print's --film-state says it anew.\n[film]\n"
      "swelling_x = {:.6g}\nswelling_y = {:.6g}\n",
      film.swelling_x, film.swelling_y);
}

std::string profile_toml(const Calibration& calibration, const std::vector<Subject>& subjects,
                         const FilmOptions& film, const std::optional<TearLimit>& tear) {
  std::string text =
      fmt::format("# A film's parameters, calibrated by hydrodip on {}.\n", source_of(subjects));
  for (const Subject& subject : subjects)
    text += fmt::format("#   {}\n", subject.file.filename().string());
  text += "# 95 % intervals in the comments. Use it with --profile.\n\n[material]\n";
  const Answer& all = calibration.all;
  const char* names[3] = {"z_stretch", "ink_stiffness_ratio", "poisson"};
  for (int k = 0; k < 3; ++k) {
    const ParameterText& p = kParameters[k];
    // A ratio is known to a few digits at most.
    const double value = rounded_to_digits(all.parameters.*p.member, 4);
    text += fmt::format(
        "{} = {}", names[k],
        value == std::floor(value) ? fmt::format("{:.1f}", value) : fmt::format("{}", value));
    if (all.fit.free[std::size_t(k)])
      text += fmt::format("  # {}",
                          interval(all.certainty.low.*p.member, all.certainty.high.*p.member));
    text += "\n";
  }
  if (tear)
    text += fmt::format(
        "tear_stretch = {:.4f}  # {:.3f} to {:.3f}\nsafe_stretch = {:.4f}\nlost_stretch = {:.4f}\n",
        tear->stretch, tear->low, tear->high, tear->low, tear->high);
  return text + swelling_toml(film);
}

std::string surface_csv(const Calibration& calibration, const std::vector<Subject>& subjects) {
  std::string text = "z_stretch,ink_stiffness_ratio,poisson";
  for (const Subject& subject : subjects) text += fmt::format(",{}_mm", subject.name);
  text += ",all_mm\n";
  const auto number = [](double value) {
    return std::isnan(value) ? std::string() : fmt::format("{:.6f}", value);
  };
  for (const GridPointError& point : calibration.grid) {
    text += fmt::format("{},{},{}", point.parameters.z_stretch, point.parameters.stiffness_ratio,
                        point.parameters.poisson);
    for (const double rms : point.rms_mm) text += fmt::format(",{}", number(rms));
    text += fmt::format(",{}\n", number(point.all_mm));
  }
  return text;
}

Json calibration_json(const Calibration& calibration, const std::vector<Subject>& subjects,
                      const JobConfig& config, const Board& board,
                      const std::optional<TearLimit>& tear, const RunContext& context) {
  Json by_ink = Json::array();
  for (const InkMisfit& misfit : calibration.all.by_ink)
    by_ink.push_back({{"density", misfit.density},
                      {"squares", misfit.squares},
                      {"more_stretch", misfit.more_stretch},
                      {"deviation", misfit.deviation}});
  const auto bounded = [](double value) { return value < 1e6 ? Json(value) : Json(nullptr); };
  Json stiffness = Json::array();
  for (const InkStiffness& ink : calibration.stiffness.inks)
    stiffness.push_back({{"density", ink.density},
                         {"law", ink.law},
                         {"stiffness", bounded(ink.stiffness)},
                         {"low_95", ink.low_95},
                         {"high_95", bounded(ink.high_95)}});
  Json scans = Json::array();
  for (std::size_t s = 0; s < subjects.size(); ++s)
    scans.push_back(
        {{"name", subjects[s].name},
         {"file", subjects[s].file.string()},
         {"synthetic", subjects[s].scan.synthetic},
         {"depth_mm", subjects[s].object.depth_mm},
         {"corners", subjects[s].scan.grid.position.size()},
         {"film_off_mm", {calibration.all.film_off_mm[s].x(), calibration.all.film_off_mm[s].y()}},
         {"error", json_of(calibration.error[s])},
         {"alone", json_of(calibration.each[s])}});
  const Json tear_json =
      tear ? Json{{"stretch", tear->stretch}, {"low_95", tear->low}, {"high_95", tear->high}}
           : Json(nullptr);
  return {
      {"schema_version", kSchemaVersion},
      {"command", "calibrate"},
      {"folder", config.output.string()},
      {"board", board.name},
      {"square_mm", board.square_mm},
      {"swelling", {{"x", config.design.film.swelling_x}, {"y", config.design.film.swelling_y}}},
      {"film_elements", config.design.film.elements},
      {"step_mm", config.design.dip.step_mm},
      {"result", json_of(calibration.all)},
      {"tear_limit", tear_json},
      {"by_ink", by_ink},
      {"stiffness_table", stiffness},
      {"stiffness_law_holds", calibration.stiffness.law_holds},
      {"average_of_each", json_of(calibration.average)},
      {"scans", scans},
      {"grid_points", calibration.grid.size()},
      {"correction_mm", calibration.correction_mm},
      {"warnings", context.warnings()}};
}

void warn_of_misfits(const Calibration& calibration, const std::vector<Subject>& subjects,
                     const RunContext& context) {
  constexpr double kFar_mm = 1, kMostDeviations = 4, kLeastStretch = 0.003;
  for (std::size_t s = 0; s < subjects.size(); ++s)
    if (const double off_mm = calibration.all.film_off_mm[s].norm(); off_mm > kFar_mm)
      context.warn(fmt::format(
          "{}: the film seems to have lain {:.1f} mm off the {}'s middle; what that does to the "
          "ink's place under the object is left out. Aim at the board's middle.",
          subjects[s].file.string(), off_mm, subjects[s].object.name));
  if (!calibration.stiffness.law_holds)
    context.warn(
        "This ink does not stiffen film as 1 + ink (ratio - 1); calibration.json has a table of "
        "what the scans say of each ink (stiffness_table). Take the ratio that fits the inks of "
        "your prints.");
  for (const InkMisfit& misfit : calibration.all.by_ink)
    if (std::abs(misfit.more_stretch) > std::max(kLeastStretch, kMostDeviations * misfit.deviation))
      context.warn(fmt::format(
          "Squares with {:.1f} % ink came out {:.1f} % (+- {:.1f}) {} stretched than stiffness "
          "1 + ink (ratio - 1) has it; see by_ink in calibration.json.",
          100 * misfit.density, 100 * std::abs(misfit.more_stretch), 100 * misfit.deviation,
          misfit.more_stretch > 0 ? "more" : "less"));
}

void warn_of_edges(const Calibration& calibration, const FilmOptions& film,
                   const RunContext& context) {
  const std::string swelling =
      swells(film)
          ? ""
          : " Film that swells and is taken for dry does that too: say how much it swelled "
            "(--film-state, film.swelling_x and _y).";
  for (std::size_t k = 0; k < 3; ++k) {
    const FilmParameters& p = calibration.all.parameters;
    // No film has less than none, and no ink makes it softer.
    const bool natural = (k == 2 && p.poisson <= 1e-9) || (k == 1 && p.stiffness_ratio <= 1 + 1e-9);
    if (calibration.all.fit.at_bound[k] && !natural)
      context.warn(fmt::format(
          "{} came out at the edge of its range; search a wider one, unless the scans do not "
          "determine it.{}",
          kParameters[k].name, swelling));
  }
  if (!calibration.all.fit.settled)
    context.warn("The refinement did not settle; the scans hardly determine the parameters.");
}

void warn_of_coarse_film(const FilmOptions& film, const RunContext& context) {
  const int tried = FilmOptions().elements;
  if (film.elements < tried)
    context.warn(fmt::format(
        "Film of {} triangles is coarser than what the intervals were tried on; they may miss the "
        "truth. Leave film.elements at {} or more.",
        film.elements, tried));
}

void warn_of_tear_limit(const std::optional<TearLimit>& limit, const RunContext& context) {
  if (!limit)
    context.warn(
        "The dome's rings that were read (--torn-ring) are stretched alike in the simulated dip: "
        "they tell no limit, and material.tear_stretch is left out.");
  else if (limit->low <= 1)
    context.warn(
        "By the ring that was read (--torn-ring) film may tear before it is stretched at all: "
        "material.safe_stretch is 1, and every stretched place of a print counts as doubtful. "
        "Count the rings from the tip again, or read another dip of the dome.");
}

// What the readings of the dome say, with the film's parameters as they were found.
std::optional<TearLimit> read_tear_limit(const JobConfig& config, const CalibrationRequest& request,
                                         const FilmParameters& film, const RunContext& context) {
  if (request.torn_rings.empty()) return std::nullopt;
  context.progress("tearing", 0);
  const std::optional<TearLimit> limit =
      tear_limit(ring_stretches(config.design, film, context), request.torn_rings);
  context.progress("tearing", 1);
  warn_of_tear_limit(limit, context);
  return limit;
}

// Before hours are spent: the dome has to fit, and the rings have to be rings.
void check_tear_readings(const JobConfig& config, const CalibrationRequest& request) {
  if (request.torn_rings.empty()) return;
  const CalibrationObject dome = tear_dome();
  require_room_for_shape(dome, config);
  require_rings(request.torn_rings);
}

// The same dip twice is no second witness.
void require_different(const std::vector<Subject>& subjects) {
  for (std::size_t i = 0; i < subjects.size(); ++i)
    for (std::size_t j = i + 1; j < subjects.size(); ++j)
      if (subjects[i].scan.grid.position == subjects[j].scan.grid.position)
        throw InputError(fmt::format("{} and {} say the same, corner by corner: give each dip once",
                                     subjects[i].file.string(), subjects[j].file.string()));
}

std::string summary(const Calibration& calibration, const std::vector<Subject>& subjects,
                    const std::optional<TearLimit>& tear, const RunContext& context) {
  std::string text =
      fmt::format("Calibrated on {}:\n{}", source_of(subjects), describe(calibration.all));
  if (tear)
    text += fmt::format("  {:<20} {:>8.3f}   95 %: {:.3f} to {:.3f}\n", "tear_stretch",
                        tear->stretch, tear->low, tear->high);
  text += fmt::format("The scans' noise seems to be {:.3f} mm. Eq. 4 with these parameters, mm:\n",
                      calibration.all.certainty.noise_mm);
  for (std::size_t s = 0; s < subjects.size(); ++s) {
    const GridError& error = calibration.error[s];
    const FilmParameters& alone = calibration.each[s].parameters;
    text += fmt::format(
        "  {:<12} {:.4f} (worst {:.3f}, {} lengths); alone: z_stretch {}, ratio {}, poisson {}\n",
        subjects[s].name, error.rms_mm, error.worst_mm, error.edges + error.diagonals,
        plain(alone.z_stretch), plain(alone.stiffness_ratio), plain(alone.poisson));
  }
  text +=
      fmt::format("  average of each alone: z_stretch {}, ratio {}, poisson {}\n",
                  plain(calibration.average.z_stretch), plain(calibration.average.stiffness_ratio),
                  plain(calibration.average.poisson));
  for (const std::string& warning : context.warnings())
    text += fmt::format("warning: {}\n", warning);
  return text;
}

JobResult shard_result(const JobConfig& config, const Shard& shard, const Search& search,
                       std::size_t total, const RunContext& context) {
  JobResult result;
  result.folder = config.output;
  result.files = {kStoreName};
  const std::size_t missing = search.missing();
  result.text = fmt::format(
      "shard {}/{} is done; {} of {} simulations of the grid are in {}.\n"
      "When all shards are done, run the same command without --shard and with --merge DIR for "
      "each "
      "of their folders.\n",
      shard.number, shard.of, total - missing, total, (config.output / kStoreName).string());
  for (const std::string& warning : context.warnings())
    result.text += fmt::format("warning: {}\n", warning);
  result.json = json_answer("calibrate", {{"folder", config.output.string()},
                                          {"shard", fmt::format("{}/{}", shard.number, shard.of)},
                                          {"simulations", total - missing},
                                          {"missing", missing}});
  return result;
}

JobResult calibrated(const JobConfig& config, const CalibrationRequest& request, const Board& board,
                     const GridSearchOptions& options, const Shard& shard,
                     const std::vector<Subject>& subjects, const RunContext& context) {
  const MadeFolder made(config.output);
  if (made.error())
    throw InputError(
        fmt::format("{}: the output folder cannot be made ({}); choose another with -o",
                    config.output.string(), made.error().message()));
  SimulationStore store(config.output / kStoreName, store_files(request.merged));
  std::vector<std::string> fingerprints;
  fingerprints.reserve(subjects.size());
  for (const Subject& subject : subjects) fingerprints.push_back(subject.fingerprint);
  for (const std::string& oddity : store.oddities(fingerprints)) context.warn(oddity);
  Search search(subjects, config.design, board, options, store);
  if (!request.shard.empty()) {
    search.simulate_grid(shard, context);
    return shard_result(config, shard, search, grid_points(options).size() * subjects.size(),
                        context);
  }
  OutputFolder folder(config.output, config.earlier_result);
  folder.announce({"profile.toml", "calibration.json", "error-surface.csv", "error-surface.png",
                   "joint-regions.png"},
                  files_of(subjects, config));
  const Calibration calibration = search.run(context);
  warn_of_coarse_film(config.design.film, context);
  warn_of_edges(calibration, config.design.film, context);
  warn_of_misfits(calibration, subjects, context);
  const std::optional<TearLimit> tear =
      read_tear_limit(config, request, calibration.all.parameters, context);

  write_file(folder.path("profile.toml"),
             profile_toml(calibration, subjects, config.design.film, tear));
  const std::string json =
      json_text(calibration_json(calibration, subjects, config, board, tear, context));
  write_file(folder.path("calibration.json"), json);
  write_file(folder.path("error-surface.csv"), surface_csv(calibration, subjects));
  save_png(folder.path("error-surface.png"),
           draw_error_surface(options, calibration.grid, calibration.all.parameters,
                              "Calibrated on " + source_of(subjects)));
  save_png(folder.path("joint-regions.png"),
           draw_joint_regions(calibration.all, "Calibrated on " + source_of(subjects)));
  context.check_cancelled();
  folder.commit();

  JobResult result;
  result.folder = config.output;
  result.files = {"profile.toml",      "calibration.json",  "error-surface.csv",
                  "error-surface.png", "joint-regions.png", kStoreName};
  result.text = summary(calibration, subjects, tear, context) + folder.told_replaced();
  for (const std::string& file : result.files)
    result.text += fmt::format("wrote {}\n", (config.output / file).string());
  result.json = json;
  return result;
}

}  // namespace

JobResult calibrate_job(const JobConfig& given, const CalibrationRequest& request,
                        const RunContext& context) {
  const RunScope scope(context.with_threads(given.threads));
  const GridSearchOptions options = search_options(request);
  const Shard shard = parse_shard(request.shard);
  const ScanSetup setup = scan_setup(given, request);
  const JobConfig& config = setup.config;
  const Board& board = setup.settings.board;
  if (config.design.dip.method != DipMethod::kFull)
    throw InputError("calibrate: only --method full has parameters to calibrate");
  check_tear_readings(config, request);
  const std::vector<Subject> subjects =
      load_subjects(request.scans, setup.settings, config, context);
  require_different(subjects);
  try {
    return calibrated(config, request, board, options, shard, subjects, context);
  } catch (const Cancelled&) {
    throw Cancelled(
        "cancelled; what was simulated is kept, and the same command goes on from there");
  }
}

}  // namespace hydrodip
