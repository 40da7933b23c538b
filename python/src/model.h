#pragma once

#include <memory>

#include "model_io/load.h"

namespace hydrodip::python {

// A model in memory, checked and mended, in millimetres.
struct ModelHandle {
  std::shared_ptr<const LoadedObject> loaded;
};

}  // namespace hydrodip::python
