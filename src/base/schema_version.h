// Files that another version of the program may have written.
#pragma once

#include <fmt/format.h>

#include <filesystem>

#include "base/error.h"

namespace hydrodip {

// Of nlohmann's kinds of values. Throws InputError for a file, an object, that says it is of a
// later schema than `newest`: its values may mean something else. One that says nothing passes.
// `what`: "this report".
template <class Json>
void require_known_schema(const Json& file, int newest, const std::filesystem::path& name,
                          const char* what) {
  if (!file.is_object() || !file.contains("schema_version")) return;
  const Json& version = file["schema_version"];
  if (version.is_number() && version.template get<double>() <= newest) return;
  throw InputError(
      fmt::format("{}: a newer hydrodip wrote {}; it is needed to read it", name.string(), what));
}

}  // namespace hydrodip
