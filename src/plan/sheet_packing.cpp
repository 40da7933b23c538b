#include "plan/sheet_packing.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace hydrodip {
namespace {

constexpr double kRounding_mm = 1e-9;

struct Room {
  Vec2 low, high;
  Vec2 size() const { return high - low; }
  bool holds(const Room& other) const {
    return (other.low - low).minCoeff() >= -kRounding_mm &&
           (high - other.high).minCoeff() >= -kRounding_mm;
  }
  bool meets(const Room& other) const {
    return (other.high - low).minCoeff() > kRounding_mm &&
           (high - other.low).minCoeff() > kRounding_mm;
  }
};

// The largest free rectangles, kept up to date (Jylanki's "MaxRects").
class FreeRooms {
 public:
  explicit FreeRooms(const Vec2& sheet_mm) : rooms_{{Vec2::Zero(), sheet_mm}} {}

  // `turns`: which way round the piece may lie.
  PackedPiece place(const Vec2& size, const std::vector<bool>& turns) {
    PackedPiece best;
    double least = 1e300;
    for (const bool turned : turns) {
      const Vec2 wanted = turned ? Vec2(size.y(), size.x()) : size;
      for (const Room& room : rooms_) {
        const Vec2 left = room.size() - wanted;
        if (left.minCoeff() < -kRounding_mm) continue;
        // The narrowest strip left over; low and left of equal ones.
        const double cost = left.minCoeff() + 1e-6 * room.low.sum() + 1e-9 * left.maxCoeff();
        if (cost >= least) continue;
        least = cost;
        best = {true, turned, room.low};
      }
    }
    if (best.placed) {
      const Vec2 taken = best.turned ? Vec2(size.y(), size.x()) : size;
      take({best.corner_mm, best.corner_mm + taken});
    }
    return best;
  }

 private:
  void take(const Room& taken) {
    std::vector<Room> next;
    for (const Room& room : rooms_) {
      if (!room.meets(taken)) {
        next.push_back(room);
        continue;
      }
      for (int k = 0; k < 2; ++k) {
        Room below = room, above = room;
        below.high[k] = taken.low[k];
        above.low[k] = taken.high[k];
        for (const Room& rest : {below, above})
          if (rest.size().minCoeff() > kRounding_mm) next.push_back(rest);
      }
    }
    rooms_.clear();
    for (std::size_t i = 0; i < next.size(); ++i) {
      bool within = false;
      for (std::size_t j = 0; j < next.size() && !within; ++j)
        within = j != i && next[j].holds(next[i]) && (!next[i].holds(next[j]) || j < i);
      if (!within) rooms_.push_back(next[i]);
    }
  }

  std::vector<Room> rooms_;
};

std::vector<PackedPiece> packed_in(const std::vector<std::size_t>& order,
                                   const std::vector<Vec2>& sizes, const Vec2& sheet,
                                   const std::vector<bool>& turns) {
  FreeRooms rooms(sheet);
  std::vector<PackedPiece> pieces(sizes.size());
  for (const std::size_t i : order) pieces[i] = rooms.place(sizes[i], turns);
  return pieces;
}

}  // namespace

std::vector<PackedPiece> pack_pieces(const std::vector<Vec2>& sizes_mm, const Vec2& sheet_mm) {
  // Large ones first, by several measures of large, and small ones first where not all fit.
  const std::vector<std::function<double(const Vec2&)>> measures = {
      [](const Vec2& s) { return s.maxCoeff(); }, [](const Vec2& s) { return s.prod(); },
      [](const Vec2& s) { return s.sum(); }, [](const Vec2& s) { return s.minCoeff(); },
      [](const Vec2& s) { return -s.prod(); }};
  std::vector<PackedPiece> best;
  std::ptrdiff_t most = -1;
  for (const auto& measure : measures) {
    std::vector<std::size_t> order(sizes_mm.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return measure(sizes_mm[a]) > measure(sizes_mm[b]);
    });
    // Equal pieces often fill a sheet only if all lie the same way.
    for (const std::vector<bool>& turns : {std::vector{false}, {false, true}, {true}}) {
      std::vector<PackedPiece> pieces = packed_in(order, sizes_mm, sheet_mm, turns);
      const auto count = std::count_if(pieces.begin(), pieces.end(),
                                       [](const PackedPiece& piece) { return piece.placed; });
      if (count <= most) continue;
      most = count;
      best = std::move(pieces);
    }
  }
  return best;
}

}  // namespace hydrodip
