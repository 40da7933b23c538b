#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <optional>

#include "base/error.h"
#include "model_io/file_checks.h"
#include "model_io/text_checks.h"

namespace hydrodip {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw InputError(fmt::format("{}: {}; export the model again.", path, what));
}

// ---- ZIP ----------------------------------------------------------------------------------------

struct ZipEntry {
  std::string name;
  int method = 0;
  std::uint32_t crc = 0;
  std::size_t packed = 0;
  std::size_t size = 0;
  std::size_t data = 0;  // offset of the packed bytes
};

constexpr std::size_t kMaxUnpacked = std::size_t(2) << 30;

class Zip {
 public:
  Zip(const std::string& path, const FileBytes& bytes) : path_(path), bytes_(bytes) {
    read_directory();
  }

  const std::vector<ZipEntry>& entries() const { return entries_; }

  std::string unpack(const ZipEntry& entry) const {
    std::string out(entry.size, '\0');
    if (entry.method == 0) {
      std::copy_n(bytes_.begin() + std::ptrdiff_t(entry.data), entry.size, out.begin());
    } else {
      inflate_into(entry, out);
    }
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(out.data()), uInt(out.size()));
    if (crc != entry.crc) damaged();
    return out;
  }

 private:
  [[noreturn]] void damaged() const {
    refuse(path_, "not a 3MF file, or a damaged or cut-off one");
  }

  std::size_t little_endian(std::size_t at, int count) const {
    if (at > bytes_.size() || bytes_.size() - at < std::size_t(count)) damaged();
    std::size_t value = 0;
    for (int i = 0; i < count; ++i) value |= std::size_t(bytes_[at + std::size_t(i)]) << (8 * i);
    return value;
  }

  std::size_t end_record() const {
    constexpr std::size_t kRecord = 22;
    if (bytes_.size() < kRecord) damaged();
    const std::size_t last = bytes_.size() - kRecord;
    for (std::size_t back = 0; back <= std::min<std::size_t>(last, 0xffff); ++back) {
      if (little_endian(last - back, 4) == 0x06054b50) return last - back;
    }
    damaged();
  }

  void read_directory() {
    const std::size_t end = end_record();
    const std::size_t count = little_endian(end + 10, 2);
    std::size_t at = little_endian(end + 16, 4);
    std::size_t total = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (little_endian(at, 4) != 0x02014b50) damaged();
      ZipEntry entry;
      entry.method = int(little_endian(at + 10, 2));
      entry.crc = std::uint32_t(little_endian(at + 16, 4));
      entry.packed = little_endian(at + 20, 4);
      entry.size = little_endian(at + 24, 4);
      const std::size_t name = little_endian(at + 28, 2);
      const std::size_t skip = little_endian(at + 30, 2) + little_endian(at + 32, 2);
      locate(entry, little_endian(at + 42, 4));
      if (at + 46 > bytes_.size() || name > bytes_.size() - at - 46) damaged();
      entry.name.assign(bytes_.begin() + std::ptrdiff_t(at + 46),
                        bytes_.begin() + std::ptrdiff_t(at + 46 + name));
      // Deflate shrinks at most 1032 to 1: more is a forged size.
      const bool believable = entry.method == 0   ? entry.size == entry.packed
                              : entry.method == 8 ? entry.size / 1040 <= entry.packed
                                                  : false;
      total += entry.size;
      if (!believable) damaged();
      if (total > kMaxUnpacked) refuse(path_, "its content is larger than 2 GiB");
      entries_.push_back(entry);
      at += 46 + name + skip;
    }
  }

  void locate(ZipEntry& entry, std::size_t header) const {
    if (little_endian(header, 4) != 0x04034b50) damaged();
    entry.data = header + 30 + little_endian(header + 26, 2) + little_endian(header + 28, 2);
    if (entry.data > bytes_.size() || entry.packed > bytes_.size() - entry.data) damaged();
  }

  void inflate_into(const ZipEntry& entry, std::string& out) const {
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) damaged();
    stream.next_in = const_cast<Bytef*>(bytes_.data() + entry.data);
    stream.avail_in = uInt(entry.packed);
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    const int result = inflate(&stream, Z_FINISH);
    const bool whole = result == Z_STREAM_END && stream.total_out == out.size();
    inflateEnd(&stream);
    if (!whole) damaged();
  }

  const std::string& path_;
  const FileBytes& bytes_;
  std::vector<ZipEntry> entries_;
};

// ---- XML ----------------------------------------------------------------------------------------

