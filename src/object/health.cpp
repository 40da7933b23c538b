#include "object/health.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/run_scope.h"
#include "object/edges.h"
#include "object/polygon.h"

namespace hydrodip {

namespace {

// Turns of a loop over triangles between two looks whether the job was cancelled.
constexpr int kTurns = 1 << 14;

// ---- welding ------------------------------------------------------------------------------------

std::uint64_t hash_position(const Vec3& p) {
  std::uint64_t hash = 0x9e3779b97f4a7c15u;
  for (int i = 0; i < 3; ++i) {
    const double coordinate = p[i] + 0.0;  // -0 equals 0
    std::uint64_t bits = 0;
    std::memcpy(&bits, &coordinate, sizeof bits);
    hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
    hash ^= hash >> 32;
  }
  return hash;
}

// Merges equal positions and drops those that no triangle uses; attributes live at the triangles'
// corners, so nothing else has to follow. New order: first use.
void weld(Object& object) {
  std::size_t slots = 16;
  while (slots < 2 * object.positions.size()) slots *= 2;
  std::vector<std::int32_t> table(slots, -1);
  std::vector<std::int32_t> renamed(object.positions.size(), -1);
  std::vector<Vec3> kept;
  auto rename = [&](std::int32_t old) {
    std::int32_t& name = renamed[std::size_t(old)];
    if (name >= 0) return name;
    const Vec3& p = object.positions[std::size_t(old)];
    std::size_t slot = hash_position(p) & (slots - 1);
    while (table[slot] >= 0 && kept[std::size_t(table[slot])] != p) slot = (slot + 1) & (slots - 1);
    if (table[slot] < 0) {
      table[slot] = std::int32_t(kept.size());
      kept.push_back(p);
    }
    return name = table[slot];
  };
  CheckEvery check(kTurns);
  for (Triangle& triangle : object.triangles) {
    check();
    for (std::int32_t& vertex : triangle) vertex = rename(vertex);
  }
  object.positions = std::move(kept);
}

// ---- seams ----

// Of a surface's rims, where each is told from its neighbours: cells of the size of what
// coordinates of seven digits leave open, in order.
struct RimCell {
  std::array<std::int64_t, 3> cell;
  std::int32_t vertex;
  bool operator<(const RimCell& other) const {
    return std::tie(cell, vertex) < std::tie(other.cell, other.vertex);
  }
};

std::vector<std::int32_t> rim_vertices(const std::vector<TriangleSide>& sides) {
  std::vector<std::int32_t> rim;
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 1) return;
    rim.push_back(sides[begin].low_vertex());
    rim.push_back(sides[begin].high_vertex());
  });
  sort_unless_cancelled(rim.begin(), rim.end(), std::less<>());
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  return rim;
}

// Joins vertices of rims that rounding alone has parted, as the ends of a turned profile (0 and the
// sine of a whole turn). True if there were any.
bool close_seams(Object& object, const std::vector<TriangleSide>& sides) {
  constexpr double kRoundings = 4, kMostOfSize = 1e-6;
  const std::vector<std::int32_t> rim = rim_vertices(sides);
  const Box3 box = object.bounds();
  const double apart = std::min(kMostOfSize * box.size().norm(),
                                kRoundings * double(std::numeric_limits<float>::epsilon()) *
                                    box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff());
  if (rim.empty() || !(apart > 0)) return false;
  std::vector<RimCell> cells;
  cells.reserve(rim.size());
  for (const std::int32_t v : rim) {
    const Vec3 at = object.positions[std::size_t(v)] / apart;
    cells.push_back({{std::int64_t(std::floor(at.x())), std::int64_t(std::floor(at.y())),
                      std::int64_t(std::floor(at.z()))},
                     v});
  }
  sort_unless_cancelled(cells.begin(), cells.end(), std::less<>());
  DisjointSets same(object.positions.size());
  bool any = false;
  CheckEvery check(kTurns);
  for (const RimCell& one : cells) {
    check();
    const Vec3& p = object.positions[std::size_t(one.vertex)];
    for (int around = 0; around < 9; ++around) {
      // Three cells along z lie one after another.
      const std::array<std::int64_t, 3> from = {one.cell[0] + around % 3 - 1,
                                                one.cell[1] + around / 3 - 1, one.cell[2] - 1};
      auto at = std::lower_bound(cells.begin(), cells.end(), RimCell{from, 0});
      for (; at != cells.end() && at->cell[0] == from[0] && at->cell[1] == from[1] &&
             at->cell[2] <= from[2] + 2;
           ++at) {
        if (at->vertex <= one.vertex ||
            (object.positions[std::size_t(at->vertex)] - p).norm() > apart)
          continue;
        same.join(one.vertex, at->vertex);
        any = true;
      }
    }
  }
  if (!any) return false;
  for (Triangle& triangle : object.triangles)
    for (std::int32_t& v : triangle) v = std::int32_t(same.find(std::uint32_t(v)));
  return true;
}

