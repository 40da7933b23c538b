// What the figures share: the paper's setup, dips of printed film, and pictures side by side.
#pragma once

#include <string>
#include <vector>

#include "coat/design.h"
#include "ink/color_model.h"
#include "settings/config.h"

namespace hydrodip::paper {

constexpr int kPicture_px = 330;  // a panel
constexpr double kSquare_mm = 5;  // of checkerboards

// Letter film, and as in the paper it never tears; everything else as hydrodip has it by default.
JobConfig paper_config();

// An object as it is, centred over the film.
PosedObject posed(Object object);

// Dips a film with these inks on it, at options.dpi; they stiffen it.
DippedObject dip_printed(const PosedObject& object, const InkImage& inks,
                         const DesignOptions& options, const RunContext& context);
// Dips blank film, or what is the same, film that ink does not stiffen.
DippedObject dip_blank(const PosedObject& object, const DesignOptions& options,
                       const RunContext& context);

// The print that the job makes of an object's own colours, with `rounds` rounds at most.
Designed designed(const PosedObject& object, const ColorModel& model, DesignOptions options,
                  int rounds, const RunContext& context);

// ---- pictures ----

struct Panel {
  std::string title;
  Image picture;
};
// In rows of `columns`, each with its title above; all pictures have the same size.
Image panels(const std::vector<Panel>& list, int columns);

// A film image laid on white, cut to the square around the film's centre.
Image film_square(const Image& film_image, const SheetRaster& raster, double side_mm, int size_px);

// The object with that film on it, from below, as lit in the studio. `film_image` shows every
// pixel as it looks on the object.
Image dipped_picture(const DippedObject& dipped, const Image& film_image, const SheetRaster& raster,
                     int size_px, const RunContext& context);
// The object with its own colours.
Image wanted_picture(const PosedObject& object, int size_px, const RunContext& context);

// ---- tables ----

// A row of a Markdown table; the first row is followed by the ruler.
class Table {
 public:
  explicit Table(const std::vector<std::string>& header);
  void add(const std::vector<std::string>& cells);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace hydrodip::paper
