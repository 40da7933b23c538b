#include "object/orientation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include "base/run_scope.h"

namespace hydrodip {

namespace {

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
  CheckEvery check(kTrianglesBetweenChecks);
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

}  // namespace

double volume6(const Object& object, std::size_t face, const Vec3& origin) {
  const Triangle& t = object.triangles[face];
  return (object.positions[std::size_t(t[0])] - origin)
      .cross(object.positions[std::size_t(t[1])] - origin)
      .dot(object.positions[std::size_t(t[2])] - origin);
}

Orientation orient_faces(Object& object, const std::vector<TriangleSide>& sides) {
  Orientation done;
  Patches patches = agree_within_patches(object, sides);
  find_closed(object, sides, patches);
  const std::vector<char> invert = patches_to_invert(object, patches);
  for (std::size_t f = 0; f < object.triangles.size(); ++f) {
    if (bool(patches.turn[f]) == bool(invert[std::size_t(patches.patch_of[f])])) continue;
    flip(object, f);
    ++done.flipped;
  }
  done.one_sided_edges = patches.torn_edges;
  return done;
}

}  // namespace hydrodip
