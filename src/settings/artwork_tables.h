// Layers of artwork among a job's settings: [[artwork]] tables, "artwork[2].size_mm", and the
// options of one layer, "art.size_mm".
#pragma once

#include <string>
#include <vector>

#include "settings/params.h"

namespace hydrodip {

inline constexpr std::size_t kMostLayers = 64;

// Applies a setting whose name begins with "artwork[NUMBER]." (a layer that is made if it is the
// next one) or "art." (the topmost layer). False: it is none of these. Throws InputError naming
// setting, value, what it has to be, and origin.
bool apply_artwork_setting(JobConfig& config, const Setting& setting);

// Whether its text is a file's name, to be taken relative to the file that says so.
bool is_artwork_path(const std::string& name);
// Whether it may be true or false.
bool is_artwork_switch(const std::string& name);

// What can be said of a layer, for help and reports.
struct LayerKey {
  std::string name;  // "size_mm"
  std::string unit;
  std::string range;  // what it has to be
  std::string help;   // one line
  // How files have its value.
  enum class Kind { kPath, kText, kFlag, kNumbers };
  Kind kind = Kind::kText;
};
const std::vector<LayerKey>& layer_keys();

// A layer's values as they would be written, in the order of the keys; "" where nothing is said.
std::vector<std::string> layer_values(const ArtworkLayer& layer);

}  // namespace hydrodip
