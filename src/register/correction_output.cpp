#include "register/correction_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "register/arrow_map.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

Json pair_of(const Vec2& v) { return {v.x(), v.y()}; }

Json json_of(const CorrectedDip& of) {
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i)
    rows.push_back({of.to_posed(i, 0), of.to_posed(i, 1), of.to_posed(i, 2)});
  return {{"model",
           {{"path", of.model}, {"sha256", of.model_sha256}, {"shape_sha256", of.shape_sha256}}},
          {"to_posed", rows},
          {"size_mm", {of.size_mm.x(), of.size_mm.y(), of.size_mm.z()}},
          {"depth_mm", of.depth_mm},
          {"film",
           {{"width_mm", of.film_mm.x()},
            {"height_mm", of.film_mm.y()},
            {"margin_mm", of.margin_mm},
            {"swelling_x", of.swelling.x()},
            {"swelling_y", of.swelling.y()}}},
          {"material",
           {{"z_stretch", of.z_stretch},
            {"poisson", of.poisson},
            {"ink_stiffness_ratio", of.ink_stiffness_ratio}}},
          {"way", of.way}};
}

}  // namespace

std::string correction_json(const CorrectedDip& of, const std::vector<SeenDip>& dips,
                            const std::vector<CorrectionSample>& samples,
                            const DisplacementFit& fit) {
  Json seen = Json::array(), moves = Json::array(), kept = Json::array();
  for (const SeenDip& dip : dips)
    seen.push_back({{"file", dip.file.string()},
                    {"board", dip.board},
                    {"square_mm", dip.square_mm},
                    {"places", dip.samples.size()},
                    {"mean_off_mm", pair_of(dip.mean_off)},
                    {"rms_on_sheet_mm", dip.rms_off_mm},
                    {"rms_on_object_mm", dip.rms_on_object_mm}});
  for (const Vec2& move : fit.field.move) moves.push_back(pair_of(move));
  for (const CorrectionSample& s : samples)
    kept.push_back({{"model_mm", pair_of(s.model_mm)}, {"move_mm", pair_of(s.move_mm)}});
  const Json json = {{"schema_version", kCorrectionSchemaVersion},
                     {"generator", "hydrodip correct"},
                     {"of", json_of(of)},
                     {"dips", seen},
                     {"between_dips_mm", between_dips_mm(dips)},
                     {"smooth_mm", fit.smooth_mm},
                     {"noise_mm", fit.noise_mm},
                     {"left_out_rms_mm", fit.left_out_rms_mm},
                     {"grid",
                      {{"first_mm", pair_of(fit.field.first)},
                       {"pitch_mm", fit.field.pitch_mm},
                       {"nx", fit.field.nx},
                       {"ny", fit.field.ny},
                       {"move_mm", moves},
                       {"sigma_mm", fit.sigma_mm}}},
                     {"samples", kept}};
  return json_line(json) + "\n";
}

Image draw_field(const DisplacementFit& fit, const FilmOptions& film, double before_mm) {
  std::vector<Arrow> arrows;
  constexpr int kEvery = 2;
  double least = 1e300;
  for (const double sigma : fit.sigma_mm) least = std::min(least, sigma);
  for (int j = 0; j < fit.field.ny; j += kEvery)
    for (int i = 0; i < fit.field.nx; i += kEvery) {
      const std::size_t at = std::size_t(j) * std::size_t(fit.field.nx) + std::size_t(i);
      const Vec2 u = fit.field.first + fit.field.pitch_mm * Vec2(i, j);
      if (is_free(film, u) && fit.sigma_mm[at] < std::max(0.1, 3 * least))
        arrows.push_back({u, fit.field.move[at]});
    }
  return draw_arrow_map(
      film.width_mm, film.height_mm, film.margin_mm, arrows, "How much farther to print",
      {fmt::format("off by {:.2f} mm rms on this print", before_mm),
       fmt::format("places left out are foretold to {:.2f} mm", fit.left_out_rms_mm),
       "arrows where the field is known"});
}

}  // namespace hydrodip
