#include "rig/rig_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/json_nesting.h"
#include "base/json_text.h"
#include "base/obstacle.h"
#include "base/schema_version.h"
#include "base/small_file.h"
#include "job/sheet_of.h"
#include "report/report.h"
#include "settings/params.h"
#include "sheet/film_marks.h"
#include "sheet/marks.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLevelFile = "rig-water-level.json";

constexpr std::uintmax_t kLargestLevel = 1 << 16, kLargestReport = 64 << 20;

struct ReadReport {
  Json json;
  std::string sha256;
};

ReadReport read_report(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "report.json";
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    const std::filesystem::path nest = folder / "nest.html";
    throw InputError(
        std::filesystem::exists(nest, ignored)
            ? fmt::format("{}: this is a nest; its run sheet is {}", folder.string(), nest.string())
            : fmt::format("{}: {}; name the folder that 'hydrodip print' wrote", folder.string(),
                          why_absent(folder, "report.json")));
  }
  const std::vector<std::uint8_t> bytes = read_small_file(file, kLargestReport, "a report");
  Json report = parsed_json<Json>(bytes);
  require_known_schema(report, kReportSchemaVersion, file, "this report");
  if (report.is_object() && report.contains("dips"))
    throw InputError(fmt::format("{}: this job has several dips; name one of them, as {}",
                                 folder.string(), (folder / "dip-1").string()));
  const bool usable = report.is_object() && report.contains("parameters") &&
                      report["parameters"].is_object() && report.contains("figures") &&
                      report["figures"].is_object() && report["figures"].contains("depth_mm");
  if (!usable)
    throw InputError(fmt::format(
        "{}: this is not the report of a dip; print the model again with 'hydrodip print'",
        file.string()));
  return {std::move(report), sha256_hex(bytes)};
}

// Values of parameters that this version does not know any more are left out.
std::vector<Setting> settings_of(const Json& parameters, const std::string& origin) {
  std::vector<Setting> settings;
  for (const Parameter& parameter : hydrodip::parameters()) {
    if (!parameters.contains(parameter.name) || !parameters[parameter.name].is_object()) continue;
    const Json value = parameters[parameter.name].value("value", Json());
    Setting setting{parameter.name, 0.0, true, value.dump(), origin};
    if (value.is_number())
      setting.value = value.get<double>();
    else if (value.is_string())
      setting.value = value.get<std::string>();
    else if (value.is_array() && value.size() == 3 && value[0].is_number() &&
             value[1].is_number() && value[2].is_number())
      setting.value = std::vector<double>{value[0], value[1], value[2]};
    else
      continue;
    settings.push_back(setting);
  }
  return settings;
}

std::string text_of(const Json& object, const char* key) {
  return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : "";
}

// At least 1.
int count_of(const Json& object, const char* key) {
  constexpr double kMost = 1000;
  if (!object.contains(key) || !object[key].is_number()) return 1;
  return int(std::clamp(object[key].get<double>(), 1.0, kMost));
}

std::string title_of(const Json& report) {
  std::string title = text_of(report, "title");
  if (!title.empty()) return title;
  if (report.contains("inputs") && report["inputs"].is_array() && !report["inputs"].empty() &&
      report["inputs"][0].is_object())
    return std::filesystem::path(text_of(report["inputs"][0], "path")).filename().string();
  return "";
}

// A path is as it was typed where the print ran: here, or in a folder above the job's. Of several
// files the one that was printed from, if its hash is known.
std::filesystem::path found_file(const std::filesystem::path& typed, const std::string& sha256,
                                 const std::filesystem::path& job_folder) {
  if (typed.empty() || typed.is_absolute()) return typed;
  std::error_code ignored;
  std::vector<std::filesystem::path> there;
  const auto look = [&](const std::filesystem::path& file) {
    if (std::filesystem::is_regular_file(file, ignored)) there.push_back(file);
  };
  look(typed);
  std::filesystem::path folder = std::filesystem::weakly_canonical(job_folder, ignored);
  while (folder.has_relative_path()) {
    folder = folder.parent_path();
    look(folder / typed);
  }
  if (there.size() > 1 && !sha256.empty())
    for (const std::filesystem::path& file : there)
      if (sha256_hex(read_file(file)) == sha256) return file;
  return there.empty() ? typed : there.front();
}

