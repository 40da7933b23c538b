#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "artwork/artwork.h"
#include "artwork/projector.h"
#include "artwork/tile_place.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/run_scope.h"
#include "coat/flat_film.h"
#include "hydrodip/hydrodip.h"
#include "job/jobs.h"
#include "job/prepare.h"
#include "job/print_dips.h"
#include "job/ways.h"

namespace hydrodip {
namespace {

// Every twelfth of a turn.
constexpr double kTurn_deg = 30;
// Of what lies on the object anyway, and how much more a spot counts.
constexpr double kAnywhere = 0.2, kSpot = 20;
// Of a pattern that is drawn anew, in pixels of the print; and in all.
constexpr double kFiner = 2, kMostPixels = 64e6;

ArtworkLayer tile_layer(const PatternRequest& request) {
  ArtworkLayer layer;
  layer.image = request.tile;
  layer.projection = Projection::kFilm;
  layer.repeat = Repeat::kTile;
  layer.width_mm = request.tile_mm;
  return layer;
}

// Even stiffness, coarse film: where the film goes does not depend on the pattern, nearly.
DippedObject trial_dip(const JobConfig& config, const PreparedObject& prepared, bool fine,
                       const RunContext& context) {
  const DesignOptions options = fine ? config.design : draft_of(config.design);
  return simulate(prepared.posed, {options.film, options.trajectory, options.dip, options.air},
                  context);
}

std::vector<Vec3> posed_spots(const PatternRequest& request, const PosedObject& posed) {
  const ModelFrame frame(posed);
  const double size = posed.mesh().bounds().size().norm();
  std::vector<Vec3> spots;
  for (const PatternRequest::Spot& spot : request.spots) {
    if (!(spot.radius_mm > 0))
      throw InputError(fmt::format("--keep {}: the radius must be above 0, not {:g} mm",
                                   as_given(spot.at_mm), spot.radius_mm));
    spots.push_back(frame.point(spot.at_mm));
    const auto hit = posed.surface().closest_point(spots.back(), 100 * size);
    if (hit && hit->t <= spot.radius_mm) continue;
    throw InputError(fmt::format(
        "--keep {}: the spot is away from the model, whose surface is nearest at {} (mm, in the "
        "model's frame after --size)",
        as_given(spot.at_mm),
        hit ? as_given(frame.back(posed.surface().position(*hit))) : "no place"));
  }
  return spots;
}

// Film on the object, by how much a pattern's detail would show its stretch.
std::vector<FilmPiece> pieces_of(const DippedObject& dipped, const PatternRequest& request) {
  const std::vector<Vec3> spots = posed_spots(request, dipped.posed);
  const DippedFilm& film = *dipped.film;
  std::vector<FilmPiece> pieces;
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    Vec2 u = Vec2::Zero();
    Vec3 at = Vec3::Zero();
    double stretch = 0;
    std::array<Vec3, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = std::size_t(film.mesh().triangles[t][k]);
      corner[k] = film.position[v];
      u += film.mesh().u[v] / 3;
      at += corner[k] / 3;
      stretch += film.stretch[v] / 3;
    }
    const double area = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
    double weight = area * (kAnywhere + std::clamp(stretch - 1, 0.0, 2.0));
    for (std::size_t s = 0; s < spots.size(); ++s)
      if ((at - spots[s]).norm() < request.spots[s].radius_mm) weight += kSpot * area;
    pieces.push_back({u, weight});
  }
  return pieces;
}

std::vector<double> turns_of(const PatternRequest& request) {
  if (request.turn_deg) return {*request.turn_deg};
  std::vector<double> turns;
  for (double turn = 0; turn < 360; turn += kTurn_deg) turns.push_back(turn);
  return turns;
}

TilePlace place_of(const PatternRequest& request, const Image& tile, const Vec2& size_mm,
                   const std::vector<FilmPiece>& pieces) {
  if (request.shift_mm) return {*request.shift_mm, request.turn_deg.value_or(0), 1};
  return best_tile_place(tile, size_mm, pieces, turns_of(request));
}

