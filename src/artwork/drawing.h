// Drawings without pixels of their own, SVG and text: the only place that knows librsvg and cairo.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artwork/svg_contents.h"
#include "artwork/tiled_image.h"
#include "base/math.h"
#include "image/image.h"

namespace hydrodip {

struct DrawnLine;

// Not to be used by two threads at once.
class Drawing {
 public:
  // Of a file's bytes, packed (.svgz) or not; nothing outside of them is read. Throws InputError
  // naming `name`: not SVG, damaged, nothing to see.
  static Drawing from_svg(const std::vector<std::uint8_t>& bytes, const std::string& name);
  // One or several lines, cut at the letters' outlines. A letter that no font has (fonts.h) becomes
  // a box. Throws InputError if nothing would be seen, and on a machine without fonts.
  static Drawing from_text(const std::string& text, const std::string& font,
                           const LinearColor& color);
  // One line of black letters. Nothing if there is nothing to see. Throws as from_text does.
  static std::optional<DrawnLine> of_line(const std::string& text, const std::string& font);

  ~Drawing();
  Drawing(Drawing&&) noexcept;
  Drawing& operator=(Drawing&&) noexcept;

  // Width over height.
  double aspect() const;
  // If an SVG drawing says it in mm, inches or the like; else 0.
  double natural_width_mm() const;
  // Of an SVG drawing: whether it has text, which is set in whatever fonts this machine has, and
  // what is not shown of it.
  const SvgContents& contents() const;
  // The largest that can be drawn: pixels in all, and a side's. A drawing in which something is
  // mixed as a whole (a group's opacity, blending, filters, masks) must be drawn in one piece.
  struct Limits {
    double pixels, side_px;
  };
  Limits limits() const;
  // All of it, within the limits.
  Image pixels(int width_px, int height_px) const;
  // The same in tiles, drawn piece by piece. Nothing if these would take more than so many bytes,
  // or if letters are larger than can be drawn: a smaller size may do.
  std::optional<TiledImage> tiles(int width_px, int height_px, std::size_t most_bytes) const;

 private:
  struct Impl;
  explicit Drawing(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Of text.
struct DrawnLine {
  Drawing drawing;
  Box2 place;  // of the drawing: font sizes from the base line's left end, y up
};

}  // namespace hydrodip
