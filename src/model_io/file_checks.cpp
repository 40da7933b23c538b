#include "model_io/file_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "base/error.h"
#include "model_io/text_checks.h"

namespace hydrodip {

namespace {

constexpr const char* kExportAgain = "export the model again";

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw InputError(fmt::format("{}: {}; {}.", path, what, kExportAgain));
}

[[noreturn]] void refuse_line(const std::string& path, long line, const std::string& what) {
  throw InputError(fmt::format("{}, line {}: {}; {}.", path, line, what, kExportAgain));
}

std::string_view text_of(const FileBytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void refuse_binary(const std::string& path, std::string_view text, const char* format) {
  if (text.find('\0') != std::string_view::npos) {
    refuse(path, fmt::format("not {} text, it contains binary data", format));
  }
}

void append_line(FileBytes& out, std::string_view line) {
  out.insert(out.end(), line.begin(), line.end());
  out.push_back('\n');
}

std::string lower(std::string_view word) {
  std::string out(word.substr(0, 40));
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return out;
}

// ---- OBJ ----------------------------------------------------------------------------------------

// One kind of list that OBJ faces index: v, vt or vn.
struct ObjList {
  const char* what;
  long long count = 0;
  long long highest = 0;  // highest index used, and where
  long highest_line = 0;
};

class ObjCheck {
 public:
  ObjCheck(const std::string& path, std::string_view text) : path_(path), rest_(text) {}

  void run() {
    while (!rest_.empty()) check_line(next_line());
    for (const ObjList& list : lists_) {
      if (list.highest > list.count) {
        refuse_line(path_, list.highest_line,
                    fmt::format("a face refers to {} {}, but the file has {}", list.what,
                                list.highest, list.count));
      }
    }
    if (faces_ == 0) refuse(path_, "it has no faces");
  }

 private:
  // A backslash at its end continues a line.
  std::string_view next_line() {
    first_line_ = line_ + 1;
    const char* begin = rest_.data();
    std::string_view line;
    do {
      line = take_line(rest_);
      ++line_;
    } while (!line.empty() && line.back() == '\\' && !rest_.empty());
    return {begin, std::size_t(line.data() + line.size() - begin)};
  }

  static std::string_view take(std::string_view& rest) {
    std::string_view word = take_word(rest);
    while (word == "\\") word = take_word(rest);
    return word;
  }

  void check_line(std::string_view line) {
    const std::string_view keyword = take(line);
    if (keyword == "v") {
      check_numbers(line, 3);
      ++lists_[0].count;
    } else if (keyword == "vt") {
      check_numbers(line, 1);
      ++lists_[1].count;
    } else if (keyword == "vn") {
      ++lists_[2].count;
    } else if (keyword == "f") {
      check_face(line);
    }
  }

  void check_numbers(std::string_view line, int needed) {
    int count = 0;
    for (std::string_view word = take(line); !word.empty() && word[0] != '#'; word = take(line)) {
      double value = 0;
      if (!parse_number(word, value)) {
        refuse_line(path_, first_line_, fmt::format("'{}' is not a finite number", shown(word)));
      }
      ++count;
    }
    if (count < needed) {
      refuse_line(path_, first_line_, fmt::format("{} numbers where {} are needed", count, needed));
    }
  }

  void check_face(std::string_view line) {
    int corners = 0;
    for (std::string_view word = take(line); !word.empty() && word[0] != '#'; word = take(line)) {
      check_corner(word);
      ++corners;
    }
    faces_ += corners >= 3;
  }

  // "v", "v/vt", "v//vn" or "v/vt/vn".
  void check_corner(std::string_view word) {
    std::string_view rest = word;
    for (std::size_t kind = 0; kind < 3; ++kind) {
      const std::size_t slash = rest.find('/');
      const std::string_view part = rest.substr(0, slash);
      if (!part.empty() || kind == 0) check_index(lists_[kind], part, word);
      if (slash == std::string_view::npos) return;
      rest.remove_prefix(slash + 1);
    }
    refuse_line(path_, first_line_, fmt::format("'{}' is not a face corner", shown(word)));
  }

  void check_index(ObjList& list, std::string_view part, std::string_view word) {
    long long index = 0;
    if (!parse_integer(part, index) || index == 0) {
      refuse_line(path_, first_line_, fmt::format("'{}' is not a face corner", shown(word)));
    }
    if (index < 0 && -index > list.count) {
      refuse_line(path_, first_line_,
                  fmt::format("a face refers to the {}th last {}, but only {} came before", -index,
                              list.what, list.count));
    }
    if (index > list.highest) {
      list.highest = index;
      list.highest_line = first_line_;
    }
  }

  static std::string shown(std::string_view word) { return std::string(word.substr(0, 40)); }

  const std::string& path_;
  std::string_view rest_;
  long line_ = 0;
  long first_line_ = 0;
  long faces_ = 0;
  ObjList lists_[3] = {{"vertex"}, {"texture coordinate"}, {"normal"}};
};

// ---- MTL ----------------------------------------------------------------------------------------

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// "0.5 0.5 0.5" of a Kd line or "1" of a d line, or "" if it is not that many numbers.
std::string clean_numbers(std::string_view line, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) {
    double value = 0;
    if (!parse_number(take_word(line), value)) return "";
    out += fmt::format(" {:.9f}", std::clamp(value, 0.0, 1.0));
  }
  return out;
}

// Skips what follows an option: one word, or up to three numbers.
void skip_arguments(std::string_view option, std::string_view& line) {
  const bool vector = option == "-o" || option == "-s" || option == "-t";
  const int most = vector ? 3 : option == "-mm" ? 2 : 1;
  for (int i = 0; i < most; ++i) {
    std::string_view probe = line;
    double value = 0;
    if (i > 0 && !parse_number(take_word(probe), value)) return;
    take_word(line);
  }
}

// "[-clamp on] name" of a map_Kd line, or "".
std::string clean_map(std::string_view line) {
  bool clamp = false;
  for (;;) {
    std::string_view rest = line;
    const std::string_view option = take_word(rest);
    if (option.size() < 2 || option[0] != '-' || !(option[1] >= 'a' && option[1] <= 'z')) break;
    line = rest;
    if (option == "-clamp") clamp = take_word(rest) == "on";
    skip_arguments(option, line);
  }
  const std::string_view name = trimmed(line).substr(0, 900);
  if (name.empty()) return "";
  return fmt::format("{} {}", clamp ? " -clamp on" : "", name);
}

// ---- PLY ----------------------------------------------------------------------------------------

struct PlyProperty {
  std::string name;
  int bytes = 0;
  int count_bytes = 0;  // 0: not a list
  bool floating = false;
  bool count_signed = false;
  bool is_signed = false;
};

struct PlyElement {
  std::string name;
  long long count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Format { kAscii, kLittle, kBig } format = Format::kAscii;
  std::vector<PlyElement> elements;
  std::size_t body = 0;
};

struct PlyType {
  const char* name;
  int bytes;
  bool floating;
  bool is_signed;
};

constexpr PlyType kPlyTypes[] = {
    {"char", 1, false, true},    {"int8", 1, false, true},    {"uchar", 1, false, false},
    {"uint8", 1, false, false},  {"short", 2, false, true},   {"int16", 2, false, true},
    {"ushort", 2, false, false}, {"uint16", 2, false, false}, {"int", 4, false, true},
    {"int32", 4, false, true},   {"uint", 4, false, false},   {"uint32", 4, false, false},
    {"float", 4, true, true},    {"float32", 4, true, true},  {"double", 8, true, true},
    {"float64", 8, true, true},
};

const PlyType& ply_type(const std::string& path, std::string_view name) {
  for (const PlyType& type : kPlyTypes) {
    if (name == type.name) return type;
  }
  refuse(path, fmt::format("'{}' is not a PLY number type", name.substr(0, 40)));
}

PlyProperty ply_property(const std::string& path, std::string_view line) {
  PlyProperty property;
  std::string_view word = take_word(line);
  if (word == "list") {
    const PlyType& count = ply_type(path, take_word(line));
    if (count.floating) refuse(path, "a PLY list is counted by a fraction");
    property.count_bytes = count.bytes;
    property.count_signed = count.is_signed;
    word = take_word(line);
  }
  const PlyType& type = ply_type(path, word);
  property.bytes = type.bytes;
  property.floating = type.floating;
  property.is_signed = type.is_signed;
  property.name = std::string(take_word(line));
  if (property.name.empty()) refuse(path, "a PLY property has no name");
  return property;
}

PlyHeader ply_header(const std::string& path, std::string_view text) {
  constexpr long kMaxLines = 1000;
  PlyHeader header;
  std::string_view rest = text;
  if (take_line(rest) != "ply") refuse(path, "not a PLY file, it does not begin with 'ply'");
  bool has_format = false;
  for (long number = 0; number < kMaxLines && !rest.empty(); ++number) {
    std::string_view line = take_line(rest);
    const std::string_view keyword = take_word(line);
    if (keyword == "end_header") {
      if (!has_format) refuse(path, "the PLY header names no format");
      header.body = text.size() - rest.size();
      return header;
    }
    if (keyword == "format") {
      const std::string_view format = take_word(line);
      has_format = true;
      if (format == "ascii") {
        header.format = PlyHeader::Format::kAscii;
      } else if (format == "binary_little_endian") {
        header.format = PlyHeader::Format::kLittle;
      } else if (format == "binary_big_endian") {
        header.format = PlyHeader::Format::kBig;
      } else {
        refuse(path, fmt::format("unknown PLY format '{}'", format.substr(0, 40)));
      }
      if (number != 0) refuse(path, "the PLY format must come second");
    } else if (keyword == "element") {
      PlyElement element;
      element.name = std::string(take_word(line));
      if (!parse_integer(take_word(line), element.count) || element.count < 0) {
        refuse(path, fmt::format("PLY element '{}' has no valid count", element.name));
      }
      header.elements.push_back(element);
    } else if (keyword == "property") {
      if (header.elements.empty()) refuse(path, "a PLY property precedes every element");
      header.elements.back().properties.push_back(ply_property(path, line));
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
      refuse(path, "the PLY header is damaged");
    }
  }
  refuse(path, "the PLY header does not end");
}

// Reads numbers one after the other, from text or from binary data.
class PlyBody {
 public:
  PlyBody(const std::string& path, const PlyHeader& header, const FileBytes& bytes)
      : path_(path), format_(header.format) {
    text_ = text_of(bytes).substr(header.body);
  }

