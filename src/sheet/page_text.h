// What of a text can be put on a page, and how letters are drawn that the PDF fonts lack.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "artwork/drawing.h"
#include "base/context.h"

namespace hydrodip {

struct PageText {
  // Tidy UTF-8 (winansi.h). Letters that neither the PDF fonts nor this machine's have are
  // replaced: by plain ones, where only their accents are missing, else by '?'.
  std::string shown;
  std::vector<std::string> lost;  // those, each once
};
PageText page_text(const std::string& utf8);

// Says so, and how to mend it, where letters of `what` are replaced in the file.
void warn_of_lost_letters(const std::string& what, const std::string& utf8, const std::string& file,
                          const RunContext& context);

// Letters of this machine's fonts in the manner of the PDF fonts. Nothing if all are blanks.
std::optional<DrawnLine> set_line(const std::string& shown, bool bold);

}  // namespace hydrodip
