#include "request.h"

#include <CLI/CLI.hpp>

#include "base/error.h"

namespace hydrodip {
namespace {

constexpr const char* kOutputGroup = "Output";
constexpr const char* kObjectGroup = "Object";
constexpr const char* kFilmGroup = "Film and dip";
constexpr const char* kConfigGroup = "Configuration";

// An option that sets one parameter; the last one given counts.
void add_parameter_option(CLI::App& app, Request& request, const std::string& option,
                          const std::string& parameter, const std::string& value_name,
                          const std::string& group, const std::string& help) {
  app.add_option_function<std::string>(
         option,
         [&request, parameter, option](const std::string& value) {
           request.sources.options.push_back({parameter, value, false, "'" + value + "'", option});
         },
         help)
      ->group(group)
      ->type_name(value_name)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

}  // namespace

void declare_model(CLI::App& app, Request& request) {
  app.add_option("MODEL", request.model, "OBJ, PLY, STL, OFF, 3MF, glTF or GLB file")
      ->type_name("");
}

void declare_output(CLI::App& app, Request& request, const std::string& default_folder) {
  app.add_option("-o,--output", request.output,
                 "output folder, made if needed (default: " + default_folder + ")")
      ->group(kOutputGroup)
      ->type_name("DIR");
}

void declare_reporting(CLI::App& app, Request& request) {
  app.add_flag("--json", request.json, "the result as JSON on standard output")
      ->group(kOutputGroup);
  app.add_flag("--quiet", request.quiet, "no progress")->group(kOutputGroup);
}

void declare_object(CLI::App& app, Request& request) {
  const auto add = [&](const char* option, const char* parameter, const char* value_name,
                       const char* help) {
    add_parameter_option(app, request, option, parameter, value_name, kObjectGroup, help);
  };
  add("--texture", "object.texture", "IMG", "image that replaces the model's textures (PNG, JPEG)");
  add("--units", "object.units", "mm|cm|m|in",
      "unit of the model (default: what the format says, else mm)");
  add("--size", "object.size_mm", "MM", "scale so that the largest extent is this");
  add("--down", "object.down", "+x|-x|+y|-y|+z|-z",
      "side that enters the water first (default: -z)");
  add("--rotate", "object.rotate_deg", "X,Y,Z",
      "then turn about fixed x, y, z in that order (degrees)");
}

void declare_film(CLI::App& app, Request& request) {
  app.add_option_function<std::string>(
         "--film",
         [&request](const std::string& film) {
           for (Setting& setting : film_settings(film))
             request.sources.options.push_back(std::move(setting));
         },
         "sheet of film, upright; -landscape turns it (default: a4)")
      ->group(kFilmGroup)
      ->type_name("letter|a4|a3|WxH")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app.add_option_function<std::string>(
         "--quality",
         [&request](const std::string& quality) {
           request.sources.quality = quality_settings(quality);
         },
         "draft: coarse and quick, without pictures; fine: 160,000 triangles, half the step")
      ->group(kFilmGroup)
      ->type_name("draft|normal|fine")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

void declare_film_and_dip(CLI::App& app, Request& request) {
  declare_film(app, request);
  add_parameter_option(app, request, "--depth", "dip.depth_mm", "MM", kFilmGroup,
                       "how deep to dip (default: the whole object)");
  add_parameter_option(app, request, "--path", "path", "FILE.csv", kFilmGroup,
                       "the way into the water, one keyframe a row (default: straight down)");
  add_parameter_option(app, request, "--method", "dip.method", "full|single-step|projection",
                       kFilmGroup,
                       "how the film gets onto the object; the last two are simple baselines to "
                       "compare with (default: full)");
}

void declare_ink(CLI::App& app, Request& request) {
  add_parameter_option(app, request, "--printer-profile", "ink.profile", "FILE.icc", kFilmGroup,
                       "the printer's ICC profile, CMYK or RGB (default: a plain formula)");
}

void declare_resolution(CLI::App& app, Request& request) {
  add_parameter_option(app, request, "--dpi", "print.dpi", "DPI", kFilmGroup,
                       "resolution of the film image, 36 to 1200 (default: 300)");
}

void declare_configuration(CLI::App& app, Request& request) {
  add_parameter_option(app, request, "--threads", "run.threads", "N", kConfigGroup,
                       "processor threads (default: all)");
  const auto paths = [](std::vector<std::filesystem::path>& list) {
    return
        [&list](const std::vector<std::string>& names) { list.assign(names.begin(), names.end()); };
  };
  const auto add_files = [&](const char* option, std::vector<std::filesystem::path>& list,
                             const char* help) {
    app.add_option_function<std::vector<std::string>>(option, paths(list), help)
        ->group(kConfigGroup)
        ->type_name("FILE.toml")
        ->allow_extra_args(false);
  };
  add_files("--profile", request.sources.profiles, "film, printer, process: values for many jobs");
  add_files("--config", request.sources.configs, "values for this job; wins over the profile");
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [&request](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) request.sources.sets.push_back(parse_set(text));
         },
         "any parameter (see 'hydrodip params'); wins over the rest")
      ->group(kConfigGroup)
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

void declare_film_image(CLI::App& app, Request& request) {
  app.add_option("--film-image", request.film_image,
                 "image of the whole sheet as printed (print.png): predicts what it leaves on the "
                 "object")
      ->group(kFilmGroup)
      ->type_name("IMG");
}

void declare_sample(CLI::App& app, Request& request) {
  app.add_option("NAME", request.sample, "which sample; without it: lists them")->type_name("");
}

void declare_folder(CLI::App& app, Request& request) {
  app.add_option("DIR", request.folder, "output folder of a job, or its report.html")
      ->type_name("");
}

JobConfig configure(const Request& request) {
  JobConfig config;
  config.model = request.model;
  config.film_image = request.film_image;
  config.output = request.output;
  config.command_line = request.command_line;
  apply_sources(config, request.sources);
  return config;
}

}  // namespace hydrodip
