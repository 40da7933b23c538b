// Wavefront OBJ.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "base/unicode.h"
#include "model_io/model_file.h"
#include "model_io/mtl.h"
#include "model_io/text.h"

namespace hydrodip {

namespace {

// One kind of list that faces index: v, vt or vn.
struct ObjList {
  const char* what;
  std::int64_t count = 0;
  std::int64_t highest = 0;  // highest index used, and where
  long highest_line = 0;
};

class ObjReader {
 public:
  explicit ObjReader(const ModelInput& input)
      : input_(input), rest_(without_bom(text_of(input.bytes))), cancel_(input.context) {}

  ModelFile run() {
    if (text_of(input_.bytes).find('\0') != std::string_view::npos)
      refuse_model(input_.path, "not OBJ text, it contains binary data");
    while (!rest_.empty()) {
      cancel_();
      read_line(next_line());
    }
    for (const ObjList& list : lists_) {
      if (list.highest <= list.count) continue;
      refuse_line(input_.path, list.highest_line,
                  fmt::format("a face refers to {} {}, but the file has {}", list.what,
                              list.highest, list.count));
    }
    if (file_.face_end.empty()) refuse_model(input_.path, "it has no faces");
    resolve_coordinates();
    resolve_colors();
    warn_of_undefined_materials();
    return std::move(file_);
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
    if (!word.empty() && word[0] == '#') return {};
    return word;
  }

  void read_line(std::string_view line) {
    const std::string_view keyword = take(line);
    if (keyword == "v") {
      read_vertex(line);
    } else if (keyword == "vt") {
      read_coordinates(line);
    } else if (keyword == "vn") {
      ++lists_[2].count;
    } else if (keyword == "f" || keyword == "fo") {
      read_face(line);
    } else if (keyword == "usemtl") {
      material_ = material_index(trimmed(line));
    } else if (keyword == "mtllib") {
      read_libraries(line);
    }
  }

  // Up to `most` numbers of the line; how many there are.
  int numbers(std::string_view line, float* values, int most, int needed) {
    int count = 0;
    for (std::string_view word = take(line); !word.empty(); word = take(line)) {
      float value = 0;
      if (!parse_coordinate(word, value))
        refuse_line(input_.path, first_line_,
                    fmt::format("'{}' is not a finite number", shown(word)));
      if (count < most) values[count] = value;
      ++count;
    }
    if (count < needed)
      refuse_line(input_.path, first_line_,
                  fmt::format("{} numbers where {} are needed", count, needed));
    return count;
  }

  // x y z, x y z w, or x y z r g b.
  void read_vertex(std::string_view line) {
    std::array<float, 6> n{};
    const int count = numbers(line, n.data(), 6, 3);
    if (count == 4) {
      if (n[3] == 0)
        refuse_line(input_.path, first_line_, "a vertex whose weight w is 0 has no place");
      for (std::size_t i = 0; i < 3; ++i) n[i] /= n[3];
    }
    file_.positions.emplace_back(n[0], n[1], n[2]);
    check_count(input_.path, file_.positions.size());
    ++lists_[0].count;
    if (count >= 6) {
      vertex_colors_.resize(file_.positions.size() - 1, {1, 1, 1});
      vertex_colors_.push_back({n[3], n[4], n[5]});
    }
  }

  void read_coordinates(std::string_view line) {
    std::array<float, 2> uv{};
    numbers(line, uv.data(), 2, 1);
    uvs_.emplace_back(uv[0], uv[1]);
    ++lists_[1].count;
  }

  // Lines and points, of fewer corners, are no faces.
  void read_face(std::string_view line) {
    const std::size_t begin = file_.corners.size();
    for (std::string_view word = take(line); !word.empty(); word = take(line)) {
      cancel_();
      read_corner(word);
    }
    if (file_.corners.size() < begin + 3) {
      file_.corners.resize(begin);
      if (!uv_of_.empty()) uv_of_.resize(begin, -1);
      return;
    }
    check_count(input_.path, file_.corners.size());
    file_.end_face(material_);
  }

  // "v", "v/vt", "v//vn" or "v/vt/vn".
  void read_corner(std::string_view word) {
    std::array<std::int64_t, 3> found{-1, -1, -1};
    std::string_view rest = word;
    for (std::size_t kind = 0;; ++kind) {
      if (kind == 3) refuse_corner(word);
      const std::size_t slash = rest.find('/');
      const std::string_view part = rest.substr(0, slash);
      if (!part.empty() || kind == 0) found[kind] = index(lists_[kind], part, word);
      if (slash == std::string_view::npos) break;
      rest.remove_prefix(slash + 1);
    }
    file_.corners.push_back(std::int32_t(found[0]));
    if (found[1] >= 0 || !uv_of_.empty()) {
      uv_of_.resize(file_.corners.size() - 1, -1);
      uv_of_.push_back(std::int32_t(found[1]));
    }
  }

  [[noreturn]] void refuse_corner(std::string_view word) const {
    refuse_line(input_.path, first_line_, fmt::format("'{}' is not a face corner", shown(word)));
  }

  // From 0. Entries may come after the faces that use them.
  std::int64_t index(ObjList& list, std::string_view part, std::string_view word) const {
    std::int64_t index = 0;
    if (!parse_integer(part, index) || index == 0) refuse_corner(word);
    if (index < -list.count)
      refuse_line(input_.path, first_line_,
                  fmt::format("a face refers to {} {}, counted from the last, but only {} came "
                              "before",
                              list.what, index, list.count));
    if (index < 0) return list.count + index;
    if (index > list.highest) {
      list.highest = index;
      list.highest_line = first_line_;
    }
    // More than the file can hold is refused at its end.
    return std::min<std::int64_t>(index, std::int64_t(1) << 30) - 1;
  }