// ---- faces to drop ------------------------------------------------------------------------------

template <typename T>
void keep_only(std::vector<T>& values, const std::vector<char>& drop) {
  if (values.empty()) return;
  std::size_t out = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!drop[i]) values[out++] = values[i];
  }
  values.resize(out);
}

long drop_faces(Object& object, const std::vector<char>& drop) {
  const long count = long(std::count(drop.begin(), drop.end(), char(1)));
  if (count == 0) return 0;
  keep_only(object.triangles, drop);
  keep_only(object.material_of, drop);
  keep_only(object.uvs, drop);
  keep_only(object.colors, drop);
  return count;
}

long drop_collapsed(Object& object) {
  std::vector<char> drop(object.triangles.size(), 0);
  for (std::size_t i = 0; i < drop.size(); ++i) {
    const Triangle& t = object.triangles[i];
    drop[i] = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  }
  return drop_faces(object, drop);
}

// Corners on one line: such a sliver still joins its neighbours, so it goes last.
long drop_slivers(Object& object) {
  constexpr double kRelativeArea = 1e-14;
  std::vector<char> drop(object.triangles.size(), 0);
  for (std::size_t i = 0; i < drop.size(); ++i) {
    const Triangle& t = object.triangles[i];
    const Vec3& a = object.positions[std::size_t(t[0])];
    const Vec3 ab = object.positions[std::size_t(t[1])] - a;
    const Vec3 ac = object.positions[std::size_t(t[2])] - a;
    const double longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    drop[i] = !(ab.cross(ac).norm() > kRelativeArea * longest2);
  }
  return drop_faces(object, drop);
}

bool same_winding(const Triangle& a, const Triangle& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (a[0] == b[k]) return a[1] == b[(k + 1) % 3];
  return false;
}

// A face that lay on another one, its back to that one's front, and went.
struct BackToBack {
  std::size_t kept;  // the other
  Triangle kept_corners, corners;
  int material = 0;
  CornerUv uvs;
  CornerColor colors;
};

BackToBack back_to_back(const Object& object, std::size_t kept, std::size_t gone) {
  BackToBack pair{kept, object.triangles[kept], object.triangles[gone], 0, {}, {}};
  if (!object.material_of.empty()) pair.material = object.material_of[gone];
  if (!object.uvs.empty()) pair.uvs = object.uvs[gone];
  if (!object.colors.empty()) pair.colors = object.colors[gone];
  return pair;
}

// Of two faces, each the other's back, the one that turned out to look outward is seen.
void show_outer(Object& object, const std::vector<BackToBack>& pairs) {
  for (const BackToBack& pair : pairs) {
    if (same_winding(object.triangles[pair.kept], pair.kept_corners)) continue;
    object.triangles[pair.kept] = pair.corners;
    if (!object.material_of.empty()) object.material_of[pair.kept] = pair.material;
    if (!object.uvs.empty()) object.uvs[pair.kept] = pair.uvs;
    if (!object.colors.empty()) object.colors[pair.kept] = pair.colors;
  }
}

