#include "base/parse_double.h"

#include <locale.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <string>
#if defined(__APPLE__)
#include <xlocale.h>
#endif

namespace hydrodip {
namespace {

#if defined(_WIN32)
double strtod_of_c_locale(const char* text, char** end) {
  static const _locale_t c_locale = _create_locale(LC_ALL, "C");
  return _strtod_l(text, end, c_locale);
}
#else
double strtod_of_c_locale(const char* text, char** end) {
  static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);
  return strtod_l(text, end, c_locale);
}
#endif

bool is_digit(const char* at, const char* last) { return at != last && *at >= '0' && *at <= '9'; }

// The end of "1", "-1.5", ".5e-3", "inf", "nan" at the beginning of the text; `first` if there is
// none. strtod would take blanks, a plus and hexadecimal digits as well.
const char* end_of_number(const char* first, const char* last) {
  const char* at = first;
  if (at != last && *at == '-') ++at;
  for (const std::string word : {"infinity", "inf", "nan"}) {
    std::string there(at, at + std::min<std::ptrdiff_t>(last - at, std::ptrdiff_t(word.size())));
    for (char& c : there)
      if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    if (there == word) return at + word.size();
  }
  const char* const digits = at;
  while (is_digit(at, last)) ++at;
  bool any = at != digits;
  if (at != last && *at == '.') {
    const char* const fraction = at + 1;
    const char* end = fraction;
    while (is_digit(end, last)) ++end;
    if (any || end != fraction) at = end;
    any = any || end != fraction;
  }
  if (!any) return first;
  if (at != last && (*at == 'e' || *at == 'E')) {
    const char* exponent = at + 1;
    if (exponent != last && (*exponent == '-' || *exponent == '+')) ++exponent;
    if (is_digit(exponent, last)) {
      while (is_digit(exponent, last)) ++exponent;
      at = exponent;
    }
  }
  return at;
}

}  // namespace

std::from_chars_result parse_double_by_strtod(const char* first, const char* last, double& value) {
  const char* const end = end_of_number(first, last);
  if (end == first) return {first, std::errc::invalid_argument};
  const std::string text(first, end);
  const double parsed = strtod_of_c_locale(text.c_str(), nullptr);
  const bool finite_text = text.find_first_of("nN") == std::string::npos;
  const bool has_digit = text.find_first_of("123456789") < text.find_first_of("eE");
  if (finite_text && (!std::isfinite(parsed) || (parsed == 0 && has_digit)))
    return {end, std::errc::result_out_of_range};
  value = parsed;
  return {end, std::errc()};
}

}  // namespace hydrodip
