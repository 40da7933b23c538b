// Wavefront material libraries, as far as they speak of colour.
#pragma once

#include <string>
#include <vector>

#include "model_io/model_file.h"

namespace hydrodip {

struct MtlMaterial {
  FileMaterial material;
  std::string picture;  // map_Kd's file, or ""
};

// Lines that make no sense are left out: a library never stops a model. `name` is used in warnings,
// which say what was taken differently from how it stands there.
std::vector<MtlMaterial> read_mtl(const std::string& name, const FileBytes& bytes,
                                  const RunContext& context);

}  // namespace hydrodip