  std::size_t left() const { return text_.size(); }
  bool ascii() const { return format_ == PlyHeader::Format::kAscii; }

  double number(int bytes, bool floating, bool is_signed) {
    if (ascii()) {
      double value = 0;
      const std::string_view word = take_word(text_);
      if (word.empty()) refuse(path_, "the file ends too early");
      if (!parse_number(word, value)) {
        refuse(path_, fmt::format("'{}' is not a finite number", word.substr(0, 40)));
      }
      return value;
    }
    if (text_.size() < std::size_t(bytes)) refuse(path_, "the file ends too early");
    unsigned char raw[8] = {};
    for (int i = 0; i < bytes; ++i) {
      const int from = format_ == PlyHeader::Format::kBig ? bytes - 1 - i : i;
      raw[i] = static_cast<unsigned char>(text_[std::size_t(from)]);
    }
    text_.remove_prefix(std::size_t(bytes));
    return decode(raw, bytes, floating, is_signed);
  }

  // A line break ends a row of text, so that a row with too few numbers does not borrow the next.
  void skip_binary(std::size_t bytes) {
    if (text_.size() < bytes) refuse(path_, "the file ends too early");
    text_.remove_prefix(bytes);
  }

 private:
  template <typename T>
  static double as(const unsigned char* raw) {
    T value;
    std::memcpy(&value, raw, sizeof value);
    return double(value);
  }

