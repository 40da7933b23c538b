// Polygons cut into triangles, and the health of whatever mesh comes of it.
#include <cmath>

#include "model.h"
#include "object/health.h"
#include "object/polygon.h"

using namespace hydrodip;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4) return 0;
  const std::size_t count = 3 + data[0];
  std::vector<Vec3> points;
  for (std::size_t i = 1; i + 2 < size && points.size() < count; i += 3)
    points.emplace_back(data[i], data[i + 1], data[i + 2] % 4);
  const auto cut = triangulate(points);
  fuzz::require(cut.size() == (points.size() < 3 ? 0 : points.size() - 2));
  Object object;
  object.materials.emplace_back();
  object.positions = points;
  for (const auto& t : cut) object.triangles.push_back({t[0], t[1], t[2]});
  for (std::size_t i = 1 + 3 * count; i + 2 < size && !points.empty(); i += 3)
    object.triangles.push_back({std::int32_t(data[i] % points.size()),
                                std::int32_t(data[i + 1] % points.size()),
                                std::int32_t(data[i + 2] % points.size())});
  object.material_of.assign(object.triangles.size(), 0);
  const MeshHealth health = check_and_repair(object);
  fuzz::require(std::isfinite(health.area_mm2) && std::isfinite(health.volume_mm3));
  for (const Triangle& t : object.triangles)
    for (const std::int32_t v : t)
      fuzz::require(v >= 0 && std::size_t(v) < object.positions.size());
  return 0;
}