// `backs`: of those that were dropped, in the numbers of the faces that stay.
long drop_duplicates(Object& object, std::vector<BackToBack>& backs) {
  struct Key {
    Triangle corners;
    std::int32_t face;
  };
  std::vector<Key> keys(object.triangles.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i] = {object.triangles[i], std::int32_t(i)};
    std::sort(keys[i].corners.begin(), keys[i].corners.end());
  }
  sort_unless_cancelled(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.corners, a.face) < std::tie(b.corners, b.face);
  });
  std::vector<char> drop(keys.size(), 0);
  std::size_t first = 0;
  bool has_back = false;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].corners != keys[first].corners) {
      first = i;
      has_back = false;
      continue;
    }
    const auto kept = std::size_t(keys[first].face), gone = std::size_t(keys[i].face);
    drop[gone] = 1;
    if (has_back || same_winding(object.triangles[kept], object.triangles[gone])) continue;
    has_back = true;
    backs.push_back(back_to_back(object, kept, gone));
  }
  std::sort(backs.begin(), backs.end(),
            [](const BackToBack& a, const BackToBack& b) { return a.kept < b.kept; });
  std::size_t face = 0, before = 0;
  for (BackToBack& pair : backs) {
    for (; face < pair.kept; ++face) before += drop[face] ? 1 : 0;
    pair.kept -= before;
  }
  return drop_faces(object, drop);
}

// ---- edges --------------------------------------------------------------------------------------

void count_edges(const Object& object, const std::vector<TriangleSide>& sides, MeshHealth& health) {
  DisjointSets rims(object.positions.size());
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin > 2) ++health.nonmanifold_edges;
    if (end - begin != 1) return;
    ++health.boundary_edges;
    rims.join(sides[begin].low_vertex(), sides[begin].high_vertex());
  });
  for (const std::int32_t vertex : rim_vertices(sides))
    health.holes += rims.is_root(std::size_t(vertex));
}

long count_shells(const Object& object) {
  DisjointSets sets(object.positions.size());
  for (const Triangle& t : object.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[1], t[2]);
  }
  long shells = 0;  // welding left no unused position
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    shells += sets.is_root(i);
  }
  return shells;
}

// ---- small holes --------------------------------------------------------------------------------

// Closes holes that are small beside the object and beside the shell that they are in.
class HoleFiller {
 public:
  HoleFiller(Object& object, const std::vector<TriangleSide>& sides)
      : object_(object), sides_(sides) {}

  // Returns how many it closed.
  long run() {
    collect_rims();
    if (rims_.empty()) return 0;
    const double largest = kRelativeSize * object_.bounds().size().norm();
    std::vector<char> seen(rims_.size(), 0);
    long closed = 0;
    for (std::size_t start = 0; start < rims_.size(); ++start) {
      if (seen[start]) continue;
      const std::vector<std::size_t> loop = trace(start, largest, seen);
      if (loop.size() < 3 || !shell_dwarfs(loop)) continue;
      fill(loop);
      ++closed;
    }
    return closed;
  }

 private:
  static constexpr double kRelativeSize = 0.003;
  static constexpr std::size_t kMostCorners = 1000;

  // An open edge, in the direction in which its triangle runs.
  struct Rim {
    std::int32_t from, to;
    std::uint32_t place;
  };

  void collect_rims() {
    for_each_edge(sides_, [&](std::size_t begin, std::size_t end) {
      if (end - begin != 1) return;
      const std::uint32_t place = sides_[begin].place;
      const Triangle& t = object_.triangles[place / 3];
      rims_.push_back({t[place % 3], t[(place + 1) % 3], place});
    });
    std::sort(rims_.begin(), rims_.end(), [](const Rim& a, const Rim& b) {
      return std::tie(a.from, a.place) < std::tie(b.from, b.place);
    });
  }

