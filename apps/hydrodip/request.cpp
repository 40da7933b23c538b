#include "request.h"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/error.h"
#include "base/parse_double.h"
#include "base/run_scope.h"
#include "rig/registration_file.h"
#include "settings/profiles.h"

namespace hydrodip {
namespace {

constexpr const char* kOutputGroup = "Output";
constexpr const char* kObjectGroup = "Object";
constexpr const char* kArtworkGroup = "Artwork (one layer; more as [[artwork]] in a file)";
constexpr const char* kFilmGroup = "Film and dip";
constexpr const char* kConfigGroup = "Configuration";

// Of options that scripts set for many commands and override for one.
constexpr auto kLastCounts = CLI::MultiOptionPolicy::TakeLast;

// An option that sets one parameter. A second layer of artwork does not override the first.
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
      ->multi_option_policy(group == kArtworkGroup ? CLI::MultiOptionPolicy::Throw : kLastCounts);
}

}  // namespace

std::vector<double> numbers_of(const std::string& option, const std::string& text,
                               std::size_t least, std::size_t most) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    double number = 0;
    const auto [rest, error] = parse_double(text.data() + begin, text.data() + end, number);
    if (error != std::errc() || rest != text.data() + end || !std::isfinite(number)) break;
    numbers.push_back(number);
    if (end == text.size() && numbers.size() >= least && numbers.size() <= most) return numbers;
    begin = end + 1;
  }
  throw InputError(option + ": write " + std::to_string(least) +
                   (most > least ? " or " + std::to_string(most) : std::string()) +
                   " numbers with commas between them, not '" + text + "'");
}

CLI::Validator between(double low, double high) {
  const auto refusal = [low, high](const std::string& text) {
    double number = 0;
    const auto [rest, error] = parse_double(text.data(), text.data() + text.size(), number);
    const bool good = error == std::errc() && rest == text.data() + text.size() && number >= low &&
                      number <= high;
    return good ? std::string()
                : fmt::format("'{}': give a number from {:g} to {:g}", text, low, high);
  };
  return {refusal, ""};
}

std::filesystem::path profile_folder() {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    return std::filesystem::path(value != nullptr ? value : "");
  };
  const std::filesystem::path configured = folder("XDG_CONFIG_HOME");
  std::filesystem::path home = folder("HOME");
  if (!home.is_absolute())
    if (const passwd* user = getpwuid(getuid())) home = user->pw_dir;
  return (configured.is_absolute() ? configured : home / ".config") / "hydrodip" / "profiles";
}

namespace {

// Marks options whose values must not differ: then it does not matter which one is taken.
constexpr auto kOneValue = CLI::MultiOptionPolicy::TakeFirst;

}  // namespace

void allow_same_value_twice(CLI::App& app) {
  for (CLI::Option* option : app.get_options({}))
    if (option->nonpositional() && option->get_items_expected_max() == 1 &&
        option->get_multi_option_policy() == CLI::MultiOptionPolicy::Throw)
      option->multi_option_policy(kOneValue);
}

void refuse_two_values(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const std::vector<std::string>& values = option->results();
    if (option->get_multi_option_policy() != kOneValue || values.empty()) continue;
    const auto other = std::ranges::find_if(
        values, [&](const std::string& value) { return value != values.front(); });
    if (other == values.end()) continue;
    const std::string twice = fmt::format("{} is given twice, as '{}' and '{}'", option->get_name(),
                                          values.front(), *other);
    throw InputError(twice + (option->get_group() == kArtworkGroup
                                  ? ": options give one layer of artwork; several stand as "
                                    "[[artwork]] tables in a job file"
                                  : "; give it once"));
  }
}

void declare_model(CLI::App& app, Request& request) {
  app.add_option("MODEL", request.model,
                 "OBJ, PLY, STL, OFF, 3MF, glTF or GLB file, or a job's TOML")
      ->type_name("");
}

void declare_no_clobber(CLI::App& app, Request& request) {
  app.add_flag_callback(
         "--no-clobber",
         [&request] {
           request.sources.options.push_back(
               {"output.no_clobber", std::string("on"), false, "'on'", "--no-clobber"});
         },
         "refuse to replace an earlier result")
      ->group(kOutputGroup);
}

