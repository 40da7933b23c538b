#include "model_io/model_files.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstring>

#include "base/file.h"
#include "image/files.h"

namespace hydrodip::fixtures {

namespace {

void append(Bytes& out, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  for (std::size_t i = 0; i < size; ++i) out.push_back(bytes[i]);
}

template <typename T>
void put(Bytes& out, T value, bool big_endian = false) {
  std::uint8_t raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big_endian) std::reverse(raw, raw + sizeof raw);
  append(out, raw, sizeof raw);
}

void put_text(Bytes& out, const std::string& text) { append(out, text.data(), text.size()); }

std::uint32_t crc32_of(const std::string& text) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : text) {
    crc ^= std::uint8_t(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
  }
  return ~crc;
}

std::string base64(const Bytes& bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      out += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
    }
  }
  return out;
}

const float kSquare[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const std::uint16_t kSquareIndices[6] = {0, 1, 2, 0, 2, 3};

// buffer_uri: JSON text ", \"uri\": ..." or "".
std::string gltf_json(const GlbOptions& options, std::size_t png_size,
                      const std::string& buffer_uri, std::size_t bin_size) {
  const std::string alpha =
      options.alpha_mode.empty() ? "" : fmt::format(R"(, "alphaMode": "{}")", options.alpha_mode);
  return fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 1]}}],
"nodes": [{{"mesh": 0}}, {{"mesh": 1, "translation": [1, 0, 0]}}],
"meshes": [
 {{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "indices": 2, "material": 0}}]}},
 {{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 2, "material": 1}}]}}],
"materials": [
 {{"name": "pictured", "pbrMetallicRoughness": {{"baseColorFactor": [{}],
   "baseColorTexture": {{"index": 0{}}}}}{}}},
 {{"name": "plain", "pbrMetallicRoughness": {{"baseColorFactor": [1, 0.5, 0, 1]}}}}],
"textures": [{{"sampler": 0, "source": 0}}],
"samplers": [{{"wrapS": {}, "wrapT": {}}}],
"images": [{{"bufferView": 3, "mimeType": "image/png"}}],
"accessors": [
 {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, -1], "max": [1, 0, 0]}},
 {{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"}},
 {{"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}}],
"bufferViews": [
 {{"buffer": 0, "byteOffset": 0, "byteLength": 48}},
 {{"buffer": 0, "byteOffset": 48, "byteLength": 32}},
 {{"buffer": 0, "byteOffset": 80, "byteLength": 12}},
 {{"buffer": 0, "byteOffset": 92, "byteLength": {}}}],
"buffers": [{{"byteLength": {}{}}}]}})",
      options.factor, options.texture_use, alpha, options.wrap_s, options.wrap_t, png_size,
      bin_size, buffer_uri);
}

Bytes png_in(const GlbOptions& options) {
  return options.png.empty() ? four_colour_png() : options.png;
}

}  // namespace

std::filesystem::path ModelFolder::write(const std::string& name, const std::string& text) const {
  write_file(path() / name, text);
  return path() / name;
}

std::filesystem::path ModelFolder::write(const std::string& name, const Bytes& bytes) const {
  write_file(path() / name, bytes.data(), bytes.size());
  return path() / name;
}

Bytes png_of(int width, int height, const std::vector<Rgb>& pixels) {
  Image image(width, height);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Rgb& p = pixels[i];
    const int channels[4] = {p.r, p.g, p.b, p.a};
    for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * i + c] = std::uint8_t(channels[c]);
  }
  return encode_png(image);
}

Bytes four_colour_png() {
  return png_of(2, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}});
}

std::string obj_text() {
  return "mtllib squares.mtl\n"
         "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n"
         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
         "usemtl left\nf 1/1 2/2 5/3 4/4\n"
         "usemtl right\nf 2/1 3/2 6/3 5/4\n";
}

std::string mtl_text() {
  return "newmtl left\nKd 0.8 0.8 0.8\nmap_Kd left.png\n"
         "newmtl right\nKd 1.0 0.5 0.0\nd 1.0\n";
}

