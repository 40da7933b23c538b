#include "base/json_nesting.h"

#include <algorithm>

namespace hydrodip {

bool JsonNesting::take(char c) {
  if (quoted_) {
    quoted_ = escaped_ || c != '"';
    escaped_ = !escaped_ && c == '\\';
    return true;
  }
  quoted_ = c == '"';
  if (c == '[' || c == '{') ++depth_;
  if (c == ']' || c == '}') --depth_;
  return depth_ <= deepest_;
}

bool nests_too_deeply(std::string_view json) {
  JsonNesting nesting(100);
  return !std::all_of(json.begin(), json.end(), [&](char c) { return nesting.take(c); });
}

}  // namespace hydrodip
