#include "scene.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "base/parallel.h"
#include "camera/board.h"

namespace hydrodip::fixtures {
namespace {

constexpr int kBlock_px = 8;  // within which rays are taken for linear
constexpr int kSamples = 3;   // along each axis of a pixel

double sampled(const SheetPicture& picture, const Vec2& mm) {
  const double x = (mm.x() - picture.upper_left_mm.x()) * picture.px_per_mm - 0.5;
  const double y = (picture.upper_left_mm.y() - mm.y()) * picture.px_per_mm - 0.5;
  if (!(x >= 0 && y >= 0 && x < picture.gray.width_px - 1 && y < picture.gray.height_px - 1))
    return -1;
  const int i = int(x), j = int(y);
  const double a = x - i, b = y - j;
  return (1 - b) * ((1 - a) * picture.gray.at(i, j) + a * picture.gray.at(i + 1, j)) +
         b * ((1 - a) * picture.gray.at(i, j + 1) + a * picture.gray.at(i + 1, j + 1));
}

// Whether a place and what is within some millimetres of it is white.
bool is_white(const SheetPicture& picture, const Vec2& mm) {
  if (picture.inked.empty()) return false;
  const int x = int(std::floor(mm.x() - picture.upper_left_mm.x())),
            y = int(std::floor(picture.upper_left_mm.y() - mm.y()));
  const int height = int(picture.inked.size()) / picture.inked_width;
  // Its edge is not white either.
  if (x < 4 || y < 4 || x >= picture.inked_width - 4 || y >= height - 4) return false;
  return picture.inked[std::size_t(y) * std::size_t(picture.inked_width) + std::size_t(x)] == 0;
}

// From rays to a sheet's own millimetres.
Mat3 ray_to_sheet(const PlacedSheet& sheet, const Pose& camera) {
  const Pose to_camera = camera * sheet.pose;
  Mat3 plane;
  plane << to_camera.rotation().leftCols<2>(), to_camera.shift;
  Mat3 own = Mat3::Identity();
  own(0, 0) = (sheet.mirrored ? -1 : 1) / sheet.stretch.x();
  own(1, 1) = 1 / sheet.stretch.y();
  return own * plane.inverse();
}

void blur(std::vector<float>& value, int width, int height, double sigma) {
  if (!(sigma > 0)) return;
  const int reach = int(std::ceil(3.5 * sigma));
  std::vector<float> weight;
  float sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    weight.push_back(float(std::exp(-0.5 * k * k / (sigma * sigma))));
    sum += weight.back();
  }
  for (float& w : weight) w /= sum;
  std::vector<float> between(value.size());
  parallel_for(std::size_t(height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < width; ++x) {
        float total = 0;
        for (int k = -reach; k <= reach; ++k)
          total += weight[std::size_t(k + reach)] *
                   value[y * std::size_t(width) + std::size_t(std::clamp(x + k, 0, width - 1))];
        between[y * std::size_t(width) + std::size_t(x)] = total;
      }
  });
  parallel_for(std::size_t(height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      float* row = value.data() + y * std::size_t(width);
      std::fill(row, row + width, 0.0F);
      for (int k = -reach; k <= reach; ++k) {
        const float w = weight[std::size_t(k + reach)];
        const float* from = between.data() +
                            std::size_t(std::clamp(int(y) + k, 0, height - 1)) * std::size_t(width);
        for (int x = 0; x < width; ++x) row[x] += w * from[x];
      }
    }
  });
}

}  // namespace

std::vector<Box2> boxes_on_a4(std::uint32_t job) {
  std::mt19937 random(job);
  std::uniform_real_distribution<double> along(-1, 1), size(4, 16);
  std::vector<Box2> boxes;
  for (int i = 0; i < 40; ++i) {
    const Vec2 from(60 * along(random), 90 * along(random));
    boxes.push_back({from, from + Vec2(size(random), size(random))});
  }
  return boxes;
}

SheetPicture draw_boxes(const std::vector<Box2>& boxes, const Box2& sheet, double px_per_mm) {
  SheetPicture picture;
  picture.px_per_mm = px_per_mm;
  picture.upper_left_mm = {sheet.min.x(), sheet.max.y()};
  const Vec2 size = (sheet.max - sheet.min) * px_per_mm;
  picture.gray = {int(std::ceil(size.x())), int(std::ceil(size.y())), {}};
  GrayImage& gray = picture.gray;
  gray.value.assign(std::size_t(gray.width_px) * std::size_t(gray.height_px), 255);
  for (const Box2& box : boxes) {
    const double x0 = (box.min.x() - sheet.min.x()) * px_per_mm,
                 x1 = (box.max.x() - sheet.min.x()) * px_per_mm,
                 y0 = (sheet.max.y() - box.max.y()) * px_per_mm,
                 y1 = (sheet.max.y() - box.min.y()) * px_per_mm;
    const auto cover = [](double a, double b, int at) {
      return std::clamp(b, double(at), at + 1.0) - std::clamp(a, double(at), at + 1.0);
    };
    for (int y = std::max(0, int(y0)); y < std::min<double>(gray.height_px, y1); ++y)
      for (int x = std::max(0, int(x0)); x < std::min<double>(gray.width_px, x1); ++x) {
        std::uint8_t& value =
            gray.value[std::size_t(y) * std::size_t(gray.width_px) + std::size_t(x)];
        const double left = 255 * (1 - cover(x0, x1, x) * cover(y0, y1, y));
        value = std::min(value, std::uint8_t(std::lround(left)));
      }
  }
  find_ink(picture);
  return picture;
}

