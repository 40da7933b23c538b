// Long work for Python: on a thread of its own, without the interpreter's lock, told about and
// cancelled.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <utility>

#include "base/context.h"

namespace hydrodip::python {

// Runs the work while this thread waits, hands what it reports to progress(activity, fraction)
// unless that is None, and cancels it when the user interrupts (KeyboardInterrupt) or when progress
// raises: that is then raised here, once the work has ended. With the interpreter's lock.
void run(const pybind11::object& progress, const std::function<void(const RunContext&)>& work);

// The same, of work that makes something; `Value` needs no default.
template <typename Value, typename Work>
Value run_for(const pybind11::object& progress, const Work& work) {
  std::optional<Value> made;
  run(progress, [&](const RunContext& context) { made.emplace(work(context)); });
  return std::move(*made);
}

}  // namespace hydrodip::python
