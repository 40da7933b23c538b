// Layers as a paint: what is seen where, and what is hidden.
#include "artwork/artwork.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/file.h"
#include "base/parallel.h"
#include "image/files.h"
#include "shapes.h"

namespace hydrodip {
namespace {

constexpr double kBlack = 0.01, kWhite = 0.99;

class Layers : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("hydrodip-artwork-" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path picture(const std::shared_ptr<const Image>& image,
                                const std::string& name = "picture.png") {
    save_png(folder_ / name, *image);
    return folder_ / name;
  }
  std::filesystem::path black() {
    return picture(painted(8, 8, [](int, int) { return std::array{0, 0, 0, 255}; }), "black.png");
  }

  static std::shared_ptr<const Paint> laid(const PosedObject& object,
                                           std::vector<ArtworkLayer> layers, bool closed = true,
                                           double dpi = 300) {
    std::vector<PictureSource> pictures = read_pictures(layers);
    return lay_artwork({std::move(layers), std::move(pictures), model_paint(object.shared_object()),
                        closed, dpi, 3},
                       object, RunContext())
        .paint;
  }

  std::filesystem::path folder_;
};

ArtworkLayer downward(const std::filesystem::path& image, double width_mm) {
  ArtworkLayer layer;
  layer.image = image;
  layer.toward = Vec3(0, 0, -1);
  layer.up = Vec3(0, 1, 0);
  layer.width_mm = width_mm;
  return layer;
}

// What is seen there of an object that is not turned.
float seen(const PosedObject& object, const Paint& paint, const Vec3& model_point) {
  const auto hit = object.surface().closest_point(moved(object, model_point), 0.01);
  if (!hit) {
    ADD_FAILURE() << "no surface at " << model_point.transpose();
    return -1;
  }
  return paint.color_at({hit->triangle, hit->u, hit->v}).g;
}

// The picture's left half is black: its edge is where the colour changes, to be found to a
// thousandth of a millimetre.
TEST_F(Layers, AnEdgeLiesWhereItIsTold) {
  const PosedObject object = posed(box({0, 0, 0}, {100, 60, 20}));
  const auto image = painted(2000, 1000, [](int x, int) {
    return x < 500 ? std::array{0, 0, 0, 255} : std::array{255, 255, 255, 255};
  });
  ArtworkLayer layer = downward(picture(image), 80);
  layer.at_mm = Vec3(47, 31, 20);
  const auto paint = laid(object, {layer});
  // A quarter of 80 mm from its left edge, at 47 - 40.
  double low = 10, high = 60;
  while (high - low > 1e-4) {
    const double middle = 0.5 * (low + high);
    (seen(object, *paint, {middle, 31, 20}) < 0.5 ? low : high) = middle;
  }
  EXPECT_NEAR(low, 27, 0.02);
}

TEST_F(Layers, TheBackOfAThinShellStaysBare) {
  // Half a millimetre thick, many small triangles and one of the backs below.
  TriangleMesh mesh = box({0, 0, 0}, {50, 50, 0.5});
  const PosedObject coarse = posed(mesh);
  const auto paint = laid(coarse, {downward(black(), 200)});
  EXPECT_LT(seen(coarse, *paint, {20, 20, 0.5}), kBlack);
  EXPECT_GT(seen(coarse, *paint, {20, 20, 0}), kWhite);
  EXPECT_GT(seen(coarse, *paint, {0, 20, 0.2}), kWhite);  // the rim is parallel to the way
  // A sphere's shell: an outer and an inner surface, 0.4 mm apart.
  TriangleMesh shell = ball(20, 300, 150);
  TriangleMesh inner = ball(19.6, 300, 150);
  for (Triangle& t : inner.triangles) std::swap(t[1], t[2]);
  append(shell, inner);
  const PosedObject fine = posed(shell);
  const auto on_shell = laid(fine, {downward(black(), 100)});
  each_point(fine.mesh(), [&](const SurfacePoint& point) {
    const Vec3 p = position_at(fine.mesh(), point) - moved(fine, Vec3::Zero());
    if (std::abs(p.z()) < 0.5) return;
    const bool outer_top = p.norm() > 19.8 && p.z() > 0;
    const float g = on_shell->color_at(point).g;
    EXPECT_TRUE(outer_top ? g < kBlack : g > kWhite) << p.transpose() << " " << g;
  });
}

TEST_F(Layers, WhatIsHiddenStaysBareUnlessToldOtherwise) {
  // A small plate over a large one: its shadow is sharp, in big triangles and in small ones.
  TriangleMesh two = box({0, 0, 0}, {60, 60, 2});
  append(two, box({20, 20, 30}, {40, 40, 32}));
  const PosedObject object = posed(two);
  ArtworkLayer layer = downward(black(), 200);
  const auto paint = laid(object, {layer});
  EXPECT_LT(seen(object, *paint, {30, 30, 32}), kBlack);
  EXPECT_LT(seen(object, *paint, {10, 10, 2}), kBlack);
  EXPECT_GT(seen(object, *paint, {30, 30, 2}), kWhite);
  EXPECT_LT(seen(object, *paint, {19.95, 30, 2}), kBlack);
  EXPECT_GT(seen(object, *paint, {20.05, 30, 2}), kWhite);
  layer.through = true;
  const auto through = laid(object, {layer});
  EXPECT_LT(seen(object, *through, {30, 30, 2}), kBlack);
  EXPECT_LT(seen(object, *through, {30, 30, 0}), kBlack);
}

// What is known of whole triangles is what a ray from every point says, whoever asks first.
TEST_F(Layers, ShadowsAreAsRaysHaveThemInAnyOrderOnAnyThreads) {
  TriangleMesh mesh = sheet(30, 25, [](double s, double t) {
    return Vec3(60 * s, 60 * t, 4 * std::sin(9 * s) * std::cos(7 * t));
  });
  TriangleMesh over = ball(11, 14, 9);
  for (Vec3& p : over.positions) p += Vec3(33, 25, 30);
  append(mesh, over);
  const PosedObject object = posed(mesh);
  std::vector<SurfacePoint> points;
  each_point(object.mesh(), [&](const SurfacePoint& p) { points.push_back(p); });
  const auto one = laid(object, {downward(black(), 200)}, false);
  const auto many = laid(object, {downward(black(), 200)}, false);
  std::vector<double> seen_by_many(points.size());
  parallel_for(points.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      seen_by_many[points.size() - 1 - i] = many->color_at(points[points.size() - 1 - i]).r;
  });
  int lit = 0, hidden = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(one->color_at(points[i]).r, seen_by_many[i]) << i;
    const Vec3 normal = face_normal(object.mesh(), points[i].triangle);
    if (normal.z() < 0.05) continue;
    const Vec3 p = position_at(object.mesh(), points[i]);
    const bool is_hidden = object.surface().is_hit(p, Vec3(0, 0, 1), 1e-2, 1e4);
    EXPECT_EQ(seen_by_many[i] > 0.5, is_hidden) << p.transpose();
    ++(is_hidden ? hidden : lit);
  }
  EXPECT_GT(lit, 5000);
  EXPECT_GT(hidden, 500);
}

