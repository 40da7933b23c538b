#include "calibrate/resolution.h"

#include <algorithm>

namespace hydrodip {
namespace {

constexpr int kFiner = 2;  // by which cells and steps shrink
constexpr int kMostElements = 1000000;

}  // namespace

DesignOptions finer_film(const DesignOptions& design) {
  DesignOptions fine = design;
  fine.film.elements = std::min(design.film.elements, kMostElements) * kFiner * kFiner;
  fine.dip.step_mm = design.dip.step_mm / kFiner;
  return fine;
}

Correction correction(const Eigen::VectorXd& change) {
  const Eigen::VectorXd beyond = change / (kFiner * kFiner - 1);
  const Eigen::VectorXd at_worst = change / (kFiner - 1);
  return {change + beyond, at_worst - beyond};
}

}  // namespace hydrodip
