#include <algorithm>
#include <unordered_map>

#include "base/run_scope.h"
#include "plan/trial.h"

namespace hydrodip {
namespace {

// Vertices that share a cell of a grid become one, in their middle.
std::shared_ptr<const Object> drawn_together(const Object& object, double cells_across) {
  const Box3 box = object.bounds();
  const double cell = std::max(box.size().maxCoeff() / cells_across, 1e-12);
  auto simple = std::make_shared<Object>();
  std::unordered_map<std::uint64_t, std::int32_t> vertex_in;
  std::vector<std::int32_t> moved(object.positions.size());
  std::vector<double> count;
  CheckEvery check(1 << 14);
  for (std::size_t v = 0; v < object.positions.size(); ++v) {
    check();
    const Vec3 at = (object.positions[v] - box.min) / cell;
    const std::uint64_t key =
        (std::uint64_t(at.x()) << 40) | (std::uint64_t(at.y()) << 20) | std::uint64_t(at.z());
    const auto [found, is_new] = vertex_in.emplace(key, std::int32_t(simple->positions.size()));
    if (is_new) {
      simple->positions.push_back(Vec3::Zero());
      count.push_back(0);
    }
    moved[v] = found->second;
    simple->positions[std::size_t(found->second)] += object.positions[v];
    count[std::size_t(found->second)] += 1;
  }
  for (std::size_t v = 0; v < count.size(); ++v) simple->positions[v] /= count[v];
  for (const Triangle& t : object.triangles) {
    const Triangle turned = {moved[std::size_t(t[0])], moved[std::size_t(t[1])],
                             moved[std::size_t(t[2])]};
    if (turned[0] == turned[1] || turned[1] == turned[2] || turned[2] == turned[0]) continue;
    simple->triangles.push_back(turned);
  }
  simple->material_of.assign(simple->triangles.size(), 0);
  simple->materials.emplace_back();
  return simple;
}

}  // namespace

std::shared_ptr<const Object> simplified_for_trials(std::shared_ptr<const Object> object) {
  constexpr std::size_t kMany = 60000;
  std::shared_ptr<const Object> simple = object;
  for (double cells = 200; simple->triangles.size() > kMany && cells > 20; cells /= 1.4)
    simple = drawn_together(*object, cells);
  return simple;
}

}  // namespace hydrodip
