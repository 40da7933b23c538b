// What registration reaches on synthetic photos, printers and dips: the figures of
// docs/registration.md. Usage: bench_registration [views [figures]], figures of: loop,
// swelling, dips, views, empty; default: 200 and all.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>

#include "base/error.h"
#include "camera/board.h"
#include "camera/film_pose.h"
#include "camera/tank.h"
#include "loops.h"
#include "scene.h"
#include "sheet/film_marks.h"

namespace hydrodip {
namespace {

using namespace fixtures;

// What is known of the level before a photo, and how a phone's lens differs from photo to photo.
constexpr double kWater_mm = 22, kWaterOff_mm = 0.1;
constexpr double kRefocus = 0.002, kFloat_px = 3;

struct Laid {
  Vec2 shift = Vec2::Zero();
  double turn_deg = 0;
  Vec2 swelling = Vec2::Ones();
  double water_off_mm = 0;
  Vec2 at(const Vec2& u) const {
    return shift + Eigen::Rotation2Dd(turn_deg * std::numbers::pi / 180) * u.cwiseProduct(swelling);
  }
};

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty()
             ? 0
             : values[std::min(values.size() - 1, std::size_t(share * double(values.size())))];
}

// A tank calibrated from twelve rendered photos, and the truth in its frame.
struct Bench {
  SyntheticTank truth = synthetic_tank(true);
  SheetPicture film;
  std::vector<MarkPlace> marks = film_marks(210, 297, 10);
  Tank tank;
  Pose to_found;  // truth's frame to the calibration's

  explicit Bench(std::uint32_t seed) {
    Box2 sheet;
    sheet.add(Vec2(105, 148.5));
    sheet.add(Vec2(-105, -148.5));
    film = draw_marks(marks, sheet);
    std::mt19937 random(seed);
    std::vector<SeenPhoto> photos;
    for (int n = 0; n < 12; ++n) {
      Scene scene = scene_of(random_view(random, 28), seed + unsigned(n), 0);
      scene.sheets = truth.sheets();
      photos.push_back({fmt::format("board {}", n), find_marks(photograph(scene), RunContext())});
    }
    tank = calibrate_tank(photos, 4000, 3000, RunContext());
    tank.water_below_mm = kWater_mm;
    Eigen::Matrix3Xd from(3, Eigen::Index(tank.corner_mm.size())), to = from;
    Eigen::Index i = 0;
    for (const auto& [id, corner] : tank.corner_mm) {
      const StripPlace at = strip_place(id);
      from.col(i) = truth.strip[std::size_t(at.strip)] * Vec3(at.corner.x(), at.corner.y(), 0);
      to.col(i++) = corner;
    }
    const Eigen::Matrix4d move = Eigen::umeyama(from, to, false);
    to_found = Pose::of(Mat3(move.topLeftCorner<3, 3>()), Vec3(move.topRightCorner<3, 1>()));
    fmt::print("camera: {} corners, {:.3f} px rms, focal length {:.2f} (true {:.2f}) px\n",
               tank.corner_mm.size(), tank.rms_px, tank.lens.focal_px, phone_lens().focal_px);
  }

  // `refocus` 0: the lens as it was calibrated.
  Scene scene_of(const Pose& camera, std::uint32_t seed, double refocus = 1) const {
    std::mt19937 random(seed * 31 + 7);
    std::uniform_real_distribution<double> any(-1, 1);
    Scene scene;
    std::normal_distribution<double> chance(0, 1);
    scene.lens = phone_lens();
    scene.lens.focal_px *= 1 + kRefocus * refocus * chance(random);
    scene.lens.center_px += kFloat_px * refocus * Vec2(chance(random), chance(random));
    scene.camera = camera;
    scene.shade = {0.4 * any(random), 0.4 * any(random)};
    for (int k = 0; k < 3; ++k)
      scene.glare.push_back({{2000 + 1500 * any(random), 1500 + 1100 * any(random)},
                             70 + 50 * any(random),
                             150 + 80 * any(random)});
    scene.blur_px = 0.8 + 0.3 * any(random);
    scene.noise = 3;
    scene.seed = seed;
    return scene;
  }

