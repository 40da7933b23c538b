// Stanford PLY, as text and binary of either byte order.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "model_io/model_file.h"
#include "model_io/text.h"

namespace hydrodip {

namespace {

// What a number of a row is good for.
enum class Use {
  kNothing,
  kX,
  kY,
  kZ,
  kU,
  kV,
  kRed,
  kGreen,
  kBlue,
  kAlpha,
  kVertexIndices,
  kTexcoords,
  kTexnumber,
  kStrips,
};

struct PlyType {
  const char* name;
  int bytes;
  bool floating;
  bool is_signed;
};

constexpr PlyType kTypes[] = {
    {"char", 1, false, true},    {"int8", 1, false, true},    {"uchar", 1, false, false},
    {"uint8", 1, false, false},  {"short", 2, false, true},   {"int16", 2, false, true},
    {"ushort", 2, false, false}, {"uint16", 2, false, false}, {"int", 4, false, true},
    {"int32", 4, false, true},   {"uint", 4, false, false},   {"uint32", 4, false, false},
    {"float", 4, true, true},    {"float32", 4, true, true},  {"double", 8, true, true},
    {"float64", 8, true, true},
};

struct PlyProperty {
  std::string name;
  PlyType type{};
  bool list = false;
  PlyType count{};
  Use use = Use::kNothing;
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class Coding { kText, kLittle, kBig };

struct PlyHeader {
  Coding coding = Coding::kText;
  std::vector<PlyElement> elements;
  std::vector<std::string> pictures;  // "comment TextureFile NAME", in order
  std::size_t body = 0;
};

struct NamedUse {
  const char* name;
  Use use;
};

constexpr NamedUse kVertexUses[] = {
    {"x", Use::kX},         {"y", Use::kY},     {"z", Use::kZ},
    {"u", Use::kU},         {"s", Use::kU},     {"texture_u", Use::kU},
    {"v", Use::kV},         {"t", Use::kV},     {"texture_v", Use::kV},
    {"red", Use::kRed},     {"r", Use::kRed},   {"diffuse_red", Use::kRed},
    {"green", Use::kGreen}, {"g", Use::kGreen}, {"diffuse_green", Use::kGreen},
    {"blue", Use::kBlue},   {"b", Use::kBlue},  {"diffuse_blue", Use::kBlue},
    {"alpha", Use::kAlpha}, {"a", Use::kAlpha}, {"diffuse_alpha", Use::kAlpha},
};

constexpr NamedUse kFaceUses[] = {
    {"vertex_indices", Use::kVertexIndices},
    {"vertex_index", Use::kVertexIndices},
    {"texcoord", Use::kTexcoords},
    {"texnumber", Use::kTexnumber},
    {"red", Use::kRed},
    {"diffuse_red", Use::kRed},
    {"green", Use::kGreen},
    {"diffuse_green", Use::kGreen},
    {"blue", Use::kBlue},
    {"diffuse_blue", Use::kBlue},
    {"alpha", Use::kAlpha},
    {"diffuse_alpha", Use::kAlpha},
};

Use use_of(const std::string& element, const PlyProperty& property) {
  if (element == "tristrips" && property.list) return Use::kStrips;
  const bool vertex = element == "vertex";
  if (!vertex && element != "face") return Use::kNothing;
  const NamedUse* begin = vertex ? std::begin(kVertexUses) : std::begin(kFaceUses);
  const NamedUse* end = vertex ? std::end(kVertexUses) : std::end(kFaceUses);
  const auto* known =
      std::find_if(begin, end, [&](const NamedUse& named) { return property.name == named.name; });
  if (known == end) return Use::kNothing;
  const bool needs_list = known->use == Use::kVertexIndices || known->use == Use::kTexcoords;
  return property.list == needs_list ? known->use : Use::kNothing;
}

// ---- header -------------------------------------------------------------------------------------

class HeaderReader {
 public:
  HeaderReader(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  PlyHeader run() {
    constexpr long kMaxLines = 10000;
    std::string_view rest = text_;
    if (trimmed(take_line(rest)) != "ply")
      refuse_model(path_, "not a PLY file, it does not begin with 'ply'");
    for (long number = 0; number < kMaxLines && !rest.empty(); ++number) {
      std::string_view line = take_header_line(rest);
      const std::string_view keyword = take_word(line);
      if (keyword == "end_header") {
        if (!has_format_) refuse_model(path_, "the PLY header names no format");
        header_.body = text_.size() - rest.size();
        return std::move(header_);
      }
      read_line(keyword, line);
    }
    refuse_model(path_, "the PLY header does not end");
  }

 private:
  // The body may begin with a byte that looks like a line's end: the header's own lines end as its
  // first one does.
  std::string_view take_header_line(std::string_view& rest) const {
    const std::size_t first = text_.find_first_of("\r\n");
    const bool carriage = text_[first] == '\r' && text_.substr(first, 2) != "\r\n";
    const std::size_t end = rest.find(carriage ? '\r' : '\n');
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  void read_line(std::string_view keyword, std::string_view line) {
    if (keyword == "format") {
      read_format(take_word(line));
    } else if (keyword == "element") {
      PlyElement element;
      element.name = std::string(take_word(line).substr(0, 100));
      if (!parse_integer(take_word(line), element.count) || element.count < 0)
        refuse_model(path_,
                     fmt::format("PLY element '{}' has no valid count", shown(element.name)));
      header_.elements.push_back(element);
    } else if (keyword == "property") {
      if (header_.elements.empty()) refuse_model(path_, "a PLY property precedes every element");
      PlyElement& element = header_.elements.back();
      element.properties.push_back(property(line));
      element.properties.back().use = use_of(element.name, element.properties.back());
    } else if (keyword == "comment" || keyword == "obj_info") {
      if (lower(take_word(line)) == "texturefile" && !trimmed(line).empty())
        header_.pictures.emplace_back(unquoted(trimmed(line)).substr(0, 900));
    } else if (!keyword.empty()) {
      refuse_model(path_, "the PLY header is damaged");
    }
  }

  void read_format(std::string_view format) {
    has_format_ = true;
    if (format == "ascii") {
      header_.coding = Coding::kText;
    } else if (format == "binary_little_endian") {
      header_.coding = Coding::kLittle;
    } else if (format == "binary_big_endian") {
      header_.coding = Coding::kBig;
    } else {
      refuse_model(path_, fmt::format("unknown PLY format '{}'", shown(format)));
    }
  }

  PlyProperty property(std::string_view line) const {
    PlyProperty property;
    std::string_view word = take_word(line);
    if (word == "list") {
      property.list = true;
      property.count = type(take_word(line));
      if (property.count.floating) refuse_model(path_, "a PLY list is counted by a fraction");
      word = take_word(line);
    }
    property.type = type(word);
    property.name = std::string(take_word(line).substr(0, 100));
    if (property.name.empty()) refuse_model(path_, "a PLY property has no name");
    return property;
  }

  const PlyType& type(std::string_view name) const {
    for (const PlyType& type : kTypes)
      if (name == type.name) return type;
    refuse_model(path_, fmt::format("'{}' is not a PLY number type", shown(name)));
  }

  const std::string& path_;
  std::string_view text_;
  PlyHeader header_;
  bool has_format_ = false;
};

// ---- body ---------------------------------------------------------------------------------------

// Reads numbers one after the other, from text or from binary data.
class Body {
 public:
  Body(const std::string& path, const PlyHeader& header, std::string_view text)
      : path_(path), coding_(header.coding), text_(text.substr(header.body)) {}

  std::size_t left() const { return text_.size(); }
  bool is_text() const { return coding_ == Coding::kText; }

  // A binary float may be no finite number; only positions must be.
  double number(const PlyType& type) { return is_text() ? from_text(type) : from_bytes(type); }

 private:
  double from_text(const PlyType& type) {
    const std::string_view word = take_word(text_);
    if (word.empty()) refuse_model(path_, "the file ends too early");
    double exact = 0;
    float single = 0;
    const bool good = type.floating && type.bytes == 4 ? parse_coordinate(word, single)
                                                       : parse_number(word, exact);
    if (!good) refuse_model(path_, fmt::format("'{}' is not a finite number", shown(word)));
    return type.floating && type.bytes == 4 ? double(single) : exact;
  }

  double from_bytes(const PlyType& type) {
    const auto bytes = std::size_t(type.bytes);
    if (text_.size() < bytes) refuse_model(path_, "the file ends too early");
    std::array<unsigned char, 8> raw{};
    for (std::size_t i = 0; i < bytes; ++i)
      raw[i] = static_cast<unsigned char>(text_[coding_ == Coding::kBig ? bytes - 1 - i : i]);
    text_.remove_prefix(bytes);
    if (type.floating) return type.bytes == 4 ? as<float>(raw) : as<double>(raw);
    switch (type.bytes) {
      case 1:
        return type.is_signed ? as<std::int8_t>(raw) : as<std::uint8_t>(raw);
      case 2:
        return type.is_signed ? as<std::int16_t>(raw) : as<std::uint16_t>(raw);
      default:
        return type.is_signed ? as<std::int32_t>(raw) : as<std::uint32_t>(raw);
    }
  }

  template <typename T>
  static double as(const std::array<unsigned char, 8>& raw) {
    T value;
    std::memcpy(&value, raw.data(), sizeof value);
    return double(value);
  }

  const std::string& path_;
  Coding coding_;
  std::string_view text_;
};

// Colours: whole numbers fill their type's range, fractions go to 1.
float color_scale(const PlyType& type) {
  if (type.floating) return 1;
  return type.bytes == 1 ? 255 : type.bytes == 2 ? 65535 : 255;
}

// How much brighter colours of that type are if they are counted up to 255 all the same.
float guess_of(const PlyType& type) {
  return type.floating ? 1.0F / 255 : type.bytes == 2 ? 65535.0F / 255 : 1;
}

// ---- rows ---------------------------------------------------------------------------------------

class PlyReader {
 public:
  explicit PlyReader(const ModelInput& input)
      : input_(input),
        header_(HeaderReader(input.path, text_of(input.bytes)).run()),
        body_(input.path, header_, text_of(input.bytes)),
        cancel_(input.context) {}

  ModelFile run() {
    std::int64_t faces = 0;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") vertices_ += element.count;
      if (element.name == "face" || element.name == "tristrips") faces += element.count;
    }
    if (vertices_ == 0 || faces == 0) refuse_model(input_.path, "it has no triangles");
    make_materials();
    for (const PlyElement& element : header_.elements) read_element(element);
    if (file_.face_end.empty()) refuse_model(input_.path, "it has no triangles");
    check_indices();
    resolve_colors();
    resolve_coordinates();
    return std::move(file_);
  }

 private:
  // One per picture; a face without coordinates shows the plain one.
  void make_materials() {
    for (const std::string& name : header_.pictures) {
      FileMaterial material;
      material.picture = std::int32_t(file_.pictures.size());
      file_.materials.push_back(material);
      file_.pictures.push_back({file_name(name), input_.name, false, {}, ""});
    }
  }

  // MeshLab writes "<this>" for the model's own name.
  std::string file_name(const std::string& name) const {
    constexpr std::string_view kThis = "<this>";
    if (!name.starts_with(kThis)) return name;
    return input_.name.substr(0, input_.name.rfind('.')) + name.substr(kThis.size());
  }

  void read_element(const PlyElement& element) {
    check_promise(element);
    const bool vertex = element.name == "vertex";
    has_vertex_colors_ = has_vertex_colors_ || (vertex && uses(element, Use::kRed));
    has_face_colors_ = has_face_colors_ || (!vertex && uses(element, Use::kRed));
    has_vertex_uvs_ =
        has_vertex_uvs_ || (vertex && uses(element, Use::kU) && uses(element, Use::kV));
    if (vertex) file_.positions.reserve(std::size_t(element.count));
    // Rows without anything in them take no place in a binary file, however many there are.
    if (element.properties.empty()) return;
    for (std::int64_t row = 0; row < element.count; ++row) {
      cancel_();
      read_row(element, row);
      if (vertex) {
        end_vertex();
      } else if (element.name == "face") {
        end_face(row);
      }
    }
  }

  static bool uses(const PlyElement& element, Use use) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [&](const PlyProperty& property) { return property.use == use; });
  }

