#include "job/nest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "job/job_part.h"
#include "job/prepare.h"
#include "plan/fit.h"

namespace hydrodip {
namespace {

// Film between the object and the tape: the less there is, the more it is stretched, and tears. As
// much as the sheet has room for, from the least to enough.
constexpr double kLeastClearance_mm = 10, kLeastClearancePerDepth = 0.25;
constexpr double kEnoughClearance_mm = 30, kEnoughClearancePerDepth = 1.5;
constexpr int kClearances = 32;  // tried between the two

Vec2 film_size(const FilmOptions& film) { return {film.width_mm, film.height_mm}; }

// From the least, at 0, to enough, at 1.
double clearance_for(double depth_mm, double amount) {
  const double least = std::max(kLeastClearance_mm, kLeastClearancePerDepth * depth_mm);
  const double enough = std::max(kEnoughClearance_mm, kEnoughClearancePerDepth * depth_mm);
  return least + amount * (enough - least);
}

// The piece of an object: itself, free film, tape.
FilmOptions piece_for(const Room& room, const FilmOptions& sheet, double clearance) {
  FilmOptions piece = sheet;
  piece.shape = FilmShape::kRectangle;
  piece.width_mm = std::ceil(2 * (room.half_width_mm + clearance + sheet.margin_mm));
  piece.height_mm = std::ceil(2 * (room.half_height_mm + clearance + sheet.margin_mm));
  return piece;
}

void cut_pieces(std::vector<NestPart>& parts, const FilmOptions& sheet, double amount,
                std::optional<double> given_mm) {
  for (NestPart& part : parts)
    part.job.config.design.film = piece_for(
        part.room, sheet, given_mm ? *given_mm : clearance_for(part.room.depth_mm, amount));
}

// As far as they find room.
std::vector<NestPiece> place(const std::vector<NestPart>& parts, const FilmOptions& sheet) {
  std::vector<NestPiece> pieces;
  std::vector<Vec2> sizes;
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (int n = 0; n < parts[p].count; ++n) {
      pieces.push_back({p, int(pieces.size()) + 1, {}});
      sizes.push_back(film_size(parts[p].film()));
    }
  const Vec2 room = film_size(sheet) - 2 * Vec2::Constant(sheet.margin_mm);
  const std::vector<PackedPiece> places = pack_pieces(sizes, room);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].place = places[i];
    pieces[i].place.corner_mm += Vec2::Constant(sheet.margin_mm);
  }
  return pieces;
}

const NestPiece* first_left_out(const std::vector<NestPiece>& pieces) {
  for (const NestPiece& piece : pieces)
    if (!piece.place.placed) return &piece;
  return nullptr;
}

}  // namespace

void share_out_film(Nest& nest, const FilmOptions& sheet, std::optional<double> clearance_mm,
                    const RunContext& context) {
  for (int k = clearance_mm ? 0 : kClearances; k >= 0; --k) {
    cut_pieces(nest.parts, sheet, double(k) / kClearances, clearance_mm);
    nest.pieces = place(nest.parts, sheet);
    if (!first_left_out(nest.pieces)) break;
    context.check_cancelled();
  }
  if (const NestPiece* left_out = first_left_out(nest.pieces)) {
    const NestPart& part = nest.parts[left_out->part];
    throw InputError(fmt::format(
        "the film of {:g} x {:g} mm holds {} of the {} parts ({} needs a piece of {:.0f} x {:.0f} "
        "mm); take a larger --film, fewer parts, or less --clearance",
        sheet.width_mm, sheet.height_mm,
        std::count_if(nest.pieces.begin(), nest.pieces.end(),
                      [](const NestPiece& piece) { return piece.place.placed; }),
        nest.pieces.size(), part.name(), part.film().width_mm, part.film().height_mm));
  }
  for (const NestPart& part : nest.parts) {
    do_part(part.name(), context, [&](const RunContext& own) {
      require_fit(part.job.prepared.posed.size_mm(), part.room, part.film(), part.job.config.bath,
                  own);
    });
    require_on_film(part.job.prepared, part.film());
  }
}

std::string not_to_be_dipped(const Nest& nest) {
  std::string numbers;
  for (const NestPiece& piece : nest.pieces)
    if (nest.made[piece.part].is_not_to_be_dipped())
      numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", piece.number);
  return numbers;
}

}  // namespace hydrodip
