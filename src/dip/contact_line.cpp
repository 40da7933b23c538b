// The default scheme. The contact line runs through triangles: every mesh edge from an attached to
// a floating vertex has a foot on the contact line, which climbs the object as the water rises and
// counts the film laid down behind it at the strain that the floating film has there. For the
// equilibrium of the floating film, the attached end of the edge stands where flat film would have
// it (its ghost). docs/model.md derives it.

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "dip/foot.h"
#include "dip/measure.h"
#include "dip/scheme.h"
#include "dip/waterline.h"
#include "elastic/kernel_variants.h"
#include "film/locate.h"

namespace hydrodip {

namespace {

// Smallest rest area of a triangle at the contact line, as a share of its flat area: keeps the
// energy finite where ghosts of a crumpled contact line meet.
constexpr double kMinArea = 0.02;
// How far the contact line should go in one part of a step, in steps, and the smallest part.
constexpr double kLineAdvance = 4;
constexpr double kSmallestPart = 1.0 / 8;
// Share of the contact line that may go faster: a scan has flat spots everywhere.
constexpr double kFasterShare = 0.1;
// A foot that jumps further than this in one step, in cells, has lost its contact line (the object
// is submerged there, or a shelf begins) and goes on straight up.
constexpr double kMaxJump = 2.5;
// In one step a floating vertex slides by less than the step and this, in cells.
constexpr double kLongestSlide = 10;
// Tolerance of the film's equilibrium over the square of the step, 1/mm.
constexpr double kTolerancePerStep2 = 1e-4;
// The same over the square of the way that film jumps: where it hangs in flaps, up to a hundred
// times as far as the step. But never more than this share of the step.
constexpr double kTolerancePerWay2 = 1e-3;
constexpr double kLoosest = 0.03;
// So often in a step film that blocks the rest is released.
constexpr int kMostReleases = 8;

RestTriangle rest_from_lengths(double ab, double bc, double ca, double min_area) {
  const double length = std::max(ab, 1e-9);
  const double along = (ab * ab + ca * ca - bc * bc) / (2 * length);
  const double across = std::sqrt(std::max(0.0, ca * ca - along * along));
  return rest_triangle(Vec2(0, 0), Vec2(length, 0),
                       Vec2(along, std::max(across, 2 * min_area / length)));
}

template <typename Item>
std::vector<Item> joined(const std::vector<std::vector<Item>>& parts) {
  std::vector<Item> all;
  for (const std::vector<Item>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

class ContactLineScheme : public Scheme {
 public:
  ContactLineScheme(const DipSetting& setting, DipState& state)
      : set_(setting),
        film_(setting.film),
        state_(state),
        waterline_(setting.positions, setting.triangles, setting.film.cell_mm),
        energy_(setting.film, setting.options.modulus, setting.options.material.poisson),
        solver_(setting.options.make_solver(setting.film)),
        relaxation_(energy_, *solver_),
        feet_of_corner_(3 * setting.film.triangles.size(), {-1, -1}),
        usable_(setting.film.triangles.size(), 0),
        is_free_(setting.film.u.size(), 0),
        film_at_(energy_.grid().field(setting.film.u)),
        plan_(film_at_),
        slid_(film_at_),
        slid_in_(setting.film.u.size(), -1),
        found_(plan_.entries(), 0),
        is_plain_(setting.film.triangles.size(), 0),
        floating_corners_(setting.film.triangles.size(), 0),
        touches_(setting.film.u.size(), 0) {
    for (std::size_t t = 0; t < film_.triangles.size(); ++t) {
      const Triangle& v = film_.triangles[t];
      const Vec2& a = film_.u[std::size_t(v[0])];
      smallest_area_.push_back(
          kMinArea * 0.5 * cross2(film_.u[std::size_t(v[1])] - a, film_.u[std::size_t(v[2])] - a));
      update_load(t);
    }
    relaxation_.field() = film_at_;
    for (auto& corner : slid_in_corner_) corner.assign(plan_.entries(), 0);
  }

  void write_positions() override {
    parallel_for(film_.u.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        if (state_.state[v] == VertexState::kUnattached)
          state_.position[v] << plan(std::int32_t(v)), state_.level;
    });
  }

  // In parts where the object rises so gently at the contact line that this one runs fast: where
  // the water first touches something blunt.
  void advance(double level) override {
    while (state_.level < level) {
      const double rise = std::max(part_, kSmallestPart) * set_.options.step_mm;
      // No sliver of a step at the end.
      raise(level - state_.level < 1.5 * rise ? level : state_.level + rise);
      part_ = std::clamp(kLineAdvance * gentlest_rise(), kSmallestPart, 1.0);
    }
  }

 private:
  // Of the object at the contact line, over outward run; of walls if there is no line.
  double gentlest_rise() const {
    std::vector<double> rises;
    for (const Foot& foot : feet_) rises.push_back(std::abs(foot.steepness));
    if (rises.empty()) return kWall;
    const auto gentle = rises.begin() + std::ptrdiff_t(kFasterShare * double(rises.size()));
    std::nth_element(rises.begin(), gentle, rises.end());
    return *gentle;
  }

  void raise(double level) {
    waterline_.raise_to(level);
    climb(level);
    set_rest();
    relax(level);
    tear_overstretched(level);
    slide();
    correct_feet();
    attach(level);
    state_.level = level;
  }

  bool floats(std::int32_t v) const {
    return state_.state[std::size_t(v)] == VertexState::kUnattached;
  }
  bool attached(std::int32_t v) const {
    return state_.state[std::size_t(v)] == VertexState::kAttached;
  }
  double z_stretch() const { return set_.options.material.z_stretch; }
  std::size_t place(std::int32_t v) const { return energy_.grid().place(std::size_t(v)); }
  Vec2 plan(std::int32_t v) const { return plan_.at(place(v)); }
  Vec2 slid(std::int32_t v) const { return slid_.at(place(v)); }

  // The contact line next to `near`. `outside` is a unit vector known to point away from the object
  // more or less; where faces are turned the wrong way, it decides.
  Waterline::Point line_near(const Vec2& near, const Vec2& outside) const {
    const auto found = waterline_.closest(near, kMaxJump * film_.cell_mm);
    if (!found) return {near, outside, kWall};
    Waterline::Point point = *found;
    if (point.outward.dot(outside) < -0.7) {
      point.outward = -point.outward;
      point.steepness = -point.steepness;
    }
    return point;
  }

  // Where the edge from a vertex that attaches now leaves the object; next to the vertex where it
  // does not (on walls and overhangs), but never on the far side of it.
  Waterline::Point first_on_line(const Vec2& from, const Vec2& to) const {
    if (const auto leaving = waterline_.exit(from, to)) return *leaving;
    const Vec2 outside = (to - from).normalized();
    const Waterline::Point near = line_near(from, outside);
    const bool behind = (near.position - from).dot(outside) < -0.1 * film_.cell_mm;
    return behind ? line_near(to, outside) : near;
  }

  // Towards the floating vertex, so that the foot stays by the edge whose strain it uses; straight
  // up where the water does not gain on it that way: on walls and overhangs, or just before
  // contact.
  Waterline::Point next_on_line(const Foot& foot) const {
    const Vec2 from = foot.point.head<2>();
    if (const auto ahead = waterline_.exit(from, plan(foot.floating)))
      if ((ahead->position - from).norm() < kMaxJump * film_.cell_mm) return *ahead;
    return line_near(from, foot.outward);
  }

  void climb(double level) {
    const double rise = level - state_.level;
    const double ratio = last_rise_ > 0 ? rise / last_rise_ : 1.0;
    last_rise_ = rise;
    for_feet([&](Foot& foot) {
      const Waterline::Point to = next_on_line(foot);
      foot.last_way = unrolled(foot.point, foot.outward, foot.steepness, to, level, z_stretch());
      foot.laid_before = foot.laid;
      foot.laid += 0.5 * (foot.line.now + foot.line.next(ratio)) * foot.last_way;
      foot.way += foot.last_way;
      foot.point << to.position, level;
      foot.outward = to.outward;
      foot.steepness = to.steepness;
      place_ghost(foot, foot.element.next(ratio));
    });
  }

  // Calls work(foot) for each, side by side.
  template <class Work>
  void for_feet(const Work& work) {
    constexpr std::size_t kFeetPerTask = 32;
    parallel_for(feet_.size(), kFeetPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) work(feet_[f]);
    });
  }

