// The film laid out over its own regular grid, as the solver computes on it: vertices as nodes, two
// triangles in every cell. What lies outside a disc is there as well, without film.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "elastic/kernels.h"
#include "film/film.h"

namespace hydrodip {

// Vectors over vertices: 2 values per vertex.
using VertexVector = std::vector<Vec2>;

// Where arrays over a grid hold its nodes (see kernels.h).
struct GridLayout {
  GridLayout(int nodes_x, int nodes_y);

  std::size_t place(int i, int j) const {
    return (std::size_t(j) + 1) * std::size_t(stride) + kernels::kLanes + std::size_t(i);
  }
  // Of an array over the grid.
  std::size_t entries() const { return std::size_t(stride) * (std::size_t(ny) + 2) + kLooseEnds; }

  // Calls body(begin, end) for parts of `rows` rows of the grid, in parallel where that pays: in an
  // even number of parts, which two threads share evenly.
  template <typename Body>
  void for_rows(int rows, const Body& body) const {
    const std::ptrdiff_t pairs = (stride * rows + kNodesPerTask) / (2 * kNodesPerTask);
    const std::ptrdiff_t tasks = pairs > 0 ? 2 * pairs : 1;
    parallel_for(std::size_t(rows), std::size_t((rows + tasks - 1) / tasks),
                 [&](std::size_t begin, std::size_t end) {
                   body(std::ptrdiff_t(begin), std::ptrdiff_t(end));
                 });
  }

  // Calls step(pass, row) for all of the grid's rows and so many passes, in parallel where that
  // pays. A row's pass comes after the pass before it of the same row and the two next to it, and
  // mostly soon, while what they share is still in the cache. Rows in [begin, end) take longest.
  template <typename Step>
  void sweep(int passes, std::ptrdiff_t begin, std::ptrdiff_t end, const Step& step) const {
    // Strips first, without rows that wait for a neighbouring strip; then those rows.
    const std::ptrdiff_t strips = strips_of(end - begin), s = passes;
    const auto seam = [&](std::size_t n) {  // before this strip
      const auto strip = std::ptrdiff_t(n);
      return strip == 0 ? 0 : strip == strips ? ny : begin + (end - begin) * strip / strips;
    };
    parallel_for(std::size_t(strips), 1, [&](std::size_t strip, std::size_t) {
      const std::ptrdiff_t from = seam(strip), to = seam(strip + 1);
      for (std::ptrdiff_t front = from; front < to + s - 1; ++front)
        for (std::ptrdiff_t pass = 0; pass < s; ++pass) {
          const std::ptrdiff_t row = front - pass;
          if (row < (from > 0 ? from + pass : 0)) continue;
          if (row < (to < ny ? to - pass : to)) step(int(pass), row);
        }
    });
    if (strips == 1) return;
    parallel_for(std::size_t(strips) - 1, 1, [&](std::size_t strip, std::size_t) {
      const std::ptrdiff_t here = seam(strip + 1);
      for (std::ptrdiff_t pass = 1; pass < s; ++pass)
        for (std::ptrdiff_t row = here - pass; row < here + pass; ++row) step(int(pass), row);
    });
  }

  int nx, ny;
  std::ptrdiff_t groups;  // of kernels::kLanes nodes, per row
  std::ptrdiff_t stride;  // (groups + 1) * kLanes

 private:
  // The nodes behind the last and before the first are asked for as well.
  static constexpr std::size_t kLooseEnds = 2 * kernels::kLanes;
  // What is worth a thread's while.
  static constexpr std::ptrdiff_t kNodesPerTask = 3000;
  // The same for all passes of a sweep together.
  static constexpr std::ptrdiff_t kNodesPerStrip = 600;
  // So many that few wait for the seams, and no row waits for two of them.
  static constexpr std::ptrdiff_t kRowsPerStrip = 16;

  std::ptrdiff_t strips_of(std::ptrdiff_t rows) const {
    const std::ptrdiff_t pairs = std::min(stride * rows / kNodesPerStrip, rows / kRowsPerStrip) / 2;
    return pairs > 0 ? 2 * pairs : 1;
  }
};

// An array over a grid, zero at first, at addresses that registers are loaded from at once.
template <typename Real>
class GridArray {
 public:
  GridArray() = default;
  explicit GridArray(std::size_t entries) : lines_((entries + kPerLine - 1) / kPerLine) {}

  // At least as many as were asked for.
  std::size_t entries() const { return lines_.size() * kPerLine; }

