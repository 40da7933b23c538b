#include "job/print_dips.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/parallel.h"
#include "base/run_scope.h"
#include "export/film_ply.h"
#include "export/preview_glb.h"
#include "export/scene.h"
#include "hydrodip/hydrodip.h"
#include "image/files.h"
#include "image/resize.h"
#include "job/dip_plan.h"
#include "job/finish_check.h"
#include "job/job_record.h"
#include "job/output.h"
#include "job/prepare.h"
#include "job/sheet_of.h"
#include "object/bake.h"
#include "plan/seams.h"
#include "render/preview.h"
#include "report/findings.h"
#include "session/appearance_of.h"
#include "session/sheet_files.h"

namespace hydrodip {
namespace {

// Nodes of the divided surface lie so close, in parts of the overlap, as far as so many allow.
constexpr double kNodesInOverlap = 3.5;
constexpr double kLeastSpacing_mm = 0.3;
constexpr int kFewestNodes = 8000, kMostNodes = 60000;

struct MadeDip {
  JobConfig config;  // of this dip alone
  Trial trial;
  DippedObject blank;  // before its ink was known
  Designed made;
  std::string folder;  // "dip-1"
  int number = 1;
};

// Everything that the report and the pictures are made of. The coats are those of `dips`.
struct MadeDips {
  const JobConfig& config;
  const PreparedObject& prepared;
  std::vector<MadeDip> dips;
  std::shared_ptr<const SurfaceNodes> nodes;
  std::vector<std::vector<float>> worth;  // of the films as they were dipped with their ink
};

JobConfig config_of(const JobConfig& config, const Trial& trial, std::size_t number,
                    std::size_t of) {
  JobConfig own = config;
  own.object.pose = trial.pose;
  own.design.trajectory.depth_mm = trial.path.empty() ? trial.depth_mm : 0;
  own.design.trajectory.path = trial.path;
  own.dips.clear();
  own.plan.dips = 0;
  const std::string name =
      config.print.job_name.empty() ? config.model.filename().string() : config.print.job_name;
  own.print.job_name = fmt::format("{}, dip {} of {}", name, number, of);
  return own;
}

Trajectory way_of(const MadeDip& dip) {
  return make_trajectory(dip.config.design.trajectory, dip.blank.posed.mesh().positions);
}

std::shared_ptr<const SurfaceNodes> make_nodes(const PreparedObject& prepared, double overlap_mm) {
  const double spacing_mm = std::max(kLeastSpacing_mm, overlap_mm / kNodesInOverlap);
  const double wanted = prepared.health.area_mm2 / (spacing_mm * spacing_mm);
  const int count = int(std::clamp(wanted, double(kFewestNodes), double(kMostNodes)));
  return std::make_shared<const SurfaceNodes>(spread_targets(prepared.posed.object(), count));
}

std::vector<float> worth_at_nodes(const MadeDip& dip, const DippedObject& dipped,
                                  const PreparedObject& prepared, const SurfaceNodes& nodes) {
  return judge_dip(job_trials(dip.config, prepared, nodes.targets()), dip.trial.pose, dipped).worth;
}

// The surface divided by the films as they lie without ink.
SharedSurface divide(const MadeDips& all, const RunContext& context) {
  std::vector<std::vector<float>> worth;
  for (const MadeDip& dip : all.dips)
    worth.push_back(worth_at_nodes(dip, dip.blank, all.prepared, *all.nodes));
  const Object& object = all.prepared.posed.object();
  const Surface surface(object.positions, object.triangles);
  return {{all.nodes, std::move(worth), *all.prepared.paint, surface, all.prepared.posed.scale(),
           all.config.plan.overlap_mm},
          context};
}

Coverage together(const MadeDips& all, const std::vector<std::vector<float>>& worth) {
  Coverage sum;
  const Targets& targets = all.nodes->targets();
  const double scale = all.prepared.posed.scale();
  sum.object_mm2 = sum.downward_mm2 = scale * scale * targets.area;
  for (std::size_t i = 0; i < targets.list.size(); ++i)
    if (std::any_of(worth.begin(), worth.end(), [&](const auto& w) { return w[i] > 0; }))
      sum.covered_mm2 += scale * scale * targets.list[i].area;
  sum.covered_downward_mm2 = sum.covered_mm2;
  double stretch = 0, area_ratio = 0;
  for (const MadeDip& dip : all.dips) {
    const Coverage& c = dip.made.dipped.coverage;
    sum.film_on_object_mm2 += c.film_on_object_mm2;
    sum.torn_mm2 += c.torn_mm2;
    sum.stretch_max = std::max(sum.stretch_max, c.stretch_max);
    sum.area_ratio_max = std::max(sum.area_ratio_max, c.area_ratio_max);
    stretch += c.stretch_mean * c.film_on_object_mm2;
    area_ratio += c.area_ratio_mean * c.film_on_object_mm2;
  }
  if (sum.film_on_object_mm2 > 0) {
    sum.stretch_mean = stretch / sum.film_on_object_mm2;
    sum.area_ratio_mean = area_ratio / sum.film_on_object_mm2;
  }
  return sum;
}

std::vector<ReportDip> report_dips(const MadeDips& all, const SharedSurface& shared) {
  std::vector<ReportDip> list;
  const Targets& targets = all.nodes->targets();
  const std::vector<double> parts = shared.shares_of_surface();
  std::vector<std::uint8_t> covered(targets.list.size(), 0);
  double so_far = 0;
  for (std::size_t k = 0; k < all.dips.size(); ++k) {
    const MadeDip& dip = all.dips[k];
    double gained = 0;
    for (std::size_t i = 0; i < covered.size(); ++i) {
      if (covered[i] || !(all.worth[k][i] > 0)) continue;
      covered[i] = 1;
      gained += targets.list[i].area / targets.area;
    }
    so_far += gained;
    const Vec3& rotate = dip.trial.pose.rotate_deg;
    list.push_back({side_name(dip.trial.pose.down),
                    {rotate.x(), rotate.y(), rotate.z()},
                    dip.trial.depth_mm,
                    describe_hold(dip.trial.pose, way_up(all.config)),
                    dip.folder,
                    parts[k],
                    gained,
                    so_far,
                    dip.made.dipped.coverage.torn_share()});
  }
  return list;
}

std::vector<ReportOutput> outputs_of(const MadeDips& all) {
  std::vector<ReportOutput> list;
  const char* side = all.config.print.ink_side == InkSide::kUp ? "up" : "down";
  for (std::size_t k = 0; k < all.dips.size(); ++k) {
    const std::string& folder = all.dips[k].folder;
    list.push_back(
        {folder + "/print.pdf",
         fmt::format("sheet {}: print it at 100 % (no scaling), ink side {}", k + 1, side)});
  }
  list.push_back({"dip-.../print.png, print.tif, film.ply, preview.glb, report.json",
                  "what belongs to each dip"});
  if (all.config.pictures) {
    list.push_back({"preview.png", "the whole finish: what was asked for beside what comes out"});
    list.push_back({"dips.png", "which dip does which part, and how far colours are off"});
  }
  list.push_back({"report.html", "everything about this job, for people"});
  list.push_back({"report.json", "the same for programs"});
  return list;
}

std::vector<std::string> file_names(const MadeDips& all) {
  std::vector<std::string> names;
  for (const MadeDip& dip : all.dips)
    for (const char* name :
         {"print.pdf", "print.png", "print.tif", "film.ply", "preview.glb", "report.json"})
      names.push_back(dip.folder + "/" + name);
  if (all.config.pictures) names.insert(names.end(), {"preview.png", "dips.png"});
  names.insert(names.end(), {"report.html", "report.json"});
  return names;
}

// What the wet bench needs of one dip.
void write_dip(OutputFolder& folder, const MadeDip& dip, const MadeDips& all,
               const std::vector<ReportInput>& inputs, const Printer& printer, const Timings& times,
               const RunContext& context) {
  const std::string inside = dip.folder + "/";
  write_sheet_files(folder, dip.made.ink.ink, printer, sheet_of(dip.config), context, inside);
  write_film_ply(folder.path(inside + "film.ply"), *dip.made.dipped.film);
  const PosedObject& posed = dip.made.dipped.posed;
  const int texture_px = dip.config.preview_texture_px;
  const Object looks = painted_object(posed.mesh(), *all.prepared.paint);
  write_preview_glb(folder.path(inside + "preview.glb"), looks, posed.surface(),
                    *dip.made.dipped.film, shrink_to(dip.made.ink.ink.on_object, 2 * texture_px),
                    dip.made.raster.width_mm, dip.made.raster.height_mm, all.prepared.paint->base(),
                    texture_px);
  const Finish alone(all.prepared.paint,
                     {{dip.made.dipped, dip.made.raster,
                       std::make_shared<const Image>(dip.made.ink.ink.on_object)}});
  const JobRecord record{"print", dip.config,    all.prepared,         inputs, alone, times,
                         context, &dip.made.ink, printer.model->name()};
  Report report = make_report(record);
  report.warnings.clear();
  report.dip_number = dip.number;
  report.dip_of = int(all.dips.size());
  write_report_json(folder.path(inside + "report.json"), report);
}

// A colour for each dip, told apart by everybody (Okabe and Ito's, and paler ones after them).
LinearColor dip_color(std::size_t dip) {
  constexpr std::array<std::array<int, 3>, 7> kColors = {{{0, 114, 178},
                                                          {230, 159, 0},
                                                          {0, 158, 115},
                                                          {204, 121, 167},
                                                          {86, 180, 233},
                                                          {213, 94, 0},
                                                          {240, 228, 66}}};
  const auto& c = kColors[dip % kColors.size()];
  const float pale = dip < kColors.size() ? 0.0F : 0.5F;
  const auto channel = [&](int v) {
    const float linear = srgb8_to_linear(std::uint8_t(v));
    return linear + pale * (1 - linear);
  };
  return {channel(c[0]), channel(c[1]), channel(c[2]), 1};
}

LinearColor error_color(double difference) {
  const auto t = float(std::clamp(difference / 10, 0.0, 1.0));
  return {0.6F + 0.1F * t, 0.6F * (1 - t), 0.6F * (1 - t) * (1 - t), 1};
}

struct Pictures {
  std::vector<std::uint8_t> preview_png, dips_png;
  std::string scene;
};

using Look = std::function<LinearColor(const SurfacePoint&)>;

// A look as a paint, to be baked.
class LookPaint : public Paint {
 public:
  LookPaint(const LinearColor& base, Look look) : Paint(base), look_(std::move(look)) {}
  LinearColor color_at(const SurfacePoint& point) const override { return look_(point); }
  bool says_anything() const override { return true; }

