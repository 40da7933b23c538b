#include "dip/tears.h"

#include "base/disjoint_sets.h"
#include "dip/measure.h"

namespace hydrodip {

std::vector<std::uint8_t> Tears::held_vertices(const FloatingSheet& sheet) const {
  if (!any_torn_) return sheet.free_vertices();
  DisjointSets islands(film_.u.size());
  // Usable film with corners that float and corners that do not.
  std::vector<std::size_t> at_edge;
  for (std::size_t t = 0; t < film_.triangles.size(); ++t) {
    const Triangle& corners = film_.triangles[t];
    const int floating = sheet.floating_corners(t);
    if (floating == 0) continue;
    if (floating == 3 && islands.clearly_joined(corners[0], corners[1]) &&
        islands.clearly_joined(corners[1], corners[2]))
      continue;
    std::int32_t first = -1;
    for (std::int32_t v : corners) {
      if (!sheet.floats(v)) continue;
      if (first < 0)
        first = v;
      else
        islands.join(v, first);
    }
    if (floating < 3) at_edge.push_back(t);
  }
  // The first vertex that holds each island, and whether there is another.
  std::vector<std::int32_t> holder(film_.u.size(), -1);
  std::vector<std::uint8_t> held(film_.u.size(), 0);
  for (std::size_t t : at_edge)
    for (std::int32_t v : film_.triangles[t])
      for (std::int32_t w : film_.triangles[t]) {
        if (!sheet.floats(v) || sheet.floats(w)) continue;
        const auto i = islands.find(v);
        if (holder[i] < 0) holder[i] = w;
        held[i] |= std::uint8_t(holder[i] != w);
      }
  std::vector<std::uint8_t> result = sheet.free_vertices();
  for (std::size_t v = 0; v < result.size(); ++v) result[v] &= held[islands.find(std::int32_t(v))];
  return result;
}

// Film that would have to turn over to follow is stretched past any limit: it tears, or if film
// never does, its vertices stay where they are.
void Tears::release(const std::vector<std::int32_t>& blocked, double travelled_mm,
                    FloatingSheet& sheet, std::vector<std::uint8_t>& is_free) {
  if (tear_limit(set_.options) > 0) {
    for (std::int32_t t : blocked) {
      tear(t, travelled_mm);
      sheet.update_load(std::size_t(t));
      sheet.unload(std::size_t(t));
    }
    is_free = held_vertices(sheet);
    return;
  }
  for (std::int32_t t : blocked)
    for (std::int32_t v : film_.triangles[std::size_t(t)]) is_free[std::size_t(v)] = 0;
}

void Tears::tear_overstretched(double travelled_mm, FloatingSheet& sheet) {
  const std::vector<double>& told = set_.options.tears_at_mm;
  const double limit = tear_limit(set_.options);
  if (!(limit > 0) && told.empty()) return;
  std::vector<std::int32_t> tears;
  if (limit > 0) tears = sheet.overstretched(limit);
  for (std::size_t t = 0; t < told.size(); ++t)
    if (sheet.is_usable(t) && travelled_mm >= told[t]) tears.push_back(std::int32_t(t));
  for (std::int32_t t : tears) tear(t, travelled_mm);
}

void Tears::tear(std::int32_t t, double travelled_mm) {
  state_.torn[std::size_t(t)] = 1;
  state_.torn_at_mm[std::size_t(t)] = travelled_mm;
  torn_now_.push_back(std::size_t(t));
  any_torn_ = true;
}

void Tears::update_loads(FloatingSheet& sheet) {
  for (std::size_t t : torn_now_) sheet.update_load(t);
  torn_now_.clear();
}

}  // namespace hydrodip
