// The only place that knows the apriltag library.
#include "tags/apriltag.h"

#include <apriltag/apriltag.h>
#include <apriltag/common/zarray.h>
#include <apriltag/tag36h11.h>
#include <fmt/format.h>

#include <memory>
#include <stdexcept>

namespace hydrodip {
namespace {

// From here on tags are found on a picture of half the size, and read on the whole one.
constexpr std::size_t kLarge_px = 6000000;
constexpr int kWrongBits = 1;
constexpr double kHalfTag_cells = 4;  // the tag's own unit: from its middle to its black edge

struct FreeFamily {
  void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
};
struct FreeDetector {
  void operator()(apriltag_detector_t* detector) const { apriltag_detector_destroy(detector); }
};
struct FreeSightings {
  void operator()(zarray_t* sightings) const { apriltag_detections_destroy(sightings); }
};
using Family = std::unique_ptr<apriltag_family_t, FreeFamily>;

SeenTag seen(const apriltag_detection_t& sighting) {
  SeenTag tag;
  tag.id = sighting.id;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      tag.to_px(i, j) = MATD_EL(sighting.H, i, j) / (j < 2 ? kHalfTag_cells : 1);
  // The library counts pixels' centres at +0, we at +0.5.
  Mat3 half = Mat3::Identity();
  half(0, 2) = half(1, 2) = 0.5;
  tag.to_px = half * tag.to_px;
  return tag;
}

}  // namespace

TagCells tag_cells(int id) {
  if (id < 0 || id >= kTagCount) throw std::out_of_range(fmt::format("there is no tag {}", id));
  const Family family(tag36h11_create());
  // A white edge, a black ring, and inside it the code's bits, of which the first is the highest.
  TagCells cells{};
  for (std::size_t row = 1; row + 1 < kMarkCells; ++row)
    for (std::size_t column = 1; column + 1 < kMarkCells; ++column) cells[row][column] = true;
  for (std::uint32_t bit = 0; bit < family->nbits; ++bit)
    if ((family->codes[id] >> (family->nbits - bit - 1) & 1U) != 0)
      cells[family->bit_y[bit] + 1][family->bit_x[bit] + 1] = false;
  return cells;
}

std::vector<SeenTag> find_tags(const GrayImage& image) {
  const Family family(tag36h11_create());
  const std::unique_ptr<apriltag_detector_t, FreeDetector> detector(apriltag_detector_create());
  apriltag_detector_add_family_bits(detector.get(), family.get(), kWrongBits);
  detector->nthreads = 1;
  detector->quad_decimate = image.value.size() > kLarge_px ? 2 : 1;
  // It reads the pixels and leaves them as they are.
  image_u8_t view{image.width_px, image.height_px, image.width_px,
                  const_cast<std::uint8_t*>(image.value.data())};
  const std::unique_ptr<zarray_t, FreeSightings> sightings(
      apriltag_detector_detect(detector.get(), &view));
  std::vector<SeenTag> tags;
  for (int i = 0; i < zarray_size(sightings.get()); ++i) {
    apriltag_detection_t* sighting = nullptr;
    zarray_get(sightings.get(), i, static_cast<void*>(&sighting));
    tags.push_back(seen(*sighting));
  }
  return tags;
}

}  // namespace hydrodip
