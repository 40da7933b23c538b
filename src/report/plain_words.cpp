#include "report/plain_words.h"

#include <regex>
#include <utility>
#include <vector>

namespace hydrodip {

std::string in_plain_words(const std::string& sentence) {
  // From the first to the last: what stands in brackets goes, what is part of a sentence gets a
  // word.
  static const std::vector<std::pair<std::regex, std::string>> kRules = [] {
    std::vector<std::pair<std::regex, std::string>> rules;
    const auto add = [&](const char* pattern, const char* words) {
      rules.emplace_back(std::regex(pattern), words);
    };
    add(R"( \((--|[a-z]+\.[a-z_]+)[^()]*\))", "");
    add(R"( \([a-z_., ]*--[^()]*\))", "");
    add(R"( with --set [a-z_.]+=\S+)", "");
    add(R"(with --size ([0-9.]+) or less)", "to $1 mm or less");
    add(R"(with --size ([0-9.]+) and --depth ([0-9.]+))", "to $1 mm and dip $2 mm of it");
    add(R"( with --(size|rotate|down|texture|film|depth|units)( or --(rotate|down|depth))?)", "");
    add(R"( with --art IMG)", "");
    add(R"(--dpi)", "the resolution");
    add(R"(--depth)", "the depth");
    add(R"(--size)", "the size");
    add(R"(--film\b)", "sheet of film");
    add(R"(--(rotate|down))", "the side that goes down");
    add(R"(--units \([^()]*\))", "unit");
    add(R"(--units)", "unit");
    add(R"(--texture)", "the texture");
    add(R"(film\.elements)", "the number of film triangles");
    add(R"(print\.dpi)", "the resolution");
    add(R"(ink\.rounds_max)", "the number of rounds");
    add(R"(: 'hydrodip plan' (looks for ways|says how much each one adds))", "");
    add(R"( \('hydrodip plan' with --dips [0-9]+ looks for them\))", "");
    add(R"(; gamut\.policy chooses how)", "");
    add(R"(dip\.tilt_deg and dip\.roll_deg)", "tilt and roll");
    add(R"((or )?try --threads 1)", "close other programs");
    return rules;
  }();
  std::string text = sentence;
  for (const auto& [pattern, words] : kRules) text = std::regex_replace(text, pattern, words);
  return text;
}

}  // namespace hydrodip
