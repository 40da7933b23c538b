#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/file.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "dip/wetting.h"
#include "image/files.h"
#include "job/dip_plan.h"
#include "job/jobs.h"
#include "job/output.h"
#include "job/prepare.h"
#include "job/print_dips.h"
#include "job/ways.h"
#include "object/dip_angles.h"
#include "plan/hold.h"
#include "render/maps.h"
#include "report/report.h"
#include "settings/settings.h"

namespace hydrodip {
namespace {

using json = nlohmann::ordered_json;

// Widest histogram bar, in characters.
constexpr double kBarLength = 40;

// A sheet that can be bought, and whether the object fits it.
struct FilmChoice {
  std::string name;
  double width_mm = 0, height_mm = 0;
  double excess_mm = 0;   // the worst direction's; not positive: the object fits it
  bool fits_bath = true;  // the sheet does
  bool fits() const { return excess_mm <= 0; }
};

// One of several dips, as far as the job says how it is made.
struct ToldDip {
  std::optional<PoseOptions> pose;
  std::optional<Vec3> size_mm;  // as posed
  std::optional<TrajectoryOptions> way;
  std::optional<double> depth_mm;
  std::optional<Room> room;  // where pose and way are known
  std::vector<RoomFit> fit;
};

struct Inspection {
  const JobConfig& config;
  const PreparedObject& prepared;
  double depth_mm = 0;
  DippingDirection direction_at;
  std::vector<ToldDip> dips;  // of a job of several
  std::vector<RoomFit> fit;   // film and bath of this job
  std::vector<FilmChoice> films;
  DipAngles angles;
  std::vector<std::string> warnings;
};

double worst_excess_mm(const std::vector<RoomFit>& list) {
  double worst = -1e300;
  for (const RoomFit& fit : list) worst = std::max(worst, fit.excess_mm());
  return worst;
}

std::vector<ToldDip> told_dips(const JobConfig& config, const PreparedObject& prepared) {
  std::vector<ToldDip> dips;
  for (const DipEntry& entry : config.dips) {
    ToldDip& dip = dips.emplace_back();
    dip.pose = told_pose(entry, config.object.pose);
    dip.way = told_way(entry, config.design.trajectory);
    if (dip.way && dip.way->path.empty() && dip.way->depth_mm > 0) dip.depth_mm = dip.way->depth_mm;
    if (!dip.pose) continue;
    const PosedObject posed(prepared.posed.shared_object(), *dip.pose);
    const TriangleMesh& mesh = posed.mesh();
    dip.size_mm = mesh.bounds().size();
    if (!dip.way) continue;
    dip.room = room_of(mesh, make_trajectory(*dip.way, mesh.positions));
    dip.depth_mm = dip.room->depth_mm;
    dip.fit = fits(posed.size_mm(), *dip.room, config.design.film, config.bath);
  }
  if (asks_for_several_dips(config))
    dips.resize(std::max(dips.size(), std::size_t(std::max(config.plan.dips, 0))));
  return dips;
}

// What has to fit film and bath: of several dips each that is known, if one is.
std::vector<Room> rooms_of(const std::vector<ToldDip>& dips, const Room& alone) {
  std::vector<Room> rooms;
  for (const ToldDip& dip : dips)
    if (dip.room) rooms.push_back(*dip.room);
  if (rooms.empty()) rooms.push_back(alone);
  return rooms;
}

FilmChoice try_film(const std::vector<Room>& rooms, FilmOptions film, const BathOptions& bath,
                    const std::string& name, double width_mm, double height_mm) {
  film.width_mm = width_mm;
  film.height_mm = height_mm;
  double worst = -1e300;
  for (const Room& room : rooms) worst = std::max(worst, worst_excess_mm(film_fits(room, film)));
  return {name, width_mm, height_mm, worst, sheet_fits_bath(film, bath)};
}

std::vector<FilmChoice> film_choices(const std::vector<Room>& rooms, const FilmOptions& film,
                                     const BathOptions& bath) {
  std::vector<FilmChoice> list;
  for (const FilmFormat& format : film_formats()) {
    list.push_back(try_film(rooms, film, bath, format.name, format.width_mm, format.height_mm));
    list.push_back(
        try_film(rooms, film, bath, format.name + "-landscape", format.height_mm, format.width_mm));
  }
  return list;
}

std::string share(double part, double whole) {
  return fmt::format("{:.1f} %", whole > 0 ? 100 * part / whole : 0.0);
}

std::string describe_size(const Inspection& i) {
  const Vec3 size = i.prepared.posed.mesh().bounds().size();
  std::string text =
      fmt::format("size         {:.2f} x {:.2f} x {:.2f} mm (x, y, z as posed; read as {})\n",
                  size.x(), size.y(), size.z(), i.prepared.units);
  if (i.dips.empty()) text += fmt::format("dipped       {:.2f} mm deep\n", i.depth_mm);
  return text;
}

std::string too_much(const RoomFit& fit) {
  return fmt::format("{:.2f} mm too much", fit.excess_mm());
}

std::string describe_dip(const ToldDip& dip, ModelSide up) {
  std::string text = dip.pose ? describe_hold(*dip.pose, up) : "held as plan finds";
  text += dip.depth_mm ? fmt::format(", {:.2f} mm deep", *dip.depth_mm)
          : dip.way    ? ", as its table says"
                       : ", as deep as plan finds";
  if (dip.fit.empty()) return text;
  std::string excess;
  for (const RoomFit& fit : dip.fit)
    if (fit.excess_mm() > 0)
      excess += fmt::format("; {:.2f} of {:.2f} mm {}: {}", fit.needed_mm, fit.available_mm,
                            fit.what, too_much(fit));
  return text + (excess.empty() ? "; fits" : excess);
}

std::string describe_dips(const Inspection& i) {
  std::string text;
  for (std::size_t k = 0; k < i.dips.size(); ++k)
    text += fmt::format("{:<12} {}\n", fmt::format("dip {}", k + 1),
                        describe_dip(i.dips[k], way_up(i.config)));
  return text;
}

std::string describe_appearance(const Object& object) {
  if (object.has_appearance()) return "textured or coloured";
  return object.uvs.empty()
             ? "none; to print, put a picture on it with --art, or give it vertex colours"
             : "UVs without a texture; to print, name one with --texture";
}

std::string describe_mesh(const Inspection& i) {
  const MeshHealth& h = i.prepared.health;
  std::string text = fmt::format(
      "mesh         {} triangles, {} vertices, {} {}, {}; area {:.0f} mm2, volume {:.0f} mm3\n",
      h.triangles, h.vertices, h.shells, h.shells == 1 ? "shell" : "shells",
      h.closed() ? "closed" : "open", h.area_mm2, h.volume_mm3);
  text += "appearance   " + describe_appearance(i.prepared.posed.object()) + "\n";
  return text;
}

std::string describe_fit(const Inspection& i) {
  std::string text;
  // Of several dips each says for itself whether it does.
  for (const RoomFit& fit : i.dips.empty() ? i.fit : std::vector<RoomFit>())
    text += fmt::format("{:<12} {:.2f} of {:.2f} mm {}: {}\n",
                        fit.room == "the bath" ? "bath" : "film", fit.needed_mm, fit.available_mm,
                        fit.what, fit.excess_mm() > 0 ? too_much(fit) : std::string("fits"));
  std::string fitting;
  for (const FilmChoice& film : i.films)
    if (film.fits())
      fitting += (fitting.empty() ? "" : ", ") + film.name +
                 (film.fits_bath ? "" : " (larger than the bath)");
  return text + "fits on      " + (fitting.empty() ? "no standard film" : fitting) + "\n";
}

std::string describe_angles(const DipAngles& a) {
  std::string text = fmt::format(
      "dip angles   between dipping direction and surface; film may tear beyond {:.0f} degrees\n",
      kDipAngleLimit_deg);
  const double longest = *std::max_element(a.area_mm2.begin(), a.area_mm2.end());
  for (int bin = 0; bin < DipAngles::kBins; ++bin) {
    const double area = a.area_mm2[static_cast<std::size_t>(bin)];
    const auto bar = static_cast<std::size_t>(longest > 0 ? kBarLength * area / longest : 0);
    text += fmt::format("  {:2} to {:2}   {:>7}  {}\n", 10 * bin, 10 * (bin + 1),
                        share(area, a.downward_mm2), std::string(bar, '#'));
  }
  return text +
         fmt::format("  {:.0f} mm2 or {} of the surface that faces down is beyond the limit\n",
                     a.over_limit_mm2, share(a.over_limit_mm2, a.downward_mm2));
}

std::string describe(const Inspection& i) {
  std::string text = describe_size(i) + describe_mesh(i) + describe_dips(i) + describe_fit(i) +
                     describe_angles(i.angles);
  for (const std::string& warning : i.warnings) text += "warning: " + warning + "\n";
  return text;
}

json triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

json health_json(const MeshHealth& h) {
  return {{"vertices", h.vertices},
          {"triangles", h.triangles},
          {"degenerate_removed", h.degenerate_removed},
          {"duplicates_removed", h.duplicates_removed},
          {"flipped", h.flipped},
          {"boundary_edges", h.boundary_edges},
          {"holes", h.holes},
          {"nonmanifold_edges", h.nonmanifold_edges},
          {"shells", h.shells},
          {"closed", h.closed()},
          {"volume_mm3", h.volume_mm3},
          {"area_mm2", h.area_mm2},
          {"findings", h.findings()}};
}

json fit_json(const std::vector<RoomFit>& list) {
  json all = json::array();
  for (const RoomFit& fit : list)
    all.push_back({{"direction", fit.what},
                   {"room", fit.room},
                   {"needed_mm", fit.needed_mm},
                   {"available_mm", fit.available_mm},
                   {"fits", fit.excess_mm() <= 0}});
  return all;
}

json films_json(const std::vector<FilmChoice>& films) {
  json all = json::array();
  for (const FilmChoice& film : films)
    all.push_back({{"name", film.name},
                   {"width_mm", film.width_mm},
                   {"height_mm", film.height_mm},
                   {"fits", film.fits()},
                   {"fits_bath", film.fits_bath}});
  return all;
}

// What plan has to find is null.
json dips_json(const std::vector<ToldDip>& dips) {
  json all = json::array();
  for (const ToldDip& dip : dips) {
    json told = {{"down", nullptr},
                 {"rotate_deg", nullptr},
                 {"depth_mm", nullptr},
                 {"size_mm", nullptr},
                 {"fit", fit_json(dip.fit)}};
    if (dip.pose) {
      told["down"] = side_name(dip.pose->down);
      told["rotate_deg"] = triple(dip.pose->rotate_deg);
    }
    if (dip.depth_mm) told["depth_mm"] = *dip.depth_mm;
    if (dip.size_mm) told["size_mm"] = triple(*dip.size_mm);
    all.push_back(told);
  }
  return all;
}

std::string machine_readable(const Inspection& i) {
  const Vec3 size = i.prepared.posed.mesh().bounds().size();
  json all = {{"schema_version", 1},
              {"command", "inspect"},
              {"model", i.config.model.string()},
              {"units", i.prepared.units},
              {"size_mm", triple(size)},
              {"depth_mm", i.depth_mm},
              {"has_appearance", i.prepared.posed.object().has_appearance()},
              {"mesh", health_json(i.prepared.health)},
              {"fit", fit_json(i.fit)},
              {"films", films_json(i.films)},
              {"dip_angles", json::parse(dip_angles_json(i.angles))},
              {"warnings", i.warnings}};
  if (!i.dips.empty()) all["dips"] = dips_json(i.dips);
  return json_text(all);
}

void write_angle_map(const std::filesystem::path& path, const Inspection& i,
                     const RunContext& context) {
  MapOptions options;
  options.width_px = i.config.preview_width_px;
  options.caption = map_caption(i.angles, nullptr);
  options.standing = standing_of(i.prepared.posed, way_up(i.config));
  const std::vector<std::uint8_t> png = encode_png(render_angle_map(
      i.prepared.posed.mesh(), i.prepared.posed.surface(), i.direction_at, options, context));
  write_file(path, png.data(), png.size());
}

// Says in a line if there was an earlier result.
std::string write_files(const Inspection& i, const std::string& report, const RunContext& context) {
  OutputFolder folder(i.config.output, i.config.earlier_result);
  folder.announce({"angles.png", "report.json"}, i.prepared.files);
  std::vector<std::string> others = prints();
  others.emplace_back("report.html");
  folder.supersede(others);
  write_angle_map(folder.path("angles.png"), i, context);
  write_file(folder.path("report.json"), report);
  context.check_cancelled();
  folder.commit();
  return folder.told_replaced();
}

}  // namespace

JobResult inspect_job(const JobConfig& given, const RunContext& context) {
  JobConfig config = given;
  const RunScope scope(context.with_threads(config.threads));
  PreparedObject prepared = prepare_object(config.model, config.object, context);
  if (asks_for_several_dips(config))
    context.warn(
        "This job is of several dips; size and dip angles are told of the object as [object] and "
        "[dip] hold it.");
  find_what_is_asked(config, prepared, context);
  const TriangleMesh& mesh = prepared.posed.mesh();
  const FilmOptions& film = config.design.film;
  const Trajectory trajectory = make_trajectory(config.design.trajectory, mesh.positions);
  const DippingDirection direction_at =
      dipping_direction(trajectory, mesh.positions, mesh.triangles);
  const Room room = room_of(mesh, trajectory);
  std::vector<ToldDip> dips = told_dips(config, prepared);
  std::vector<FilmChoice> films = film_choices(rooms_of(dips, room), film, config.bath);
  const Inspection inspection{config,
                              prepared,
                              room.depth_mm,
                              direction_at,
                              std::move(dips),
                              fits(prepared.posed.size_mm(), room, film, config.bath),
                              std::move(films),
                              dip_angles(mesh, direction_at),
                              context.warnings()};
  JobResult result;
  result.text = describe(inspection);
  result.json = machine_readable(inspection);
  context.check_cancelled();
  if (config.output.empty()) return result;
  result.text += write_files(inspection, result.json, context);
  result.folder = config.output;
  result.files = {"angles.png", "report.json"};
  result.text += fmt::format(
      "wrote to {}:\n  angles.png   the dip angles on the object\n  report.json  all of this for "
      "programs\n",
      config.output.string());
  return result;
}

}  // namespace hydrodip
