// A person's own profiles: TOML files in one folder, each known by its file's name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "settings/settings.h"

namespace hydrodip {

// FOLDER/NAME.toml. Throws InputError unless the name is made of letters, digits, '-', '_' and '.'
// and does not begin with a dot.
std::filesystem::path profile_path(const std::filesystem::path& folder, const std::string& name);

// What the folder holds, in order of names; nothing if there is no such folder.
std::vector<std::string> profile_names(const std::filesystem::path& folder);

// The file behind what was given to --profile: a path ("shop.toml", "./shop"), or the name of one
// of the folder's. Throws InputError, with the nearest known name, if it is neither.
std::filesystem::path find_profile(const std::string& name_or_file,
                                   const std::filesystem::path& folder);

// Values and what they replace.
struct ProfileEdit {
  SettingSources add;               // later ones win, as everywhere
  std::vector<std::string> remove;  // names of parameters
};

// The text of a profile that has the values of `before` (may be empty: nothing) and the edit's.
// Throws InputError for unknown names, for values out of range, and for what belongs to one job:
// its model, artwork, dips and ways in.
std::string edited_profile(const std::filesystem::path& before, const ProfileEdit& edit);

// Names of the parameters that a profile sets. Throws as read_settings, and InputError for what no
// profile may hold.
std::vector<std::string> names_in_profile(const std::filesystem::path& file);

}  // namespace hydrodip