void find_ink(SheetPicture& picture) {
  const GrayImage& gray = picture.gray;
  picture.inked_width = int(std::ceil(gray.width_px / picture.px_per_mm));
  const int height = int(std::ceil(gray.height_px / picture.px_per_mm));
  picture.inked.assign(std::size_t(picture.inked_width) * std::size_t(height), 0);
  std::vector<std::uint8_t> own = picture.inked;
  for (int y = 0; y < gray.height_px; ++y)
    for (int x = 0; x < gray.width_px; ++x)
      if (gray.at(x, y) < 250)
        own[std::size_t(y / picture.px_per_mm) * std::size_t(picture.inked_width) +
            std::size_t(x / picture.px_per_mm)] = 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < picture.inked_width; ++x)
      for (int j = std::max(0, y - 3); j <= std::min(height - 1, y + 3); ++j)
        for (int i = std::max(0, x - 3); i <= std::min(picture.inked_width - 1, x + 3); ++i)
          if (own[std::size_t(j) * std::size_t(picture.inked_width) + std::size_t(i)])
            picture.inked[std::size_t(y) * std::size_t(picture.inked_width) + std::size_t(x)] = 1;
}

SheetPicture draw_marks(const std::vector<MarkPlace>& marks, const Box2& sheet, double px_per_mm) {
  std::vector<Box2> boxes;
  for (const MarkPlace& mark : marks)
    for (const Box2& box : mark_boxes(mark)) boxes.push_back(box);
  return draw_boxes(boxes, sheet, px_per_mm);
}

GrayImage photograph(const Scene& scene) {
  const int width = scene.width_px, height = scene.height_px;
  std::vector<Mat3> to_sheet;
  for (const PlacedSheet& sheet : scene.sheets)
    to_sheet.push_back(ray_to_sheet(sheet, scene.camera));
  std::vector<float> value(std::size_t(width) * std::size_t(height));
  const int rows = (height + kBlock_px - 1) / kBlock_px;
  parallel_for(std::size_t(rows), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int x0 = 0; x0 < width; x0 += kBlock_px) {
        const int y0 = int(row) * kBlock_px;
        std::array<Vec3, 4> ray;
        for (int k = 0; k < 4; ++k)
          ray[std::size_t(k)] =
              scene.lens.ray(Vec2(x0 + kBlock_px * (k % 2), y0 + kBlock_px * (k / 2)));
        // Of one sheet, white.
        const Vec3 mid = 0.25 * (ray[0] + ray[1] + ray[2] + ray[3]);
        bool plain = false, any = false;
        for (std::size_t k = 0; k < to_sheet.size(); ++k) {
          const Vec2 at = (to_sheet[k] * mid).hnormalized();
          const SheetPicture& picture = *scene.sheets[k].picture;
          const Vec2 from = at - picture.upper_left_mm;
          const double px = picture.px_per_mm;
          const bool near = from.x() > -4 && from.y() < 4 &&
                            from.x() < picture.gray.width_px / px + 4 &&
                            -from.y() < picture.gray.height_px / px + 4;
          any = any || near;
          if (near) plain = is_white(picture, at);
        }
        if (plain || !any) {
          for (int y = y0; y < std::min(height, y0 + kBlock_px); ++y)
            for (int x = x0; x < std::min(width, x0 + kBlock_px); ++x)
              value[std::size_t(y) * std::size_t(width) + std::size_t(x)] =
                  float(plain ? scene.light_white : scene.background);
          continue;
        }
        for (int y = y0; y < std::min(height, y0 + kBlock_px); ++y)
          for (int x = x0; x < std::min(width, x0 + kBlock_px); ++x) {
            double sum = 0;
            for (int s = 0; s < kSamples * kSamples; ++s) {
              const int across = s % kSamples, down = s / kSamples;
              const double a = (x - x0 + (across + 0.5) / kSamples) / kBlock_px;
              const double b = (y - y0 + (down + 0.5) / kSamples) / kBlock_px;
              const Vec3 at =
                  (1 - b) * ((1 - a) * ray[0] + a * ray[1]) + b * ((1 - a) * ray[2] + a * ray[3]);
              double shown = scene.background;
              for (std::size_t k = 0; k < to_sheet.size(); ++k) {
                const double white =
                    sampled(*scene.sheets[k].picture, (to_sheet[k] * at).hnormalized());
                if (white >= 0)
                  shown = scene.light_black + (scene.light_white - scene.light_black) * white / 255;
              }
              sum += shown;
            }
            value[std::size_t(y) * std::size_t(width) + std::size_t(x)] =
                float(sum / (kSamples * kSamples));
          }
      }
  });
  blur(value, width, height, scene.blur_px);
  GrayImage image{width, height, std::vector<std::uint8_t>(value.size())};
  parallel_for(std::size_t(height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      std::minstd_rand random(scene.seed * 7919U + unsigned(y) + 1);
      std::normal_distribution<float> noise(0, float(std::max(1e-9, scene.noise)));
      for (int x = 0; x < width; ++x) {
        double light = value[y * std::size_t(width) + std::size_t(x)] *
                       (1 + scene.shade.x() * (double(x) / width - 0.5) +
                        scene.shade.y() * (double(y) / height - 0.5));
        for (const Glare& glare : scene.glare)
          light +=
              glare.strength * std::exp(-0.5 * (Vec2(x, double(y)) - glare.at_px).squaredNorm() /
                                        (glare.radius_px * glare.radius_px));
        image.value[y * std::size_t(width) + std::size_t(x)] =
            std::uint8_t(std::clamp(light + double(noise(random)), 0.0, 255.0));
      }
    }
  });
  return image;
}

