#include "dip/feet.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "dip/line_search.h"

namespace hydrodip {

namespace {

// Share of the contact line that may go faster, or where strain may change otherwise: a scan has
// flat spots everywhere.
constexpr double kFewFeet = 0.1;

// Cosine of how far a line turns in one step, at a corner.
constexpr double kSameLine = 0.5;

// How the object turns in the water plane from one moment to another.
Mat2 spin_between(const Moment& from, const Moment& to) {
  const Mat3 turn = to.turn * from.turn.transpose();
  const double cosine = turn(0, 0) + turn(1, 1), sine = turn(1, 0) - turn(0, 1);
  Mat2 spin;
  spin << cosine, -sine, sine, cosine;
  return spin / std::hypot(cosine, sine);
}

}  // namespace

double Feet::gentlest_rise() const {
  std::vector<double> rises;
  for (const Foot& foot : feet_) rises.push_back(std::abs(foot.steepness));
  if (rises.empty()) return kWall;
  const auto gentle = rises.begin() + std::ptrdiff_t(kFewFeet * double(rises.size()));
  std::nth_element(rises.begin(), gentle, rises.end());
  return *gentle;
}

double Feet::unforeseen_mm() const {
  if (unforeseen_mm_.empty()) return 0;
  std::vector<double> ways = unforeseen_mm_;
  const auto far = ways.end() - 1 - std::ptrdiff_t(kFewFeet * double(ways.size()));
  std::nth_element(ways.begin(), far, ways.end());
  return *far;
}

// The way is unrolled as the object is in the middle of it: between two moments it turns a little.
// Where the water falls back from laid film, the film's edge stays where it is.
void Feet::climb(const FloatingSheet& sheet, const Waterline& line, const Moment& to) {
  const Moment& from = state_.moment;
  const double travel = to.travelled_mm - from.travelled_mm;
  const double ratio = last_travel_ > 0 ? travel / last_travel_ : 1.0;
  last_travel_ = travel;
  const Moment between = set_.travel.at(0.5 * (from.travelled_mm + to.travelled_mm));
  const Mat2 spin = spin_between(from, to);
  const LineSearch search{line, film_.cell_mm};
  for_feet([&](Foot& foot) {
    if (to.moved) foot.way = spin * foot.way;
    const Vec3 start = to.to_sinking(foot.point);
    foot.laid_before = foot.laid;
    foot.ghost_before = foot.ghost;
    foot.expected = foot.element.next(ratio);
    if (start.z() > to.level_mm) {
      foot.last_way = Vec2::Zero();
      foot.place = start.head<2>();
    } else {
      const Waterline::Point end = next_of(foot, start, sheet.plan(foot.floating), search, to);
      const Vec3 point = to.afloat(end.position);
      const Vec3 point_between = between.to_sinking(point);
      foot.last_way = unrolled(between.to_sinking(foot.point), foot.outward, foot.steepness,
                               {point_between.head<2>(), end.outward, end.steepness},
                               point_between.z(), z_stretch());
      foot.laid += 0.5 * (foot.element.now + foot.expected) * foot.last_way;
      foot.way += foot.last_way;
      foot.point = point;
      foot.place = end.position;
      foot.outward = end.outward;
      foot.steepness = end.steepness;
    }
    const double way = foot.way.norm(), left = (sheet.plan(foot.floating) - foot.place).norm();
    foot.ghost_gradient.follow(foot.expected, foot.last_way.norm(), way,
                               way > 0 ? way / (way + left) : 0);
    place_ghost(foot);
  });
}

// Where a foot goes that starts from there. With no line before its floating vertex, the line next
// to it may be another one, which faces elsewhere. Then the vertex is reached in this step, as what
// was dry between two places of something blunt is gone; or the object is submerged there.
Waterline::Point Feet::next_of(const Foot& foot, const Vec3& start, const Vec2& floating,
                               const LineSearch& search, const Moment& to) const {
  const Vec2 from = start.head<2>();
  if (const auto ahead = search.ahead(from, floating)) return *ahead;
  const auto near = search.near(from);
  const double sign = foot.inside_out ? -1 : 1;
  const double facing = near ? sign * near->outward.dot(foot.outward) : 0;
  const double left = (floating - from).norm();
  if (facing < kSameLine && left > 0 && is_reached(floating, to))
    return {floating, (floating - from) / left, (to.level_mm - start.z()) / left};
  if (!near || facing < -kSameLine) return {from, foot.outward, kWall};
  return LineSearch::outwards(*near, foot.outward);
}

// Whether the water meets the object there in this step.
bool Feet::is_reached(const Vec2& place, const Moment& to) const {
  return first_touch(set_.surface, place, state_.moment, place, to).has_value();
}

void Feet::correct(const FloatingSheet& sheet) {
  std::vector<Mat2> element(feet_.size());
  for_feet([&](const Foot& foot) {
    element[number(foot)] =
        sheet.gradient_at_edge(foot.attached, foot.floating, foot.element.now, *this);
  });
  unforeseen_mm_.resize(feet_.size());
  for_feet([&](Foot& foot) {
    const Mat2& now = element[number(foot)];
    unforeseen_mm_[number(foot)] = 0.5 * ((now - foot.expected) * foot.last_way).norm();
    foot.laid = foot.laid_before + 0.5 * (foot.element.now + now) * foot.last_way;
    foot.element.advance(now);
  });
}

std::vector<Foot> Feet::created_for(const std::vector<Touch>& touches, const FloatingSheet& sheet,
                                    const Waterline& line, const Moment& to) {
  for (const Touch& touch : touches) touches_[std::size_t(touch.vertex)] = 1;
  constexpr std::size_t kTouchesPerTask = 2;
  std::vector<std::vector<Foot>> created(touches.size());
  parallel_for(touches.size(), kTouchesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) create(touches[n], sheet, line, to, created[n]);
  });
  for (const Touch& touch : touches) touches_[std::size_t(touch.vertex)] = 0;
  std::vector<Foot> all;
  for (const std::vector<Foot>& part : created) all.insert(all.end(), part.begin(), part.end());
  return all;
}

