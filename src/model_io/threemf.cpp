// 3MF: core, materials and production extensions; slices and beam lattices are passed over.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "base/error.h"
#include "model_io/model_file.h"
#include "model_io/package.h"
#include "model_io/slicer_parts.h"
#include "model_io/text.h"

namespace hydrodip {

namespace {

using Eigen::Matrix4f;
using Rgba = std::array<std::uint8_t, 4>;

// What a property group says of a triangle's corner.
struct Entry {
  Rgba color{255, 255, 255, 255};
  std::int32_t material = -1;  // with a picture, or -1
  Eigen::Vector2f uv{ModelFile::kNoUv, 0};
};

using Group = std::vector<Entry>;

struct MeshTriangle {
  std::array<std::int32_t, 3> corners;
  std::int32_t group = -1;  // into Part::groups
  std::array<std::int32_t, 3> entries{};
};

struct Component {
  std::string path;  // of the part that holds the object, "" for this one
  std::int64_t id = 0;
  Matrix4f transform;
};

struct Object3mf {
  bool printed = true;  // not a support
  std::vector<Eigen::Vector3f> vertices;
  std::vector<MeshTriangle> triangles;
  std::vector<Component> components;
};

// One .model file of the package.
struct Part {
  std::string units;
  std::map<std::int64_t, std::int32_t> group_of;  // by id, into groups
  std::vector<Group> groups;
  std::vector<bool> group_has_color;
  std::map<std::int64_t, Object3mf> objects;
  std::vector<Component> items, items_off;  // off: not to be printed, as slicers mark it
};

// What the reader tells about in the end.
struct LeftOut {
  std::int64_t painted = 0;  // triangles
  std::set<std::string> features;
  std::set<std::string> extensions;  // that the file requires
};

// Numbers of the file's pictures and their materials, shared by all parts.
class Textures {
 public:
  Textures(const ModelInput& input, Package& package, ModelFile& file)
      : input_(input), package_(package), file_(file) {}

  std::int32_t material(const std::string& path, Wrap wrap_u, Wrap wrap_v) {
    const auto [known, is_new] = known_.try_emplace(std::make_tuple(path, int(wrap_u), int(wrap_v)),
                                                    std::int32_t(file_.materials.size()));
    if (!is_new) return known->second;
    FileMaterial material;
    material.wrap_u = wrap_u;
    material.wrap_v = wrap_v;
    material.picture = picture(path);
    file_.materials.push_back(material);
    return known->second;
  }

 private:
  std::int32_t picture(const std::string& path) {
    const auto [known, is_new] = pictures_.try_emplace(path, std::int32_t(file_.pictures.size()));
    if (!is_new) return known->second;
    FilePicture out;
    out.embedded = true;
    out.asked_by = input_.name;
    out.name = fmt::format("{}, embedded texture {}", input_.name, path.substr(0, 200));
    const std::string stored = package_.find(path);
    if (stored.empty()) {
      out.problem = fmt::format("The texture {} that {} refers to is missing in it.",
                                path.substr(0, 200), input_.name);
    } else {
      out.bytes = package_.read(stored);
    }
    file_.pictures.push_back(std::move(out));
    return known->second;
  }

  const ModelInput& input_;
  Package& package_;
  ModelFile& file_;
  std::map<std::tuple<std::string, int, int>, std::int32_t> known_;
  std::map<std::string, std::int32_t> pictures_;
};

// ---- one part -----------------------------------------------------------------------------------

class PartReader {
 public:
  PartReader(const std::string& path, Package::Stream& stream, Textures& textures,
             LeftOut& left_out, const RunContext& context)
      : path_(path), tags_(path, stream, context), textures_(textures), left_out_(left_out) {}

