#include "transfer/raster.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"
#include "base/parallel.h"
#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

using fixtures::fill_pixel;
using fixtures::kHalfSide_mm;

SheetRaster small_sheet(double dpi) { return {60, 60, dpi}; }

Image printed(const fixtures::Dipped& dipped, const SheetRaster& raster,
              const InverseOptions& options = {}) {
  RunContext context;
  return film_image(fixtures::paint_of(dipped), *dipped.map, raster, options, Allotment(), context);
}

// How far a point lies outside the square that the slab's bottom covers.
double outside_mm(const Vec2& u) {
  const Vec2 beyond = (u.cwiseAbs() - Vec2::Constant(kHalfSide_mm)).cwiseMax(0);
  return beyond.norm();
}

Image plain_texture(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Image image(4, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) fill_pixel(image, x, y, r, g, b);
  return image;
}

std::unique_ptr<fixtures::Dipped> textured_slab(Image texture, int elements = 5000) {
  Object object = fixtures::slab();
  fixtures::map_from_above(object);
  fixtures::set_texture(object, std::move(texture));
  return fixtures::mapped(std::move(object), fixtures::film_on_slab(elements));
}

TEST(SheetRaster, PixelsAndMillimetresAreInverse) {
  for (const double dpi : {72.0, 300.0, 1200.0}) {
    const SheetRaster raster{210, 297, dpi};
    EXPECT_EQ(raster.width_px(), std::lround(210 / 25.4 * dpi));
    EXPECT_EQ(raster.height_px(), std::lround(297 / 25.4 * dpi));
    for (const Vec2& u : {Vec2(0, 0), Vec2(-105, 148.5), Vec2(33.3, -71.2)}) {
      const Vec2 pixel = raster.to_pixel(u);
      EXPECT_LT((raster.to_film(pixel.x(), pixel.y()) - u).norm(), 1e-10);
    }
    // The sheet's centre is the image's; y points up on the film, down in the image.
    EXPECT_LT(raster.to_film(0.5 * raster.width_px(), 0.5 * raster.height_px()).norm(), 1e-12);
    const Vec2 step = raster.to_film(11, 21) - raster.to_film(10, 20);
    EXPECT_NEAR(step.x(), 25.4 / dpi, 1e-12);
    EXPECT_NEAR(step.y(), -25.4 / dpi, 1e-12);
  }
}

TEST(FilmImage, PrintsWhatTheObjectShowsWhereItShowsIt) {
  // One dot in each quadrant, of another colour: neither mirrored nor turned.
  Image texture = plain_texture(255, 255, 255);
  texture = Image(600, 600);  // 0.1 mm a pixel
  const auto dot_color = [](double x, double y) {
    return std::array<int, 3>{x > 0 ? 200 : 20, y > 0 ? 180 : 40, 90};
  };
  for (int y = 0; y < 600; ++y)
    for (int x = 0; x < 600; ++x) {
      const double mm_x = (x + 0.5) / 10 - 30, mm_y = 30 - (y + 0.5) / 10;
      const auto c = dot_color(mm_x, mm_y);
      fill_pixel(texture, x, y, std::uint8_t(c[0]), std::uint8_t(c[1]), std::uint8_t(c[2]));
    }
  const SheetRaster raster = small_sheet(254);
  const auto dipped = textured_slab(texture);
  const Image image = printed(*dipped, raster);
  for (const Vec2& u : {Vec2(10, 10), Vec2(-10, 10), Vec2(10, -10), Vec2(-10, -10)}) {
    const Vec2 at = raster.to_pixel(u);
    const std::uint8_t* pixel = image.pixel(int(at.x()), int(at.y()));
    const auto expected = dot_color(u.x(), u.y());
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(pixel[k], expected[std::size_t(k)], 1);
    EXPECT_EQ(pixel[3], 255);
  }
}

