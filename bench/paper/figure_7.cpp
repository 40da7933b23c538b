// How the film image grows while ink and film come to agree, round by round.
#include <fmt/format.h>

#include "figures.h"
#include "image/files.h"
#include "samples/samples.h"
#include "study.h"

namespace hydrodip::paper {
namespace {

struct Growth {
  std::vector<InkRound> rounds;
  bool settled = false;
  Image first, last;  // the film image of the first round and of the last
};

Growth follow(const std::string& sample, const DesignOptions& options, const Study& study) {
  const auto model = make_device_model();
  const SheetRaster raster = raster_of(options.film, options.dpi);
  const PosedObject object = posed(make_sample(sample));
  const double side_mm = 1.25 * object.mesh().bounds().size().head<2>().maxCoeff();
  const auto picture = [&](const FilmInk& ink) {
    return film_square(look_on_film(ink.inking.inks, ink.inking.printed, *model), raster, side_mm,
                       kPicture_px);
  };
  Growth growth;
  growth.first = picture(designed(object, *model, options, 1, study.context).ink.ink);
  const InkResult result = designed(object, *model, options, options.rounds_max, study.context).ink;
  growth.last = picture(result.ink);
  growth.rounds = result.rounds;
  growth.settled = result.settled;
  return growth;
}

}  // namespace

std::string figure_7(const Study& study) {
  DesignOptions options = paper_config().design;
  // Full spheres and ellipsoids are dipped here: the film tears on their upper sides.
  options.dip.material.tear_stretch = FilmMaterial{}.tear_stretch;
  Table table({"object", "round", "printed mm2", "film moved by (mm, mean)"});
  std::vector<Panel> pictures;
  for (const std::string name : {"sphere", "pyramid", "ellipsoid", "mask"}) {
    const Growth growth = follow(name, options, study);
    for (std::size_t i = 0; i < growth.rounds.size(); ++i) {
      const InkRound& round = growth.rounds[i];
      const bool last = i + 1 == growth.rounds.size();
      table.add({i == 0 ? name : "", std::to_string(i + 1),
                 fmt::format("{:.1f}", round.printed_mm2),
                 i == 0 ? ""
                        : fmt::format("{:.2g}", round.change_mm) +
                              (last && !growth.settled ? " (not settled)" : "")});
    }
    if (name != "pyramid" && name != "mask") continue;
    pictures.push_back({name + ", round 1", growth.first});
    pictures.push_back({fmt::format("{}, round {}", name, growth.rounds.size()), growth.last});
  }
  save_png(study.folder / "figure_7.png", panels(pictures, 2));
  return table.text();
}

}  // namespace hydrodip::paper
