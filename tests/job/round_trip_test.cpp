// The whole way: a model is printed, the print is dipped, and the model's own colours come back.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "coat/dipped_object.h"
#include "image/files.h"
#include "ink/discoloration.h"
#include "ink/stiffness.h"
#include "job/jobs.h"
#include "job/prepare.h"
#include "samples/samples.h"
#include "sheet/sheet.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

JobConfig mask_job(const std::filesystem::path& folder) {
  write_sample("mask", make_sample("mask"), folder);
  JobConfig config;
  config.model = folder / "mask.obj";
  config.output = folder / "out";
  // No more film than a mask of 100 x 130 mm needs.
  config.design.film.width_mm = 150;
  config.design.film.height_mm = 180;
  config.design.film.elements = 14000;
  config.design.dip.step_mm = 0.2;
  // The mask's texture has edges sharper than a pixel of 300 dpi, which alone keep it at 34 dB.
  config.design.dpi = 600;
  config.pictures = false;
  return config;
}

// The film that carries the inks of print.tif, dipped as it will be.
DippedObject dipped_again(const JobConfig& config, const PosedObject& posed, const InkImage& inks,
                          const RunContext& context) {
  Timings timings;
  const DesignOptions& design = config.design;
  const auto film = std::make_shared<const FilmMesh>(make_film_mesh(design.film));
  DipOptions options = design.dip;
  options.modulus = film_modulus(*film, inks, raster_of(design.film, design.dpi), design.stiffness);
  return dip_object(posed, film, make_trajectory({}, posed.mesh().positions), options, timings,
                    context);
}

// Evenly over the surface and always the same: equal shares of area, and in each triangle the
// points of a low-discrepancy sequence.
std::vector<SurfacePoint> evenly_spread(const TriangleMesh& object, int count) {
  std::vector<double> area_up_to;
  double total = 0;
  for (const Triangle& t : object.triangles) {
    const Vec3& a = object.positions[std::size_t(t[0])];
    const Vec3 ab = object.positions[std::size_t(t[1])] - a;
    const Vec3 ac = object.positions[std::size_t(t[2])] - a;
    const Vec3 normal(ab.y() * ac.z() - ab.z() * ac.y(), ab.z() * ac.x() - ab.x() * ac.z(),
                      ab.x() * ac.y() - ab.y() * ac.x());
    area_up_to.push_back(total += 0.5 * normal.norm());
  }
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    const auto at =
        std::upper_bound(area_up_to.begin(), area_up_to.end(), total * (i + 0.5) / count);
    double u = std::fmod(0.5 + 0.7548776662466927 * i, 1.0);
    double v = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    points.push_back({int(at - area_up_to.begin()), u, v});
  }
  return points;
}

std::array<int, 3> srgb(const LinearColor& c) {
  return {linear_to_srgb8(c.r), linear_to_srgb8(c.g), linear_to_srgb8(c.b)};
}

struct Likeness {
  double psnr_db = 0;
  int compared = 0;
};

// Wanted against predicted colours wherever film lies on the object.
Likeness likeness(const DippedObject& dipped, const Paint& paint, const Image& film,
                  const SheetRaster& raster) {
  const LinearColor base{1, 1, 1, 1};
  const TriangleMesh& mesh = dipped.posed.mesh();
  double squares = 0;
  Likeness result;
  for (const SurfacePoint& point : evenly_spread(mesh, 200000)) {
    const Vec3 position = position_at(mesh, point);
    const Vec3 normal = face_normal(mesh, point.triangle);
    if (!dipped.map->to_film(position, normal)) continue;
    const auto wanted = srgb(paint.color_at(point));
    const auto found = srgb(predicted_color(film, raster, *dipped.map, position, normal, base));
    for (std::size_t k = 0; k < 3; ++k) squares += std::pow(wanted[k] - found[k], 2) / 3;
    ++result.compared;
  }
  result.psnr_db = 10 * std::log10(255 * 255 / (squares / result.compared));
  return result;
}

constexpr double kDotSpacing_mm = 10, kDotRadius_mm = 0.8;

