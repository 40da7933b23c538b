#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "export/preview_glb.h"
#include "image/files.h"
#include "laid_film.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using fixtures::film_under_ball;
using fixtures::kRadius;
using fixtures::two_coloured_ball;
using Json = nlohmann::json;

// A sheet whose colour tells where it is: red grows with x, green with y, opaque.
Image gradient_sheet() {
  Image sheet(160, 200);
  for (int y = 0; y < sheet.height_px; ++y) {
    for (int x = 0; x < sheet.width_px; ++x) {
      std::uint8_t* p = sheet.pixel(x, y);
      p[0] = std::uint8_t(x);
      p[1] = std::uint8_t(199 - y);
      p[2] = 40;
      p[3] = 255;
    }
  }
  return sheet;
}

struct Glb {
  Json json;
  std::vector<std::uint8_t> binary;
};

std::uint32_t u32_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return std::uint32_t(bytes.at(at)) | std::uint32_t(bytes.at(at + 1)) << 8 |
         std::uint32_t(bytes.at(at + 2)) << 16 | std::uint32_t(bytes.at(at + 3)) << 24;
}

Glb parse(const std::vector<std::uint8_t>& bytes) {
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 4), "glTF");
  EXPECT_EQ(u32_at(bytes, 4), 2u);
  EXPECT_EQ(u32_at(bytes, 8), bytes.size());
  const std::size_t text = u32_at(bytes, 12);
  EXPECT_EQ(text % 4, 0u);
  EXPECT_EQ(u32_at(bytes, 16), 0x4e4f534au);
  const std::size_t binary = 20 + text;
  EXPECT_EQ(u32_at(bytes, binary) % 4, 0u);
  EXPECT_EQ(u32_at(bytes, binary + 4), 0x004e4942u);
  EXPECT_EQ(binary + 8 + u32_at(bytes, binary), bytes.size());
  Glb glb;
  glb.json = Json::parse(bytes.begin() + 20, bytes.begin() + std::ptrdiff_t(binary));
  glb.binary.assign(bytes.begin() + std::ptrdiff_t(binary) + 8, bytes.end());
  return glb;
}

std::size_t components(const Json& accessor) {
  const std::string type = accessor["type"];
  return type == "SCALAR" ? 1 : std::size_t(type.back() - '0');
}

