#include "elastic/table_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"

namespace hydrodip {

namespace {

constexpr int kFewest = 8, kMost = 4000;
constexpr double kSymmetry = 1e-9;

// Second derivatives at evenly spaced nodes of the cubic spline through the values, whose third
// derivative is continuous at the second node and the last but one. `at`: of `count` values.
template <typename At>
std::vector<double> second_derivatives(int count, double h, const At& at) {
  const auto n = std::size_t(count);
  std::vector<double> bend(n), upper(n);
  const auto bent = [&](std::size_t i) {
    return 6 / (h * h) * (at(i - 1) - 2 * at(i) + at(i + 1));
  };
  bend[1] = bent(1) / 6;
  bend[n - 2] = bent(n - 2) / 6;
  // Thomas' algorithm for the nodes between.
  upper[1] = 0;
  for (std::size_t i = 2; i < n - 2; ++i) {
    const double pivot = 4 - upper[i - 1];
    upper[i] = 1 / pivot;
    const double known = i == n - 3 ? bent(i) - bend[n - 2] : bent(i);
    bend[i] = (known - bend[i - 1]) / pivot;
  }
  for (std::size_t i = n - 3; i-- > 2;) bend[i] -= upper[i] * bend[i + 1];
  bend[0] = 2 * bend[1] - bend[2];
  bend[n - 1] = 2 * bend[n - 2] - bend[n - 3];
  return bend;
}

// Of values and second derivatives at the two nodes around a place: their shares in the spline
// there, and the shares' derivatives.
struct Shares {
  std::size_t node = 0;
  std::array<double, 4> value{}, first{}, second{};
};

class TableLaw : public MaterialLaw {
 public:
  explicit TableLaw(const LawTable& table)
      : least_(table.least),
        h_((table.most - table.least) / (table.samples - 1)),
        count_(std::size_t(table.samples)),
        nodes_(count_ * count_) {
    for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_[n][0] = table.energy[n];
    for (std::size_t line = 0; line < count_; ++line) derive(line * count_, 1, 0, 2);
    for (std::size_t line = 0; line < count_; ++line) derive(line, count_, 0, 1);
    for (std::size_t line = 0; line < count_; ++line) derive(line, count_, 2, 3);
  }

  Value at(double a, double b) const override {
    const Shares s = shares(a), t = shares(b);
    Value v;
    // value and second derivative along a, times those along b
    for (std::size_t i = 0; i < 4; ++i) {
      double value = 0, first = 0, second = 0;
      for (std::size_t j = 0; j < 4; ++j) {
        const double c = nodes_[(s.node + i % 2) * count_ + t.node + j % 2][i / 2 + 2 * (j / 2)];
        value += t.value[j] * c;
        first += t.first[j] * c;
        second += t.second[j] * c;
      }
      v.energy += s.value[i] * value;
      v.by_a += s.first[i] * value;
      v.by_b += s.value[i] * first;
      v.by_aa += s.second[i] * value;
      v.by_ab += s.first[i] * first;
      v.by_bb += s.value[i] * second;
    }
    return v;
  }

 private:
  // energy, by_aa, by_bb, by_aabb.
  using Node = std::array<double, 4>;

  void derive(std::size_t begin, std::size_t stride, std::size_t from, std::size_t to) {
    const std::vector<double> bend = second_derivatives(
        int(count_), h_, [&](std::size_t i) { return nodes_[begin + i * stride][from]; });
    for (std::size_t i = 0; i < count_; ++i) nodes_[begin + i * stride][to] = bend[i];
  }

  Shares shares(double x) const {
    const double last = double(count_ - 1);
    const double place = (x - least_) / h_;
    const double inside = std::clamp(place, 0.0, last);
    Shares s;
    s.node = std::min(std::size_t(inside), count_ - 2);
    const double B = inside - double(s.node), A = 1 - B;
    s.value = {A, B, (A * A * A - A) * h_ * h_ / 6, (B * B * B - B) * h_ * h_ / 6};
    s.first = {-1 / h_, 1 / h_, -(3 * A * A - 1) * h_ / 6, (3 * B * B - 1) * h_ / 6};
    s.second = {0, 0, A, B};
    const double beyond = (place - inside) * h_;
    if (beyond == 0) return s;
    for (std::size_t k = 0; k < 4; ++k) {
      s.value[k] += beyond * (s.first[k] + 0.5 * beyond * s.second[k]);
      s.first[k] += beyond * s.second[k];
    }
    return s;
  }

  double least_, h_;
  std::size_t count_;
  std::vector<Node> nodes_;
};

void check(const LawTable& table) {
  const auto refuse = [](const std::string& what) { throw InputError("the material " + what); };
  if (table.samples < kFewest || table.samples > kMost)
    refuse("table needs 8 to 4000 samples along each side");
  if (!(table.least > 0 && table.least < 1 && table.most > 1 && table.most < 1e3))
    refuse(
        "table's range has to begin between 0 and 1 and to end above 1, where film is unstretched");
  const auto n = std::size_t(table.samples);
  if (table.energy.size() != n * n) refuse("table needs samples x samples energies");
  double largest = 0;
  for (const double e : table.energy) {
    if (!std::isfinite(e)) refuse("table has an energy that is not finite");
    largest = std::max(largest, std::abs(e));
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (std::abs(table.energy[i * n + j] - table.energy[j * n + i]) > kSymmetry * largest)
        refuse("is not isotropic: its table changes when both principal values are exchanged");
}

}  // namespace

std::shared_ptr<const MaterialLaw> make_table_law(const LawTable& table) {
  check(table);
  return std::make_shared<const TableLaw>(table);
}

LawTable tabulated(const LawEnergy& energy, LawTable range) {
  range.energy.clear();
  const double h = (range.most - range.least) / (range.samples - 1);
  for (int i = 0; i < range.samples; ++i)
    for (int j = 0; j < range.samples; ++j)
      range.energy.push_back(energy(range.least + i * h, range.least + j * h));
  return range;
}

LawTable tabulated_by_stretch(const LawEnergy& energy, LawTable range) {
  return tabulated([&](double a, double b) { return a * b * energy(1 / a, 1 / b); },
                   std::move(range));
}

}  // namespace hydrodip