// Black dots on white every 10 mm as seen from below, put on with texture coordinates to match.
std::shared_ptr<const Object> dotted(const TriangleMesh& mesh) {
  constexpr int kPixels = 1600;
  constexpr double kSize_mm = 160;
  Image image(kPixels, kPixels);
  for (int y = 0; y < kPixels; ++y)
    for (int x = 0; x < kPixels; ++x) {
      const Vec2 at((x + 0.5) * kSize_mm / kPixels - kSize_mm / 2,
                    kSize_mm / 2 - (y + 0.5) * kSize_mm / kPixels);
      const Vec2 dot = (at / kDotSpacing_mm).array().round() * kDotSpacing_mm;
      const double edge = (at - dot).norm() - kDotRadius_mm;  // soft over one pixel
      const auto value = std::uint8_t(std::lround(255 * std::clamp(edge / 0.1 + 0.5, 0.0, 1.0)));
      std::uint8_t* pixel = image.pixel(x, y);
      std::fill_n(pixel, 3, value);
      pixel[3] = 255;
    }
  Object result;
  result.positions = mesh.positions;
  result.triangles = mesh.triangles;
  result.materials.assign(1, Material{});
  result.materials[0].texture = 0;
  result.material_of.assign(result.triangles.size(), 0);
  result.colors.clear();
  result.textures = {std::make_shared<const Image>(std::move(image))};
  result.uvs.clear();
  for (const Triangle& t : result.triangles) {
    CornerUv uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 plan = result.positions[std::size_t(t[k])].head<2>();
      uv[k] = (plan / kSize_mm + Vec2::Constant(0.5)).cast<float>();
    }
    result.uvs.push_back(uv);
  }
  return std::make_shared<const Object>(std::move(result));
}

struct Registration {
  double largest_mm = 0;
  int dots = 0;
};

// Where each dot's centre is on the object, wanted and predicted, in space.
Registration registration(const DippedObject& dipped, const Object& object, const Image& film,
                          const SheetRaster& raster) {
  const LinearColor base{1, 1, 1, 1};
  Registration result;
  const Box3 box = object.bounds();
  const int reach = int(std::ceil(box.max.head<2>().maxCoeff() / kDotSpacing_mm));
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) {
      Vec3 wanted = Vec3::Zero(), found = Vec3::Zero();
      double wanted_ink = 0, found_ink = 0;
      bool covered = true;
      for (double dx = -1.5; dx <= 1.5 && covered; dx += 0.06)
        for (double dy = -1.5; dy <= 1.5 && covered; dy += 0.06) {
          const Vec3 below(i * kDotSpacing_mm + dx, j * kDotSpacing_mm + dy, -1);
          const auto hit = dipped.posed.surface().first_hit(below, Vec3(0, 0, 1), 0, 1e3);
          if (!hit) {
            covered = false;
            break;
          }
          const Vec3 position = dipped.posed.surface().position(*hit);
          const Vec3 normal = dipped.posed.surface().normal(*hit);
          covered = dipped.map->to_film(position, normal).has_value();
          const double w = 1 - double(color_at(object, {hit->triangle, hit->u, hit->v}, base).g);
          const double f =
              1 - double(predicted_color(film, raster, *dipped.map, position, normal, base).g);
          wanted += w * position;
          wanted_ink += w;
          found += f * position;
          found_ink += f;
        }
      if (!covered) continue;
      ++result.dots;
      EXPECT_NEAR(found_ink / wanted_ink, 1, 0.1) << i << " " << j;
      result.largest_mm =
          std::max(result.largest_mm, (wanted / wanted_ink - found / found_ink).norm());
    }
  return result;
}

// Without tears: what depends on how torn film falls is not printed, and another dip tears anew.
TEST(RoundTripSlow, WhatIsPrintedAndDippedIsWhatWasWanted) {
  const TemporaryFolder folder;
  JobConfig config = mask_job(folder.path());
  config.design.dip.material.tear_stretch = 0;
  RunContext context;
  print_job(config, context);
  const InkImage inks = read_cmyk_tiff(config.output / "print.tif").inks;
  const SheetRaster raster = raster_of(config.design.film, config.design.dpi);
  ASSERT_EQ(inks.width_px, raster.width_px());
  ASSERT_EQ(inks.height_px, raster.height_px());

  // Stiffened by its ink and paled by its stretch.
  const PreparedObject prepared = prepare_object(config.model, config.object, context);
  const DippedObject dipped = dipped_again(config, prepared.posed, inks, context);
  const FilmStretch stretch =
      film_stretch(*dipped.map, raster, config.design.inverse.bleed_mm, context);
  const auto model = make_device_model();
  const Image seen = look_on_object(inks, stretch.area_ratio, *model, {1, 1, 1, 1});
  const Likeness colors = likeness(dipped, *prepared.paint, seen, raster);
  EXPECT_GT(colors.compared, 50000);
  EXPECT_GE(colors.psnr_db, 35);
  RecordProperty("psnr_db", std::to_string(colors.psnr_db));

  const auto dots = dotted(dipped.posed.mesh());
  const Image dots_film =
      film_image(*model_paint(dots), *dipped.map, raster, InverseOptions{}, Allotment(), context);
  const Registration features = registration(dipped, *dots, dots_film, raster);
  EXPECT_GT(features.dots, 60);
  EXPECT_LT(features.largest_mm, 0.05);
  RecordProperty("largest_mm", std::to_string(features.largest_mm));
}

