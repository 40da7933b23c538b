// Where parameter values come from: TOML files and the command line's options.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "settings/params.h"

namespace hydrodip {

// Every value of a TOML file, nested tables ([film] width_mm = 210) or dotted keys alike, in the
// file's order of lines. A relative kPath value is taken relative to the file's folder. Throws
// InputError with file, line and column for broken TOML, unknown names, or values that no parameter
// can have (dates, tables of tables).
std::vector<Setting> read_settings(const std::filesystem::path& file);

// A TOML file that is no configuration, as the text of a JSON object: for what has a shape of its
// own. Throws InputError with file, line and column for broken TOML.
std::string toml_as_json(const std::filesystem::path& file);

// "film.elements=4000" as given to --set.
Setting parse_set(const std::string& text);

// "a4", "letter", "a3", with "-landscape", or "WxH" in mm: the settings of film.width_mm and
// film.height_mm.
std::vector<Setting> film_settings(const std::string& film);

// Sheets that people can buy, by name; upright.
struct FilmFormat {
  std::string name;
  double width_mm;
  double height_mm;
};
const std::vector<FilmFormat>& film_formats();

// What --quality stands for: draft (to look at while turning the object), normal (the defaults) or
// fine. docs/performance.md has the errors and times of each.
std::vector<Setting> quality_settings(const std::string& quality);

// What the command line said about parameters, in rising precedence.
struct SettingSources {
  std::vector<Setting> quality;                 // --quality
  std::vector<std::filesystem::path> profiles;  // --profile, in order
  std::vector<std::filesystem::path> configs;   // --config, in order
  std::vector<Setting> options;                 // --size, --film, ...
  std::vector<Setting> sets;                    // --set
};

// Defaults < quality < profiles < configs < options < sets; settled.
void apply_sources(JobConfig& config, const SettingSources& sources);

// What follows from everything that was `given`, once it is applied: a named profile of inks is
// used, the paper's film is a regular grid, film.correction is read. Throws InputError for values
// that do not go together.
void settle(JobConfig& config, const std::vector<Setting>& given);

// A job's configuration: `model` is a model's file, or a job's (.toml) that names one; where it is
// empty, what the sources name. Throws InputError.
JobConfig configured(const std::string& model, SettingSources sources);

}  // namespace hydrodip