  static double decode(const unsigned char* raw, int bytes, bool floating, bool is_signed) {
    if (floating) return bytes == 4 ? as<float>(raw) : as<double>(raw);
    switch (bytes) {
      case 1:
        return is_signed ? as<std::int8_t>(raw) : as<std::uint8_t>(raw);
      case 2:
        return is_signed ? as<std::int16_t>(raw) : as<std::uint16_t>(raw);
      default:
        return is_signed ? as<std::int32_t>(raw) : as<std::uint32_t>(raw);
    }
  }

  const std::string& path_;
  PlyHeader::Format format_;
  std::string_view text_;
};

bool is_index_list(const PlyProperty& property) {
  return property.count_bytes > 0 &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

void check_ply_list(const std::string& path, const PlyProperty& property, long long row,
                    long long vertices, PlyBody& body) {
  const double count = body.number(property.count_bytes, false, property.count_signed);
  if (count < 0 || count > double(body.left())) refuse(path, "a PLY list is longer than the file");
  for (double i = 0; i < count; ++i) {
    const double value = body.number(property.bytes, property.floating, property.is_signed);
    if (is_index_list(property) && (value < 0 || value >= double(vertices))) {
      refuse(path, fmt::format("face {} refers to vertex {:.0f}, but the file has vertices 0 to {}",
                               row, value, vertices - 1));
    }
  }
}

void check_ply_rows(const std::string& path, const PlyElement& element, long long vertices,
                    PlyBody& body) {
  const bool plain = std::none_of(element.properties.begin(), element.properties.end(),
                                  [](const PlyProperty& p) { return p.count_bytes > 0; });
  std::size_t row_bytes = 0;
  for (const PlyProperty& property : element.properties) {
    row_bytes += std::size_t(body.ascii()               ? 2
                             : property.count_bytes > 0 ? property.count_bytes
                                                        : property.bytes);
  }
  // The last number of a text file needs no blank after it.
  if (double(element.count) * double(row_bytes) > double(body.left()) + 1) {
    refuse(path, fmt::format("the header promises {} of element '{}', more than the file holds",
                             element.count, element.name));
  }
  if (plain && !body.ascii()) {
    body.skip_binary(std::size_t(element.count) * row_bytes);
    return;
  }
  for (long long row = 0; row < element.count; ++row) {
    for (const PlyProperty& property : element.properties) {
      if (property.count_bytes > 0) {
        check_ply_list(path, property, row, vertices, body);
      } else {
        body.number(property.bytes, property.floating, property.is_signed);
      }
    }
  }
}

// ---- STL ----------------------------------------------------------------------------------------

constexpr std::size_t kStlHeader = 84;
constexpr std::size_t kStlTriangle = 50;

bool starts_with_solid(std::string_view text) {
  const std::string_view word = take_word(text);
  return word == "solid" || word == "SOLID" || word == "Solid";
}

void check_ascii_stl(const std::string& path, std::string_view text) {
  refuse_binary(path, text, "STL");
  long line_number = 0, facets = 0;
  int corners = -1;  // -1: outside a facet
  bool open = false;
  while (!text.empty()) {
    std::string_view line = take_line(text);
    ++line_number;
    const std::string keyword = lower(take_word(line));
    if (keyword == "solid") {
      open = true;
    } else if (keyword == "endsolid") {
      if (corners >= 0) refuse_line(path, line_number, "a facet is not finished");
      open = false;
    } else if (keyword == "facet") {
      if (corners >= 0) refuse_line(path, line_number, "a facet is not finished");
      corners = 0;
    } else if (keyword == "vertex") {
      double value = 0;
      for (int i = 0; i < 3; ++i) {
        if (!parse_number(take_word(line), value)) {
          refuse_line(path, line_number, "a vertex needs three finite numbers");
        }
      }
      if (corners < 0) refuse_line(path, line_number, "a vertex outside a facet");
      ++corners;
    } else if (keyword == "endfacet") {
      if (corners != 3) refuse_line(path, line_number, "a facet needs three vertices");
      corners = -1;
      ++facets;
    } else if (keyword != "outer" && keyword != "endloop" && !keyword.empty()) {
      refuse_line(path, line_number, "not a line of an STL file");
    }
  }
  if (open || corners >= 0) refuse(path, "the STL file ends too early, without 'endsolid'");
  if (facets == 0) refuse(path, "it has no triangles");
}

void check_binary_stl(const std::string& path, const FileBytes& bytes) {
  if (bytes.size() < kStlHeader) refuse(path, "too short for an STL file");
  std::uint32_t count = 0;
  for (int i = 0; i < 4; ++i) count |= std::uint32_t(bytes[80 + std::size_t(i)]) << (8 * i);
  const double needed = double(kStlHeader) + double(kStlTriangle) * count;
  if (needed != double(bytes.size())) {
    refuse(path, fmt::format("as a binary STL file of {} triangles it should have {:.0f} bytes, "
                             "but it has {}",
                             count, needed, bytes.size()));
  }
  if (count == 0) refuse(path, "it has no triangles");
}

bool has_binary_stl_size(const FileBytes& bytes) {
  if (bytes.size() < kStlHeader) return false;
  std::uint32_t count = 0;
  for (int i = 0; i < 4; ++i) count |= std::uint32_t(bytes[80 + std::size_t(i)]) << (8 * i);
  return double(kStlHeader) + double(kStlTriangle) * count == double(bytes.size());
}

// ---- OFF ----------------------------------------------------------------------------------------

// The longest line and the largest face that assimp's OFF reader takes.
constexpr std::size_t kOffLine = 4000;
constexpr long long kOffCorners = 9;

// Lines without comments and blank ones.
class OffLines {
 public:
  OffLines(const std::string& path, std::string_view text) : path_(path), rest_(text) {}

  std::string_view next() {
    while (!rest_.empty()) {
      std::string_view line = take_line(rest_);
      ++number_;
      line = line.substr(0, line.find('#'));
      std::string_view probe = line;
      if (take_word(probe).empty()) continue;
      if (line.size() > kOffLine) refuse_line(path_, number_, "the line is too long");
      return line;
    }
    refuse(path_, "the file ends too early");
  }

  long number() const { return number_; }
  std::size_t left() const { return rest_.size(); }

 private:
  const std::string& path_;
  std::string_view rest_;
  long number_ = 0;
};

int numbers_in(const std::string& path, const OffLines& lines, std::string_view line) {
  int count = 0;
  for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
    double value = 0;
    if (!parse_number(word, value)) {
      refuse_line(path, lines.number(),
                  fmt::format("'{}' is not a finite number", word.substr(0, 40)));
    }
    ++count;
  }
  return count;
}

void check_off_face(const std::string& path, const OffLines& lines, std::string_view line,
                    long long vertices) {
  long long corners = 0;
  if (!parse_integer(take_word(line), corners) || corners < 1) {
    refuse_line(path, lines.number(), "a face must begin with its number of corners");
  }
  if (corners > kOffCorners) {
    throw InputError(
        fmt::format("{}, line {}: a face has {} corners, more than {}; triangulate the model.",
                    path, lines.number(), corners, kOffCorners));
  }
  for (long long i = 0; i < corners; ++i) {
    long long index = -1;
    if (!parse_integer(take_word(line), index)) {
      refuse_line(path, lines.number(), fmt::format("a face needs {} vertex numbers", corners));
    }
    if (index < 0 || index >= vertices) {
      refuse_line(path, lines.number(),
                  fmt::format("a face refers to vertex {}, but the file has vertices 0 to {}",
                              index, vertices - 1));
    }
  }
}

}  // namespace