  Part run() {
    Tag tag;
    while (tags_.next(tag)) {
      learn_namespaces(tag);
      const Space space = space_of(tag.prefix);
      if (tag.closing) {
        close(tag.name);
      } else if (space == Space::kForeign) {
        note_foreign(tag.name);
        tags_.skip_element(tag);
      } else {
        open(tag);
      }
    }
    if (part_.units.empty()) refuse("it holds no 3MF model");
    return std::move(part_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { refuse_model(path_, what); }

  // ---- namespaces

  enum class Space { kKnown, kForeign };

  void learn_namespaces(const Tag& tag) {
    for (const auto& [key, value] : tag.attributes) {
      if (!key.starts_with("xmlns")) continue;
      const bool known = value.find("/3dmanufacturing/core/") != std::string_view::npos ||
                         value.find("/3dmanufacturing/material/") != std::string_view::npos;
      foreign_[std::string(key.size() > 6 ? key.substr(6) : "")] = !known;
    }
  }

  // Files that declare nothing mean the core.
  Space space_of(std::string_view prefix) const {
    const auto known = foreign_.find(std::string(prefix));
    const bool foreign =
        known == foreign_.end() ? !prefix.empty() && !foreign_.empty() : known->second;
    return foreign ? Space::kForeign : Space::kKnown;
  }

  // What a file may require and still be dipped as it is: it places parts, slices them, or names
  // shapes that are left out and said.
  void note_required(const Tag& tag) {
    static constexpr std::string_view kMeant[] = {
        "/3dmanufacturing/core/",         "/3dmanufacturing/material/",
        "/3dmanufacturing/production/",   "/3dmanufacturing/slice/",
        "/3dmanufacturing/beamlattice/",  "/3dmanufacturing/booleanoperations/",
        "/3dmanufacturing/displacement/", "/3dmanufacturing/volumetric/",
        "/3dmanufacturing/trianglesets/"};
    const std::string prefixes = tag.text("requiredextensions");
    std::string_view rest = prefixes;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      const std::string space = tag.text("xmlns:" + std::string(word));
      const bool meant = std::any_of(
          std::begin(kMeant), std::end(kMeant),
          [&](std::string_view known) { return space.find(known) != std::string::npos; });
      if (!meant)
        left_out_.extensions.insert((space.empty() ? std::string(word) : space).substr(0, 120));
    }
  }

  void note_foreign(std::string_view name) {
    if (name == "beamlattice") left_out_.features.insert("beam lattices");
    if (name == "booleanshape") left_out_.features.insert("boolean shapes");
    if (name == "levelset" || name == "volumedata") left_out_.features.insert("volumes");
    if (name == "displacementmesh") left_out_.features.insert("displacements");
  }

  // ---- elements

  void open(const Tag& tag) {
    const std::string_view name = tag.name;
    if (name == "model") {
      read_units(tag);
    } else if (name == "texture2d") {
      read_texture(tag);
    } else if (name == "basematerials" || name == "colorgroup" || name == "texture2dgroup" ||
               name == "compositematerials" || name == "multiproperties") {
      open_group(tag);
    } else if (name == "base" || name == "color") {
      add_entry({color_of(tag.find(name == "base" ? "displaycolor" : "color")), -1, no_uv()});
    } else if (name == "tex2coord") {
      read_coordinates(tag);
    } else if (name == "composite") {
      read_composite(tag);
    } else if (name == "multi") {
      read_multi(tag);
    } else if (name == "object") {
      open_object(tag);
    } else if (name == "vertex") {
      read_vertex(tag);
    } else if (name == "triangle") {
      read_triangle(tag);
    } else if (name == "component") {
      if (!object_) refuse("a component outside an object");
      object_->components.push_back(placement(tag));
      count_placement();
    } else if (name == "item") {
      const bool is_off = tag.find("printable") && tag.text("printable") == "0";
      (is_off ? part_.items_off : part_.items).push_back(placement(tag));
      count_placement();
    }
  }

  void close(std::string_view name) {
    if (name == "object") object_ = nullptr;
    if (name == "basematerials" || name == "colorgroup" || name == "texture2dgroup" ||
        name == "compositematerials" || name == "multiproperties")
      group_ = -1;
  }

  void read_units(const Tag& tag) {
    if (!part_.units.empty()) refuse("it holds two models");
    part_.units = tag.find("unit") ? tag.text("unit") : "millimeter";
    static constexpr std::string_view kKnown[] = {"micron", "millimeter", "centimeter",
                                                  "inch",   "foot",       "meter"};
    if (std::find(std::begin(kKnown), std::end(kKnown), part_.units) == std::end(kKnown))
      refuse(fmt::format("unknown 3MF unit '{}'", shown(part_.units)));
    note_required(tag);
  }

  std::int32_t integer(const Tag& tag, std::string_view name) const {
    std::int64_t value = 0;
    const std::string_view* text = tag.find(name);
    if (!text || !parse_integer(*text, value) || value < 0 ||
        value > std::numeric_limits<std::int32_t>::max())
      refuse(fmt::format("<{}> has no valid '{}'", shown(tag.name), name));
    return std::int32_t(value);
  }

  float number(const Tag& tag, std::string_view name) const {
    double value = 0;
    const std::string_view* text = tag.find(name);
    if (!text || !parse_number(*text, value))
      refuse(fmt::format("a {}'s {} is not a finite number", shown(tag.name), name));
    return float(value);
  }

  // ---- colour

  static Eigen::Vector2f no_uv() { return {ModelFile::kNoUv, 0}; }

  Rgba color_of(const std::string_view* text) const {
    Rgba color{255, 255, 255, 255};
    if (!text) return color;
    bool good = (text->size() == 7 || text->size() == 9) && text->front() == '#';
    for (std::size_t c = 0; good && 2 * c + 2 < text->size(); ++c) {
      const char* digits = text->data() + 1 + 2 * c;
      const auto [end, error] = std::from_chars(digits, digits + 2, color[c], 16);
      good = error == std::errc() && end == digits + 2;
    }
    if (!good) refuse("a colour is not #RRGGBB or #RRGGBBAA");
    return color;
  }

  static Wrap wrap_of(const std::string& style) {
    if (style == "mirror") return Wrap::kMirror;
    if (style == "clamp") return Wrap::kClamp;
    return style == "none" ? Wrap::kDecal : Wrap::kRepeat;
  }

  void read_texture(const Tag& tag) {
    const std::int32_t id = integer(tag, "id");
    const std::string path = tag.text("path");
    if (path.empty()) refuse("a texture names no file");
    textures_of_[id] =
        textures_.material(path, wrap_of(tag.text("tilestyleu")), wrap_of(tag.text("tilestylev")));
  }

  void open_group(const Tag& tag) {
    const std::int32_t id = integer(tag, "id");
    group_ = std::int32_t(part_.groups.size());
    part_.group_of[id] = group_;
    part_.groups.emplace_back();
    part_.group_has_color.push_back(tag.name != "texture2dgroup");
    texture_ = -1;
    mixed_.clear();
    if (tag.name == "texture2dgroup") {
      const auto texture = textures_of_.find(integer(tag, "texid"));
      if (texture == textures_of_.end()) refuse("a texture group refers to no texture");
      texture_ = texture->second;
    } else if (tag.name == "compositematerials") {
      const std::int32_t base = group_number(integer(tag, "matid"));
      for (const std::int32_t index : integers(tag.text("matindices")))
        mixed_.emplace_back(base, index);
    } else if (tag.name == "multiproperties") {
      const std::vector<std::int32_t> layers = integers(tag.text("pids"));
      if (layers.size() > kMostLayers) refuse("a material has more layers than any");
      for (const std::int32_t layer : layers) mixed_.emplace_back(group_number(layer), 0);
    }
    if (tag.empty) group_ = -1;
  }

  static constexpr std::size_t kMostLayers = 100;

  std::int32_t group_number(std::int32_t id) const {
    const auto known = part_.group_of.find(id);
    return known == part_.group_of.end() ? -1 : known->second;
  }

  std::vector<std::int32_t> integers(const std::string& text) const {
    std::vector<std::int32_t> out;
    std::string_view rest = text;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      std::int64_t value = 0;
      if (!parse_integer(word, value) || value < 0 ||
          value > std::numeric_limits<std::int32_t>::max())
        refuse("a list of numbers is damaged");
      out.push_back(std::int32_t(value));
    }
    return out;
  }