  Real* data() { return lines_.data()->value; }
  const Real* data() const { return lines_.data()->value; }
  Real& operator[](std::size_t n) { return data()[n]; }
  const Real& operator[](std::size_t n) const { return data()[n]; }
  void swap(GridArray& other) { lines_.swap(other.lines_); }
  void set_zero() { lines_.assign(lines_.size(), {}); }

 private:
  static constexpr std::size_t kPerLine = 64 / sizeof(Real);
  struct alignas(64) Line {
    Real value[kPerLine];
  };
  std::vector<Line> lines_;
};

// A vector field over the film's grid.
struct GridField {
  GridField() = default;
  explicit GridField(const GridLayout& layout) : x(layout.entries()), y(layout.entries()) {}
  void swap(GridField& other) {
    x.swap(other.x);
    y.swap(other.y);
  }
  Vec2 at(std::size_t place) const { return {x[place], y[place]}; }
  void set(std::size_t place, const Vec2& value) {
    x[place] = value.x();
    y[place] = value.y();
  }
  std::size_t entries() const { return x.entries(); }
  // As the kernels take it. Implicit: a view, and nothing else is meant.
  operator kernels::ConstField() const {  // NOLINT(google-explicit-constructor)
    return {x.data(), y.data()};
  }
  operator kernels::Field() { return {x.data(), y.data()}; }  // NOLINT(google-explicit-constructor)

  GridArray<double> x, y;
};

// A vector over a grid in single precision.
class GridVector {
 public:
  GridVector() = default;
  explicit GridVector(const GridLayout& layout) : x_(layout.entries()), y_(layout.entries()) {}

  float* x() { return x_.data(); }
  float* y() { return y_.data(); }
  const float* x() const { return x_.data(); }
  const float* y() const { return y_.data(); }
  // As the kernels take it. Implicit: a view, and nothing else is meant.
  operator kernels::Input() const { return {x(), y()}; }  // NOLINT(google-explicit-constructor)
  operator kernels::Output() { return {x(), y()}; }       // NOLINT(google-explicit-constructor)
  void set_zero() {
    x_.set_zero();
    y_.set_zero();
  }
  void swap(GridVector& other) {
    x_.swap(other.x_);
    y_.swap(other.y_);
  }

 private:
  GridArray<float> x_, y_;
};

// How a film mesh lies on its grid.
class FilmGrid {
 public:
  explicit FilmGrid(const FilmMesh& mesh);

  const GridLayout& layout() const { return layout_; }
  std::size_t vertices() const { return place_.size(); }
  // Of a vertex, in arrays over the grid.
  std::size_t place(std::size_t v) const { return std::size_t(place_[v]); }
  // Column and row of its node.
  const std::array<int, 2>& node(std::size_t v) const { return node_[v]; }
  // What a field holds at a triangle's corners.
  std::array<Vec2, 3> corners(const Triangle& triangle, const GridField& field) const;

  // Of a triangle, in arrays over elements (kernels::Elements), which have `elements()` entries.
  std::size_t element(std::size_t t) const { return std::size_t(element_[t]); }
  std::size_t elements() const { return 2 * layout_.entries(); }
  // The triangle there; -1: none.
  std::int32_t triangle(std::size_t element) const { return triangle_[element]; }
  // Corner 0 of the triangle's element is the triangle's corner of this number, and so on round.
  int first_corner(std::size_t t) const { return first_corner_[t]; }
  const GridArray<double>& rising(int parity) const { return rising_[std::size_t(parity)]; }

  // Of a loop over vertices with little to do for each.
  static constexpr std::size_t kVertexGrain = 5120;

  // From vertices to the grid and back; what is no vertex stays as it is.
  void to_grid(const VertexVector& from, GridField& to) const;
  void to_vertices(const GridField& from, VertexVector& to) const;
  GridField field(const VertexVector& from) const;
  // 1 where is_set is 1, 0 at other vertices.
  void to_mask(const std::vector<std::uint8_t>& is_set, GridArray<double>& mask) const;

 private:
  void place_triangles(const FilmMesh& mesh);

  GridLayout layout_;
  std::vector<std::array<int, 2>> node_;
  std::vector<std::int32_t> place_;
  std::vector<std::int32_t> element_, triangle_;
  std::vector<std::uint8_t> first_corner_;
  std::array<GridArray<double>, 2> rising_;
};

}  // namespace hydrodip
