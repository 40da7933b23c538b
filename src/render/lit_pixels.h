// What every pixel of a view shows, and the light there: of a soft lamp from above left and a white
// sky, over a ground that takes the shadow.
#pragma once

#include <functional>
#include <vector>

#include "base/context.h"
#include "object/object.h"
#include "object/surface.h"
#include "render/normals.h"
#include "render/view.h"

namespace hydrodip {

// Refers to all of them.
struct LitObject {
  const TriangleMesh& mesh;
  const Surface& surface;
  const std::vector<CornerNormals>& normals;
};

// Both 1 where nothing stands in the way.
struct Light {
  double sky = 1;   // share of the sky that is not hidden
  double lamp = 1;  // share of the lamp
};

// What is seen at one place of the picture.
struct SeenPoint {
  int triangle = -1;  // -1: the backdrop
  float u = 0, v = 0, depth = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // unit, of the triangle, turned to the eye

  SurfacePoint point() const { return {triangle, double(u), double(v)}; }
  Vec3 flat() const { return normal.cast<double>(); }
};

// At the corner normals' point, turned to the eye.
Vec3 smooth_normal(const std::vector<CornerNormals>& normals, const SeenPoint& seen);

class LitPixels {
 public:
  // Throws Cancelled. Does not depend on the number of threads.
  LitPixels(const LitObject& object, const Camera& camera, int width_px, int height_px,
            const RunContext& context);

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t count() const { return std::size_t(width_) * std::size_t(height_); }
  std::size_t at(int x, int y) const {
    return std::size_t(y) * std::size_t(width_) + std::size_t(x);
  }
  // Calls `row` for each y, in parallel. Throws Cancelled.
  void for_rows(const std::function<void(int y)>& row) const;

  const LitObject& object() const { return object_; }
  const Camera& camera() const { return camera_; }
  const Vec3& ground_normal() const { return ground_normal_; }
  const Vec3& lamp() const { return lamp_; }  // unit, towards it

  const SeenPoint& centre(int x, int y) const { return centre_[at(x, y)]; }
  Light light(int x, int y) const { return light_[at(x, y)]; }

  // Of a place anywhere in the picture, in pixels from its upper left corner.
  SeenPoint trace(double x_px, double y_px) const;
  Vec3 position(const SeenPoint& seen) const;
  // The light of the centre, of pixel (x, y) and those around it, that shows the surface nearest
  // to this point.
  Light light_near(const SeenPoint& seen, int x, int y) const;
  // On the ground behind the object.
  Light ground_at(double x_px, double y_px) const;

 private:
  // In single precision, which takes half the memory.
  struct PixelLight {
    float sky = 1, lamp = 1;
    PixelLight() = default;
    PixelLight(const Light& light)  // NOLINT(google-explicit-constructor)
        : sky(float(light.sky)), lamp(float(light.lamp)) {}
    operator Light() const {  // NOLINT(google-explicit-constructor)
      return {double(sky), double(lamp)};
    }
  };

  void place_ground();
  Vec3 ray(double x_px, double y_px) const;
  bool blocked(const Vec3& origin, const Vec3& direction) const;

  void trace_centres();
  void cast_light_rays();
  Light cast_from(const SeenPoint& seen, int phase) const;
  Vec3 rounded_position(const SeenPoint& seen) const;
  void smooth_light();
  Light gathered(const std::vector<PixelLight>& raw, int x, int y) const;

  void shadow_ground();
  std::size_t coarse_at(int x, int y) const;
  void for_coarse(const std::function<void(int x, int y)>& cell) const;
  Light ground_light(double x_px, double y_px, int phase) const;
  Light gathered_ground(const std::vector<Light>& raw, int x, int y) const;

  const LitObject object_;
  const Camera camera_;
  int width_;
  int height_;
  const RunContext& context_;
  double extent_ = 1;
  Vec3 ground_normal_, lamp_;
  std::vector<Vec3> sky_rays_;  // around z
  std::vector<Vec3> lamp_rays_, ground_sky_rays_, ground_lamp_rays_;
  double ground_height_ = 0;
  std::vector<SeenPoint> centre_;
  std::vector<PixelLight> light_;
  std::vector<Light> ground_;
  int coarse_width_ = 0;
  int coarse_height_ = 0;
};

}  // namespace hydrodip
