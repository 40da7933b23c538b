#include "model_io/draco_mesh.h"

// Draco's headers do not compile without warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wshadow"
#include <draco/compression/decode.h>
#include <draco/metadata/metadata_decoder.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

namespace hydrodip {

namespace {

constexpr std::size_t kHeader = 11;
constexpr std::uint8_t kMesh = 1, kSequential = 0;

// The header's counts are believed by the library before it looks at the data. A face takes a
// fraction of a bit at the least, so much more than the bytes can hold is forged.
void check_counts(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeader || bytes[7] != kMesh)
    throw std::runtime_error("not a mesh compressed by Draco");
  std::size_t at = kHeader;
  const bool has_metadata = (bytes[10] & 0x80) != 0;
  if (has_metadata) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()) + at, bytes.size() - at);
    draco::GeometryMetadata metadata;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
      throw std::runtime_error("its metadata is damaged");
    at += std::size_t(buffer.decoded_size());
  }
  if (bytes[8] != kSequential) ++at;
  for (int count = 0; count < 2; ++count) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      if (at >= bytes.size()) throw std::runtime_error("it ends too early");
      value |= std::uint64_t(bytes[at] & 0x7f) << shift;
      if (!(bytes[at++] & 0x80)) break;
    }
    if (double(value) > 64.0 * double(bytes.size()) + 4096)
      throw std::runtime_error("it promises more than it holds");
  }
}

// What a whole number of that kind stands for 1; 0 of others.
float full_scale(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return 127;
    case draco::DT_UINT8:
      return 255;
    case draco::DT_INT16:
      return 32767;
    case draco::DT_UINT16:
      return 65535;
    default:
      return 0;
  }
}

DracoMesh::Attribute values_of(const draco::Mesh& mesh, const DracoWanted& wanted) {
  DracoMesh::Attribute out;
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(wanted.id);
  if (!attribute || attribute->num_components() < 1 || attribute->num_components() > 4) return out;
  out.components = attribute->num_components();
  out.values.resize(std::size_t(mesh.num_points()) * std::size_t(out.components));
  const float scale = full_scale(attribute->data_type());
  std::array<std::int32_t, 4> numbers{};
  for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
    float* to = &out.values[std::size_t(p) * std::size_t(out.components)];
    const draco::AttributeValueIndex value = attribute->mapped_index(draco::PointIndex(p));
    const auto count = std::int8_t(out.components);
    const bool is_good =
        value.value() < attribute->size() &&
        (scale > 0 ? attribute->ConvertValue<std::int32_t>(value, count, numbers.data())
                   : attribute->ConvertValue<float>(value, count, to));
    if (!is_good) throw std::runtime_error("its values are damaged");
    for (int c = 0; scale > 0 && c < out.components; ++c) {
      const auto number = float(numbers[std::size_t(c)]);
      to[c] =
          wanted.normalized || attribute->normalized() ? std::max(number / scale, -1.0F) : number;
    }
  }
  return out;
}

}  // namespace

DracoMesh decode_draco(std::span<const std::uint8_t> bytes,
                       const std::vector<DracoWanted>& wanted) {
  check_counts(bytes);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw std::runtime_error(decoded.status().error_msg_string());
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  DracoMesh out;
  out.points = mesh->num_points();
  out.faces.reserve(mesh->num_faces());
  for (std::uint32_t f = 0; f < mesh->num_faces(); ++f) {
    const auto& face = mesh->face(draco::FaceIndex(f));
    out.faces.push_back({face[0].value(), face[1].value(), face[2].value()});
    for (const std::uint32_t point : out.faces.back())
      if (point >= out.points) throw std::runtime_error("its faces are damaged");
  }
  for (const DracoWanted& one : wanted) out.attributes.push_back(values_of(*mesh, one));
  return out;
}

}  // namespace hydrodip
