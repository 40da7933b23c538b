#include "job/logo.h"

#include <algorithm>

#include "artwork/picture.h"
#include "image/files.h"

namespace hydrodip {
namespace {

// Twice what the page's style shows, for fine screens and for paper.
constexpr double kHeight_px = 160, kWidth_px = 900;

}  // namespace

std::vector<std::uint8_t> logo_png(const std::filesystem::path& file) {
  if (file.empty()) return {};
  ArtworkLayer layer;
  layer.image = file;
  PictureSource source(layer);
  const double aspect = source.aspect();
  const double height = std::min(kHeight_px, kWidth_px / aspect);
  return encode_png(*source.image(Vec2(height * aspect, height), 1));
}

}  // namespace hydrodip
