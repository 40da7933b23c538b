#pragma once

#include <memory>

#include "elastic/material_law.h"

namespace hydrodip::python {

// A material law as Python holds it.
struct LawHandle {
  std::shared_ptr<const MaterialLaw> law;
};

}  // namespace hydrodip::python
