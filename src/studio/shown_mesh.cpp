#include "studio/shown_mesh.h"

#include <algorithm>
#include <cmath>

#include "base/run_scope.h"
#include "export/scene_object.h"
#include "image/resize.h"
#include "studio/bundle.h"

namespace hydrodip {
namespace {

constexpr std::size_t kMostTriangles = 250000;
constexpr int kTextureSide_px = 2048, kJpegQuality = 90;

std::uint8_t byte_of(float value) {
  return std::uint8_t(std::lround(255 * std::clamp(value, 0.0F, 1.0F)));
}

Json head_of(const Model& model, const Object& object, const ShownObject& shown,
             const std::string& id, const std::string& address) {
  const Box3 box = model.object->bounds();
  Json groups = Json::array(), materials = Json::array(), textures = Json::array();
  for (const ShownGroup& group : shown.groups)
    groups.push_back(
        {{"material", group.material}, {"start", group.begin}, {"count", group.count}});
  for (const Material& material : object.materials) {
    const LinearColor& c = material.base_color;
    materials.push_back({{"color", {c.r, c.g, c.b, c.a}},
                         {"texture", object.uvs.empty() ? -1 : material.texture},
                         {"wrap", {wrap_name(material.wrap_u), wrap_name(material.wrap_v)}}});
  }
  for (std::size_t k = 0; k < object.textures.size(); ++k)
    textures.push_back(address + "/textures/" + std::to_string(k));
  return {{"mesh", id},
          {"triangles", model.object->triangles.size()},
          {"simplified", shown.simplified},
          {"low_mm", {box.min.x(), box.min.y(), box.min.z()}},
          {"high_mm", {box.max.x(), box.max.y(), box.max.z()}},
          {"largest_mm", box.size().maxCoeff()},
          {"units", model.units},
          {"closed", model.health.closed()},
          {"area_mm2", model.health.area_mm2},
          {"volume_mm3", model.health.volume_mm3},
          {"has_colors", model.object->has_appearance()},
          {"health", model.health.findings()},
          {"groups", groups},
          {"materials", materials},
          {"textures", textures}};
}

}  // namespace

const ShownPicture& ShownTexture::picture() const {
  std::call_once(once_, [&] {
    const RunScope scope(context_);
    picture_ = shown_picture(shrink_to(*image_, kTextureSide_px), kJpegQuality);
    image_.reset();
  });
  return picture_;
}

ShownMesh shown_mesh(const Model& model, const Object& object, const std::string& id,
                     const std::string& address, const RunContext& context) {
  const RunScope scope(context);
  const ShownObject shown = shown_object(object, kMostTriangles);
  Bundle bundle(head_of(model, object, shown, id, address));
  std::vector<float> positions, uvs;
  std::vector<std::int8_t> normals;
  std::vector<std::uint8_t> colors;
  for (const ShownVertex& v : shown.vertices) {
    positions.insert(positions.end(), v.position.begin(), v.position.end());
    for (const float n : v.normal) normals.push_back(std::int8_t(std::lround(127 * n)));
    normals.push_back(0);
    uvs.insert(uvs.end(), v.uv.begin(), v.uv.end());
    for (const float c : v.color) colors.push_back(byte_of(c));
  }
  bundle.add("position", positions, 3);
  bundle.add("normal", normals, 4);
  if (!object.uvs.empty()) bundle.add("uv", uvs, 2);
  if (!object.colors.empty()) bundle.add("color", colors, 4);
  bundle.add("index", shown.indices, 1);
  ShownMesh mesh{bundle.finish(), {}};
  for (const auto& texture : object.textures)
    mesh.textures.push_back(std::make_shared<const ShownTexture>(texture, context));
  return mesh;
}

}  // namespace hydrodip
