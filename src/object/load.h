// Object in: the only place that knows assimp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "object/health.h"
#include "object/object.h"

namespace hydrodip {

struct LoadOptions {
  // "mm", "cm", "m", "in", or "" for what the format says (glTF: m; 3MF: its unit; else mm).
  std::string units;
  // Replaces every material's texture when not empty; needs UVs.
  std::filesystem::path texture;
};

struct LoadedObject {
  Object object;
  MeshHealth health;
  std::string units;                             // the unit that was applied
  std::vector<std::filesystem::path> files;      // every file that was read, for the report's hashes
};

// Reads OBJ (+MTL, textures), PLY, STL, OFF, 3MF, glTF, GLB. Scales to millimetres, checks and
// repairs (object/health.h). A missing or unreadable texture file that the model refers to is a
// warning (the material falls back to its base colour) unless it came from options.texture.
// glTF's y-up is turned to z-up. Throws InputError (what, where, how to mend) for: missing, empty
// or unparsable files, face indices out of range, non-finite coordinates, no triangles, --texture
// without UVs, unknown extension.
LoadedObject load_object(const std::filesystem::path& path, const LoadOptions& options,
                         RunContext& context);

}  // namespace hydrodip