  std::int32_t material_index(std::string_view name) {
    const auto [known, is_new] =
        material_named_.try_emplace(std::string(name), std::int32_t(file_.materials.size()));
    if (is_new) {
      file_.materials.emplace_back();
      file_.materials.back().name = std::string(name.substr(0, 900));
      defined_.push_back(0);
    }
    return known->second;
  }

  // Names may have blanks, and a line several names.
  void read_libraries(std::string_view line) {
    const std::string whole(unquoted(trimmed(line)));
    if (whole.empty() || read_library(whole)) return;
    bool found = false;
    std::vector<std::string> missing;
    std::string_view rest = line;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      if (read_library(std::string(word))) {
        found = true;
      } else {
        missing.emplace_back(word);
      }
    }
    if (!found) missing.assign(1, whole);
    for (const std::string& name : missing) warn_of_library(name);
  }

  bool read_library(const std::string& name) {
    const std::string file = input_.side_files.identity(name);
    if (libraries_.contains(file)) return true;
    auto bytes = input_.side_files.read(name);
    if (!bytes) return false;
    libraries_.insert(file);
    for (MtlMaterial& found : read_mtl(name, in_utf8(std::move(*bytes)), input_.context)) {
      const std::int32_t number = material_index(found.material.name);
      // The first definition of a name counts.
      if (std::exchange(defined_[std::size_t(number)], char(1))) continue;
      if (!found.picture.empty()) {
        found.material.picture = std::int32_t(file_.pictures.size());
        file_.pictures.push_back({found.picture, name, false, {}, ""});
        // The others of the library may be shown or not.
        if (input_.expected != nullptr && found.material.picture == 0)
          input_.expected->expect(file_.pictures.front(), found.material);
      }
      file_.materials[std::size_t(number)] = std::move(found.material);
    }
    return true;
  }

  // A library under the model's own name is meant where files were renamed.
  void warn_of_library(const std::string& name) {
    constexpr int kMost = 20;
    if (++missing_libraries_ > kMost) return;
    const std::string sentence =
        fmt::format("The file {} that {} refers to is missing; put it beside the model.",
                    name.substr(0, 200), input_.name);
    input_.context.warn(sentence);
    if (missing_libraries_ == kMost)
      input_.context.warn("More material libraries may be missing than are named here.");
    if (!read_library(input_.name.substr(0, input_.name.rfind('.')) + ".mtl"))
      file_.color_problems.push_back(sentence);
  }

  void resolve_coordinates() {
    if (uv_of_.empty()) return;
    uv_of_.resize(file_.corners.size(), -1);
    file_.uvs.reserve(uv_of_.size());
    for (const std::int32_t index : uv_of_) {
      cancel_();
      file_.uvs.push_back(index < 0 ? Eigen::Vector2f(ModelFile::kNoUv, 0)
                                    : uvs_[std::size_t(index)]);
    }
  }

  // Some write 0 to 255.
  void resolve_colors() {
    if (vertex_colors_.empty()) return;
    vertex_colors_.resize(file_.positions.size(), {1, 1, 1});
    float most = 0;
    for (const auto& color : vertex_colors_) most = std::max({most, color[0], color[1], color[2]});
    const float scale = most > 2 ? 1.0F / 255 : 1;
    std::vector<LinearColor> linear;
    linear.reserve(vertex_colors_.size());
    for (const auto& c : vertex_colors_) {
      cancel_();
      linear.push_back(linear_from_srgb(c[0] * scale, c[1] * scale, c[2] * scale, 1));
    }
    file_.colors.reserve(file_.corners.size());
    for (const std::int32_t v : file_.corners) file_.colors.push_back(linear[std::size_t(v)]);
  }

  void warn_of_undefined_materials() const {
    if (libraries_.empty()) return;
    std::string names;
    int count = 0;
    for (std::size_t m = 0; m < defined_.size(); ++m) {
      if (defined_[m] || ++count > 3) continue;
      const std::string& name = file_.materials[m].name;
      names += (names.empty() ? "" : ", ") + (name.empty() ? "without a name" : shown(name));
    }
    if (count > 0)
      input_.context.warn(
          fmt::format("{} uses {} that no material library defines ({}{}); they are white.",
                      input_.name, count == 1 ? "a material" : fmt::format("{} materials", count),
                      names, count > 3 ? ", ..." : ""));
  }

  const ModelInput& input_;
  std::string_view rest_;
  CancelCheck cancel_;
  long line_ = 0;
  long first_line_ = 0;
  ModelFile file_;
  std::int32_t material_ = -1;
  std::vector<Eigen::Vector2f> uvs_;
  std::vector<std::int32_t> uv_of_;  // per corner, -1: none; empty while no corner has any
  std::vector<std::array<float, 3>> vertex_colors_;
  std::unordered_map<std::string, std::int32_t> material_named_;
  std::vector<char> defined_;                  // per material: whether a library says what it is
  std::unordered_set<std::string> libraries_;  // files that were read
  int missing_libraries_ = 0;
  std::array<ObjList, 3> lists_{{{"vertex"}, {"texture coordinate"}, {"normal"}}};
};

}  // namespace

ModelFile read_obj(const ModelInput& input) { return ObjReader(input).run(); }

}  // namespace hydrodip