// Stripes, rings and a cut-out edge, soft over a third of a millimetre, as a photograph is.
Image layer_picture() {
  constexpr int kPixels = 1500;
  Image image(kPixels, kPixels);
  for (int y = 0; y < kPixels; ++y)
    for (int x = 0; x < kPixels; ++x) {
      const double u = (x + 0.5) / kPixels - 0.5, v = (y + 0.5) / kPixels - 0.5;
      const double ring = std::hypot(u, v);
      const auto wave = [](double t) { return std::uint8_t(std::lround(90 + 70 * std::sin(t))); };
      std::uint8_t* pixel = image.pixel(x, y);
      pixel[0] = wave(60 * u);
      pixel[1] = wave(80 * ring);
      pixel[2] = wave(50 * (u + v));
      pixel[3] = std::uint8_t(std::lround(255 * std::clamp((0.45 - ring) * 100 + 0.5, 0.0, 1.0)));
    }
  return image;
}

TEST(RoundTripSlow, ALayersColoursComeBackAsTexturesDo) {
  const TemporaryFolder folder;
  JobConfig config = mask_job(folder.path());
  save_png(folder.path() / "layer.png", layer_picture());
  config.object.artwork.emplace_back();
  config.object.artwork[0].image = folder.path() / "layer.png";
  config.object.artwork[0].width_mm = 90;
  config.design.dpi = 300;
  // Under it plain white: the mask's own texture has edges that are too sharp for 300 dpi.
  Object bare = make_sample("mask");
  auto white = std::make_shared<Image>(4, 4);
  std::fill(white->rgba.begin(), white->rgba.end(), std::uint8_t(255));
  bare.textures = {white};
  write_sample("bare", bare, folder.path());
  config.model = folder.path() / "bare.obj";
  RunContext context;
  print_job(config, context);
  const InkImage inks = read_cmyk_tiff(config.output / "print.tif").inks;
  const SheetRaster raster = raster_of(config.design.film, config.design.dpi);
  const PreparedObject prepared = prepare_object(config.model, config.object, context, 300);
  const DippedObject dipped = dipped_again(config, prepared.posed, inks, context);
  const FilmStretch stretch =
      film_stretch(*dipped.map, raster, config.design.inverse.bleed_mm, context);
  const Image seen = look_on_object(inks, stretch.area_ratio, *make_device_model(), {1, 1, 1, 1});
  const Likeness colors = likeness(dipped, *prepared.paint, seen, raster);
  EXPECT_GT(colors.compared, 50000);
  EXPECT_GE(colors.psnr_db, 35);
  RecordProperty("psnr_db", std::to_string(colors.psnr_db));
}

// A sheet that somebody else made, half a per cent too low: its middle is still the middle.
TEST(FilmImage, OfNearlyTheSheetsShapeFillsIt) {
  const TemporaryFolder folder;
  write_sample("sphere", make_sample("sphere"), folder.path());
  JobConfig config;
  config.model = folder.path() / "sphere.obj";
  config.output = folder.path() / "out";
  config.design.film = {120, 150, FilmShape::kRectangle, 10, 800};
  config.design.dip.step_mm = 1;
  config.design.trajectory.depth_mm = 5;
  config.pictures = false;
  config.plan.suggest = false;
  constexpr double kDpi = 100;
  SheetOptions sheet;
  sheet.width_mm = 120;
  sheet.height_mm = 149.2;
  sheet.dpi = kDpi;
  const SheetRaster given{sheet.width_mm, sheet.height_mm, kDpi};
  InkImage inks(given.width_px(), given.height_px());
  const int middle = inks.height_px / 2;
  for (int y = middle - 3; y < middle + 3; ++y)
    for (int x = 100; x < 300; ++x) inks.pixel(x, y)[3] = 255;
  config.film_image = folder.path() / "given.tif";
  write_print_tiff(config.film_image, inks, make_device_model()->profile(), sheet);
  RunContext context;
  print_film_image_job(config, context);
  EXPECT_TRUE(context.warnings().empty()) << context.warnings().front();
  const InkImage printed = read_cmyk_tiff(config.output / "print.tif").inks;
  double sum = 0, count = 0;
  for (int y = 0; y < printed.height_px; ++y)
    if (printed.pixel(200, y)[3] > 0) {
      sum += y + 0.5;
      ++count;
    }
  ASSERT_GT(count, 0);
  EXPECT_NEAR(sum / count, 0.5 * printed.height_px, 1);
}

}  // namespace
}  // namespace hydrodip