// A profile turned about z, from the axis and back to it; outward if it goes round the solid with
// the solid on its left.
TriangleMesh turned(const std::vector<Vec2>& profile, int around) {
  const auto n = int(profile.size()) - 1;
  return welded(sheet(around, n, [&](double s, double t) {
    const Vec2& p = profile[std::size_t(std::lround(t * n))];
    return Vec3(p.x() * std::cos(2 * kPi * s), p.x() * std::sin(2 * kPi * s), p.y());
  }));
}

// The arc of a circle about the origin, in degrees from straight down.
void add_arc(std::vector<Vec2>& profile, double radius, double from, double to) {
  for (int i = 0; i <= 60; ++i) {
    const double angle = (from + (to - from) * i / 60) * kPi / 180;
    profile.emplace_back(radius * std::sin(angle), -radius * std::cos(angle));
  }
}

TEST_F(Layers, NothingGoesThroughAHole) {
  // A hollow ball with a hole at its top, wide enough to see the bottom of its inside.
  std::vector<Vec2> profile;
  add_arc(profile, 30, 0, 155);
  add_arc(profile, 28, 155, 0);
  const PosedObject object = posed(turned(profile, 90));
  const auto paint = laid(object, {downward(black(), 200)});
  int outside = 0, inside = 0;
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    const Vec3 p = position_at(object.mesh(), point) - moved(object, Vec3::Zero());
    const float g = paint->color_at(point).g;
    if (p.norm() < 28.05) {
      ++inside;
      EXPECT_GT(g, kWhite) << p.transpose();
    } else if (p.norm() > 29.9 && p.z() > 3 && p.head<2>().norm() > 14) {
      ++outside;
      EXPECT_LT(g, kBlack) << p.transpose();
    }
  });
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 1000);
}

