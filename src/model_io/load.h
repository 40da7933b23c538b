// Object in.
//
// Colour, as read: pictures are brought to sRGB; OBJ's Kd, 3MF's colours and the vertex and face
// colours of PLY, OFF, STL and OBJ are sRGB. glTF's factors and vertex colours are linear. STL, PLY
// and OFF have no materials: their base colour is white. OBJ: a Kd beside a map_Kd multiplies it
// only if it is not grey (exporters write a grey Kd that was never meant as a tint); Kd and d make
// the base colour. glTF: alphaMode decides what becomes of the alpha; the texture transform is
// applied to the UVs. docs/formats.md says what of each format is read, warned about and refused.
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
  // When not empty, this picture alone decides the colour: it replaces every material's texture,
  // base colour and the vertex colours. Needs UVs.
  std::filesystem::path texture;
  // When not empty, the model reads no other file than those in this folder, whatever it names: for
  // models of people who may not read all that this process may.
  std::filesystem::path confined_to = {};
};

struct LoadedObject {
  Object object;
  MeshHealth health;
  std::string units;                         // the unit that was applied
  std::vector<std::filesystem::path> files;  // every file that was read, for the report's hashes
  // Why pictures and material libraries that the model refers to are not shown: one sentence each,
  // also among the context's warnings.
  std::vector<std::string> picture_problems;
  bool units_are_told = true;  // by the options, the file or its format: no guess
};

// Reads OBJ (+MTL, textures), PLY, STL, OFF, 3MF, glTF, GLB. Scales to millimetres, checks and
// repairs (object/health.h). A missing or unreadable texture file that the model refers to is a
// warning (the material falls back to its base colour) unless it came from options.texture.
// glTF's y-up is turned to z-up. Throws InputError (what, where, how to mend) for: missing, empty
// or unparsable files, face indices out of range, non-finite coordinates, no triangles, --texture
// without UVs, unknown extension.
LoadedObject load_object(const std::filesystem::path& path, const LoadOptions& options,
                         const RunContext& context);

// Throws InputError for what load_object reads nothing of by its name, and for a folder.
void require_model_file(const std::filesystem::path& path);

// Faces as the file has them, not cut into triangles. Equal positions are one vertex.
struct PolygonMesh {
  std::vector<Vec3> positions;                   // in the file's unit
  std::vector<std::vector<std::int32_t>> faces;  // three corners or more
};

// Reads OBJ and PLY; nothing but positions and faces. Warns of nothing. Throws InputError as
// load_object.
PolygonMesh load_polygons(const std::filesystem::path& path, const RunContext& context);

}  // namespace hydrodip
