#include "settings/refuse_value.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/parse_double.h"

namespace hydrodip {
namespace {

// "12" in a file, where 12 is meant: it must be a number, and looks like one.
bool is_quoted_number(const Setting& setting) {
  const auto* text = std::get_if<std::string>(&setting.value);
  if (!text || !setting.typed) return false;
  double ignored = 0;
  const char* end = text->data() + text->size();
  const auto [rest, error] = parse_double(text->data(), end, ignored);
  return error == std::errc() && rest == end;
}

}  // namespace

void refuse_value(const Setting& setting, Wanted wanted, const std::string& expected) {
  const bool quoted = wanted == Wanted::kNumber && is_quoted_number(setting);
  throw InputError(fmt::format("{}: {} must be {}, not {}{}", setting.origin, told_name(setting),
                               expected, setting.shown.empty() ? "empty" : setting.shown,
                               quoted ? ", which is text: leave out its quotation marks" : ""));
}

}  // namespace hydrodip