  std::size_t number(const Foot& foot) const { return std::size_t(&foot - feet_.data()); }

  Vec2 corner(std::size_t t, std::size_t k) const {
    const std::int32_t v = film_.triangles[t][k];
    if (!attached(v)) return plan(v);
    const auto& feet = feet_of_corner_[3 * t + k];
    if (feet[0] < 0) return plan(v);
    const Vec2& first = feet_[std::size_t(feet[0])].ghost;
    return feet[1] < 0 ? first : Vec2(0.5 * (first + feet_[std::size_t(feet[1])].ghost));
  }

  bool carries_load(std::size_t t) const {
    const Triangle& v = film_.triangles[t];
    return !state_.torn[t] && (floats(v[0]) || floats(v[1]) || floats(v[2]));
  }

  // After a corner of the triangle attached or it tore. A vertex without any film left around it
  // drifts: nothing holds or moves it.
  void update_load(std::size_t t) {
    const Triangle& v = film_.triangles[t];
    usable_[t] = carries_load(t);
    is_plain_[t] = usable_[t] && !attached(v[0]) && !attached(v[1]) && !attached(v[2]);
    floating_corners_[t] = 0;
    for (std::int32_t w : v) floating_corners_[t] += std::uint8_t(usable_[t] && floats(w));
    energy_.set_film(t, usable_[t]);
    for (std::int32_t w : v) {
      const auto begin = film_.incident.begin() + film_.incident_begin[std::size_t(w)],
                 end = film_.incident.begin() + film_.incident_begin[std::size_t(w) + 1];
      is_free_[std::size_t(w)] = floats(w) && std::any_of(begin, end, [&](std::int32_t other) {
                                   return usable_[std::size_t(other)] != 0;
                                 });
    }
  }

