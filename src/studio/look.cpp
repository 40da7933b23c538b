#include "studio/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/run_scope.h"
#include "coat/film_paint.h"
#include "job/job_record.h"
#include "job/prepare.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "plan/hold.h"
#include "report/findings.h"
#include "report/plain_words.h"
#include "settings/correction_file.h"
#include "studio/bundle.h"
#include "studio/job_files.h"
#include "studio/mends.h"

namespace hydrodip {
namespace {

// A picture has so many pixels at most; the screen shows no more.
constexpr double kSketchPixels = 3.5e5, kDraftPixels = 7e5, kNormalPixels = 4e6;
constexpr double kSketchDpi = 60, kDraftDpi = 100, kNormalDpi = 150;
constexpr int kSketchElements = 5000, kSketchAirCells = 10000;
constexpr std::size_t kSketchTriangles = 20000;
constexpr int kSketchPoints = 4000;  // at which the report asks what is covered
constexpr double kSketchStep_mm = 2;

double shown_dpi(const JobConfig& config, LookQuality quality) {
  struct Picture {
    double pixels, dpi;
  };
  const auto most = [&]() -> Picture {
    switch (quality) {
      case LookQuality::kSketch:
        return {kSketchPixels, kSketchDpi};
      case LookQuality::kDraft:
        return {kDraftPixels, kDraftDpi};
      case LookQuality::kNormal:
        break;
    }
    return {kNormalPixels, kNormalDpi};
  }();
  const double area_in2 =
      config.design.film.width_mm * config.design.film.height_mm / (kMmPerInch * kMmPerInch);
  return std::min({config.design.dpi, most.dpi, std::floor(std::sqrt(most.pixels / area_in2))});
}

void make_sketch(Project& project) {
  project.most_triangles = kSketchTriangles;
  DesignOptions& design = project.design;
  design.film.elements = std::min(design.film.elements, kSketchElements);
  design.dip.step_mm = std::max(design.dip.step_mm, kSketchStep_mm);
  design.dip.quick_look = design.inverse.quick_look = true;
  design.air.cells = std::min(design.air.cells, kSketchAirCells);
}

// At which is asked what becomes of what shall be printed.
int points_of(LookQuality quality) {
  return quality == LookQuality::kSketch ? kSketchPoints : kWantedPoints;
}

// ---- computing ----

[[noreturn]] void refuse(const std::string& code, const std::string& text, Json mends) {
  throw ProblemFound({code, text, std::move(mends)});
}

// What `compute` gives; what it throws is a problem that the page can show.
template <typename Compute>
auto or_refused(const Compute& compute) {
  try {
    return compute();
  } catch (const InputError& error) {
    refuse("input", in_plain_words(error.what()), Json::array());
  } catch (const DipError& error) {
    refuse("dip", in_plain_words(error.what()), Json::array());
  } catch (const std::bad_alloc&) {
    refuse("memory", "There is not enough memory for this.", Json::array());
  }
}

void require_sensible_size(const JobConfig& config, const TriangleMesh& posed) {
  if (config.object.pose.size_mm > 0 || !config.object.load.units.empty()) return;
  const double largest = posed.bounds().size().maxCoeff();
  if (largest >= kTiny_mm && largest <= kHuge_mm) return;
  refuse("input",
         fmt::format("Is it really {:.3g} mm large? Say its unit, or the size that it shall have.",
                     largest),
         size_mends());
}

void require_room(const JobConfig& config, const PosedObject& posed, const RunContext& context) {
  const TriangleMesh& mesh = posed.mesh();
  const std::string how = misfit(config, mesh);
  if (!how.empty()) refuse("input", how, room_mends(config, posed));
  const Trajectory way = make_trajectory(config.design.trajectory, mesh.positions);
  require_fit(posed.size_mm(), room_of(mesh, way), config.design.film, config.bath, context);
}

// ---- packing ----

template <class Vector>
void add_vector(std::vector<float>& to, const Vector& v) {
  for (Eigen::Index k = 0; k < v.size(); ++k) to.push_back(float(v[k]));
}

std::vector<std::uint32_t> indices_of(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> list;
  list.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (const std::int32_t v : t) list.push_back(std::uint32_t(v));
  return list;
}

template <class Item>
std::vector<float> floats_of(const std::vector<Item>& items) {
  std::vector<float> list;
  if constexpr (std::is_arithmetic_v<Item>) {
    list.assign(items.begin(), items.end());
  } else {
    list.reserve(items.size() * std::size_t(Item::SizeAtCompileTime));
    for (const Item& item : items) add_vector(list, item);
  }
  return list;
}

void add_film(Bundle& bundle, const DippedFilm& film) {
  bundle.add("film.u", floats_of(film.mesh().u), 2);
  bundle.add("film.position", floats_of(film.position), 3);
  std::vector<std::uint8_t> state;
  for (const VertexState s : film.state) state.push_back(std::uint8_t(s));
  bundle.add("film.state", state, 1);
  bundle.add("film.stretch", floats_of(film.stretch), 1);
  bundle.add("film.area_ratio", floats_of(film.area_ratio), 1);
  bundle.add("film.index", indices_of(film.mesh().triangles), 3);
  bundle.add("film.torn", film.torn, 1);
  bundle.add("film.wrinkled", film.wrinkled, 1);
}

void add_sheet(Bundle& bundle, const FilmInk& ink, const ColorModel& model) {
  bundle.add("sheet.printed", look_on_film(ink.inking.inks, ink.inking.printed, model).rgba, 4);
  std::vector<std::uint8_t> predicted = ink.on_object.rgba;
  const std::vector<std::uint8_t>& laid = ink.inking.inks.cmyk;
  for (std::size_t i = 0; i < predicted.size(); i += 4)
    predicted[i + 3] = laid[i] || laid[i + 1] || laid[i + 2] || laid[i + 3] ? 255 : 0;
  bundle.add("sheet.predicted", predicted, 4);
}

void add_air(Bundle& bundle, const DippedObject& dipped) {
  const TrappedAir& air = *dipped.air;
  const TriangleMesh& mesh = dipped.posed.mesh();
  std::vector<float> dry;
  std::vector<std::uint32_t> index;
  for (std::size_t t = 0; t < air.pocket_of.size(); ++t) {
    if (air.pocket_of[t] < 0) continue;
    Vec3 middle = Vec3::Zero();
    for (const std::int32_t v : mesh.triangles[t]) middle += mesh.positions[std::size_t(v)] / 3;
    if (!air.holds(int(t), middle)) continue;
    for (const std::int32_t v : mesh.triangles[t]) {
      index.push_back(std::uint32_t(dry.size() / 3));
      add_vector(dry, mesh.positions[std::size_t(v)]);
    }
  }
  bundle.add("air.position", dry, 3);
  bundle.add("air.index", index, 3);
  bundle.add("lids.position", floats_of(air.lids.positions), 3);
  bundle.add("lids.index", indices_of(air.lids.triangles), 3);
}

// ---- words ----

std::string overlay_of(const std::string& key) {
  static const std::vector<std::pair<std::string, std::string>> overlays = {
      {"tears", "tears"},       {"stretch", "stretch"}, {"air", "air"},
      {"vent", "air"},          {"steepness", "angle"}, {"coverage", "coverage"},
      {"wrinkles", "wrinkles"}, {"lifted", "coverage"}};
  for (const auto& [finding, overlay] : overlays)
    if (finding == key) return overlay;
  return "";
}

// Where a camera had best look: of what is torn the part that is nearest to the middle of it, of
// stretch where it is largest.
std::optional<Vec3> place_of(const std::string& key, const DippedObject& dipped) {
  const DippedFilm& film = *dipped.film;
  if (key == "air" && !dipped.air->pockets.empty()) return dipped.air->pockets.front().top;
  if (key == "vent" && !dipped.air->vents.empty()) return dipped.air->vents.front().at;
  if (key == "lifted") return dipped.coverage.lifted_at;
  if (key == "stretch") {
    std::optional<std::size_t> most;
    for (std::size_t v = 0; v < film.stretch.size(); ++v)
      if (film.state[v] == VertexState::kAttached &&
          (!most || film.stretch[v] > film.stretch[*most]))
        most = v;
    if (most) return film.position[*most];
  }
  if (key != "tears" && key != "wrinkles") return std::nullopt;
  const std::vector<std::uint8_t>& marked = key == "tears" ? film.torn : film.wrinkled;
  std::vector<Vec3> places;
  Vec3 sum = Vec3::Zero();
  for (std::size_t t = 0; t < marked.size(); ++t) {
    if (!marked[t]) continue;
    Vec3 middle = Vec3::Zero();
    for (const std::int32_t v : film.mesh().triangles[t])
      middle += film.position[std::size_t(v)] / 3;
    places.push_back(middle);
    sum += middle;
  }
  if (places.empty()) return std::nullopt;
  const Vec3 mean = sum / double(places.size());
  return *std::min_element(places.begin(), places.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - mean).squaredNorm() < (b - mean).squaredNorm();
  });
}