TEST_F(Layers, TheInsideOfABowlIsNoHole) {
  std::vector<Vec2> profile;
  add_arc(profile, 30, 0, 88);
  add_arc(profile, 28, 88, 0);
  const PosedObject object = posed(turned(profile, 90));
  const auto paint = laid(object, {downward(black(), 200)});
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    const Vec3 p = position_at(object.mesh(), point) - moved(object, Vec3::Zero());
    if (p.norm() < 28.01 && p.z() < -4) {
      EXPECT_LT(paint->color_at(point).g, kBlack) << p.transpose();
    }
  });
}

// A tray of 40 x 40 x 30 mm, 3 mm thick, open above.
TriangleMesh tray() {
  TriangleMesh mesh;
  const auto ring = [&](double half, double z) {
    for (const Vec2& p :
         {Vec2(-half, -half), Vec2(half, -half), Vec2(half, half), Vec2(-half, half)})
      mesh.positions.emplace_back(p.x(), p.y(), z);
  };
  const auto quad = [&](int a, int b, int c, int d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  ring(20, 30), ring(17, 30), ring(20, 0), ring(17, 3);
  for (int k = 0; k < 4; ++k) {
    const int n = (k + 1) % 4;
    quad(k, n, n + 4, k + 4);
    quad(k, k + 8, n + 8, n);
    quad(k + 4, n + 4, n + 12, k + 12);
  }
  quad(11, 10, 9, 8);
  quad(12, 13, 14, 15);
  return mesh;
}

// Its walls stand upright: no ray along them is to tell that its bottom lies behind them.
TEST_F(Layers, TheBottomOfATrayIsNoHole) {
  const PosedObject object = posed(tray());
  const auto paint = laid(object, {downward(black(), 200)});
  int bottom = 0;
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    const Vec3 p = position_at(object.mesh(), point) - moved(object, Vec3::Zero());
    if (std::abs(p.z() - 3) > 1e-3) return;
    ++bottom;
    EXPECT_LT(paint->color_at(point).g, kBlack) << p.transpose();
  });
  EXPECT_GT(bottom, 8);
}

TEST_F(Layers, ShadowsAreTheSameInSmallTriangles) {
  const auto flat = [](double z) {
    return [z](double s, double t) { return Vec3(40 * s, 40 * t, z); };
  };
  const auto small = [](double s, double t) { return Vec3(10 + 20 * s, 10 + 20 * t, 5); };
  TriangleMesh two = sheet(120, 120, flat(0));
  append(two, sheet(60, 60, small));
  const PosedObject object = posed(two);
  const auto paint = laid(object, {downward(black(), 200)}, false);
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    const Vec3 p = position_at(object.mesh(), point);
    const bool below = p.z() < 1 && std::abs(p.x()) < 10 && std::abs(p.y()) < 10;
    const float g = paint->color_at(point).g;
    EXPECT_TRUE(below ? g > kWhite : g < kBlack) << p.transpose();
  });
}

TEST_F(Layers, TransparentEdgesHaveNoFringe) {
  // Red, cut out by alpha; the hidden colour of the rest is black, or white. On white, nothing
  // between red and white is darker than red, or lighter than it is covered.
  for (const int hidden : {0, 255}) {
    const auto image = painted(40, 40, [=](int x, int) {
      return x < 20 ? std::array{255, 0, 0, 255} : std::array{hidden, hidden, hidden, 0};
    });
    const PosedObject object = posed(box({0, 0, 0}, {40, 40, 5}));
    const auto paint = laid(object, {downward(picture(image), 40)});
    for (double x = 15; x < 25; x += 0.01) {
      const auto hit = object.surface().closest_point(moved(object, {x, 20, 5}), 0.01);
      const LinearColor color = paint->color_at({hit->triangle, hit->u, hit->v});
      EXPECT_NEAR(color.r, 1, 1e-5);
      EXPECT_NEAR(color.g, color.b, 1e-6);
      EXPECT_NEAR(color.g, std::clamp(x - 19.5, 0.0, 1.0), 0.01);
    }
  }
}

