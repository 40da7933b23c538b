// Between our arrays and numpy's: out without a copy, in with one at most.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/math.h"

namespace hydrodip::python {

namespace py = pybind11;

// Keeps what it holds alive as long as Python refers to it.
template <typename Held>
py::capsule keep(Held held) {
  return py::capsule(new Held(std::move(held)),
                     [](void* kept) { delete static_cast<Held*>(kept); });
}

// A read-only array over memory that `owner` keeps alive.
template <typename Scalar, typename Items>
py::array view(const Items& items, std::vector<py::ssize_t> shape_of_item,
               const py::capsule& owner) {
  shape_of_item.insert(shape_of_item.begin(), py::ssize_t(items.size()));
  py::array array(py::dtype::of<Scalar>(), shape_of_item,
                  reinterpret_cast<const Scalar*>(items.data()), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}
template <typename Owner>
py::array view(const std::vector<Vec2>& items, const Owner& owner) {
  static_assert(sizeof(Vec2) == 2 * sizeof(double));
  return view<double>(items, {2}, keep(owner));
}
template <typename Owner>
py::array view(const std::vector<Vec3>& items, const Owner& owner) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return view<double>(items, {3}, keep(owner));
}
template <typename Owner>
py::array view(const std::vector<Triangle>& items, const Owner& owner) {
  static_assert(sizeof(Triangle) == 3 * sizeof(std::int32_t));
  return view<std::int32_t>(items, {3}, keep(owner));
}
template <typename Owner>
py::array view(const std::vector<double>& items, const Owner& owner) {
  return view<double>(items, {}, keep(owner));
}
// Of yes and no.
template <typename Owner>
py::array view_of_flags(const std::vector<std::uint8_t>& items, const Owner& owner) {
  return view<bool>(items, {}, keep(owner));
}

// A new array over a vector that nobody else holds.
template <typename Scalar, typename Item>
py::array taken(std::vector<Item> items, const std::vector<py::ssize_t>& shape_of_item) {
  auto held = std::make_shared<const std::vector<Item>>(std::move(items));
  return view<Scalar>(*held, shape_of_item, keep(held));
}

// Doubles in rows of so many, as they are or converted.
using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;
inline py::ssize_t require_rows(const Rows& rows, py::ssize_t width, const std::string& what) {
  if (rows.ndim() != 2 || rows.shape(1) != width)
    throw InputError(what + " must be given as an array of shape (n, " + std::to_string(width) +
                     ")");
  return rows.shape(0);
}

// Whole numbers in a row, as they are or converted. Others are refused, not cut to whole ones.
using WholeNumbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
inline WholeNumbers whole_numbers(const py::object& given, const std::string& what) {
  const py::array array = py::array::ensure(given);
  if (!array || array.ndim() != 1) throw InputError(what + " have to be an array of shape (n,)");
  const char kind = array.dtype().kind();
  if (array.size() > 0 && kind != 'i' && kind != 'u' && kind != 'b')
    throw InputError(what + " have to be whole numbers");
  return WholeNumbers(array);
}

}  // namespace hydrodip::python
