// The parts of the module, one function each.
#pragma once

#include <pybind11/pybind11.h>

namespace hydrodip::python {

void bind_material(pybind11::module_& module);
void bind_model(pybind11::module_& module);
void bind_results(pybind11::module_& module);
void bind_jobs(pybind11::module_& module);

}  // namespace hydrodip::python