TEST_F(Layers, StandUpright) {
  const auto image = painted(40, 40, [](int, int y) {
    return y < 20 ? std::array{0, 0, 0, 255} : std::array{255, 255, 255, 255};
  });
  const PosedObject object = posed(box({0, 0, 0}, {40, 40, 5}));
  const auto paint = laid(object, {downward(picture(image), 40)});
  EXPECT_LT(seen(object, *paint, {20, 30, 5}), kBlack);
  EXPECT_GT(seen(object, *paint, {20, 10, 5}), kWhite);
}

TEST_F(Layers, TurnCounterClockwiseAsOneSeesThem) {
  const auto image = painted(40, 40, [](int x, int) {
    return x < 20 ? std::array{0, 0, 0, 255} : std::array{255, 255, 255, 255};
  });
  const PosedObject object = posed(box({0, 0, 0}, {40, 40, 5}));
  ArtworkLayer layer = downward(picture(image), 40);
  layer.turn_deg = 90;  // what was left is below
  const auto paint = laid(object, {layer});
  EXPECT_LT(seen(object, *paint, {20, 10, 5}), kBlack);
  EXPECT_GT(seen(object, *paint, {20, 30, 5}), kWhite);
}

TEST_F(Layers, LieOverEachOtherInOrder) {
  const auto gray = picture(painted(4, 4,
                                    [](int, int) {
                                      return std::array{188, 188, 188, 255};
                                    }),
                            "gray.png");
  const float half = srgb8_to_linear(188);
  const PosedObject object = posed(box({0, 0, 0}, {40, 40, 5}));
  ArtworkLayer bottom = downward(gray, 40), top = downward(black(), 40);
  top.opacity = 0.25;
  EXPECT_NEAR(seen(object, *laid(object, {bottom, top}), {20, 20, 5}), 0.75 * half, 1e-4);
  EXPECT_NEAR(seen(object, *laid(object, {top, bottom}), {20, 20, 5}), half, 1e-4);
  ArtworkLayer tint = downward(gray, 40);
  tint.blend = Blend::kMultiply;
  EXPECT_NEAR(seen(object, *laid(object, {bottom, tint}), {20, 20, 5}), half * half, 1e-4);
  // More layers than are looked at at once.
  std::vector<ArtworkLayer> many(20, tint);
  EXPECT_NEAR(seen(object, *laid(object, many), {20, 20, 5}), std::pow(half, 20), 1e-5);
}

TEST_F(Layers, RepeatAndMirror) {
  const auto image = painted(100, 100, [](int x, int) {
    return x < 50 ? std::array{0, 0, 0, 255} : std::array{255, 255, 255, 255};
  });
  const PosedObject object = posed(box({0, 0, 0}, {100, 100, 5}));
  ArtworkLayer layer = downward(picture(image), 20);
  layer.at_mm = Vec3(50, 50, 5);
  const auto at = [&](const Paint& paint, double x) { return seen(object, paint, {x, 50, 5}); };
  const auto once = laid(object, {layer});
  EXPECT_LT(at(*once, 45), kBlack);
  EXPECT_GT(at(*once, 25), kWhite);
  layer.repeat = Repeat::kTile;
  const auto tiled = laid(object, {layer});
  EXPECT_LT(at(*tiled, 65), kBlack);
  EXPECT_GT(at(*tiled, 75), kWhite);
  EXPECT_LT(at(*tiled, 25), kBlack);
  layer.repeat = Repeat::kMirror;
  const auto mirrored = laid(object, {layer});
  EXPECT_GT(at(*mirrored, 65), kWhite);
  EXPECT_LT(at(*mirrored, 75), kBlack);
  EXPECT_LT(at(*mirrored, 35), kBlack);
}

TEST_F(Layers, FadeWhereTheSurfaceTurnsAway) {
  const PosedObject object = posed(ball(20, 200, 100));
  ArtworkLayer layer = downward(black(), 100);
  layer.fade_deg = 30;
  const auto paint = laid(object, {layer});
  const auto at = [&](double degrees) {
    const double angle = degrees * kPi / 180;
    const auto hit = object.surface().closest_point(
        moved(object, 20 * Vec3(std::sin(angle), 0, std::cos(angle))), 0.1);
    return double(paint->color_at({hit->triangle, hit->u, hit->v}).g);
  };
  EXPECT_NEAR(at(10), 0, 0.01);
  EXPECT_NEAR(at(28), 0, 0.01);
  EXPECT_NEAR(at(60), 0.5, 0.02);
  EXPECT_NEAR(at(85), 1 - 5.0 / 60, 0.02);
}

