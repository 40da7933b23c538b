// The mask's painted side: porcelain skin, a harlequin and a filigree half, gold lines fine enough
// to show how well a print registers. All coordinates in mm as one looks at the face.
#include <cmath>
#include <numbers>

#include "samples/painting.h"
#include "samples/parts.h"

namespace hydrodip {
namespace {

constexpr double kPxPerMm = 16;
constexpr double kPi = std::numbers::pi;

struct Palette {
  LinearColor porcelain = rgb(0xf6ebdc), warm = rgb(0xe6c9b0), rose = rgb(0xd9475f);
  LinearColor gold = rgb(0xc08a24), pale_gold = rgb(0xf0cf7a), dark_gold = rgb(0x7d5312);
  LinearColor teal = rgb(0x0d6670), night = rgb(0x10264a), plum = rgb(0x6d1f4f);
  LinearColor ink = rgb(0x1c1418), brown = rgb(0x4a2a22), white = rgb(0xffffff);
  LinearColor red = rgb(0xb0122c), dark_red = rgb(0x64091c), pink = rgb(0xf3a0a4);
};

LinearColor with_alpha(LinearColor color, double alpha) {
  color.a = float(alpha);
  return color;
}

Path closed(Path path) {
  path.push_back(path.front());
  return path;
}

Path outline(double radius) {
  Path path;
  for (int i = 0; i < 360; ++i) path.push_back(mask_point(radius, i * kPi / 180));
  return path;
}

Path diamond(const Vec2& center, double half_width, double half_height) {
  return {center + Vec2(half_width, 0), center + Vec2(0, half_height), center - Vec2(half_width, 0),
          center - Vec2(0, half_height)};
}

// A pointed drop from `root` to its round end around `center`.
Path drop(const Vec2& root, const Vec2& center, double radius) {
  const Vec2 away = (center - root).normalized();
  const Vec2 side(-away.y(), away.x());
  const Vec2 left = center + radius * side, right = center - radius * side;
  const Vec2 tip = center + radius * away;
  const double k = 0.55 * radius;
  return join({bezier(root, root + 0.45 * (center - root), left - 1.2 * k * away, left),
               bezier(left, left + k * away, tip + k * side, tip),
               bezier(tip, tip - k * side, right + k * away, right),
               bezier(right, right - 1.2 * k * away, root + 0.45 * (center - root), root)});
}

// A leaf from root to tip, bulging to both sides.
Path leaf(const Vec2& root, const Vec2& tip, double width) {
  const Vec2 along = tip - root, side = Vec2(-along.y(), along.x()).normalized() * width;
  return join(
      {bezier(root, root + 0.3 * along + side, root + 0.7 * along + side, tip),
       bezier(tip, root + 0.7 * along - 0.3 * side, root + 0.3 * along - 0.3 * side, root)});
}

using Decorator = std::function<Path(const Path&)>;  // the identity or mirrored()

void paint_skin(Canvas& canvas, const Palette& p) {
  canvas.fill_all([&](const Vec2& at) {
    const double r = mask_radius(at);
    return mix(p.porcelain, p.warm, 0.75 * smooth_step(0.55, 1.05, r));
  });
  for (const double side : {-1.0, 1.0}) {
    canvas.glow({side * 31, -13}, 9.5, 8.0, side * -20, p.rose, 0.46);
    canvas.glow({side * 9.5, -13}, 2.6, 8, side * 12, p.warm, 0.5);        // beside the nose
    canvas.glow({side * 4.1, -23.2}, 1.7, 0.8, side * 18, p.brown, 0.75);  // nostrils
    canvas.glow({side * 9.8, -21}, 1.2, 2.0, side * 20, p.brown, 0.25);
  }
  canvas.glow({0, -14}, 3.4, 3.0, 0, p.rose, 0.14);
  canvas.glow({0, -16}, 1.6, 1.2, 0, p.white, 0.35);
  canvas.glow({0, -48.3}, 7, 1.6, 0, p.warm, 0.6);
  canvas.glow({0, -28}, 1.4, 3.2, 0, p.warm, 0.6);
  canvas.glow({0, -54.5}, 6, 4, 0, p.rose, 0.12);
}

// ---- the painted half-mask around the eyes ----

Path domino_half() {  // viewer's right, from the middle above to the middle below
  return join({bezier({0, 22}, {4, 29}, {13, 32}, {23, 31}),
               bezier({23, 31}, {33, 30}, {39, 33}, {44.5, 40}),
               bezier({44.5, 40}, {45.5, 30}, {45, 19}, {41.5, 8}),
               bezier({41.5, 8}, {39, -1}, {31, -5}, {23, -4.5}),
               bezier({23, -4.5}, {14, -4}, {10.5, 2}, {7, 6}),
               bezier({7, 6}, {4.5, 8.5}, {2, 8.5}, {0, 7})});
}

Path domino() { return join({domino_half(), reversed(mirrored(domino_half()))}); }

void fill_filigree_half(Canvas& canvas, const Palette& p) {
  canvas.fill(domino(), [&](const Vec2& at) {
    const double t = smooth_step(8, 46, std::abs(at.x()) + 0.25 * (at.y() - 12));
    return mix(p.teal, p.night, t);
  });
}

void fill_harlequin_half(Canvas& canvas, const Palette& p) {
  const LinearColor colors[4] = {p.plum, p.porcelain, p.teal, rgb(0xe3a63a)};
  const double step_x = 5.2, step_y = 7.8;
  canvas.clip(join({{{0, 22}}, domino_half(), {{0, 7}}}));
  for (int i = 0; i < 24; ++i)
    for (int j = -8; j < 16; ++j) {
      if ((i + j) % 2 != 0) continue;
      const Vec2 center(i * step_x / 2, 12 + j * step_y / 2);
      const int which = ((i - j) / 2 % 2 + 2) % 2 + 2 * (((i + j) / 2 % 2 + 2) % 2);
      canvas.fill(diamond(center, step_x / 2, step_y / 2), colors[which]);
    }
  for (int k = -24; k < 40; ++k) {
    const double y = 12 + (k + 0.5) * step_y;
    const double slope = step_y / step_x;
    canvas.stroke({{0, y}, {50, y + 50 * slope}}, 0.32, p.pale_gold);
    canvas.stroke({{0, y}, {50, y - 50 * slope}}, 0.32, p.pale_gold);
  }
  canvas.clip({});
}

void paint_filigree(Canvas& canvas, const Palette& p) {
  canvas.clip(domino());
  const auto curl = [&](const Vec2& center, double radius, double end_deg, double turns,
                        const Vec2& c1, const Vec2& c2, const Vec2& root, double width) {
    const Path head = spiral(center, radius, end_deg, turns);
    const Path line = join({head, bezier(head.back(), c1, c2, root)});
    canvas.stroke(
        line, [&](double t) { return width * (0.32 + 0.68 * std::sin(kPi * t)) / 2; }, p.pale_gold);
    canvas.dot(center, width * 0.62, p.pale_gold);
  };
  // Sprays that run from the bridge of the nose over the brow to the temple.
  curl({-13.2, 24.6}, 2.5, 250, -1.6, {-11, 20}, {-6, 17}, {-2.5, 13}, 0.62);
  curl({-25.5, 24.8}, 2.7, 255, -1.7, {-22, 20}, {-17, 19.4}, {-11, 19.2}, 0.62);
  curl({-36.3, 27}, 3.0, 240, -1.7, {-34, 21.6}, {-29, 20}, {-23.5, 19.7}, 0.62);
  curl({-39.2, 15.4}, 2.4, 100, 1.6, {-36, 19.5}, {-33, 20.6}, {-30, 20.6}, 0.56);
  curl({-34.2, 3.4}, 2.3, 80, 1.5, {-38, 8}, {-41, 12}, {-42, 17}, 0.56);
  curl({-23.8, -0.6}, 1.7, 70, 1.4, {-27, 2}, {-30, 0}, {-32, -2.4}, 0.5);
  curl({-15.0, 0.9}, 1.5, 60, 1.4, {-18, 3}, {-20, 0}, {-22, -3}, 0.46);
  const Vec2 leaves[][2] = {{{-6.5, 16.8}, {-7.6, 21.2}},   {{-17, 19.6}, {-18.2, 24.6}},
                            {{-28.5, 20.4}, {-30.4, 25.6}}, {{-41.2, 21}, {-42.4, 30}},
                            {{-40.4, 10.5}, {-37, 9.4}},    {{-30, 0.6}, {-29.3, 3.2}}};
  for (const auto& ends : leaves) canvas.fill(leaf(ends[0], ends[1], 0.95), p.pale_gold);
  for (int i = 0; i < 6; ++i)
    canvas.dot({-20 - 2.1 * i, 28.6 - 0.05 * i * i + 0.1 * i}, 0.34 - 0.03 * i, p.pale_gold);
  canvas.clip({});
}

void paint_domino_edge(Canvas& canvas, const Palette& p) {
  const Path edge = closed(domino());
  canvas.stroke(edge, 1.5, p.dark_gold);
  canvas.stroke(edge, 1.15, p.gold);
  canvas.stroke(edge, 0.35, p.pale_gold);
}

void paint_domino(Canvas& canvas, const Palette& p) {
  fill_filigree_half(canvas, p);
  paint_filigree(canvas, p);
  fill_harlequin_half(canvas, p);
  canvas.stroke({{0, 21.5}, {0, 7.4}}, 0.7, p.gold);
  paint_domino_edge(canvas, p);
}

// ---- features ----

Path upper_lid() {
  return smooth_curve({{9.6, 6.9}, {13.6, 11.0}, {19.6, 13.9}, {26, 13.0}, {32.2, 9.6}});
}
Path lower_lid() {
  return smooth_curve({{32.2, 9.6}, {27, 6.6}, {20.6, 5.0}, {14, 5.4}, {9.6, 6.9}});
}

void paint_eye(Canvas& canvas, const Palette& p, const Decorator& side) {
  const auto at = [&](double x, double y) { return side(Path{{x, y}}).front(); };
  const Path almond = side(join({upper_lid(), lower_lid()}));
  // A porcelain island with a gold lid keeps the eye clear of the pattern around it.
  const Path island = side(smooth_loop({{6.6, 5.4},
                                        {11.6, 12.4},
                                        {19.6, 17.2},
                                        {28, 16.2},
                                        {36.8, 11.0},
                                        {30, 4.6},
                                        {20.6, 2.2},
                                        {12, 2.8}}));
  canvas.fill(island, p.porcelain);
  canvas.clip(island);
  canvas.glow(at(21, 16.2), 10, 1.9, 0, p.teal, 0.8);
  canvas.glow(at(32, 11.8), 4.0, 2.0, 0, p.plum, 0.7);
  canvas.glow(at(20, 3.0), 10, 1.0, 0, p.rose, 0.35);
  canvas.clip({});
  canvas.stroke(closed(island), 0.95, p.dark_gold);
  canvas.stroke(closed(island), 0.65, p.pale_gold);

  canvas.fill(almond, rgb(0xfdfaf4));
  canvas.clip(almond);
  canvas.glow(at(11, 7), 1.6, 1.2, 0, p.pink, 0.7);
  canvas.glow(at(31, 9.4), 1.8, 1.2, 0, p.pink, 0.45);
  const Vec2 iris = at(20.6, 9.6);
  canvas.fill(ellipse(iris, 4.75, 4.75), rgb(0x10242a));
  canvas.fill(ellipse(iris, 4.35, 4.35), [&](const Vec2& q) {
    const Vec2 d = q - iris;
    const double r = d.norm() / 4.35, angle = std::atan2(d.y(), d.x());
    const double fibres = 0.5 + 0.25 * std::sin(31 * angle) + 0.25 * std::sin(47 * angle + 1.3);
    const LinearColor inner = rgb(0xd9a441), outer = rgb(0x1c7f78);
    const LinearColor base = mix(inner, outer, smooth_step(0.38, 0.72, r + 0.12 * fibres));
    return mix(base, rgb(0x0b2f38), 0.55 * fibres * smooth_step(0.35, 1.0, r));
  });
  canvas.fill(ellipse(iris, 1.95, 1.95), p.ink);
  canvas.glow(at(20.6, 14.4), 9, 1.5, 0, rgb(0x2a2030), 0.75);  // shadow of the lid
  canvas.fill(ellipse(iris + Vec2(-1.5, 1.7), 1.05, 0.85, 30), p.white);
  canvas.dot(iris + Vec2(1.5, -1.9), 0.42, with_alpha(p.white, 0.85));
  canvas.clip({});

  // Lash lines; the upper one runs out into a wing.
  const Path lash =
      side(join({upper_lid(), bezier({32.2, 9.6}, {33.4, 9.5}, {34.8, 10.6}, {36.0, 12.4})}));
  canvas.stroke(
      lash, [](double t) { return 0.16 + 0.62 * std::sin(kPi * std::pow(t, 0.8)); }, p.ink);
  canvas.stroke(
      side(lower_lid()), [](double t) { return 0.30 - 0.2 * t; }, with_alpha(p.ink, 0.9));
  const Path lid = upper_lid();
  for (int i = 0; i < 9; ++i) {
    const Vec2 root = lid[lid.size() * std::size_t(8 + i) / 18];
    const double t = i / 8.0;
    const Vec2 tip = root + (1.7 + 1.2 * t) * Vec2(-0.15 + 0.75 * t, 1.0 - 0.35 * t).normalized();
    canvas.tapering_stroke(side(bezier(root, root + Vec2(0.3, 0.3), tip - Vec2(0.1, 0.5), tip)),
                           0.42, p.ink);
  }
}

void paint_brow(Canvas& canvas, const Palette& p, const Decorator& side) {
  const Path brow =
      side(smooth_curve({{6.0, 30.4}, {12, 34.6}, {19.5, 36.6}, {27, 35.8}, {33.6, 38.6}}));
  canvas.stroke(
      brow, [](double t) { return 0.15 + 1.25 * std::pow(std::sin(kPi * std::pow(t, 0.62)), 0.8); },
      p.brown);
  for (int i = 0; i < 26; ++i) {  // hairs along its upper edge
    const double t = 0.04 + 0.03 * i;
    const auto index = std::size_t(t * double(brow.size() - 1));
    const Vec2 along = (brow[index + 1] - brow[index]).norm() > 0
                           ? Vec2((brow[index + 1] - brow[index]).normalized())
                           : Vec2((brow[index + 2] - brow[index]).normalized());
    Vec2 up(-along.y(), along.x());
    if (up.y() < 0) up = -up;
    const double reach = 1.25 * std::sin(kPi * std::pow(t, 0.62)) + 0.75;
    canvas.tapering_stroke(
        bezier(brow[index] - 0.8 * up, brow[index], brow[index] + 0.6 * up + 0.5 * along,
               brow[index] + reach * up + 1.9 * along),
        0.34, p.brown);
  }
}

void paint_lips(Canvas& canvas, const Palette& p) {
  const Path upper_edge = smooth_curve({{-15, -38.2},
                                        {-9.5, -34.6},
                                        {-3.6, -31.9},
                                        {0, -33.4},
                                        {3.6, -31.9},
                                        {9.5, -34.6},
                                        {15, -38.2}});
  const Path seam = smooth_curve({{15, -38.2},
                                  {9, -37.8},
                                  {4.2, -38.7},
                                  {0, -38.0},
                                  {-4.2, -38.7},
                                  {-9, -37.8},
                                  {-15, -38.2}});
  const Path lower_edge = smooth_curve({{-15, -38.2},
                                        {-10, -43.1},
                                        {-4.5, -46.0},
                                        {0, -46.4},
                                        {4.5, -46.0},
                                        {10, -43.1},
                                        {15, -38.2}});
  canvas.fill(join({upper_edge, seam}), [&](const Vec2& at) {
    return mix(p.red, p.dark_red, smooth_step(-34, -39, at.y()));
  });
  canvas.fill(join({seam, lower_edge}), [&](const Vec2& at) {
    const double x = at.x() / 9, y = (at.y() + 41.6) / 2.4;
    return mix(p.red, rgb(0xd8324a), std::exp(-x * x - y * y));
  });
  canvas.glow({-3.0, -41.0}, 2.6, 0.55, 6, p.white, 0.6);
  canvas.glow({2.6, -41.2}, 1.2, 0.4, -6, p.white, 0.35);
  canvas.glow({-3.8, -33.2}, 1.6, 0.35, 28, p.pink, 0.7);
  canvas.glow({3.8, -33.2}, 1.6, 0.35, -28, p.pink, 0.5);
  canvas.stroke(
      seam, [](double t) { return 0.12 + 0.3 * std::sin(kPi * t); }, rgb(0x3a0610));
  canvas.stroke(join({upper_edge, reversed(lower_edge)}), 0.3, p.gold);
}

// ---- ornaments ----

// Sun and crescent: the crescent's horns tell left from right.
void paint_medallion(Canvas& canvas, const Palette& p) {
  const Vec2 center(0, 46.5);
  for (int i = 0; i < 32; ++i) {
    const double angle = 2 * kPi * i / 32;
    const Vec2 away(std::cos(angle), std::sin(angle));
    const bool is_long = i % 2 == 0;
    const double from = 7.6, to = is_long ? 12.6 : 10.4;
    if (i % 4 == 0)
      canvas.fill(leaf(center + 7.3 * away, center + 13.4 * away, 1.15), p.gold);
    else
      canvas.tapering_stroke({center + from * away, center + to * away}, is_long ? 0.62 : 0.5,
                             p.gold);
    if (is_long && i % 4 != 0) canvas.dot(center + 13.4 * away, 0.36, p.teal);
  }
  canvas.fill(ellipse(center, 6.9, 6.9), [&](const Vec2& at) {
    return mix(p.teal, p.night, smooth_step(0, 7.2, (at - center - Vec2(-1.5, 2)).norm()));
  });
  canvas.stroke(closed(ellipse(center, 6.9, 6.9)), 0.9, p.dark_gold);
  canvas.stroke(closed(ellipse(center, 6.9, 6.9)), 0.6, p.pale_gold);
  canvas.stroke(closed(ellipse(center, 5.9, 5.9)), 0.2, p.pale_gold);
  const Path crescent = join({arc(center + Vec2(-0.4, 0), 4.3, 50, 310),
                              reversed(arc(center + Vec2(1.25, 0), 3.45, 74, 286))});
  canvas.fill(crescent, p.pale_gold);
  const Vec2 star = center + Vec2(2.1, 0.2);
  Path points;
  for (int i = 0; i < 10; ++i) {
    const double angle = kPi / 2 + kPi * i / 5, r = i % 2 == 0 ? 1.75 : 0.72;
    points.push_back(star + r * Vec2(std::cos(angle), std::sin(angle)));
  }
  canvas.fill(points, p.white);
}

void paint_forehead_sprays(Canvas& canvas, const Palette& p, const Decorator& side) {
  const auto at = [&](double x, double y) { return side(Path{{x, y}}).front(); };
  const Path head = spiral({26.6, 45.6}, 2.7, 90, -1.7);
  const Path stem = join({head, bezier(head.back(), {22.5, 48.6}, {20, 42.0}, {15.0, 43.0})});
  canvas.stroke(
      side(stem), [](double t) { return 0.16 + 0.36 * std::sin(kPi * t); }, p.gold);
  const Path head2 = spiral({19.6, 52.2}, 2.0, 270, 1.6);
  const Path stem2 = join({head2, bezier(head2.back(), {22.5, 49.8}, {18, 46.4}, {15.0, 48.8})});
  canvas.stroke(
      side(stem2), [](double t) { return 0.14 + 0.3 * std::sin(kPi * t); }, p.teal);
  canvas.fill(side(leaf({18.6, 43.2}, {22.8, 40.6}, 1.0)), p.teal);
  canvas.fill(side(leaf({21.8, 45.2}, {25.0, 41.9}, -0.8)), p.gold);
  for (int i = 0; i < 3; ++i)
    canvas.dot(at(28.7 + 0.25 * i, 41.6 - 1.35 * i), 0.42 - 0.08 * i, p.plum);
}

// Viewer's right: a tear and its beads.
void paint_tear(Canvas& canvas, const Palette& p) {
  const Path tear = drop({22, -7.6}, {22, -17.6}, 2.7);
  canvas.fill(tear, [&](const Vec2& at) {
    return mix(p.teal, p.night, smooth_step(0, 4.5, (at - Vec2(21.2, -16.8)).norm()));
  });
  canvas.stroke(closed(tear), 0.7, p.dark_gold);
  canvas.stroke(closed(tear), 0.42, p.pale_gold);
  canvas.fill(ellipse({21.0, -17.0}, 0.5, 0.9, -20), p.white);
  for (int i = 0; i < 3; ++i) canvas.dot({22, -23.2 - 2.4 * i}, 0.72 - 0.17 * i, p.teal);
}

// Viewer's left: a vine from the temple down to the jaw.
void paint_vine(Canvas& canvas, const Palette& p) {
  const Path stem = smooth_curve(
      {{-35.0, 1.0}, {-33.0, -12}, {-34.0, -21}, {-30.2, -29.5}, {-27.8, -38}, {-21, -46.5}});
  canvas.stroke(
      stem, [](double t) { return 0.42 - 0.22 * t; }, p.gold);
  for (int i = 0; i < 6; ++i) {
    const auto index = std::size_t(double(stem.size() - 1) * (0.12 + 0.14 * i));
    const Vec2 root = stem[index];
    const double turn = i % 2 == 0 ? 1 : -1;
    const double size = 1.0 - 0.07 * i;
    const Vec2 eye = root + size * Vec2(turn * 4.6, -1.8);
    const Path head = spiral(eye, 1.75 * size, turn > 0 ? 95 : 85, turn > 0 ? -1.4 : 1.4);
    canvas.stroke(
        join({head, bezier(head.back(), eye + size * Vec2(-turn * 1.8, 2.2),
                           root + Vec2(turn * 0.8, -0.2), root)}),
        [](double t) { return 0.13 + 0.2 * std::sin(kPi * t); }, p.gold);
    canvas.dot(eye, 0.36, p.plum);
    canvas.fill(leaf(root, root + size * Vec2(-turn * 3.6, -2.4), turn * 1.0),
                i % 2 == 0 ? p.teal : p.plum);
  }
  const Path tail = reversed(spiral({-19.5, -45.3}, 1.92, 218.5, -1.5));
  canvas.stroke(tail, 0.4, p.gold);
}

void paint_chin(Canvas& canvas, const Palette& p) {
  canvas.fill(diamond({0, -54.5}, 1.6, 2.8), p.plum);
  canvas.stroke(closed(diamond({0, -54.5}, 1.6, 2.8)), 0.35, p.gold);
  for (const double side : {-1.0, 1.0}) {
    canvas.fill(leaf({side * 2.4, -54.2}, {side * 7.2, -52.2}, side * 0.9), p.gold);
    canvas.dot({side * 8.6, -51.6}, 0.4, p.teal);
  }
}

void paint_border(Canvas& canvas, const Palette& p) {
  canvas.stroke(closed(outline(0.945)), 0.95, p.dark_gold);
  canvas.stroke(closed(outline(0.945)), 0.65, p.gold);
  canvas.stroke(closed(outline(0.900)), 0.28, p.gold);
  constexpr int kBeads = 120;
  for (int i = 0; i < kBeads; ++i) {
    const Vec2 at = mask_point(0.9225, 2 * kPi * (i + 0.5) / kBeads);
    canvas.dot(at, i % 5 == 0 ? 0.72 : 0.40, i % 5 == 0 ? p.plum : p.teal);
  }
  // Beyond the border, over the rounded edge: one deep colour.
  canvas.fill(join({outline(2.2),
                    {outline(2.2).front()},
                    {outline(0.952).front()},
                    reversed(outline(0.952)),
                    {outline(0.952).front()}}),
              p.night);
}

}  // namespace

Image paint_mask() {
  const Palette palette;
  Canvas canvas(kMaskTextureWidthMm, kMaskTextureHeightMm, kPxPerMm);
  paint_skin(canvas, palette);
  paint_vine(canvas, palette);
  paint_domino(canvas, palette);
  paint_lips(canvas, palette);
  paint_medallion(canvas, palette);
  const Decorator right = [](const Path& path) { return path; };
  const Decorator left = [](const Path& path) { return mirrored(path); };
  for (const Decorator& side : {right, left}) {
    paint_eye(canvas, palette, side);
    paint_brow(canvas, palette, side);
    paint_forehead_sprays(canvas, palette, side);
  }
  paint_tear(canvas, palette);
  paint_chin(canvas, palette);
  paint_border(canvas, palette);
  return canvas.image();
}

}  // namespace hydrodip