  void check_promise(const PlyElement& element) const {
    std::size_t row_bytes = 0;
    for (const PlyProperty& property : element.properties) {
      row_bytes += std::size_t(body_.is_text() ? 2
                               : property.list ? property.count.bytes
                                               : property.type.bytes);
    }
    if (element.name == "vertex" && row_bytes == 0)
      refuse_model(input_.path, "its vertices have no coordinates");
    // The last number of a text file needs no blank after it.
    if (double(element.count) * double(row_bytes) > double(body_.left()) + 1)
      refuse_model(input_.path,
                   fmt::format("the header promises {} of element '{}', more than the file holds",
                               element.count, shown(element.name)));
    check_count(input_.path, std::size_t(element.count));
  }

  void read_row(const PlyElement& element, std::int64_t row) {
    row_ = Row();
    for (const PlyProperty& property : element.properties) {
      if (property.list) {
        read_list(property, row);
      } else {
        take(property, body_.number(property.type));
      }
    }
  }

  struct Row {
    std::array<double, 3> position{};
    std::array<float, 2> uv{};
    std::array<float, 4> color{1, 1, 1, 1};
    std::int64_t texnumber = 0;
    std::size_t corners = 0;  // of them, at the end of file_.corners
    std::vector<float> texcoords;
  };