CheckedFile check_obj(const std::string& path, FileBytes bytes) {
  refuse_binary(path, text_of(bytes), "OBJ");
  ObjCheck(path, text_of(bytes)).run();
  return {std::move(bytes), "", {}, {}};
}

FileBytes clean_mtl(const FileBytes& bytes) {
  FileBytes out;
  bool named = false;
  std::string_view rest = text_of(bytes);
  while (!rest.empty()) {
    std::string_view line = take_line(rest);
    line = line.substr(0, line.find('\0'));
    const std::string_view keyword = take_word(line);
    if (keyword == "newmtl" && !trimmed(line).empty()) {
      named = true;
      append_line(out, fmt::format("newmtl {}", trimmed(line).substr(0, 900)));
    }
    if (!named) continue;
    const std::string key = lower(keyword);
    const std::string value = keyword == "Kd"                     ? clean_numbers(line, 3)
                              : keyword == "d" || keyword == "Tr" ? clean_numbers(line, 1)
                              : key == "map_kd"                   ? clean_map(line)
                                                                  : "";
    if (!value.empty())
      append_line(out, (key == "map_kd" ? "map_Kd" : std::string(keyword)) + value);
  }
  // assimp takes an empty library for a missing one.
  if (out.empty()) append_line(out, "# no materials");
  return out;
}