std::string ascii_ply_text() {
  return "ply\nformat ascii 1.0\ncomment two squares\nelement vertex 6\n"
         "property float x\nproperty float y\nproperty float z\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\n"
         "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0 255 0 0\n1 0 0 255 0 0\n2 0 0 0 0 255\n"
         "0 1 0 255 0 0\n1 1 0 255 0 0\n2 1 0 0 0 255\n"
         "4 0 1 4 3\n4 1 2 5 4\n";
}

Bytes binary_ply(bool big_endian) {
  Bytes out;
  put_text(out, fmt::format("ply\nformat binary_{}_endian 1.0\nelement vertex 6\n"
                            "property float x\nproperty float y\nproperty float z\n"
                            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                            "element face 2\nproperty list uchar int vertex_indices\nend_header\n",
                            big_endian ? "big" : "little"));
  for (int v = 0; v < 6; ++v) {
    put(out, float(v % 3), big_endian);
    put(out, float(v / 3), big_endian);
    put(out, 0.0f, big_endian);
    const bool far = v % 3 == 2;
    for (const int c : {far ? 0 : 255, 0, far ? 255 : 0}) put(out, std::uint8_t(c));
  }
  for (const int left : {0, 1}) {
    put(out, std::uint8_t(4));
    for (const int corner : {0, 1, 4, 3}) put(out, std::int32_t(left + corner), big_endian);
  }
  return out;
}

std::string ascii_stl_text() {
  std::string out = "solid squares\n";
  for (int left = 0; left < 2; ++left) {
    for (int t = 0; t < 2; ++t) {
      out += "facet normal 0 0 1\n outer loop\n";
      for (int c = 0; c < 3; ++c) {
        const float* p = kSquare[kSquareIndices[3 * t + c]];
        out += fmt::format("  vertex {} {} 0\n", p[0] + float(left), p[1]);
      }
      out += " endloop\nendfacet\n";
    }
  }
  return out + "endsolid squares\n";
}

Bytes binary_stl() {
  Bytes out(80, ' ');
  put(out, std::uint32_t(4));
  for (int left = 0; left < 2; ++left) {
    for (int t = 0; t < 2; ++t) {
      for (const float n : {0.0f, 0.0f, 1.0f}) put(out, n);
      for (int c = 0; c < 3; ++c) {
        const float* p = kSquare[kSquareIndices[3 * t + c]];
        for (const float x : {p[0] + float(left), p[1], 0.0f}) put(out, x);
      }
      put(out, std::uint16_t(0));
    }
  }
  return out;
}

std::string off_text() {
  return "OFF\n# two squares\n6 2 0\n\n0 0 0\n1 0 0\n2 0 0 # a comment\n0 1 0\n1 1 0\n2 1 0\n"
         "4 0 1 4 3\n4 1 2 5 4\n";
}

std::string coff_text() {
  return "COFF\n6 2 0\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n2 0 0 0 0 255 255\n"
         "0 1 0 255 0 0 255\n1 1 0 255 0 0 255\n2 1 0 0 0 255 255\n4 0 1 4 3\n4 1 2 5 4\n";
}

Bytes zip_of(const std::vector<std::pair<std::string, std::string>>& members) {
  Bytes out, directory;
  for (const auto& [name, content] : members) {
    const auto offset = std::uint32_t(out.size());
    Bytes common;  // from "version needed" to the name's length, the same in both places
    put(common, std::uint16_t(20));
    put(common, std::uint16_t(0));
    put(common, std::uint16_t(0));
    put(common, std::uint16_t(0));
    put(common, std::uint16_t(0x21));
    put(common, crc32_of(content));
    put(common, std::uint32_t(content.size()));
    put(common, std::uint32_t(content.size()));
    put(common, std::uint16_t(name.size()));
    put(out, std::uint32_t(0x04034b50));
    append(out, common.data(), common.size());
    put(out, std::uint16_t(0));
    put_text(out, name + content);
    put(directory, std::uint32_t(0x02014b50));
    put(directory, std::uint16_t(20));
    append(directory, common.data(), common.size());
    directory.resize(directory.size() + 12, 0);  // extra, comment, disk, attributes
    put(directory, offset);
    put_text(directory, name);
  }
  const auto start = std::uint32_t(out.size());
  append(out, directory.data(), directory.size());
  put(out, std::uint32_t(0x06054b50));
  put(out, std::uint32_t(0));
  put(out, std::uint16_t(members.size()));
  put(out, std::uint16_t(members.size()));
  put(out, std::uint32_t(directory.size()));
  put(out, start);
  put(out, std::uint16_t(0));
  return out;
}