  // The only open edge that begins at the vertex, or none.
  std::optional<std::size_t> leaving(std::int32_t vertex) const {
    const auto first =
        std::lower_bound(rims_.begin(), rims_.end(), vertex,
                         [](const Rim& rim, std::int32_t wanted) { return rim.from < wanted; });
    if (first == rims_.end() || first->from != vertex) return {};
    if (first + 1 != rims_.end() && (first + 1)->from == vertex) return {};
    return std::size_t(first - rims_.begin());
  }

  // The edges around a small hole, or nothing.
  std::vector<std::size_t> trace(std::size_t start, double largest, std::vector<char>& seen) const {
    std::vector<std::size_t> loop;
    Box3 box;
    for (std::size_t at = start;;) {
      seen[at] = 1;
      loop.push_back(at);
      box.add(object_.positions[std::size_t(rims_[at].from)]);
      if (loop.size() > kMostCorners || box.size().norm() > largest) return {};
      const auto next = leaving(rims_[at].to);
      if (!next) return {};
      if (*next == start) return loop;
      if (seen[*next]) return {};
      at = *next;
    }
  }

  // A loose scrap's outline is no hole.
  bool shell_dwarfs(const std::vector<std::size_t>& loop) {
    if (shell_boxes_.empty()) measure_shells();
    Box3 box;
    for (const std::size_t at : loop) box.add(object_.positions[std::size_t(rims_[at].from)]);
    const auto shell = shells_->find(std::uint32_t(rims_[loop[0]].from));
    return shell_boxes_[shell].size().norm() > 4 * box.size().norm();
  }

  void measure_shells() {
    shells_.emplace(object_.positions.size());
    for (const Triangle& t : object_.triangles) {
      shells_->join(t[0], t[1]);
      shells_->join(t[1], t[2]);
    }
    shell_boxes_.resize(object_.positions.size());
    for (std::size_t v = 0; v < object_.positions.size(); ++v)
      shell_boxes_[shells_->find(std::uint32_t(v))].add(object_.positions[v]);
  }

  // Against the open edges' direction, so that the new triangles face as their neighbours do. They
  // look like the neighbours at their corners.
  void fill(std::vector<std::size_t> loop) {
    std::reverse(loop.begin(), loop.end());
    std::vector<Vec3> corners;
    corners.reserve(loop.size());
    for (const std::size_t at : loop)
      corners.push_back(object_.positions[std::size_t(rims_[at].from)]);
    for (const auto& cut : triangulate(corners)) {
      std::array<std::uint32_t, 3> places{};
      for (std::size_t c = 0; c < 3; ++c) places[c] = rims_[loop[std::size_t(cut[c])]].place;
      const int material = object_.material_of[places[0] / 3];
      // Where materials meet, one of them goes on alone.
      for (std::uint32_t& place : places)
        if (object_.material_of[place / 3] != material) place = places[0];
      object_.triangles.push_back({rims_[loop[std::size_t(cut[0])]].from,
                                   rims_[loop[std::size_t(cut[1])]].from,
                                   rims_[loop[std::size_t(cut[2])]].from});
      object_.material_of.push_back(material);
      copy_corners(object_.uvs, places);
      copy_corners(object_.colors, places);
    }
  }

  template <typename Corner>
  static void copy_corners(std::vector<std::array<Corner, 3>>& values,
                           const std::array<std::uint32_t, 3>& places) {
    if (values.empty()) return;
    std::array<Corner, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = values[places[c] / 3][places[c] % 3];
    values.push_back(corners);
  }

  Object& object_;
  const std::vector<TriangleSide>& sides_;
  std::vector<Rim> rims_;
  std::optional<DisjointSets> shells_;
  std::vector<Box3> shell_boxes_;
};

// ---- orientation --------------------------------------------------------------------------------

