// The object as the page draws it. docs/studio-api.md, "A mesh".
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/context.h"
#include "export/scene_object.h"
#include "hydrodip/hydrodip.h"

namespace hydrodip {

// A texture, packed when a page asks for it: on that request's thread. For any number of threads.
class ShownTexture {
 public:
  ShownTexture(std::shared_ptr<const Image> image, RunContext context)
      : context_(std::move(context)), image_(std::move(image)) {}

  // Throws Cancelled.
  const ShownPicture& picture() const;

 private:
  const RunContext context_;
  mutable std::once_flag once_;
  mutable std::shared_ptr<const Image> image_;  // until then
  mutable ShownPicture picture_;
};

struct ShownMesh {
  std::vector<std::uint8_t> bundle;
  std::vector<std::shared_ptr<const ShownTexture>> textures;
};

// `object`: the model's own, or one painted anew with the same triangles. `address`: of this mesh
// for the page. Models of very many triangles are simplified for the eye. `context`: of its
// textures too, whenever they are packed.
ShownMesh shown_mesh(const Model& model, const Object& object, const std::string& id,
                     const std::string& address, const RunContext& context);

}  // namespace hydrodip