  RestTriangle rest_of(std::size_t t) const {
    const std::array<Vec2, 3> x = {corner(t, 0), corner(t, 1), corner(t, 2)};
    const double min_area = smallest_area_[t];
    const double area = 0.5 * cross2(x[1] - x[0], x[2] - x[0]);
    if (area >= min_area) return rest_triangle(x[0], x[1], x[2]);
    return rest_from_lengths((x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[0] - x[2]).norm(),
                             min_area);
  }

  // Flat where it floats, all at once; with ghosts for corners at the contact line.
  void set_rest() {
    const std::vector<std::int32_t> small = energy_.set_flat_rest(plan_, kMinArea);
    for (std::size_t t : line_triangles_)
      if (usable_[t]) energy_.set_rest(t, rest_of(t));
    for (std::int32_t t : small) energy_.set_rest(std::size_t(t), rest_of(std::size_t(t)));
  }

  // The free vertices, without islands: film torn off all around or hanging by one point drifts,
  // because nothing says where it should be.
  std::vector<std::uint8_t> held_vertices() const {
    if (!any_torn_) return is_free_;
    std::vector<std::int32_t> island(film_.u.size());
    std::iota(island.begin(), island.end(), 0);
    const auto root = [&](std::int32_t v) {
      while (island[std::size_t(v)] != v)
        v = island[std::size_t(v)] = island[std::size_t(island[std::size_t(v)])];
      return v;
    };
    // Usable film with corners that float and corners that do not.
    std::vector<std::size_t> at_edge;
    for (std::size_t t = 0; t < film_.triangles.size(); ++t) {
      const Triangle& corners = film_.triangles[t];
      const auto parent = [&](std::size_t k) { return island[std::size_t(corners[k])]; };
      if (floating_corners_[t] == 0) continue;
      if (floating_corners_[t] == 3 && parent(0) == parent(1) && parent(1) == parent(2)) continue;
      std::int32_t first = -1;
      for (std::int32_t v : corners) {
        if (!floats(v)) continue;
        if (first < 0)
          first = v;
        else
          island[std::size_t(root(v))] = root(first);
      }
      if (floating_corners_[t] < 3) at_edge.push_back(t);
    }
    // The first vertex that holds each island, and whether there is another.
    std::vector<std::int32_t> holder(film_.u.size(), -1);
    std::vector<std::uint8_t> held(film_.u.size(), 0);
    for (std::size_t t : at_edge)
      for (std::int32_t v : film_.triangles[t])
        for (std::int32_t w : film_.triangles[t]) {
          if (!floats(v) || floats(w)) continue;
          const auto i = std::size_t(root(v));
          if (holder[i] < 0) holder[i] = w;
          held[i] |= std::uint8_t(holder[i] != w);
        }
    std::vector<std::uint8_t> result = is_free_;
    for (std::size_t v = 0; v < result.size(); ++v)
      result[v] &= held[std::size_t(root(std::int32_t(v)))];
    return result;
  }