// `correction`: that it was printed with.
void find_inputs(const Json& report, const std::filesystem::path& correction, RigJob& job) {
  if (!report.contains("inputs") || !report["inputs"].is_array()) return;
  for (const Json& input : report["inputs"]) {
    if (!input.is_object()) continue;
    const std::string role = text_of(input, "role"), path = text_of(input, "path");
    if (role == "model") {
      job.model_sha256 = text_of(input, "sha256");
      job.config.model = found_file(path, job.model_sha256, job.folder);
    }
    if (role == "correction" && path == correction) {
      job.correction_sha256 = text_of(input, "sha256");
      // Unless today's settings name another one.
      if (job.config.correction == correction)
        job.config.correction = found_file(path, job.correction_sha256, job.folder);
    }
    if (role == "settings")
      job.settings_files.push_back(found_file(path, text_of(input, "sha256"), job.folder));
  }
}

// Of all inks together.
double ink_coverage(const Json& report) {
  double sum = 0;
  if (!report.contains("ink") || !report["ink"].is_object()) return 0;
  const Json mean = report["ink"].value("mean", Json());
  if (!mean.is_object()) return 0;
  for (const auto& [ink, share] : mean.items())
    if (share.is_number()) sum += share.get<double>();
  return sum;
}

// Today's settings change nothing of what was printed.
SheetUse sheet_use_of(const Json& report) {
  JobConfig printed;
  apply_settings(printed, settings_of(report["parameters"], "report.json"));
  const FilmOptions& film = printed.design.film;
  // Means are over the whole picture, which reaches beyond a disc.
  const double picture_mm2 = film.width_mm * film.height_mm, film_mm2 = film_area_mm2(film);
  SheetUse use{1e-6 * film_mm2, ink_coverage(report) * picture_mm2 / film_mm2};
  if (report.contains("dip_of_several") && report["dip_of_several"].is_object())
    use.first_of_piece = count_of(report["dip_of_several"], "number") == 1;
  return use;
}

std::vector<WayPoint> way_in(const Json& report, const std::filesystem::path& file) {
  std::vector<WayPoint> way;
  if (!report.contains("way_in")) return way;
  const auto bad = [&] {
    return InputError(fmt::format("{}: way_in is not a list of places", file.string()));
  };
  if (!report["way_in"].is_array()) throw bad();
  for (const Json& row : report["way_in"]) {
    const auto value = [&](const char* name) {
      if (!row.is_object() || !row.contains(name) || !row[name].is_number()) throw bad();
      return row[name].get<double>();
    };
    way.push_back({value("travelled_mm"),
                   {.lower_mm = value("lower_mm"),
                    .shift_x_mm = value("shift_x_mm"),
                    .shift_y_mm = value("shift_y_mm"),
                    .turn_x_deg = value("turn_x_deg"),
                    .turn_y_deg = value("turn_y_deg"),
                    .turn_z_deg = value("turn_z_deg")}});
  }
  return way;
}

PlannedMove travel(const std::string& phase, double from_mm, double to_mm, double mm_per_min) {
  return {phase, from_mm, to_mm, mm_per_min, 60 * std::abs(to_mm - from_mm) / mm_per_min};
}

}  // namespace

double tape_mm(const JobConfig& config) {
  const FilmOptions& film = config.design.film;
  return tape_mm(film.width_mm, film.height_mm, film.margin_mm, config.print.camera_marks);
}

std::string taping(const JobConfig& config) {
  const double tape = tape_mm(config);
  return tape > 0 ? fmt::format("Tape {:g} mm around all four edges", tape)
                  : "No tape: the sheet has no margin for it";
}

double ruler_mm(const JobConfig& config) {
  return ruler_mm(config.design.film.width_mm, config.design.film.margin_mm);
}

std::optional<SheetUse> sheet_use(const std::string& report) {
  const Json json = parsed_json<Json>(report);
  if (!json.is_object() || !json.contains("parameters") || !json["parameters"].is_object())
    return {};
  try {
    return sheet_use_of(json);
  } catch (const InputError&) {  // of a version with other ranges
    return {};
  }
}

