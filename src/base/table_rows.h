// Tables as text, however people write them and spreadsheets save them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hydrodip {

// Row by row, without what is blank or a comment (#). Cells stand between commas, semicolons, tabs
// or blanks, in quotation marks or without. Where semicolons or tabs separate, a comma between
// digits is a decimal one, as in German, and comes as a point.
class TableRows {
 public:
  // The text, in UTF-8 with or without its byte order mark, has to outlive this.
  explicit TableRows(std::string_view text);

  bool next();                                                      // false: there are no more
  const std::vector<std::string>& cells() const { return cells_; }  // one at least
  // Whether the cells are those, written with commas between.
  bool is(std::string_view header) const;
  std::size_t line() const { return line_; }  // from 1

 private:
  std::string_view rest_;
  std::vector<std::string> cells_;
  std::size_t line_ = 0;
};

}  // namespace hydrodip