Bytes threemf(const std::string& unit) {
  const std::string vertices =
      "<vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
      "<vertex x=\"1\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices>";
  const std::string triangles =
      "<triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/><triangle v1=\"0\" v2=\"2\" v3=\"3\"/>"
      "</triangles>";
  const std::string model =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model" +
      (unit.empty() ? "" : fmt::format(" unit=\"{}\"", unit)) +
      " xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\""
      " xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n<resources>"
      "<basematerials id=\"1\"><base name=\"red\" displaycolor=\"#FF0000\"/></basematerials>"
      "<m:colorgroup id=\"2\"><m:color color=\"#0000FF\"/></m:colorgroup>"
      "<object id=\"3\" type=\"model\" pid=\"1\" pindex=\"0\"><mesh>" +
      vertices + triangles +
      "</mesh></object>"
      "<object id=\"4\" type=\"model\" pid=\"2\" pindex=\"0\"><mesh>" +
      vertices + triangles +
      "</mesh></object></resources>\n"
      "<build><item objectid=\"3\"/>"
      "<item objectid=\"4\" transform=\"1 0 0 0 1 0 0 0 1 1 0 0\"/></build></model>\n";
  return zip_of(
      {{"[Content_Types].xml",
        "<?xml version=\"1.0\"?><Types "
        "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
        "<Default Extension=\"rels\" "
        "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
        "<Default Extension=\"model\" "
        "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
       {"_rels/.rels",
        "<?xml version=\"1.0\"?><Relationships "
        "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
        "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
        "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
       {"3D/3dmodel.model", model}});
}

Bytes gltf_bin(const GlbOptions& options) {
  Bytes out;
  for (const auto& p : kSquare) {
    for (const float x : {p[0], 0.0f, -p[1]}) put(out, x);
  }
  for (const auto& p : kSquare) {
    put(out, options.uv_max * p[0]);
    put(out, options.uv_max * (1 - p[1]));  // glTF's v runs down
  }
  for (const std::uint16_t i : kSquareIndices) put(out, i);
  const Bytes png = png_in(options);
  append(out, png.data(), png.size());
  return out;
}

Bytes glb(const GlbOptions& options) {
  Bytes bin = gltf_bin(options);
  std::string json = gltf_json(options, png_in(options).size(), "", bin.size());
  while (json.size() % 4 != 0) json += ' ';
  while (bin.size() % 4 != 0) bin.push_back(0);
  Bytes out;
  put_text(out, "glTF");
  put(out, std::uint32_t(2));
  put(out, std::uint32_t(12 + 8 + json.size() + 8 + bin.size()));
  put(out, std::uint32_t(json.size()));
  put_text(out, "JSON" + json);
  put(out, std::uint32_t(bin.size()));
  put_text(out, std::string("BIN\0", 4));
  append(out, bin.data(), bin.size());
  return out;
}

Bytes glb() { return glb(GlbOptions()); }

std::string gltf_text(const std::string& external_bin) {
  const GlbOptions options;
  const Bytes bin = gltf_bin(options);
  const std::string uri =
      external_bin.empty() ? "data:application/octet-stream;base64," + base64(bin) : external_bin;
  return gltf_json(options, png_in(options).size(), fmt::format(R"(, "uri": "{}")", uri),
                   bin.size());
}

}  // namespace hydrodip::fixtures