TEST_F(Layers, WhatHitsNothingIsRefused) {
  const PosedObject object = posed(box({0, 0, 0}, {40, 40, 5}));
  ArtworkLayer layer = downward(black(), 10);
  layer.at_mm = Vec3(100, 20, 5);
  EXPECT_THROW(laid(object, {layer}), InputError);
  ArtworkLayer hidden = downward(picture(painted(4, 4,
                                                 [](int, int) {
                                                   return std::array{9, 9, 9, 0};
                                                 })),
                                 10);
  EXPECT_THROW(laid(object, {hidden}), InputError);
  ArtworkLayer by_uv = downward(black(), 10);
  by_uv.projection = Projection::kUv;
  EXPECT_THROW(laid(object, {by_uv}), InputError);
}

// A face without texture coordinates among others that have them shows nothing of the picture.
// A row of pixels as wide as the object: no printer lays a line of a hundredth of a millimetre.
TEST_F(Layers, LinesThinnerThanAnyPrintAreRefusedWithTheirSize) {
  const PosedObject object = posed(box({0, 0, 0}, {60, 60, 5}));
  const auto row = [](int width) {
    return painted(width, 1, [](int, int) { return std::array{0, 0, 0, 255}; });
  };
  for (const int width : {4000, 32768})
    for (const Projection projection : {Projection::kPlanar, Projection::kFilm}) {
      ArtworkLayer layer = downward(picture(row(width)), 60);
      layer.projection = projection;
      try {
        laid(object, {layer});
        ADD_FAILURE() << width << " px were laid";
      } catch (const InputError& error) {
        const std::string said = error.what();
        EXPECT_NE(said.find(width == 4000 ? "60 x 0.015 mm" : "60 x 0.00183 mm"), said.npos)
            << said;
        EXPECT_NE(said.find("--art-size W,H"), said.npos) << said;
      }
      // Repeated, it is all of the surface, and with a height of its own a band of it.
      layer.repeat = Repeat::kTile;
      EXPECT_NO_THROW(laid(object, {layer}));
      layer.repeat = Repeat::kOnce;
      layer.height_mm = 5;
      EXPECT_NO_THROW(laid(object, {layer}));
    }
}

// What prints at one resolution may not at another.
TEST(ThinLayers, AreToldByTheResolution) {
  LaidLayer line{
      .name = "line.png", .layer = {}, .size_mm = Vec2(60, 0.1), .fonts = {}, .shows = {}};
  LaidLayer wide{
      .name = "wide.png", .layer = {}, .size_mm = Vec2(60, 20), .fonts = {}, .shows = {}};
  EXPECT_EQ(told_thin({line}, 300), "");
  EXPECT_NE(told_thin({line}, 72).find("line.png: it is laid 60 x 0.1 mm"), std::string::npos);
  // There is more to print.
  EXPECT_EQ(told_thin({line, wide}, 72), "");
  EXPECT_EQ(told_thin({}, 72), "");
}

TEST_F(Layers, ByUvLieOnlyOnWhatHasThem) {
  Object object = with_materials(box({0, 0, 0}, {40, 40, 5}));
  object.uvs.assign(object.triangles.size(),
                    {Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero()});
  object.uvs[2] = {Eigen::Vector2f(0.1F, 0.1F), Eigen::Vector2f(0.9F, 0.1F),
                   Eigen::Vector2f(0.9F, 0.9F)};
  const PosedObject posed(std::make_shared<const Object>(object), {});
  ArtworkLayer layer;
  layer.image = black();
  layer.projection = Projection::kUv;
  const auto paint = laid(posed, {layer});
  for (int t = 0; t < int(object.triangles.size()); ++t) {
    const float seen = paint->color_at({t, 0.3, 0.3}).g;
    if (t == 2)
      EXPECT_LT(seen, kBlack);
    else
      EXPECT_GT(seen, kWhite) << t;
  }
}