// One start tag. Attribute values are raw: the numbers and names that matter hold no entities.
struct Tag {
  std::string_view name;  // without namespace prefix
  bool closing = false;   // </name>
  std::vector<std::pair<std::string_view, std::string_view>> attributes;

  std::optional<std::string_view> find(std::string_view wanted) const {
    for (const auto& [key, value] : attributes) {
      if (key == wanted) return value;
    }
    return std::nullopt;
  }
};

class Tags {
 public:
  Tags(const std::string& path, std::string_view text) : path_(path), rest_(text) {}

  bool next(Tag& tag) {
    for (;;) {
      const std::size_t open = rest_.find('<');
      if (open == std::string_view::npos) return false;
      rest_.remove_prefix(open + 1);
      if (rest_.substr(0, 3) == "!--") {
        skip_past("-->");
      } else if (rest_.substr(0, 1) == "?") {
        skip_past("?>");
      } else if (rest_.substr(0, 1) == "!") {
        refuse(path_, "its XML has declarations that 3MF does not allow");
      } else {
        read(tag);
        return true;
      }
    }
  }

  int depth() const { return depth_; }

 private:
  [[noreturn]] void damaged() const { refuse(path_, "its XML is damaged"); }

  void skip_past(std::string_view mark) {
    const std::size_t at = rest_.find(mark);
    if (at == std::string_view::npos) damaged();
    rest_.remove_prefix(at + mark.size());
  }

  void skip_blanks() {
    while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  }

  std::string_view take_name() {
    std::size_t end = 0;
    while (end < rest_.size() && !is_blank(rest_[end]) && rest_[end] != '=' && rest_[end] != '>' &&
           rest_[end] != '/') {
      ++end;
    }
    if (end == 0) damaged();
    const std::string_view name = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return name;
  }

  void read(Tag& tag) {
    tag.attributes.clear();
    tag.closing = rest_.substr(0, 1) == "/";
    if (tag.closing) rest_.remove_prefix(1);
    tag.name = take_name();
    const std::size_t colon = tag.name.find(':');
    if (colon != std::string_view::npos) tag.name.remove_prefix(colon + 1);
    bool empty = false;
    for (skip_blanks();; skip_blanks()) {
      if (rest_.empty()) damaged();
      if (rest_.front() == '>') break;
      if (rest_.front() == '/') {
        empty = true;
        rest_.remove_prefix(1);
        continue;
      }
      read_attribute(tag);
    }
    rest_.remove_prefix(1);
    if (tag.closing) {
      --depth_;
    } else if (!empty) {
      ++depth_;
    }
    // The reader recurses into elements; a model needs a handful of levels.
    if (depth_ > 64 || depth_ < 0) damaged();
  }

  void read_attribute(Tag& tag) {
    const std::string_view key = take_name();
    skip_blanks();
    if (rest_.empty() || rest_.front() != '=') damaged();
    rest_.remove_prefix(1);
    skip_blanks();
    if (rest_.empty() || (rest_.front() != '"' && rest_.front() != '\'')) damaged();
    const char quote = rest_.front();
    rest_.remove_prefix(1);
    const std::size_t end = rest_.find(quote);
    if (end == std::string_view::npos) damaged();
    tag.attributes.emplace_back(key, rest_.substr(0, end));
    rest_.remove_prefix(end + 1);
  }

  const std::string& path_;
  std::string_view rest_;
  int depth_ = 0;
};

// ---- model --------------------------------------------------------------------------------------

// The lists of a model part, in the order that the reader meets them.
class ModelCheck {
 public:
  ModelCheck(const std::string& path, std::string_view text) : path_(path), tags_(path, text) {}

  void run() {
    Tag tag;
    while (tags_.next(tag)) {
      if (tag.closing) {
        close(tag.name);
      } else {
        open(tag);
      }
    }
    close_object();
    if (tags_.depth() != 0) refuse(path_, "its XML ends too early");
    if (units_.empty()) refuse(path_, "it holds no 3MF model");
  }

  const std::string& units() const { return units_; }
  long long triangles() const { return triangles_; }
  bool textured() const { return textured_; }
  // Empty if no triangle has a colour.
  std::vector<std::vector<FaceColors>> take_colors() {
    if (!colored_) colors_.clear();
    return std::move(colors_);
  }

 private:
  using Rgba = std::array<std::uint8_t, 4>;
  struct Group {
    long long entries = 0;
    std::vector<Rgba> colors;  // empty for textures
  };
  struct Object3mf {
    long long placed = 0;  // triangles, components included
    int depth = 0;
  };

