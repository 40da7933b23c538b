#include "air/cells.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/parallel.h"
#include "base/run_scope.h"

namespace hydrodip {

namespace {

// Models are made of round numbers: lines through centres that are none of these meet no vertex and
// run along no face.
const Vec3 kOddShift(0.4142, 0.3028, 0.2361);

}  // namespace

AirCells::AirCells(const TriangleMesh& mesh, const Box3& part, std::size_t most_cells) {
  const Vec3 size = part.size().cwiseMax(1e-3);
  const auto counts = [&](double pitch) {
    std::array<int, 3> n{};
    for (int k = 0; k < 3; ++k) n[std::size_t(k)] = int(std::ceil(size[k] / pitch)) + 3;
    return n;
  };
  const auto total = [](const std::array<int, 3>& n) {
    return double(n[0]) * double(n[1]) * double(n[2]);
  };
  pitch_ = std::cbrt(size.prod() / double(most_cells));
  pitch_ = std::max(pitch_, size.maxCoeff() / 4000);
  while (total(counts(pitch_)) > double(most_cells)) pitch_ *= 1.05;
  n_ = counts(pitch_);
  first_ = part.min - pitch_ * (Vec3::Constant(0.5) + kOddShift);
  stride_ = {1, std::size_t(n_[0]), std::size_t(n_[0]) * std::size_t(n_[1])};
  for (auto& axis : blocked_) axis.assign(count(), 0);
  std::vector<std::function<void()>> axes;
  axes.reserve(3);
  for (int axis = 0; axis < 3; ++axis)
    axes.emplace_back([this, &mesh, axis] { block(mesh, axis); });
  parallel_do(axes);
}

// Every line through centres along the axis, met by every triangle whose shadow it crosses.
void AirCells::block(const TriangleMesh& mesh, int axis) {
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  std::vector<std::uint8_t>& blocked = blocked_[std::size_t(axis)];
  const auto line = [&](int of, double x) { return (x - first_[of]) / pitch_; };
  CheckEvery check(1 << 14);
  for (const Triangle& t : mesh.triangles) {
    check();
    const std::array<const Vec3*, 3> p = {&mesh.positions[std::size_t(t[0])],
                                          &mesh.positions[std::size_t(t[1])],
                                          &mesh.positions[std::size_t(t[2])]};
    std::array<Vec2, 3> flat;
    Box2 box;
    for (std::size_t k = 0; k < 3; ++k) {
      flat[k] = Vec2(line(b, (*p[k])[b]), line(c, (*p[k])[c]));
      box.add(flat[k]);
    }
    const double twice = cross2(flat[1] - flat[0], flat[2] - flat[0]);
    if (twice == 0) continue;
    const double slack = -1e-9;
    for (int k = std::max(0, int(std::ceil(box.min.y())));
         k <= box.max.y() && k < n_[std::size_t(c)]; ++k) {
      for (int j = std::max(0, int(std::ceil(box.min.x())));
           j <= box.max.x() && j < n_[std::size_t(b)]; ++j) {
        const Vec2 at(j, k);
        const double w0 = cross2(flat[1] - at, flat[2] - at) / twice;
        const double w1 = cross2(flat[2] - at, flat[0] - at) / twice;
        const double w2 = 1 - w0 - w1;
        if (w0 < slack || w1 < slack || w2 < slack) continue;
        const double met = line(axis, w0 * (*p[0])[axis] + w1 * (*p[1])[axis] + w2 * (*p[2])[axis]);
        const int i = int(std::floor(met));
        if (i < 0 || i + 1 >= n_[std::size_t(axis)]) continue;
        blocked[std::size_t(i) * stride_[std::size_t(axis)] +
                std::size_t(j) * stride_[std::size_t(b)] +
                std::size_t(k) * stride_[std::size_t(c)]] = 1;
      }
    }
  }
}

Vec3 AirCells::center(std::size_t cell) const {
  const std::size_t x = cell % stride_[1];
  const std::size_t y = cell % stride_[2] / stride_[1];
  const std::size_t z = cell / stride_[2];
  return first_ + pitch_ * Vec3(double(x), double(y), double(z));
}

std::size_t AirCells::cell_of(const Vec3& point) const {
  std::size_t cell = 0;
  for (int k = 0; k < 3; ++k) {
    const double i = std::round((point[k] - first_[k]) / pitch_);
    cell +=
        std::size_t(std::clamp(i, 0.0, double(n_[std::size_t(k)] - 1))) * stride_[std::size_t(k)];
  }
  return cell;
}

bool AirCells::on_border(std::size_t cell) const {
  const std::array<std::size_t, 3> i = {cell % stride_[1], cell % stride_[2] / stride_[1],
                                        cell / stride_[2]};
  for (std::size_t k = 0; k < 3; ++k)
    if (i[k] == 0 || i[k] + 1 == std::size_t(n_[k])) return true;
  return false;
}

void AirCells::add_link(std::size_t a, std::size_t b) {
  if (a == b) return;
  has_extra_.resize(count());
  for (const auto& link : {std::pair(a, b), std::pair(b, a)}) {
    extra_.insert(std::upper_bound(extra_.begin(), extra_.end(), link), link);
    has_extra_[link.first] = 1;
  }
}

}  // namespace hydrodip