// A dot on a plate of two triangles a side: as found as a picture that is as large as the plate.
TEST_F(Layers, TheSmallestPictureIsFound) {
  const PosedObject object = posed(box({0, 0, 0}, {300, 300, 5}));
  for (const double width : {1.0, 0.3, 0.01}) {
    ArtworkLayer layer = downward(black(), width);
    layer.at_mm = Vec3(123.4, 77.7, 5);
    EXPECT_LT(seen(object, *laid(object, {layer}), {123.4, 77.7, 5}), kBlack) << width;
    layer.at_mm = Vec3(300 + 0.6 * width, 77.7, 5);
    EXPECT_THROW(laid(object, {layer}), InputError) << width;
  }
}

TEST_F(Layers, DrawingsAreAsSharpAsThePrint) {
  const std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 40 20'><rect x='10.25' y='0' "
      "width='20' height='20' fill='#000'/></svg>";
  write_file(folder_ / "logo.svg", svg);
  const PosedObject object = posed(box({0, 0, 0}, {40, 40, 5}));
  constexpr double kDpi = 1200;
  const auto paint = laid(object, {downward(folder_ / "logo.svg", 40)}, true, kDpi);
  // From white to black within less than a printed pixel, at the right place.
  double begin = 0, end = 0;
  for (double x = 10; x < 10.5; x += 0.0005) {
    const float g = seen(object, *paint, {x, 20, 5});
    if (g > 0.98) begin = x;
    if (g > 0.02) end = x;
  }
  EXPECT_NEAR(0.5 * (begin + end), 10.25, 0.005);
  EXPECT_LT(end - begin, kMmPerInch / kDpi);
}

TEST_F(Layers, TextIsSet) {
  const PosedObject object = posed(box({0, 0, 0}, {80, 40, 5}));
  ArtworkLayer layer = downward("", 70);
  layer.text = "HHH & <H>";
  const auto paint = laid(object, {layer});
  int dark = 0, light = 0;
  for (double x = 5; x < 75; x += 0.1) {
    const float g = seen(object, *paint, {x, 20, 5});
    dark += g < 0.1;
    light += g > 0.9;
  }
  EXPECT_GT(dark, 50);
  EXPECT_GT(light, 50);
  // What it is set in is said.
  std::vector<ArtworkLayer> layers = {layer};
  std::vector<PictureSource> pictures = read_pictures(layers);
  const RunContext context;
  const auto artwork =
      lay_artwork({layers, std::move(pictures), model_paint(object.shared_object()), true, 300, 3},
                  object, context);
  ASSERT_EQ(artwork.layers[0].fonts.size(), 1U);
  EXPECT_NE(describe(artwork.layers[0]).find("set in " + artwork.layers[0].fonts[0].name),
            std::string::npos);
  EXPECT_TRUE(context.warnings().empty());
  // And that it is another one than was asked for.
  layers[0].font = "No Font Of This Name";
  lay_artwork({layers, read_pictures(layers), model_paint(object.shared_object()), true, 300, 3},
              object, context);
  ASSERT_EQ(context.warnings().size(), 1U);
  EXPECT_NE(context.warnings()[0].find("'No Font Of This Name' is not installed"),
            std::string::npos);
  layer.text = " ";
  EXPECT_THROW(laid(object, {layer}), InputError);
}

TEST_F(Layers, OfDrawingsSayWhatIsNotShown) {
  const PosedObject object = posed(box({0, 0, 0}, {40, 40, 5}));
  const auto warnings = [&](const std::string& inside) {
    ArtworkLayer layer;
    layer.image = folder_ / "a.svg";
    std::ofstream(layer.image) << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><rect "
                                  "width='9' height='9'/>"
                               << inside << "</svg>";
    RunContext context;
    std::vector<PictureSource> pictures = read_pictures({layer});
    lay_artwork({{layer}, std::move(pictures), model_paint(object.shared_object()), true, 100, 1},
                object, context);
    return context.warnings();
  };
  const std::string file = (folder_ / "a.svg").string();
  EXPECT_TRUE(warnings("").empty());
  EXPECT_EQ(warnings("<image href='b.png'/>"),
            std::vector{file + ": 'b.png' is not in the drawing's file and not shown; embed it"});
  EXPECT_EQ(
      warnings("<image href='b.png'/><use href='c.svg#c'/>"),
      std::vector{file + ": 'b.png' and 'c.svg#c' are not in the drawing's file and not shown; "
                         "embed them"});
  std::string many, damaged;
  for (const char name : {'b', 'c', 'd', 'e', 'f', 'g', 'h'}) {
    many += std::string("<image href='") + name + "'/>";
    damaged += "<image width='1' height='1' href='data:image/png;base64,AAAA'/>";
  }
  EXPECT_EQ(
      warnings(many),
      std::vector{file + ": 'b', 'c', 'd', 'e', 'f' and 2 more are not in the drawing's file and "
                         "not shown; embed them"});
  EXPECT_EQ(
      warnings(damaged),
      std::vector{file + ": each of 7 pictures in the drawing is damaged or of a kind that is not "
                         "read, and not shown; embed it again as PNG or JPEG"});
}

