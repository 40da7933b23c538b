#include "register/place_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "base/error.h"
#include "base/parse_double.h"
#include "base/run_scope.h"

namespace hydrodip {
namespace {

constexpr const char* kHeader = "film_x_mm,film_y_mm,x,y,z";
constexpr double kFarthest_mm = 1e5;
constexpr std::size_t kLongestHeader = 1000;
constexpr std::size_t kMostRows = 1000000;

std::string line_of(std::istream& file, bool& any) {
  std::string line;
  any = bool(std::getline(file, line));
  if (line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  return line;
}

}  // namespace

bool is_place_table(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  std::ifstream in(file);
  // No line of another kind of file is read to an end that may be far.
  std::string start(kLongestHeader, '\0');
  in.read(start.data(), std::streamsize(start.size()));
  start.resize(std::size_t(std::max<std::streamsize>(in.gcount(), 0)));
  std::istringstream lines(start);
  bool any = false;
  return line_of(lines, any) == kHeader;
}

std::vector<PlaceRow> read_place_table(const std::filesystem::path& file) {
  std::ifstream in(file);
  bool any = false;
  line_of(in, any);
  std::vector<PlaceRow> rows;
  for (int number = 2;; ++number) {
    const std::string line = line_of(in, any);
    if (!any) break;
    check_cancelled();
    if (line.empty()) continue;
    std::array<double, 5> value{};
    std::size_t begin = 0, count = 0;
    while (begin <= line.size() && count < value.size()) {
      const std::size_t end = std::min(line.find(',', begin), line.size());
      const auto [rest, error] = parse_double(line.data() + begin, line.data() + end, value[count]);
      if (error != std::errc() || rest != line.data() + end ||
          !(std::abs(value[count]) <= kFarthest_mm))
        break;
      ++count;
      begin = end + 1;
    }
    if (count != value.size() || begin <= line.size())
      throw InputError(
          fmt::format("{}:{}: needs five numbers: {}", file.string(), number, kHeader));
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