// A ball of many triangles with film laid round it, stretched, under a texture that is finer than a
// pixel: every sample of a pixel is where it lands by itself.
TEST(FilmImage, EverySampleOfAPixelCounts) {
  const double radius = 28;
  Object object = fixtures::plain_object(shapes::sphere_bowl(radius, 24, 60, 90));
  fixtures::map_from_above(object);
  Image texture(1500, 1500);
  for (int y = 0; y < 1500; ++y)
    for (int x = 0; x < 1500; ++x)
      fill_pixel(texture, x, y, std::uint8_t((x * 37 + y * 91) % 256), std::uint8_t((x / 9) % 256),
                 std::uint8_t(255 * ((x + y) % 2)));
  fixtures::set_texture(object, std::move(texture));
  DippedFilm film = fixtures::film_on_slab(5000);
  for (std::size_t v = 0; v < film.position.size(); ++v) {
    const Vec2 at = 1.1 * film.mesh().u[v];
    const double way = std::sin(std::min(at.norm() / radius, 1.0)) * radius;
    const Vec2 plan = at.norm() > 0 ? Vec2(at * (way / at.norm())) : at;
    film.position[v] << plan, radius - std::sqrt(radius * radius - plan.squaredNorm());
    film.state[v] = at.norm() < 24 ? VertexState::kAttached : VertexState::kUnattached;
  }
  const auto dipped = fixtures::mapped(std::move(object), std::move(film));
  const SheetRaster raster = small_sheet(200);
  const Image image = printed(*dipped, raster, {.bleed_mm = 0});
  long compared = 0;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      if (image.pixel(x, y)[3] != 255) continue;
      LinearColor sum{0, 0, 0, 0};
      int found = 0;
      for (int k = 0; k < 9; ++k) {
        const int i = k % 3, j = k / 3;
        const auto point =
            dipped->map->to_object(raster.to_film(x + (i + 0.5) / 3, y + (j + 0.5) / 3));
        if (!point) continue;
        const LinearColor color = color_at(dipped->object, *point, {1, 1, 1, 1});
        sum.r += color.r / 9;
        sum.g += color.g / 9;
        sum.b += color.b / 9;
        ++found;
      }
      if (found < 9) continue;
      ++compared;
      EXPECT_NEAR(image.pixel(x, y)[0], linear_to_srgb8(sum.r), 2);
      EXPECT_NEAR(image.pixel(x, y)[1], linear_to_srgb8(sum.g), 2);
      EXPECT_NEAR(image.pixel(x, y)[2], linear_to_srgb8(sum.b), 2);
    }
  EXPECT_GT(compared, 50000);
}

TEST(FilmImage, InkEndsWhereTheBleedEnds) {
  const SheetRaster raster = small_sheet(300);
  const double pixel_mm = kMmPerInch / raster.dpi;
  const auto dipped = textured_slab(plain_texture(10, 120, 200));
  for (const double bleed : {0.0, 1.0, 2.5}) {
    InverseOptions options;
    options.bleed_mm = bleed;
    const Image image = printed(*dipped, raster, options);
    int wrong = 0;
    for (int y = 0; y < image.height_px; ++y)
      for (int x = 0; x < image.width_px; ++x) {
        const double outside = outside_mm(raster.to_film(x + 0.5, y + 0.5));
        const std::uint8_t* pixel = image.pixel(x, y);
        if (outside > bleed + pixel_mm) {
          wrong += pixel[0] != 0 || pixel[1] != 0 || pixel[2] != 0 || pixel[3] != 0;
        } else if (outside < bleed - pixel_mm || outside == 0) {
          // A covered pixel at the edge may be covered in part if there is no bleed around it.
          const bool at_edge =
              raster.to_film(x + 0.5, y + 0.5).cwiseAbs().maxCoeff() > kHalfSide_mm - pixel_mm;
          wrong += !(bleed == 0 && at_edge) && pixel[3] != 255;
          wrong += pixel[3] > 0 && (std::abs(pixel[0] - 10) > 1 || std::abs(pixel[1] - 120) > 1 ||
                                    std::abs(pixel[2] - 200) > 1);
        }
      }
    EXPECT_EQ(wrong, 0) << "bleed " << bleed;
  }
}