void Feet::create(const Touch& touch, const FloatingSheet& sheet, const Waterline& line,
                  const Moment& to, std::vector<Foot>& created) const {
  const std::int32_t v = touch.vertex;
  const Vec3 touched = to.to_sinking(touch.contact.position);
  const Vec3 normal = to.direction_to_sinking(touch.contact.normal);
  Vec3 way;  // on which it touched
  way << sheet.slid(v) - sheet.plan(v), to.level_mm - state_.moment.level_mm;
  std::vector<std::int32_t> around;
  for (auto n = film_.incident_begin[std::size_t(v)]; n < film_.incident_begin[std::size_t(v) + 1];
       ++n)
    for (std::int32_t w : film_.triangles[std::size_t(film_.incident[std::size_t(n)])])
      if (w != v && sheet.floats(w) && !touches_[std::size_t(w)] && sheet.is_usable_edge(v, w))
        around.push_back(w);
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  const LineSearch search{line, film_.cell_mm};
  for (std::int32_t w : around) {
    Foot foot;
    foot.attached = v;
    foot.floating = w;
    foot.inside_out = way.dot(normal) > 0;
    const Vec2 from = touched.head<2>();
    const Waterline::Point end = search.first_on_line(from, sheet.slid(w));
    const Mat2 F = sheet.gradient_at_edge(v, w, Mat2::Identity(), *this);
    // What the film did before there was a foot tells as much of what it will do as afterwards:
    // without, each foot's first step lays film at a strain that is out of date.
    foot.element = {F, sheet.gradient_at_edge(v, w, F, *this, When::kBefore)};
    foot.ghost_gradient.now = F;
    foot.way = unrolled(touched, normal.head<2>().stableNormalized(),
                        steepness_along(normal, end.outward), end, to.level_mm, z_stretch());
    foot.laid = F * foot.way;
    foot.point = to.afloat(end.position);
    foot.place = end.position;
    foot.outward = end.outward;
    foot.steepness = end.steepness;
    place_ghost(foot);
    created.push_back(foot);
  }
}

void Feet::replace(const std::vector<Foot>& created, const FloatingSheet& sheet) {
  std::erase_if(feet_, [&](const Foot& foot) {
    return !sheet.floats(foot.floating) || !sheet.is_usable_edge(foot.attached, foot.floating);
  });
  feet_.insert(feet_.end(), created.begin(), created.end());
  index(sheet);
}

void Feet::index(const FloatingSheet& sheet) {
  for (std::size_t c : indexed_corners_) feet_of_corner_[c] = {-1, -1};
  indexed_corners_.clear();
  line_triangles_.clear();
  for (std::size_t f = 0; f < feet_.size(); ++f)
    sheet.for_triangles_at_edge(feet_[f].attached, feet_[f].floating, [&](std::size_t t) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (film_.triangles[t][k] != feet_[f].attached) continue;
        auto& slots = feet_of_corner_[3 * t + k];
        slots[slots[0] < 0 ? 0 : 1] = static_cast<std::int32_t>(f);
        indexed_corners_.push_back(3 * t + k);
        line_triangles_.push_back(t);
      }
    });
  std::sort(line_triangles_.begin(), line_triangles_.end());
  line_triangles_.erase(std::unique(line_triangles_.begin(), line_triangles_.end()),
                        line_triangles_.end());
}

}  // namespace hydrodip
