#include "dip/floating_sheet.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "dip/feet.h"
#include "elastic/kernel_variants.h"
#include "film/locate.h"

namespace hydrodip {

namespace {

// Smallest rest area of a triangle at the contact line, as a share of its flat area: keeps the
// energy finite where ghosts of a crumpled contact line meet.
constexpr double kMinArea = 0.02;
// In one step a floating vertex slides by less than the step and this, in cells.
constexpr double kLongestSlide = 10;
// Tolerance of the film's equilibrium over the square of the step, 1/mm.
constexpr double kTolerancePerStep2 = 1e-4;
// The same over the square of the way that film jumps: where it hangs in flaps, up to a hundred
// times as far as the step. But never more than this share of the step.
constexpr double kTolerancePerWay2 = 1e-3;
constexpr double kLoosest = 0.03;

RestTriangle rest_from_lengths(double ab, double bc, double ca, double min_area) {
  const double length = std::max(ab, 1e-9);
  const double along = (ab * ab + ca * ca - bc * bc) / (2 * length);
  const double across = std::sqrt(std::max(0.0, ca * ca - along * along));
  return rest_triangle(Vec2(0, 0), Vec2(length, 0),
                       Vec2(along, std::max(across, 2 * min_area / length)));
}

}  // namespace

FloatingSheet::FloatingSheet(const DipSetting& setting, DipState& state)
    : options_(setting.options),
      film_(setting.film),
      state_(state),
      energy_(setting.film, setting.options.modulus, setting.options.material.poisson,
              setting.options.material.law),
      solver_(setting.options.make_solver(setting.film)),
      relaxation_(energy_, *solver_),
      usable_(setting.film.triangles.size(), 0),
      is_free_(setting.film.u.size(), 0),
      film_at_(energy_.grid().field(setting.film.u)),
      plan_(film_at_),
      slid_(film_at_),
      foresight_(energy_.grid().layout(), film_at_, setting.options.relaxed_steps.get()),
      slid_in_(setting.film.u.size(), -1),
      found_(plan_.entries(), 0),
      is_plain_(setting.film.triangles.size(), 0) {
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

Vec2 FloatingSheet::corner(std::size_t t, std::size_t k, const Feet& feet, When when) const {
  const std::int32_t v = film_.triangles[t][k];
  if (!attached(v)) return plan(v);
  const auto ghost = feet.ghost(t, k, when);
  return ghost ? *ghost : plan(v);
}

bool FloatingSheet::carries_load(std::size_t t) const {
  const Triangle& v = film_.triangles[t];
  return !state_.torn[t] && (floats(v[0]) || floats(v[1]) || floats(v[2]));
}

// A vertex without any film left around it drifts: nothing holds or moves it.
void FloatingSheet::update_load(std::size_t t) {
  const Triangle& v = film_.triangles[t];
  usable_[t] = carries_load(t);
  is_plain_[t] = usable_[t] && !attached(v[0]) && !attached(v[1]) && !attached(v[2]);
  energy_.set_film(t, usable_[t]);
  for (std::int32_t w : v) {
    const auto begin = film_.incident.begin() + film_.incident_begin[std::size_t(w)],
               end = film_.incident.begin() + film_.incident_begin[std::size_t(w) + 1];
    is_free_[std::size_t(w)] = floats(w) && std::any_of(begin, end, [&](std::int32_t other) {
                                 return usable_[std::size_t(other)] != 0;
                               });
  }
}

RestTriangle FloatingSheet::rest_of(std::size_t t, const Feet& feet) const {
  const std::array<Vec2, 3> x = {corner(t, 0, feet), corner(t, 1, feet), corner(t, 2, feet)};
  const double min_area = smallest_area_[t];
  const double area = 0.5 * cross2(x[1] - x[0], x[2] - x[0]);
  if (area >= min_area) return rest_triangle(x[0], x[1], x[2]);
  return rest_from_lengths((x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[0] - x[2]).norm(),
                           min_area);
}

// All at once where nothing is attached.
void FloatingSheet::set_rest(const Feet& feet) {
  const std::vector<std::int32_t> small = energy_.set_flat_rest(plan_, kMinArea);
  for (std::size_t t : feet.line_triangles())
    if (usable_[t]) energy_.set_rest(t, rest_of(t, feet));
  for (std::int32_t t : small) energy_.set_rest(std::size_t(t), rest_of(std::size_t(t), feet));
}

RelaxationResult FloatingSheet::relax(const std::vector<std::uint8_t>& is_free) {
  RelaxationOptions options;
  options.otherwise = &film_.u;
  options.tolerance_mm = tolerance_mm();
  options.tolerance_per_way2 = kTolerancePerWay2;
  options.loosest_mm = kLoosest * options_.step_mm;
  return relaxation_.run(is_free, options);
}

void FloatingSheet::keep_relaxed() {
  energy_.grid().to_vertices(relaxation_.field(), relaxed_);
  foresight_.keep(relaxation_.field());
}

// The error of long steps grows with their square; what is far below it need not be computed.
double FloatingSheet::tolerance_mm() const {
  const double step = options_.step_mm;
  return std::max(RelaxationOptions().tolerance_mm, kTolerancePerStep2 * step * step);
}

void FloatingSheet::put_back(const std::vector<std::uint8_t>& is_free) {
  parallel_for(is_free.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (!is_free[v]) {
        const std::size_t at = energy_.grid().place(v);
        relaxation_.field().set(at, film_at_.at(at));
      }
  });
}

// Most vertices are found where they were found last, all at once.
void FloatingSheet::slide(const Feet& feet) {
  const auto carry = kernels::best().carry;
  const std::int32_t* const corners[3] = {slid_in_corner_[0].data(), slid_in_corner_[1].data(),
                                          slid_in_corner_[2].data()};
  // Film that has let go may have far to go: in several steps.
  const double reach = kLongestSlide * film_.cell_mm + options_.step_mm;
  parallel_for(film_.u.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    const std::size_t first = energy_.grid().place(begin), last = energy_.grid().place(end - 1);
    carry(first, last + 1, corners, film_at_, relaxation_.field(), plan_, reach, slid_,
          found_.data());
    for (std::size_t v = begin; v < end; ++v) {
      const std::size_t at = energy_.grid().place(v);
      if (!is_free_[v]) {
        slid_.set(at, plan_.at(at));
      } else if (!found_[at] || !is_plain_[std::size_t(slid_in_[v])]) {
        const Vec2 from = plan_.at(at), to = look_up(v, feet).value_or(from);
        const double way = (to - from).norm();
        slid_.set(at, way < reach ? to : Vec2(from + reach / way * (to - from)));
      }
    }
  });
  hold_back_folds();
}