Json mends_for(const Finding& finding, const Look& look) {
  const DippedObject& dipped = look.made->dipped;
  if (finding.concern == Concern::kNone) return Json::array();
  if (finding.key == "tears" || (finding.key == "coverage" && finding.concern == Concern::kStop))
    return tear_mends(look.config, *dipped.film);
  if (finding.key == "air") return air_mends(*dipped.air);
  Json list = Json::array();
  if (finding.key == "steepness") list.push_back(orient_mend());
  return list;
}

std::string hex_of(const LinearColor& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", linear_to_srgb8(c.r), linear_to_srgb8(c.g),
                     linear_to_srgb8(c.b));
}

Report report_of(const Look& look, const std::filesystem::path& uploads,
                 const RunContext& context) {
  const RunContext words = context.quiet();
  for (const std::string& warning : look.warnings) words.warn(without_folder(warning, uploads));
  const PreparedObject prepared{.posed = look.made->dipped.posed,
                                .paint = look.paint,
                                .health = look.model->health,
                                .units = look.model->units,
                                .files = {},
                                .artwork = {},
                                .picture_problems = {}};
  const std::vector<ReportInput> inputs;
  const Finish finish(look.paint, {{look.made->dipped, look.made->raster, nullptr}});
  const Timings times;
  JobRecord record{"print", look.config, prepared,        inputs, finish,
                   times,   words,       &look.made->ink, "",     ""};
  record.wanted =
      wanted_coverage(look.made->dipped, *look.paint,
                      doubtful_stretch(look.config.design.dip.material), points_of(look.quality));
  return make_report(record);
}

