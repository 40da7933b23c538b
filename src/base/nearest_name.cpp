#include "base/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace hydrodip {
namespace {

// Names longer than this are not typing errors; it also bounds the work.
constexpr std::size_t kLongestName = 64;
// Fewer letters begin too many names.
constexpr std::size_t kLeastOfName = 4;

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Optimal string alignment distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = d[i - 1][j - 1] + (a[i - 1] != b[j - 1] ? 1 : 0);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string last_part(const std::string& name) { return name.substr(name.rfind('.') + 1); }

// "depth" of "depth_mm".
std::string without_unit(const std::string& name) {
  for (const char* unit : {"_mm_per_min", "_mm", "_mm2", "_deg", "_px", "_s", "_h", "_c", "_g"})
    if (name.size() > std::string_view(unit).size() && name.ends_with(unit))
      return name.substr(0, name.size() - std::string_view(unit).size());
  return name;
}

// In half edits: 1 for one name with another unit or none, a little more if its group differs, too.
std::size_t distance_between(const std::string& wanted, const std::string& candidate) {
  std::size_t distance = 2 * edit_distance(wanted, candidate);
  const bool grouped = wanted.find('.') != std::string::npos;
  const std::string last = last_part(candidate);
  if (!grouped && candidate.find('.') != std::string::npos)
    distance = std::min(distance, 2 * edit_distance(wanted, last));
  // Cut short, as in 'depth' for 'depth_mm'.
  if (wanted.size() >= kLeastOfName && (candidate.starts_with(wanted) || last.starts_with(wanted)))
    distance = std::min<std::size_t>(distance, 2);
  const std::string bare = without_unit(last_part(wanted)), core = without_unit(last);
  if (bare == core && core.size() >= kLeastOfName)
    distance = std::min<std::size_t>(
        distance,
        !grouped || candidate.starts_with(wanted.substr(0, wanted.rfind('.') + 1)) ? 1 : 2);
  // With a word before it, as in 'art_size' for 'size_mm'.
  if (core.size() >= kLeastOfName && bare.ends_with("_" + core))
    distance = std::min<std::size_t>(distance, 2);
  return distance;
}

}  // namespace

std::string nearest_name(const std::string& name, const std::vector<std::string>& known) {
  if (name.empty() || name.size() > kLongestName) return "";
  const std::string wanted = lower(name);
  std::string best;
  std::size_t best_distance = 2 * (1 + std::max<std::size_t>(1, wanted.size() / 3));
  for (const std::string& candidate : known) {
    const std::size_t distance = distance_between(wanted, lower(candidate));
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

}  // namespace hydrodip
