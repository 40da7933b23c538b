#include "render/maps.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "laid_film.h"
#include "render/lit_view.h"

namespace hydrodip {
namespace {

using fixtures::film_under_ball;
using fixtures::kRadius;
using fixtures::two_coloured_ball;

// The ball's dipping angle, from geometry alone.
double ball_angle_deg(const Vec3& p) {
  return std::acos(std::clamp((kRadius - p.z()) / (p - Vec3(0, 0, kRadius)).norm(), -1.0, 1.0)) /
         kDegree;
}

// Torn is whatever lies at x > 4.
DippedFilm film_torn_on_one_side() {
  DippedFilm film = film_under_ball();
  for (std::size_t t = 0; t < film.torn.size(); ++t) {
    double least = 1e300;
    for (const std::int32_t v : film.mesh().triangles[t])
      least = std::min(least, film.mesh().u[std::size_t(v)].x());
    film.torn[t] = film.lies_on_object(t) && least > 4 ? 1 : 0;
  }
  return film;
}

// Corners of the cube's sides that differ by rounding only become one.
Object smooth_ball() {
  Object ball = two_coloured_ball(48);
  for (Vec3& p : ball.positions) p = ((p * 1e6).array().round() / 1e6).matrix();
  return ball;
}

struct Scene {
  Object ball = smooth_ball();
  Surface surface{ball.positions, ball.triangles};
  DippedFilm film = film_torn_on_one_side();
  FilmMap map{ball, surface, film};
  std::vector<CornerNormals> normals = map_normals(ball);
  MapScene maps{ball, normals, straight_down_to(1e9), {}, &map, 1.8};
};

struct Pixel {
  double angle_deg = 0;
  Vec3 position = Vec3::Zero();
  const std::uint8_t* rgb = nullptr;
};

// Calls `check` for every pixel whose ray hits the ball.
template <typename Check>
void for_ball_pixels(const Scene& scene, const Camera& camera, const Image& image, Check check) {
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const Vec3 ray =
          camera.ray(2 * (x + 0.5) / image.width_px - 1, 1 - 2 * (y + 0.5) / image.height_px);
      const auto hit = scene.surface.first_hit(camera.eye, ray, 0, 1e9);
      if (!hit) continue;
      const Vec3 p = scene.surface.position(*hit);
      check(Pixel{ball_angle_deg(p), p, image.pixel(x, y)});
    }
  }
}

ViewPair render(const Scene& scene, const Camera& camera) {
  const Appearance appearance = map_appearance(scene.maps, camera, 2);
  RunContext context;
  return LitView({scene.ball, scene.surface, scene.normals}, camera, 200, 200, context)
      .show(appearance, {scene.normals, 0.6, false});
}

// Although facets are tilted by more than a degree; mesh normals are least true where three cube
// sides meet.
TEST(Maps, AngleOnABallIsTheAnalyticOne) {
  const Scene scene;
  for (std::size_t t = 0; t < scene.ball.triangles.size(); t += 7) {
    for (const SurfacePoint& point : {SurfacePoint{int(t), 0, 0}, SurfacePoint{int(t), 0.3, 0.3},
                                      SurfacePoint{int(t), 0.1, 0.8}}) {
      EXPECT_NEAR(angle_at(scene.ball, scene.normals, point),
                  ball_angle_deg(position_at(scene.ball, point)), 0.3);
    }
  }
}

// Faces 90 degrees apart stay flat: their angle is the same everywhere.
TEST(Maps, AngleKeepsEdges) {
  Object roof;
  roof.positions = {{0, -1, 0}, {0, 1, 0}, {1, 0, 1}, {-1, 0, 1}};
  roof.triangles = {{0, 2, 1}, {0, 1, 3}};
  const auto normals = map_normals(roof);
  for (int t = 0; t < 2; ++t) {
    for (const double u : {0.0, 0.4, 1.0}) {
      EXPECT_NEAR(angle_at(roof, normals, {t, u, 0}), angle_at(roof, normals, {t, 0, 1}), 1e-9);
    }
  }
}

TEST(Maps, ColoursSayOnWhichSideOfTheLimitAnAngleLies) {
  for (const double angle : {0.0, 10.0, 30.0, 44.0, 45.0, 45.05}) {
    const LinearColor c = angle_color(angle);
    EXPECT_GT(c.b, c.r) << angle;
  }
  for (const double angle : {45.2, 50.0, 70.0, 89.5}) {
    const LinearColor c = angle_color(angle);
    EXPECT_GT(c.r, 2 * c.b) << angle;
  }
  for (const double angle : {90.0, 91.0, 180.0}) {
    const LinearColor c = angle_color(angle);
    EXPECT_TRUE(c.r == c.g && c.g == c.b) << angle;
  }
}

