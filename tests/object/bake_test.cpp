#include "object/bake.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "image/resize.h"

namespace hydrodip {
namespace {

// Red and green run with the place in space, so that neighbouring triangles agree.
class GradientPaint : public Paint {
 public:
  explicit GradientPaint(const TriangleMesh& mesh) : Paint({1, 1, 1, 1}), mesh_(mesh) {}
  LinearColor color_at(const SurfacePoint& point) const override {
    const Vec3 p = position_at(mesh_, point);
    return {float(p.x()), float(p.y()), 0.25F, 1};
  }
  bool says_anything() const override { return true; }

 private:
  const TriangleMesh& mesh_;
};

// The unit square in the plane, in 2 n^2 triangles and one that covers half of it once more.
TriangleMesh square(int n) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.positions.emplace_back(double(i) / n, double(j) / n, 0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::int32_t a = j * (n + 1) + i, b = a + n + 1;
      mesh.triangles.push_back({a, a + 1, b});
      mesh.triangles.push_back({a + 1, b + 1, b});
    }
  mesh.triangles.push_back({0, n, n * (n + 1)});
  return mesh;
}

TriangleMesh crumpled(TriangleMesh mesh) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.positions[v].z() = 0.2 * std::fmod(0.618034 * double(v * v % 1009), 1) /
                            std::sqrt(double(mesh.positions.size()));
  return mesh;
}

// Each triangle by itself, with corners of its own.
TriangleMesh apart(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (const Triangle& triangle : mesh.triangles) {
    const auto first = std::int32_t(result.positions.size());
    for (const std::int32_t v : triangle)
      result.positions.push_back(mesh.positions[std::size_t(v)]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

// A dome, (0, 0) to (1, 1) seen from above, in 2 n^2 triangles that all face another way.
TriangleMesh dome(int n) {
  TriangleMesh mesh = square(n);
  mesh.triangles.pop_back();
  for (Vec3& p : mesh.positions) {
    const double x = p.x() - 0.5, y = p.y() - 0.5;
    p.z() = std::sqrt(1 - x * x - y * y);
  }
  return mesh;
}

void shows_the_paint_everywhere(const TriangleMesh& mesh) {
  const GradientPaint paint(mesh);
  const Object object = painted_object(mesh, paint, {512});
  ASSERT_EQ(object.uvs.size(), mesh.triangles.size());
  EXPECT_LE(object.textures.at(0)->width_px, 512);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const auto& [u, v] :
         {std::pair(0.0, 0.0), {1.0, 0.0}, {0.0, 1.0}, {0.3, 0.3}, {0.1, 0.7}}) {
      const SurfacePoint point{int(t), u, v};
      const LinearColor wanted = paint.color_at(point);
      const LinearColor shown = color_at(object, point, {0, 0, 0, 1});
      EXPECT_NEAR(shown.r, wanted.r, 0.01) << t;
      EXPECT_NEAR(shown.g, wanted.g, 0.01) << t;
      EXPECT_NEAR(shown.b, wanted.b, 0.005) << t;
    }
}

TEST(Bake, ShowsThePaintEverywhere) {
  shows_the_paint_everywhere(square(9));
  shows_the_paint_everywhere(crumpled(square(9)));
  shows_the_paint_everywhere(apart(crumpled(square(9))));
}

// A disc of triangles round its middle, each 95 times as long as wide, as CAD programs give a
// flat end. A stripe crosses them half-way.
TEST(Bake, LongThinTrianglesHaveTexelsAlongTheirLength) {
  TriangleMesh mesh;
  mesh.positions.emplace_back(0, 0, 0);
  constexpr int kCount = 600;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2 * M_PI * i / kCount;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  for (int i = 0; i < kCount; ++i) {
    const std::int32_t a = 1 + i, b = 1 + (i + 1) % kCount;
    mesh.triangles.push_back(i % 3 == 0   ? Triangle{0, a, b}
                             : i % 3 == 1 ? Triangle{a, b, 0}
                                          : Triangle{b, 0, a});
  }
  class StripePaint : public GradientPaint {
   public:
    using GradientPaint::GradientPaint;
    LinearColor color_at(const SurfacePoint& point) const override {
      const bool on = std::abs(GradientPaint::color_at(point).r - 0.5F) < 0.1F;
      return on ? LinearColor{1, 1, 1, 1} : LinearColor{0, 0, 0, 1};
    }
  };
  const StripePaint paint(mesh);
  const Object object = painted_object(mesh, paint, {512});
  ASSERT_FALSE(object.textures.empty());
  int wrong = 0, all = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 100; ++i) {
      // Along the middle of the triangle, from the disc's middle to its rim.
      const double out = (i + 0.5) / 100;
      std::array<double, 3> weight{};
      for (std::size_t k = 0; k < 3; ++k)
        weight[k] = mesh.triangles[t][k] == 0 ? 1 - out : 0.5 * out;
      const SurfacePoint point{int(t), weight[1], weight[2]};
      const LinearColor wanted = paint.color_at(point);
      wrong += std::abs(color_at(object, point, {0, 0, 0, 1}).r - wanted.r) > 0.5F;
      ++all;
    }
  // It was 1.3 % with a square for each triangle.
  EXPECT_LT(wrong, all / 200) << wrong << " of " << all;
}

// A colour for each triangle.
class MosaicPaint : public Paint {
 public:
  MosaicPaint() : Paint({1, 1, 1, 1}) {}
  LinearColor color_at(const SurfacePoint& point) const override {
    return point.triangle % 2 == 0 ? LinearColor{1, 0, 0, 1} : LinearColor{0, 1, 1, 1};
  }
  bool says_anything() const override { return true; }
};

// As viewers do that draw a large texture small.
TEST(Bake, ASmallerCopyOfTheTextureKeepsTrianglesApart) {
  const TriangleMesh mesh = apart(crumpled(square(5)));
  const MosaicPaint paint;
  Object object = painted_object(mesh, paint, {1024});
  const Image& whole = *object.textures.at(0);
  object.textures[0] =
      std::make_shared<const Image>(resize(whole, whole.width_px / 4, whole.height_px / 4));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const auto& [u, v] : {std::pair(0.0, 0.0), {1.0, 0.0}, {0.0, 1.0}, {0.5, 0.5}}) {
      const SurfacePoint point{int(t), u, v};
      const LinearColor wanted = paint.color_at(point);
      const LinearColor shown = color_at(object, point, {0, 0, 0, 1});
      EXPECT_NEAR(shown.r, wanted.r, 0.01) << t;
      EXPECT_NEAR(shown.g, wanted.g, 0.01) << t;
    }
}

