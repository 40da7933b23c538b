// Geomview's OFF, as text.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "model_io/model_file.h"
#include "model_io/text.h"

namespace hydrodip {

namespace {

class OffReader {
 public:
  explicit OffReader(const ModelInput& input)
      : input_(input), rest_(without_bom(text_of(input.bytes))), cancel_(input.context) {}

  ModelFile run() {
    if (text_of(input_.bytes).find('\0') != std::string_view::npos)
      refuse_model(input_.path, "not OFF text, it contains binary data");
    std::string_view line = next();
    read_header(line);
    if (trimmed(line).empty()) line = next();
    read_counts(line);
    file_.positions.reserve(std::size_t(vertices_));
    for (std::int64_t i = 0; i < vertices_; ++i) read_vertex(next());
    file_.reserve(std::size_t(faces_), std::size_t(3 * faces_));
    for (std::int64_t i = 0; i < faces_; ++i) read_face(next());
    if (file_.face_end.empty()) refuse_model(input_.path, "it has no faces");
    resolve_colors();
    resolve_coordinates();
    return std::move(file_);
  }

 private:
  // The next line without comments that is not blank.
  std::string_view next() {
    while (!rest_.empty()) {
      cancel_();
      std::string_view line = take_line(rest_);
      ++number_;
      line = line.substr(0, line.find('#'));
      if (!trimmed(line).empty()) return line;
    }
    refuse_model(input_.path, "the file ends too early");
  }

  // "[ST][C][N][4]OFF", and what follows it on the line ("OFF490 518 0" is common).
  void read_header(std::string_view& line) {
    line = trimmed(line);
    const std::size_t off = line.find("OFF");
    std::string_view flags = line.substr(0, off == std::string_view::npos ? 0 : off);
    const auto takes = [&](std::string_view flag) {
      if (flags.substr(0, flag.size()) != flag) return false;
      flags.remove_prefix(flag.size());
      return true;
    };
    has_coordinates_ = takes("ST");
    has_colors_ = takes("C");
    has_normals_ = takes("N");
    has_weights_ = takes("4");
    if (off == std::string_view::npos || !flags.empty())
      refuse_model(input_.path,
                   "not an OFF file that can be read, it does not begin with OFF, COFF, NOFF, "
                   "CNOFF or STOFF");
    line.remove_prefix(off + 3);
    std::string_view words = line;
    if (lower(take_word(words)) == "binary")
      refuse_model(input_.path, "binary OFF files are not read; export it as text");
  }

  void read_counts(std::string_view line) {
    if (!parse_integer(take_word(line), vertices_) || !parse_integer(take_word(line), faces_) ||
        vertices_ <= 0 || faces_ <= 0)
      refuse_line(input_.path, number_, "the numbers of vertices and faces are missing");
    if (double(vertices_) * 6 + double(faces_) * 4 > double(rest_.size()) + 2)
      refuse_model(input_.path, fmt::format("the header promises {} vertices and {} faces, more "
                                            "than the file holds",
                                            vertices_, faces_));
    check_count(input_.path, std::size_t(vertices_));
  }

  float number(std::string_view word) const {
    float value = 0;
    if (!parse_coordinate(word, value))
      refuse_line(input_.path, number_, fmt::format("'{}' is not a finite number", shown(word)));
    return value;
  }

  // x y z [w] [normal] [r g b a] [u v]
  void read_vertex(std::string_view line) {
    std::array<float, 13> n{};
    std::size_t count = 0;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      const float value = number(word);
      if (count < n.size()) n[count] = value;
      ++count;
    }
    std::size_t at = has_weights_ ? 4 : 3;
    const std::size_t needed =
        at + (has_normals_ ? 3 : 0) + (has_colors_ ? 3 : 0) + (has_coordinates_ ? 2 : 0);
    if (count < needed)
      refuse_line(input_.path, number_, fmt::format("a vertex needs {} numbers", needed));
    if (has_weights_ && n[3] == 0)
      refuse_line(input_.path, number_, "a vertex whose weight w is 0 has no place");
    const float weight = has_weights_ ? n[3] : 1;
    file_.positions.emplace_back(n[0] / weight, n[1] / weight, n[2] / weight);
    if (has_normals_) at += 3;
    if (has_colors_) {
      const bool alpha = count >= needed + 1;
      vertex_colors_.push_back({n[at], n[at + 1], n[at + 2], alpha ? n[at + 3] : kNoAlpha});
      at += alpha ? 4 : 3;
    }
    if (has_coordinates_) uvs_.emplace_back(n[at], n[at + 1]);
  }

