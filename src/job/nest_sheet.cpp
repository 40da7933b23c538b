#include "job/nest_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "artwork/drawing.h"
#include "job/sheet_of.h"
#include "sheet/page_text.h"

namespace hydrodip {
namespace {

// Lines to cut along, and what is written beside them, in the taped margin.
constexpr double kLine_mm = 0.2, kLabel_mm = 3, kTick_mm = 3;

// A rectangle of pixels on the sheet, and how a piece's own pixels lie in it.
class PieceOnSheet {
 public:
  PieceOnSheet(const NestPiece& piece, const SheetRaster& own, const SheetRaster& sheet)
      : width_(own.width_px()), height_(own.height_px()), turned_(piece.place.turned) {
    const double pixel_mm = kMmPerInch / sheet.dpi;
    left_ = int(std::lround(piece.place.corner_mm.x() / pixel_mm));
    const int bottom = int(std::lround(piece.place.corner_mm.y() / pixel_mm));
    left_ = std::clamp(left_, 0, std::max(0, sheet.width_px() - wide()));
    top_ =
        std::clamp(sheet.height_px() - bottom - high(), 0, std::max(0, sheet.height_px() - high()));
  }
  int wide() const { return turned_ ? height_ : width_; }
  int high() const { return turned_ ? width_ : height_; }

  // Copies what is printed of the piece. Turned: its right edge is up on the sheet.
  void copy(const Inking& from, Inking& sheet) const {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        if (!from.printed.contains(x, y)) continue;
        const int to_x = left_ + (turned_ ? y : x);
        const int to_y = top_ + (turned_ ? width_ - 1 - x : y);
        if (to_x >= sheet.inks.width_px || to_y >= sheet.inks.height_px) continue;
        std::copy_n(from.inks.pixel(x, y), 4, sheet.inks.pixel(to_x, to_y));
        sheet.printed.insert(to_x, to_y);
      }
  }

 private:
  int width_, height_;
  bool turned_;
  int left_ = 0, top_ = 0;
};

// Black on a piece: where `alpha` says so.
void blacken(Inking& laid, int x, int y, std::uint8_t alpha) {
  if (alpha == 0 || x < 0 || y < 0 || x >= laid.inks.width_px || y >= laid.inks.height_px) return;
  std::uint8_t* inks = laid.inks.pixel(x, y);
  inks[3] = std::max(inks[3], alpha);
  laid.printed.insert(x, y);
}

// What is needed to cut a piece out and to know it again.
void mark_piece(Inking& laid, const std::string& label, double margin_mm, double dpi) {
  const int width = laid.inks.width_px, height = laid.inks.height_px;
  const double pixels_per_mm = dpi / kMmPerInch;
  const int line = std::max(1, int(std::lround(kLine_mm * pixels_per_mm)));
  for (int x = 0; x < width; ++x)
    for (int k = 0; k < line; ++k) {
      blacken(laid, x, k, 255);
      blacken(laid, x, height - 1 - k, 255);
    }
  for (int y = 0; y < height; ++y)
    for (int k = 0; k < line; ++k) {
      blacken(laid, k, y, 255);
      blacken(laid, width - 1 - k, y, 255);
    }
  // Where the object's middle belongs.
  const int tick = int(std::min(kTick_mm, 0.5 * margin_mm) * pixels_per_mm);
  for (int k = 0; k < tick; ++k)
    for (int across = 0; across < line; ++across) {
      blacken(laid, width / 2 + across, k, 255);
      blacken(laid, width / 2 + across, height - 1 - k, 255);
      blacken(laid, k, height / 2 + across, 255);
      blacken(laid, width - 1 - k, height / 2 + across, 255);
    }
  if (margin_mm < kLabel_mm + 2) return;
  const Drawing text = Drawing::from_text(page_text(label).shown, "sans bold", {0, 0, 0, 1});
  double high_mm = kLabel_mm, wide_mm = high_mm * text.aspect();
  const double room_mm = width / pixels_per_mm - 4;
  if (wide_mm > room_mm) {
    high_mm *= room_mm / wide_mm;
    wide_mm = room_mm;
  }
  const Image letters = text.pixels(std::max(1, int(wide_mm * pixels_per_mm)),
                                    std::max(1, int(high_mm * pixels_per_mm)));
  const int left = (width - letters.width_px) / 2;
  const int top = height - int((0.5 * margin_mm + 0.5 * high_mm) * pixels_per_mm);
  for (int y = 0; y < letters.height_px; ++y)
    for (int x = 0; x < letters.width_px; ++x)
      blacken(laid, left + x, top + y, letters.pixel(x, y)[3]);
}

std::string label_of(const NestPiece& piece, const Nest& nest) {
  return fmt::format("{}: {}{}", piece.number, nest.parts[piece.part].file.stem().string(),
                     nest.made[piece.part].is_not_to_be_dipped() ? " - DO NOT DIP" : "");
}

}  // namespace

Inking whole_sheet(const Nest& nest, const SheetRaster& sheet) {
  Inking whole = no_ink(sheet.width_px(), sheet.height_px());
  for (const NestPiece& piece : nest.pieces) {
    const Designed& designed = nest.made[piece.part].made.designed;
    Inking own = designed.ink.ink.inking;
    mark_piece(own, label_of(piece, nest), nest.parts[piece.part].film().margin_mm, sheet.dpi);
    const PieceOnSheet on(piece, designed.raster, sheet);
    on.copy(own, whole);
  }
  return whole;
}

SheetOptions sheet_of(const JobConfig& config, const Nest& nest) {
  SheetOptions sheet = sheet_of(config);
  // Of pieces that are cut out nobody finds the sheet's own rim and marks.
  sheet.disc = sheet.camera_marks = false;
  if (config.print.job_name.empty()) sheet.job_name = fmt::format("{} parts", nest.pieces.size());
  const std::string bad = not_to_be_dipped(nest);
  sheet.alarm = bad.empty() ? draft_alarm(config.design) : "DO NOT DIP " + bad;
  return sheet;
}

}  // namespace hydrodip
