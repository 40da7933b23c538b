// The object as the page draws it. docs/studio-api.md, "A mesh".
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "export/scene_object.h"
#include "hydrodip/hydrodip.h"

namespace hydrodip {

// A texture, packed when a page asks for it: on that request's thread. For any number of threads.
class ShownTexture {
 public:
  explicit ShownTexture(std::shared_ptr<const Image> image) : image_(std::move(image)) {}

  const ShownPicture& picture() const;

 private:
  mutable std::once_flag once_;
  mutable std::shared_ptr<const Image> image_;  // until then
  mutable ShownPicture picture_;
};

struct ShownMesh {
  std::vector<std::uint8_t> bundle;
  std::vector<std::shared_ptr<const ShownTexture>> textures;
};

// `object`: the model's own, or one painted anew with the same triangles. `address`: of this mesh
// for the page. Models of very many triangles are simplified for the eye.
ShownMesh shown_mesh(const Model& model, const Object& object, const std::string& id,
                     const std::string& address, const RunContext& context);

}  // namespace hydrodip
