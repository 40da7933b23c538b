// What every reader of model files must hold, whatever it is given.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "model_io/model_file.h"

namespace hydrodip::fuzz {

class NoSideFiles : public SideFiles {
 public:
  std::string identity(const std::string&) override { return {}; }
  std::optional<FileBytes> read(const std::string&) override { return {}; }
};

inline void require(bool holds) {
  if (!holds) std::abort();
}

inline void check(const ModelFile& file) {
  require(!file.face_end.empty());
  require(file.material_of.size() == file.face_end.size());
  std::uint32_t begin = 0;
  for (const std::uint32_t end : file.face_end) {
    require(end >= begin + 3 && end <= file.corners.size());
    begin = end;
  }
  require(begin == file.corners.size());
  for (const std::int32_t v : file.corners)
    require(v >= 0 && std::size_t(v) < file.positions.size());
  for (const std::int32_t m : file.material_of)
    require(m >= -1 && m < std::int32_t(file.materials.size()));
  for (const FileMaterial& material : file.materials)
    require(material.picture >= -1 && material.picture < std::int32_t(file.pictures.size()));
  require(file.uvs.empty() || file.uvs.size() == file.corners.size());
  require(file.colors.empty() || file.colors.size() == file.corners.size());
}

// Reads the bytes as a file of that name; a refusal is as good as a model.
inline int read(ModelFile (*reader)(const ModelInput&), const char* name, const std::uint8_t* data,
                std::size_t size) {
  if (size == 0) return 0;
  const FileBytes bytes(data, data + size);
  const std::string path = name;
  NoSideFiles side_files;
  RunContext context;
  try {
    check(reader({path, path, bytes, side_files, context}));
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace hydrodip::fuzz