void declare_output(CLI::App& app, Request& request, const std::string& default_folder) {
  app.add_option("-o,--output", request.output,
                 "output folder, made if needed (default: " + default_folder + ")")
      ->group(kOutputGroup)
      ->type_name("DIR");
  declare_no_clobber(app, request);
}

void declare_reporting(CLI::App& app, Request& request) {
  app.add_flag("--json", request.json, "the result as JSON on standard output")
      ->group(kOutputGroup);
  app.add_flag("--quiet", request.quiet, "no progress")->group(kOutputGroup);
}

void declare_report_page(CLI::App& app, Request& request) {
  add_parameter_option(app, request, "--for", "report.for", "workshop|customer", kOutputGroup,
                       "who reads report.html; customer: what comes out, in plain words (default: "
                       "workshop)");
  add_parameter_option(app, request, "--logo", "report.logo", "IMG", kOutputGroup,
                       "picture above report.html (PNG, JPEG, SVG)");
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
  add("--rotate", "object.rotate_deg", "X,Y,Z|auto",
      "then turn about fixed x, y, z in that order (degrees); auto: as it dips best");
}

void declare_artwork(CLI::App& app, Request& request) {
  const auto add = [&](const char* option, const char* key, const char* value_name,
                       const char* help) {
    add_parameter_option(app, request, option, std::string("art.") + key, value_name, kArtworkGroup,
                         help);
  };
  add("--art", "image", "IMG",
      "picture to put on the model, which needs no UVs: PNG, JPEG, SVG, ...");
  add("--art-text", "text", "TEXT", "or text");
  add("--art-font", "font", "FONT", "of the text, as 'DejaVu Serif bold' (default: sans bold)");
  add("--art-color", "text_color", "#rrggbb", "of the text (default: black)");
  add("--projection", "projection", "planar|cylinder|sphere|box|uv|wrap|film",
      "planar, cylinder, sphere, box push the picture through space onto what it meets first; wrap "
      "sticks it on, along the surface; film leaves it on the film (default: planar)");
  add("--art-at", "at_mm", "X,Y,Z",
      "the picture's centre, in the model's frame after --size (default: centred)");
  add("--art-toward", "toward", "X,Y,Z",
      "the way it is projected; of cylinder and sphere the axis (default: from the side that "
      "enters "
      "the water first, or square to the surface at --art-at)");
  add("--art-up", "up", "X,Y,Z", "towards the picture's upper edge (default: the model's z)");
  add("--art-size", "size_mm", "W[,H]",
      "on the surface; one figure keeps its shape (default: as large as fits)");
  add("--art-turn", "turn_deg", "DEG", "turn counter-clockwise, as one sees the picture");
  add("--art-repeat", "repeat", "once|tile|mirror", "beyond its edges (default: once)");
  app.add_flag_callback(
         "--art-through",
         [&request] {
           request.sources.options.push_back(
               {"art.through", std::string("true"), false, "'true'", "--art-through"});
         },
         "also onto what lies behind the first surface")
      ->group(kArtworkGroup);
  add("--art-fade", "fade_deg", "DEG", "fade out where the surface turns away by more than this");
  add("--art-opacity", "opacity", "0..1", "of the layer (default: 1)");
  add("--art-blend", "blend", "normal|multiply", "with what is below (default: normal)");
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
      ->multi_option_policy(kLastCounts);
  app.add_option_function<std::string>(
         "--quality",
         [&request](const std::string& quality) {
           request.sources.quality = quality_settings(quality);
         },
         "draft: coarse and quick, without pictures; fine: 160,000 triangles, half the step")
      ->group(kFilmGroup)
      ->type_name("draft|normal|fine")
      ->multi_option_policy(kLastCounts);
}

