// glTF's container and numbers: the JSON, buffers, compressed views and accessors.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "model_io/model_file.h"

namespace hydrodip {

// A list of points, colours or indices, read one at a time: primitives may share long ones.
class GltfNumbers {
 public:
  std::int64_t count = 0;
  int components = 0;
  bool floating = false;  // else whole numbers
  // The components of entry i; 8 at most. Normalised integers are brought to [0, 1] or [-1, 1].
  void get(std::int64_t i, float* out) const;
  std::uint32_t index(std::int64_t i) const;  // of a list of whole numbers

 private:
  friend class GltfData;
  const std::uint8_t* entry(std::int64_t i) const;

  std::span<const std::uint8_t> bytes_;  // empty: all entries are 0
  std::size_t stride_ = 0;
  int type_ = 0;
  bool normalized_ = false;
  std::shared_ptr<const std::vector<std::uint32_t>> replaced_;  // sparse: ascending; else none
  std::span<const std::uint8_t> replacements_;                  // theirs, packed
};

// The file's JSON with checked access. Throws InputError.
class GltfData {
 public:
  explicit GltfData(const ModelInput& input);
  ~GltfData();
  GltfData(const GltfData&) = delete;
  GltfData& operator=(const GltfData&) = delete;

  const nlohmann::json& root() const { return *root_; }
  [[noreturn]] void refuse(const std::string& what) const;

  std::size_t table_size(const char* name) const;
  // An entry of a table, which is an object.
  const nlohmann::json& entry(const char* table, std::int64_t index) const;
  // A whole number of the object, or the fallback if it has none.
  std::int64_t integer(const nlohmann::json& object, const char* name, std::int64_t fallback) const;
  // An index into a table, or -1 if the object has none.
  std::int64_t reference(const nlohmann::json& object, const char* name, const char* table) const;
  // As many finite numbers as `values` has; false if the object has none of that name.
  bool numbers(const nlohmann::json& object, const char* name, std::span<float> values) const;
  // A member that is an object, or null.
  const nlohmann::json* object(const nlohmann::json& owner, const char* name) const;
  // An extension of the object, or null.
  const nlohmann::json* extension(const nlohmann::json& owner, const char* name) const;

  // A buffer view's bytes, unpacked if it is compressed by meshoptimizer. Valid as long as this.
  std::span<const std::uint8_t> view(std::int64_t index);
  // The bytes behind "data:...;base64,".
  FileBytes data_uri(const std::string& uri) const;
  GltfNumbers accessor(std::int64_t index);
  // Of all buffers: bounds what can be made of them.
  std::size_t buffer_bytes() const { return buffer_bytes_; }
  // Whether any of it is compressed, by meshoptimizer or by Draco.
  bool is_compressed() const;

 private:
  void open();
  void parse(std::string_view text);
  void check_version() const;
  void read_buffers();
  std::span<const std::uint8_t> buffer_part(const nlohmann::json& part) const;
  const nlohmann::json* compression_of(const nlohmann::json& owner) const;
  FileBytes unpacked(const nlohmann::json& compression) const;
  void read_sparse(const nlohmann::json& sparse, GltfNumbers& numbers);

  const ModelInput& input_;
  std::unique_ptr<nlohmann::json> root_;
  std::span<const std::uint8_t> bin_;  // GLB's own buffer
  bool glb_ = false;
  std::vector<std::span<const std::uint8_t>> buffers_;
  std::vector<std::unique_ptr<FileBytes>> owned_;
  std::map<std::int64_t, std::span<const std::uint8_t>> unpacked_;
  std::map<std::int64_t, GltfNumbers> sparse_;  // by accessor: copies of a mesh ask again
  std::size_t buffer_bytes_ = 0;
};

}  // namespace hydrodip