// A patch: faces connected across edges that exactly two faces share.
struct Patches {
  std::vector<std::int32_t> patch_of;  // per face
  std::vector<char> turn;              // per face: whether to flip it
  std::vector<char> closed;            // per patch
  long torn_edges = 0;                 // where no choice agrees: a one-sided surface
  std::size_t count() const { return closed.size(); }
};

// For each side its partner across a two-face edge, or -1.
std::vector<std::int32_t> partners(const std::vector<TriangleSide>& sides) {
  std::vector<std::int32_t> partner(sides.size(), -1);
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 2) return;
    partner[sides[begin].place] = std::int32_t(sides[begin + 1].place);
    partner[sides[begin + 1].place] = std::int32_t(sides[begin].place);
  });
  return partner;
}

bool same_direction(const Object& object, std::int32_t place_a, std::int32_t place_b) {
  const auto start = [&](std::int32_t place) {
    return object.triangles[std::size_t(place / 3)][std::size_t(place % 3)];
  };
  return start(place_a) == start(place_b);
}

// Floods each patch from its first face; a neighbour that runs along the shared edge in the same
// direction faces the other way.
Patches agree_within_patches(const Object& object, const std::vector<TriangleSide>& sides) {
  const std::vector<std::int32_t> partner = partners(sides);
  Patches patches;
  patches.patch_of.assign(object.triangles.size(), -1);
  patches.turn.assign(object.triangles.size(), 0);
  std::vector<std::int32_t> queue;
  CheckEvery check(kTurns);
  for (std::size_t seed = 0; seed < object.triangles.size(); ++seed) {
    if (patches.patch_of[seed] >= 0) continue;
    const auto patch = std::int32_t(patches.count());
    patches.closed.push_back(1);
    patches.patch_of[seed] = patch;
    queue.assign(1, std::int32_t(seed));
    while (!queue.empty()) {
      check();
      const std::int32_t face = queue.back();
      queue.pop_back();
      for (std::int32_t place = 3 * face; place < 3 * face + 3; ++place) {
        const std::int32_t across = partner[std::size_t(place)];
        if (across < 0) continue;
        const char turn =
            char(patches.turn[std::size_t(face)] ^ same_direction(object, place, across));
        const auto other = std::size_t(across / 3);
        if (patches.patch_of[other] < 0) {
          patches.patch_of[other] = patch;
          patches.turn[other] = turn;
          queue.push_back(std::int32_t(other));
        } else if (patches.turn[other] != turn && std::size_t(face) < other) {
          ++patches.torn_edges;
        }
      }
    }
  }
  return patches;
}

// A patch is closed if around every edge its own faces cancel: as many run up as run down.
void find_closed(const Object& object, const std::vector<TriangleSide>& sides, Patches& patches) {
  std::vector<std::pair<std::int32_t, int>> balance;
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    balance.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const auto face = std::size_t(face_of(sides[i]));
      const bool up = runs_up(object, sides[i]) != bool(patches.turn[face]);
      balance.emplace_back(patches.patch_of[face], up ? 1 : -1);
    }
    std::sort(balance.begin(), balance.end());
    for (std::size_t i = 0; i < balance.size();) {
      const std::int32_t patch = balance[i].first;
      int sum = 0;
      for (; i < balance.size() && balance[i].first == patch; ++i) sum += balance[i].second;
      if (sum != 0) patches.closed[std::size_t(patch)] = 0;
    }
  });
}

// Six times the signed volume between the triangle and `origin`.
double volume6(const Object& object, std::size_t face, const Vec3& origin) {
  const Triangle& t = object.triangles[face];
  return (object.positions[std::size_t(t[0])] - origin)
      .cross(object.positions[std::size_t(t[1])] - origin)
      .dot(object.positions[std::size_t(t[2])] - origin);
}

// What orientation needs to know of a patch.
struct PatchShape {
  double volume6 = 0;
  Box3 box;
  std::int32_t first_face = -1;
  long faces = 0;
  long turned = 0;
};

