// The default scheme. The contact line runs through triangles: every mesh edge from an attached to
// a floating vertex has a foot on the contact line, which climbs the object as the water rises and
// counts the film laid down behind it at the strain that the floating film has there. For the
// equilibrium of the floating film, the attached end of the edge stands where flat film would have
// it (its ghost). docs/model.md derives it.

#include <vector>

#include "base/parallel.h"
#include "dip/feet.h"
#include "dip/floating_sheet.h"
#include "dip/pace.h"
#include "dip/scheme.h"
#include "dip/tears.h"
#include "dip/waterline.h"

namespace hydrodip {

namespace {

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
        tears_(setting, state),
        pace_(setting) {}

  void write_positions() override {
    parallel_for(film_.u.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        if (state_.state[v] == VertexState::kUnattached)
          state_.position[v] = state_.moment.afloat(sheet_.plan(std::int32_t(v)));
    });
  }

  void advance(const Moment& to) override {
    for (;;) {
      const double from_mm = state_.moment.travelled_mm;
      const auto end_mm = pace_.next_end_mm(from_mm, to.travelled_mm);
      if (!end_mm) return;
      take_step(*end_mm == to.travelled_mm ? to : set_.travel.at(*end_mm));
      state_.statistics.steps_at_mm.push_back(*end_mm);
      pace_.see(feet_, tears_.any(), from_mm, *end_mm);
    }
  }

 private:
  void take_step(const Moment& to) {
    lower(to);
    relax(to);
    attach(collide(to), to);
    state_.moment = to;
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
    sheet_.foresee(to.travelled_mm);
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
  Pace pace_;
};

}  // namespace

std::unique_ptr<Scheme> make_contact_line_scheme(const DipSetting& setting, DipState& state) {
  return std::make_unique<ContactLineScheme>(setting, state);
}

}  // namespace hydrodip