  // corners, then a colour: nothing, a number in a map (which nobody has), or r g b [a].
  void read_face(std::string_view line) {
    std::int64_t corners = 0;
    if (!parse_integer(take_word(line), corners) || corners < 1)
      refuse_line(input_.path, number_, "a face must begin with its number of corners");
    const std::size_t begin = file_.corners.size();
    for (std::int64_t i = 0; i < corners; ++i) {
      cancel_();
      std::int64_t index = -1;
      if (!parse_integer(take_word(line), index))
        refuse_line(input_.path, number_, fmt::format("a face needs {} vertex numbers", corners));
      if (index < 0 || index >= vertices_)
        refuse_line(input_.path, number_,
                    fmt::format("a face refers to vertex {}, but the file has vertices 0 to {}",
                                index, vertices_ - 1));
      file_.corners.push_back(std::int32_t(index));
    }
    if (corners < 3) {
      file_.corners.resize(begin);
      return;
    }
    check_count(input_.path, file_.corners.size());
    file_.end_face();
    read_face_color(line);
  }

  void read_face_color(std::string_view line) {
    std::array<float, 4> color{0, 0, 0, kNoAlpha};
    std::size_t count = 0;
    bool fractions = false;
    for (std::string_view word = take_word(line); !word.empty() && count < 4;
         word = take_word(line)) {
      fractions = fractions || word.find('.') != std::string_view::npos;
      double value = 0;
      if (!parse_number(word, value)) return;
      color[count++] = float(value);
    }
    if (count < 3) return;
    // Here the format does say: whole numbers go to 255.
    if (!fractions)
      for (std::size_t c = 0; c < count; ++c) color[c] /= 255;
    face_colors_.resize(file_.face_end.size() - 1, {1, 1, 1, 1});
    face_colors_.push_back(color);
  }

  static LinearColor linear(const std::array<float, 4>& c, float scale) {
    const float alpha = c[3] == kNoAlpha ? 1 : c[3] > 1 ? c[3] * scale : c[3];
    return linear_from_srgb(c[0] * scale, c[1] * scale, c[2] * scale, alpha);
  }

  // Vertex colours win over face colours. The format does not say how far their numbers go.
  void resolve_colors() {
    if (has_colors_) {
      bool bytes = false;
      for (const auto& c : vertex_colors_) bytes = bytes || c[0] > 1 || c[1] > 1 || c[2] > 1;
      std::vector<LinearColor> colors;
      colors.reserve(vertex_colors_.size());
      for (const auto& c : vertex_colors_) {
        cancel_();
        colors.push_back(linear(c, bytes ? 1.0F / 255 : 1));
      }
      for (const std::int32_t v : file_.corners) file_.colors.push_back(colors[std::size_t(v)]);
    } else if (!face_colors_.empty()) {
      face_colors_.resize(file_.face_end.size(), {1, 1, 1, 1});
      for (std::size_t f = 0; f < face_colors_.size(); ++f)
        file_.colors.resize(file_.face_end[f], linear(face_colors_[f], 1));
    }
  }

  void resolve_coordinates() {
    if (!has_coordinates_) return;
    for (const std::int32_t v : file_.corners) file_.uvs.push_back(uvs_[std::size_t(v)]);
  }

  static constexpr float kNoAlpha = -1;

  const ModelInput& input_;
  std::string_view rest_;
  CancelCheck cancel_;
  long number_ = 0;
  std::int64_t vertices_ = 0, faces_ = 0;
  bool has_coordinates_ = false, has_colors_ = false, has_normals_ = false, has_weights_ = false;
  std::vector<std::array<float, 4>> vertex_colors_, face_colors_;
  std::vector<Eigen::Vector2f> uvs_;
  ModelFile file_;
};

}  // namespace

ModelFile read_off(const ModelInput& input) { return OffReader(input).run(); }

}  // namespace hydrodip
