// What a model file says, as a value: one reader per format makes it, load.cpp makes an Object of
// it. Readers trust nothing: every index, size and number is checked, and what is wrong is refused
// with one sentence.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/context.h"
#include "object/object.h"

namespace hydrodip {

using FileBytes = std::vector<std::uint8_t>;

inline std::string_view text_of(const FileBytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// What becomes of a picture's alpha.
enum class Alpha { kBlend, kOpaque, kMask };

struct FilePicture {
  std::string name;      // a file beside the model, or what to call embedded bytes in messages
  std::string asked_by;  // the file that names it
  bool embedded = false;
  FileBytes bytes;      // of an embedded one
  std::string problem;  // why an embedded one cannot be read, or ""
};

struct FileMaterial {
  std::string name;
  LinearColor base_color{1, 1, 1, 1};
  bool color_is_default = false;         // base_color is the format's, not the file's
  LinearColor texture_tint{1, 1, 1, 1};  // takes base_color's place where the picture is shown
  int picture = -1;                      // into ModelFile::pictures
  Alpha alpha = Alpha::kBlend;
  float alpha_cutoff = 0.5F;                 // kMask: below is invisible
  float picture_base = 0, picture_gain = 1;  // MTL's -mm: a sample c shows as base + gain * c
  bool transformed = false;  // where the picture is shown: uv = transform * (u, v, 1)
  Eigen::Matrix<float, 2, 3> transform;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
};

// Polygons by corners, one after another. All lists are per corner or per face; colours and texture
// coordinates belong to corners, so that seams stay sharp.
struct ModelFile {
  static constexpr float kNoUv = -1e30F;  // u of a corner without texture coordinates

  std::string units;  // what the file itself says ("meter"), or ""
  bool y_up = false;
  std::vector<Vec3> positions;            // in the file's unit
  std::vector<std::int32_t> corners;      // indices into positions
  std::vector<std::uint32_t> face_end;    // per face: where its corners end
  std::vector<std::int32_t> material_of;  // per face: into materials, -1: none
  std::vector<Eigen::Vector2f> uvs;       // per corner, v up; or empty
  std::vector<LinearColor> colors;        // per corner; or empty
  std::vector<FileMaterial> materials;
  std::vector<FilePicture> pictures;
  // Why colours that the file refers to are not known, one sentence each; warned of already.
  std::vector<std::string> color_problems;

  void reserve(std::size_t faces, std::size_t corner_count) {
    corners.reserve(corner_count);
    face_end.reserve(faces);
    material_of.reserve(faces);
  }
  void end_face(std::int32_t material = -1) {
    face_end.push_back(std::uint32_t(corners.size()));
    material_of.push_back(material);
  }
};

// Files named inside a model, found beside it.
class SideFiles {
 public:
  virtual ~SideFiles() = default;
  // The same for all names of one file, which may be written in many ways: letter case,
  // backslashes and percent escapes are forgiven. Empty if there is none.
  virtual std::string identity(const std::string& name) = 0;
  // Empty if there is none of that name, or it cannot be read.
  virtual std::optional<FileBytes> read(const std::string& name) = 0;
};

// Pictures that will be shown, told while the model is still read: they can be decoded meanwhile.
class ExpectedPictures {
 public:
  virtual ~ExpectedPictures() = default;
  // A face shows it so. Not an embedded one.
  virtual void expect(const FilePicture& picture, const FileMaterial& material) = 0;
};

struct ModelInput {
  const std::string& path;  // for messages
  const std::string& name;  // the file's bare name, for messages about what it refers to
  const FileBytes& bytes;   // not empty
  SideFiles& side_files;
  ExpectedPictures* expected;  // none: pictures are not shown
  const RunContext& context;   // warnings; asked for a cancel every now and then
};

// All throw InputError and Cancelled. Memory: some tens of bytes per corner.
ModelFile read_obj(const ModelInput& input);
ModelFile read_ply(const ModelInput& input);
ModelFile read_stl(const ModelInput& input);
ModelFile read_off(const ModelInput& input);
ModelFile read_gltf(const ModelInput& input);  // .gltf and .glb
ModelFile read_3mf(const ModelInput& input);

// ---- for the readers ----------------------------------------------------------------------------

// "PATH: WHAT; export the model again."
[[noreturn]] void refuse_model(const std::string& path, const std::string& what);
[[noreturn]] void refuse_line(const std::string& path, long line, const std::string& what);

// The start of a word from a file, for messages.
inline std::string shown(std::string_view word) {
  std::string text(word.substr(0, 40));
  for (char& c : text)
    if (c == '\0') c = '?';  // an exception's sentence would end there
  return text;
}

// Asks for a cancel every few thousand calls.
class CancelCheck {
 public:
  explicit CancelCheck(const RunContext& context) : context_(context) {}
  void operator()() {
    if ((++calls_ & 0xfff) == 0) context_.check_cancelled();
  }

 private:
  const RunContext& context_;
  unsigned calls_ = 0;
};

// A colour as sRGB numbers in [0, 1], clamped; one that is not a number counts as 1.
LinearColor linear_from_srgb(float r, float g, float b, float a);

// Throws InputError if the model has more vertices or corners than can be numbered.
void check_count(const std::string& path, std::size_t count);

}  // namespace hydrodip
