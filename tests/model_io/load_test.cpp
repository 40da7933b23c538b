#include "model_io/load.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <string>

#include "base/error.h"
#include "model_io/model_files.h"

namespace hydrodip {
namespace {

using fixtures::Bytes;
using fixtures::GlbOptions;
using fixtures::ModelFolder;

constexpr LinearColor kBlack{0, 0, 0, 1};

LoadedObject load(const std::filesystem::path& path, const LoadOptions& options = {}) {
  RunContext context;
  return load_object(path, options, context);
}

std::string refusal(const std::filesystem::path& path, const LoadOptions& options = {}) {
  try {
    load(path, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// The colour at a point of the plane z = 0, which some triangle must contain.
LinearColor color_near(const Object& object, double x, double y, const LinearColor& base = kBlack) {
  for (std::size_t f = 0; f < object.triangles.size(); ++f) {
    const Triangle& t = object.triangles[f];
    const Vec2 a = object.positions[std::size_t(t[0])].head<2>();
    const Vec2 ab = object.positions[std::size_t(t[1])].head<2>() - a;
    const Vec2 ac = object.positions[std::size_t(t[2])].head<2>() - a;
    const double area = cross2(ab, ac);
    const double u = cross2(Vec2(x, y) - a, ac) / area;
    const double v = cross2(ab, Vec2(x, y) - a) / area;
    if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
    return color_at(object, {int(f), u, v}, base);
  }
  ADD_FAILURE() << "no triangle at " << x << ", " << y;
  return {};
}

void expect_color(const LinearColor& color, float r, float g, float b) {
  EXPECT_NEAR(color.r, r, 1e-5);
  EXPECT_NEAR(color.g, g, 1e-5);
  EXPECT_NEAR(color.b, b, 1e-5);
}

// Two unit squares from (0, 0) to (2, 1), facing +z.
void expect_squares(const LoadedObject& loaded, double mm = 1) {
  EXPECT_EQ(loaded.health.triangles, 4);
  EXPECT_EQ(loaded.health.shells, 1);
  EXPECT_EQ(loaded.health.boundary_edges, 6);
  EXPECT_EQ(loaded.health.flipped, 0);
  EXPECT_NEAR(loaded.health.area_mm2, 2 * mm * mm, 1e-9 * mm * mm);
  const Box3 box = loaded.object.bounds();
  EXPECT_NEAR((box.min - Vec3(0, 0, 0)).norm(), 0, 1e-6 * mm);
  EXPECT_NEAR((box.max - Vec3(2 * mm, mm, 0)).norm(), 0, 1e-6 * mm);
  for (int f = 0; f < 4; ++f) EXPECT_EQ(face_normal(loaded.object, f).z(), 1);
}

ModelFolder& obj_in(ModelFolder& folder) {
  folder.write("squares.obj", fixtures::obj_text());
  folder.write("squares.mtl", fixtures::mtl_text());
  folder.write("left.png", fixtures::four_colour_png());
  return folder;
}

TEST(Load, ObjWithMaterialsAndTexture) {
  ModelFolder folder;
  const LoadedObject loaded = load(obj_in(folder) / "squares.obj");
  expect_squares(loaded);
  EXPECT_EQ(loaded.units, "mm");
  EXPECT_TRUE(loaded.object.has_appearance());
  EXPECT_EQ(loaded.files.size(), 3u);
  // Texel centres: v = 0 is the picture's bottom row. The grey Kd is no tint.
  expect_color(color_near(loaded.object, 0.25, 0.75), 1, 0, 0);
  expect_color(color_near(loaded.object, 0.75, 0.75), 0, 1, 0);
  expect_color(color_near(loaded.object, 0.25, 0.25), 0, 0, 1);
  expect_color(color_near(loaded.object, 0.75, 0.25), 1, 1, 1);
  // Kd is sRGB.
  expect_color(color_near(loaded.object, 1.5, 0.5), 1, srgb_to_linear(0.5f), 0);
}

TEST(Load, ColouredKdTintsTheTexture) {
  ModelFolder folder;
  obj_in(folder).write("squares.mtl", "newmtl left\nKd 1 0.5 0\nmap_Kd left.png\n");
  const LoadedObject loaded = load((folder / "squares.obj"));
  expect_color(color_near(loaded.object, 0.75, 0.25), 1, srgb_to_linear(0.5f), 0);
}

TEST(Load, ObjTransparencyLetsTheObjectShow) {
  ModelFolder folder;
  obj_in(folder).write("squares.mtl", "newmtl right\nKd 1 1 1\nd 0.25\n");
  const LoadedObject loaded = load((folder / "squares.obj"));
  expect_color(color_near(loaded.object, 1.5, 0.5, {0, 1, 0, 1}), 0.25f, 1, 0.25f);
}

TEST(Load, SeveralTextures) {
  ModelFolder folder;
  obj_in(folder).write("squares.mtl",
                       "newmtl left\nmap_Kd left.png\nnewmtl right\nmap_Kd -clamp on right.png\n");
  folder.write("right.png", fixtures::png_of(1, 1, {{0, 255, 255}}));
  const LoadedObject loaded = load((folder / "squares.obj"));
  EXPECT_EQ(loaded.object.textures.size(), 2u);
  expect_color(color_near(loaded.object, 0.25, 0.75), 1, 0, 0);
  expect_color(color_near(loaded.object, 1.25, 0.75), 0, 1, 1);
}

// What a model names elsewhere is not there for one that is confined, whichever way it leads.
TEST(Load, ConfinedModelsReadNothingElsewhere) {
  ModelFolder folder;
  const auto inside = folder / "inside";
  std::filesystem::create_directories(inside / "below");
  obj_in(folder);
  const auto png = folder / "left.png";
  std::filesystem::copy(folder / "squares.obj", inside / "squares.obj");
  std::filesystem::create_symlink(png, inside / "link.png");
  const auto pictures_read = [&](const std::string& name, bool confined) {
    std::ofstream(inside / "squares.mtl") << "newmtl left\nmap_Kd " << name << "\n";
    LoadOptions options;
    if (confined) options.confined_to = inside;
    return load(inside / "squares.obj", options).files.size() - 2;
  };
  for (const std::string& name : {png.string(), std::string("../left.png"), std::string("link.png"),
                                  std::string("below/../../left.png")}) {
    EXPECT_EQ(pictures_read(name, false), 1U) << name;
    EXPECT_EQ(pictures_read(name, true), 0U) << name;
  }
  std::filesystem::copy(png, inside / "below/own.png");
  EXPECT_EQ(pictures_read("below/own.png", true), 1U);
}

TEST(Load, MissingTextureFallsBackWithAWarning) {
  ModelFolder folder;
  obj_in(folder);
  std::filesystem::remove((folder / "left.png"));
  RunContext context;
  const LoadedObject loaded = load_object((folder / "squares.obj"), {}, context);
  ASSERT_EQ(context.warnings().size(), 1u);
  EXPECT_NE(context.warnings()[0].find("left.png"), std::string::npos);
  const float kd = srgb_to_linear(0.8f);
  expect_color(color_near(loaded.object, 0.25, 0.75), kd, kd, kd);
}

TEST(Load, DamagedTextureFallsBackWithAWarning) {
  ModelFolder folder;
  obj_in(folder).write("left.png", std::string("not a picture"));
  RunContext context;
  EXPECT_TRUE(load_object((folder / "squares.obj"), {}, context).object.textures.empty());
  EXPECT_EQ(context.warnings().size(), 1u);
}

// Many pictures, of which some are missing, damaged, named twice or shown by no face: what is
// shown, told and listed, and in which order, does not depend on the threads that read them.
TEST(Load, PicturesComeInTheFacesOrderOnAnyNumberOfThreads) {
  ModelFolder folder;
  const auto load_on = [&](int threads, const LoadOptions& options) {
    const RunContext context = RunContext().with_threads(threads);
    LoadedObject loaded = load_object(folder / "many.obj", options, context);
    return std::make_pair(std::move(loaded), context.warnings());
  };
  std::string obj = "mtllib many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n", mtl;
  for (int n = 0; n < 12; ++n) mtl += fmt::format("newmtl m{0}\nmap_Kd {0}.png\n", n);
  mtl += "newmtl again\nmap_Kd ./8.PNG\n";
  // The library's first is shown by none, and is missing.
  for (const char* name : {"m9", "m8", "m2", "again", "m5", "m4", "m3", "m11", "m10", "m7", "m6"}) {
    obj += fmt::format("usemtl {}\n", name);
    for (int face = 0; face < 2; ++face)
      obj += fmt::format("v 0 0 {0}\nv 1 0 {0}\nv 0 1 {0}\nf -3/1 -2/1 -1/1\n", obj.size());
  }
  obj += "usemtl m1\nv 0 0 9000\nv 1 0 9000\nv 0 1 9000\nf -3 -2 -1\n";  // without coordinates
  folder.write("many.obj", obj);
  folder.write("many.mtl", mtl);
  for (int n = 1; n < 12; ++n)
    if (n != 5) folder.write(fmt::format("{}.png", n), fixtures::png_of(1, 1, {{n, 0, 0}}));
  folder.write("3.png", std::string("not a picture"));

  const auto [one, told_by_one] = load_on(1, {});
  std::vector<int> reds;
  for (const auto& picture : one.object.textures) reds.push_back(picture->rgba[0]);
  EXPECT_EQ(reds, (std::vector<int>{9, 8, 2, 4, 11, 10, 7, 6, 1}));
  ASSERT_EQ(told_by_one.size(), 2U);
  EXPECT_NE(told_by_one[0].find("5.png"), std::string::npos) << told_by_one[0];
  EXPECT_NE(told_by_one[1].find("3.png"), std::string::npos) << told_by_one[1];
  EXPECT_EQ(one.picture_problems.size(), 2U);
  std::vector<std::string> files;
  for (const auto& file : one.files) files.push_back(file.filename().string());
  EXPECT_EQ(files,
            (std::vector<std::string>{"many.obj", "many.mtl", "9.png", "8.png", "2.png", "4.png",
                                      "3.png", "11.png", "10.png", "7.png", "6.png", "1.png"}));

  for (int again = 0; again < 20; ++again) {
    const auto [all, told] = load_on(0, {});
    EXPECT_EQ(told, told_by_one);
    EXPECT_EQ(all.files, one.files);
    EXPECT_EQ(all.picture_problems, one.picture_problems);
    EXPECT_EQ(all.object.material_of, one.object.material_of);
    ASSERT_EQ(all.object.textures.size(), one.object.textures.size());
    for (std::size_t n = 0; n < reds.size(); ++n)
      EXPECT_EQ(all.object.textures[n]->rgba, one.object.textures[n]->rgba);
    ASSERT_EQ(all.object.materials.size(), one.object.materials.size());
    for (std::size_t n = 0; n < one.object.materials.size(); ++n)
      EXPECT_EQ(all.object.materials[n].texture, one.object.materials[n].texture);
  }
  // With one picture for all, the model's own are not read.
  const auto [replaced, told] = load_on(0, {.units = "", .texture = folder / "9.png"});
  EXPECT_TRUE(told.empty());
  EXPECT_EQ(replaced.files.size(), 3U);
  ASSERT_EQ(replaced.object.textures.size(), 1U);
  EXPECT_EQ(replaced.object.textures[0]->rgba[0], 9);
}

TEST(Load, MissingMtlIsAWarning) {
  ModelFolder folder;
  obj_in(folder);
  std::filesystem::remove((folder / "squares.mtl"));
  RunContext context;
  const LoadedObject loaded = load_object((folder / "squares.obj"), {}, context);
  expect_squares(loaded);
  ASSERT_EQ(context.warnings().size(), 1u);
  EXPECT_NE(context.warnings()[0].find("squares.mtl"), std::string::npos);
  expect_color(color_near(loaded.object, 1.5, 0.5), 1, 1, 1);
}

TEST(Load, TextureOptionReplacesEverything) {
  ModelFolder folder;
  obj_in(folder);
  LoadOptions options;
  options.texture = folder.write("other.png", fixtures::png_of(1, 1, {{255, 0, 255}}));
  const LoadedObject loaded = load((folder / "squares.obj"), options);
  expect_color(color_near(loaded.object, 0.25, 0.75), 1, 0, 1);
  expect_color(color_near(loaded.object, 1.5, 0.5), 1, 0, 1);
  EXPECT_EQ(loaded.object.textures.size(), 1u);
}

TEST(Load, TextureOptionNeedsUvsAndAPicture) {
  ModelFolder folder;
  obj_in(folder);
  LoadOptions options;
  options.texture = (folder / "left.png");
  EXPECT_NE(refusal(folder.write("a.stl", fixtures::binary_stl()), options).find("UVs"),
            std::string::npos);
  options.texture = (folder / "none.png");
  EXPECT_NE(refusal((folder / "squares.obj"), options).find("none.png"), std::string::npos);
}

TEST(Load, ObjContinuationsNegativeIndicesAndConcavePolygons) {
  ModelFolder folder;
  // An L shape of area 3: a fan from its first corner would cover the notch.
  const LoadedObject loaded =
      load(folder.write("l.obj",
                        "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
                        "f -5 -4 \\\n -3 -2 -1 -6\n"));
  EXPECT_EQ(loaded.health.triangles, 4);
  EXPECT_NEAR(loaded.health.area_mm2, 3, 1e-9);
}

TEST(Load, PlyWithVertexColours) {
  ModelFolder folder;
  for (const auto& path : {folder.write("ascii.ply", fixtures::ascii_ply_text()),
                           folder.write("little.ply", fixtures::binary_ply(false)),
                           folder.write("big.PLY", fixtures::binary_ply(true))}) {
    const LoadedObject loaded = load(path);
    expect_squares(loaded);
    expect_color(color_near(loaded.object, 0.5, 0.5), 1, 0, 0);
    // Half-way between red and blue in linear light.
    expect_color(color_near(loaded.object, 1.5, 0), 0.5f, 0, 0.5f);
  }
}

TEST(Load, PlyBytesAreSrgb) {
  ModelFolder folder;
  std::string text = fixtures::ascii_ply_text();
  for (std::size_t at; (at = text.find("255 0 0")) != std::string::npos;) {
    text.replace(at, 7, "128 0 64");
  }
  const LoadedObject loaded = load(folder.write("a.ply", text));
  expect_color(color_near(loaded.object, 0.5, 0.5), srgb8_to_linear(128), 0, srgb8_to_linear(64));
}

TEST(Load, StlAndOff) {
  ModelFolder folder;
  expect_squares(load(folder.write("ascii.stl", fixtures::ascii_stl_text())));
  expect_squares(load(folder.write("binary.stl", fixtures::binary_stl())));
  expect_squares(load(folder.write("plain.off", fixtures::off_text())));
  const LoadedObject plain = load((folder / "binary.stl"));
  EXPECT_FALSE(plain.object.has_appearance());
  expect_color(color_near(plain.object, 0.5, 0.5), 1, 1, 1);
  const LoadedObject colored = load(folder.write("colored.off", fixtures::coff_text()));
  expect_squares(colored);
  expect_color(color_near(colored.object, 0.5, 0.5), 1, 0, 0);
}

TEST(Load, ThreeMfUnitsTransformsAndColours) {
  ModelFolder folder;
  const std::pair<const char*, double> units[] = {
      {"", 1},         {"millimeter", 1}, {"centimeter", 10}, {"inch", 25.4},
      {"foot", 304.8}, {"meter", 1000},   {"micron", 0.001}};
  for (const auto& [unit, mm] : units) {
    const LoadedObject loaded = load(folder.write("a.3mf", fixtures::threemf(unit)));
    expect_squares(loaded, mm);
    EXPECT_TRUE(loaded.units_are_told);  // millimetres where it is left out
    expect_color(color_near(loaded.object, 0.5 * mm, 0.5 * mm), 1, 0, 0);
    expect_color(color_near(loaded.object, 1.5 * mm, 0.5 * mm), 0, 0, 1);
  }
  LoadOptions options;
  options.units = "cm";
  expect_squares(load((folder / "a.3mf"), options), 10);
}

TEST(Load, GlbTexturesMaterialsNodesAndMetres) {
  ModelFolder folder;
  const LoadedObject loaded = load(folder.write("a.glb", fixtures::glb()));
  EXPECT_EQ(loaded.units, "m");
  EXPECT_TRUE(loaded.units_are_told);
  expect_squares(loaded, 1000);
  // UVs run to 2: the left square shows the picture four times.
  for (const double x : {0.0, 500.0}) {
    for (const double y : {0.0, 500.0}) {
      expect_color(color_near(loaded.object, x + 125, y + 375), 1, 0, 0);
      expect_color(color_near(loaded.object, x + 375, y + 375), 0, 1, 0);
      expect_color(color_near(loaded.object, x + 125, y + 125), 0, 0, 1);
    }
  }
  // glTF's factors are linear.
  expect_color(color_near(loaded.object, 1500, 500), 1, 0.5f, 0);
  LoadOptions options;
  options.units = "mm";
  expect_squares(load((folder / "a.glb"), options));
}

TEST(Load, GltfTextWithEmbeddedAndExternalData) {
  ModelFolder folder;
  expect_squares(load(folder.write("a.gltf", fixtures::gltf_text())), 1000);
  folder.write("with blank.bin", fixtures::gltf_bin({}));
  const LoadedObject loaded = load(folder.write("b.gltf", fixtures::gltf_text("with%20blank.bin")));
  expect_squares(loaded, 1000);
  EXPECT_EQ(loaded.files.size(), 2u);
  expect_color(color_near(loaded.object, 125, 375), 1, 0, 0);
  EXPECT_NE(refusal(folder.write("c.gltf", fixtures::gltf_text("none.bin"))).find("none.bin"),
            std::string::npos);
}

TEST(Load, GlbWrapModes) {
  ModelFolder folder;
  GlbOptions options;
  options.wrap_s = 33648;  // mirrored
  options.wrap_t = 33071;  // clamped
  const LoadedObject loaded = load(folder.write("a.glb", fixtures::glb(options)));
  // u = 1.25 mirrors to 0.75. In glTF v runs down from the upper edge; the picture fills the upper
  // half and its bottom row (blue, white) extends below.
  expect_color(color_near(loaded.object, 125, 875), 1, 0, 0);
  expect_color(color_near(loaded.object, 625, 875), 0, 1, 0);
  expect_color(color_near(loaded.object, 875, 875), 1, 0, 0);
  expect_color(color_near(loaded.object, 125, 100), 0, 0, 1);
  expect_color(color_near(loaded.object, 375, 100), 1, 1, 1);
}

TEST(Load, GlbAlphaModes) {
  ModelFolder folder;
  GlbOptions options;
  options.png = fixtures::png_of(1, 1, {{255, 255, 255, 51}});
  options.factor = "1,1,1,0.5";
  const LinearColor base{0, 1, 0, 1};
  const auto red_part = [&](const char* mode) {
    options.alpha_mode = mode;
    const LoadedObject loaded = load(folder.write("a.glb", fixtures::glb(options)));
    return color_near(loaded.object, 500, 500, base).r;
  };
  EXPECT_NEAR(red_part("BLEND"), 0.1, 1e-6);
  EXPECT_NEAR(red_part("OPAQUE"), 1, 1e-6);
  EXPECT_NEAR(red_part(""), 1, 1e-6);
  EXPECT_NEAR(red_part("MASK"), 0, 1e-6);
}

TEST(Load, GltfTextureTransform) {
  ModelFolder folder;
  GlbOptions options;
  options.uv_max = 1;
  options.texture_use =
      R"(, "extensions": {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1.5707963267948966}})";
  options.texture_use += "}";
  options.texture_use.pop_back();
  const LoadedObject loaded = load(folder.write("a.glb", fixtures::glb(options)));
  // glTF, v down: (u, v) -> (v, 1 - u): the picture's left column becomes ... its point (u, v)
  // shows what lies at (v, 1 - u). The upper left corner of the square shows the lower left of the
  // picture.
  expect_color(color_near(loaded.object, 250, 750), 0, 0, 1);
  expect_color(color_near(loaded.object, 750, 750), 1, 0, 0);
  expect_color(color_near(loaded.object, 250, 250), 1, 1, 1);
  expect_color(color_near(loaded.object, 750, 250), 0, 1, 0);
}

TEST(Load, UnitsOption) {
  ModelFolder folder;
  const auto path = folder.write("a.stl", fixtures::binary_stl());
  LoadOptions options;
  for (const auto& [name, mm] : {std::pair{"mm", 1.0}, {"cm", 10.0}, {"m", 1000.0}, {"in", 25.4}}) {
    options.units = name;
    expect_squares(load(path, options), mm);
  }
  options.units = "furlong";
  EXPECT_NE(refusal(path, options).find("furlong"), std::string::npos);
}

// ---- refusals -----------------------------------------------------------------------------------

TEST(LoadRefuses, MissingEmptyAndUnknownFiles) {
  ModelFolder folder;
  EXPECT_NE(refusal((folder / "none.obj")).find("none.obj"), std::string::npos);
  EXPECT_NE(refusal(folder.write("a.xyz", std::string("1 2 3"))).find(".xyz"), std::string::npos);
  std::filesystem::create_directory(folder / "models");
  EXPECT_NE(refusal(folder / "models").find("it is a folder"), std::string::npos);
  for (const char* name : {"a.obj", "a.ply", "a.stl", "a.off", "a.3mf", "a.gltf", "a.glb"}) {
    EXPECT_NE(refusal(folder.write(name, std::string())).find("empty"), std::string::npos) << name;
  }
}

TEST(LoadRefuses, RandomBytesUnderEveryName) {
  ModelFolder folder;
  std::mt19937 random(1);
  for (const std::size_t size : {1u, 15u, 100u, 3000u}) {
    Bytes bytes(size);
    for (auto& byte : bytes) byte = std::uint8_t(random());
    for (const char* name : {"a.obj", "a.ply", "a.stl", "a.off", "a.3mf", "a.gltf", "a.glb"}) {
      EXPECT_NE(refusal(folder.write(name, bytes)).find(name), std::string::npos) << name;
    }
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST(LoadRefuses, FaceIndicesOutOfRange) {
  ModelFolder folder;
  const std::string obj = fixtures::obj_text();
  EXPECT_NE(refusal(folder.write("a.obj", replaced(obj, "6/3", "7/3"))).find("vertex 7"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("b.obj", replaced(obj, "6/3", "6/9"))).find("coordinate 9"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("c.obj", replaced(obj, "6/3", "0/3"))), "");
  EXPECT_NE(refusal(folder.write("d.obj", replaced(obj, "6/3", "-7/3"))), "");
  EXPECT_NE(
      refusal(folder.write("a.ply", replaced(fixtures::ascii_ply_text(), "4 1 2 5 4", "4 1 2 6 4")))
          .find("vertex 6"),
      std::string::npos);
  EXPECT_NE(refusal(folder.write("a.off", replaced(fixtures::off_text(), "4 1 2 5 4", "4 1 2 6 4")))
                .find("vertex 6"),
            std::string::npos);
  Bytes ply = fixtures::binary_ply(false);
  ply[ply.size() - 4] = 200;
  EXPECT_NE(refusal(folder.write("b.ply", ply)).find("vertex 200"), std::string::npos);
  Bytes bytes = fixtures::glb();
  const std::string json_end = "BIN";
  const auto bin = std::search(bytes.begin(), bytes.end(), json_end.begin(), json_end.end()) + 4;
  *(bin + 80) = 9;  // the first index
  EXPECT_NE(refusal(folder.write("a.glb", bytes)).find("vertex 9"), std::string::npos);
  EXPECT_NE(
      refusal(folder.write("a.3mf", fixtures::zip_of(
                                        {{"_rels/.rels", "<Relationships/>"},
                                         {"3D/3dmodel.model",
                                          "<model><resources><object id=\"1\"><mesh><vertices>"
                                          "<vertex x=\"0\" y=\"0\" z=\"0\"/></vertices><triangles>"
                                          "<triangle v1=\"0\" v2=\"0\" v3=\"5\"/></triangles>"
                                          "</mesh></object></resources></model>"}})))
          .find("vertex 5"),
      std::string::npos);
}

TEST(LoadRefuses, CoordinatesThatAreNotFinite) {
  ModelFolder folder;
  for (const char* bad : {"nan", "inf", "-inf", "1e60", "abc"}) {
    EXPECT_NE(refusal(folder.write("a.obj", replaced(fixtures::obj_text(), "v 2 0 0",
                                                     std::string("v 2 ") + bad + " 0"))),
              "")
        << bad;
    EXPECT_NE(refusal(folder.write("a.ply", replaced(fixtures::ascii_ply_text(), "\n2 0 0 ",
                                                     std::string("\n2 ") + bad + " 0 "))),
              "")
        << bad;
    EXPECT_NE(refusal(folder.write("a.off", replaced(fixtures::off_text(), "\n2 0 0",
                                                     std::string("\n2 ") + bad + " 0"))),
              "")
        << bad;
    EXPECT_NE(refusal(folder.write("a.stl", replaced(fixtures::ascii_stl_text(), "vertex 1 0 0",
                                                     std::string("vertex 1 ") + bad + " 0"))),
              "")
        << bad;
  }
  const float nan = std::nanf("");
  Bytes stl = fixtures::binary_stl();
  std::memcpy(&stl[84 + 12], &nan, 4);
  EXPECT_NE(refusal(folder.write("b.stl", stl)).find("finite"), std::string::npos);
  Bytes ply = fixtures::binary_ply(false);
  std::memcpy(&ply[ply.size() - 34 - 90], &nan, 4);
  EXPECT_NE(refusal(folder.write("b.ply", ply)).find("finite"), std::string::npos);
  Bytes gltf = fixtures::glb();
  const std::string mark = "BIN";
  const auto bin = std::search(gltf.begin(), gltf.end(), mark.begin(), mark.end()) + 4;
  std::memcpy(&*bin, &nan, 4);
  EXPECT_NE(refusal(folder.write("b.glb", gltf)).find("finite"), std::string::npos);
}

TEST(LoadRefuses, SizesThatTheFileCannotHold) {
  ModelFolder folder;
  Bytes stl = fixtures::binary_stl();
  stl.pop_back();
  EXPECT_NE(refusal(folder.write("a.stl", stl)).find("bytes"), std::string::npos);
  stl[80] = stl[81] = stl[82] = stl[83] = 255;
  EXPECT_NE(refusal(folder.write("a.stl", stl)).find("bytes"), std::string::npos);
  EXPECT_NE(refusal(folder.write(
                "a.ply", replaced(fixtures::ascii_ply_text(), "vertex 6", "vertex 4000000000"))),
            "");
  EXPECT_NE(
      refusal(folder.write("a.off", replaced(fixtures::off_text(), "6 2 0", "4000000000 2 0"))),
      "");
  EXPECT_NE(refusal(folder.write("a.gltf", replaced(fixtures::gltf_text(), "\"count\": 6",
                                                    "\"count\": 4000000000"))),
            "");
  EXPECT_NE(refusal(folder.write("b.gltf", std::string(1000000, '['))), "");
}

TEST(LoadRefuses, NodesThatLoop) {
  ModelFolder folder;
  EXPECT_NE(refusal(folder.write("a.gltf", replaced(fixtures::gltf_text(), "{\"mesh\": 0}",
                                                    "{\"mesh\": 0, \"children\": [0]}")))
                .find("loop"),
            std::string::npos);
}

// ---- damage -------------------------------------------------------------------------------------

struct Sample {
  std::string name;
  Bytes bytes;
};

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::vector<Sample> samples_of_every_kind() {
  return {{"a.obj", bytes_of(fixtures::obj_text())},
          {"ascii.ply", bytes_of(fixtures::ascii_ply_text())},
          {"binary.ply", fixtures::binary_ply(false)},
          {"ascii.stl", bytes_of(fixtures::ascii_stl_text())},
          {"binary.stl", fixtures::binary_stl()},
          {"a.off", bytes_of(fixtures::off_text())},
          {"c.off", bytes_of(fixtures::coff_text())},
          {"a.3mf", fixtures::threemf("inch")},
          {"a.gltf", bytes_of(fixtures::gltf_text())},
          {"a.glb", fixtures::glb()}};
}

// A changed byte, a changed bit, a cut, a repeated or a removed piece.
Bytes damaged(Bytes bytes, std::mt19937& random) {
  const auto place = [&] { return std::size_t(random() % bytes.size()); };
  const unsigned rounds = 1 + random() % 3;
  for (unsigned i = 0; i < rounds && !bytes.empty(); ++i) {
    const std::size_t a = place(), b = std::min(bytes.size(), a + 1 + random() % 20);
    const auto begin = bytes.begin() + std::ptrdiff_t(a), end = bytes.begin() + std::ptrdiff_t(b);
    switch (random() % 6) {
      case 0:
        bytes[a] = std::uint8_t(random());
        break;
      case 1:
        bytes[a] ^= std::uint8_t(1u << random() % 8);
        break;
      case 2:
        bytes[a] = std::uint8_t("0123456789-. e/\n"[random() % 16]);
        break;
      case 3:
        bytes.resize(a);
        break;
      case 4:
        bytes.erase(begin, end);
        break;
      default: {
        const Bytes piece(begin, end);
        const std::size_t at = place();
        bytes.insert(bytes.begin() + std::ptrdiff_t(at), piece.begin(), piece.end());
      }
    }
  }
  return bytes;
}

TEST(Load, DamagedFilesEndInAResultOrARefusal) {
  ModelFolder folder;
  obj_in(folder);
  std::mt19937 random(20151);
  const char* count = std::getenv("HYDRODIP_FUZZ");
  const int variants = count ? std::stoi(count) : 60;
  for (const Sample& sample : samples_of_every_kind()) {
    int refused = 0;
    for (int i = 0; i < variants; ++i) {
      const auto path = folder.write(sample.name, damaged(sample.bytes, random));
      try {
        const LoadedObject loaded = load(path);
        EXPECT_FALSE(loaded.object.triangles.empty());
        EXPECT_TRUE(std::isfinite(loaded.object.bounds().size().norm()));
      } catch (const InputError& error) {
        ++refused;
        EXPECT_NE(std::string(error.what()).find(sample.name), std::string::npos) << error.what();
      }
    }
    EXPECT_GT(refused, 0) << sample.name;
  }
}

TEST(Load, DamagedMtlNeverStopsTheModel) {
  ModelFolder folder;
  obj_in(folder).write("squares.mtl", std::string("Kd 1 0 0\nmap_Kd left.png\nd 1\n"));
  expect_squares(load((folder / "squares.obj")));
  std::mt19937 random(7);
  for (int i = 0; i < 100; ++i) {
    folder.write("squares.mtl", damaged(bytes_of(fixtures::mtl_text()), random));
    expect_squares(load((folder / "squares.obj")));
  }
}

TEST(Load, MapOptionsAndBlanksInNames) {
  ModelFolder folder;
  obj_in(folder).write("squares.mtl",
                       "newmtl left\nmap_Kd -bm 1 -mm 0 1 -o 0 0 0 -blendu on  a picture.png \n");
  folder.write("a picture.png", fixtures::four_colour_png());
  expect_color(color_near(load((folder / "squares.obj")).object, 0.25, 0.75), 1, 0, 0);
}

}  // namespace
}  // namespace hydrodip