// All values of an accessor, after checking that they lie within view and buffer.
std::vector<std::uint32_t> words(const Glb& glb, int number) {
  const Json& accessor = glb.json["accessors"].at(std::size_t(number));
  const Json& view = glb.json["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
  const std::size_t begin = view["byteOffset"];
  const std::size_t length = view["byteLength"];
  const std::size_t count = accessor["count"].get<std::size_t>() * components(accessor);
  EXPECT_LE(4 * count, length);
  EXPECT_LE(begin + length, glb.binary.size());
  EXPECT_EQ(begin % 4, 0u);
  std::vector<std::uint32_t> result(count);
  for (std::size_t i = 0; i < count; ++i) result[i] = u32_at(glb.binary, begin + 4 * i);
  return result;
}

std::vector<float> floats(const Glb& glb, int number) {
  std::vector<float> result;
  for (const std::uint32_t word : words(glb, number)) result.push_back(std::bit_cast<float>(word));
  return result;
}

Surface surface_of(const Object& object) { return {object.positions, object.triangles}; }

Glb write_and_parse(const DippedFilm& film, const Image& sheet) {
  const TemporaryFolder folder;
  const Object ball = two_coloured_ball();
  write_preview_glb(folder / "preview.glb", ball, surface_of(ball), film, sheet, 80, 100,
                    {1, 1, 1, 1});
  return parse(read_file(folder / "preview.glb"));
}

const Json& primitive(const Glb& glb, std::size_t mesh) {
  return glb.json["meshes"].at(mesh)["primitives"].at(0);
}

Vec3 vec3(const std::vector<float>& values, std::uint32_t i) {
  return {values.at(3 * i), values.at(3 * i + 1), values.at(3 * i + 2)};
}

TEST(PreviewGlb, AccessorsAreWholeAndTheirLimitsTrue) {
  const Glb glb = write_and_parse(film_under_ball(), gradient_sheet());
  ASSERT_EQ(glb.json["meshes"].size(), 2u);
  EXPECT_EQ(glb.json["buffers"][0]["byteLength"], glb.binary.size());
  for (std::size_t m = 0; m < 2; ++m) {
    const Json& part = primitive(glb, m);
    const int position = part["attributes"]["POSITION"];
    const std::vector<float> values = floats(glb, position);
    for (std::size_t k = 0; k < 3; ++k) {
      float low = values[k];
      float high = values[k];
      for (std::size_t i = k; i < values.size(); i += 3) {
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
      }
      const Json& accessor = glb.json["accessors"][std::size_t(position)];
      EXPECT_EQ(accessor["min"][k].get<float>(), low);
      EXPECT_EQ(accessor["max"][k].get<float>(), high);
    }
    const std::vector<float> normals = floats(glb, part["attributes"]["NORMAL"]);
    ASSERT_EQ(normals.size(), values.size());
    for (std::uint32_t i = 0; i < normals.size() / 3; ++i) {
      ASSERT_NEAR(vec3(normals, i).norm(), 1, 1e-5);
    }
    const std::vector<std::uint32_t> indices = words(glb, part["indices"]);
    EXPECT_EQ(indices.size() % 3, 0u);
    for (const std::uint32_t index : indices) ASSERT_LT(index, values.size() / 3);
  }
}

TEST(PreviewGlb, FilmLiesJustOutsideTheObjectAndFacesOutward) {
  const Glb glb = write_and_parse(film_under_ball(), gradient_sheet());
  const Json& film = primitive(glb, 1);
  const std::vector<float> positions = floats(glb, film["attributes"]["POSITION"]);
  const std::vector<std::uint32_t> indices = words(glb, film["indices"]);
  // Posed (0, 0, R) in metres, turned half round about the vertical: the ball's centre.
  const Vec3 center(0, 0, -1e-3 * kRadius);
  for (std::uint32_t i = 0; i < positions.size() / 3; ++i) {
    const double above_mm = 1e3 * (vec3(positions, i) - center).norm() - kRadius;
    ASSERT_GT(above_mm, 0.045);
    ASSERT_LT(above_mm, 0.15);
  }
  for (std::size_t t = 0; t < indices.size(); t += 3) {
    const Vec3 a = vec3(positions, indices[t]);
    const Vec3 b = vec3(positions, indices[t + 1]);
    const Vec3 c = vec3(positions, indices[t + 2]);
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 normal(ab.y() * ac.z() - ab.z() * ac.y(), ab.z() * ac.x() - ab.x() * ac.z(),
                      ab.x() * ac.y() - ab.y() * ac.x());
    ASSERT_GT(normal.dot(a - center), 0);
  }
}

Image texture_of(const Glb& glb) {
  const Json& view =
      glb.json["bufferViews"][glb.json["images"][0]["bufferView"].get<std::size_t>()];
  const auto begin = glb.binary.begin() + view["byteOffset"].get<std::ptrdiff_t>();
  return decode_image(
      std::vector<std::uint8_t>(begin, begin + view["byteLength"].get<std::ptrdiff_t>()),
      "texture");
}

TEST(PreviewGlb, TextureCarriesEachFilmPointsColour) {
  const Glb glb = write_and_parse(film_under_ball(), gradient_sheet());
  const Image texture = texture_of(glb);
  EXPECT_LT(texture.width_px, 80);  // cropped to the film that lies on the ball
  const Json& film = primitive(glb, 1);
  const std::vector<float> positions = floats(glb, film["attributes"]["POSITION"]);
  const std::vector<float> uvs = floats(glb, film["attributes"]["TEXCOORD_0"]);
  for (std::uint32_t i = 0; i < positions.size() / 3; ++i) {
    // This film came down straight, so x and y tell where it was on the sheet (2 px per mm). The
    // offset moves it outward by at most 0.15 mm.
    const double x_mm = -1000 * positions[3 * i];
    const double y_mm = 1000 * positions[3 * i + 1];
    const int x = std::clamp(int(uvs[2 * i] * float(texture.width_px)), 0, texture.width_px - 1);
    const int y =
        std::clamp(int(uvs[2 * i + 1] * float(texture.height_px)), 0, texture.height_px - 1);
    ASSERT_NEAR(texture.pixel(x, y)[0], 80 + 2 * x_mm, 1.2);
    ASSERT_NEAR(texture.pixel(x, y)[1], 100 + 2 * y_mm, 1.2);
  }
}

// Where a sheet is blank the object's own colour shows.
TEST(PreviewGlb, BlankFilmIsAsTheBareObject) {
  const TemporaryFolder folder;
  const Object ball = two_coloured_ball(4);
  const LinearColor base{0.2F, 0.4F, 0.6F, 1};
  write_preview_glb(folder / "b.glb", ball, surface_of(ball), film_under_ball(), Image(160, 200),
                    80, 100, base);
  const Glb glb = parse(read_file(folder / "b.glb"));
  const Image texture = texture_of(glb);
  const std::uint8_t* p = texture.pixel(texture.width_px / 2, texture.height_px / 2);
  EXPECT_EQ(p[0], linear_to_srgb8(base.r));
  EXPECT_EQ(p[1], linear_to_srgb8(base.g));
  EXPECT_EQ(p[2], linear_to_srgb8(base.b));
}

// glTF's pictures begin at their top, models' at their bottom.
TEST(PreviewGlb, TextureCoordinatesRunDown) {
  Object ball = two_coloured_ball(4);
  ball.materials = {Material{}};
  ball.material_of.assign(ball.triangles.size(), 0);
  ball.textures = {std::make_shared<const Image>(gradient_sheet())};
  ball.materials[0].texture = 0;
  for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
    CornerUv corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = ball.positions[std::size_t(ball.triangles[t][k])];
      corners[k] = {float(0.5 + p.x() / 100), float(p.z() / 100)};
    }
    ball.uvs.push_back(corners);
  }
  const TemporaryFolder folder;
  write_preview_glb(folder / "t.glb", ball, surface_of(ball), film_under_ball(), gradient_sheet(),
                    80, 100, {1, 1, 1, 1});
  const Glb glb = parse(read_file(folder / "t.glb"));
  const Json& part = primitive(glb, 0);
  const std::vector<float> positions = floats(glb, part["attributes"]["POSITION"]);
  const std::vector<float> uvs = floats(glb, part["attributes"]["TEXCOORD_0"]);
  ASSERT_EQ(uvs.size() / 2, positions.size() / 3);
  for (std::size_t i = 0; i < uvs.size() / 2; ++i) {  // x right and z up of the model, in metres
    EXPECT_NEAR(uvs[2 * i], 0.5 - 10 * positions[3 * i], 1e-4);
    EXPECT_NEAR(uvs[2 * i + 1], 1 + 10 * positions[3 * i + 2], 1e-4);
  }
}