  void add_entry(const Entry& entry) {
    if (group_ >= 0) part_.groups[std::size_t(group_)].push_back(entry);
  }

  void read_coordinates(const Tag& tag) {
    Entry entry;
    entry.material = texture_;
    entry.uv = {number(tag, "u"), number(tag, "v")};
    add_entry(entry);
  }

  const Entry& entry_of(std::int32_t group, std::int32_t index) const {
    const Group& entries = part_.groups[std::size_t(group)];
    if (std::size_t(index) >= entries.size())
      refuse(fmt::format("a triangle refers to entry {} of a material group, which has {}", index,
                         entries.size()));
    return entries[std::size_t(index)];
  }

  // Base materials in shares.
  void read_composite(const Tag& tag) {
    const std::string text = tag.text("values");
    std::string_view rest = text;
    std::array<double, 4> sum{};
    double total = 0;
    for (const auto& [group, index] : mixed_) {
      const std::string_view word = take_word(rest);
      if (word.empty()) break;
      double share = 0;
      if (!parse_number(word, share) || share < 0 || group < 0) continue;
      const Rgba& color = entry_of(group, index).color;
      for (std::size_t c = 0; c < 4; ++c) sum[c] += share * color[c];
      total += share;
    }
    Entry entry;
    for (std::size_t c = 0; total > 0 && c < 4; ++c)
      entry.color[c] = std::uint8_t(std::lround(std::min(sum[c] / total, 255.0)));
    add_entry(entry);
  }