 private:
  Look look_;
};

// Draws what the report shows of a finish.
class FinishPictures {
 public:
  FinishPictures(const MadeDips& all, const SharedSurface& shared, const Finish& finish,
                 const FinishCheck& check)
      : all_(all),
        shared_(shared),
        finish_(finish),
        check_(check),
        posed_(all.prepared.posed.shared_object(), all.config.object.pose),
        standing_(standing_of(posed_, way_up(all.config))) {}

  Pictures draw(const std::string& caption, const RunContext& context) const {
    PreviewOptions options;
    options.width_px = all_.config.preview_width_px;
    options.base = finish_.paint().base();
    options.whole = true;
    options.standing = standing_;
    std::vector<PreviewPair> pairs(2);
    pairs[0].shown = appearance_of(finish_);
    pairs[0].caption = caption;
    pairs[1].shown.wanted = [&](const SurfacePoint& p, const Vec3&, const Vec3&) {
      return part_at(p);
    };
    pairs[1].shown.predicted = [&](const SurfacePoint& p, const Vec3&, const Vec3&) {
      return error_at(p);
    };
    pairs[1].titles = {"which dip does what; grey: none", "colour error: grey 0, red 10 and more"};
    pairs[1].caption = fmt::format(
        "{:.0f} mm of seams, {:g} mm wide; colour error (CIEDE2000) over them {:.1f}, elsewhere "
        "{:.1f}",
        shared_.seam_mm(), all_.config.plan.overlap_mm, check_.seam_error(), check_.other_error());
    const std::vector<Image> pages =
        render_previews(posed_.mesh(), posed_.surface(), *all_.dips.front().made.dipped.film, pairs,
                        options, context);
    return {encode_png(pages[0]), encode_png(pages[1]), scene(context)};
  }

