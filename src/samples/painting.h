// A small antialiasing painter for the samples' textures. Private to the samples.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/math.h"
#include "image/image.h"

namespace hydrodip {

// A polyline in millimetres, x to the right and y up as one looks at the printed side.
using Path = std::vector<Vec2>;

// 0xRRGGBB in sRGB, opaque, as linear light.
LinearColor rgb(std::uint32_t hex);

LinearColor mix(const LinearColor& a, const LinearColor& b, double t);

// 0 below `from`, 1 above `to`, smooth in between; from > to turns it round.
double smooth_step(double from, double to, double value);

// Path builders. Curves are flattened finely enough for 20 px/mm.
Path bezier(const Vec2& p0, const Vec2& p1, const Vec2& p2, const Vec2& p3);
// A smooth curve through every point (Catmull-Rom).
Path smooth_curve(const std::vector<Vec2>& points);
Path smooth_loop(const std::vector<Vec2>& points);
Path ellipse(const Vec2& center, double radius_x, double radius_y, double turn_deg = 0);
Path arc(const Vec2& center, double radius, double from_deg, double to_deg);
// From `center` outwards, radius growing linearly to `radius`; ends at angle end_deg.
Path spiral(const Vec2& center, double radius, double end_deg, double turns);
// Parts joined in order (duplicate points are harmless).
Path join(const std::vector<Path>& parts);
Path reversed(Path path);
Path mirrored(Path path);  // x -> -x

// Pixels in linear light over a rectangle of the plane centred at the origin. Every method blends
// over what is there with area coverage at the edges.
class Canvas {
 public:
  using Paint = std::function<LinearColor(const Vec2&)>;  // its alpha counts
  using Radius = std::function<double(double)>;           // of arc-length fraction in [0, 1]

  Canvas(double width_mm, double height_mm, double px_per_mm);

  void fill_all(const Paint& paint);
  // Even-odd interior of a closed path.
  void fill(const Path& path, const Paint& paint);
  void fill(const Path& path, const LinearColor& color);
  // Round-capped line of constant or varying width.
  void stroke(const Path& path, double width_mm, const LinearColor& color);
  void stroke(const Path& path, const Radius& radius_mm, const LinearColor& color);
  // A line that starts at width_mm and runs out to a point.
  void tapering_stroke(const Path& path, double width_mm, const LinearColor& color);
  void dot(const Vec2& center, double radius_mm, const LinearColor& color);
  // Gaussian spot: opacity `strength` at its centre.
  void glow(const Vec2& center, double radius_x, double radius_y, double turn_deg,
            const LinearColor& color, double strength);

  // Restricts everything painted from now on to the inside of a closed path; an empty path lifts
  // the restriction.
  void clip(const Path& path);

  Image image() const;

 private:
  struct Pixels {  // half-open ranges
    int x0, y0, x1, y1;
    int width() const { return x1 - x0; }
  };
  Vec2 to_px(const Vec2& mm) const;
  Vec2 to_mm(int x, int y) const;  // the pixel's centre
  Pixels clamp_to_canvas(const Box2& box_px) const;
  std::vector<float> coverage_of_fill(const Path& path, Pixels& pixels) const;
  void blend(int x, int y, double coverage, const LinearColor& color);

  int width_px_ = 0;
  int height_px_ = 0;
  double px_per_mm_ = 0;
  std::vector<float> rgb_;   // 3 per pixel, row 0 on top
  std::vector<float> clip_;  // one per pixel, or empty
};

}  // namespace hydrodip