Eigen::Isometry3d hanging_pose(const RigJob& job) {
  if (job.way_in.empty()) return Eigen::Isometry3d::Identity();
  const Keyframe& first = job.way_in.front().pose;
  return Trajectory::through({first, first}, job.config.design.trajectory.pivot_mm)
      .bath_from_object(0);
}

std::string tenths(double value) {
  return fmt::format("{:.1f}", std::round(10 * value) / 10 + 0.0);
}

std::string hung_otherwise(const RigJob& job) {
  if (job.way_in.empty()) return "";
  constexpr double kNothing = 0.05;  // of what is shown
  const Keyframe& pose = job.way_in.front().pose;
  const Vec3 turn(pose.turn_x_deg, pose.turn_y_deg, pose.turn_z_deg);
  const Vec2 shift(pose.shift_x_mm, pose.shift_y_mm);
  std::string words;
  if (turn.cwiseAbs().maxCoeff() >= kNothing)
    words = fmt::format(
        "turned from that by {}, {} and {} degrees about x, then y, then "
        "z of the bath",
        tenths(turn.x()), tenths(turn.y()), tenths(turn.z()));
  if (shift.cwiseAbs().maxCoeff() >= kNothing)
    words += fmt::format(
        "{}moved by {} mm along the film's width (x) and {} mm along its "
        "length (y)",
        words.empty() ? "" : ", and ", tenths(shift.x()), tenths(shift.y()));
  return words;
}

bool moves_aside(const RigJob& job) {
  constexpr double kStill = 1e-9;
  return std::ranges::any_of(job.way_in, [&](const WayPoint& point) {
    const Keyframe &first = job.way_in.front().pose, &pose = point.pose;
    return std::abs(pose.shift_x_mm - first.shift_x_mm) > kStill ||
           std::abs(pose.shift_y_mm - first.shift_y_mm) > kStill ||
           std::abs(pose.turn_x_deg - first.turn_x_deg) > kStill ||
           std::abs(pose.turn_y_deg - first.turn_y_deg) > kStill ||
           std::abs(pose.turn_z_deg - first.turn_z_deg) > kStill;
  });
}

void require_lowering_only(const RigJob& job) {
  if (!moves_aside(job)) return;
  throw InputError(fmt::format(
      "{}: this job's way into the water shifts or turns the object, and the stage only lowers it: "
      "dip it by hand along its run sheet ('hydrodip rig guide' without --port), or print it anew "
      "without path and dip.roll_deg",
      job.folder.string()));
}

RigJob load_rig_job(const std::filesystem::path& folder, const SettingSources& sources) {
  const ReadReport read = read_report(folder);
  const Json& report = read.json;
  RigJob job;
  job.folder = folder;
  job.title = title_of(report);
  apply_settings(job.config, settings_of(report["parameters"], (folder / "report.json").string()));
  // What happened to results then is not asked for today.
  job.config.earlier_result = EarlierResult::kReplaced;
  // The bench can do without what the print was corrected by.
  const std::filesystem::path correction = std::exchange(job.config.correction, {});
  apply_sources(job.config, sources);
  if (job.config.correction.empty()) job.config.correction = correction;
  job.way_in = way_in(report, folder / "report.json");
  find_inputs(report, correction, job);
  job.has_artwork = report["parameters"].contains("artwork[1].projection");
  job.report_sha256 = read.sha256;
  job.sheet = sheet_use_of(report);
  const Json& figures = report["figures"];
  if (!figures["depth_mm"].is_number() || !(figures["depth_mm"].get<double>() > 0))
    throw InputError(
        fmt::format("{}: figures.depth_mm is not a depth", (folder / "report.json").string()));
  job.depth_mm = figures["depth_mm"];
  const Json size = figures.value("object_size_mm", Json());
  for (int k = 0; k < 3; ++k)
    if (size.is_array() && size.size() == 3 && size[std::size_t(k)].is_number())
      job.object_size_mm[k] = size[std::size_t(k)];
  if (text_of(report, "concern") == "stop")
    job.alarm = "Do not dip it like this: " + text_of(report, "short_verdict");
  else if (makes_sheet(text_of(report, "command")))
    job.alarm = draft_alarm(job.config.design);
  if (report.contains("dip_of_several") && report["dip_of_several"].is_object()) {
    const Json& dip = report["dip_of_several"];
    const int number = count_of(dip, "number"), of = count_of(dip, "of");
    job.earlier_dips = std::max(0, number - 1);
    job.next_dip = number < of ? number + 1 : 0;
  }
  if (report.contains("warnings") && report["warnings"].is_array())
    for (const Json& warning : report["warnings"])
      if (warning.is_string()) job.warnings.push_back(warning);
  return job;
}