  // From where the film lay after the last step: it slides on as it did then.
  void relax(double level) {
    std::vector<std::uint8_t> is_free = held_vertices();
    put_back(is_free);
    RelaxationOptions options;
    options.otherwise = &film_.u;
    options.tolerance_mm = tolerance_mm();
    options.tolerance_per_way2 = kTolerancePerWay2;
    options.loosest_mm = kLoosest * set_.options.step_mm;
    for (int round = 0;; ++round) {
      const RelaxationResult result = relaxation_.run(is_free, options);
      if (result.blocked.empty() || round == kMostReleases) {
        energy_.grid().to_vertices(relaxation_.field(), relaxed_);
        count(result, relaxed_, state_.statistics);
        return;
      }
      state_.statistics.iterations += result.iterations;
      release(result.blocked, level, is_free);
    }
  }

  // The error of long steps grows with their square; what is far below it need not be computed.
  double tolerance_mm() const {
    const double step = set_.options.step_mm;
    return std::max(RelaxationOptions().tolerance_mm, kTolerancePerStep2 * step * step);
  }

  // The vertices that are not free have their own film coordinates.
  void put_back(const std::vector<std::uint8_t>& is_free) {
    parallel_for(is_free.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        if (!is_free[v]) {
          const std::size_t at = energy_.grid().place(v);
          relaxation_.field().set(at, film_at_.at(at));
        }
    });
  }

  // Film that would have to turn over to follow is stretched past any limit: it tears, or if film
  // never does, its vertices stay where they are.
  void release(const std::vector<std::int32_t>& blocked, double level,
               std::vector<std::uint8_t>& is_free) {
    if (tear_limit(set_.options) > 0) {
      for (std::int32_t t : blocked) {
        tear(t, level);
        update_load(std::size_t(t));
        energy_.set_rest(std::size_t(t), {});
      }
      is_free = held_vertices();
      return;
    }
    for (std::int32_t t : blocked)
      for (std::int32_t v : film_.triangles[std::size_t(t)]) is_free[std::size_t(v)] = 0;
  }

  void tear_overstretched(double level) {
    const std::vector<double>& told = set_.options.tear_levels;
    const double limit = tear_limit(set_.options);
    if (!(limit > 0) && told.empty()) return;
    std::vector<std::int32_t> tears;
    if (limit > 0) tears = energy_.overstretched(relaxation_.field(), limit);
    for (std::size_t t = 0; t < told.size(); ++t)
      if (usable_[t] && level >= told[t]) tears.push_back(std::int32_t(t));
    for (std::int32_t t : tears) tear(t, level);
  }

  void tear(std::int32_t t, double level) {
    state_.torn[std::size_t(t)] = 1;
    state_.tear_level[std::size_t(t)] = level;
    torn_now_.push_back(std::size_t(t));
    any_torn_ = true;
  }