// Red and blue faces meet along the diagonal of the slab's bottom; their texture coordinates lie
// far apart, with green between them.
TEST(FilmImage, DoesNotMixAcrossASeam) {
  Object object = fixtures::slab();
  Image texture(64, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 64; ++x)
      fill_pixel(texture, x, y, x < 16 ? 255 : 0, x >= 16 && x < 48 ? 255 : 0, x >= 48 ? 255 : 0);
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const float u = t % 2 == 0 ? 0.1f : 0.9f;  // the bottom's are triangles 0 and 1
    object.uvs.push_back(
        {Eigen::Vector2f(u, 0.3f), Eigen::Vector2f(u + 0.02f, 0.3f), Eigen::Vector2f(u, 0.6f)});
  }
  fixtures::set_texture(object, std::move(texture));
  const auto dipped = fixtures::mapped(std::move(object), fixtures::film_on_slab(5000));
  const SheetRaster raster = small_sheet(300);
  const double pixel_mm = kMmPerInch / raster.dpi;
  InverseOptions options;
  options.bleed_mm = 0;
  const Image image = printed(*dipped, raster, options);
  int mixed_away_from_seam = 0, green = 0, red = 0, blue = 0;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      const std::uint8_t* pixel = image.pixel(x, y);
      if (pixel[3] == 0) continue;
      const Vec2 u = raster.to_film(x + 0.5, y + 0.5);
      const bool is_red = pixel[0] == 255 && pixel[2] == 0;
      const bool is_blue = pixel[2] == 255 && pixel[0] == 0;
      red += is_red;
      blue += is_blue;
      green += pixel[1] > 0;
      // Both diagonals, so as not to depend on which one cuts the bottom.
      const double seam = std::min(std::abs(u.x() - u.y()), std::abs(u.x() + u.y())) / std::sqrt(2);
      if (!is_red && !is_blue && seam > 0.75 * pixel_mm) ++mixed_away_from_seam;
    }
  EXPECT_EQ(green, 0);
  EXPECT_EQ(mixed_away_from_seam, 0);
  const double half = 0.5 * 1600 / (pixel_mm * pixel_mm);
  EXPECT_NEAR(red / half, 1, 0.01);
  EXPECT_NEAR(blue / half, 1, 0.01);
}

// A checkerboard finer than the pixels prints as its mean in linear light: 50 % black and white is
// sRGB 188, not 128.
TEST(FilmImage, AntialiasesInLinearLight) {
  Image texture(1200, 1200);  // 0.05 mm a pixel
  for (int y = 0; y < 1200; ++y)
    for (int x = 0; x < 1200; ++x) {
      const std::uint8_t value = (x + y) % 2 == 0 ? 255 : 0;
      fill_pixel(texture, x, y, value, value, value);
    }
  const auto dipped = textured_slab(texture);
  InverseOptions options;
  options.samples_per_axis = 8;
  const SheetRaster raster = small_sheet(72);
  const Image image = printed(*dipped, raster, options);
  double sum = 0;
  int count = 0;
  for (double x = -15; x < 15; x += 1)
    for (double y = -15; y < 15; y += 1) {
      const Vec2 at = raster.to_pixel(Vec2(x, y));
      const std::uint8_t value = image.pixel(int(at.x()), int(at.y()))[0];
      EXPECT_NEAR(value, 188, 20);
      sum += srgb8_to_linear(value);
      ++count;
    }
  EXPECT_NEAR(sum / count, 0.5, 0.02);
}

TEST(FilmImage, ThreadsDoNotChangeAByte) {
  Image texture(100, 100);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x)
      fill_pixel(texture, x, y, std::uint8_t(x * 2), std::uint8_t(y * 2), std::uint8_t(x ^ y));
  const auto dipped = textured_slab(texture);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return printed(*dipped, small_sheet(300)).rgba;
  };
  EXPECT_EQ(with_threads(1), with_threads(2));
}

