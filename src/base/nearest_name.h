// Near misses: which known name a misspelt one was meant to be.
#pragma once

#include <string>
#include <vector>

namespace hydrodip {

// The known name that takes the fewest edits (insert, delete, replace, swap neighbours; case is
// ignored), or "" when none is close enough to be what was meant. A known "group.name" is also
// found by its last part, and each without its unit, under another group and with a word before it
// ("depth", "bath.depth", "my_depth" for "dip.depth_mm"). Ties go to the earlier one.
std::string nearest_name(const std::string& name, const std::vector<std::string>& known);

// "; did you mean 'film.elements'?" or "" when nothing is near.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

}  // namespace hydrodip
