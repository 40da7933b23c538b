// The object as the page draws it. docs/studio-api.md, "A mesh".
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "export/scene_object.h"
#include "hydrodip/hydrodip.h"
#include "studio/json.h"

namespace hydrodip {

struct ShownMesh {
  std::vector<std::uint8_t> bundle;
  std::vector<ShownPicture> textures;
};

// `object`: the model's own, or one painted anew with the same triangles. `address`: of this mesh
// for the page. Models of very many triangles are simplified for the eye.
ShownMesh shown_mesh(const Model& model, const Object& object, const std::string& id,
                     const std::string& address, const RunContext& context);

}  // namespace hydrodip