  // Layers: the last one with a picture shows, else the last one with a colour.
  void read_multi(const Tag& tag) {
    const std::vector<std::int32_t> indices = integers(tag.text("pindices"));
    Entry entry;
    for (std::size_t layer = 0; layer < mixed_.size(); ++layer) {
      const std::int32_t group = mixed_[layer].first;
      if (group < 0) continue;
      const std::int32_t index = layer < indices.size() ? indices[layer] : 0;
      const Group& entries = part_.groups[std::size_t(group)];
      // The consortium's own samples have layers with fewer entries than are asked for.
      if (std::size_t(index) >= entries.size()) continue;
      const Entry& found = entries[std::size_t(index)];
      if (found.material >= 0 || entry.material < 0) entry = found;
    }
    add_entry(entry);
  }

  // ---- shape

  void open_object(const Tag& tag) {
    const std::int32_t id = integer(tag, "id");
    const auto [object, is_new] = part_.objects.try_emplace(id);
    if (!is_new || part_.group_of.contains(id))
      refuse(fmt::format("two resources share the id {}", id));
    object_ = tag.empty ? nullptr : &object->second;
    const std::string type = tag.text("type");
    object->second.printed = type != "support" && type != "solidsupport";
    object_group_ = -1;
    object_entry_ = 0;
    if (tag.find("pid") && tag.find("pindex")) {
      object_group_ = group_number(integer(tag, "pid"));
      object_entry_ = integer(tag, "pindex");
      if (object_group_ >= 0) entry_of(object_group_, object_entry_);
    }
  }

  void read_vertex(const Tag& tag) {
    if (!object_) refuse("a vertex outside an object");
    object_->vertices.emplace_back(number(tag, "x"), number(tag, "y"), number(tag, "z"));
    check_count(path_, object_->vertices.size());
  }

  void read_triangle(const Tag& tag) {
    if (!object_) refuse("a triangle outside an object");
    MeshTriangle triangle;
    const auto vertices = std::int64_t(object_->vertices.size());
    constexpr const char* kCorners[] = {"v1", "v2", "v3"};
    for (std::size_t c = 0; c < 3; ++c) {
      triangle.corners[c] = integer(tag, kCorners[c]);
      if (triangle.corners[c] >= vertices)
        refuse(fmt::format("a face refers to vertex {}, but the mesh has vertices 0 to {}",
                           triangle.corners[c], vertices - 1));
    }
    read_properties(tag, triangle);
    if (tag.find("paint_color") || tag.find("mmu_segmentation")) ++left_out_.painted;
    object_->triangles.push_back(triangle);
    check_count(path_, 3 * object_->triangles.size());
  }

  // p1 alone goes for all three corners; none of them: the object's own.
  void read_properties(const Tag& tag, MeshTriangle& triangle) const {
    const bool own_group = tag.find("pid") != nullptr, own_entry = tag.find("p1") != nullptr;
    triangle.group = own_group ? group_number(integer(tag, "pid")) : object_group_;
    triangle.entries.fill(object_entry_);
    if (own_entry) {
      triangle.entries.fill(integer(tag, "p1"));
      if (tag.find("p2")) triangle.entries[1] = integer(tag, "p2");
      if (tag.find("p3")) triangle.entries[2] = integer(tag, "p3");
    } else if (own_group) {
      triangle.group = -1;
    }
    if (triangle.group >= 0)
      for (const std::int32_t index : triangle.entries) entry_of(triangle.group, index);
  }

  // Slicers' plates hold dozens of objects; a list of very many is made to hang a reader.
  void count_placement() {
    constexpr int kMost = 5000;
    if (++placements_ > kMost)
      throw InputError(fmt::format(
          "{}: it places more than {} objects; export what is to be dipped alone.", path_, kMost));
  }

  Component placement(const Tag& tag) const {
    return {tag.text("path"), integer(tag, "objectid"), transform(tag)};
  }

  // Twelve numbers, row by row, of a matrix that multiplies rows.
  Matrix4f transform(const Tag& tag) const {
    Matrix4f matrix = Matrix4f::Identity();
    const std::string_view* text = tag.find("transform");
    if (!text) return matrix;
    std::string_view rest = *text;
    int count = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++count) {
      double value = 0;
      if (count == 12 || !parse_number(word, value)) break;
      matrix(count % 3, count / 3) = float(value);
    }
    if (count != 12 || !trimmed(rest).empty()) refuse("a transform is not made of 12 numbers");
    return matrix;
  }