std::vector<PatchShape> measure(const Object& object, const Patches& patches) {
  std::vector<PatchShape> shapes(patches.count());
  for (std::size_t f = 0; f < object.triangles.size(); ++f) {
    PatchShape& shape = shapes[std::size_t(patches.patch_of[f])];
    if (shape.first_face < 0) shape.first_face = std::int32_t(f);
    const Vec3& origin =
        object.positions[std::size_t(object.triangles[std::size_t(shape.first_face)][0])];
    shape.volume6 += (patches.turn[f] ? -1 : 1) * volume6(object, f, origin);
    for (const std::int32_t v : object.triangles[f])
      shape.box.add(object.positions[std::size_t(v)]);
    ++shape.faces;
    shape.turned += patches.turn[f];
  }
  return shapes;
}

// Counts how often a vertical ray from a point crosses a closed patch. Triangles are filed by the
// columns of a grid over x and y, so that many small shells inside a large one stay cheap.
class CrossingCounter {
 public:
  CrossingCounter(const Object& object, const std::vector<std::int32_t>& faces, const Box3& box)
      : object_(object), min_(box.min) {
    cells_ = std::max(1, int(std::sqrt(double(faces.size()) / 2)));
    const Vec3 size = box.size();
    scale_ = Vec2(size.x() > 0 ? cells_ / size.x() : 0, size.y() > 0 ? cells_ / size.y() : 0);
    for (const std::int32_t face : faces) file(face);
    sort_unless_cancelled(entries_.begin(), entries_.end(), std::less<>());
  }

  bool inside(const Vec3& p) const {
    const std::int64_t cell = std::int64_t(column(p.x(), 0)) * cells_ + column(p.y(), 1);
    auto it = std::lower_bound(entries_.begin(), entries_.end(), std::make_pair(cell, -1));
    bool odd = false;
    for (; it != entries_.end() && it->first == cell; ++it) odd ^= crosses_above(it->second, p);
    return odd;
  }

 private:
  int column(double coordinate, int axis) const {
    return int(std::clamp((coordinate - min_[axis]) * scale_[axis], 0.0, double(cells_ - 1)));
  }

  void file(std::int32_t face) {
    Box3 box;
    for (const std::int32_t v : object_.triangles[std::size_t(face)]) {
      box.add(object_.positions[std::size_t(v)]);
    }
    for (int i = column(box.min.x(), 0); i <= column(box.max.x(), 0); ++i) {
      check_cancelled();
      for (int j = column(box.min.y(), 1); j <= column(box.max.y(), 1); ++j) {
        entries_.emplace_back(std::int64_t(i) * cells_ + j, face);
      }
    }
  }

  // The crossing rule of an edge is half-open in y and evaluated from its lower vertex index, so
  // two triangles that share an edge never both claim or both miss a point on it.
  bool crosses_above(std::int32_t face, const Vec3& p) const {
    const Triangle& t = object_.triangles[std::size_t(face)];
    bool within = false;
    for (std::size_t i = 0; i < 3; ++i) {
      std::int32_t ia = t[i], ib = t[(i + 1) % 3];
      if (ib < ia) std::swap(ia, ib);
      const Vec3& a = object_.positions[std::size_t(ia)];
      const Vec3& b = object_.positions[std::size_t(ib)];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      const double x = a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      within ^= p.x() < x;
    }
    if (!within) return false;
    const Vec3& a = object_.positions[std::size_t(t[0])];
    const Vec3 normal =
        (object_.positions[std::size_t(t[1])] - a).cross(object_.positions[std::size_t(t[2])] - a);
    return normal.z() != 0 && normal.dot(a - p) / normal.z() > 0;
  }

  const Object& object_;
  Vec3 min_;
  int cells_ = 1;
  Vec2 scale_;
  std::vector<std::pair<std::int64_t, std::int32_t>> entries_;
};

bool box_inside(const Box3& inner, const Box3& outer) {
  return (inner.min.array() >= outer.min.array()).all() &&
         (inner.max.array() <= outer.max.array()).all();
}