  PlacedSheet laid(const Laid& film_lies, bool mirrored = false) const {
    const Pose lies{
        Vec3(0, 0, film_lies.turn_deg * std::numbers::pi / 180),
        Vec3(film_lies.shift.x(), film_lies.shift.y(), -kWater_mm + film_lies.water_off_mm)};
    return {&film, to_found.inverse() * lies, film_lies.swelling, mirrored};
  }

  FilmPose find(const Scene& scene) const {
    return find_film(photograph(scene), "photo", tank, {marks, kWaterOff_mm, 1, false},
                     RunContext());
  }
};

Laid random_laid(std::mt19937& random) {
  std::normal_distribution<double> chance(0, 1);
  std::uniform_real_distribution<double> any(0, 1);
  return {{chance(random), chance(random)},
          chance(random),
          {1 + 0.03 * any(random), 1 + 0.03 * any(random)},
          kWaterOff_mm * chance(random)};
}

void views(const Bench& bench, int count) {
  std::mt19937 random(11);
  std::vector<double> shift, turn, swelling, sigma;
  int failed = 0, untold_mirror = 0, untold_turn = 0;
  for (int n = 0; n < count; ++n) {
    const Laid laid = random_laid(random);
    Scene scene = bench.scene_of(random_view(random), unsigned(n) + 1000);
    scene.sheets = bench.truth.sheets();
    scene.sheets.push_back(bench.laid(laid));
    try {
      const FilmPose pose = bench.find(scene);
      shift.push_back((pose.shift_mm - laid.shift).norm());
      turn.push_back(std::abs(pose.turn_deg - laid.turn_deg));
      swelling.push_back((pose.swelling - laid.swelling).cwiseAbs().maxCoeff());
      for (int k = 0; k < 2; ++k)
        sigma.push_back(std::abs(pose.shift_mm[k] - laid.shift[k]) / pose.shift_sigma_mm[k]);
    } catch (const InputError& error) {
      ++failed;
      fmt::print("view {}: {}\n", n, error.what());
    }
    // Every tenth view again, upside down and turned.
    if (n % 10 != 0) continue;
    for (const bool mirrored : {true, false}) {
      Laid wrong = laid;
      if (!mirrored) wrong.turn_deg += n % 20 == 0 ? 180 : 90;
      scene.sheets.back() = bench.laid(wrong, mirrored);
      std::string said;
      try {
        bench.find(scene);
      } catch (const InputError& error) {
        said = error.what();
      }
      const bool told = said.find(mirrored ? "upside down" : "turned by") != std::string::npos;
      (mirrored ? untold_mirror : untold_turn) += !told;
    }
  }
  fmt::print(
      "{} views, {} of them refused\n"
      "  shift    median {:.3f}, p95 {:.3f}, worst {:.3f} mm (goal: 0.1 at p95)\n"
      "  turn     median {:.4f}, p95 {:.4f}, worst {:.4f} deg (goal: 0.05 at p95)\n"
      "  swelling median {:.4f}, p95 {:.4f}, worst {:.4f} % (goal: 0.1)\n"
      "  error over its stated standard deviation, rms: {:.2f}\n"
      "  upside down or turned film in {} views each: {} and {} not told (goal: 0)\n",
      count, failed, percentile(shift, 0.5), percentile(shift, 0.95), percentile(shift, 1),
      percentile(turn, 0.5), percentile(turn, 0.95), percentile(turn, 1),
      100 * percentile(swelling, 0.5), 100 * percentile(swelling, 0.95),
      100 * percentile(swelling, 1),
      [&] {
        double sum = 0;
        for (const double s : sigma) sum += s * s / double(sigma.size());
        return std::sqrt(sum);
      }(),
      (count + 9) / 10, untold_mirror, untold_turn);
}

// No film, but tags of all kinds lying about, those of sheets among them.
void empty_views(const Bench& bench, int count) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> any(-1, 1);
  int wrong = 0;
  for (int n = 0; n < count; ++n) {
    std::vector<SheetPicture> tags(12);
    Scene scene = bench.scene_of(random_view(random), unsigned(n) + 5000);
    scene.sheets = bench.truth.sheets();
    for (std::size_t k = 0; k < tags.size(); ++k) {
      const int id = k < 8 ? bench.marks[(k + std::size_t(n)) % bench.marks.size()].id
                           : int(random() % kTagCount);
      const MarkPlace mark{id, Vec2::Zero(), Vec2::UnitX(), 0.6 + 0.3 * std::abs(any(random))};
      Box2 sheet = mark_outline(mark);
      sheet.min -= Vec2(3, 3);
      sheet.max += Vec2(3, 3);
      tags[k] = draw_marks({mark}, sheet);
      scene.sheets.push_back(
          {&tags[k], Pose{Vec3(0, 0, 3.1 * any(random)),
                          Vec3(100 * any(random), 140 * any(random), -kWater_mm)}});
    }
    try {
      bench.find(scene);
      ++wrong;
    } catch (const InputError&) {
    }
  }
  fmt::print("{} views without film, with foreign tags: film found in {} (goal: 0)\n", count,
             wrong);
}