TEST_F(Layers, OnTheFilmShowWhereFilmLies) {
  const auto image = painted(100, 100, [](int x, int) {
    return x < 50 ? std::array{0, 0, 0, 255} : std::array{255, 255, 255, 255};
  });
  const PosedObject object = posed(box({0, 0, 0}, {40, 40, 5}));
  ArtworkLayer layer;
  layer.image = picture(image);
  layer.projection = Projection::kFilm;
  layer.width_mm = 20;
  layer.repeat = Repeat::kTile;
  const auto paint = laid(object, {layer});
  ASSERT_TRUE(paint->depends_on_film());
  const SurfacePoint anywhere{0, 0.2, 0.2};
  EXPECT_GT(paint->color_at(anywhere).g, kWhite);
  EXPECT_LT(paint->color_on_film(anywhere, {-5, 3}).g, kBlack);
  EXPECT_GT(paint->color_on_film(anywhere, {5, 3}).g, kWhite);
  EXPECT_LT(paint->color_on_film(anywhere, {15, 3}).g, kBlack);
  // Its centre is where it is told to lie.
  layer.at_mm = Vec3(5, 1, 0);
  const auto moved_right = laid(object, {layer});
  EXPECT_LT(moved_right->color_on_film(anywhere, {2, 3}).g, kBlack);
  EXPECT_GT(moved_right->color_on_film(anywhere, {8, 3}).g, kWhite);
  // What is written on it is read from its other side.
  layer.image.clear();
  layer.text = "H";
  const RunContext context;
  lay_artwork({{layer}, read_pictures({layer}), model_paint(object.shared_object()), true, 100, 1},
              object, context);
  ASSERT_EQ(context.warnings().size(), 1U);
  EXPECT_NE(context.warnings()[0].find("mirror writing"), std::string::npos);
}

// A drawing that says how large it is, in whatever unit; in pixels it says nothing.
TEST_F(Layers, OnTheFilmHaveTheSizeThatTheirFileSays) {
  const PosedObject object = posed(box({0, 0, 0}, {40, 40, 5}));
  const auto size_of = [&](const char* width, const char* height) {
    ArtworkLayer layer;
    layer.image = folder_ / "a.svg";
    layer.projection = Projection::kFilm;
    std::ofstream(layer.image) << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width
                               << "' height='" << height
                               << "' viewBox='0 0 2 1'><rect width='2' height='1'/></svg>";
    RunContext context;
    std::vector<PictureSource> pictures = read_pictures({layer});
    const Artwork artwork = lay_artwork(
        {{layer}, std::move(pictures), model_paint(object.shared_object()), true, 100, 1}, object,
        context);
    return std::pair(artwork.layers[0].size_mm, context.warnings().size());
  };
  for (const auto& [width, height] :
       {std::pair{"50.8mm", "25.4mm"}, {"5.08cm", "2.54cm"}, {"2in", "1in"}, {"144pt", "72pt"}}) {
    const auto [size, warnings] = size_of(width, height);
    EXPECT_NEAR(size.x(), 50.8, 1e-6) << width;
    EXPECT_NEAR(size.y(), 25.4, 1e-6) << width;
    EXPECT_EQ(warnings, 0U);
  }
  const auto [size, warnings] = size_of("200", "100");
  EXPECT_NEAR(size.x(), 100, 1e-6);
  EXPECT_EQ(warnings, 1U);  // that nothing says it
}

}  // namespace
}  // namespace hydrodip