CheckedFile check_ply(const std::string& path, FileBytes bytes) {
  const PlyHeader header = ply_header(path, text_of(bytes));
  long long vertices = 0, faces = 0;
  for (const PlyElement& element : header.elements) {
    if (element.name == "tristrips") refuse(path, "triangle strips are not supported");
    if (element.name == "face") faces += element.count;
    if (element.name != "vertex") continue;
    vertices += element.count;
    for (const PlyProperty& property : element.properties) {
      if (property.count_bytes > 0) refuse(path, "lists per vertex are not supported");
    }
  }
  if (vertices == 0 || faces == 0) refuse(path, "it has no triangles");
  PlyBody body(path, header, bytes);
  for (const PlyElement& element : header.elements) {
    check_ply_rows(path, element, vertices, body);
  }
  return {std::move(bytes), "", {}, {}};
}

CheckedFile check_stl(const std::string& path, FileBytes bytes) {
  // Many binary files begin with "solid" too: the size decides.
  if (!has_binary_stl_size(bytes) && starts_with_solid(text_of(bytes))) {
    check_ascii_stl(path, text_of(bytes));
  } else {
    check_binary_stl(path, bytes);
  }
  return {std::move(bytes), "", {}, {}};
}

CheckedFile check_off(const std::string& path, const FileBytes& bytes) {
  refuse_binary(path, text_of(bytes), "OFF");
  OffLines lines(path, text_of(bytes));
  std::string_view line = lines.next();
  std::string_view counts = line;
  const std::string_view header = take_word(counts);
  const bool known = header == "OFF" || header == "COFF" || header == "NOFF" || header == "CNOFF" ||
                     header == "STOFF";
  if (!known) {
    refuse(path,
           "not an OFF file that can be read, it does not begin with OFF, COFF, NOFF, CNOFF "
           "or STOFF");
  }
  const int per_vertex = header == "OFF"     ? 3
                         : header == "COFF"  ? 6
                         : header == "STOFF" ? 5
                         : header == "NOFF"  ? 6
                                             : 9;
  std::string_view probe = counts;
  if (take_word(probe).empty()) counts = lines.next();
  long long vertices = 0, faces = 0;
  if (!parse_integer(take_word(counts), vertices) || !parse_integer(take_word(counts), faces) ||
      vertices <= 0 || faces <= 0) {
    refuse_line(path, lines.number(), "the numbers of vertices and faces are missing");
  }
  if (double(vertices) * 6 + double(faces) * 4 > double(lines.left()) + 2) {
    refuse(path, fmt::format("the header promises {} vertices and {} faces, more than the file "
                             "holds",
                             vertices, faces));
  }
  FileBytes out;
  out.reserve(bytes.size() + 64);
  append_line(out, fmt::format("{}\n{} {} 0", header, vertices, faces));
  for (long long i = 0; i < vertices; ++i) {
    line = lines.next();
    if (numbers_in(path, lines, line) < per_vertex) {
      refuse_line(path, lines.number(), fmt::format("a vertex needs {} numbers", per_vertex));
    }
    append_line(out, line);
  }
  for (long long i = 0; i < faces; ++i) {
    line = lines.next();
    check_off_face(path, lines, line, vertices);
    append_line(out, line);
  }
  return {std::move(out), "", {}, {}};
}

}  // namespace hydrodip
