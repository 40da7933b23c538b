#include "job/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/memory.h"
#include "base/run_scope.h"

namespace hydrodip {
namespace {

// Film lies where it should within a few thousandths of a millimetre.
constexpr double kRounded_mm = 0.003;

// What the film image is wanted to be, how film stretches, its inks, how they look, how far all of
// that is off, and what is written of it: at most, as half of it takes the place of the other half.
// Pictures that compress well take 12.
constexpr double kBytesPerPixel = 24;
// How long film's rim is over the side of a square as large: ragged film of several pieces.
constexpr double kRimOverSide = 16;

// Below that a model whose unit nobody told may well be one in inches.
constexpr double kMaybeInches_mm = 15;

void warn_if_tiny(const TriangleMesh& mesh, bool size_is_told, const RunContext& context) {
  const double largest_mm = mesh.bounds().size().maxCoeff();
  const bool tiny = largest_mm < kTiny_mm;
  if (!tiny && (size_is_told || !(largest_mm < kMaybeInches_mm))) return;
  std::string length = fmt::format("{:.2f}", largest_mm);
  length.erase(length.find_last_not_of('0') + 1);
  if (length.back() == '.') length.pop_back();
  context.warn(fmt::format("The object's largest extent is {} mm: {}.", length,
                           tiny ? "if that is not meant, say its --units or --size"
                                : fmt::format("if it is in inches, it is {:.0f} mm with --units in",
                                              largest_mm * kMmPerInch)));
}

// Files of models keep seven digits of a coordinate, or are read so.
void warn_if_far(const TriangleMesh& mesh, double scale, const RunContext& context) {
  const Box3 box = mesh.bounds();
  if (box.empty()) return;
  const double far_mm = scale * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  const double rounded_mm = far_mm * std::numeric_limits<float>::epsilon();
  if (!(rounded_mm > kRounded_mm)) return;
  context.warn(fmt::format(
      "The model lies up to {:.0f} mm from its file's origin, so far that its coordinates are "
      "rounded to {} mm: move it to the origin where it was made, and save it anew.",
      far_mm,
      rounded_mm < 1 ? fmt::format("{:.1g}", rounded_mm) : fmt::format("{:.0f}", rounded_mm)));
}

void require_room(const DesignOptions& options, double inked_mm2, double limit_bytes) {
  const double needed = sheet_memory_bytes(options, inked_mm2);
  if (needed <= limit_bytes) return;
  const double px_per_mm = options.dpi / kMmPerInch;
  throw InputError(fmt::format(
      "the sheet of {:.0f} x {:.0f} px may need about {:.1f} GB of memory, but there are {:.1f} "
      "GB; lower --dpi to {:.0f} or less",
      options.film.width_mm * px_per_mm, options.film.height_mm * px_per_mm, needed / 1e9,
      limit_bytes / 1e9, std::floor(options.dpi * std::sqrt(limit_bytes / needed))));
}

}  // namespace

PreparedObject prepare_object(const std::filesystem::path& model, const ObjectOptions& options,
                              const RunContext& context, double dpi, int samples_per_axis) {
  const RunScope scope(context);
  context.progress("loading", 0);
  std::vector<PictureSource> pictures = read_pictures(options.artwork);
  LoadedObject loaded = options.given ? *options.given : load_object(model, options.load, context);
  for (const std::string& finding : loaded.health.findings()) context.warn(finding);
  const auto object = std::make_shared<const Object>(std::move(loaded.object));
  PreparedObject result{.posed = PosedObject(object, options.pose),
                        .paint = model_paint(object, options.base),
                        .health = loaded.health,
                        .units = loaded.units,
                        .files = loaded.files,
                        .artwork = {},
                        .picture_problems = loaded.picture_problems};
  // Area and volume grow with the object.
  const double scale = result.posed.scale();
  result.health.area_mm2 *= scale * scale;
  result.health.volume_mm3 *= scale * scale * scale;
  warn_if_tiny(result.posed.mesh(), loaded.units_are_told || options.pose.size_mm > 0, context);
  warn_if_far(*object, scale, context);
  context.progress("loading", 1);
  if (options.artwork.empty()) return result;
  Artwork artwork = lay_artwork({options.artwork, std::move(pictures), result.paint,
                                 result.health.closed(), dpi, samples_per_axis},
                                result.posed, context);
  result.paint = std::move(artwork.paint);
  result.artwork = std::move(artwork.layers);
  const auto add_file = [&](const std::filesystem::path& file) {
    if (!file.empty() &&
        std::find(result.files.begin(), result.files.end(), file) == result.files.end())
      result.files.push_back(file);
  };
  for (const ArtworkLayer& layer : options.artwork) add_file(layer.image);
  for (const LaidLayer& layer : result.artwork)
    for (const FontUse& font : layer.fonts) add_file(font.file);
  return result;
}

void hold(ObjectOptions& options, const PreparedObject& prepared, const PoseOptions& pose) {
  options.pose = pose;
  for (std::size_t n = 0; n < prepared.artwork.size(); ++n)
    options.artwork[n] = prepared.artwork[n].layer;
}

void require_size(const PosedObject& posed, const ObjectOptions& options,
                  const std::filesystem::path& model) {
  if (options.pose.size_mm > 0 || !options.load.units.empty()) return;
  const double largest_mm = posed.mesh().bounds().size().maxCoeff();
  if (largest_mm >= kTiny_mm && largest_mm <= kHuge_mm) return;
  throw InputError(fmt::format(
      "{}: is it really {:.4g} mm large? Say its --units (mm, cm, m or in), or the --size that its "
      "largest extent shall have in mm",
      model.string(), largest_mm));
}

void require_on_film(const PreparedObject& prepared, const FilmOptions& film) {
  for (const LaidLayer& laid : prepared.artwork) {
    const ArtworkLayer& layer = laid.layer;
    if (layer.projection != Projection::kFilm || layer.repeat != Repeat::kOnce || !layer.at_mm)
      continue;
    const double reach = 0.5 * laid.size_mm.norm();
    if (std::abs(layer.at_mm->x()) - reach < 0.5 * film.width_mm &&
        std::abs(layer.at_mm->y()) - reach < 0.5 * film.height_mm)
      continue;
    throw InputError(fmt::format(
        "{}: the artwork lies beside the sheet, which reaches {:g} x {:g} mm from its middle; move "
        "it with --art-at",
        name_of(layer), 0.5 * film.width_mm, 0.5 * film.height_mm));
  }
}

double inkable_mm2(const PreparedObject& prepared, const DesignOptions& options) {
  const double sheet_mm2 = options.film.width_mm * options.film.height_mm;
  if (prepared.paint->depends_on_film()) return sheet_mm2;
  const double object_mm2 = prepared.health.area_mm2;
  const double rim_mm = kRimOverSide * std::sqrt(object_mm2);
  return std::min(sheet_mm2, object_mm2 + rim_mm * options.inverse.bleed_mm);
}

double sheet_memory_bytes(const DesignOptions& options, double inked_mm2) {
  const double px_per_mm = options.dpi / kMmPerInch;
  return kBytesPerPixel * inked_mm2 * px_per_mm * px_per_mm;
}

void warn_if_draft(const DesignOptions& options, const RunContext& context) {
  if (is_draft(options))
    context.warn(
        "This is a draft, of coarse film in long steps and as if ink did not stiffen it: before "
        "you dip, print it without --quality draft.");
}

void require_memory(const DesignOptions& options, double inked_mm2) {
  const double sheet_mm2 = options.film.width_mm * options.film.height_mm;
  require_room(options, sheet_mm2, address_limit_bytes());
  require_room(options, inked_mm2, memory_limit_bytes());
}

void require_appearance(const Object& object, const std::vector<std::string>& picture_problems,
                        const std::filesystem::path& model) {
  // A model of one colour whose picture is missing would print as a plain sheet.
  if (!picture_problems.empty() && object.one_color())
    throw InputError(fmt::format("{}: {}", model.string(), picture_problems.front()));
  if (object.has_appearance()) return;
  if (!object.uvs.empty())
    throw InputError(fmt::format(
        "{}: the model has texture coordinates but no texture: name the image with --texture",
        model.string()));
  throw InputError(fmt::format(
      "{}: the model has neither texture coordinates (UVs) nor colours, so there is nothing "
      "to print: put a picture on it with --art IMG, or paint vertex colours and save it as PLY",
      model.string()));
}

void require_appearance(const PreparedObject& prepared, const std::filesystem::path& model) {
  if (prepared.artwork.empty())
    require_appearance(prepared.posed.object(), prepared.picture_problems, model);
}

}  // namespace hydrodip