  void take(const PlyProperty& property, double value) {
    switch (property.use) {
      case Use::kX:
      case Use::kY:
      case Use::kZ:
        row_.position[std::size_t(property.use) - std::size_t(Use::kX)] = value;
        break;
      case Use::kU:
      case Use::kV:
        row_.uv[std::size_t(property.use) - std::size_t(Use::kU)] = float(value);
        break;
      case Use::kRed:
      case Use::kGreen:
      case Use::kBlue:
      case Use::kAlpha:
        row_.color[std::size_t(property.use) - std::size_t(Use::kRed)] =
            float(value) / color_scale(property.type);
        most_color_ = std::max(most_color_, value);
        states_alpha_ = states_alpha_ || property.use == Use::kAlpha;
        if (property.type.bytes != 1) color_guess_ = guess_of(property.type);
        break;
      case Use::kTexnumber:
        row_.texnumber = value >= 0 && value < 1e9 ? std::int64_t(value) : -1;
        break;
      default:
        break;
    }
  }

  void read_list(const PlyProperty& property, std::int64_t row) {
    const double count = body_.number(property.count);
    if (!(count >= 0) || count > double(body_.left()))
      refuse_model(input_.path, "a PLY list is longer than the file");
    for (double i = 0; i < count; ++i) {
      cancel_();
      const double value = body_.number(property.type);
      if (property.use == Use::kVertexIndices) {
        add_corner(value, row);
      } else if (property.use == Use::kTexcoords) {
        row_.texcoords.push_back(float(value));
      } else if (property.use == Use::kStrips) {
        add_to_strip(value, row);
      }
    }
    strip_.clear();
  }

