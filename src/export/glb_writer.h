// A GLB file (binary glTF 2.0) as it grows: its JSON and its binary chunk.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "export/bytes.h"

namespace hydrodip {

constexpr int kGlbClampToEdge = 33071;

struct GlbMesh {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 3>> normals;
  std::vector<std::array<float, 2>> uvs;     // empty: none
  std::vector<std::array<float, 4>> colors;  // linear; empty: none
  std::vector<std::uint32_t> indices;        // of all parts
};

// A range of a mesh's indices and what it is made of: what the dip leaves, and what is wanted.
struct GlbPart {
  std::size_t begin = 0, count = 0;
  int predicted = 0, wanted = 0;  // materials
};

class GlbWriter {
 public:
  using Json = nlohmann::ordered_json;

  GlbWriter();

  int add_material(const Json& material);

  // An embedded PNG or JPEG file (`type`: its MIME type).
  int add_texture(const std::vector<std::uint8_t>& file, const std::string& type,
                  const std::string& name, int wrap_u = kGlbClampToEdge,
                  int wrap_v = kGlbClampToEdge);

  // From now on parts have two looks: the material variants "predicted" and "wanted".
  void add_variants();

  void add_mesh(const std::string& name, const GlbMesh& mesh, const std::vector<GlbPart>& parts);

  // The file's bytes.
  std::vector<std::uint8_t> finish();

 private:
  int append(const char* list, const Json& entry);
  int add_view(const std::vector<std::uint8_t>& bytes, int target);
  template <std::size_t N>
  int add_floats(const std::vector<std::array<float, N>>& values, bool with_limits);
  int add_indices(const std::vector<std::uint32_t>& indices, const GlbPart& part);

  Json json_;
  Bytes binary_;
  bool has_variants_ = false;
};

}  // namespace hydrodip
