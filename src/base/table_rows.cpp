#include "base/table_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"

namespace hydrodip {
namespace {

// With blanks for whatever separated its cells.
std::string with_blanks(std::string_view line) {
  const bool commas_are_decimal = line.find_first_of(";\t") != std::string_view::npos;
  const auto is_digit = [&](std::size_t at) {
    return at < line.size() && line[at] >= '0' && line[at] <= '9';
  };
  std::string text(line);
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == ',')
      text[i] = commas_are_decimal && is_digit(i - 1) && is_digit(i + 1) ? '.' : ' ';
    else if (line[i] == ';' || line[i] == '"')
      text[i] = ' ';
  }
  return text;
}

}  // namespace

TableRows::TableRows(std::string_view text) : rest_(without_bom(text)) {}

bool TableRows::next() {
  while (!rest_.empty()) {
    const std::string line = with_blanks(take_line(rest_));
    ++line_;
    cells_.clear();
    std::string_view words = line;
    for (std::string_view word = take_word(words); !word.empty(); word = take_word(words))
      cells_.emplace_back(word);
    if (!cells_.empty() && cells_.front().front() != '#') return true;
  }
  return false;
}

bool TableRows::is(std::string_view header) const {
  return fmt::format("{}", fmt::join(cells_, ",")) == header;
}

}  // namespace hydrodip