// Where the vertex goes if it is not where it was found last, or if a corner there has a ghost.
std::optional<Vec2> FloatingSheet::look_up(std::size_t v, const Feet& feet) {
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
  return at.weight[0] * corner(t, 0, feet) + at.weight[1] * corner(t, 1, feet) +
         at.weight[2] * corner(t, 2, feet);
}

// Where sliding that far would turn floating film over, its vertices stay where they were; there
// it lies the right way up, so this ends.
void FloatingSheet::hold_back_folds() {
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

bool FloatingSheet::folds(std::size_t t) const {
  const Triangle& v = film_.triangles[t];
  if (!usable_[t]) return false;
  const Vec2 a = slid(v[0]);
  if (cross2(slid(v[1]) - a, slid(v[2]) - a) > 0) return false;
  return !attached(v[0]) && !attached(v[1]) && !attached(v[2]);
}

bool FloatingSheet::any_fold() {
  if (!energy_.any_inverted(slid_)) return false;
  for (std::size_t t = 0; t < film_.triangles.size(); ++t)
    if (folds(t)) return true;
  return false;
}

// The gradient du/dX of a triangle with its floating corners where they slide from or to.
Mat2 FloatingSheet::gradient(std::size_t t, const Feet& feet, When when) const {
  std::array<Vec2, 3> x;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t v = film_.triangles[t][k];
    x[k] = !floats(v) ? corner(t, k, feet, when) : when == When::kBefore ? plan(v) : slid(v);
  }
  const RestTriangle rest = rest_triangle(x[0], x[1], x[2]);
  const Triangle& v = film_.triangles[t];
  if (!(rest.area > smallest_area_[t])) return Mat2::Zero();
  return deformation_gradient(rest, film_.u[std::size_t(v[0])], film_.u[std::size_t(v[1])],
                              film_.u[std::size_t(v[2])]);
}

Mat2 FloatingSheet::gradient_at_edge(std::int32_t a, std::int32_t b, const Mat2& otherwise,
                                     const Feet& feet, When when) const {
  Mat2 sum = Mat2::Zero();
  int count = 0;
  for_triangles_at_edge(a, b, [&](std::size_t t) {
    if (!usable_[t]) return;
    const Mat2 F = gradient(t, feet, when);
    if (!usable_gradient(F)) return;
    sum += F;
    ++count;
  });
  return count > 0 ? Mat2(sum / count) : otherwise;
}

}  // namespace hydrodip