  void open(const Tag& tag) {
    const std::string_view name = tag.name;
    if (name == "model") {
      read_units(tag);
    } else if (name == "basematerials" || name == "colorgroup" || name == "texture2dgroup") {
      group_ = &groups_[integer(tag, "id")];
      *group_ = {};
    } else if (name == "tex2coord") {
      if (group_) ++group_->entries;
    } else if (name == "base" || name == "color") {
      read_color(tag, name == "base" ? "displaycolor" : "color");
    } else if (name == "object") {
      open_object(tag);
    } else if (name == "mesh") {
      vertices_ = 0;
      colors_.emplace_back();
    } else if (name == "vertices") {
      if (vertices_ > 0) refuse(path_, "a mesh has two vertex lists");
    } else if (name == "vertex") {
      check_vertex(tag);
    } else if (name == "triangle") {
      check_triangle(tag);
    } else if (name == "component" || name == "item") {
      check_placement(tag, name == "component");
    }
  }

  void close(std::string_view name) {
    if (name == "basematerials" || name == "colorgroup" || name == "texture2dgroup") {
      group_ = nullptr;
    } else if (name == "object") {
      close_object();
    }
  }

  void read_units(const Tag& tag) {
    if (!units_.empty()) refuse(path_, "it holds two models");
    units_ = std::string(tag.find("unit").value_or("millimeter"));
    static constexpr std::string_view kKnown[] = {"micron", "millimeter", "centimeter",
                                                  "inch",   "foot",       "meter"};
    if (std::find(std::begin(kKnown), std::end(kKnown), units_) == std::end(kKnown)) {
      refuse(path_, fmt::format("unknown 3MF unit '{}'", units_.substr(0, 40)));
    }
  }

  long long integer(const Tag& tag, std::string_view name) const {
    long long value = 0;
    const auto text = tag.find(name);
    if (!text || !parse_integer(*text, value) || value < 0 ||
        value > std::numeric_limits<std::int32_t>::max()) {
      refuse(path_, fmt::format("<{}> has no valid '{}'", tag.name.substr(0, 40), name));
    }
    return value;
  }

