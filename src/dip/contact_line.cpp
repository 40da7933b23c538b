// The default scheme. The contact line runs through triangles: every mesh edge from an attached to
// a floating vertex has a foot on the contact line, which climbs the object as the water rises and
// counts the film laid down behind it at the strain that the floating film has there. For the
// equilibrium of the floating film, the attached end of the edge stands where flat film would have
// it (its ghost). docs/model.md derives it.

#include <algorithm>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "dip/feet.h"
#include "dip/flat_levels.h"
#include "dip/floating_sheet.h"
#include "dip/scheme.h"
#include "dip/tears.h"
#include "dip/waterline.h"

namespace hydrodip {

namespace {

// How far the contact line should go in one part of a step, in steps, and the smallest part.
constexpr double kLineAdvance = 4;
constexpr double kSmallestPart = 1.0 / 8;
// So often in a step film that blocks the rest is released.
constexpr int kMostReleases = 30;

class ContactLineScheme : public Scheme {
 public:
  ContactLineScheme(const DipSetting& setting, DipState& state)
      : set_(setting),
        film_(setting.film),
        state_(state),
        waterline_(setting.positions, setting.triangles, setting.film.cell_mm),
        sheet_(setting, state),
        feet_(setting, state),
        tears_(setting, state) {
    if (setting.travel.trajectory().is_straight_down())
      jumps_at_mm_ = flat_levels(setting.positions, setting.triangles,
                                 setting.film.cell_mm * setting.film.cell_mm);
  }

  void write_positions() override {
    parallel_for(film_.u.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        if (state_.state[v] == VertexState::kUnattached)
          state_.position[v] = state_.moment.afloat(sheet_.plan(std::int32_t(v)));
    });
  }

  // In parts where the object rises so gently at the contact line that this one runs fast: where
  // the water first touches something blunt. Where it jumps, a part ends, if need be a little
  // before the moment, and the next step makes up for it.
  void advance(const Moment& to) override {
    const bool last = !(to.travelled_mm < set_.travel.length_mm());
    const double short_mm = last ? 0 : kSmallestPart * set_.options.step_mm;
    while (to.travelled_mm - state_.moment.travelled_mm > short_mm) {
      const double part_mm = std::max(part_, kSmallestPart) * set_.options.step_mm;
      // No sliver of a step at the end.
      const bool ends = to.travelled_mm - state_.moment.travelled_mm < 1.5 * part_mm;
      const double end_mm = ends ? to.travelled_mm : state_.moment.travelled_mm + part_mm;
      const auto jump_mm = next_jump(end_mm);
      take_step(jump_mm ? set_.travel.at(*jump_mm) : ends ? to : set_.travel.at(end_mm));
      part_ = std::clamp(kLineAdvance * feet_.gentlest_rise(), kSmallestPart, 1.0);
    }
  }

 private:
  void take_step(const Moment& to) {
    lower(to);
    relax(to);
    attach(collide(to), to);
    state_.moment = to;
  }

  // The first jump of the contact line on the way on, unless it is so near that a part of a step
  // would be too short.
  std::optional<double> next_jump(double end_mm) const {
    const double shortest_mm = kSmallestPart * set_.options.step_mm;
    const auto jump = std::lower_bound(jumps_at_mm_.begin(), jumps_at_mm_.end(),
                                       state_.moment.travelled_mm + shortest_mm);
    if (jump == jumps_at_mm_.end() || !(*jump < end_mm)) return std::nullopt;
    const double left_mm = set_.travel.length_mm() - *jump;
    return left_mm < shortest_mm ? std::nullopt : std::optional(*jump);
  }

  void lower(const Moment& to) {
    Moment reached = to;
    reached.level_mm -= kReached_mm;
    waterline_.move_to(reached);
    feet_.climb(sheet_, waterline_, to);
    sheet_.set_rest(feet_);
  }

  void relax(const Moment& to) {
    find_equilibrium(to);
    tears_.release_overstretched(to.travelled_mm, sheet_);
    sheet_.slide(feet_);
    feet_.correct(sheet_);
  }

  void find_equilibrium(const Moment& to) {
    std::vector<std::uint8_t> is_free = sheet_.free_vertices();
    sheet_.put_back(is_free);
    for (int round = 0;; ++round) {
      const RelaxationResult result = sheet_.relax(is_free);
      if (result.blocked.empty() || round == kMostReleases) {
        sheet_.keep_relaxed();
        count(result, sheet_.relaxed(), state_.statistics);
        return;
      }
      state_.statistics.iterations += result.iterations;
      tears_.release(result.blocked, to.travelled_mm, sheet_, is_free);
    }
  }

  // The floating vertices whose way through this step, sideways and with the water, meets the
  // object, in their order. Of what has let go nobody knows the way.
  std::vector<Touch> collide(const Moment& to) const {
    // Few, because those that may touch lie together.
    constexpr std::size_t kVerticesPerTask = 256;
    std::vector<std::vector<Touch>> found((film_.u.size() + kVerticesPerTask - 1) /
                                          kVerticesPerTask);
    parallel_for(film_.u.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const auto vertex = static_cast<std::int32_t>(v);
        if (!sheet_.free_vertices()[v]) continue;
        const Vec2 start = sheet_.plan(vertex), end_of_way = sheet_.slid(vertex);
        if (!waterline_.may_touch(start, end_of_way)) continue;
        const auto contact = first_touch(set_.surface, start, state_.moment, end_of_way, to);
        if (contact) found[begin / kVerticesPerTask].push_back({vertex, *contact});
      }
    });
    std::vector<Touch> all;
    for (const std::vector<Touch>& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  void attach(const std::vector<Touch>& touches, const Moment& to) {
    if (to.moved && state_.up.empty()) state_.up.assign(film_.u.size(), Vec3::UnitZ());
    const std::vector<Foot> created = feet_.created_for(touches, sheet_, waterline_, to);
    sheet_.settle();
    for (const Touch& touch : touches) {
      const auto v = std::size_t(touch.vertex);
      state_.state[v] = VertexState::kAttached;
      state_.position[v] = touch.contact.position;
      sheet_.attach_at(touch.vertex, to.to_sinking(touch.contact.position).head<2>());
      if (to.moved) state_.up[v] = to.turn.row(2);
    }
    for (const Touch& touch : touches)
      for (auto n = film_.incident_begin[std::size_t(touch.vertex)];
           n < film_.incident_begin[std::size_t(touch.vertex) + 1]; ++n)
        sheet_.update_load(std::size_t(film_.incident[std::size_t(n)]));
    tears_.end_step(sheet_);
    feet_.replace(created, sheet_);
  }

  const DipSetting set_;
  const FilmMesh& film_;
  DipState& state_;
  Waterline waterline_;
  FloatingSheet sheet_;
  Feet feet_;
  Tears tears_;
  double part_ = 0;                  // of a step, to go at once next
  std::vector<double> jumps_at_mm_;  // travelled where the contact line jumps, ascending
};

}  // namespace

std::unique_ptr<Scheme> make_contact_line_scheme(const DipSetting& setting, DipState& state) {
  return std::make_unique<ContactLineScheme>(setting, state);
}

}  // namespace hydrodip