// Film of large triangles, through which the ball bulges.
TEST(PreviewGlb, FilmLiesOutsideOfWhatBulgesBetweenItsCorners) {
  const Object ball = two_coloured_ball();
  DippedFilm film = film_under_ball();
  const TemporaryFolder folder;
  // Flatter than the ball: each corner a little below the surface, as if its triangles were large.
  for (std::size_t v = 0; v < film.position.size(); ++v)
    if (film.state[v] == VertexState::kAttached) {
      const Vec3 center(0, 0, kRadius);
      film.position[v] = center + (1 - 0.3 / kRadius) * (film.position[v] - center);
    }
  write_preview_glb(folder / "f.glb", ball, surface_of(ball), film, gradient_sheet(), 80, 100,
                    {1, 1, 1, 1});
  const Glb glb = parse(read_file(folder / "f.glb"));
  const std::vector<float> positions = floats(glb, primitive(glb, 1)["attributes"]["POSITION"]);
  const Vec3 center(0, 0, -1e-3 * kRadius);
  for (std::uint32_t i = 0; i < positions.size() / 3; ++i)
    ASSERT_GT((vec3(positions, i) - center).norm(), 1e-3 * (kRadius - 0.1)) << i;
}

// The materials of every primitive in a variant, by name.
std::vector<std::string> shown_in(const Glb& glb, int variant) {
  std::vector<std::string> names;
  for (const Json& mesh : glb.json["meshes"]) {
    for (const Json& part : mesh["primitives"]) {
      for (const Json& mapping : part["extensions"]["KHR_materials_variants"]["mappings"]) {
        const auto variants = mapping["variants"].get<std::vector<int>>();
        if (std::find(variants.begin(), variants.end(), variant) == variants.end()) continue;
        names.push_back(glb.json["materials"][mapping["material"].get<std::size_t>()]["name"]);
      }
    }
  }
  return names;
}

