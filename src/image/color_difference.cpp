#include "image/color_difference.h"

#include <cmath>

namespace hydrodip {
namespace {

double lab_root(double t) {
  constexpr double kEdge = 216.0 / 24389;
  return t > kEdge ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}

// In [0, 360); 0 for grey.
double hue_deg(double a, double b) {
  if (a == 0 && b == 0) return 0;
  const double hue = std::atan2(b, a) / kDegree;
  return hue < 0 ? hue + 360 : hue;
}

double seventh_power_share(double chroma) {
  const double power = std::pow(chroma, 7);
  return std::sqrt(power / (power + 6103515625.0));  // 25^7
}

}  // namespace

Vec3 to_cielab(const LinearColor& color) {
  const double r = double(color.r), g = double(color.g), b = double(color.b);
  const double x = lab_root((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
  const double y = lab_root(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
  const double z = lab_root((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double ciede2000(const Vec3& lab1, const Vec3& lab2) {
  const double mean_ab = 0.5 * (std::hypot(lab1[1], lab1[2]) + std::hypot(lab2[1], lab2[2]));
  const double stretch = 1 + 0.5 * (1 - seventh_power_share(mean_ab));
  const double a1 = stretch * lab1[1], a2 = stretch * lab2[1];
  const double c1 = std::hypot(a1, lab1[2]), c2 = std::hypot(a2, lab2[2]);
  const double h1 = hue_deg(a1, lab1[2]), h2 = hue_deg(a2, lab2[2]);
  const bool grey = c1 * c2 == 0;

  double turn = grey ? 0 : h2 - h1;
  if (turn > 180) turn -= 360;
  if (turn < -180) turn += 360;
  double hue = h1 + h2;
  if (!grey) {
    if (std::abs(h1 - h2) > 180) hue += hue < 360 ? 360 : -360;
    hue /= 2;
  }

  const double light = 0.5 * (lab1[0] + lab2[0]), chroma = 0.5 * (c1 + c2);
  const double t = 1 - 0.17 * std::cos((hue - 30) * kDegree) + 0.24 * std::cos(2 * hue * kDegree) +
                   0.32 * std::cos((3 * hue + 6) * kDegree) -
                   0.20 * std::cos((4 * hue - 63) * kDegree);
  const double off = (light - 50) * (light - 50);
  const double dl = (lab2[0] - lab1[0]) / (1 + 0.015 * off / std::sqrt(20 + off));
  const double dc = (c2 - c1) / (1 + 0.045 * chroma);
  const double dh =
      2 * std::sqrt(c1 * c2) * std::sin(0.5 * turn * kDegree) / (1 + 0.015 * chroma * t);
  const double bend = (hue - 275) / 25;
  const double rotation =
      -std::sin(60 * std::exp(-bend * bend) * kDegree) * 2 * seventh_power_share(chroma);
  return std::sqrt(std::max(0.0, dl * dl + dc * dc + dh * dh + rotation * dc * dh));
}

}  // namespace hydrodip
