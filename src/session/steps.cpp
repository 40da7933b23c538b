// The steps of the public library, each in terms of the rooms that do the work.
#include <utility>

#include "artwork/artwork.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "coat/film_paint.h"
#include "export/film_ply.h"
#include "hydrodip/hydrodip.h"
#include "image/files.h"
#include "render/preview.h"
#include "samples/samples.h"
#include "session/appearance_of.h"
#include "session/coat_of.h"
#include "session/sheet_files.h"

namespace hydrodip {
namespace {

void require_sound(const Object& object) {
  const auto refuse = [](const std::string& what) { throw InputError("the mesh " + what); };
  const std::size_t triangles = object.triangles.size();
  const auto vertices = std::int32_t(object.positions.size());
  if (triangles == 0) refuse("has no triangles");
  for (const Vec3& p : object.positions)
    if (!p.allFinite()) refuse("has a vertex that is not finite");
  for (const Triangle& t : object.triangles)
    for (const std::int32_t v : t)
      if (v < 0 || v >= vertices) refuse("has a triangle whose vertex does not exist");
  if (object.material_of.size() != triangles) refuse("needs a material number per triangle");
  for (const int m : object.material_of)
    if (m < 0 || std::size_t(m) >= object.materials.size())
      refuse("has a triangle whose material does not exist");
  if (!object.uvs.empty() && object.uvs.size() != triangles)
    refuse("needs texture coordinates for every triangle or none");
  for (const CornerUv& corners : object.uvs)
    for (const Eigen::Vector2f& uv : corners)
      if (!uv.allFinite()) refuse("has a texture coordinate that is not finite");
  if (!object.colors.empty() && object.colors.size() != triangles)
    refuse("needs colours for every triangle or none");
  for (const Material& m : object.materials)
    if (m.texture >= int(object.textures.size())) refuse("has a material without its texture");
}

}  // namespace

Model load(const std::filesystem::path& file, const LoadOptions& options,
           const RunContext& context) {
  const RunScope scope(context);
  LoadedObject loaded = load_object(file, options, context);
  return {std::make_shared<const Object>(std::move(loaded.object)), loaded.health,
          std::move(loaded.units), std::move(loaded.files)};
}

Model model_from(Object object) {
  if (object.materials.empty()) object.materials.resize(1);
  if (object.material_of.empty()) object.material_of.assign(object.triangles.size(), 0);
  require_sound(object);
  const MeshHealth health = check_and_repair(object);
  return {std::make_shared<const Object>(std::move(object)), health, "mm", {}};
}

Model sample(const std::string& name) { return model_from(make_sample(name)); }

std::shared_ptr<const Paint> paint_of(const Model& model, const LinearColor& base) {
  return model_paint(model.object, base);
}

std::shared_ptr<const Paint> paint_with(const Model& model, const PosedObject& posed,
                                        const std::vector<ArtworkLayer>& layers,
                                        const LinearColor& base, double dpi, int samples_per_axis,
                                        const RunContext& context) {
  std::shared_ptr<const Paint> own = paint_of(model, base);
  if (layers.empty()) return own;
  const RunScope scope(context);
  return lay_artwork({layers, read_pictures(layers), std::move(own), model.health.closed(), dpi,
                      samples_per_axis},
                     posed, context)
      .paint;
}

PosedObject pose(const Model& model, const PoseOptions& options) {
  return PosedObject(model.object, options);
}

DippedObject simulate(const PosedObject& posed, const SimulationOptions& options,
                      const RunContext& context, const DipObserver& observe) {
  const RunScope scope(context);
  Timings timings;
  return dip_object(posed, std::make_shared<const FilmMesh>(make_film_mesh(options.film)),
                    make_trajectory(options.trajectory, posed.mesh().positions), options.dip,
                    timings, context, observe, {.options = options.air, .found = {}});
}

Designed design(const PosedObject& posed, const Paint& paint, const DesignOptions& options,
                const Printer& printer, const RunContext& context, const Allotment& allotment) {
  const RunScope scope(context);
  Timings timings;
  return design({posed, paint, allotment, *printer.model, options}, timings, context);
}

Coat coat_of(const Designed& made, bool is_first, const ColorModel& model) {
  const FilmInk& ink = made.ink.ink;
  auto look = std::make_shared<const Image>(
      is_first ? ink.on_object
               : look_on_object(ink.inking.inks, ink.stretch.area_ratio, model, {1, 1, 1, 1}));
  return {made.dipped, made.raster, std::move(look)};
}

Finish finish(std::shared_ptr<const Paint> paint, const std::vector<Designed>& designs,
              const Printer& printer) {
  std::vector<Coat> coats;
  coats.reserve(designs.size());
  for (const Designed& made : designs)
    coats.push_back(coat_of(made, coats.empty(), *printer.model));
  if (!coats.empty()) paint = paint_as_dipped(std::move(paint), coats.front().dipped);
  return Finish(std::move(paint), std::move(coats));
}

Image render(const Finish& finish, int width_px, const RunContext& context) {
  if (finish.coats().empty()) throw InputError("a finish without coats has nothing to show");
  const RunScope scope(context);
  const DippedObject& dipped = finish.coats().front().dipped;
  PreviewOptions options;
  options.width_px = width_px;
  options.base = finish.paint().base();
  std::vector<PreviewPair> pairs(1);
  pairs[0].shown = appearance_of(finish);
  return render_previews(dipped.posed.mesh(), dipped.posed.surface(), *dipped.film, pairs, options,
                         context)
      .front();
}

void write_sheet(const std::filesystem::path& folder, const Designed& designed,
                 const Printer& printer, const SheetOptions& options, const RunContext& context) {
  const RunScope scope(context);
  OutputFolder output(folder);
  const Inking& laid = designed.ink.ink.inking;
  write_sheet_files(output, laid.inks, laid.printed, printer, options, context);
  context.check_cancelled();
  output.commit();
}

void write_png(const std::filesystem::path& file, const Image& image) {
  const std::vector<std::uint8_t> png = encode_png(image);
  write_whole(file, png.data(), png.size());
}

void write_film(const std::filesystem::path& file, const DippedFilm& film) {
  const std::vector<std::uint8_t> ply = film_ply(film);
  write_whole(file, ply.data(), ply.size());
}

}  // namespace hydrodip
