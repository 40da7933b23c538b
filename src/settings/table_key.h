// The name of a value in one of several tables: "dip[2].depth_mm".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hydrodip {

struct TableKey {
  std::size_t number = 0;  // from 1
  std::string key;
};

// `table`: "dip", say. Nothing for any other name.
std::optional<TableKey> table_key(std::string_view table, std::string_view name);

}  // namespace hydrodip
