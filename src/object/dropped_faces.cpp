#include "object/dropped_faces.h"

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "base/run_scope.h"

namespace hydrodip {

namespace {

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

bool same_winding(const Triangle& a, const Triangle& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (a[0] == b[k]) return a[1] == b[(k + 1) % 3];
  return false;
}

BackToBack back_to_back(const Object& object, std::size_t kept, std::size_t gone) {
  BackToBack pair{kept, object.triangles[kept], object.triangles[gone], 0, {}, {}};
  if (!object.material_of.empty()) pair.material = object.material_of[gone];
  if (!object.uvs.empty()) pair.uvs = object.uvs[gone];
  if (!object.colors.empty()) pair.colors = object.colors[gone];
  return pair;
}

}  // namespace

long drop_collapsed(Object& object) {
  std::vector<char> drop(object.triangles.size(), 0);
  for (std::size_t i = 0; i < drop.size(); ++i) {
    const Triangle& t = object.triangles[i];
    drop[i] = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  }
  return drop_faces(object, drop);
}

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

void show_outer(Object& object, const std::vector<BackToBack>& pairs) {
  for (const BackToBack& pair : pairs) {
    if (same_winding(object.triangles[pair.kept], pair.kept_corners)) continue;
    object.triangles[pair.kept] = pair.corners;
    if (!object.material_of.empty()) object.material_of[pair.kept] = pair.material;
    if (!object.uvs.empty()) object.uvs[pair.kept] = pair.uvs;
    if (!object.colors.empty()) object.colors[pair.kept] = pair.colors;
  }
}

}  // namespace hydrodip
