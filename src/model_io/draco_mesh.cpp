#include "model_io/draco_mesh.h"

// Draco's headers do not compile without warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wshadow"
#include <draco/compression/decode.h>
#include <draco/metadata/metadata_decoder.h>
#pragma GCC diagnostic pop

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

DracoMesh::Attribute values_of(const draco::Mesh& mesh, std::uint32_t id) {
  DracoMesh::Attribute out;
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
  if (!attribute || attribute->num_components() < 1 || attribute->num_components() > 4) return out;
  out.components = attribute->num_components();
  out.values.resize(std::size_t(mesh.num_points()) * std::size_t(out.components));
  for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
    const draco::AttributeValueIndex value = attribute->mapped_index(draco::PointIndex(p));
    if (value.value() >= attribute->size() ||
        !attribute->ConvertValue<float>(value, std::int8_t(out.components),
                                        &out.values[std::size_t(p) * std::size_t(out.components)]))
      throw std::runtime_error("its values are damaged");
  }
  return out;
}

}  // namespace

DracoMesh decode_draco(std::span<const std::uint8_t> bytes, const std::vector<std::uint32_t>& ids) {
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
  for (const std::uint32_t id : ids) out.attributes.push_back(values_of(*mesh, id));
  return out;
}

}  // namespace hydrodip
