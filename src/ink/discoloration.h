// Ink pales as the film stretches, and more of it makes up for that, as far as a printer can give
// more (paper section 3.4, and what it leaves open: the gamut).
#pragma once

#include <vector>

#include "base/context.h"
#include "image/image.h"
#include "image/pixel_set.h"
#include "ink/color_model.h"
#include "transfer/film_cells.h"
#include "transfer/raster.h"

namespace hydrodip {

// Where more ink is needed than the printer lays down.
enum class GamutPolicy {
  kClip,   // each ink as far as it goes (the paper)
  kScale,  // the whole image lightened until everything fits
  kSoft,   // all inks of a point held back alike, smoothly from 80 % of the limit on: hue is kept
};

struct InkingOptions {
  bool compensate = true;  // false: printed as wanted, and it will be pale
  GamutPolicy policy = GamutPolicy::kClip;
  double limit = 3;              // largest sum of inks, in (0, 4]
  double lightened_most = 1;     // kScale: the factor on all inks is this at most
  LinearColor base{1, 1, 1, 1};  // of the bare object
};

// What is left of inks on film stretched to `area_ratio` times its area: (a0 / a) c.
Inks paled(const Inks& inks, double area_ratio);

// Inks that leave `wanted` after stretching, (a / a0) c, within what a printer gives: each ink up
// to 1, their sum up to the limit, by kClip or kSoft. Black that the black ink alone cannot give is
// made up of the colours.
Inks compensated(const Inks& wanted, double area_ratio, GamutPolicy policy, double limit);

struct Inking {
  InkImage inks;         // to print
  PixelSet printed;      // where anything is, be it white: where what is wanted is not transparent
  double lightened = 1;  // kScale: factor on all inks, 1 if everything fits
};

// A sheet on which nothing is printed.
Inking no_ink(int width_px, int height_px);

// The inks to print so that `wanted` (straight alpha: 0 where nothing is to be printed) appears on
// the object. area_ratio: FilmStretch's. Ink lies on the base as a filter: the light that comes
// back is that from white film times the base.
Inking ink_film(const Image& wanted, const BlankArray<float>& area_ratio, const ColorModel& model,
                const InkingOptions& options, const RunContext& context);

// What a film with these inks looks like before the dip: over white; transparent where nothing is
// printed, so that the rest of the sheet stays empty. Takes the place of the inks in memory.
Image look_on_film(InkImage inks, const PixelSet& printed, const ColorModel& model);

// The same film pixel by pixel as it will look on the object, paled and over the base colour.
// Transparent where there is no ink and no film on the object.
Image look_on_object(const InkImage& inks, const BlankArray<float>& area_ratio,
                     const ColorModel& model, const LinearColor& base);

// The inks behind an image of a film as `print.png` shows it: transparent means none.
InkImage inks_of_film(const Image& image, const ColorModel& model);

// How far what comes out is from what was wanted, where film lies on the object.
struct Reach {
  double compared_mm2 = 0;      // on the object
  double out_of_reach_mm2 = 0;  // of that, where the CIEDE2000 is above kVisible
  double mean = 0;              // CIEDE2000, over all that was compared
  double mean_within = 0;       // over what is within reach
  double mean_beyond = 0;       // over what is out of reach
  double largest = 0;
  // Per pixel of the film image: CIEDE2000 where it is out of reach, elsewhere 0. Where all is
  // within reach it takes no memory.
  BlankArray<float> out_of_reach;
  FilmCells difference;  // means of the CIEDE2000 where anything is printed; 0 where not compared

  double out_of_reach_share() const {
    return compared_mm2 > 0 ? out_of_reach_mm2 / compared_mm2 : 0;
  }
};
inline constexpr double kVisible = 1;  // CIEDE2000

// ---- all of that in bands of rows ----

// Rows [begin, end) of an image.
struct RowBand {
  int begin = 0, end = 0;
};

// ink_film() is: this, and ink_rows() of all rows. Nothing is printed yet; how much lighter all
// inks have to be is known.
Inking prepared_inking(const Image& wanted, const BlankArray<float>& area_ratio,
                       const ColorModel& model, const InkingOptions& options);
void ink_rows(const RowBand& rows, const Image& wanted, const BlankArray<float>& area_ratio,
              const ColorModel& model, const InkingOptions& options, Inking& result);

// look_on_object() is: this of all rows of a transparent image.
void look_at_rows(const RowBand& rows, const InkImage& inks, const BlankArray<float>& area_ratio,
                  const ColorModel& model, const LinearColor& base, Image& image);

// Compares the pixels that lie on the object (and are opaque in `wanted`), each weighing its area
// there.
class ReachMeter {
 public:
  // `film`: the part of it over whose cells differences are averaged, in film coordinates.
  ReachMeter(const SheetRaster& raster, const Box2& film);

  // Bands from the first row to the last; nothing is asked of rows before them.
  void add(const RowBand& rows, const Image& wanted, const Image& on_object,
           const FilmStretch& stretch);
  // Once, when all rows are there.
  Reach result();

 private:
  void count_pixel(double area_mm2, double difference);

  const double pixel_mm2_;
  CellMeans means_;
  Reach reach_;
  double within_ = 0, beyond_ = 0;  // sums of area times difference
  BlankArray<float> differences_;   // of the band
};

}  // namespace hydrodip
