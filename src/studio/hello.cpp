#include "studio/hello.h"

#include "samples/samples.h"
#include "settings/artwork_tables.h"
#include "settings/dip_tables.h"
#include "settings/params.h"
#include "settings/settings.h"
#include "studio/document.h"
#include "studio/dropped_files.h"
#include "studio/job_files.h"

namespace hydrodip {
namespace {

Json parameters_list() {
  Json list = Json::parse(parameters_json())["parameters"];
  Json own = Json::array();
  for (Json& p : list) {
    if (is_of_the_machine(p["name"])) continue;
    if (p.contains("zero_means")) p["zero"] = p["zero_means"];
    own.push_back(p);
  }
  return own;
}

}  // namespace

Json hello_json(const std::string& run, const std::string& opened,
                const std::vector<std::string>& profiles, const Json& recent) {
  Json films = Json::array(), sample_list = Json::array(), layers = Json::array();
  for (const FilmFormat& film : film_formats())
    films.push_back(
        {{"name", film.name}, {"width_mm", film.width_mm}, {"height_mm", film.height_mm}});
  for (const SampleInfo& sample : samples())
    sample_list.push_back({{"name", sample.name}, {"text", sample.description}});
  for (const LayerKey& key : layer_keys())
    layers.push_back(
        {{"name", key.name}, {"unit", key.unit}, {"range", key.range}, {"help", key.help}});
  return {{"version", HYDRODIP_VERSION},
          {"run", run},
          {"opened", opened.empty() ? Json() : Json(opened)},
          {"samples", sample_list},
          {"films", films},
          {"parameters", parameters_list()},
          {"layer_keys", layers},
          {"profiles", profiles},
          {"recent", recent},
          {"limits",
           {{"file_bytes", kMostFileBytes},
            {"job_bytes", kMostJobBytes},
            {"document_bytes", kLargestDocument},
            {"layers", kMostLayers},
            {"dips", kMostDips}}},
          {"model_types", model_endings()},
          {"picture_types", picture_endings()}};
}

}  // namespace hydrodip