  // Every floating vertex goes where its film coordinate is found in the relaxed film. Most are
  // found where they were found last, all at once.
  void slide() {
    const auto carry = kernels::best().carry;
    const std::int32_t* const corners[3] = {slid_in_corner_[0].data(), slid_in_corner_[1].data(),
                                            slid_in_corner_[2].data()};
    // Scraps of torn film may have no place that means anything.
    const double reach = kLongestSlide * film_.cell_mm + set_.options.step_mm;
    parallel_for(film_.u.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
      const std::size_t first = energy_.grid().place(begin), last = energy_.grid().place(end - 1);
      carry(first, last + 1, corners, film_at_, relaxation_.field(), plan_, reach, slid_,
            found_.data());
      for (std::size_t v = begin; v < end; ++v) {
        const std::size_t at = energy_.grid().place(v);
        if (state_.state[v] != VertexState::kUnattached) {
          slid_.set(at, plan_.at(at));
        } else if (!found_[at] || !is_plain_[std::size_t(slid_in_[v])]) {
          const auto to = look_up(v);
          const bool near = to && (*to - plan_.at(at)).norm() < reach;
          slid_.set(at, near ? *to : plan_.at(at));
        }
      }
    });
    hold_back_folds();
  }

  // Where the vertex goes if it is not where it was found last, or if a corner there has a ghost.
  std::optional<Vec2> look_up(std::size_t v) {
    const FilmLocation at =
        locate(film_, relaxed_, usable_, static_cast<std::int32_t>(v), film_.u[v], slid_in_[v]);
    slid_in_[v] = at.triangle;
    for (std::size_t k = 0; k < 3; ++k)
      slid_in_corner_[k][energy_.grid().place(v)] =
          at.triangle < 0
              ? 0
              : static_cast<std::int32_t>(place(film_.triangles[std::size_t(at.triangle)][k]));
    if (at.triangle < 0) return std::nullopt;
    const auto t = std::size_t(at.triangle);
    return at.weight[0] * corner(t, 0) + at.weight[1] * corner(t, 1) + at.weight[2] * corner(t, 2);
  }

  // Where sliding that far would turn floating film over, its vertices stay where they were; there
  // it lies the right way up, so this ends.
  void hold_back_folds() {
    if (!any_fold()) return;
    for (bool held = true; held;) {
      held = false;
      for (std::size_t t = 0; t < film_.triangles.size(); ++t) {
        if (!folds(t)) continue;
        for (std::int32_t w : film_.triangles[t])
          if (floats(w) && slid(w) != plan(w)) {
            slid_.set(place(w), plan(w));
            held = true;
          }
      }
    }
  }

  bool folds(std::size_t t) const {
    const Triangle& v = film_.triangles[t];
    if (!usable_[t]) return false;
    const Vec2 a = slid(v[0]);
    if (cross2(slid(v[1]) - a, slid(v[2]) - a) > 0) return false;
    return !attached(v[0]) && !attached(v[1]) && !attached(v[2]);
  }

  bool any_fold() {
    if (!energy_.any_inverted(slid_)) return false;
    for (std::size_t t = 0; t < film_.triangles.size(); ++t)
      if (folds(t)) return true;
    return false;
  }

  // The gradient du/dX of a triangle with its floating corners where they slid to.
  Mat2 gradient_after(std::size_t t) const {
    std::array<Vec2, 3> x;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t v = film_.triangles[t][k];
      x[k] = floats(v) ? slid(v) : corner(t, k);
    }
    const RestTriangle rest = rest_triangle(x[0], x[1], x[2]);
    const Triangle& v = film_.triangles[t];
    if (!(rest.area > smallest_area_[t])) return Mat2::Zero();
    return deformation_gradient(rest, film_.u[std::size_t(v[0])], film_.u[std::size_t(v[1])],
                                film_.u[std::size_t(v[2])]);
  }

  // Mean over the triangles on both sides of an edge; `otherwise` if neither can say.
  Mat2 gradient_at_edge(std::int32_t a, std::int32_t b, const Mat2& otherwise) const {
    Mat2 sum = Mat2::Zero();
    int count = 0;
    for_triangles_at_edge(a, b, [&](std::size_t t) {
      if (!usable_[t]) return;
      const Mat2 F = gradient_after(t);
      if (!usable_gradient(F)) return;
      sum += F;
      ++count;
    });
    return count > 0 ? Mat2(sum / count) : otherwise;
  }

  template <typename Visit>
  void for_triangles_at_edge(std::int32_t a, std::int32_t b, const Visit& visit) const {
    for (auto n = film_.incident_begin[std::size_t(a)];
         n < film_.incident_begin[std::size_t(a) + 1]; ++n) {
      const auto t = std::size_t(film_.incident[std::size_t(n)]);
      const Triangle& v = film_.triangles[t];
      if (v[0] == b || v[1] == b || v[2] == b) visit(t);
    }
  }

  // Trapezoidal rule: the film laid in this step has the mean of the strain before and after.
  void correct_feet() {
    std::vector<Mat2> element(feet_.size());
    for_feet([&](const Foot& foot) {
      element[number(foot)] = gradient_at_edge(foot.attached, foot.floating, foot.element.now);
    });
    for_feet([&](Foot& foot) {
      const Mat2& floating = element[number(foot)];
      const Mat2 line = gradient_on_line(foot, floating);
      foot.laid = foot.laid_before + 0.5 * (foot.line.now + line) * foot.last_way;
      foot.line.advance(line);
      foot.element.advance(floating);
    });
  }

  // Around a vertex that is attached alone, the contact line is a circle smaller than the triangles
  // around it, and the floating film strains as around a hole: u = A r + B / r. Of that, triangles
  // know the mean slope from the circle (radius c) out to the floating vertex (r), and the foot
  // knows u / c; the slope at the circle follows.
  Mat2 gradient_on_line(const Foot& foot, const Mat2& element) const {
    if (!stands_alone(foot.attached)) return element;
    const Vec2 centre = plan(foot.attached);
    const Vec2 out = foot.point.head<2>() - centre;
    const double c = out.norm();
    const double r = (slid(foot.floating) - centre).norm();
    if (!(c > 0) || !(r > c)) return element;
    const Vec2 n = out / c;
    const double half_q = 0.5 * (1 - c / r);
    const double around = n.dot(foot.laid) / c;
    const double mean = n.dot(element * n);
    const double slope = (mean - half_q * around) / (1 - half_q);
    return element + (slope - mean) * n * n.transpose();
  }

  bool stands_alone(std::int32_t v) const {
    for (auto n = film_.incident_begin[std::size_t(v)];
         n < film_.incident_begin[std::size_t(v) + 1]; ++n)
      for (std::int32_t w : film_.triangles[std::size_t(film_.incident[std::size_t(n)])])
        if (w != v && !floats(w)) return false;
    return true;
  }

  struct Touch {
    std::int32_t vertex;
    Contact contact;
  };

  void attach(double level) {
    const std::vector<Touch> touches = find_contacts(level);
    for (const Touch& touch : touches) touches_[std::size_t(touch.vertex)] = 1;
    const std::vector<Foot> created = created_feet(touches, level);
    plan_.swap(slid_);
    for (const Touch& touch : touches) {
      const auto v = std::size_t(touch.vertex);
      touches_[v] = 0;
      state_.state[v] = VertexState::kAttached;
      state_.position[v] = touch.contact.position;
      plan_.set(place(touch.vertex), touch.contact.position.head<2>());
    }
    update_loads(touches);
    std::erase_if(feet_, [&](const Foot& foot) { return !floats(foot.floating); });
    feet_.insert(feet_.end(), created.begin(), created.end());
    for_feet([](Foot& foot) { place_ghost(foot, foot.element.now); });
    index_feet();
  }

  // In the order of the vertices.
  std::vector<Touch> find_contacts(double level) const {
    // Few, because those that may touch lie together.
    constexpr std::size_t kVerticesPerTask = 256;
    std::vector<std::vector<Touch>> found((film_.u.size() + kVerticesPerTask - 1) /
                                          kVerticesPerTask);
    parallel_for(film_.u.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (state_.state[v] != VertexState::kUnattached) continue;
        const auto vertex = static_cast<std::int32_t>(v);
        const Vec2 from = plan(vertex), to = slid(vertex);
        if (!waterline_.may_touch(from, to)) continue;
        const auto contact = first_contact(set_.surface, Vec3(from.x(), from.y(), state_.level),
                                           Vec3(to.x(), to.y(), level));
        if (contact) found[begin / kVerticesPerTask].push_back({vertex, *contact});
      }
    });
    return joined(found);
  }

  void update_loads(const std::vector<Touch>& touches) {
    for (const Touch& touch : touches)
      for (auto n = film_.incident_begin[std::size_t(touch.vertex)];
           n < film_.incident_begin[std::size_t(touch.vertex) + 1]; ++n)
        update_load(std::size_t(film_.incident[std::size_t(n)]));
    for (std::size_t t : torn_now_) update_load(t);
    torn_now_.clear();
  }

  // In the order of their touches.
  std::vector<Foot> created_feet(const std::vector<Touch>& touches, double level) const {
    constexpr std::size_t kTouchesPerTask = 2;
    std::vector<std::vector<Foot>> created(touches.size());
    parallel_for(touches.size(), kTouchesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) create_feet(touches[n], level, created[n]);
    });
    return joined(created);
  }

  // One for every edge from a vertex that attaches now to one that goes on floating.
  void create_feet(const Touch& touch, double level, std::vector<Foot>& created) const {
    const std::int32_t v = touch.vertex;
    const Contact& contact = touch.contact;
    std::vector<std::int32_t> around;
    for (auto n = film_.incident_begin[std::size_t(v)];
         n < film_.incident_begin[std::size_t(v) + 1]; ++n)
      for (std::int32_t w : film_.triangles[std::size_t(film_.incident[std::size_t(n)])])
        if (w != v && floats(w) && !touches_[std::size_t(w)]) around.push_back(w);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    for (std::int32_t w : around) {
      Foot foot;
      foot.attached = v;
      foot.floating = w;
      const Vec2 from = contact.position.head<2>();
      const Waterline::Point to = first_on_line(from, slid(w));
      const Mat2 F = gradient_at_edge(v, w, Mat2::Identity());
      foot.element = foot.line = {F, F};
      foot.way = unrolled(contact.position, contact.normal.head<2>().stableNormalized(),
                          steepness_along(contact.normal, to.outward), to, level, z_stretch());
      foot.laid = F * foot.way;
      foot.point << to.position, level;
      foot.outward = to.outward;
      foot.steepness = to.steepness;
      created.push_back(foot);
    }
  }

  void index_feet() {
    for (std::size_t c : indexed_corners_) feet_of_corner_[c] = {-1, -1};
    indexed_corners_.clear();
    line_triangles_.clear();
    for (std::size_t f = 0; f < feet_.size(); ++f)
      for_triangles_at_edge(feet_[f].attached, feet_[f].floating, [&](std::size_t t) {
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

  const DipSetting set_;
  const FilmMesh& film_;
  DipState& state_;
  Waterline waterline_;
  FilmEnergy energy_;
  std::unique_ptr<LinearSolver> solver_;
  Relaxation relaxation_;
  double part_ = 0;       // of a step, to go at once next
  double last_rise_ = 0;  // of the level
  std::vector<Foot> feet_;
  // Per triangle corner, if its vertex is attached: the feet of its edges to floating corners.
  std::vector<std::array<std::int32_t, 2>> feet_of_corner_;
  std::vector<std::size_t> indexed_corners_;
  std::vector<std::size_t> line_triangles_;  // with attached and floating corners, ascending
  // Per triangle: carries load in this step; the least rest area.
  std::vector<std::uint8_t> usable_;
  std::vector<double> smallest_area_;
  std::vector<std::size_t> torn_now_;  // triangles torn in this step
  bool any_torn_ = false;
  std::vector<std::uint8_t> is_free_;  // per vertex: floats and has film around it
  // Over the film's grid: film coordinates, and vertices seen from above, now and after relaxing.
  GridField film_at_, plan_, slid_;
  VertexVector relaxed_;  // per vertex: film coordinates after relaxing
  // Per vertex: the triangle that it was last found in. Over the grid: that one's corners, and
  // whether the vertex still was inside.
  std::vector<std::int32_t> slid_in_, slid_in_corner_[3];
  std::vector<std::int64_t> found_;
  std::vector<std::uint8_t> is_plain_;  // per triangle: usable, and none of its corners attached
  std::vector<std::uint8_t> floating_corners_;  // per triangle: how many float; 0 if not usable
  std::vector<std::uint8_t> touches_;           // per vertex: attaches in this step
};

}  // namespace

std::unique_ptr<Scheme> make_contact_line_scheme(const DipSetting& setting, DipState& state) {
  return std::make_unique<ContactLineScheme>(setting, state);
}

}  // namespace hydrodip
