#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "laid_film.h"
#include "render/preview.h"
#include "render/text.h"
#include "render/view.h"

namespace hydrodip {
namespace {

using fixtures::film_under_ball;
using fixtures::two_coloured_ball;

Image draw(const DippedFilm& film, bool same, const std::string& caption = "caption") {
  const Object ball = two_coloured_ball();
  const Surface surface(ball.positions, ball.triangles);
  Appearance appearance;
  appearance.wanted = [&](const SurfacePoint& p, const Vec3&, const Vec3&) {
    return ball.materials[std::size_t(ball.material_of[std::size_t(p.triangle)])].base_color;
  };
  if (same) appearance.predicted = appearance.wanted;
  PreviewOptions options;
  options.width_px = 320;
  RunContext context;
  return render_previews(ball, surface, film, {{.shown = appearance, .caption = caption}}, options,
                         context)
      .front();
}

// Pixels in which one channel stands far above the two others.
long count_pure(const Image& image, int x0, int x1, std::size_t channel) {
  long count = 0;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = x0; x < x1; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      if (p[channel] > 60 + p[(channel + 1) % 3] && p[channel] > 60 + p[(channel + 2) % 3]) ++count;
    }
  }
  return count;
}

TEST(Preview, ShowsBothColoursOnTheirSides) {
  const Image image = draw(film_under_ball(), false);
  ASSERT_EQ(image.width_px, 320);
  const long red = count_pure(image, 0, 160, 0);
  const long blue = count_pure(image, 0, 160, 2);
  EXPECT_GT(red, 3000);
  EXPECT_GT(blue, 3000);
  // Nothing was predicted: the right half shows the bare ball.
  EXPECT_EQ(count_pure(image, 160, 320, 0) + count_pure(image, 160, 320, 2), 0);
}

TEST(Preview, SeenFromTheFilmsSideNotMirrored) {
  // From below, with y up, the object's -x (red) lies on the viewer's right.
  const Image image = draw(film_under_ball(), false);
  const int row = image.height_px / 4;
  long red_x = 0;
  long blue_x = 0;
  long reds = 0;
  long blues = 0;
  for (int x = 0; x < 160; ++x) {
    const std::uint8_t* p = image.pixel(x, row);
    if (p[0] > 60 + p[2]) red_x += x, ++reds;
    if (p[2] > 60 + p[0]) blue_x += x, ++blues;
  }
  ASSERT_GT(reds, 10);
  ASSERT_GT(blues, 10);
  EXPECT_GT(double(red_x) / double(reds), double(blue_x) / double(blues));
}

TEST(Preview, EqualAppearancesGiveEqualPictures) {
  const Image image = draw(film_under_ball(), true);
  const int margin = 6;    // of 1600 wide: 28
  const int offset = 155;  // from one column to the next
  for (int y = 20; y < image.height_px - 20; ++y) {
    for (int x = margin; x < 156; ++x) {
      for (int c = 0; c < 4; ++c) {
        ASSERT_EQ(image.pixel(x, y)[c], image.pixel(x + offset, y)[c]) << x << ", " << y;
      }
    }
  }
}

TEST(Preview, SameBytesWithOneAndTwoThreads) {
  Image one, two;
  {
    const ThreadLimit limit(1);
    one = draw(film_under_ball(), false);
  }
  {
    const ThreadLimit limit(2);
    two = draw(film_under_ball(), false);
  }
  EXPECT_EQ(one.rgba, two.rgba);
}

TEST(Preview, WithoutFilmStillShowsTheObject) {
  const Image image = draw(film_under_ball(-1), false);
  EXPECT_GT(count_pure(image, 0, 160, 0) + count_pure(image, 0, 160, 2), 3000);
}

TEST(Preview, EveryPixelIsOpaque) {
  const Image image = draw(film_under_ball(), false);
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) ASSERT_EQ(image.rgba[i], 255);
}

TEST(Preview, StopsWhenCancelled) {
  const Object ball = two_coloured_ball(4);
  const Surface surface(ball.positions, ball.triangles);
  RunContext context;
  context.cancel();
  EXPECT_THROW(render_previews(ball, surface, film_under_ball(), {{}}, {}, context), Cancelled);
}

TEST(View, FirstDirectionFacesTheFilm) {
  const Object ball = two_coloured_ball();
  const Surface surface(ball.positions, ball.triangles);
  const auto [first, second] = telling_directions(ball, surface, film_under_ball());
  EXPECT_LT(first.z(), -0.9);
  EXPECT_NEAR(first.norm(), 1, 1e-12);
  EXPECT_NEAR(second.norm(), 1, 1e-12);
  EXPECT_LT(first.dot(second), std::cos(30 * std::numbers::pi / 180));
}

TEST(View, CameraSeesTheWholeObject) {
  const Object ball = two_coloured_ball();
  for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(1, 2, 3), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
    const Camera camera = frame_object(ball, direction, 1.5, 0.8);
    double most = 0;
    for (const Vec3& p : ball.positions) {
      const Vec3 d = p - camera.eye;
      const double depth = -d.dot(camera.back);
      ASSERT_GT(depth, 0);
      most = std::max({most, std::abs(d.dot(camera.right)) / (depth * camera.half_width),
                       std::abs(d.dot(camera.up)) / (depth * camera.half_height)});
    }
    EXPECT_NEAR(most, 0.8, 1e-9);
    EXPECT_NEAR(camera.right.cross(camera.up).dot(camera.back), 1, 1e-9);
  }
}

TEST(Text, WidthIsTheSumOfItsParts) {
  TextStyle style;
  const double gap = text_width_px("aa", style) - 2 * text_width_px("a", style);
  EXPECT_NEAR(text_width_px("ab", style),
              text_width_px("a", style) + text_width_px("b", style) + gap, 1e-9);
  EXPECT_EQ(text_width_px("", style), 0);
}

TEST(Text, FitsWithDots) {
  TextStyle style;
  const std::string text(200, 'm');
  const std::string cut = fit_text(text, style, 300);
  EXPECT_LE(text_width_px(cut, style), 300);
  EXPECT_EQ(cut.substr(cut.size() - 3), "...");
  EXPECT_EQ(fit_text("short", style, 300), "short");
  const std::vector<std::string> lines =
      fit_lines("one two three four", style, text_width_px("one two three", style) + 1, 2);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], "one two three");
  EXPECT_EQ(lines[1], "four");
  EXPECT_EQ(fit_lines("short", style, 300, 2).size(), 1U);
  EXPECT_LE(text_width_px(fit_lines(text, style, 300, 2).back(), style), 300);
}

TEST(Text, AnyBytesAreDrawnWithinThePicture) {
  Image image(60, 30);
  for (std::uint8_t& byte : image.rgba) byte = 255;
  std::string all;
  for (int c = 1; c < 256; ++c) all += char(c);
  draw_text(image, all, -40, 20, {});
  draw_text(image, "\xe2\x82", 10, 20, {});
  EXPECT_NE(*std::min_element(image.rgba.begin(), image.rgba.end()), 255);
}

TEST(Text, EveryPrintableCharacterLeavesInk) {
  for (char c = '!'; c <= '~'; ++c) {
    Image image(40, 40);
    for (std::uint8_t& byte : image.rgba) byte = 255;
    draw_text(image, std::string(1, c), 8, 30, {});
    EXPECT_LT(*std::min_element(image.rgba.begin(), image.rgba.end()), 100) << c;
  }
}

}  // namespace
}  // namespace hydrodip
