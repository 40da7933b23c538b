#include "job/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "base/file.h"
#include "base/run_scope.h"
#include "export/film_ply.h"
#include "export/preview_glb.h"
#include "export/scene.h"
#include "image/files.h"
#include "image/resize.h"
#include "job/logo.h"
#include "job/ways.h"
#include "object/bake.h"
#include "render/maps.h"
#include "render/preview.h"
#include "render/telling_views.h"
#include "report/findings.h"
#include "report/report.h"
#include "session/appearance_of.h"
#include "settings/dip_tables.h"
#include "settings/part_tables.h"

namespace hydrodip {
namespace {

// Large enough to look at closely, small enough for viewers on a phone.
constexpr int kPageTextureSide_px = 2048;

std::vector<std::uint8_t> write_picture(const std::filesystem::path& path, const Image& image) {
  std::vector<std::uint8_t> png = encode_png(image);
  write_file(path, png.data(), png.size());
  return png;
}

ReportColors colors_of(const FilmLayer& error) {
  const LayerSummary summary = summarize(error);
  return {summary.mean, summary.most_of};
}

// With what is known of colours.
Report full_report(const JobRecord& record, const Previews& previews) {
  Report report = make_report(record);
  report.colors = previews.colors;
  return report;
}

// The verdict in one line.
std::string picture_caption(const Report& report) {
  const Coverage& coverage = *report.coverage;
  if (!(coverage.film_on_object_mm2 > 0)) return short_verdict(report);
  return headline(concern_of(findings(report))) + ": " + short_verdict(report);
}

// Grey where a colour comes out as wanted, from yellow to dark red where it cannot.
LinearColor reach_color(float difference) {
  constexpr float kMost = 20;
  if (difference <= float(kVisible)) return {0.6F, 0.6F, 0.6F, 1};
  const float t = std::min(1.0F, difference / kMost);
  return {1 - 0.65F * t * t, 0.75F * (1 - t) * (1 - t), 0.05F * (1 - t), 1};
}

// What comes out, which the first pair shows, beside how far it is from what was wanted.
PreviewPair reach_pair(const JobRecord& record, const SheetRaster& raster) {
  PreviewPair pair;
  pair.left_is_firsts_right = true;
  pair.shown.predicted = [&](const SurfacePoint& point, const Vec3&, const Vec3&) {
    const auto u = record.dipped().map->to_film(point);
    if (!u) return record.paint().base();
    const Vec2 pixel = raster.to_pixel(*u);
    const int x = std::clamp(int(pixel.x()), 0, raster.width_px() - 1);
    const int y = std::clamp(int(pixel.y()), 0, raster.height_px() - 1);
    return reach_color(
        record.ink->reach
            .out_of_reach[std::size_t(y) * std::size_t(raster.width_px()) + std::size_t(x)]);
  };
  pair.titles = {"predicted", "out of reach: yellow, red"};
  pair.caption = fmt::format(
      "{:.1f} % of the covered surface cannot have its colour; there it is off by {:.1f} "
      "(CIEDE2000)",
      100 * record.ink->reach.out_of_reach_share(), record.ink->reach.mean_beyond);
  return pair;
}

// Film whose place is known to half of what is promised shows as it is, or ink would look paler
// than it will be; from there to where nothing is printed it fades.
double fading_mm(double moved_mm) { return std::max(0.0, 4 * moved_mm - 2 * kMoved_mm); }

// What is predicted, where what is doubtful fades from where film surely holds to where nothing is
// printed.
Appearance fading(const Appearance& shown, const JobRecord& record) {
  const FilmMaterial& material = record.config.design.dip.material;
  const DoubtfulStretch doubtful{doubtful_stretch(material).from, material.tear_stretch};
  if (!(material.tear_stretch > doubtful.from)) return shown;
  Appearance result = shown;
  result.predicted = [&finish = record.finish, doubtful, map = record.dipped().map,
                      base = record.paint().base()](const SurfacePoint& point, const Vec3&,
                                                    const Vec3&) {
    const FilmMap::Lying lying = map->lying_at(point);
    const LinearColor color = finish.color_with_film(point, lying.film);
    if (!lying.hold || !lying.hold->whole) return color;
    const auto left = float(1 - doubtful.of(lying.hold->stretch, fading_mm(lying.hold->moved_mm)));
    return LinearColor{base.r + left * (color.r - base.r), base.g + left * (color.g - base.g),
                       base.b + left * (color.b - base.b), 1};
  };
  return result;
}

// preview.png, whose bytes are returned, and gamut.png (empty: none), which shows the same views.
std::vector<std::uint8_t> write_pairs(const std::filesystem::path& preview_png,
                                      const std::filesystem::path& gamut_png,
                                      const TellingViews& views, const JobRecord& record,
                                      const Appearance& shown, const SheetRaster& raster,
                                      const std::string& caption) {
  std::vector<PreviewPair> pairs(1);
  pairs[0].shown = fading(shown, record);
  pairs[0].caption = caption;
  if (!gamut_png.empty()) pairs.push_back(reach_pair(record, raster));
  const std::vector<Image> pictures =
      render_previews(views, pairs, record.paint().base(), record.context);
  if (!gamut_png.empty()) write_picture(gamut_png, pictures[1]);
  return write_picture(preview_png, pictures[0]);
}

Image draw_maps(const TellingViews& views, const JobRecord& record) {
  const DippedObject& dipped = record.dipped();
  MapOptions options;
  options.tear_stretch = record.config.design.dip.material.tear_stretch;
  options.doubtful = doubtful_stretch(record.config.design.dip.material);
  options.caption = map_caption(dipped.angles, &dipped.coverage);
  options.direction_at = dipped.direction_at;
  if (!dipped.air->pockets.empty())
    options.in_air = [&](int triangle, const Vec3& position) {
      return dipped.air->holds(triangle, position);
    };
  return render_maps(views, dipped.posed.mesh(), *dipped.film, *dipped.map, options,
                     record.context);
}

// Quantities over the film, and what is learnt from them. Every verdict needs that, so it comes
// before any picture.
std::vector<FilmLayer> measure_layers(const JobRecord& record, const Appearance& shown,
                                      Previews& previews) {
  const DippedObject& dipped = record.dipped();
  std::vector<FilmLayer> layers;
  if (record.paint().says_anything()) {
    layers.push_back(color_error_layer(dipped.posed.mesh(), *dipped.map, shown, record.context));
    previews.colors = colors_of(layers.back());
  }
  if (record.ink != nullptr) layers.push_back({record.ink->reach.difference, "out_of_gamut"});
  if (dipped.coverage.wrinkled_mm2 > 0)
    layers.push_back(pressed_layer(*dipped.film, dipped.map->covered()));
  return layers;
}

// What the 3D view shows.
std::string make_scene(const JobRecord& record, const Object& looks, const TellingViews& views,
                       const std::vector<FilmLayer>& layers, const Image& sheet,
                       const SheetRaster& raster) {
  const DippedObject& dipped = record.dipped();
  SceneSource scene{looks, *dipped.film, *dipped.history, sheet};
  scene.sheet_width_mm = raster.width_mm;
  scene.sheet_height_mm = raster.height_mm;
  scene.bath_width_mm = record.config.bath.width_mm;
  scene.bath_height_mm = record.config.bath.height_mm;
  scene.tear_stretch = record.config.design.dip.material.tear_stretch;
  scene.base = record.paint().base();
  scene.standing = views.standing();
  scene.first_look = views.camera(0).back;
  scene.layers = layers;
  return scene_json(scene, record.context);
}

void write_glb(const std::filesystem::path& path, const JobRecord& record, const Object& looks,
               const Image& sheet, const SheetRaster& raster) {
  const DippedObject& dipped = record.dipped();
  write_preview_glb(path, looks, dipped.posed.surface(), *dipped.film, sheet, raster.width_mm,
                    raster.height_mm, record.paint().base(), record.config.preview_texture_px);
}

// That some jobs have and others, as drafts, have not.
std::vector<std::string> pictures_of_jobs() {
  return {"preview.png", "maps.png", "gamut.png", "dips.png"};
}

}  // namespace

ReportInk ink_amounts(const InkImage& inks, double limit) {
  ReportInk amounts;
  amounts.density_limit = limit;
  int most = 0;  // whole numbers, so that a sheet at the limit is not over it by rounding
  std::array<std::uint64_t, 4> sum{};
  CheckEvery check(1 << 16);
  for (std::size_t i = 0; i < inks.cmyk.size(); i += 4) {
    check();
    const std::uint8_t* laid = inks.cmyk.data() + i;
    if (is_blank(laid)) continue;
    most = std::max(most, laid[0] + laid[1] + laid[2] + laid[3]);
    for (std::size_t k = 0; k < 4; ++k) sum[k] += laid[k];
  }
  amounts.density_max = most / 255.0;
  const double full = 255.0 * std::max(1.0, 0.25 * double(inks.cmyk.size()));
  for (std::size_t k = 0; k < 4; ++k) amounts.mean[k] = double(sum[k]) / full;
  return amounts;
}

Previews write_previews(OutputFolder& folder, const JobRecord& record,
                        const std::string& caption_start) {
  const DippedObject& dipped = record.dipped();
  const Image& film_image = *record.finish.coats().front().look;
  const SheetRaster& raster = record.finish.coats().front().raster;
  Previews previews;
  std::vector<std::function<void()>> tasks;
  const auto add = [&](const std::string& name, const auto& write) {
    tasks.emplace_back([path = folder.path(name), write] { write(path); });
  };
  const int looks_px = record.config.pictures
                           ? std::max(record.config.preview_texture_px, kPageTextureSide_px)
                           : record.config.preview_texture_px;
  const Object looks = painted_object(dipped.posed.mesh(), record.paint(),
                                      {.most_px = looks_px, .finest = kFinestTexels_per_mm});
  const Appearance shown = appearance_of(record.finish);
  std::vector<FilmLayer> layers;
  // Once for all who want as many pixels.
  const Image glb_sheet = shrink_to(film_image, 2 * record.config.preview_texture_px);
  std::optional<TellingViews> views;
  // The longest first.
  if (record.config.pictures) {
    layers = measure_layers(record, shown, previews);
    const TriangleMesh& mesh = dipped.posed.mesh();
    const Surface& surface = dipped.posed.surface();
    const Standing standing = standing_of(dipped.posed, way_up(record.config));
    views.emplace(mesh, surface, telling_directions(mesh, surface, *dipped.film, standing),
                  record.config.preview_width_px, standing, record.context);
    tasks.emplace_back([&] {
      const bool is_enough = 2 * record.config.preview_texture_px >= kPageTextureSide_px;
      previews.pictures.scene =
          make_scene(record, looks, *views, layers,
                     shrink_to(is_enough ? glb_sheet : film_image, kPageTextureSide_px), raster);
    });
    add("maps.png", [&](const auto& path) {
      previews.pictures.maps_png = write_picture(path, draw_maps(*views, record));
    });
    const std::filesystem::path preview_png = folder.path("preview.png");
    const std::filesystem::path gamut_png =
        record.ink != nullptr ? folder.path("gamut.png") : std::filesystem::path();
    const std::string caption = caption_start + picture_caption(full_report(record, previews));
    tasks.emplace(tasks.begin(), [&, preview_png, gamut_png, caption] {
      previews.pictures.preview_png =
          write_pairs(preview_png, gamut_png, *views, record, shown, raster, caption);
    });
  }
  add("preview.glb", [&](const auto& path) { write_glb(path, record, looks, glb_sheet, raster); });
  add("film.ply", [&](const auto& path) { write_film_ply(path, *dipped.film); });
  record.context.side_by_side("drawing the previews", tasks);
  return previews;
}

JobResult finish_job(OutputFolder& folder, const JobRecord& record, const Previews& previews) {
  const Report report = full_report(record, previews);
  write_report_json(folder.path("report.json"), report);
  ReportPictures pictures = previews.pictures;
  pictures.logo_png = logo_png(record.config.report.logo);
  write_report_html(folder.path("report.html"), report, pictures);
  record.context.check_cancelled();
  folder.commit();
  JobResult result = describe_result(report, folder.folder(), told_places(record.prepared.artwork));
  result.text = folder.told_replaced() + result.text;
  return result;
}

std::vector<std::string> files_of_dip() {
  return {"print.pdf", "print.png", "print.tif", "film.ply", "preview.glb", "report.json"};
}

std::vector<std::string> files_of_jig() {
  return {"mount.stl",   "bar.stl",     "frame.stl",   "frame-1.stl",
          "frame-2.stl", "frame-3.stl", "frame-4.stl", "jig.png"};
}

std::vector<std::string> prints() {
  std::vector<std::string> names = sheets_of_other_prints(0);
  for (const std::string& name : sheets_of_other_prints(1)) names.push_back(name);
  return names;
}

std::vector<std::string> sheets_of_other_prints(std::size_t dips) {
  std::vector<std::string> names;
  const auto add_jig = [&](const std::string& folder) {
    for (const std::string& name : files_of_jig())
      names.push_back(fmt::format("{}jig/{}", folder, name));
  };
  // The jig first, so that its folder is gone when that of the dip is to go.
  const auto add = [&](const std::string& folder) {
    add_jig(folder);
    for (const std::string& name : files_of_dip())
      if (!folder.empty() || name != "report.json") names.push_back(folder + name);
    names.push_back(folder + "run-sheet.pdf");
  };
  if (dips > 0) {
    add("");  // whose report is replaced
  } else {
    add_jig("");
    names.emplace_back("run-sheet.pdf");
  }
  for (std::size_t k = 0; k < dips; ++k) add_jig(fmt::format("dip-{}/", k + 1));
  for (const std::string& picture : pictures_of_jobs()) names.push_back(picture);
  for (const char* of_others : {"nest.json", "nest.html", "angles.png"})
    names.emplace_back(of_others);
  for (std::size_t part = 1; part <= kMostParts; ++part)
    names.push_back(fmt::format("part-{}.png", part));
  for (std::size_t k = dips; k < kMostDips; ++k) add(fmt::format("dip-{}/", k + 1));
  return names;
}

}  // namespace hydrodip