  void add_corner(double value, std::int64_t row) {
    if (!(value >= 0) || value >= double(vertices_))
      refuse_model(input_.path,
                   fmt::format("face {} refers to vertex {:.0f}, but the file has vertices 0 to {}",
                               row, value, vertices_ - 1));
    check_count(input_.path, file_.corners.size());
    file_.corners.push_back(std::int32_t(value));
    ++row_.corners;
  }

  // Each number after the second makes a triangle; -1 starts anew.
  void add_to_strip(double value, std::int64_t row) {
    if (value == -1) {
      strip_.clear();
      return;
    }
    strip_.push_back(value);
    if (strip_.size() < 3) return;
    const std::size_t last = strip_.size() - 1;
    const bool odd = last % 2 == 1;
    for (const std::size_t at : {last - 2, odd ? last : last - 1, odd ? last - 1 : last})
      add_corner(strip_[at], row);
    file_.end_face(file_.materials.empty() ? -1 : 0);
  }

  void end_vertex() {
    const Vec3 position(row_.position[0], row_.position[1], row_.position[2]);
    file_.positions.push_back(position.cast<float>().cast<double>());
    if (has_vertex_colors_) vertex_colors_.push_back(row_.color);
    if (has_vertex_uvs_) vertex_uvs_.emplace_back(row_.uv[0], row_.uv[1]);
  }

