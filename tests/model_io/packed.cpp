#include "model_io/packed.h"

#include <meshoptimizer.h>
#include <zlib.h>

// Draco's headers do not compile without warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wshadow"
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#pragma GCC diagnostic pop

#include <stdexcept>

namespace hydrodip::fixtures {

DracoMesh draco_mesh(const std::vector<std::array<float, 3>>& positions,
                     const std::vector<std::array<float, 2>>& uvs,
                     const std::vector<std::array<std::uint16_t, 3>>& triangles,
                     const std::array<std::uint8_t, 3>& color) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(int(triangles.size()));
  const int places = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int coordinates =
      builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const int colors = builder.AddAttribute(draco::GeometryAttribute::COLOR, 3, draco::DT_UINT8);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const draco::FaceIndex face{std::uint32_t(t)};
    const auto [a, b, c] = triangles[t];
    builder.SetAttributeValuesForFace(places, face, positions[a].data(), positions[b].data(),
                                      positions[c].data());
    builder.SetAttributeValuesForFace(coordinates, face, uvs[a].data(), uvs[b].data(),
                                      uvs[c].data());
    builder.SetAttributeValuesForFace(colors, face, color.data(), color.data(), color.data());
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  if (!mesh || !encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) throw std::runtime_error("Draco");
  return {{buffer.data(), buffer.data() + buffer.size()},
          mesh->attribute(places)->unique_id(),
          mesh->attribute(coordinates)->unique_id(),
          mesh->attribute(colors)->unique_id()};
}

Bytes meshopt_vertices(const Bytes& values, std::size_t stride) {
  const std::size_t count = values.size() / stride;
  Bytes out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), count, stride));
  return out;
}

Bytes meshopt_triangles(const std::vector<std::array<std::uint16_t, 3>>& triangles,
                        std::size_t vertices) {
  std::vector<unsigned> indices;
  for (const auto& triangle : triangles)
    indices.insert(indices.end(), triangle.begin(), triangle.end());
  meshopt_encodeIndexVersion(1);
  Bytes out(meshopt_encodeIndexBufferBound(indices.size(), vertices));
  out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
  return out;
}

namespace {

template <typename T>
void put(Bytes& out, T value) {
  for (std::size_t i = 0; i < sizeof value; ++i)
    out.push_back(std::uint8_t(std::uint64_t(value) >> (8 * i)));
}

void put_text(Bytes& out, const std::string& text) {
  out.insert(out.end(), text.begin(), text.end());
}

constexpr std::uint16_t kZip64Extra = 1, kVersion = 45, kSizesBehind = 8;
constexpr std::uint32_t kElsewhere = 0xffffffff;

}  // namespace

Bytes streamed_zip(const std::vector<std::pair<std::string, std::string>>& members) {
  Bytes out, directory;
  for (const auto& [name, content] : members) {
    const std::uint64_t offset = out.size(), size = content.size();
    const auto crc = std::uint32_t(
        crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size())));
    put(out, std::uint32_t(0x04034b50));
    for (const std::uint16_t word :
         {kVersion, kSizesBehind, std::uint16_t(0), std::uint16_t(0), std::uint16_t(0x21)})
      put(out, word);
    put(out, std::uint32_t(0));
    put(out, kElsewhere);
    put(out, kElsewhere);
    put(out, std::uint16_t(name.size()));
    put(out, std::uint16_t(20));
    put_text(out, name);
    put(out, kZip64Extra);
    put(out, std::uint16_t(16));
    put(out, std::uint64_t(0));
    put(out, std::uint64_t(0));
    put_text(out, content);
    put(out, std::uint32_t(0x08074b50));
    put(out, crc);
    put(out, size);
    put(out, size);
    put(directory, std::uint32_t(0x02014b50));
    for (const std::uint16_t word : {kVersion, kVersion, kSizesBehind, std::uint16_t(0),
                                     std::uint16_t(0), std::uint16_t(0x21)})
      put(directory, word);
    put(directory, crc);
    put(directory, kElsewhere);
    put(directory, kElsewhere);
    put(directory, std::uint16_t(name.size()));
    put(directory, std::uint16_t(28));
    directory.resize(directory.size() + 10, 0);  // comment, disk, attributes
    put(directory, kElsewhere);
    put_text(directory, name);
    put(directory, kZip64Extra);
    put(directory, std::uint16_t(24));
    for (const std::uint64_t number : {size, size, offset}) put(directory, number);
  }
  const std::uint64_t start = out.size(), count = members.size(), length = directory.size();
  out.insert(out.end(), directory.begin(), directory.end());
  const std::uint64_t end = out.size();
  put(out, std::uint32_t(0x06064b50));
  put(out, std::uint64_t(44));
  put(out, kVersion);
  put(out, kVersion);
  put(out, std::uint64_t(0));
  for (const std::uint64_t number : {count, count, length, start}) put(out, number);
  put(out, std::uint32_t(0x07064b50));
  put(out, std::uint32_t(0));
  put(out, end);
  put(out, std::uint32_t(1));
  put(out, std::uint32_t(0x06054b50));
  put(out, std::uint32_t(0));
  put(out, std::uint16_t(0xffff));
  put(out, std::uint16_t(0xffff));
  put(out, kElsewhere);
  put(out, kElsewhere);
  put(out, std::uint16_t(0));
  return out;
}

}  // namespace hydrodip::fixtures
