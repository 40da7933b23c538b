#include "model_io/gltf_data.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_nesting.h"
#include "model_io/text.h"

namespace hydrodip {

namespace {

using nlohmann::json;
using Span = std::span<const std::uint8_t>;

constexpr int kMaxDepth = 128;                         // of JSON brackets
constexpr std::int64_t kMostWithoutData = 16'000'000;  // entries that are all 0
constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;

std::uint32_t little_endian32(const std::uint8_t* p) {
  return std::uint32_t(p[0]) | std::uint32_t(p[1]) << 8 | std::uint32_t(p[2]) << 16 |
         std::uint32_t(p[3]) << 24;
}

// glTF's numbers for types of components.
enum Type {
  kByte = 5120,
  kUByte = 5121,
  kShort = 5122,
  kUShort = 5123,
  kUInt = 5125,
  kFloat = 5126
};

int bytes_of(std::int64_t type) {
  switch (type) {
    case kByte:
    case kUByte:
      return 1;
    case kShort:
    case kUShort:
      return 2;
    case kUInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

template <typename T>
T load(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

float component(const std::uint8_t* at, int type, bool normalized) {
  switch (type) {
    case kByte:
      return normalized ? std::max(float(load<std::int8_t>(at)) / 127, -1.0F)
                        : float(load<std::int8_t>(at));
    case kUByte:
      return normalized ? float(*at) / 255 : float(*at);
    case kShort:
      return normalized ? std::max(float(load<std::int16_t>(at)) / 32767, -1.0F)
                        : float(load<std::int16_t>(at));
    case kUShort:
      return normalized ? float(load<std::uint16_t>(at)) / 65535 : float(load<std::uint16_t>(at));
    case kUInt:
      return float(load<std::uint32_t>(at));
    default:
      return load<float>(at);
  }
}

std::uint32_t whole(const std::uint8_t* at, int type) {
  return type == kUByte ? *at : type == kUShort ? load<std::uint16_t>(at) : load<std::uint32_t>(at);
}

// Hands a text on and asks for a cancel on the way: a single string may be most of a file.
class WatchedText {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  WatchedText(const char* at, CancelCheck& cancel) : at_(at), cancel_(&cancel) {}
  reference operator*() const { return *at_; }
  WatchedText& operator++() {
    ++at_;
    (*cancel_)();
    return *this;
  }
  WatchedText operator++(int) {
    WatchedText before = *this;
    ++*this;
    return before;
  }
  bool operator==(const WatchedText& other) const { return at_ == other.at_; }
  bool operator!=(const WatchedText& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  CancelCheck* cancel_;
};

int components_of(const json& accessor) {
  const auto it = accessor.find("type");
  if (it == accessor.end() || !it->is_string()) return 0;
  const auto& type = it->get_ref<const std::string&>();
  return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
}

}  // namespace

// ---- numbers ------------------------------------------------------------------------------------

const std::uint8_t* GltfNumbers::entry(std::int64_t i) const {
  if (replaced_) {
    const auto found = std::lower_bound(replaced_->begin(), replaced_->end(), std::uint32_t(i));
    if (found != replaced_->end() && *found == std::uint32_t(i))
      return replacements_.data() +
             std::size_t(found - replaced_->begin()) * std::size_t(components * bytes_of(type_));
  }
  return bytes_.empty() ? nullptr : bytes_.data() + std::size_t(i) * stride_;
}

void GltfNumbers::get(std::int64_t i, float* out) const {
  const std::uint8_t* at = entry(i);
  for (int c = 0; c < components; ++c)
    out[c] = at ? component(at + c * bytes_of(type_), type_, normalized_) : 0;
}

std::uint32_t GltfNumbers::index(std::int64_t i) const {
  const std::uint8_t* at = entry(i);
  return at ? whole(at, type_) : 0;
}

// ---- container ----------------------------------------------------------------------------------

GltfData::GltfData(const ModelInput& input) : input_(input), root_(std::make_unique<json>()) {
  open();
  check_version();
  read_buffers();
}

GltfData::~GltfData() = default;

void GltfData::refuse(const std::string& what) const { refuse_model(input_.path, what); }

void GltfData::open() {
  const FileBytes& bytes = input_.bytes;
  glb_ = bytes.size() >= 4 && little_endian32(bytes.data()) == kGlbMagic;
  if (!glb_) {
    parse(without_bom(text_of(bytes)));
    return;
  }
  if (bytes.size() < 20) refuse("the GLB file ends too early");
  if (little_endian32(&bytes[4]) != 2) refuse("not version 2 of GLB");
  const std::size_t length = little_endian32(&bytes[8]);
  if (length > bytes.size()) refuse("the GLB file ends too early");
  const std::size_t json_length = little_endian32(&bytes[12]);
  if (length < 20 || little_endian32(&bytes[16]) != kJsonChunk || json_length > length - 20)
    refuse("the GLB file has no JSON chunk");
  parse(text_of(bytes).substr(20, json_length));
  const std::size_t at = 20 + (json_length + 3) / 4 * 4;
  if (at + 8 > length || little_endian32(&bytes[at + 4]) != kBinChunk) return;
  const std::size_t bin_length = little_endian32(&bytes[at]);
  if (bin_length > length - at - 8) refuse("the GLB file's binary chunk is cut off");
  bin_ = Span(bytes).subspan(at + 8, bin_length);
}

void GltfData::parse(std::string_view text) {
  CancelCheck cancel(input_.context);
  JsonNesting nesting(kMaxDepth);
  for (const char c : text) {
    cancel();
    if (!nesting.take(c)) refuse("its JSON is nested too deeply");
  }
  // Without a callback: with one, nlohmann's parser looks through a list again after every entry.
  *root_ = json::parse(WatchedText(text.data(), cancel),
                       WatchedText(text.data() + text.size(), cancel), nullptr, false);
  if (root_->is_discarded() || !root_->is_object()) refuse("not glTF, its JSON cannot be parsed");
}

void GltfData::check_version() const {
  const json* asset = object(*root_, "asset");
  const bool known = asset && asset->contains("version") && asset->at("version").is_string() &&
                     asset->at("version").get_ref<const std::string&>().starts_with("2.");
  if (!known) refuse("not glTF version 2");
}

// ---- access with checks -------------------------------------------------------------------------

std::size_t GltfData::table_size(const char* name) const {
  const auto it = root_->find(name);
  if (it == root_->end()) return 0;
  if (!it->is_array()) refuse(fmt::format("'{}' is not a list", name));
  return it->size();
}

const json& GltfData::entry(const char* table, std::int64_t index) const {
  if (index < 0 || std::size_t(index) >= table_size(table))
    refuse(fmt::format("entry {} of '{}' does not exist", index, table));
  const json& entry = (*root_)[table][std::size_t(index)];
  if (!entry.is_object()) refuse(fmt::format("an entry of '{}' is not an object", table));
  return entry;
}

std::int64_t GltfData::integer(const json& object, const char* name, std::int64_t fallback) const {
  const auto it = object.find(name);
  if (it == object.end()) return fallback;
  const double value = it->is_number() ? it->get<double>() : std::nan("");
  if (!(std::abs(value) <= 9e15) || std::floor(value) != value)
    refuse(fmt::format("'{}' is not a whole number", name));
  return std::int64_t(value);
}

std::int64_t GltfData::reference(const json& object, const char* name, const char* table) const {
  if (!object.contains(name)) return -1;
  const std::int64_t index = integer(object, name, -1);
  if (index < 0 || index >= std::int64_t(table_size(table)))
    refuse(
        fmt::format("'{}' refers to entry {} of '{}', which does not exist", name, index, table));
  return index;
}

bool GltfData::numbers(const json& object, const char* name, std::span<float> values) const {
  const auto it = object.find(name);
  if (it == object.end()) return false;
  bool good = it->is_array() && it->size() == values.size();
  for (std::size_t i = 0; good && i < values.size(); ++i) {
    good = (*it)[i].is_number();
    if (good) values[i] = (*it)[i].get<float>();
    good = good && std::isfinite(values[i]);
  }
  if (!good) refuse(fmt::format("'{}' is not a list of {} numbers", name, values.size()));
  return true;
}

const json* GltfData::object(const json& owner, const char* name) const {
  const auto it = owner.find(name);
  if (it == owner.end()) return nullptr;
  if (!it->is_object()) refuse(fmt::format("'{}' is not an object", name));
  return &*it;
}

const json* GltfData::extension(const json& owner, const char* name) const {
  const json* extensions = object(owner, "extensions");
  return extensions ? object(*extensions, name) : nullptr;
}

// ---- buffers ------------------------------------------------------------------------------------

FileBytes GltfData::data_uri(const std::string& uri) const {
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos || uri.find("base64") > comma)
    refuse("embedded data is not base64");
  FileBytes out;
  out.reserve((uri.size() - comma) / 4 * 3);
  std::uint32_t bits = 0;
  int held = 0;
  bool ended = false;
  CancelCheck cancel(input_.context);
  for (std::size_t i = comma + 1; i < uri.size(); ++i) {
    cancel();
    const char c = uri[i];
    const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+' || c == '-' ? 62
                      : c == '/' || c == '_' ? 63
                                             : -1;
    if (c == '=') ended = true;
    if (c == '=' || is_blank(c)) continue;
    if (value < 0 || ended) refuse("embedded base64 data is damaged");
    bits = bits << 6 | std::uint32_t(value);
    if ((held += 6) < 8) continue;
    held -= 8;
    out.push_back(std::uint8_t(bits >> held));
  }
  return out;
}

// meshoptimizer's, by either name.
const json* GltfData::compression_of(const json& owner) const {
  const json* compression = extension(owner, "EXT_meshopt_compression");
  return compression ? compression : extension(owner, "KHR_meshopt_compression");
}

bool GltfData::is_compressed() const {
  for (std::size_t i = 0; i < table_size("bufferViews"); ++i)
    if (compression_of(entry("bufferViews", std::int64_t(i)))) return true;
  for (std::size_t i = 0; i < table_size("meshes"); ++i) {
    const json& mesh = entry("meshes", std::int64_t(i));
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array()) continue;
    for (const json& primitive : *primitives)
      if (primitive.is_object() && extension(primitive, "KHR_draco_mesh_compression")) return true;
  }
  return false;
}

void GltfData::read_buffers() {
  for (std::size_t i = 0; i < table_size("buffers"); ++i) {
    const json& buffer = entry("buffers", std::int64_t(i));
    const std::int64_t length = integer(buffer, "byteLength", -1);
    const auto uri = buffer.find("uri");
    Span bytes;
    if (uri == buffer.end()) {
      // Without bytes it is a place for what compressed views unpack to.
      if (i != 0 || !glb_ || compression_of(buffer)) {
        buffers_.emplace_back();
        continue;
      }
      bytes = bin_;
    } else {
      if (!uri->is_string()) refuse("a buffer's address is not text");
      const auto& name = uri->get_ref<const std::string&>();
      if (name.starts_with("data:")) {
        owned_.push_back(std::make_unique<FileBytes>(data_uri(name)));
      } else {
        auto read = input_.side_files.read(name);
        if (!read)
          throw InputError(fmt::format("{}: its data file {} is missing; put it beside the model.",
                                       input_.path, name.substr(0, 200)));
        owned_.push_back(std::make_unique<FileBytes>(std::move(*read)));
      }
      bytes = *owned_.back();
    }
    if (length < 1 || std::size_t(length) > bytes.size())
      refuse(fmt::format("buffer {} is longer than its data", i));
    buffers_.push_back(bytes.first(std::size_t(length)));
    buffer_bytes_ += std::size_t(length);
  }
}

// What "buffer", "byteOffset" and "byteLength" name.
Span GltfData::buffer_part(const json& part) const {
  const std::int64_t buffer = reference(part, "buffer", "buffers");
  const std::int64_t offset = integer(part, "byteOffset", 0);
  const std::int64_t length = integer(part, "byteLength", -1);
  if (buffer < 0 || offset < 0 || length < 1 ||
      offset > std::int64_t(buffers_[std::size_t(buffer)].size()) - length)
    refuse("a buffer view lies outside its buffer");
  return buffers_[std::size_t(buffer)].subspan(std::size_t(offset), std::size_t(length));
}

Span GltfData::view(std::int64_t index) {
  const json& view = entry("bufferViews", index);
  const json* compression = compression_of(view);
  if (!compression) return buffer_part(view);
  const auto known = unpacked_.find(index);
  if (known != unpacked_.end()) return known->second;
  owned_.push_back(std::make_unique<FileBytes>(unpacked(*compression)));
  return unpacked_[index] = *owned_.back();
}

FileBytes GltfData::unpacked(const json& compression) const {
  const Span packed = buffer_part(compression);
  const std::int64_t count = integer(compression, "count", -1);
  const std::int64_t stride = integer(compression, "byteStride", -1);
  const auto text = [&](const char* name, const char* fallback) {
    const auto it = compression.find(name);
    return it == compression.end() || !it->is_string() ? std::string(fallback)
                                                       : it->get<std::string>();
  };
  const std::string mode = text("mode", ""), filter = text("filter", "NONE");
  const bool attributes = mode == "ATTRIBUTES";
  // What the codecs can do at best: a forged count must not ask for gigabytes.
  const double most = (attributes ? 64.0 : 12.0) * double(packed.size()) + 65536;
  const bool fits =
      attributes ? stride >= 4 && stride <= 256 && stride % 4 == 0 : stride == 2 || stride == 4;
  if (count < 1 || !fits || double(count) * double(stride) > most ||
      (mode == "TRIANGLES" && count % 3 != 0))
    refuse("a view compressed by meshoptimizer is damaged");
  FileBytes out(std::size_t(count) * std::size_t(stride));
  const auto n = std::size_t(count), size = std::size_t(stride);
  int error = 1;
  if (attributes) {
    error = meshopt_decodeVertexBuffer(out.data(), n, size, packed.data(), packed.size());
  } else if (mode == "TRIANGLES") {
    error = meshopt_decodeIndexBuffer(out.data(), n, size, packed.data(), packed.size());
  } else if (mode == "INDICES") {
    error = meshopt_decodeIndexSequence(out.data(), n, size, packed.data(), packed.size());
  }
  if (error != 0) refuse("a view compressed by meshoptimizer is damaged");
  if (filter == "OCTAHEDRAL" && attributes && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(out.data(), n, size);
  } else if (filter == "QUATERNION" && attributes && stride == 8) {
    meshopt_decodeFilterQuat(out.data(), n, size);
  } else if (filter == "EXPONENTIAL" && attributes) {
    meshopt_decodeFilterExp(out.data(), n, size);
  } else if (filter != "NONE") {
    refuse(fmt::format("a compressed view has the unknown filter {}", shown(filter)));
  }
  return out;
}

// ---- accessors ----------------------------------------------------------------------------------

GltfNumbers GltfData::accessor(std::int64_t index) {
  if (const auto known = sparse_.find(index); known != sparse_.end()) return known->second;
  const json& accessor = entry("accessors", index);
  GltfNumbers out;
  out.components = components_of(accessor);
  out.type_ = int(std::clamp<std::int64_t>(integer(accessor, "componentType", 0), 0, 9999));
  out.count = integer(accessor, "count", 0);
  out.floating = out.type_ == kFloat;
  const int size = bytes_of(out.type_) * out.components;
  if (size == 0 || out.count < 1 || out.count > std::int64_t(1) << 31)
    refuse(fmt::format("accessor {} is of no known kind", index));
  const auto normalized = accessor.find("normalized");
  if (normalized != accessor.end() && !normalized->is_boolean())
    refuse("'normalized' is neither true nor false");
  out.normalized_ = normalized != accessor.end() && normalized->get<bool>();
  const std::int64_t number = reference(accessor, "bufferView", "bufferViews");
  if (number >= 0) {
    const Span bytes = view(number);
    const auto length = std::int64_t(bytes.size());
    const std::int64_t offset = integer(accessor, "byteOffset", 0);
    const std::int64_t stride = integer(entry("bufferViews", number), "byteStride", size);
    if (stride < size || stride > 256) refuse(fmt::format("accessor {} overlaps itself", index));
    // count is bounded first so that the product cannot overflow.
    if (offset < 0 || offset > length || out.count > length ||
        offset + (out.count - 1) * stride + size > length)
      refuse(fmt::format("accessor {} lies outside its buffer view", index));
    out.bytes_ = bytes.subspan(std::size_t(offset));
    out.stride_ = std::size_t(stride);
  } else if (out.count > kMostWithoutData) {
    refuse(fmt::format("accessor {} has more entries than any model", index));
  }
  if (const json* sparse = object(accessor, "sparse")) {
    read_sparse(*sparse, out);
    sparse_.emplace(index, out);
  }
  return out;
}

// Entries that take the place of others.
void GltfData::read_sparse(const json& sparse, GltfNumbers& numbers) {
  const std::int64_t count = integer(sparse, "count", 0);
  const json* indices = object(sparse, "indices");
  const json* values = object(sparse, "values");
  if (count < 1 || count > numbers.count || !indices || !values)
    refuse("a sparse accessor is damaged");
  const auto part = [&](const json& of, std::int64_t size) {
    const Span bytes = view(reference(of, "bufferView", "bufferViews"));
    const std::int64_t offset = integer(of, "byteOffset", 0);
    const auto length = std::int64_t(bytes.size());
    if (offset < 0 || size < 1 || count > length || offset > length - count * size)
      refuse("a sparse accessor lies outside its buffer view");
    return bytes.subspan(std::size_t(offset), std::size_t(count * size));
  };
  const auto type = int(std::clamp<std::int64_t>(integer(*indices, "componentType", 0), 0, 9999));
  if (type != kUByte && type != kUShort && type != kUInt) refuse("a sparse accessor is damaged");
  const Span places = part(*indices, bytes_of(type));
  numbers.replacements_ = part(*values, numbers.components * bytes_of(numbers.type_));
  auto replaced = std::make_shared<std::vector<std::uint32_t>>();
  replaced->reserve(std::size_t(count));
  CancelCheck cancel(input_.context);
  for (std::int64_t i = 0; i < count; ++i) {
    const std::uint32_t place = whole(&places[std::size_t(i * bytes_of(type))], type);
    cancel();
    if (place >= numbers.count || (i > 0 && place <= replaced->back()))
      refuse("a sparse accessor's entries are not in order");
    replaced->push_back(place);
  }
  numbers.replaced_ = std::move(replaced);
}

}  // namespace hydrodip
