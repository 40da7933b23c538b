#include "dip/tears.h"

#include <limits>

#include "dip/measure.h"

namespace hydrodip {

// Film that would have to turn over to follow is stretched past any limit: it lets go, and what is
// overstretched beside it; or if film never does, its vertices stay where they are.
void Tears::release(const std::vector<std::int32_t>& blocked, double travelled_mm,
                    FloatingSheet& sheet, std::vector<std::uint8_t>& is_free) {
  const double limit = let_go_limit(set_.options);
  if (limit > 0) {
    for (std::int32_t t : blocked) let_go(t, travelled_mm);
    for (std::int32_t t : sheet.overstretched(limit)) let_go(t, travelled_mm);
    drop_scraps(travelled_mm, sheet);
    for (; unloaded_ < torn_now_.size(); ++unloaded_) {
      sheet.update_load(torn_now_[unloaded_]);
      sheet.unload(torn_now_[unloaded_]);
    }
    is_free = sheet.free_vertices();
    return;
  }
  for (std::int32_t t : blocked)
    for (std::int32_t v : film_.triangles[std::size_t(t)]) is_free[std::size_t(v)] = 0;
}

void Tears::release_overstretched(double travelled_mm, const FloatingSheet& sheet) {
  const std::vector<double>& told = set_.options.tears_at_mm;
  const double limit = let_go_limit(set_.options);
  if (!(limit > 0) && told.empty()) return;
  if (limit > 0)
    for (std::int32_t t : sheet.overstretched(limit)) let_go(t, travelled_mm);
  for (std::size_t t = 0; t < told.size(); ++t)
    if (sheet.is_usable(t) && travelled_mm >= told[t]) let_go(std::int32_t(t), travelled_mm);
  if (torn_now_.size() > unloaded_) drop_scraps(travelled_mm, sheet);
}

void Tears::let_go(std::int32_t t, double travelled_mm) {
  if (state_.torn[std::size_t(t)]) return;
  state_.torn[std::size_t(t)] = 1;
  state_.torn_at_mm[std::size_t(t)] = travelled_mm;
  torn_now_.push_back(std::size_t(t));
}

// An opening of the film's shape: the inner triangles, which have no corner at a free edge, as far
// as they hang together with the rim, and whatever has a floating corner in common with those.
void Tears::drop_scraps(double travelled_mm, const FloatingSheet& sheet) {
  std::vector<std::uint8_t> at_free_edge(film_.u.size(), 0);
  for (std::size_t t = 0; t < film_.triangles.size(); ++t)
    if (state_.torn[t])
      for (std::int32_t v : film_.triangles[t]) at_free_edge[std::size_t(v)] |= sheet.floats(v);
  std::vector<std::uint8_t> inner(film_.triangles.size(), 0);
  std::vector<std::int32_t> front;
  for (std::size_t t = 0; t < inner.size(); ++t) {
    if (!carries(t, sheet)) continue;
    const Triangle& v = film_.triangles[t];
    inner[t] = !at_free_edge[std::size_t(v[0])] && !at_free_edge[std::size_t(v[1])] &&
               !at_free_edge[std::size_t(v[2])];
    const bool at_rim = film_.on_rim[std::size_t(v[0])] || film_.on_rim[std::size_t(v[1])] ||
                        film_.on_rim[std::size_t(v[2])];
    if (!inner[t] || !at_rim) continue;
    inner[t] = 0;
    front.push_back(std::int32_t(t));
  }
  // Triangles of the front have been reached, and are no longer marked.
  std::vector<std::uint8_t> holds(film_.u.size(), 0);
  while (!front.empty()) {
    const auto t = std::size_t(front.back());
    front.pop_back();
    for (std::int32_t v : film_.triangles[t]) holds[std::size_t(v)] |= sheet.floats(v);
    for (const std::int32_t next : film_.neighbor[t]) {
      if (next < 0 || !inner[std::size_t(next)]) continue;
      inner[std::size_t(next)] = 0;
      front.push_back(next);
    }
  }
  for (std::size_t t = 0; t < inner.size(); ++t) {
    if (!carries(t, sheet)) continue;
    const Triangle& v = film_.triangles[t];
    if (!holds[std::size_t(v[0])] && !holds[std::size_t(v[1])] && !holds[std::size_t(v[2])])
      let_go(std::int32_t(t), travelled_mm);
  }
}

void Tears::end_step(FloatingSheet& sheet) {
  for (const std::size_t t : torn_now_) {
    const Triangle& v = film_.triangles[t];
    if (sheet.attached(v[0]) && sheet.attached(v[1]) && sheet.attached(v[2])) {
      state_.torn[t] = 0;
      state_.torn_at_mm[t] = std::numeric_limits<double>::infinity();
    }
    any_ = any_ || state_.torn[t];
    sheet.update_load(t);
  }
  torn_now_.clear();
  unloaded_ = 0;
}

}  // namespace hydrodip
