#include "render/lit_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "render/lit_pixels.h"

namespace hydrodip {
namespace {

// Light levels are chosen so that a white surface facing the lamp comes out just below white.
constexpr double kSkyAbove = 0.56;
constexpr double kSkyBelow = 0.30;
constexpr double kLamp = 0.46;
constexpr double kFill = 0.07;

// Where pixels differ, one shows besides its centre's what these places of it show: together no two
// in the same fifth of its width or height, so that edges along either come out in five grades.
constexpr std::array<std::array<double, 2>, 4> kRooks = {
    {{0.3, 0.1}, {0.9, 0.3}, {0.1, 0.7}, {0.7, 0.9}}};

struct Shade {
  std::array<float, 3> wanted{};
  std::array<float, 3> predicted{};
};

// One pair of appearances in that light.
class Painter {
 public:
  Painter(const LitPixels& pixels, const Appearance& appearance, const Shading& shading)
      : pixels_(pixels), camera_(pixels.camera()), appearance_(appearance), shading_(shading) {}

  ViewPair run() {
    shade_centres();
    refine_edges();
    return {picture(&Shade::wanted), picture(&Shade::predicted)};
  }

 private:
  // A pale grey sweep, lighter in the middle, with the object's shadow on it.
  Shade backdrop(double x_px, double y_px) const {
    const double x = (x_px - 0.5 * pixels_.width()) / pixels_.width();
    const double y = (y_px - 0.45 * pixels_.height()) / pixels_.height();
    const double glow = std::exp(-2.2 * (x * x + y * y));
    const Light light = pixels_.ground_at(x_px, y_px);
    const double shadow = 0.62 * light.sky + 0.38 * (0.35 + 0.65 * light.lamp);
    const double level = (0.50 + 0.27 * glow) * (0.25 + 0.75 * shadow);
    Shade shade;
    shade.wanted = {float(level * 0.985), float(level * 0.995), float(level * 1.01)};
    shade.predicted = shade.wanted;
    return shade;
  }

  Shade shade(const SeenPoint& s, const Light& light) const {
    const Vec3 n = smooth_normal(shading_.normals, s);
    const double sky =
        kSkyBelow + (kSkyAbove - kSkyBelow) * (0.5 + 0.5 * n.dot(pixels_.ground_normal()));
    const double lit_level = sky * (0.12 + 0.88 * light.sky) +
                             kLamp * std::max(0.0, n.dot(pixels_.lamp())) * light.lamp +
                             kFill * std::max(0.0, n.dot(camera_.back));
    const double level = lit_level + shading_.flatness * (1 - lit_level);
    const Vec3 p = pixels_.position(s);
    const Vec3 normal = face_normal(pixels_.object().mesh, s.triangle);
    const SurfacePoint point = s.point();
    const auto lit = [&](const LinearColor& c) {
      const float f = float(level);
      return std::array<float, 3>{f * c.r, f * c.g, f * c.b};
    };
    return {lit(appearance_.wanted(point, p, normal)),
            lit(appearance_.predicted(point, p, normal))};
  }

  void shade_centres() {
    shade_.resize(pixels_.count());
    pixels_.for_rows([&](int y) {
      for (int x = 0; x < pixels_.width(); ++x) {
        const SeenPoint& s = pixels_.centre(x, y);
        shade_[pixels_.at(x, y)] =
            s.triangle < 0 ? backdrop(x + 0.5, y + 0.5) : shade(s, pixels_.light(x, y));
      }
    });
  }

  // Whether a pixel differs from a neighbour by more than a barely visible step.
  bool busy(const std::vector<Shade>& shades, int x, int y) const {
    const auto differs = [](const std::array<float, 3>& a, const std::array<float, 3>& b) {
      float most = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        most = std::max(most, std::abs(a[c] - b[c]) / (0.1f + a[c] + b[c]));
      }
      return most > 0.035f;
    };
    const std::size_t self = pixels_.at(x, y);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= pixels_.width() || y + dy >= pixels_.height())
          continue;
        const std::size_t other = pixels_.at(x + dx, y + dy);
        if ((pixels_.centre(x, y).triangle < 0) != (pixels_.centre(x + dx, y + dy).triangle < 0))
          return true;
        if (pixels_.centre(x, y).triangle < 0) continue;
        if (differs(shades[self].wanted, shades[other].wanted)) return true;
        if (differs(shades[self].predicted, shades[other].predicted)) return true;
      }
    }
    return false;
  }

  void refine_edges() {
    if (!shading_.smooth_edges) return;
    const std::vector<Shade> single = shade_;
    pixels_.for_rows([&](int y) {
      for (int x = 0; x < pixels_.width(); ++x) {
        if (busy(single, x, y)) refine(shade_[pixels_.at(x, y)], x, y);
      }
    });
  }

  // The shade of a pixel's centre becomes that of the pixel.
  void refine(Shade& centre, int x, int y) const {
    Shade sum;
    const auto add = [&](const Shade& part) {
      constexpr float kShare = 1.0f / (1 + kRooks.size());
      for (std::size_t c = 0; c < 3; ++c) {
        sum.wanted[c] += std::clamp(part.wanted[c], 0.0f, 1.0f) * kShare;
        sum.predicted[c] += std::clamp(part.predicted[c], 0.0f, 1.0f) * kShare;
      }
    };
    add(centre);
    for (const auto& [dx, dy] : kRooks) {
      const SeenPoint s = pixels_.trace(x + dx, y + dy);
      add(s.triangle < 0 ? backdrop(x + dx, y + dy) : shade(s, pixels_.light_near(s, x, y)));
    }
    centre = sum;
  }

  Image picture(std::array<float, 3> Shade::*part) const {
    Image image(pixels_.width(), pixels_.height());
    for (std::size_t i = 0; i < pixels_.count(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        image.rgba[4 * i + c] = linear_to_srgb8((shade_[i].*part)[c]);
      }
      image.rgba[4 * i + 3] = 255;
    }
    return image;
  }

  const LitPixels& pixels_;
  const Camera& camera_;
  const Appearance& appearance_;
  const Shading shading_;
  std::vector<Shade> shade_;
};

}  // namespace

LitView::LitView(const LitObject& object, const Camera& camera, int width_px, int height_px,
                 const RunContext& context)
    : pixels_(object, camera, width_px, height_px, context) {}

ViewPair LitView::show(const Appearance& appearance) const {
  return show(appearance, {pixels_.object().normals});
}

ViewPair LitView::show(const Appearance& appearance, const Shading& shading) const {
  return Painter(pixels_, appearance, shading).run();
}

}  // namespace hydrodip
