// Where film tears, and what of it still hangs on something afterwards.
#pragma once

#include <cstdint>
#include <vector>

#include "dip/floating_sheet.h"

namespace hydrodip {

class Tears {
 public:
  Tears(const DipSetting& setting, DipState& state)
      : set_(setting), film_(setting.film), state_(state) {}

  // The free vertices, without islands: film torn off all around or hanging by one point drifts,
  // because nothing says where it should be.
  std::vector<std::uint8_t> held_vertices(const FloatingSheet& sheet) const;
  // Of triangles that block the rest because they would have to turn over.
  void release(const std::vector<std::int32_t>& blocked, double travelled_mm, FloatingSheet& sheet,
               std::vector<std::uint8_t>& is_free);
  // What is stretched too far in the relaxed film, or was told to tear by now.
  void tear_overstretched(double travelled_mm, FloatingSheet& sheet);
  // Updates the loads of what tore since it was called last.
  void update_loads(FloatingSheet& sheet);

 private:
  void tear(std::int32_t t, double travelled_mm);

  const DipSetting set_;
  const FilmMesh& film_;
  DipState& state_;
  std::vector<std::size_t> torn_now_;  // triangles torn in this step
  bool any_torn_ = false;
};

}  // namespace hydrodip
