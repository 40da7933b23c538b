// Tiny model files of every kind, written by hand so that what they mean is known exactly.
//
// All of them show the same thing where their format can: two unit squares in the plane z = 0, the
// left one from (0, 0) to (1, 1), the right one from (1, 0) to (2, 1), facing +z.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "temporary_folder.h"

namespace hydrodip::fixtures {

using Bytes = std::vector<std::uint8_t>;

// A folder that files are written to.
class ModelFolder : public TemporaryFolder {
 public:
  std::filesystem::path write(const std::string& name, const std::string& text) const;
  std::filesystem::path write(const std::string& name, const Bytes& bytes) const;
};

struct Rgb {
  int r, g, b, a = 255;
};

// Pixels row by row from the top.
Bytes png_of(int width, int height, const std::vector<Rgb>& pixels);

// Top row: red, green. Bottom row: blue, white.
Bytes four_colour_png();

std::string obj_text();  // refers to squares.mtl; materials "left" (texture left.png), "right"
std::string mtl_text();
std::string ascii_ply_text();  // left square red, right square blue at the far side
Bytes binary_ply(bool big_endian);
std::string ascii_stl_text();
Bytes binary_stl();
std::string off_text();
std::string coff_text();

// A ZIP archive with stored (uncompressed) members.
Bytes zip_of(const std::vector<std::pair<std::string, std::string>>& members);
// unit: the attribute's value, or "" to leave it out. Left square in a base material #ff0000, right
// square as a second object moved 1 to the right by its build item, with colour group #0000ff.
Bytes threemf(const std::string& unit);

// Left square: texture (four colours) in material 0, wrapping as given (glTF numbers); right
// square: material 1, base colour (1, 0.5, 0, 1), placed by a node's translation. The squares lie
// in glTF's frame so that they end up in z = 0 facing +z. UVs of the left square run from 0 to 2.
struct GlbOptions {
  int wrap_s = 10497;
  int wrap_t = 10497;
  std::string alpha_mode;          // "" for none
  std::string texture_use;         // extra JSON inside baseColorTexture, ", ..." or ""
  std::string factor = "1,1,1,1";  // of material 0
  float uv_max = 2;
  Bytes png;  // empty: four_colour_png()
};
Bytes glb(const GlbOptions& options);
Bytes glb();
// The same as text, with the data in base64, or in an external file of that name.
std::string gltf_text(const std::string& external_bin = "");
// The binary chunk that belongs to it.
Bytes gltf_bin(const GlbOptions& options);

}  // namespace hydrodip::fixtures