namespace {

// What the film on the water is like: a registration's swelling, or a profile.
void take_film_state(Request& request, const std::string& file) {
  if (std::filesystem::path(file).extension() == ".toml") {
    const std::vector<std::string> names = names_in_profile(file);
    const auto is_swelling = [](const std::string& name) {
      return name.starts_with("film.swelling_");
    };
    if (std::ranges::none_of(names, is_swelling))
      throw InputError("--film-state: " + file +
                       ": says nothing of how film swells (film.swelling_x, film.swelling_y); give "
                       "it with --profile");
    request.film_state = file;
    return;
  }
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw InputError("--film-state: " + file +
                     ": there is no such file; 'hydrodip register' writes registration.json into "
                     "the job's folder");
  if (std::filesystem::is_directory(file, ignored))
    throw InputError("--film-state: " + file + " is a folder; name the registration.json in it");
  const auto registration = read_registration(file);
  if (!registration)
    throw InputError("--film-state: " + file +
                     " is neither the registration.json of 'hydrodip register' nor a profile");
  const auto add = [&](const char* name, double value) {
    request.sources.options.push_back({name, value, true, std::to_string(value), "--film-state"});
  };
  add("film.swelling_x", registration->swelling.x());
  add("film.swelling_y", registration->swelling.y());
}

}  // namespace

void declare_film_state(CLI::App& app, Request& request, const std::string& help) {
  app.add_option_function<std::string>(
         "--film-state", [&request](const std::string& file) { take_film_state(request, file); },
         help)
      ->group(kFilmGroup)
      ->type_name("FILE.json|FILE.toml")
      ->multi_option_policy(kLastCounts);
}

void declare_film_and_dip(CLI::App& app, Request& request) {
  declare_film(app, request);
  declare_film_state(app, request,
                     "design for film that swells as this registration.json, or profile, says");
  add_parameter_option(app, request, "--correction", "film.correction", "FILE.json", kFilmGroup,
                       "take out what 'hydrodip correct' found of earlier dips");
  add_parameter_option(app, request, "--depth", "dip.depth_mm", "MM|auto", kFilmGroup,
                       "how deep to dip; auto: as deep as is good (default: the whole object)");
  add_parameter_option(app, request, "--path", "path", "FILE.csv", kFilmGroup,
                       "the way into the water, one keyframe a row (default: straight down)");
  add_parameter_option(app, request, "--method", "dip.method", "full|single-step|projection",
                       kFilmGroup,
                       "how the film gets onto the object; the last two are simple baselines to "
                       "compare with (default: full)");
}

void declare_strict(CLI::App& app, Request& request) {
  app.add_flag("--strict", request.strict, "exit with 4 if the verdict is not to dip it like this")
      ->group(kOutputGroup);
}

void declare_dips(CLI::App& app, Request& request) {
  add_parameter_option(app, request, "--dips", "plan.dips", "N", kFilmGroup,
                       "so many dips, each with a sheet of its own (default: one)");
}

void declare_ink(CLI::App& app, Request& request) {
  add_parameter_option(app, request, "--printer-profile", "ink.profile", "FILE.icc", kFilmGroup,
                       "the printer's ICC profile, CMYK or RGB (default: a plain formula)");
}

void declare_resolution(CLI::App& app, Request& request) {
  add_parameter_option(app, request, "--dpi", "print.dpi", "DPI", kFilmGroup,
                       "resolution of the film image, 36 to 1200 (default: 300)");
}

void declare_threads(CLI::App& app, Request& request) {
  add_parameter_option(app, request, "--threads", "run.threads", "N", kConfigGroup,
                       "processor threads (default: all)");
}

void declare_configuration(CLI::App& app, Request& request) {
  declare_threads(app, request);
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
  app.add_option_function<std::vector<std::string>>(
         "--profile",
         [&request](const std::vector<std::string>& names) {
           request.sources.profiles.clear();
           for (const std::string& name : names)
             request.sources.profiles.push_back(find_profile(name, profile_folder()));
         },
         "film, printer, process: values for many jobs; a file, or the name of a profile that "
         "'hydrodip profile' keeps")
      ->group(kConfigGroup)
      ->type_name("NAME|FILE.toml")
      ->allow_extra_args(false);
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
                 "image of the whole sheet, finished: predicts what it leaves on the object, and "
                 "'print' prints it as it is")
      ->group(kFilmGroup)
      ->type_name("IMG");
}