  const std::string& path_;
  XmlTags tags_;
  Textures& textures_;
  LeftOut& left_out_;
  Part part_;
  std::map<std::string, bool> foreign_;                       // by prefix
  std::map<std::int32_t, std::int32_t> textures_of_;          // by id: material
  std::int32_t group_ = -1;                                   // the open one
  std::int32_t texture_ = -1;                                 // its picture's material
  std::vector<std::pair<std::int32_t, std::int32_t>> mixed_;  // its groups and entries
  Object3mf* object_ = nullptr;
  std::int32_t object_group_ = -1, object_entry_ = 0;
  int placements_ = 0;
};

// ---- the whole ----------------------------------------------------------------------------------

class ThreeMfReader {
 public:
  explicit ThreeMfReader(const ModelInput& input)
      : input_(input),
        package_(input.path, input.bytes),
        textures_(input, package_, file_),
        cancel_(input.context) {}

  ModelFile run() {
    slicer_parts_ = read_slicer_parts(input_.path, package_, input_.context);
    root_ = root_part();
    const Part& part = this->part(root_);
    file_.units = part.units;
    std::vector<Component> items = part.items.empty() ? part.items_off : part.items;
    if (!part.items.empty() && !part.items_off.empty())
      left_out_.features.insert("objects that are switched off for printing");
    // Some write no build at all: then everything is meant.
    if (items.empty())
      for (const auto& [id, object] : part.objects) items.push_back({"", id, Matrix4f::Identity()});
    for (const Component& item : items) place(root_, item, Matrix4f::Identity(), 0);
    if (file_.face_end.empty()) refuse_without_triangles();
    tell_what_is_left_out();
    return std::move(file_);
  }

 private:
  std::string root_part() {
    const std::string relations = package_.find("_rels/.rels");
    if (!relations.empty()) {
      Package::Stream stream(package_, relations);
      XmlTags tags(input_.path, stream, input_.context);
      Tag tag;
      while (tags.next(tag)) {
        const std::string type = tag.text("Type");
        if (tag.name != "Relationship" || !type.ends_with("/3dmodel")) continue;
        std::string stored = package_.find(tag.text("Target"));
        if (!stored.empty()) return stored;
      }
    }
    for (const std::string& name : package_.names())
      if (lower(name).ends_with(".model")) return name;
    refuse_model(input_.path, "it holds no 3MF model");
  }

  // By its stored name; read once.
  Part& part(const std::string& name) {
    const auto known = parts_.find(name);
    if (known != parts_.end()) return known->second;
    Package::Stream stream(package_, name);
    Part read = PartReader(input_.path, stream, textures_, left_out_, input_.context).run();
    for (const auto& [id, object] : read.objects) size_left_ += kCopies * size_of(object);
    return parts_.emplace(name, std::move(read)).first->second;
  }

  void place(const std::string& part_name, const Component& placed, const Matrix4f& parent,
             int depth) {
    if (depth > 32) refuse_model(input_.path, "its components are nested too deeply");
    if (--placements_left_ < 0) refuse_copies();
    const std::string name = placed.path.empty() ? part_name : package_.find(placed.path);
    if (name.empty())
      refuse_model(input_.path, fmt::format("its part {} is missing", shown(placed.path)));
    Part& part = this->part(name);
    const auto object = part.objects.find(placed.id);
    if (object == part.objects.end())
      refuse_model(input_.path, fmt::format("object {} is used but not defined", placed.id));
    if (!object->second.printed) return;
    const Matrix4f world = parent * placed.transform;
    // Slicers speak of the objects of the root part.
    const bool root = name == root_;
    add_mesh(part, object->second, world, root ? left_out_triangles(placed.id) : kNone);
    for (const Component& component : object->second.components)
      if (!root || !slicer_parts_.components.contains({placed.id, component.id}))
        place(name, component, world, depth + 1);
  }

  const std::vector<SlicerParts::Range>& left_out_triangles(std::int64_t object) const {
    const auto known = slicer_parts_.triangles.find(object);
    return known == slicer_parts_.triangles.end() ? kNone : known->second;
  }

  // What a copy of it costs.
  static std::int64_t size_of(const Object3mf& object) {
    return std::int64_t(object.triangles.size() + object.vertices.size());
  }

