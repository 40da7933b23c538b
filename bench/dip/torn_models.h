// Models on which film tears: flaps, holes, thin parts, ears and fins.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "dip/zoo_shapes.h"
#include "model_io/load.h"

namespace hydrodip::shapes {

inline Shape moved(Shape shape, const Vec3& by) {
  for (Vec3& p : shape.positions) p += by;
  return shape;
}

inline Shape scaled(Shape shape, const Vec3& by) {
  for (Vec3& p : shape.positions) p = p.cwiseProduct(by).eval();
  return shape;
}

// Largest extent in mm.
inline Shape sized(Shape shape, double size_mm) {
  Box3 box;
  for (const Vec3& p : shape.positions) box.add(p);
  return scaled(std::move(shape), Vec3::Constant(size_mm / box.size().maxCoeff()));
}

inline Shape joined(std::vector<Shape> parts) {
  Shape all;
  for (const Shape& part : parts) all.append(part);
  return all;
}

inline Shape round_plate(double radius, double thickness) {
  return turned({{0, 0}, {radius, 0}, {radius, thickness}, {0, thickness}}, 96);
}

// A round head with two flat ears.
inline Shape head_with_ears() {
  const auto ear = [](double side) {
    return moved(placed(round_plate(13, 3), {90, 0, side * 20}), Vec3(side * 24, 0, 28));
  };
  return joined({full_sphere(24, 80, 100), ear(1), ear(-1)});
}

// A body with a back fin, two side fins and a tail.
inline Shape fish() {
  Shape body = scaled(full_sphere(20, 80, 100), Vec3(2, 0.8, 1));
  return joined({body, box({-20, -1, 34}, {15, 1, 55}), box({-4, -34, 18}, {10, 34, 20}),
                 box({34, -0.8, 4}, {56, 0.8, 40})});
}

inline Shape table() {
  Shape all = box({-35, -25, 30}, {35, 25, 36});
  for (const double x : {-30.0, 24.0})
    for (const double y : {-20.0, 14.0}) all.append(box({x, y, 0}, {x + 6, y + 6, 31}));
  return all;
}

// A plate with square holes.
inline Shape grille() {
  Shape all;
  for (int k = 0; k < 6; ++k) {
    const double at = -38 + 14.0 * k;
    all.append(box({at, -41, 0}, {at + 6, 41, 5}));
    all.append(box({-41, at, 0.5}, {41, at + 6, 5.5}));
  }
  return all;
}

inline Shape gear() {
  Shape all = round_plate(24, 10);
  for (int k = 0; k < 12; ++k) {
    const double a = 2 * M_PI * k / 12;
    all.append(moved(placed(box({-3, -6, 0}, {3, 6, 9}), {0, 0, 180 / M_PI * a - 90}),
                     Vec3(27 * std::cos(a), 27 * std::sin(a), 0.5)));
  }
  return all;
}

// A dome that is open below, with a rim.
inline Shape half_mask() {
  std::vector<Vec2> corners;
  for (int i = 0; i <= 30; ++i)
    corners.push_back({36 * std::sin(M_PI / 2 * i / 30), 30 - 30 * std::cos(M_PI / 2 * i / 30)});
  corners.push_back({42, 31});
  corners.push_back({42, 33});
  corners.push_back({34, 32});
  for (int i = 30; i >= 0; --i)
    corners.push_back({33 * std::sin(M_PI / 2 * i / 30), 31 - 28 * std::cos(M_PI / 2 * i / 30)});
  return turned(corners);
}

inline Shape propeller() {
  Shape all = scaled(full_sphere(9, 60, 80), Vec3(1, 1, 1.4));
  for (int k = 0; k < 3; ++k)
    all.append(moved(placed(box({0, -8, 0}, {38, 8, 2.5}), {35, 0, 120.0 * k}),
                     Vec3(22 * std::cos(2 * M_PI * k / 3), 22 * std::sin(2 * M_PI * k / 3), 6)));
  return all;
}

// A floor with a deep round hole in a block.
inline Shape block_with_hole() {
  return turned({{0, 35}, {12, 35}, {12, 0}, {30, 0}, {30, 40}, {0, 40}});
}

inline Shape handled_pot() {
  return joined({turned({{0, 0}, {20, 0}, {26, 14}, {24, 34}, {18, 40}, {0, 40}}),
                 moved(placed(torus(11, 3, 96, 32), {90, 0, 0}), Vec3(30, 0, 8))});
}

// The generated ones, and those of well-known test shapes that are in the folder (or none).
inline std::vector<Named> torn_models(const std::filesystem::path& folder) {
  std::vector<Named> list;
  for (Named& animal : zoo())
    if (animal.name == "mushroom" || animal.name == "comb of 1 mm fins" ||
        animal.name == "two parts" || animal.name == "cup opening down" ||
        animal.name == "torus lying flat" || animal.name == "scan")
      list.push_back(std::move(animal));
  list.push_back({"head with ears", head_with_ears()});
  list.push_back({"fish", fish()});
  list.push_back({"table", table()});
  list.push_back({"grille", grille()});
  list.push_back({"gear", gear()});
  list.push_back({"half mask", half_mask()});
  list.push_back({"propeller", propeller()});
  list.push_back({"block with hole", block_with_hole()});
  list.push_back({"pot with handle", handled_pot()});
  for (const auto& [name, file] :
       std::vector<std::pair<std::string, std::string>>{{"spot", "spot/spot.obj"},
                                                        {"cheburashka", "shapes/cheburashka.obj"},
                                                        {"suzanne", "shapes/suzanne.obj"},
                                                        {"teapot", "shapes/teapot.obj"},
                                                        {"beetle", "shapes/beetle.obj"}}) {
    if (!std::filesystem::exists(folder / file)) {
      fmt::print(stderr, "{} is left out: there is no {}\n", name, (folder / file).string());
      continue;
    }
    RunContext context;
    const Object object = load_object(folder / file, {}, context).object;
    // Their y is up.
    list.push_back({name, sized(placed({object.positions, object.triangles}, {90, 0, 0}), 80)});
  }
  return list;
}

// Ways to hold them: as they stand, on their head, on the sides, and two tilted.
inline std::vector<Vec3> holds_deg() {
  return {{0, 0, 0}, {180, 0, 0}, {90, 0, 0}, {0, 90, 0}, {35, 20, 10}, {120, -40, 0}};
}

}  // namespace hydrodip::shapes
