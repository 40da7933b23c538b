// The two views of a dipped object that all pictures of a report show, each lit once.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/context.h"
#include "render/lit_view.h"

namespace hydrodip {

// Where pictures of two views, one above the other, have them: lengths are given for a picture 1600
// wide.
struct ViewLayout {
  double unit = 1;
  int width = 0;  // of the picture, pixels
  int margin = 0, gap = 0;
  int cell_width = 0;
  std::array<int, 2> cell_height{};

  ViewLayout(const TriangleMesh& object, const std::array<Vec3, 2>& directions, int width_px,
             const Standing& standing);
  int px(double length) const;
};

// Refers to object and surface.
class TellingViews {
 public:
  // From two directions towards the eye, as of telling_directions().
  TellingViews(const TriangleMesh& object, const Surface& surface,
               const std::array<Vec3, 2>& directions, int width_px, const Standing& standing,
               const RunContext& context);
  TellingViews(const TellingViews&) = delete;
  TellingViews& operator=(const TellingViews&) = delete;

  const ViewLayout& layout() const { return layout_; }
  const Camera& camera(std::size_t i) const { return cameras_[i]; }
  const LitView& view(std::size_t i) const { return *views_[i]; }
  const Standing& standing() const { return standing_; }

 private:
  Standing standing_;
  std::array<Vec3, 2> directions_;
  ViewLayout layout_;
  std::vector<CornerNormals> normals_;
  std::array<Camera, 2> cameras_;
  std::array<std::unique_ptr<const LitView>, 2> views_;
};

}  // namespace hydrodip