  [[noreturn]] void refuse_copies() const {
    throw InputError(
        fmt::format("{}: its objects' copies come to too many; export what is to be dipped alone, "
                    "as one mesh.",
                    input_.path));
  }

  void add_mesh(const Part& part, const Object3mf& object, const Matrix4f& world,
                const std::vector<SlicerParts::Range>& left_out) {
    if ((size_left_ -= size_of(object)) < 0) refuse_copies();
    const auto first = std::int32_t(file_.positions.size());
    check_count(input_.path, file_.positions.size() + object.vertices.size());
    const Mat3 linear = world.topLeftCorner<3, 3>().cast<double>();
    const Vec3 offset = world.topRightCorner<3, 1>().cast<double>();
    for (const auto& p : object.vertices) {
      cancel_();
      file_.positions.push_back(linear * p.cast<double>() + offset);
    }
    const bool mirrored = world.determinant() < 0;
    auto next_left_out = left_out.begin();
    for (std::size_t t = 0; t < object.triangles.size(); ++t) {
      cancel_();
      while (next_left_out != left_out.end() && next_left_out->second < std::int64_t(t))
        ++next_left_out;
      if (next_left_out != left_out.end() && next_left_out->first <= std::int64_t(t)) continue;
      add_triangle(part, object.triangles[t], first, mirrored);
    }
    check_count(input_.path, file_.corners.size());
  }

  void add_triangle(const Part& part, const MeshTriangle& triangle, std::int32_t first,
                    bool mirrored) {
    static const Entry kPlain;
    std::int32_t material = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t c = mirrored && k > 0 ? 3 - k : k;
      const bool plain = triangle.group < 0;
      const Entry& entry =
          plain ? kPlain
                : part.groups[std::size_t(triangle.group)][std::size_t(triangle.entries[c])];
      file_.corners.push_back(first + triangle.corners[c]);
      if (k == 0) material = entry.material;
      if (!plain && part.group_has_color[std::size_t(triangle.group)]) has_colors_ = true;
      if (entry.material >= 0) has_uvs_ = true;
      // From the first on that says anything.
      const std::size_t before = file_.corners.size() - 1;
      if (has_colors_) {
        file_.colors.resize(before, {1, 1, 1, 1});
        file_.colors.push_back({srgb8_to_linear(entry.color[0]), srgb8_to_linear(entry.color[1]),
                                srgb8_to_linear(entry.color[2]), float(entry.color[3]) / 255});
      }
      if (has_uvs_) {
        file_.uvs.resize(before, kPlain.uv);
        file_.uvs.push_back(entry.uv);
      }
    }
    file_.end_face(material);
  }

  [[noreturn]] void refuse_without_triangles() const {
    std::string why = "it has no triangles";
    if (!left_out_.features.empty())
      why += fmt::format(", only {}, which are not read", fmt::join(left_out_.features, " and "));
    refuse_model(input_.path, why);
  }

  void tell_what_is_left_out() const {
    for (const std::string& kind : slicer_parts_.kinds)
      input_.context.warn(fmt::format("{} holds {}; they are left out.", input_.name, kind));
    for (const std::string& feature : left_out_.features)
      input_.context.warn(fmt::format("{} holds {}, which are left out.", input_.name, feature));
    for (const std::string& extension : left_out_.extensions)
      input_.context.warn(
          fmt::format("{} requires the 3MF extension {}, which is not read; what it describes is "
                      "missing.",
                      input_.name, extension));
    if (left_out_.painted > 0)
      input_.context.warn(fmt::format(
          "{} is painted in a slicer (paint_color of {} triangles), which is not read: the colours "
          "to print come from textures, colour groups or base materials.",
          input_.name, left_out_.painted));
  }

  static constexpr std::int64_t kCopies = 4;
  static inline const std::vector<SlicerParts::Range> kNone;

  const ModelInput& input_;
  Package package_;
  ModelFile file_;
  Textures textures_;
  CancelCheck cancel_;
  std::string root_;  // its part's stored name
  std::map<std::string, Part> parts_;
  SlicerParts slicer_parts_;
  LeftOut left_out_;
  std::int64_t size_left_ = 1'000'000;
  std::int64_t placements_left_ = 20'000;
  bool has_colors_ = false, has_uvs_ = false;
};

}  // namespace

ModelFile read_3mf(const ModelInput& input) { return ThreeMfReader(input).run(); }

}  // namespace hydrodip