Lens phone_lens() { return {2950, {2012, 1489}, -0.045, 0.018, 0.0006, -0.0004}; }

Pose look_at(const Vec3& eye, const Vec3& target, double roll_deg) {
  const Vec3 ahead = (target - eye).normalized();
  const Vec3 right = ahead.cross(Vec3::UnitY()).normalized();
  Mat3 rotation;  // rows: the camera's axes
  rotation.row(0) = right;
  rotation.row(1) = ahead.cross(right);
  rotation.row(2) = ahead;
  rotation =
      Eigen::AngleAxisd(roll_deg * std::numbers::pi / 180, Vec3::UnitZ()).toRotationMatrix() *
      rotation;
  return Pose::of(rotation, -(rotation * eye));
}

SyntheticTank synthetic_tank(bool draw) {
  SyntheticTank tank;
  const auto place = [&](double x, double y, double turn_deg, const Vec3& lean) {
    const Mat3 turn = (Eigen::AngleAxisd(turn_deg * std::numbers::pi / 180, Vec3::UnitZ()) *
                       Eigen::AngleAxisd(lean.norm(), lean.normalized()))
                          .toRotationMatrix();
    tank.strip.push_back(Pose::of(turn, Vec3(x, y, 0)));
  };
  place(-40, 170, 0.3, Vec3(0.01, 0.004, 0));
  place(216, 10, 90.5, Vec3(-0.006, 0.01, 0));
  place(30, -171, 179.6, Vec3(0.008, -0.003, 0));
  place(-215, -12, -89.7, Vec3(0.002, 0.012, 0));
  if (!draw) return tank;
  for (int strip = 0; strip < int(tank.strip.size()); ++strip) {
    Box2 sheet;
    sheet.add(0.5 * Vec2(kStripLength_mm, kStripHeight_mm) + Vec2(2, 2));
    sheet.add(-0.5 * Vec2(kStripLength_mm, kStripHeight_mm) - Vec2(2, 2));
    tank.picture.push_back(draw_marks(strip_marks(strip), sheet, 12));
  }
  return tank;
}

std::vector<PlacedSheet> SyntheticTank::sheets() const {
  std::vector<PlacedSheet> sheets;
  for (std::size_t k = 0; k < picture.size(); ++k) sheets.push_back({&picture[k], strip[k]});
  return sheets;
}

std::vector<SeenMark> SyntheticTank::seen(const Lens& lens, const Pose& camera, double noise_px,
                                          std::mt19937& random) const {
  std::normal_distribution<double> noise(0, noise_px);
  std::vector<SeenMark> marks;
  for (int k = 0; k < int(strip.size()); ++k)
    for (const MarkPlace& mark : strip_marks(k)) {
      const Vec3 at = camera * (strip[std::size_t(k)] * Vec3(mark.corner.x(), mark.corner.y(), 0));
      const Vec2 px = lens.project(at) + Vec2(noise(random), noise(random));
      marks.push_back({mark.id, px, 8});
    }
  return marks;
}

Pose random_view(std::mt19937& random, double tilt_deg) {
  std::uniform_real_distribution<double> any(-1, 1);
  const double tilt = std::tan(tilt_deg * std::numbers::pi / 180), high = 500 + 30 * any(random);
  const Vec3 eye(high * tilt * any(random), high * tilt * any(random), high);
  return look_at(eye, Vec3(10 * any(random), 10 * any(random), 0), 8 * any(random));
}

}  // namespace hydrodip::fixtures