TEST(FilmImage, PrintsTheShareThatIsAllotted) {
  const auto dipped = textured_slab(plain_texture(10, 200, 30));
  RunContext context;
  const SheetRaster raster = small_sheet(100);
  const auto image_of = [&](const Allotment& allotment) {
    return film_image(fixtures::paint_of(*dipped), *dipped->map, raster, {}, allotment, context);
  };
  const Image whole = image_of(Allotment());
  // The same as saying so of every point.
  EXPECT_EQ(image_of(Allotment([](const SurfacePoint&) { return 1.0F; })).rgba, whole.rgba);
  // On one half of the slab a quarter, on the other half nothing.
  const TriangleMesh& mesh = dipped->object;
  const Image part = image_of(Allotment(
      [&](const SurfacePoint& point) { return position_at(mesh, point).x() > 0 ? 0.25F : 0.0F; }));
  const Vec2 right = raster.to_pixel({10, 3}), left = raster.to_pixel({-10, 3});
  const std::uint8_t* pixel = part.pixel(int(right.x()), int(right.y()));
  EXPECT_EQ(int(pixel[3]), 255);
  // A quarter of the ink lets through the fourth root of the light: four such films make the whole.
  for (const auto& [channel, value] : {std::pair(1, 200), std::pair(2, 30)}) {
    const double light = double(srgb8_to_linear(pixel[channel]));
    EXPECT_NEAR(std::pow(light, 4), double(srgb8_to_linear(std::uint8_t(value))), 0.01);
  }
  EXPECT_EQ(int(part.pixel(int(left.x()), int(left.y()))[3]), 0);
}

TEST(FilmImage, CanBeCancelled) {
  const auto dipped = textured_slab(plain_texture(1, 2, 3));
  RunContext context;
  context.cancel();
  EXPECT_THROW(film_image(fixtures::paint_of(*dipped), *dipped->map, small_sheet(300), {},
                          Allotment(), context),
               Cancelled);
}

TEST(SampleFilmImage, IsBilinearAndTransparentOutside) {
  const SheetRaster raster = small_sheet(25.4);  // 1 mm a pixel
  Image image(60, 60);
  fill_pixel(image, 30, 29, 255, 255, 255);  // centre at (0.5, 0.5) mm
  EXPECT_NEAR(sample_film_image(image, raster, Vec2(0.5, 0.5)).a, 1, 1e-6);
  EXPECT_NEAR(sample_film_image(image, raster, Vec2(1.0, 0.5)).a, 0.5, 1e-6);
  EXPECT_NEAR(sample_film_image(image, raster, Vec2(1.0, 1.0)).a, 0.25, 1e-6);
  // A colour does not darken where it fades.
  EXPECT_NEAR(sample_film_image(image, raster, Vec2(1.0, 1.0)).r, 1, 1e-6);
  EXPECT_EQ(sample_film_image(image, raster, Vec2(1.6, 0.5)).a, 0);
  EXPECT_EQ(sample_film_image(image, raster, Vec2(500, 0)).a, 0);
}

// Between a thin red and a thick blue, colour counts by what it covers.
TEST(SampleFilmImage, ThinColoursCountForLess) {
  const SheetRaster raster = small_sheet(25.4);
  Image image(60, 60);
  fill_pixel(image, 30, 29, 255, 0, 0);
  fill_pixel(image, 31, 29, 0, 0, 255);
  image.pixel(30, 29)[3] = 51;
  image.pixel(31, 29)[3] = 204;
  const LinearColor color = sample_film_image(image, raster, Vec2(1.0, 0.5));
  EXPECT_NEAR(color.r, 0.2, 1e-6);
  EXPECT_NEAR(color.b, 0.8, 1e-6);
  EXPECT_NEAR(color.a, 0.5, 1e-6);
}

TEST(PredictedColor, IsInkOverTheBareObject) {
  const auto dipped = textured_slab(plain_texture(0, 0, 0));
  const SheetRaster raster = small_sheet(25.4);
  Image image(60, 60);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 30; ++x) fill_pixel(image, x, y, 255, 0, 0);
  const LinearColor base{0.2f, 0.4f, 0.6f, 1};
  const auto at = [&](const Vec3& position, const Vec3& normal) {
    return predicted_color(image, raster, *dipped->map, position, normal, base);
  };
  const LinearColor inked = at(Vec3(-10, 3, 0), Vec3(0, 0, -1));
  EXPECT_NEAR(inked.r, 1, 1e-6);
  EXPECT_NEAR(inked.g, 0, 1e-6);
  const LinearColor blank = at(Vec3(10, 3, 0), Vec3(0, 0, -1));  // film without ink
  EXPECT_NEAR(blank.g, 0.4, 1e-6);
  const LinearColor bare = at(Vec3(-10, 3, 8), Vec3(0, 0, 1));  // no film
  EXPECT_NEAR(bare.b, 0.6, 1e-6);
  EXPECT_EQ(bare.a, 1);
}

}  // namespace
}  // namespace hydrodip