  void read_color(const Tag& tag, std::string_view attribute) {
    if (!group_) return;
    Rgba color = {255, 255, 255, 255};
    if (const auto text = tag.find(attribute)) {
      const bool well_formed = (text->size() == 7 || text->size() == 9) && (*text)[0] == '#';
      for (std::size_t c = 0; well_formed && 2 * c + 2 < text->size(); ++c) {
        const std::string_view digits = text->substr(1 + 2 * c, 2);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + 2, color[c], 16);
        if (error != std::errc() || end != digits.data() + 2) refuse_color();
      }
      if (!well_formed) refuse_color();
    }
    group_->colors.push_back(color);
    ++group_->entries;
  }

  [[noreturn]] void refuse_color() const { refuse(path_, "a colour is not #RRGGBB or #RRGGBBAA"); }

  void open_object(const Tag& tag) {
    close_object();
    current_id_ = integer(tag, "id");
    if (objects_.count(current_id_) || groups_.count(current_id_)) {
      refuse(path_, fmt::format("two resources share the id {}", current_id_));
    }
    current_ = Object3mf{};
    object_group_ = -1;
    object_index_ = -1;
    if (tag.find("pid") && tag.find("pindex")) {
      object_group_ = integer(tag, "pid");
      object_index_ = integer(tag, "pindex");
      check_property(object_group_, object_index_);
    }
  }

  void close_object() {
    if (!current_) return;
    objects_[current_id_] = *current_;
    current_.reset();
  }

  void check_property(long long group, long long index) const {
    const auto it = groups_.find(group);
    if (it != groups_.end() && index >= it->second.entries) {
      refuse(path_, fmt::format("a triangle refers to entry {} of material group {}, which has {}",
                                index, group, it->second.entries));
    }
  }

  void check_vertex(const Tag& tag) {
    for (const char* axis : {"x", "y", "z"}) {
      double value = 0;
      const auto text = tag.find(axis);
      if (!text || !parse_number(*text, value)) {
        refuse(path_, fmt::format("a vertex's {} is not a finite number", axis));
      }
    }
    ++vertices_;
  }

  void check_triangle(const Tag& tag) {
    if (!current_) refuse(path_, "a triangle outside an object");
    for (const char* corner : {"v1", "v2", "v3"}) {
      const long long index = integer(tag, corner);
      if (index >= vertices_) {
        refuse(path_, fmt::format("a face refers to vertex {}, but the mesh has vertices 0 to {}",
                                  index, vertices_ - 1));
      }
    }
    if (colors_.empty()) refuse(path_, "a triangle outside a mesh");
    colors_.back().push_back(face_colors(tag));
    ++current_->placed;
    ++triangles_;
  }

  // p1 alone goes for all three corners; none of them: the object's own.
  FaceColors face_colors(const Tag& tag) {
    long long group = object_group_;
    if (tag.find("pid")) group = integer(tag, "pid");
    long long indices[3] = {object_index_, object_index_, object_index_};
    if (tag.find("p1")) {
      indices[0] = integer(tag, "p1");
      indices[1] = tag.find("p2") ? integer(tag, "p2") : indices[0];
      indices[2] = tag.find("p3") ? integer(tag, "p3") : indices[0];
    } else if (tag.find("pid")) {
      return kPlain;
    }
    FaceColors colors = kPlain;
    const auto it = groups_.find(group);
    for (std::size_t c = 0; it != groups_.end() && c < 3; ++c) {
      check_property(group, indices[c]);
      if (indices[c] < 0 || it->second.colors.empty()) continue;
      colors[c] = it->second.colors[std::size_t(indices[c])];
      colored_ = true;
    }
    if (it != groups_.end() && it->second.colors.empty()) textured_ = true;
    return colors;
  }

  // Objects come before those that use them, so components cannot form a loop.
  void check_placement(const Tag& tag, bool component) {
    constexpr long long kMaxPlaced = 100'000'000;
    if (component && !current_) refuse(path_, "a component outside an object");
    const long long id = integer(tag, "objectid");
    const auto it = objects_.find(id);
    if (it == objects_.end()) {
      refuse(path_, fmt::format("object {} is used but not defined before", id));
    }
    check_transform(tag);
    if (component) {
      current_->placed += it->second.placed;
      current_->depth = std::max(current_->depth, it->second.depth + 1);
      if (current_->depth > 32) refuse(path_, "its components are nested too deeply");
      if (++placements_ > 100'000 || current_->placed > kMaxPlaced) {
        refuse(path_, "it has too many triangles");
      }
    } else {
      placed_ += it->second.placed;
      if (placed_ > kMaxPlaced) refuse(path_, "it has too many triangles");
    }
  }

  void check_transform(const Tag& tag) const {
    const auto transform = tag.find("transform");
    if (!transform) return;
    std::string_view rest = *transform;
    int count = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      double value = 0;
      if (!parse_number(word, value)) refuse(path_, "a transform is not made of numbers");
      ++count;
    }
    if (count != 12 || transform->find_first_of("\t\r\n") != std::string_view::npos) {
      refuse(path_, "a transform is not made of 12 numbers");
    }
  }

  static constexpr FaceColors kPlain = {Rgba{255, 255, 255, 255}, Rgba{255, 255, 255, 255},
                                        Rgba{255, 255, 255, 255}};

  const std::string& path_;
  Tags tags_;
  std::string units_;
  std::map<long long, Group> groups_;
  std::map<long long, Object3mf> objects_;
  Group* group_ = nullptr;
  std::optional<Object3mf> current_;
  long long current_id_ = 0;
  long long object_group_ = -1, object_index_ = -1;
  long long vertices_ = 0;
  std::vector<std::vector<FaceColors>> colors_;
  long long triangles_ = 0;
  long long placed_ = 0;
  long long placements_ = 0;
  bool colored_ = false;
  bool textured_ = false;
};

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

CheckedFile check_3mf(const std::string& path, FileBytes bytes) {
  CheckedFile checked;
  long models = 0;
  {
    const Zip zip(path, bytes);
    for (const ZipEntry& entry : zip.entries()) {
      // Every part is unpacked once, so that none of them can surprise the reader.
      const std::string content = zip.unpack(entry);
      if (ends_with(entry.name, ".rels")) {
        Tags tags(path, content);
        for (Tag tag; tags.next(tag);) continue;
      }
      if (!ends_with(entry.name, ".model")) continue;
      if (++models > 1)
        refuse(path, "it is split into several model parts, which is not supported");
      ModelCheck check(path, content);
      check.run();
      if (check.triangles() == 0) refuse(path, "it has no triangles");
      checked.units = check.units();
      checked.face_colors = check.take_colors();
      if (check.textured()) {
        checked.warnings.push_back(
            "Textures in 3MF files are read with one texture and one coordinate per vertex of a "
            "mesh, so seams may smear; export GLB or OBJ to keep them.");
      }
    }
  }
  if (models == 0) refuse(path, "it holds no 3MF model");
  checked.bytes = std::move(bytes);
  return checked;
}

}  // namespace hydrodip