// Pairs of closed patches (container, candidate) of which the first may surround the second: its
// box does, and it is larger. Swept along the longest axis, so that thousands of small shells side
// by side need not be compared each with each. Sorted by container.
std::vector<std::pair<std::int32_t, std::int32_t>> nested_boxes(
    const std::vector<std::int32_t>& by_volume, const std::vector<PatchShape>& shapes) {
  Box3 all;
  for (const std::int32_t patch : by_volume) {
    all.add(shapes[std::size_t(patch)].box.min);
    all.add(shapes[std::size_t(patch)].box.max);
  }
  int axis = 0;
  all.size().maxCoeff(&axis);
  // Places in by_volume; a smaller place means a larger patch.
  std::vector<std::int32_t> order(by_volume.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = std::int32_t(i);
  const auto box = [&](std::int32_t place) -> const Box3& {
    return shapes[std::size_t(by_volume[std::size_t(place)])].box;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return box(a).min[axis] < box(b).min[axis];
  });
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  std::vector<std::int32_t> open;
  for (const std::int32_t place : order) {
    check_cancelled();
    const double at = box(place).min[axis];
    std::erase_if(open, [&](std::int32_t other) { return box(other).max[axis] < at; });
    for (const std::int32_t other : open) {
      const std::int32_t outer = std::min(place, other), inner = std::max(place, other);
      if (box_inside(box(inner), box(outer)))
        pairs.emplace_back(by_volume[std::size_t(outer)], by_volume[std::size_t(inner)]);
    }
    open.push_back(place);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// Per patch: how many other closed patches surround it.
std::vector<int> nesting_depth(const Object& object, const Patches& patches,
                               const std::vector<PatchShape>& shapes) {
  std::vector<int> depth(shapes.size(), 0);
  std::vector<std::int32_t> by_volume;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (patches.closed[i]) by_volume.push_back(std::int32_t(i));
  }
  if (by_volume.size() < 2) return depth;
  std::vector<std::vector<std::int32_t>> members(shapes.size());
  for (std::size_t f = 0; f < patches.patch_of.size(); ++f) {
    members[std::size_t(patches.patch_of[f])].push_back(std::int32_t(f));
  }
  std::stable_sort(by_volume.begin(), by_volume.end(), [&](std::int32_t a, std::int32_t b) {
    return std::abs(shapes[std::size_t(a)].volume6) > std::abs(shapes[std::size_t(b)].volume6);
  });
  const auto pairs = nested_boxes(by_volume, shapes);
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    check_cancelled();
    const auto container = std::size_t(pairs[begin].first);
    const CrossingCounter counter(object, members[container], shapes[container].box);
    for (; end < pairs.size() && pairs[end].first == pairs[begin].first; ++end) {
      const auto candidate = std::size_t(pairs[end].second);
      const Triangle& t = object.triangles[std::size_t(shapes[candidate].first_face)];
      const Vec3 probe =
          (object.positions[std::size_t(t[0])] + object.positions[std::size_t(t[1])] +
           object.positions[std::size_t(t[2])]) /
          3;
      depth[candidate] += counter.inside(probe);
    }
  }
  return depth;
}

// Whether each patch, made consistent by `turn`, must be turned over as a whole.
std::vector<char> patches_to_invert(const Object& object, const Patches& patches) {
  const std::vector<PatchShape> shapes = measure(object, patches);
  const std::vector<int> depth = nesting_depth(object, patches, shapes);
  std::vector<char> invert(shapes.size(), 0);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (patches.closed[i] && shapes[i].volume6 != 0) {
      const bool cavity = depth[i] % 2 == 1;
      invert[i] = (shapes[i].volume6 < 0) != cavity;
    } else {
      invert[i] = 2 * shapes[i].turned > shapes[i].faces;
    }
  }
  return invert;
}

