#include "export/film_layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "dip/principal_stretch.h"
#include "film/locate.h"
#include "image/color_difference.h"

namespace hydrodip {
namespace {

constexpr std::array<double, 2> kSamples = {0.25, 0.75};  // per cell and axis

FilmLayer empty_layer(const std::string& key, const Box2& extent) {
  return {empty_cells(extent), key};
}

double least_stretch(const DippedFilm& film, std::size_t triangle) {
  const auto& v = film.mesh().triangles[triangle];
  std::array<Vec2, 3> flat;
  std::array<Vec3, 3> placed;
  for (std::size_t k = 0; k < 3; ++k) {
    flat[k] = film.mesh().u[std::size_t(v[k])];
    placed[k] = film.position[std::size_t(v[k])];
  }
  return principal_stretches(flat, placed).least;
}

struct Mean {
  Vec3 sum = Vec3::Zero();
  void add(const LinearColor& c) { sum += Vec3(double(c.r), double(c.g), double(c.b)); }
  LinearColor over(int count) const {
    return {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count), 1};
  }
};

class ColorError {
 public:
  ColorError(const TriangleMesh& object, const FilmMap& map, const Appearance& appearance)
      : object_(object), map_(map), appearance_(appearance) {}

  void fill_row(FilmLayer& layer, int row) const {
    FilmMap::Cursor cursor;
    CheckEvery check(64);
    for (int x = 0; x < layer.width; ++x) {
      check();
      layer.values[std::size_t(row) * std::size_t(layer.width) + std::size_t(x)] =
          at(layer, x, row, cursor);
    }
  }

 private:
  float at(const FilmLayer& layer, int x, int row, FilmMap::Cursor& cursor) const {
    Mean wanted, predicted;
    int count = 0;
    for (const double dy : kSamples) {
      for (const double dx : kSamples) {
        const Vec2 size = layer.extent.max - layer.extent.min;
        const Vec2 u(layer.extent.min.x() + size.x() * (x + dx) / layer.width,
                     layer.extent.max.y() - size.y() * (row + dy) / layer.height);
        const auto point = map_.to_object(u, cursor);
        if (!point) continue;
        const Vec3 position = position_at(object_, *point);
        const Vec3 normal = face_normal(object_, point->triangle);
        wanted.add(appearance_.wanted(*point, position, normal));
        predicted.add(appearance_.predicted(*point, position, normal));
        ++count;
      }
    }
    if (count == 0) return std::numeric_limits<float>::quiet_NaN();
    return float(ciede2000(to_cielab(wanted.over(count)), to_cielab(predicted.over(count))));
  }

  const TriangleMesh& object_;
  const FilmMap& map_;
  const Appearance& appearance_;
};

}  // namespace

FilmLayer color_error_layer(const TriangleMesh& object, const FilmMap& map,
                            const Appearance& appearance, const RunContext& context) {
  const RunScope scope(context);
  FilmLayer layer = empty_layer("color_error", map.covered());
  const ColorError error(object, map, appearance);
  parallel_for(std::size_t(layer.height), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) error.fill_row(layer, int(row));
  });
  return layer;
}

FilmLayer pressed_layer(const DippedFilm& film, const Box2& extent) {
  FilmLayer layer = empty_layer("pressed", extent);
  const FilmMesh& mesh = film.mesh();
  const Vec2 size = layer.extent.max - layer.extent.min;
  parallel_for(std::size_t(layer.height), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int x = 0; x < layer.width; ++x) {
        const Vec2 u(layer.extent.min.x() + size.x() * (x + 0.5) / layer.width,
                     layer.extent.max.y() - size.y() * (double(row) + 0.5) / layer.height);
        const FilmLocation at = locate_flat(mesh, u);
        if (!at.inside || !film.lies_on_object(std::size_t(at.triangle))) continue;
        layer.values[row * std::size_t(layer.width) + std::size_t(x)] =
            float(100 * std::max(0.0, 1 - least_stretch(film, std::size_t(at.triangle))));
      }
  });
  return layer;
}

LayerSummary summarize(const FilmLayer& layer) {
  std::vector<float> there;
  std::copy_if(layer.values.begin(), layer.values.end(), std::back_inserter(there),
               [](float value) { return !std::isnan(value); });
  if (there.empty()) return {};
  std::sort(there.begin(), there.end());
  double sum = 0;
  for (const float value : there) sum += double(value);
  return {sum / double(there.size()), double(there[(there.size() - 1) * 95 / 100])};
}

}  // namespace hydrodip