 private:
  LinearColor part_at(const SurfacePoint& point) const {
    if (!finish_.has_film_at(point)) return {0.35F, 0.35F, 0.35F, 1};
    const TriangleMesh& model = all_.prepared.posed.object();
    const std::vector<float> shares =
        shared_.shares_at(position_at(model, point), face_normal(model, point.triangle));
    LinearColor color{0, 0, 0, 1};
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const LinearColor own = dip_color(k);
      color = {color.r + shares[k] * own.r, color.g + shares[k] * own.g,
               color.b + shares[k] * own.b, 1};
    }
    return color;
  }

  LinearColor error_at(const SurfacePoint& point) const {
    const TriangleMesh& model = all_.prepared.posed.object();
    return error_color(
        check_.error_near(position_at(model, point), face_normal(model, point.triangle)));
  }

  // The page's view shows a mesh with y up and its front towards -z.
  std::string scene(const RunContext& context) const {
    Mat3 turn;
    turn.row(0) = standing_.front.cross(standing_.up);
    turn.row(1) = standing_.up;
    turn.row(2) = -standing_.front;
    TriangleMesh mesh = posed_.mesh();
    for (Vec3& p : mesh.positions) p = turn * p;
    constexpr int kColors_px = 1024, kOthers_px = 512;
    const auto baked = [&](const Look& look, int most_px) {
      return painted_object(mesh, LookPaint(finish_.paint().base(), look), most_px);
    };
    const Object wanted = painted_object(mesh, finish_.paint());
    const DippedFilm no_film;
    const DipHistory no_history;
    SceneSource source{wanted, no_film, no_history, Image()};
    source.base = finish_.paint().base();
    source.dips = int(all_.dips.size());
    source.looks = {
        {"none", baked([&](const auto& p) { return finish_.color_at(p); }, kColors_px)},
        {"parts", baked([&](const auto& p) { return part_at(p); }, kOthers_px)},
        {"finish_error", baked([&](const auto& p) { return error_at(p); }, kOthers_px)}};
    return scene_json(source, context);
  }