// Viewers draw a texture small from smaller copies of it, and at the rims of triangles they sample
// next to them.
TEST(Bake, FineMeshesLookAsWantedFromAnyDistance) {
  const TriangleMesh mesh = dome(100);
  const GradientPaint paint(mesh);
  Object object = painted_object(mesh, paint, {1024});
  ASSERT_FALSE(object.textures.empty());
  const Image whole = *object.textures.at(0);
  for (int smaller = 1; smaller <= 16; smaller *= 2) {
    object.textures[0] = std::make_shared<const Image>(
        resize(whole, whole.width_px / smaller, whole.height_px / smaller));
    double worst = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const auto& [u, v] :
           {std::pair(0.0, 0.0), {1.0, 0.0}, {0.0, 1.0}, {0.7, 0.6}, {-0.2, 0.5}, {0.5, -0.2}}) {
        const SurfacePoint point{int(t), u, v};
        const LinearColor wanted = paint.color_at(point);
        const LinearColor shown = color_at(object, point, {0, 0, 0, 1});
        worst = std::max(
            {worst, double(std::abs(shown.r - wanted.r)), double(std::abs(shown.g - wanted.g))});
      }
    EXPECT_LT(worst, 0.015 * smaller) << smaller;
  }
}

TEST(Bake, NoTexelIsLeftBlank) {
  const TriangleMesh mesh = dome(9);
  const Object object = painted_object(mesh, GradientPaint(mesh), {512});
  const Image& texture = *object.textures.at(0);
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) ASSERT_EQ(texture.rgba[i], 255) << i;
}

TEST(Bake, TrianglesSmallerThanTexelsHaveTheirColorsAtTheCorners) {
  const TriangleMesh mesh = apart(crumpled(square(60)));
  const GradientPaint paint(mesh);
  const Object object = painted_object(mesh, paint, {64});
  EXPECT_TRUE(object.textures.empty());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const SurfacePoint point{int(t), 0.2, 0.5};
    const LinearColor wanted = paint.color_at(point);
    const LinearColor shown = color_at(object, point, {0, 0, 0, 1});
    EXPECT_NEAR(shown.r, wanted.r, 1e-5) << t;
    EXPECT_NEAR(shown.g, wanted.g, 1e-5) << t;
  }
}

TEST(Bake, TexelsLieAsCloseAsAskedFor) {
  TriangleMesh mesh = square(4);
  for (Vec3& p : mesh.positions) p *= 0.5;
  const GradientPaint paint(mesh);
  for (const double finest : {50.0, 100.0, 400.0}) {
    const Object object = painted_object(mesh, paint, {.most_px = 2048, .finest = finest});
    const int side_px = object.textures.at(0)->width_px;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const Triangle& corners = mesh.triangles[t];
        const double apart = (mesh.positions[std::size_t(corners[k])] -
                              mesh.positions[std::size_t(corners[(k + 1) % 3])])
                                 .norm();
        const double texels = side_px * (object.uvs[t][k] - object.uvs[t][(k + 1) % 3]).norm();
        // Sides are powers of two, with a margin.
        EXPECT_LT(texels, 1.01 * finest * apart);
        EXPECT_GT(texels, 0.35 * finest * apart);
      }
  }
  const Object coarse = painted_object(mesh, paint, {.most_px = 32, .finest = 400});
  EXPECT_LE(coarse.textures.at(0)->width_px, 32);
}

TEST(Bake, WhatAModelSaysIsPassedOn) {
  auto model = std::make_shared<Object>();
  model->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  model->triangles = {{0, 1, 2}};
  model->material_of = {0};
  model->materials.resize(1);
  model->colors = {{LinearColor{1, 0, 0, 1}, LinearColor{0, 1, 0, 1}, LinearColor{0, 0, 1, 1}}};
  TriangleMesh posed = *model;
  for (Vec3& p : posed.positions) p *= 2;
  const Object object = painted_object(posed, *model_paint(model), {64});
  EXPECT_EQ(object.positions[1], Vec3(2, 0, 0));
  EXPECT_EQ(object.colors.size(), 1U);
  EXPECT_TRUE(object.textures.empty());
}

}  // namespace
}  // namespace hydrodip