bool is_blank(const Look& look) {
  const auto& laid = look.made->ink.ink.inking.inks.cmyk;
  return std::all_of(laid.begin(), laid.end(), [](std::uint8_t value) { return value == 0; });
}

Json verdict_of(const Report& report, const std::vector<Finding>& list) {
  const Concern concern = concern_of(list);
  return {{"concern", concern_name(concern)},
          {"headline", headline(concern)},
          {"short", report.coverage ? in_plain_words(short_verdict(report)) : ""},
          {"text", in_plain_words(verdict_of(report))}};
}

Json finding_json(const Finding& f, const std::string& overlay, Json mends) {
  return {{"key", f.key},
          {"concern", concern_name(f.concern)},
          {"title", f.title},
          {"figure", f.figure},
          {"text", in_plain_words(f.text)},
          {"advice", in_plain_words(f.advice)},
          {"overlay", overlay},
          {"at_mm", nullptr},
          {"mends", std::move(mends)}};
}

Json findings_json(const Look& look, const std::vector<Finding>& list) {
  Json all = Json::array();
  for (const Finding& f : list) {
    Json one = finding_json(f, overlay_of(f.key), mends_for(f, look));
    if (f.concern != Concern::kNone)
      if (const auto at = place_of(f.key, look.made->dipped))
        one["at_mm"] = {at->x(), at->y(), at->z()};
    all.push_back(std::move(one));
  }
  return all;
}