void flip(Object& object, std::size_t face) {
  std::swap(object.triangles[face][1], object.triangles[face][2]);
  if (!object.uvs.empty()) std::swap(object.uvs[face][1], object.uvs[face][2]);
  if (!object.colors.empty()) std::swap(object.colors[face][1], object.colors[face][2]);
}

void orient(Object& object, const std::vector<TriangleSide>& sides, MeshHealth& health) {
  Patches patches = agree_within_patches(object, sides);
  find_closed(object, sides, patches);
  const std::vector<char> invert = patches_to_invert(object, patches);
  for (std::size_t f = 0; f < object.triangles.size(); ++f) {
    if (bool(patches.turn[f]) == bool(invert[std::size_t(patches.patch_of[f])])) continue;
    flip(object, f);
    ++health.flipped;
  }
  health.one_sided_edges = patches.torn_edges;
}

void measure_mesh(const Object& object, MeshHealth& health) {
  const Vec3 origin = object.bounds().center();
  for (std::size_t f = 0; f < object.triangles.size(); ++f) {
    const Triangle& t = object.triangles[f];
    const Vec3& a = object.positions[std::size_t(t[0])];
    health.area_mm2 += 0.5 * (object.positions[std::size_t(t[1])] - a)
                                 .cross(object.positions[std::size_t(t[2])] - a)
                                 .norm();
    health.volume_mm3 += volume6(object, f, origin) / 6;
  }
  health.vertices = long(object.positions.size());
  health.triangles = long(object.triangles.size());
}

std::string counted(long count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace

std::vector<std::string> MeshHealth::findings() const {
  std::vector<std::string> out;
  if (degenerate_removed > 0) {
    out.push_back(fmt::format("Removed {} without area.",
                              counted(degenerate_removed, "triangle", "triangles")));
  }
  if (duplicates_removed > 0) {
    out.push_back(
        fmt::format("Removed {} there already.",
                    counted(duplicates_removed, "triangle that was", "triangles that were")));
  }
  if (flipped > 0) {
    out.push_back(fmt::format("Turned over {} that faced the wrong way.",
                              counted(flipped, "triangle", "triangles")));
  }
  if (holes_closed > 0) {
    out.push_back(fmt::format(
        "Closed {} smaller than 0.3 % of the object, so that the film does not tear there.",
        counted(holes_closed, "hole", "holes")));
  }
  if (boundary_edges > 0) {
    out.push_back(fmt::format("The surface has {} ({}); it is dipped as it is, open.",
                              counted(holes, "hole", "holes"),
                              counted(boundary_edges, "open edge", "open edges")));
  }
  if (nonmanifold_edges > 0) {
    out.push_back(
        fmt::format("At {} more than two triangles meet; inner walls are ignored where "
                    "the film cannot reach them.",
                    counted(nonmanifold_edges, "edge", "edges")));
  }
  if (one_sided_edges > 0) {
    out.push_back(
        fmt::format("The surface is one-sided like a Moebius strip at {}, so its outside "
                    "is undefined there.",
                    counted(one_sided_edges, "edge", "edges")));
  }
  if (shells > 1) {
    out.push_back(fmt::format("The model consists of {} separate shells.", shells));
  }
  return out;
}

MeshHealth check_and_repair(Object& object) {
  MeshHealth health;
  weld(object);
  health.degenerate_removed = drop_collapsed(object);
  std::vector<BackToBack> backs;
  health.duplicates_removed = drop_duplicates(object, backs);
  {
    std::vector<TriangleSide> sides = sorted_sides(object);
    if (close_seams(object, sides)) sides = sorted_sides(object);
    health.holes_closed = HoleFiller(object, sides).run();
    if (health.holes_closed > 0) sides = sorted_sides(object);
    count_edges(object, sides, health);
    orient(object, sides, health);
    show_outer(object, backs);
  }
  health.degenerate_removed += drop_slivers(object);
  weld(object);  // positions that only dropped faces used
  health.shells = count_shells(object);
  measure_mesh(object, health);
  return health;
}

}  // namespace hydrodip
