// What JSON from strangers must not do to who copies or prints it: parsed values are copied and
// printed by recursion, and a file of nothing but "[" must not exhaust the stack.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace hydrodip {

// Counts along a text how many lists and objects lie in each other.
class JsonNesting {
 public:
  explicit JsonNesting(int deepest) : deepest_(deepest) {}
  // False while more of them are open than may be.
  bool take(char c);

 private:
  int deepest_, depth_ = 0;
  bool quoted_ = false, escaped_ = false;
};

// Whether lists and objects lie in each other more than a hundred deep.
bool nests_too_deeply(std::string_view json);

// Of nlohmann's kinds of values: what the text says, or a discarded value if it is no JSON or nests
// too deeply.
template <class Json>
Json parsed_json(std::string_view text) {
  return nests_too_deeply(text) ? Json(Json::value_t::discarded)
                                : Json::parse(text, nullptr, false);
}
template <class Json>
Json parsed_json(const std::vector<std::uint8_t>& bytes) {
  return parsed_json<Json>(
      std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace hydrodip
