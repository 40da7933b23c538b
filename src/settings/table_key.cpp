#include "settings/table_key.h"

#include <charconv>

namespace hydrodip {

std::optional<TableKey> table_key(std::string_view table, std::string_view name) {
  if (!name.starts_with(table) || !name.substr(table.size()).starts_with('[')) return {};
  const std::string_view rest = name.substr(table.size() + 1);
  const std::size_t end = rest.find("].");
  if (end == std::string_view::npos) return {};
  TableKey key;
  const auto [stop, error] = std::from_chars(rest.data(), rest.data() + end, key.number);
  if (error != std::errc() || stop != rest.data() + end || key.number == 0) return {};
  key.key = rest.substr(end + 2);
  return key;
}

}  // namespace hydrodip