TEST(Maps, PictureShowsTheAngleOfEveryPixel) {
  const Scene scene;
  const Camera camera = frame_object(scene.ball, Vec3(0.6, 0.5, -0.6).normalized(), 1, 0.9);
  const Image image = render(scene, camera).wanted;
  long gentle = 0, steep = 0, neutral = 0;
  for_ball_pixels(scene, camera, image, [&](const Pixel& pixel) {
    const int r = pixel.rgb[0], g = pixel.rgb[1], b = pixel.rgb[2];
    if (pixel.angle_deg < 44.5) {
      EXPECT_GT(b, r + 15) << pixel.angle_deg;
      ++gentle;
    } else if (pixel.angle_deg > 45.5 && pixel.angle_deg < 89.5) {
      EXPECT_GT(r, b + 15) << pixel.angle_deg;
      ++steep;
    } else if (pixel.angle_deg > 90.5) {
      EXPECT_TRUE(r == g && g == b) << pixel.angle_deg;
      ++neutral;
    }
  });
  EXPECT_GT(gentle, 2000);
  EXPECT_GT(steep, 2000);
  EXPECT_GT(neutral, 500);
}

// Stripes are dark red or, but for the light, white; bare surface is grey, the scale colourful.
TEST(Maps, TornMarksStandOnlyWhereFilmIsTorn) {
  const Scene scene;
  const Camera camera = frame_object(scene.ball, Vec3(0, 0, -1), 1, 0.9);
  const Image image = render(scene, camera).predicted;
  const double cell = scene.film.mesh().cell_mm;
  long red = 0, light = 0;
  for_ball_pixels(scene, camera, image, [&](const Pixel& pixel) {
    const int r = pixel.rgb[0], g = pixel.rgb[1], b = pixel.rgb[2];
    const bool is_red = r > g + 80 && r > b + 60;
    const bool is_grey = r == g && g == b;
    const Vec3& p = pixel.position;
    const double reach = std::hypot(p.x(), p.y());
    if (p.x() > 4 + 2 * cell && reach < 16 - 2 * cell && p.z() < kRadius) {
      EXPECT_TRUE(is_red || is_grey);
      red += is_red;
      light += is_grey && r > 190;
    } else if (p.x() < 4 - cell || reach > 16 + cell) {
      EXPECT_FALSE(is_red) << p.transpose();
      // The film ends along whole triangles.
      const bool clear = reach > 16 || reach < 16 - 2 * cell;
      EXPECT_TRUE(!clear || is_grey == (reach > 16)) << p.transpose();
    }
  });
  EXPECT_GT(red, 500);
  EXPECT_GT(light, 500);
}

TEST(Maps, StretchScaleEndsAtTheLimitOrAboveTheMost) {
  const DippedFilm film = film_under_ball();  // up to 1 / 0.6
  EXPECT_EQ(stretch_scale_end(film, 1.4), 1.4);
  EXPECT_NEAR(stretch_scale_end(film, 0), 1.7, 1e-12);
  EXPECT_GT(stretch_scale_end(film, 1), 1);
  EXPECT_NEAR(stretch_scale_end(DippedFilm{}, 0), 1.1, 1e-12);
}

Image draw_page(const Scene& scene, bool angles_only, int width_px = 320) {
  MapOptions options;
  options.width_px = width_px;
  options.tear_stretch = 1.4;
  options.caption = "caption";
  RunContext context;
  return angles_only
             ? render_angle_map(scene.ball, scene.surface, straight_down_to(25), options, context)
             : render_maps(scene.ball, scene.surface, scene.film, scene.map, options, context);
}

TEST(Maps, SameBytesWithOneAndTwoThreads) {
  const Scene scene;
  for (const bool angles_only : {false, true}) {
    Image one, two;
    {
      const ThreadLimit limit(1);
      one = draw_page(scene, angles_only);
    }
    {
      const ThreadLimit limit(2);
      two = draw_page(scene, angles_only);
    }
    EXPECT_EQ(one.rgba, two.rgba);
  }
}

TEST(Maps, PagesAreWholeAtAnyWidth) {
  const Scene scene;
  for (const int width_px : {1, 64, 150}) {
    for (const bool angles_only : {false, true}) {
      const Image page = draw_page(scene, angles_only, width_px);
      EXPECT_EQ(page.width_px, std::max(width_px, 64));
      for (std::size_t i = 3; i < page.rgba.size(); i += 4) ASSERT_EQ(page.rgba[i], 255);
    }
  }
}

TEST(Maps, StopWhenCancelled) {
  const Scene scene;
  RunContext context;
  context.cancel();
  EXPECT_THROW(render_maps(scene.ball, scene.surface, scene.film, scene.map, {}, context),
               Cancelled);
  EXPECT_THROW(render_angle_map(scene.ball, scene.surface, straight_down_to(25), {}, context),
               Cancelled);
}

TEST(Maps, CaptionNamesBothShares) {
  DipAngles angles;
  angles.downward_mm2 = 200;
  angles.over_limit_mm2 = 50;
  Coverage coverage;
  coverage.film_on_object_mm2 = 90;
  EXPECT_EQ(map_caption(angles, nullptr),
            "25 % of the surface that faces down is steeper than 45\u00b0");
  EXPECT_NE(map_caption(angles, &coverage).find("no film is torn"), std::string::npos);
  coverage.torn_mm2 = 10;
  EXPECT_NE(map_caption(angles, &coverage).find("10 %"), std::string::npos);
}

}  // namespace
}  // namespace hydrodip