TEST(PreviewGlb, TheWantedColoursAreAVariant) {
  const Glb glb = write_and_parse(film_under_ball(), gradient_sheet());
  const Json& variants = glb.json["extensions"]["KHR_materials_variants"]["variants"];
  EXPECT_EQ(variants[0]["name"], "predicted");
  EXPECT_EQ(variants[1]["name"], "wanted");
  using Names = std::vector<std::string>;
  EXPECT_EQ(shown_in(glb, 0), (Names{"object", "object", "film"}));
  EXPECT_EQ(shown_in(glb, 1), (Names{"wanted ", "wanted ", "hidden"}));
  // Without variants, the predicted ones are shown.
  EXPECT_EQ(glb.json["materials"][primitive(glb, 0)["material"].get<std::size_t>()]["name"],
            "object");
  const Json& red = glb.json["materials"][2]["pbrMetallicRoughness"]["baseColorFactor"];
  EXPECT_EQ(red, Json({1.0, 0.0, 0.0, 1.0}));
}

TEST(PreviewGlb, VertexColoursComeOnAMeshOfTheirOwn) {
  Object ball = two_coloured_ball(4);
  ball.colors.assign(ball.triangles.size(), CornerColor{});
  for (CornerColor& corners : ball.colors) corners.fill({0, 1, 0, 0.5f});
  for (Material& material : ball.materials) material.base_color = {1, 1, 1, 1};
  const TemporaryFolder folder;
  write_preview_glb(folder / "c.glb", ball, surface_of(ball), film_under_ball(), gradient_sheet(),
                    80, 100, {1, 1, 1, 1});
  const Glb glb = parse(read_file(folder / "c.glb"));
  ASSERT_EQ(glb.json["meshes"].size(), 3u);
  EXPECT_FALSE(primitive(glb, 0)["attributes"].contains("COLOR_0"));
  const Json& wanted = primitive(glb, 1);
  const std::vector<float> colors = floats(glb, wanted["attributes"]["COLOR_0"]);
  for (std::size_t i = 0; i < colors.size(); i += 4) {  // half green over white
    EXPECT_NEAR(colors[i], 0.5f, 1e-6);
    EXPECT_NEAR(colors[i + 1], 1, 1e-6);
  }
}

// Old programs write names in their machine's own letters, and long ones are cut anywhere.
TEST(PreviewGlb, TakesMaterialNamesOfAnyLetters) {
  Object ball = two_coloured_ball(4);
  ball.materials[0].name = "Geh\xe4use";
  ball.materials[1].name = "\xc3";
  const TemporaryFolder folder;
  write_preview_glb(folder / "n.glb", ball, surface_of(ball), film_under_ball(), gradient_sheet(),
                    80, 100, {1, 1, 1, 1}, 64);
  const Glb glb = parse(read_file(folder / "n.glb"));
  EXPECT_FALSE(glb.json["materials"].empty());
}

TEST(PreviewGlb, APlainModelHasNoVariants) {
  Object ball = two_coloured_ball(4);
  ball.materials = {Material{}};
  ball.material_of.assign(ball.triangles.size(), 0);
  const TemporaryFolder folder;
  write_preview_glb(folder / "p.glb", ball, surface_of(ball), film_under_ball(), gradient_sheet(),
                    80, 100, {1, 1, 1, 1});
  EXPECT_FALSE(parse(read_file(folder / "p.glb")).json.contains("extensionsUsed"));
}

TEST(PreviewGlb, WithoutFilmOnlyTheObject) {
  const Glb glb = write_and_parse(film_under_ball(-1), gradient_sheet());
  EXPECT_EQ(glb.json["meshes"].size(), 1u);
  EXPECT_FALSE(glb.json.contains("images"));
}

TEST(PreviewGlb, WithoutAnImageOnlyTheObject) {
  const Glb glb = write_and_parse(film_under_ball(), Image());
  EXPECT_EQ(glb.json["meshes"].size(), 1u);
}

}  // namespace
}  // namespace hydrodip
