#include "calibrate/checkerboard_dip.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/parse_double.h"
#include "calibrate/board_lines.h"
#include "calibrate/printed_board.h"
#include "calibrate/rounded_pyramid.h"
#include "ink/stiffness.h"
#include "job/prepare.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

constexpr double kDeepest_mm = 5000;

// "sphere@12" into "sphere" and 12; 0: no depth given. A '@' in a file's name is left alone.
std::pair<std::string, double> split_depth(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) return {text, 0};
  double depth = 0;
  const char* begin = text.data() + at + 1;
  const char* end = text.data() + text.size();
  const auto [stop, error] = parse_double(begin, end, depth);
  if (error != std::errc() || stop != end) {
    if (find_shape(text.substr(0, at)) == nullptr) return {text, 0};
    throw InputError(
        fmt::format("{}: give the depth in mm after '@', as in {}@12.5, or leave the "
                    "'@' out",
                    text, text.substr(0, at)));
  }
  if (!(depth > 0 && depth < kDeepest_mm))
    throw InputError(
        fmt::format("{}: the depth after '@' must be above 0 and below {} mm", text, kDeepest_mm));
  return {text.substr(0, at), depth};
}

// A word alone means a shape. It is not read as a model's name, of which it would lack the end.
void require_known_word(const std::string& name) {
  std::error_code ignored;
  const std::filesystem::path file(name);
  const bool is_word = !file.has_parent_path() && !file.has_extension();
  if (!is_word || std::filesystem::exists(file, ignored)) return;
  std::vector<std::string> known;
  for (const KitShape& shape : known_shapes()) known.push_back(shape.name);
  throw InputError(fmt::format("{}: is neither a model file nor one of the shapes {}{}", name,
                               fmt::join(known, ", "), did_you_mean(name, known)));
}

}  // namespace

FilmParameters film_parameters(const DesignOptions& design) {
  return {design.dip.material.z_stretch, design.stiffness.ratio, design.dip.material.poisson};
}

const std::vector<KitShape>& kit_shapes() {
  static const std::vector<KitShape> shapes = {{"sphere-90", "sphere", 1.5, 17},
                                               {"pyramid-90", "pyramid", 1.5, 32, 6},
                                               {"ellipsoid-135", "ellipsoid", 1.5, 15.5}};
  return shapes;
}

const std::vector<KitShape>& sample_shapes() {
  static const std::vector<KitShape> shapes = {{"sphere", "sphere", 1, 12},
                                               {"pyramid", "pyramid", 1, 22},
                                               {"ellipsoid", "ellipsoid", 1, 11}};
  return shapes;
}

std::vector<KitShape> known_shapes() {
  std::vector<KitShape> all = kit_shapes();
  all.insert(all.end(), sample_shapes().begin(), sample_shapes().end());
  return all;
}

const KitShape* find_shape(const std::string& name) {
  for (const auto* shapes : {&kit_shapes(), &sample_shapes()})
    for (const KitShape& shape : *shapes)
      if (name == shape.name) return &shape;
  return nullptr;
}

TriangleMesh mesh_of(const KitShape& shape) {
  TriangleMesh mesh = make_sample(shape.sample);
  for (Vec3& p : mesh.positions) p *= shape.scale;
  if (shape.edge_radius_mm == 0) return mesh;
  const Vec3 size = mesh.bounds().size();
  return rounded_pyramid(size.x(), size.z(), shape.edge_radius_mm).closed();
}

void require_room_for_shape(const CalibrationObject& shape, const JobConfig& config) {
  constexpr double kRounding_mm = 0.01;
  const double size_mm = shape.object.bounds().size().maxCoeff();
  const Room room = room_of(shape.object, shape.depth_mm);
  for (const RoomFit& fit : fits(size_mm, room, config.design.film, config.bath))
    if (fit.excess_mm() > kRounding_mm)
      throw InputError(fmt::format(
          "{}: the shape is {:.1f} mm {} as it dips, {:.1f} more than {} has: take a larger "
          "--film, give the size of a larger bath (bath.width_mm, ...), or name smaller shapes, as "
          "sphere, pyramid and ellipsoid",
          shape.name, fit.needed_mm, fit.what, fit.excess_mm(), fit.room));
}

void require_no_correction_of_board(const JobConfig& config) {
  if (config.design.film.correction)
    throw InputError(
        "film.correction: a correction is of one job's print, and a calibration's board is printed "
        "without: leave it out");
}

CalibrationObject calibration_object(const std::string& text, const JobConfig& config,
                                     const RunContext& context) {
  const auto [name, depth] = split_depth(text);
  CalibrationObject result;
  result.name = name;
  double size_mm = 0;
  if (const KitShape* shape = find_shape(name)) {
    result.is_known_shape = true;
    result.object = mesh_of(*shape);
    size_mm = result.object.bounds().size().maxCoeff();
    result.depth_mm = depth > 0 ? depth : shape->depth_mm;
    require_room_for_shape(result, config);
  } else {
    require_known_word(name);
    const PosedObject posed = prepare_object(name, config.object, context).posed;
    result.object = posed.mesh();
    size_mm = posed.size_mm();
    result.name = std::filesystem::path(name).stem().string();
    TrajectoryOptions way = config.design.trajectory;
    if (depth > 0) way.depth_mm = depth;
    result.depth_mm = make_trajectory(way, result.object.positions).depth_mm();
  }
  require_fit(size_mm, room_of(result.object, result.depth_mm), config.design.film, config.bath,
              context);
  return result;
}

CheckeredFilm checkered_film(const DesignOptions& design, const Board& board, int halvings) {
  CheckeredFilm film;
  film.board = board;
  BoardGrid grid = board_grid(design.film, board, design.stiffness.filter_mm);
  grid.halvings = halvings;
  film.mesh = std::make_shared<const FilmMesh>(make_film_mesh(
      design.film, board_lines(design.film, board, design.stiffness.filter_mm, grid)));
  const PrintedBoard printed = print_board(design.film, board);
  // A ratio of 2 makes the modulus 1 more than the density.
  film.ink_density =
      film_modulus(*film.mesh, printed.inks, printed.raster, {2, design.stiffness.filter_mm});
  for (double& density : film.ink_density) density -= 1;
  return film;
}

GridLanding CheckerboardDip::landing(const CalibrationObject& object) const {
  return [this, &object](const GridPlace& place) -> std::optional<Vec3> {
    const auto point = map->to_object(board.on_film(place));
    if (!point) return std::nullopt;
    return position_at(object.object, *point);
  };
}

CheckerboardDip dip_checkerboard(const CheckeredFilm& film, const CalibrationObject& object,
                                 const Surface& surface, const FilmParameters& parameters,
                                 const DipOptions& options, const RunContext& context) {
  DipOptions dip_options = options;
  dip_options.material.z_stretch = parameters.z_stretch;
  dip_options.material.poisson = parameters.poisson;
  dip_options.material.tear_stretch = 0;
  if (options.method != DipMethod::kProjection) {
    dip_options.modulus = film.ink_density;
    for (double& value : dip_options.modulus) value = 1 + value * (parameters.stiffness_ratio - 1);
  }
  CheckerboardDip result;
  result.board = film.board;
  result.film = std::make_unique<DippedFilm>(
      dip(film.mesh, object.object.positions, object.object.triangles, surface,
          make_trajectory({object.depth_mm}, object.object.positions), dip_options, context)
          .film);
  result.map = std::make_unique<FilmMap>(object.object, surface, *result.film);
  return result;
}

}  // namespace hydrodip
