#include "settings/settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/shell_word.h"
#include "settings/correction_file.h"

namespace hydrodip {
namespace {

constexpr const char* kLandscape = "-landscape";

std::string without_suffix(const std::string& text, const std::string& suffix) {
  if (text.size() < suffix.size() || !text.ends_with(suffix)) return text;
  return text.substr(0, text.size() - suffix.size());
}

Setting option_setting(const std::string& name, const std::string& value,
                       const std::string& shown) {
  return {name, value, false, shown, "--film"};
}

// nullptr: left at its default.
const Setting* last_given(const std::vector<Setting>& given, const std::string& name) {
  const auto last = std::find_if(given.rbegin(), given.rend(),
                                 [&name](const Setting& setting) { return setting.name == name; });
  return last == given.rend() ? nullptr : &*last;
}

// The paper's film is a regular grid.
void settle_grading(JobConfig& config, const std::vector<Setting>& given) {
  if (config.design.dip.scheme == DipScheme::kPaper && !last_given(given, "film.grading"))
    config.design.film.grading = 1;
}

// A profile that was named is to be used.
void settle_ink_model(JobConfig& config, const std::vector<Setting>& given) {
  if (config.printer.profile.empty()) return;
  const Setting* told = last_given(given, "ink.model");
  if (!told)
    config.printer.model = InkModel::kProfile;
  else if (config.printer.model == InkModel::kDevice)
    throw InputError(fmt::format(
        "{}: ink.model=device takes no profile, and {} is one: leave out ink.model or the profile",
        told->origin, config.printer.profile.string()));
}

void require_order(const char* from, const char* to, double least, double most) {
  if (least > most)
    throw InputError(fmt::format("{} ({:g}) must not be above {} ({:g})", from, least, to, most));
}

void require_order(const ProcessOptions& process) {
  require_order("process.water_min_c", "process.water_max_c", process.water_min_c,
                process.water_max_c);
  require_order("process.soak_min_s", "process.soak_max_s", process.soak_min_s, process.soak_max_s);
  require_order("process.dry_min_h", "process.dry_max_h", process.dry_min_h, process.dry_max_h);
}

void require_order(const FilmMaterial& material) {
  if (material.safe_stretch > material.lost_stretch)
    throw InputError(fmt::format(
        "material.safe_stretch ({:g}), up to which film surely holds, must not be above "
        "material.lost_stretch ({:g}), from which on none does",
        material.safe_stretch, material.lost_stretch));
}

}  // namespace

Setting parse_set(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(
        fmt::format("--set: write NAME=VALUE, as in film.elements=40000, not '{}'", text));
  const std::string value = text.substr(equals + 1);
  return {text.substr(0, equals), value, false, "'" + value + "'", "--set"};
}

const std::vector<FilmFormat>& film_formats() {
  static const std::vector<FilmFormat> formats = {
      {"letter", 215.9, 279.4}, {"a4", 210, 297}, {"a3", 297, 420}};
  return formats;
}

std::vector<Setting> film_settings(const std::string& film) {
  const std::string name = without_suffix(film, kLandscape);
  const bool landscape = name != film;
  for (const FilmFormat& format : film_formats()) {
    if (format.name != name) continue;
    std::string width = fmt::format("{}", format.width_mm);
    std::string height = fmt::format("{}", format.height_mm);
    if (landscape) std::swap(width, height);
    return {option_setting("film.width_mm", width, film),
            option_setting("film.height_mm", height, film)};
  }
  const std::size_t cross = name.find('x');
  const bool starts_like_a_size =
      !film.empty() && (film[0] == '-' || (film[0] >= '0' && film[0] <= '9'));
  if (cross == std::string::npos || !starts_like_a_size) {
    std::vector<std::string> names;
    for (const FilmFormat& format : film_formats()) {
      names.push_back(format.name);
      names.push_back(format.name + kLandscape);
    }
    throw InputError(fmt::format(
        "--film: '{}' is neither letter, a4, a3 (or -landscape) nor WxH in mm, as in 200x150{}",
        film, did_you_mean(film, names)));
  }
  std::string width = name.substr(0, cross), height = name.substr(cross + 1);
  if (landscape) std::swap(width, height);
  return {option_setting("film.width_mm", width, "'" + width + "'"),
          option_setting("film.height_mm", height, "'" + height + "'")};
}

std::vector<Setting> quality_settings(const std::string& quality) {
  const auto settings = [](std::initializer_list<std::pair<const char*, std::string>> values) {
    std::vector<Setting> list;
    for (const auto& [name, value] : values)
      list.push_back({name, value, false, value, "--quality"});
    return list;
  };
  if (quality == "draft")
    return settings({{"film.elements", fmt::format("{}", kDraftElements)},
                     {"dip.step_mm", fmt::format("{:.1f}", kDraftStep_mm)},
                     {"dip.air_cells", fmt::format("{}", kDraftAirCells)},
                     {"ink.rounds_max", "1"},
                     {"plan.suggest", "off"},
                     {"preview.texture_px", "512"},
                     {"preview.pictures", "off"}});
  if (quality == "normal") return {};
  if (quality == "fine") return settings({{"film.elements", "160000"}, {"dip.step_mm", "0.05"}});
  throw InputError(fmt::format("--quality: '{}' is none of draft, normal, fine{}", quality,
                               did_you_mean(quality, {"draft", "normal", "fine"})));
}

namespace {

// A file that has tables of one kind has all of them: fields of an earlier file's would mix with
// its own.
void forget_tables_before(JobConfig& config, const std::vector<Setting>& file) {
  const auto has = [&](const char* table) {
    return std::any_of(file.begin(), file.end(),
                       [&](const Setting& s) { return s.name.starts_with(table); });
  };
  if (has("artwork[")) config.object.artwork.clear();
  if (has("part[")) config.parts.clear();
  if (has("dip[")) config.dips.clear();
}

// The files that ways into the water came from are in the configuration as rows only.
void keep_path_files(JobConfig& config, const std::vector<Setting>& all) {
  const auto keep = [&](const std::string& name, const std::vector<Keyframe>& path) {
    const Setting* last = last_given(all, name);
    const auto* text = last ? std::get_if<std::string>(&last->value) : nullptr;
    if (!path.empty() && text && text->find(';') == std::string::npos)
      config.settings_files.emplace_back(*text);
  };
  keep("path", config.design.trajectory.path);
  for (std::size_t k = 0; k < config.dips.size(); ++k)
    keep(fmt::format("dip[{}].path", k + 1), config.dips[k].path);
}

// All that they said, in order.
std::vector<Setting> applied(JobConfig& config, const SettingSources& sources) {
  std::vector<Setting> all;
  const auto add = [&](const std::vector<Setting>& settings) {
    apply_settings(config, settings);
    all.insert(all.end(), settings.begin(), settings.end());
  };
  add(sources.quality);
  for (const auto* files : {&sources.profiles, &sources.configs})
    for (const auto& file : *files) {
      const std::vector<Setting> settings = read_settings(file);
      forget_tables_before(config, settings);
      add(settings);
      config.settings_files.push_back(file);
    }
  // Options speak of a layer of their own, above those of files, if they give it a picture.
  const bool own_layer =
      std::any_of(sources.options.begin(), sources.options.end(), [](const Setting& setting) {
        return setting.name == "art.image" || setting.name == "art.text";
      });
  if (own_layer) config.object.artwork.emplace_back();
  add(sources.options);
  add(sources.sets);
  settle(config, all);
  keep_path_files(config, all);
  return all;
}

}  // namespace

void apply_sources(JobConfig& config, const SettingSources& sources) { applied(config, sources); }

void settle(JobConfig& config, const std::vector<Setting>& given) {
  settle_grading(config, given);
  settle_ink_model(config, given);
  require_order(config.design.dip.material);
  require_order(config.process);
  if (!config.correction.empty())
    config.design.film.correction = read_correction_field(config.correction);
}

namespace {

// A table says for its dip what these say for the only one; of the two one would be passed over.
void require_dips_alone_say(const JobConfig& config, const SettingSources& sources) {
  if (config.dips.empty()) return;
  for (const auto* settings : {&sources.options, &sources.sets})
    for (const Setting& s : *settings)
      if (s.name == "object.rotate_deg" || s.name == "object.down" || s.name == "dip.depth_mm" ||
          s.name == "path")
        throw InputError(fmt::format(
            "{}: this job's [[dip]] tables say how it is held and how deep it goes; change it "
            "there, or take the tables away",
            s.origin == "--set" ? "--set " + s.name : s.origin));
}

// One depth for dips of which each has its own would be passed over. What a file says of others, as
// a profile does, may stand beside dips that all say theirs.
void require_no_common_depth(const JobConfig& config, const std::vector<Setting>& all) {
  const Setting* last = last_given(all, "dip.depth_mm");
  if (!last || config.plan.find_depth || (config.dips.empty() && config.plan.dips < 2)) return;
  const bool is_planned = config.plan.dips > int(config.dips.size());
  if (last->typed && !is_planned && std::ranges::all_of(config.dips, [](const DipEntry& dip) {
        return dip.depth_mm.has_value() || !dip.path.empty();
      }))
    return;
  throw InputError(fmt::format(
      "{}{}: each of several dips has a depth of its own: write it into their [[dip]] tables "
      "(depth_mm), or leave this out, and it is looked for",
      last->origin,
      last->typed               ? ": " + told_name(*last)
      : last->origin == "--set" ? " " + last->name
                                : ""));
}

// Of a path and a depth beside it one would be passed over.
void require_one_way_down(const JobConfig& config, const std::string& model) {
  const bool has_path = !config.design.trajectory.path.empty();
  for (std::size_t k = 0; k < config.dips.size(); ++k)
    if (config.dips[k].depth_mm && (has_path || !config.dips[k].path.empty()))
      throw InputError(fmt::format(
          "{}: [[dip]] {}: a path says all of the way in: leave out depth_mm, or the path",
          model.empty() ? "this job" : model, k + 1));
}

// Parts share a sheet; the job of one object would pass them over.
void require_no_parts(const std::filesystem::path& job) {
  for (const Setting& s : read_settings(job))
    if (s.name.starts_with("part["))
      throw InputError(fmt::format(
          "{}: [[part]] tables share a sheet among jobs; to print it: hydrodip nest --config {}",
          s.origin, shell_word(job.string())));
}

}  // namespace

JobConfig configured(const std::string& model, SettingSources sources) {
  JobConfig config;
  const bool is_job = std::filesystem::path(model).extension() == ".toml";
  if (is_job) sources.configs.insert(sources.configs.begin(), model);
  const std::vector<Setting> all = applied(config, sources);
  require_dips_alone_say(config, sources);
  require_no_common_depth(config, all);
  require_one_way_down(config, model);
  if (!is_job && !model.empty()) config.model = model;
  if (is_job) require_no_parts(model);
  if (is_job && config.model.empty())
    throw InputError(fmt::format(
        "{}: the job names no model: begin it with file = \"MODEL\" under [object]", model));
  return config;
}

}  // namespace hydrodip