// Every dip's film lies off by chance; the frame, or the object, is moved by what one photo says.
void dips(const Bench& bench, int count) {
  std::mt19937 random(13);
  std::normal_distribution<double> chance(0, 1);
  std::vector<double> before, after;
  for (int n = 0; n < count; ++n) {
    Laid laid{{chance(random), chance(random)},
              chance(random),
              {1.025, 1.015},
              kWaterOff_mm * chance(random)};
    Scene scene = bench.scene_of(random_view(random), unsigned(n) + 9000);
    scene.sheets = bench.truth.sheets();
    scene.sheets.push_back(bench.laid(laid));
    FilmPose pose;
    try {
      pose = bench.find(scene);
    } catch (const InputError& error) {
      fmt::print("dip {}: {}\n", n, error.what());
      after.push_back(1e3);
      continue;
    }
    const Laid meant{Vec2::Zero(), 0, pose.swelling}, plain{Vec2::Zero(), 0, laid.swelling};
    // What lands where the object is, 60 mm around the middle.
    double worst_before = 0, worst_after = 0;
    const Eigen::Rotation2Dd back(-pose.turn_deg * std::numbers::pi / 180);
    for (int k = 0; k < 12; ++k) {
      const Vec2 u =
          60 * Vec2(std::cos(k * std::numbers::pi / 6), std::sin(k * std::numbers::pi / 6));
      worst_before = std::max(worst_before, (laid.at(u) - plain.at(u)).norm());
      worst_after =
          std::max(worst_after, (back * (laid.at(u) - pose.shift_mm) - meant.at(u)).norm());
    }
    before.push_back(worst_before);
    after.push_back(worst_after);
  }
  fmt::print(
      "{} dips, film off by 1 mm and 1 degree (standard deviations); worst landed error "
      "within 60 mm of the middle\n  without camera p95 {:.2f} mm; with it median {:.3f}, p95 "
      "{:.3f} mm "
      "(goal: 0.15)\n",
      count, percentile(before, 0.95), percentile(after, 0.5), percentile(after, 0.95));
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  using namespace hydrodip;
  const int count = argc > 1 ? std::atoi(argv[1]) : 200;
  const std::string figures = argc > 2 ? argv[2] : "loop,swelling,dips,views,empty";
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  if (figures.find("loop") != std::string::npos) closed_loop();
  if (figures.find("swelling") != std::string::npos) swollen_film();
  const bool photos = figures.find("dips") != std::string::npos ||
                      figures.find("views") != std::string::npos ||
                      figures.find("empty") != std::string::npos;
  if (!photos) return 0;
  fmt::print(
      "All photos are synthetic: rendered with lens distortion, perspective, blur, noise, "
      "glare and uneven light.\n");
  const Bench bench(1);
  if (figures.find("dips") != std::string::npos) dips(bench, std::min(count, 50));
  if (figures.find("views") != std::string::npos) views(bench, count);
  if (figures.find("empty") != std::string::npos) empty_views(bench, count);
  return 0;
}
