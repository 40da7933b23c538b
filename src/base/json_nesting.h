// What JSON from strangers must not do to who copies or prints it.
#pragma once

#include <string_view>

namespace hydrodip {

// Whether lists and objects lie in each other more than a hundred deep: parsed values are copied
// and printed by recursion, and a file of nothing but "[" must not exhaust the stack.
bool nests_too_deeply(std::string_view json);

}  // namespace hydrodip
