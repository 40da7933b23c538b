// Supernodal CHOLMOD (GPL: for comparison in benchmarks only) as a solver of the film's steps.
#pragma once

#include "elastic/linear_solver.h"

namespace hydrodip {

// Symbolic analysis once, one numeric factorisation a Newton iteration.
std::unique_ptr<LinearSolver> make_cholmod_solver();

}  // namespace hydrodip