// The pattern over the whole film, drawn so that it comes out flat.
std::shared_ptr<const Image> drawn_flat(const FlatFilm& flat, const Image& tile,
                                        const Vec2& tile_mm, const TilePlace& place,
                                        const DesignOptions& design) {
  SheetRaster raster = raster_of(design.film, kFiner * design.dpi);
  const double pixels = double(raster.width_px()) * raster.height_px();
  if (pixels > kMostPixels) raster.dpi *= std::sqrt(kMostPixels / pixels);
  auto image = std::make_shared<Image>(raster.width_px(), raster.height_px());
  const PictureFrame frame(tile_mm, place.turn_deg, Repeat::kTile);
  parallel_for(std::size_t(image->height_px), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < image->width_px; ++x) {
        const Vec2 u = flat.at(raster.to_film(x + 0.5, double(y) + 0.5));
        const LinearColor c = sample(tile, frame, u - place.shift_mm);
        std::uint8_t* pixel = image->pixel(x, int(y));
        const float part = c.a > 0 ? 1 / c.a : 0;
        pixel[0] = linear_to_srgb8(part * c.r);
        pixel[1] = linear_to_srgb8(part * c.g);
        pixel[2] = linear_to_srgb8(part * c.b);
        pixel[3] = std::uint8_t(std::lround(255 * std::min(c.a, 1.0F)));
      }
  });
  return image;
}

std::string describe(const TilePlace& place, const PatternRequest& request) {
  std::string text = fmt::format(
      "pattern at {:.1f},{:.1f} mm from the film's centre, turned {:g} "
      "degrees",
      place.shift_mm.x(), place.shift_mm.y(), place.turn_deg);
  if (request.shift_mm) return text + "\n";
  return text + fmt::format(
                    ": {:.0f} % of the trouble that it has on average\n  to keep it: --tile-at "
                    "{:.2f},{:.2f} --tile-turn {:g}\n",
                    100 * place.trouble, place.shift_mm.x(), place.shift_mm.y(), place.turn_deg);
}

}  // namespace

JobResult pattern_job(const JobConfig& given, const PatternRequest& request,
                      const RunContext& context) {
  require_one_dip(given, "a tile is placed for one dip; make a job of each dip by itself");
  const RunScope scope(context.with_threads(given.threads));
  JobConfig config = given;
  ArtworkLayer layer = tile_layer(request);
  PictureSource source(layer);
  const Vec2 tile_mm(request.tile_mm, request.tile_mm / source.aspect());
  const double pixels_per_mm =
      config.design.dpi / kMmPerInch * config.design.inverse.samples_per_axis;
  const auto tile = source.image(tile_mm, pixels_per_mm);

  RunContext quiet = context.quiet();
  ObjectOptions bare = config.object;
  bare.artwork.clear();
  PreparedObject prepared = prepare_object(config.model, bare, quiet);
  find_what_is_asked(config, prepared, context);
  const TriangleMesh& mesh = prepared.posed.mesh();
  const Trajectory trajectory = make_trajectory(config.design.trajectory, mesh.positions);
  require_fit(prepared.posed.size_mm(), room_of(mesh, trajectory), config.design.film, config.bath,
              quiet);
  const DippedObject dipped = trial_dip(config, prepared, request.compensate, context);
  const TilePlace place = place_of(request, *tile, tile_mm, pieces_of(dipped, request));

  std::string text = describe(place, request);
  layer.at_mm = Vec3(place.shift_mm.x(), place.shift_mm.y(), 0);
  layer.turn_deg = place.turn_deg;
  if (request.compensate) {
    const FlatFilm flat(*dipped.film);
    layer.picture = drawn_flat(flat, *tile, tile_mm, place, config.design);
    layer.repeat = Repeat::kOnce;
    layer.at_mm = Vec3(Vec3::Zero());
    layer.turn_deg = 0;
    layer.width_mm = config.design.film.width_mm;
    layer.height_mm = config.design.film.height_mm;
    text += fmt::format(
        "on the part the pattern's lengths are {:.1f} % off on average, {:.1f} % without "
        "--compensate\n",
        100 * flat.distortion(), 100 * flat.distortion_as_printed());
  }
  if (!is_seamless(*tile))
    context.warn(fmt::format(
        "{}: the tile's edges do not go on in each other, so that its seams will show; make it "
        "seamless, or larger than the film",
        request.tile.string()));
  config.object.artwork.insert(config.object.artwork.begin(), layer);
  JobResult result = print_job(config, context, "pattern");
  result.text = text + result.text;
  return result;
}

}  // namespace hydrodip