  const MadeDips& all_;
  const SharedSurface& shared_;
  const Finish& finish_;
  const FinishCheck& check_;
  const PosedObject posed_;
  const Standing standing_;
};

void write_bytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  write_file(path, bytes.data(), bytes.size());
}

void require_some_ink(const MadeDips& all) {
  const bool any = std::any_of(all.dips.begin(), all.dips.end(), [](const MadeDip& dip) {
    const auto& laid = dip.made.ink.ink.inking.inks.cmyk;
    return std::any_of(laid.begin(), laid.end(), [](std::uint8_t value) { return value != 0; });
  });
  if (!any)
    throw InputError(fmt::format(
        "{}: all sheets would be blank: what the films reach of the model is white, transparent or "
        "of the object's own colour; check its texture and colours",
        all.config.model.string()));
}

}  // namespace

bool asks_for_several_dips(const JobConfig& config) {
  return config.plan.dips > 1 || !config.dips.empty();
}

JobResult print_dips(const JobConfig& config, const RunContext& context) {
  const RunScope scope(context.with_threads(config.threads));
  require_memory(config.design);
  OutputFolder folder(config.output, config.earlier_result);
  Timings times;
  const PreparedObject prepared = times.measure("load", [&] {
    return prepare_object(config.model, config.object, context, config.design.dpi,
                          config.design.inverse.samples_per_axis);
  });
  require_size(prepared.posed, config.object, config.model);
  require_appearance(prepared, config.model);
  if (prepared.paint->depends_on_film())
    throw InputError(
        "artwork that is laid on the film (projection film) belongs to one dip: give it another "
        "projection, or leave out --dips and [[dip]]");
  const Printer printer = make_printer(config.printer);
  const std::vector<ReportInput> inputs = describe_inputs(config, prepared, printer);

  const DipPlan plan = times.measure("plan", [&] {
    const Targets targets = job_targets(config, prepared, context);
    return plan_dips(config, prepared, targets, false, context);
  });
  MadeDips all{config, prepared, {}, make_nodes(prepared, config.plan.overlap_mm), {}};
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    MadeDip dip{
        config_of(config, plan.dips[k], k + 1, plan.dips.size()),
        plan.dips[k],
        DippedObject{.posed = PosedObject(prepared.posed.shared_object(), plan.dips[k].pose)},
        {DippedObject{.posed = prepared.posed}, {}, {}},
        fmt::format("dip-{}", k + 1),
        int(k) + 1};
    const TriangleMesh& mesh = dip.blank.posed.mesh();
    require_fit(mesh, room_of(mesh, way_of(dip)), config.design.film, config.bath, context);
    all.dips.push_back(std::move(dip));
  }
  std::vector<std::filesystem::path> input_files;
  for (const ReportInput& input : inputs) input_files.emplace_back(input.path);
  folder.announce(file_names(all), input_files);

  const auto film = std::make_shared<const FilmMesh>(make_film_mesh(config.design.film));
  for (MadeDip& dip : all.dips)
    dip.blank = dip_object(dip.blank.posed, film, way_of(dip), config.design.dip, times, context);
  const SharedSurface shared = times.measure("seams", [&] { return divide(all, context); });

  const auto mesh = std::make_shared<const TriangleMesh>(prepared.posed.object());
  std::vector<Designed> designs;
  for (std::size_t k = 0; k < all.dips.size(); ++k) {
    MadeDip& dip = all.dips[k];
    context.log(fmt::format("dip {} of {}", k + 1, all.dips.size()));
    dip.made = design({dip.blank.posed, *prepared.paint, shared.allotment(k, mesh), *printer.model,
                       dip.config.design},
                      times, context);
    designs.push_back(dip.made);
    all.worth.push_back(worth_at_nodes(dip, dip.made.dipped, prepared, *all.nodes));
  }
  require_some_ink(all);
  const Finish finish = hydrodip::finish(prepared.paint, designs, printer);

  times.measure("sheet", [&] {
    for (const MadeDip& dip : all.dips)
      write_dip(folder, dip, all, inputs, printer, times, context);
  });
  const FinishCheck check =
      times.measure("check", [&] { return FinishCheck(finish, shared, context); });

  Report report = make_report({"print", config, prepared, inputs, finish, times, context,
                               &all.dips.front().made.ink, printer.model->name()});
  report.coverage = together(all, all.worth);
  report.angles.reset();
  report.figures.clear();
  report.rounds.clear();
  report.dips = report_dips(all, shared);
  report.verdict = several_dips_verdict(*report.coverage, all.dips.size());
  report.colors = check.colors();
  report.seams = ReportSeams{shared.seam_mm(), config.plan.overlap_mm, check.seam_error(),
                             FinishCheck::kOff_mm, check.seam_error_off()};
  report.outputs = outputs_of(all);
  ReportPictures pictures;
  if (config.pictures) {
    times.measure("preview", [&] {
      const Pictures drawn =
          FinishPictures(all, shared, finish, check)
              .draw(headline(concern_of(findings(report))) + ": " + report.verdict, context);
      write_bytes(folder.path("preview.png"), drawn.preview_png);
      write_bytes(folder.path("dips.png"), drawn.dips_png);
      pictures.preview_png = drawn.preview_png;
      pictures.dips_png = drawn.dips_png;
      pictures.scene = drawn.scene;
    });
  }
  report.total_seconds = times.total_s();
  report.stages.clear();
  for (const Timing& time : times.list()) report.stages.push_back({time.what, time.seconds});
  write_report_json(folder.path("report.json"), report);
  write_report_html(folder.path("report.html"), report, pictures);
  context.check_cancelled();
  folder.commit();
  JobResult result = describe_result(report, folder.folder());
  result.files = file_names(all);
  for (const MadeDip& dip : all.dips) result.dips.push_back(dip.folder);
  if (folder.replaced_earlier()) result.text = "replaced the earlier result there\n" + result.text;
  return result;
}

}  // namespace hydrodip