void require_model(const RigJob& job) {
  std::error_code ignored;
  if (job.config.model.empty() || std::filesystem::exists(job.config.model, ignored)) return;
  throw InputError(
      fmt::format("{}: the model that the job in {} was printed from is {}; put it back{}",
                  job.config.model.string(), job.folder.string(),
                  job.config.model.is_absolute() ? "not there any more"
                                                 : "neither here nor in a folder above the job's",
                  job.config.model.is_absolute() ? "" : ", or work where 'hydrodip print' ran"));
}

Activator activator_for(const JobConfig& config) {
  return activator_for(config.process, config.design.film);
}

double bath_litres(const BathOptions& bath) {
  return 1e-6 * bath.width_mm * bath.height_mm * bath.depth_mm;
}

std::optional<double> known_water_level_mm(const RigJob& job) {
  if (job.config.stage.water_mm > 0) return job.config.stage.water_mm;
  const std::filesystem::path file = job.folder / kLevelFile;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return {};
  const Json level = parsed_json<Json>(read_small_file(file, kLargestLevel, "a water level"));
  if (!level.is_object() || !level.contains("water_mm") || !level["water_mm"].is_number())
    return {};
  return level["water_mm"].get<double>();
}

void save_water_level(const RigJob& job, double position_mm) {
  write_whole(job.folder / kLevelFile, json_line({{"water_mm", position_mm}}) + "\n");
}

double in_water_mm(const RigJob& job) {
  return job.way_in.empty() ? job.depth_mm : job.way_in.back().travelled_mm;
}

std::vector<PlannedMove> plan_dip(const RigJob& job) {
  const ProcessOptions& process = job.config.process;
  const StageOptions& stage = job.config.stage;
  const double approach_mm = std::min(stage.approach_mm, stage.clearance_mm);
  PlannedMove dip = travel("dip", approach_mm, -job.depth_mm, process.speed_mm_per_min);
  dip.seconds = 60 * (approach_mm + in_water_mm(job)) / process.speed_mm_per_min;
  return {travel("approach", stage.clearance_mm, approach_mm, stage.travel_mm_per_min),
          dip,
          {"dwell", -job.depth_mm, -job.depth_mm, 0, process.dwell_s},
          travel("retract", -job.depth_mm, stage.clearance_mm, process.lift_mm_per_min)};
}

double stage_position_mm(const StageOptions& stage, double water_mm, double height_mm) {
  return stage.down == StageDown::kPlus ? water_mm - height_mm : water_mm + height_mm;
}

std::string describe_plan(const RigJob& job, std::optional<double> water_mm) {
  std::string text = fmt::format("{:<10} {:>10} {:>10} {:>10} {:>8}", "movement", "from, mm",
                                 "to, mm", "mm/min", "s");
  if (water_mm) text += fmt::format("   {:>22}", "stage positions, mm");
  text += "\n";
  for (const PlannedMove& move : plan_dip(job)) {
    text +=
        fmt::format("{:<10} {:>10.2f} {:>10.2f} {:>10} {:>8.1f}", move.phase, move.from_height_mm,
                    move.to_height_mm,
                    move.mm_per_min > 0 ? fmt::format("{:g}", move.mm_per_min) : "-", move.seconds);
    if (water_mm)
      text += fmt::format("   {:>10.3f} {:>11.3f}",
                          stage_position_mm(job.config.stage, *water_mm, move.from_height_mm),
                          stage_position_mm(job.config.stage, *water_mm, move.to_height_mm));
    text += "\n";
  }
  return text + "Heights are those of the object's lowest point over the water.\n";
}

}  // namespace hydrodip
