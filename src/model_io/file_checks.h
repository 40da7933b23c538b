// What must hold of a model file before assimp sees it. Assimp clamps or ignores much of what a
// maker needs to know (indices out of range, truncated lists) and trusts sizes in headers; these
// checks refuse such files with one sentence each, and hand on bytes that assimp reads safely.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hydrodip {

using FileBytes = std::vector<std::uint8_t>;

// A side file that a model refers to: its size in bytes, or -1 if it is missing.
class SideFiles {
 public:
  virtual ~SideFiles() = default;
  virtual std::int64_t size(const std::string& relative_path) = 0;
};

// sRGB bytes with alpha at a triangle's three corners.
using FaceColors = std::array<std::array<std::uint8_t, 4>, 3>;

struct CheckedFile {
  FileBytes bytes;                    // what assimp is to read in the file's place
  std::string units;                  // what the file itself says, or ""
  std::vector<std::string> warnings;  // about what is left out
  // 3MF: per mesh in file order, per triangle; empty if no triangle has a material. assimp keeps
  // one base material per mesh and no colour groups.
  std::vector<std::vector<FaceColors>> face_colors;
};

// `path` is used in messages only. All throw InputError.
CheckedFile check_obj(const std::string& path, FileBytes bytes);
// A material library reduced to names, Kd, d and map_Kd in plain form; assimp crashes on some of
// the rest, and on what precedes the first name. Lines that make no sense are left out.
FileBytes clean_mtl(const FileBytes& bytes);
CheckedFile check_ply(const std::string& path, FileBytes bytes);
CheckedFile check_stl(const std::string& path, FileBytes bytes);
CheckedFile check_off(const std::string& path, const FileBytes& bytes);
// .gltf and .glb; keeps only what describes shape and colour (no animations, skins, extensions
// other than texture transforms).
CheckedFile check_gltf(const std::string& path, FileBytes bytes, SideFiles& side_files);
CheckedFile check_3mf(const std::string& path, FileBytes bytes);

}  // namespace hydrodip
