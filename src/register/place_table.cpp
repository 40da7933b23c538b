#include "register/place_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/run_scope.h"
#include "base/small_file.h"
#include "base/table_rows.h"
#include "base/unicode.h"
#include "model_io/model_file.h"
#include "model_io/text.h"

namespace hydrodip {
namespace {

constexpr const char* kHeader = "film_x_mm,film_y_mm,x,y,z";
constexpr double kFarthest_mm = 1e5;
constexpr std::size_t kLongestHeader = 1000;
constexpr std::size_t kMostRows = 1000000;
constexpr std::uintmax_t kLargestFile = 256 << 20;

}  // namespace

bool is_place_table(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  std::ifstream in(file, std::ios::binary);
  // No line of another kind of file is read to an end that may be far.
  std::vector<std::uint8_t> start(kLongestHeader);
  in.read(reinterpret_cast<char*>(start.data()), std::streamsize(start.size()));
  start.resize(std::size_t(std::max<std::streamsize>(in.gcount(), 0)));
  start = in_utf8(std::move(start));
  TableRows rows(text_of(start));
  // One of its columns tells it from a table of corners, also where others are misspelt.
  return rows.next() && std::ranges::any_of(rows.cells(), [](const std::string& cell) {
           return cell.starts_with("film_");
         });
}

std::vector<PlaceRow> read_place_table(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes =
      in_utf8(read_small_file(file, kLargestFile, "a table of places"));
  TableRows table(text_of(bytes));
  if (!table.next() || !table.is(kHeader))
    throw InputError(
        fmt::format("{}: a table of places begins with the line {}", file.string(), kHeader));
  std::vector<PlaceRow> rows;
  while (table.next()) {
    check_cancelled();
    const std::vector<std::string>& cells = table.cells();
    std::array<double, 5> value{};
    bool good = cells.size() == value.size();
    for (std::size_t k = 0; good && k < value.size(); ++k)
      good = parse_number(cells[k], value[k]) && std::abs(value[k]) <= kFarthest_mm;
    if (!good)
      throw InputError(
          fmt::format("{}:{}: needs five numbers: {}", file.string(), table.line(), kHeader));
    if (rows.size() == kMostRows)
      throw InputError(fmt::format("{}: has more than {} places; measured places are fewer",
                                   file.string(), kMostRows));
    rows.push_back({{value[0], value[1]}, {value[2], value[3], value[4]}});
  }
  if (rows.empty())
    throw InputError(fmt::format("{}: has its header and no place: one row for each, {}",
                                 file.string(), kHeader));
  return rows;
}

}  // namespace hydrodip
