// Objects and films for tests of the transfer, made by hand or dipped.
#pragma once

#include <memory>
#include <utility>

#include "exact/dipping.h"
#include "object/object.h"
#include "object/paint.h"
#include "transfer/film_map.h"

namespace hydrodip::fixtures {

inline constexpr double kHalfSide_mm = 20;

// A dipped object with its map; stays where it was made, because the map refers to it.
struct Dipped {
  Object object;
  std::unique_ptr<Surface> surface;
  DippedFilm film;
  std::unique_ptr<FilmMap> map;
};

inline std::unique_ptr<Dipped> mapped(Object object, DippedFilm film) {
  auto result = std::make_unique<Dipped>();
  result->object = std::move(object);
  result->film = std::move(film);
  result->surface = std::make_unique<Surface>(result->object.positions, result->object.triangles);
  result->map = std::make_unique<FilmMap>(result->object, *result->surface, result->film);
  return result;
}

// The object's own colours, on white.
class ObjectPaint : public Paint {
 public:
  explicit ObjectPaint(const Object& object) : Paint({1, 1, 1, 1}), object_(object) {}
  LinearColor color_at(const SurfacePoint& point) const override {
    return hydrodip::color_at(object_, point, base());
  }
  bool says_anything() const override { return object_.has_appearance(); }

 private:
  const Object& object_;
};

inline ObjectPaint paint_of(const Dipped& dipped) { return ObjectPaint(dipped.object); }

inline Object plain_object(const shapes::Shape& shape) {
  Object object;
  object.positions = shape.positions;
  object.triangles = shape.triangles;
  object.material_of.assign(object.triangles.size(), 0);
  object.materials.resize(1);
  return object;
}

// The sheet of all films here: 60 x 60 mm.
inline FilmMesh small_film(int elements) {
  return make_film_mesh(
      {.width_mm = 60, .height_mm = 60, .margin_mm = 5, .elements = elements, .grading = 1});
}

// A slab whose flat bottom reaches to x, y = +-20, and film that lies on it undeformed: attached
// exactly where it lies within the square.
inline DippedFilm film_on_slab(int elements) {
  DippedFilm film;
  film.shared_mesh = std::make_shared<const FilmMesh>(small_film(elements));
  const std::size_t vertices = film.mesh().u.size();
  for (std::size_t v = 0; v < vertices; ++v) {
    const Vec2& u = film.mesh().u[v];
    const bool inside = u.cwiseAbs().maxCoeff() <= kHalfSide_mm + 1e-9;
    film.position.emplace_back(u.x(), u.y(), inside ? 0.0 : 3.0);
    film.state.push_back(
        inside ? VertexState::kAttached
               : (film.mesh().on_rim[v] ? VertexState::kClamped : VertexState::kUnattached));
  }
  film.area_ratio.assign(vertices, 1);
  film.stretch.assign(vertices, 1);
  film.torn.assign(film.mesh().triangles.size(), 0);
  film.depth_mm = 3;
  return film;
}

inline Object slab() {
  return plain_object(
      shapes::box(Vec3(-kHalfSide_mm, -kHalfSide_mm, 0), Vec3(kHalfSide_mm, kHalfSide_mm, 8)));
}

// Texture coordinates from above: the sheet's 60 x 60 mm are the picture.
inline void map_from_above(Object& object) {
  object.uvs.clear();
  for (const Triangle& t : object.triangles) {
    CornerUv uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 plan = object.positions[std::size_t(t[k])].head<2>();
      uv[k] = (plan / 60 + Vec2::Constant(0.5)).cast<float>();
    }
    object.uvs.push_back(uv);
  }
}

inline void set_texture(Object& object, Image image) {
  object.textures = {std::make_shared<const Image>(std::move(image))};
  object.materials[0].texture = 0;
}

inline void fill_pixel(Image& image, int x, int y, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  std::uint8_t* pixel = image.pixel(x, y);
  pixel[0] = r;
  pixel[1] = g;
  pixel[2] = b;
  pixel[3] = 255;
}

}  // namespace hydrodip::fixtures
