// Drawings without pixels of their own, SVG and text: the only place that knows librsvg and cairo.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/math.h"
#include "image/image.h"

namespace hydrodip {

// Not to be used by two threads at once.
class Drawing {
 public:
  // Of a file's bytes; nothing outside of them is read. Throws InputError naming `name`: not SVG,
  // damaged, nothing to see.
  static Drawing from_svg(const std::vector<std::uint8_t>& bytes, const std::string& name);
  // One or several lines, cut at the letters' outlines. Throws InputError if nothing would be seen.
  static Drawing from_text(const std::string& text, const std::string& font,
                           const LinearColor& color);

  ~Drawing();
  Drawing(Drawing&&) noexcept;
  Drawing& operator=(Drawing&&) noexcept;

  // Width over height.
  double aspect() const;
  // All of it, at most 32767 px a side.
  Image pixels(int width_px, int height_px) const;

 private:
  struct Impl;
  explicit Drawing(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Whether a file's first bytes are those of an SVG drawing.
bool looks_like_svg(const std::vector<std::uint8_t>& bytes);

}  // namespace hydrodip
