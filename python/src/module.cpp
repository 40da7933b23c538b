// hydrodip._core: what Python cannot do itself. The package around it (python/hydrodip) is what
// people use.
#include "bindings.h"

#include "base/error.h"

PYBIND11_MODULE(_core, m) {
  namespace py = pybind11;
  namespace hp = hydrodip::python;
  m.doc() = "hydrodip's compiled part.";
  py::register_exception<hydrodip::InputError>(m, "InputError", PyExc_ValueError);
  py::register_exception<hydrodip::DipError>(m, "DipError", PyExc_RuntimeError);
  m.attr("InputError").attr("__module__") = "hydrodip";
  m.attr("DipError").attr("__module__") = "hydrodip";
  m.attr("InputError").attr("__doc__") =
      "Bad input: one sentence that says what, where, and how to mend it (exit code 2).";
  m.attr("DipError").attr("__doc__") = "The dip could not be computed (exit code 3).";
  hp::bind_material(m);
  hp::bind_model(m);
  hp::bind_results(m);
  hp::bind_jobs(m);
}
