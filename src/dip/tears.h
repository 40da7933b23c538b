// Which film lets go, and what of it is left.
#pragma once

#include <cstdint>
#include <vector>

#include "dip/floating_sheet.h"

namespace hydrodip {

// Film that lets go pulls no more, now and for good. So does what afterwards hangs by so little on
// the film that the rim holds that its place means nothing: scraps, threads, and what is cut off.
// What stays has clean edges, which are free.
class Tears {
 public:
  Tears(const DipSetting& setting, DipState& state)
      : set_(setting), film_(setting.film), state_(state) {}

  // Of triangles that block the rest because they would have to turn over.
  void release(const std::vector<std::int32_t>& blocked, double travelled_mm, FloatingSheet& sheet,
               std::vector<std::uint8_t>& is_free);
  // What is stretched too far in the relaxed film, or was told to let go by now.
  void release_overstretched(double travelled_mm, const FloatingSheet& sheet);
  // Once vertices have attached: updates the loads of what let go in this step. What has come to
  // lie on the object with all its corners has not torn: between two places where the object
  // touches, the little film that still floats is only said to be stretched.
  void end_step(FloatingSheet& sheet);
  // Whether any film has let go for good.
  bool any() const { return any_; }

 private:
  void let_go(std::int32_t t, double travelled_mm);
  void drop_scraps(double travelled_mm, const FloatingSheet& sheet);
  bool carries(std::size_t t, const FloatingSheet& sheet) const {
    return sheet.is_usable(t) && !state_.torn[t];
  }

  const DipSetting set_;
  const FilmMesh& film_;
  DipState& state_;
  std::vector<std::size_t> torn_now_;  // in this step
  std::size_t unloaded_ = 0;           // of these, whose loads are up to date
  bool any_ = false;
};

}  // namespace hydrodip
