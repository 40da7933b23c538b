#include "material.h"

#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "elastic/table_law.h"

namespace hydrodip::python {

namespace {

LawTable table_from(const Rows& energy, double least, double most) {
  if (energy.ndim() != 2 || energy.shape(0) != energy.shape(1))
    throw InputError("the material's energies have to be an array of shape (n, n)");
  LawTable table{.least = least, .most = most, .samples = int(energy.shape(0)), .energy = {}};
  table.energy.assign(energy.data(), energy.data() + energy.size());
  return table;
}

LawHandle checked(std::shared_ptr<const MaterialLaw> law) {
  check_law(*law);
  return {std::move(law)};
}

LawHandle from_table(const Rows& energy, double least, double most) {
  return checked(make_table_law(table_from(energy, least, most)));
}

// Given over stretches: a surface through them, taken at 1 / a and 1 / b.
LawHandle from_stretch_table(const Rows& energy, double least, double most) {
  const LawTable given = table_from(energy, least, most);
  const auto by_stretch = make_table_law(given);
  return checked(make_table_law(tabulated_by_stretch(
      [&](double s, double t) { return by_stretch->at(s, t).energy; },
      {.least = 1 / most, .most = 1 / least, .samples = given.samples, .energy = {}})));
}

// Per row of (a, b): energy, by_a, by_b, by_aa, by_ab, by_bb.
py::array values_at(const LawHandle& handle, const Rows& principal) {
  const py::ssize_t count = require_rows(principal, 2, "a list of principal values");
  std::vector<double> values;
  for (py::ssize_t i = 0; i < count; ++i) {
    const MaterialLaw::Value v = handle.law->at(principal.at(i, 0), principal.at(i, 1));
    for (const double x : {v.energy, v.by_a, v.by_b, v.by_aa, v.by_ab, v.by_bb})
      values.push_back(x);
  }
  py::array all = taken<double>(std::move(values), {});
  return all.reshape(std::vector<py::ssize_t>{count, 6});
}

}  // namespace

void bind_material(py::module_& m) {
  py::class_<LawHandle>(m, "Law")
      .def_static("paper", [](double poisson) { return LawHandle{make_corotated_law(poisson)}; })
      .def_static("from_table", &from_table)
      .def_static("from_stretch_table", &from_stretch_table)
      .def("values_at", &values_at);
}

}  // namespace hydrodip::python
