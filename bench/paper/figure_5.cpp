// An evenly blue sphere, printed as it is wanted and with more ink where the film stretches. Both
// prints are dipped as they will be: with the stiffness of the ink that is really on them.
#include <fmt/format.h>

#include <algorithm>

#include "figures.h"
#include "image/color_difference.h"
#include "image/files.h"
#include "samples/samples.h"
#include "study.h"

namespace hydrodip::paper {
namespace {

constexpr SrgbColor kBlue{0.29F, 0.44F, 0.82F};
constexpr double kDepth_mm = 25;  // of a radius of 30: to 80 degrees

Object blue_sphere() {
  Object sphere = make_sample("sphere");
  sphere.uvs.clear();
  sphere.textures.clear();
  Material blue;
  blue.base_color = {srgb_to_linear(kBlue.r), srgb_to_linear(kBlue.g), srgb_to_linear(kBlue.b), 1};
  sphere.materials = {blue};
  sphere.material_of.assign(sphere.triangles.size(), 0);
  return sphere;
}

// How far the film may stretch before a printer cannot lay down enough ink for the blue.
double largest_ratio_in_gamut(const ColorModel& model, double limit) {
  Inks inks;
  model.separate(&kBlue, &inks, 1);
  const double most = double(std::max({inks.c, inks.m, inks.y, inks.k}));
  return std::min(1 / most, limit / double(inks.density()));
}

struct Difference {
  double covered_mm2 = 0, in_gamut_mm2 = 0;  // on the object
  double mean = 0, largest = 0;              // CIEDE2000, over all covered
  double mean_in_gamut = 0, largest_in_gamut = 0;
};

Difference measure(const Image& on_object, const FilmStretch& stretch, double largest_ratio,
                   double dpi) {
  const Vec3 wanted =
      to_cielab({srgb_to_linear(kBlue.r), srgb_to_linear(kBlue.g), srgb_to_linear(kBlue.b), 1});
  Difference d;
  const double pixel_mm2 = (kMmPerInch / dpi) * (kMmPerInch / dpi);
  for (std::size_t i = 0; i < stretch.on_object.size(); ++i) {
    if (!stretch.on_object[i]) continue;
    const double ratio = double(stretch.area_ratio[i]);
    const std::uint8_t* p = &on_object.rgba[4 * i];
    const double difference = ciede2000(
        wanted, to_cielab({srgb8_to_linear(p[0]), srgb8_to_linear(p[1]), srgb8_to_linear(p[2])}));
    d.covered_mm2 += pixel_mm2 * ratio;
    d.mean += pixel_mm2 * ratio * difference;
    d.largest = std::max(d.largest, difference);
    if (ratio > largest_ratio) continue;
    d.in_gamut_mm2 += pixel_mm2 * ratio;
    d.mean_in_gamut += pixel_mm2 * ratio * difference;
    d.largest_in_gamut = std::max(d.largest_in_gamut, difference);
  }
  d.mean /= d.covered_mm2;
  d.mean_in_gamut /= d.in_gamut_mm2;
  return d;
}

struct Outcome {
  Difference difference;
  Image film, object;  // pictures
};

Outcome print_and_dip(DesignOptions options, bool compensate, const Study& study) {
  options.inking.compensate = compensate;
  const auto model = make_device_model();
  const SheetRaster raster = raster_of(options.film, options.dpi);
  const PosedObject sphere = posed(blue_sphere());
  const FilmInk print =
      designed(sphere, *model, options, options.rounds_max, study.context).ink.ink;
  const InkImage& inks = print.inking.inks;

  const DippedObject dipped = dip_printed(sphere, inks, options, study.context);
  const FilmStretch stretch = film_stretch(*dipped.map, raster, 0, study.context);
  const Image on_object = look_on_object(inks, stretch.area_ratio, *model, {1, 1, 1, 1});
  Outcome outcome;
  outcome.difference = measure(on_object, stretch,
                               largest_ratio_in_gamut(*model, options.inking.limit), options.dpi);
  outcome.film =
      film_square(look_on_film(inks, print.inking.printed, *model), raster, 90, kPicture_px);
  outcome.object = dipped_picture(dipped, on_object, raster, kPicture_px, study.context);
  return outcome;
}

void add_rows(Table& table, const std::string& film, const Outcome& before, const Outcome& after) {
  for (const auto& [name, d] :
       {std::pair{"as wanted", before.difference}, std::pair{"with more ink", after.difference}})
    table.add({film, name, fmt::format("{:.0f}", d.covered_mm2),
               fmt::format("{:.0f} %", 100 * d.in_gamut_mm2 / d.covered_mm2),
               fmt::format("{:.2f} ({:.2f})", d.mean_in_gamut, d.largest_in_gamut),
               fmt::format("{:.2f} ({:.2f})", d.mean, d.largest)});
}

}  // namespace

std::string figure_5(const Study& study) {
  DesignOptions options = paper_config().design;
  options.trajectory.depth_mm = kDepth_mm;
  Table table({"film", "printed", "covered mm2", "of it in gamut", "CIEDE2000 in gamut (largest)",
               "CIEDE2000 over all (largest)"});
  const Outcome before = print_and_dip(options, false, study);
  const Outcome after = print_and_dip(options, true, study);
  add_rows(table, "never tears", before, after);
  save_png(study.folder / "figure_5.png", panels({{"evenly blue film", before.film},
                                                  {"the sphere: it pales", before.object},
                                                  {"more ink where film stretches", after.film},
                                                  {"the sphere: even", after.object}},
                                                 2));
  options.dip.material.tear_stretch = FilmMaterial{}.tear_stretch;
  add_rows(table, fmt::format("tears at {:g}", options.dip.material.tear_stretch),
           print_and_dip(options, false, study), print_and_dip(options, true, study));
  return table.text();
}

}  // namespace hydrodip::paper