// What the report knows nothing of: a sheet on which nothing is.
std::vector<Finding> findings_of(const Look& look, const Report& report) {
  std::vector<Finding> list = findings(report);
  if (is_blank(look))
    list.insert(
        list.begin() + (list.empty() ? 0 : 1),
        {"blank", Concern::kCare, "Nothing to print", "",
         look.paint->says_anything() ? "What the film reaches has the object's own colour."
                                     : "The object has no colours yet: put a picture on it.",
         ""});
  if (look.dips > 1 && look.paint->depends_on_film())
    list.push_back({"pattern-dips", Concern::kStop, "Pattern film belongs to one dip", "",
                    "Films of several dips cannot share a pattern, so this job cannot be printed.",
                    "Lay the pattern on the object, or take the other dips away."});
  // Worst first, and otherwise as they come.
  std::stable_sort(list.begin(), list.end(),
                   [](const Finding& a, const Finding& b) { return a.concern > b.concern; });
  return list;
}

Json layers_json(const std::vector<DryLayer>& layers) {
  Json list = Json::array();
  for (const DryLayer& layer : layers) list.push_back(layer.layer);
  return list;
}

Json figures_json(const Look& look) {
  const DippedObject& d = look.made->dipped;
  const Coverage& c = d.coverage;
  const Reach& reach = look.made->ink.reach;
  return {{"covered_share", c.covered_share()},
          {"covered_downward_share", c.covered_downward_share()},
          {"covered_mm2", c.covered_mm2},
          {"torn_share", c.torn_share()},
          {"torn_mm2", c.torn_mm2},
          {"stretch_mean", c.stretch_mean},
          {"stretch_max", c.stretch_max},
          {"area_ratio_max", c.area_ratio_max},
          {"wrinkled_mm2", c.wrinkled_mm2},
          {"air_mm2", d.air->area_mm2()},
          {"air_volume_mm3", d.air->volume_mm3()},
          {"color_difference", reach.mean},
          {"out_of_gamut_share", reach.out_of_reach_share()},
          {"steep_share", d.angles.over_limit_share()}};
}

// What the print would look for: another way than the one that could be shown.
void require_known_way(const JobConfig& job, std::size_t dip) {
  const bool is_one_of_several = dip < job.dips.size();
  const bool leaves_pose = is_one_of_several ? job.dips[dip].find_rotation : job.plan.find_pose;
  if (leaves_pose || (job.plan.find_depth && !is_one_of_several))
    refuse("input",
           "This job leaves open how the object is held, or how deep it goes: look for a way, or "
           "say one.",
           is_one_of_several ? Json({orient_mend()}) : auto_mends());
}

// Of what the workspace makes.
Quality quality_of(LookQuality quality) {
  return quality == LookQuality::kNormal ? Quality::kNormal : Quality::kDraft;
}

}  // namespace

std::string quality_name(LookQuality quality) {
  if (quality == LookQuality::kNormal) return "normal";
  return quality == LookQuality::kDraft ? "draft" : "sketch";
}

JobConfig config_of_dip(const JobConfig& config, std::size_t dip) {
  JobConfig own = config;
  own.plan.find_pose = own.plan.find_depth = false;
  own.plan.dips = 0;
  own.dips.clear();
  if (dip >= config.dips.size()) return own;
  const DipEntry& entry = config.dips[dip];
  if (entry.down) own.object.pose.down = *entry.down;
  if (entry.rotate_deg) own.object.pose.rotate_deg = *entry.rotate_deg;
  if (entry.depth_mm) own.design.trajectory.depth_mm = *entry.depth_mm;
  if (!entry.path.empty()) {
    own.design.trajectory.path = entry.path;
    own.design.trajectory.depth_mm = 0;  // a path says how deep
  }
  if (!entry.correction.empty())
    own.design.film.correction = read_correction_field(entry.correction);
  return own;
}

Project project_of(const JobConfig& config, LookQuality quality) {
  Project project;
  project.model = config.model;
  project.load = config.object.load;
  project.pose = config.object.pose;
  project.base = config.object.base;
  project.artwork = config.object.artwork;
  project.design = config.design;
  project.design.dpi = shown_dpi(config, quality);
  if (quality != LookQuality::kNormal) project.design.inverse.samples_per_axis = 1;
  if (quality == LookQuality::kSketch) make_sketch(project);
  project.printer = config.printer;
  return project;
}

