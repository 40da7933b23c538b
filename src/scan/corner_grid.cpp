#include "scan/corner_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "base/error.h"

namespace hydrodip {
namespace {

using Quad = std::array<std::int32_t, 4>;
using Edge = std::pair<std::int32_t, std::int32_t>;

Edge undirected(std::int32_t a, std::int32_t b) { return {std::min(a, b), std::max(a, b)}; }

void check_quads(const std::vector<Quad>& quads, std::size_t corners, const std::string& name) {
  for (std::size_t q = 0; q < quads.size(); ++q) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (quads[q][k] < 0 || std::size_t(quads[q][k]) >= corners)
        throw InputError(
            fmt::format("{}: quad {} refers to a corner that is not there", name, q + 1));
      for (std::size_t l = 0; l < k; ++l)
        if (quads[q][k] == quads[q][l])
          throw InputError(
              fmt::format("{}: quad {} has one corner twice; draw it with four different corners",
                          name, q + 1));
    }
  }
}

// Which quads lie at an edge.
std::map<Edge, std::vector<std::size_t>> quads_at_edges(const std::vector<Quad>& quads,
                                                        const std::string& name) {
  std::map<Edge, std::vector<std::size_t>> at;
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (std::size_t k = 0; k < 4; ++k) {
      auto& list = at[undirected(quads[q][k], quads[q][(k + 1) % 4])];
      list.push_back(q);
      if (list.size() > 2)
        throw InputError(fmt::format(
            "{}: {} quads share one edge, at quad {}; a checkerboard's edge lies between two "
            "squares: delete doubled faces",
            name, list.size(), q + 1));
    }
  return at;
}

// Gives the corners of connected quads their places, quad by quad. A corner where two patches touch
// belongs to both.
class PlaceFinder {
 public:
  PlaceFinder(const std::vector<Vec3>& corners, const std::vector<Quad>& quads,
              const std::string& name)
      : corners_(corners),
        quads_(quads),
        name_(name),
        at_edge_(quads_at_edges(quads, name)),
        turn_(quads.size(), 0) {}

  CornerGrid run() {
    for (std::size_t q = 0; q < quads_.size(); ++q)
      if (turn_[q] == 0) add_patch(q);
    return grid_;
  }

 private:
  void add_patch(std::size_t first) {
    place_.clear();
    set_place(quads_[first][0], {0, 0}, first);
    set_place(quads_[first][1], {0, 1}, first);
    place_quad(first, 0, 1);
    std::vector<std::size_t> members = {first};
    for (std::size_t i = 0; i < members.size(); ++i) place_neighbors(members[i], members);

    // If most quads run the other way than the first, the places came out mirrored.
    const auto turned =
        std::count_if(members.begin(), members.end(), [&](std::size_t q) { return turn_[q] < 0; });
    const int mirror = 2 * std::size_t(turned) > members.size() ? -1 : 1;
    for (const auto& [corner, place] : place_) {
      grid_.position.push_back(corners_[std::size_t(corner)]);
      grid_.place.push_back({mirror * place[0], place[1]});
      grid_.patch.push_back(patches_);
    }
    ++patches_;
  }

  void place_neighbors(std::size_t q, std::vector<std::size_t>& members) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::int32_t a = quads_[q][k], b = quads_[q][(k + 1) % 4];
      for (const std::size_t next : at_edge_.at(undirected(a, b))) {
        if (turn_[next] != 0) continue;
        const auto start = std::size_t(std::find(quads_[next].begin(), quads_[next].end(), a) -
                                       quads_[next].begin());
        // A neighbour that is turned the same way runs along the edge the other way.
        const bool same_turn = quads_[next][(start + 3) % 4] == b;
        place_quad(next, start, same_turn ? turn_[q] : -turn_[q]);
        members.push_back(next);
      }
    }
  }

  // Places the four corners, of which `start` and one beside it have their places.
  void place_quad(std::size_t q, std::size_t start, int turn) {
    turn_[q] = turn;
    // Walks so that every turn is to the right on the film, whichever way the file has it.
    const auto corner = [&](int steps) {
      return quads_[q][std::size_t(8 + int(start) + turn * steps) % 4];
    };
    const int begin = place_.count(corner(1)) > 0 ? 0 : -1;
    const GridPlace from = place_.at(corner(begin)), to = place_.at(corner(begin + 1));
    const GridPlace along = {to[0] - from[0], to[1] - from[1]};
    const GridPlace right = {along[1], -along[0]};
    set_place(corner(begin + 2), {to[0] + right[0], to[1] + right[1]}, q);
    set_place(corner(begin + 3), {from[0] + right[0], from[1] + right[1]}, q);
  }

  void set_place(std::int32_t corner, const GridPlace& place, std::size_t q) {
    const auto [entry, is_new] = place_.try_emplace(corner, place);
    if (!is_new && entry->second != place)
      throw InputError(fmt::format(
          "{}: rows and columns contradict each other at quad {}; every inner corner of a "
          "checkerboard has four squares around it",
          name_, q + 1));
  }

  const std::vector<Vec3>& corners_;
  const std::vector<Quad>& quads_;
  const std::string& name_;
  std::map<Edge, std::vector<std::size_t>> at_edge_;
  std::vector<int> turn_;  // per quad: 1 as its patch's first, -1 the other way, 0 not seen yet
  std::map<std::int32_t, GridPlace> place_;  // of this patch's corners
  int patches_ = 0;
  CornerGrid grid_;
};

void refuse_doubled_places(const CornerGrid& grid, const std::string& name) {
  std::set<std::tuple<int, int, int>> seen;
  for (std::size_t c = 0; c < grid.place.size(); ++c)
    if (!seen.insert({grid.patch[c], grid.place[c][0], grid.place[c][1]}).second)
      throw InputError(fmt::format(
          "{}: the quads wind around so that two corners have the same row and column; a "
          "checkerboard has four squares at every inner corner",
          name));
}

}  // namespace

std::vector<GridLength> grid_lengths(const CornerGrid& grid) {
  std::map<std::tuple<int, int, int>, std::int32_t> corner_at;
  for (std::size_t c = 0; c < grid.place.size(); ++c)
    corner_at[{grid.patch[c], grid.place[c][0], grid.place[c][1]}] = std::int32_t(c);
  std::vector<GridLength> lengths;
  for (std::size_t c = 0; c < grid.place.size(); ++c) {
    const auto add = [&](int columns, int rows) {
      const auto found =
          corner_at.find({grid.patch[c], grid.place[c][0] + columns, grid.place[c][1] + rows});
      if (found == corner_at.end()) return;
      lengths.push_back({std::int32_t(c), found->second, columns != 0 && rows != 0});
    };
    add(1, 0);
    add(0, 1);
    add(1, 1);
    add(1, -1);
  }
  return lengths;
}

CornerGrid grid_of_quads(const std::vector<Vec3>& corners, const std::vector<Quad>& quads,
                         const std::string& name) {
  check_quads(quads, corners.size(), name);
  CornerGrid grid = PlaceFinder(corners, quads, name).run();
  refuse_doubled_places(grid, name);
  return grid;
}

}  // namespace hydrodip