void declare_pattern(CLI::App& app, Request& request) {
  constexpr const char* kPatternGroup = "Pattern";
  PatternRequest& pattern = request.pattern;
  app.add_option("--tile", pattern.tile,
                 "picture that is repeated over the film: PNG, JPEG, SVG, ...")
      ->group(kPatternGroup)
      ->type_name("IMG");
  app.add_option("--tile-mm", pattern.tile_mm,
                 "its width on the film, as bought pattern film has it")
      ->group(kPatternGroup)
      ->type_name("MM")
      ->check(between(0.01, 10000));
  app.add_flag("--compensate", pattern.compensate,
               "draw the pattern so that it looks unstretched on the part")
      ->group(kPatternGroup);
  app.add_option_function<std::vector<std::string>>(
         "--keep",
         [&pattern](const std::vector<std::string>& spots) {
           for (const std::string& spot : spots) {
             const std::vector<double> n = numbers_of("--keep", spot, 3, 4);
             pattern.spots.push_back({Vec3(n[0], n[1], n[2]), n.size() > 3 ? n[3] : 10});
           }
         },
         "a spot of the model to keep free of detail and seams, and its radius (default: 10)")
      ->group(kPatternGroup)
      ->type_name("X,Y,Z[,R]")
      ->allow_extra_args(false);
  app.add_option_function<std::string>(
         "--tile-at",
         [&pattern](const std::string& text) {
           const std::vector<double> n = numbers_of("--tile-at", text, 2, 2);
           pattern.shift_mm = Vec2(n[0], n[1]);
         },
         "a tile's centre on the film, from its middle (default: where it does least harm)")
      ->group(kPatternGroup)
      ->type_name("X,Y");
  app.add_option_function<double>(
         "--tile-turn", [&pattern](const double& turn) { pattern.turn_deg = turn; },
         "turn of the pattern, counter-clockwise from above (default: as it does least harm)")
      ->group(kPatternGroup)
      ->type_name("DEG")
      ->check(between(-360, 360));
}

void declare_nest(CLI::App& app, Request& request) {
  app.add_option(
         "PART", request.jobs,
         "models or jobs, once for each copy; or [[part]] tables (job, count) in a --config")
      ->type_name("");
  app.add_option("--clearance", request.clearance_mm,
                 "free film around each part (default: as much as the sheet has room for)")
      ->group(kFilmGroup)
      ->type_name("MM")
      ->check(between(0, 500));
}

void declare_sample(CLI::App& app, Request& request) {
  app.add_option("NAME", request.sample, "which sample; without it: lists them")->type_name("");
}

void declare_folder(CLI::App& app, Request& request) {
  app.add_option("DIR", request.folder, "output folder of a job, or its report.html")
      ->type_name("");
}

void declare_studio(CLI::App& app, Request& request) {
  constexpr const char* kStudioGroup = "Studio";
  StudioOptions& studio = request.studio;
  app.add_option("MODEL", request.model, "model, or a job's TOML, to begin with")->type_name("");
  app.add_flag_callback(
         "--no-browser", [&studio] { studio.browser = false; },
         "open no browser: only print the address")
      ->group(kStudioGroup);
  app.add_option("--port", studio.port, "default: 4714, or the next that is free")
      ->group(kStudioGroup)
      ->type_name("PORT")
      ->check(CLI::Range(1, 65535).description(""));
  app.add_option("--listen", studio.address,
                 "address to serve from, for other machines; needs a password (default: this "
                 "machine alone)")
      ->group(kStudioGroup)
      ->type_name("ADDRESS");
  app.add_option("--password-file", studio.password_file,
                 "file whose first line is asked for in the browser")
      ->group(kStudioGroup)
      ->type_name("FILE");
}

JobConfig configure(const Request& request, const RunContext& context) {
  const RunScope scope(context);
  SettingSources sources = request.sources;
  if (!request.film_state.empty()) sources.profiles.push_back(request.film_state);
  JobConfig config = configured(request.model, std::move(sources));
  config.film_image = request.film_image;
  config.output = request.output;
  config.command_line = request.command_line;
  return config;
}

JobConfig configure_part(const Request& request, const std::string& model,
                         const RunContext& context) {
  Request part = request;
  part.model = model;
  return configure(part, context);
}

RigJob configure_printed(const Request& request, const std::string& folder,
                         const RunContext& context) {
  const RunScope scope(context);
  return load_rig_job(folder, request.sources);
}

}  // namespace hydrodip