  void end_face(std::int64_t row) {
    if (row_.corners < 3) {  // a point or a line
      file_.corners.resize(file_.corners.size() - row_.corners);
      if (wedge_uvs_.size() > file_.corners.size())
        wedge_uvs_.resize(file_.corners.size(), no_uv());
      return;
    }
    if (!row_.texcoords.empty()) {
      if (row_.texcoords.size() != 2 * row_.corners)
        refuse_model(input_.path, fmt::format("face {} has {} corners and {} texture coordinates",
                                              row, row_.corners, row_.texcoords.size() / 2));
      wedge_uvs_.resize(file_.corners.size() - row_.corners, no_uv());
      for (std::size_t c = 0; c < row_.corners; ++c)
        wedge_uvs_.emplace_back(row_.texcoords[2 * c], row_.texcoords[2 * c + 1]);
    }
    const auto pictures = std::int64_t(file_.materials.size());
    file_.end_face(row_.texnumber < pictures ? std::int32_t(row_.texnumber) : -1);
    if (!has_face_colors_) return;
    face_colors_.resize(file_.face_end.size() - 1, {1, 1, 1, 1});
    face_colors_.push_back(row_.color);
  }

  static Eigen::Vector2f no_uv() { return {ModelFile::kNoUv, 0}; }

  // Faces may come before the vertices, and vertices in several elements.
  void check_indices() const {
    for (const std::int32_t v : file_.corners)
      if (std::size_t(v) >= file_.positions.size())
        refuse_model(input_.path, fmt::format("a face refers to vertex {}, but the file has {}", v,
                                              file_.positions.size()));
  }

  // Some count fractions, or two bytes, up to 255.
  void recount_colors() {
    const bool up_to_255 =
        color_guess_ < 1 ? most_color_ > 2 : color_guess_ > 1 && most_color_ <= 255;
    if (!up_to_255 || most_color_ <= 1) return;
    for (auto* colors : {&vertex_colors_, &face_colors_})
      for (auto& color : *colors)
        for (std::size_t c = 0; c < (states_alpha_ ? 4U : 3U); ++c) color[c] *= color_guess_;
  }

  // Vertex colours win over face colours. An alpha that is 0 everywhere was never meant.
  void resolve_colors() {
    recount_colors();
    if (has_vertex_colors_) {
      const std::vector<LinearColor> colors = linear(vertex_colors_);
      if (colors.size() != file_.positions.size()) return;
      file_.colors.reserve(file_.corners.size());
      for (const std::int32_t v : file_.corners) file_.colors.push_back(colors[std::size_t(v)]);
    } else if (has_face_colors_) {
      face_colors_.resize(file_.face_end.size(), {1, 1, 1, 1});
      const std::vector<LinearColor> colors = linear(face_colors_);
      file_.colors.reserve(file_.corners.size());
      for (std::size_t f = 0; f < colors.size(); ++f)
        file_.colors.resize(file_.face_end[f], colors[f]);
    }
  }

  std::vector<LinearColor> linear(const std::vector<std::array<float, 4>>& encoded) {
    const bool has_alpha = std::any_of(encoded.begin(), encoded.end(),
                                       [](const auto& color) { return color[3] != 0; });
    std::vector<LinearColor> colors;
    colors.reserve(encoded.size());
    for (const auto& c : encoded) {
      cancel_();
      colors.push_back(linear_from_srgb(c[0], c[1], c[2], has_alpha ? c[3] : 1));
    }
    return colors;
  }

  // A face's own coordinates know about seams, those of vertices do not.
  void resolve_coordinates() {
    if (!wedge_uvs_.empty()) {
      wedge_uvs_.resize(file_.corners.size(), no_uv());
      file_.uvs = std::move(wedge_uvs_);
    } else if (has_vertex_uvs_ && vertex_uvs_.size() == file_.positions.size()) {
      file_.uvs.reserve(file_.corners.size());
      for (const std::int32_t v : file_.corners) file_.uvs.push_back(vertex_uvs_[std::size_t(v)]);
    }
  }

  const ModelInput& input_;
  PlyHeader header_;
  Body body_;
  CancelCheck cancel_;
  std::int64_t vertices_ = 0;
  bool has_vertex_colors_ = false, has_face_colors_ = false, has_vertex_uvs_ = false;
  Row row_;
  std::vector<double> strip_;
  std::vector<std::array<float, 4>> vertex_colors_, face_colors_;
  double most_color_ = 0;  // as the file has it
  float color_guess_ = 1;
  bool states_alpha_ = false;
  std::vector<Eigen::Vector2f> vertex_uvs_, wedge_uvs_;
  ModelFile file_;
};

}  // namespace

ModelFile read_ply(const ModelInput& input) { return PlyReader(input).run(); }

}  // namespace hydrodip