Look look_at_dip(Workspace& workspace, const JobConfig& job, std::size_t dip, LookQuality quality,
                 const std::vector<std::string>& known, const RunContext& context) {
  const RunScope scope(context);
  if (job.model.empty())
    refuse("no-model", "There is no model yet: drop one here, or open a sample.", Json::array());
  require_known_way(job, dip);
  return or_refused([&] {
    Look look;
    look.config = config_of_dip(job, dip);
    look.dip = dip;
    look.dips = std::max<std::size_t>(1, job.dips.size());
    look.quality = quality;
    const Project project = project_of(look.config, quality);
    look.model = workspace.model(project, context);
    const auto posed = workspace.posed(project, context);
    require_sensible_size(look.config, posed->mesh());
    require_room(look.config, *posed, context);
    look.paint = workspace.paint(project, quality_of(quality), context);
    look.artwork = workspace.laid(project, quality_of(quality), context);
    look.made = workspace.designed(project, quality_of(quality), context);
    look.paint = paint_as_dipped(look.paint, look.made->dipped);
    look.dry = dry_layers(look.artwork, look.made->dipped, points_of(quality));
    look.warnings = known;
    std::vector<std::string> dry;
    if (look.dips == 1)
      for (const DryLayer& layer : look.dry) dry.push_back(layer.told);
    for (const auto& list : {look.model->health.findings(), context.warnings(), dry})
      for (const std::string& warning : list)
        if (std::find(look.warnings.begin(), look.warnings.end(), warning) == look.warnings.end())
          look.warnings.push_back(warning);
    return look;
  });
}

DipsTogether look_at_dips(Workspace& workspace, const JobConfig& job, int texture_px,
                          const RunContext& context) {
  const RunScope scope(context);
  return or_refused([&] {
    JobConfig config = job;
    config.plan.find_pose = config.plan.find_depth = false;
    const Project project = project_of(config, LookQuality::kDraft);
    const auto model = workspace.model(project, context);
    const auto posed = workspace.posed(project, context);
    MeshHealth health = model->health;
    health.area_mm2 *= posed->scale() * posed->scale();
    config.design = draft_of(project.design);
    const PreparedObject prepared{.posed = *posed,
                                  .paint = workspace.paint(project, Quality::kDraft, context),
                                  .health = std::move(health),
                                  .units = model->units,
                                  .files = {},
                                  .artwork = workspace.laid(project, Quality::kDraft, context),
                                  .picture_problems = {}};
    return put_together(config, prepared, texture_px, context.quiet());
  });
}

std::vector<std::uint8_t> finish_bundle(const DipsTogether& look, Json head,
                                        const std::filesystem::path& uploads) {
  Report report = look.report;
  for (std::string& warning : report.warnings) warning = without_folder(warning, uploads);
  const ReportSeams& seams = *report.seams;
  const std::vector<Finding> list = findings(report);
  head["covered_share"] = report.coverage->covered_share();
  head["verdict"] = verdict_of(report, list);
  head["findings"] = Json::array();
  for (const Finding& f : list)
    head["findings"].push_back(
        finding_json(f, f.key == "seams" || f.key == "coverage" ? "parts" : "", Json::array()));
  head["dry_layers"] = layers_json(look.dry);
  head["dips"] = Json::array();
  for (std::size_t k = 0; k < report.dips.size(); ++k) {
    const ReportDip& dip = report.dips[k];
    head["dips"].push_back({{"part_share", dip.part_share},
                            {"gained_share", dip.gained_share},
                            {"covered_share", dip.covered_share},
                            {"torn_share", dip.torn_share},
                            {"color", hex_of(look.color_of[k])},
                            {"width_px", look.sheets[k].width_px},
                            {"height_px", look.sheets[k].height_px}});
  }
  head["seams"] = {{"length_mm", seams.length_mm},
                   {"overlap_mm", seams.overlap_mm},
                   {"error_mean", seams.error_mean},
                   {"off_mm", seams.off_mm},
                   {"error_mean_off", seams.error_mean_off}};
  Bundle bundle(std::move(head));
  for (std::size_t k = 0; k < look.sheets.size(); ++k)
    bundle.add(fmt::format("sheet.{}", k), look.sheets[k].rgba, 4);
  return bundle.finish();
}

std::vector<std::uint8_t> result_bundle(const Look& look, Json head,
                                        const std::filesystem::path& uploads,
                                        const RunContext& context) {
  const RunScope scope(context);
  const DippedObject& dipped = look.made->dipped;
  const DippedFilm& film = *dipped.film;
  const FilmInk& ink = look.made->ink.ink;
  const FilmOptions& sheet = look.config.design.film;
  const BathOptions& bath = look.config.bath;
  const Printer printer = make_printer(look.config.printer);
  const Report report = report_of(look, uploads, context);
  const std::vector<Finding> list = findings_of(look, report);
  head["quality"] = quality_name(look.quality);
  head["dip"] = look.dip;
  head["dips"] = look.dips;
  const Eigen::Matrix4d& matrix = dipped.posed.matrix();
  head["matrix"] = std::vector<double>(matrix.data(), matrix.data() + 16);
  head["scale"] = dipped.posed.scale();
  head["depth_mm"] = film.depth_mm;
  head["hold"] = describe_hold(look.config.object.pose, way_up(look.config));
  head["film"] = {{"width_mm", sheet.width_mm},
                  {"height_mm", sheet.height_mm},
                  {"margin_mm", sheet.margin_mm},
                  {"shape", sheet.shape == FilmShape::kDisc ? "disc" : "rectangle"},
                  {"cell_mm", film.mesh().cell_mm},
                  {"tear_stretch", look.config.design.dip.material.tear_stretch}};
  head["bath"] = {
      {"width_mm", bath.width_mm}, {"height_mm", bath.height_mm}, {"depth_mm", bath.depth_mm}};
  head["sheet"] = {{"width_px", ink.on_object.width_px}, {"height_px", ink.on_object.height_px}};
  head["verdict"] = verdict_of(report, list);
  head["findings"] = findings_json(look, list);
  head["figures"] = figures_json(look);
  head["artwork"] = Json::array();
  for (const LaidLayer& laid : look.artwork)
    head["artwork"].push_back({{"size_mm", {laid.size_mm.x(), laid.size_mm.y()}},
                               {"stretch", {laid.stretch_least, laid.stretch_most}}});
  head["dry_layers"] = layers_json(look.dry);
  head["warnings"] = Json::array();
  for (const std::string& warning : report.warnings)
    head["warnings"].push_back(in_plain_words(warning));
  Bundle bundle(std::move(head));
  add_film(bundle, film);
  add_sheet(bundle, ink, *printer.model);
  add_air(bundle, dipped);
  return bundle.finish();
}

std::vector<std::uint8_t> dip_bundle(const DippedObject& dipped) {
  const std::vector<DipFrame>& frames = dipped.history->frames();
  std::vector<float> positions;
  Json levels = Json::array(), poses = Json::array();
  for (const DipFrame& frame : frames) {
    levels.push_back(frame.moment.travelled_mm);
    if (frame.moment.moved) {
      Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
      pose.topLeftCorner<3, 3>() = frame.moment.turn;
      pose.topRightCorner<3, 1>() = frame.moment.shift - Vec3(0, 0, frame.moment.level_mm);
      poses.push_back(std::vector<double>(pose.data(), pose.data() + 16));
    }
    for (const auto& p : frame.position) positions.insert(positions.end(), p.begin(), p.end());
  }
  Json head = {{"frames", frames.size()}, {"levels_mm", levels}};
  if (!poses.empty()) head["poses"] = poses;
  Bundle bundle(std::move(head));
  bundle.add("position", positions, 3);
  bundle.add("attached_from", dipped.history->attached_from(), 1);
  return bundle.finish();
}

}  // namespace hydrodip
