// Features of each format that people's files have: docs/formats.md, line by line.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/file.h"
#include "contains.h"
#include "model_io/load.h"
#include "model_io/model_files.h"
#include "model_io/packed.h"

namespace hydrodip {
namespace {

using fixtures::Bytes;
using fixtures::ModelFolder;

struct Loaded {
  LoadedObject object;
  std::vector<std::string> warnings;
};

Loaded load(const std::filesystem::path& path, const LoadOptions& options = {}) {
  RunContext context;
  LoadedObject object = load_object(path, options, context);
  return {std::move(object), context.warnings()};
}

std::string refusal_of(const std::filesystem::path& path, const LoadOptions& options = {}) {
  try {
    load(path, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool warned(const Loaded& loaded, const std::string& of) {
  for (const std::string& warning : loaded.warnings)
    if (contains(warning, of)) return true;
  return false;
}

// The colour at a point of the plane z = 0 over black, as sRGB bytes.
std::array<int, 3> seen_at(const Loaded& loaded, double x, double y) {
  const Object& object = loaded.object.object;
  for (std::size_t f = 0; f < object.triangles.size(); ++f) {
    const Triangle& t = object.triangles[f];
    const Vec2 a = object.positions[std::size_t(t[0])].head<2>();
    const Vec2 ab = object.positions[std::size_t(t[1])].head<2>() - a;
    const Vec2 ac = object.positions[std::size_t(t[2])].head<2>() - a;
    const double area = cross2(ab, ac);
    const double u = cross2(Vec2(x, y) - a, ac) / area;
    const double v = cross2(ab, Vec2(x, y) - a) / area;
    if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
    const LinearColor color = color_at(object, {int(f), u, v}, {0, 0, 0, 1});
    return {linear_to_srgb8(color.r), linear_to_srgb8(color.g), linear_to_srgb8(color.b)};
  }
  ADD_FAILURE() << "no triangle at " << x << ", " << y;
  return {};
}

using Rgb = std::array<int, 3>;
constexpr Rgb kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255}, kWhite{255, 255, 255},
    kBlack{0, 0, 0};

// A unit square with the four-colour picture on it: red and green above, blue and white below.
void expect_four_colours(const Loaded& loaded) {
  EXPECT_EQ(seen_at(loaded, 0.25, 0.75), kRed);
  EXPECT_EQ(seen_at(loaded, 0.75, 0.75), kGreen);
  EXPECT_EQ(seen_at(loaded, 0.25, 0.25), kBlue);
  EXPECT_EQ(seen_at(loaded, 0.75, 0.25), kWhite);
}

// An OBJ of that square; what stands before it and how its material looks.
class Formats : public ::testing::Test {
 protected:
  Formats() { folder_.write("tex.png", fixtures::four_colour_png()); }

  Loaded obj(const std::string& mtl, const std::string& head = "mtllib a.mtl\n") {
    folder_.write("a.mtl", mtl);
    return load(folder_.write("a.obj", head + kSquare));
  }

  static constexpr const char* kSquare =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
      "usemtl m\nf 1/1 2/2 3/3 4/4\n";
  ModelFolder folder_;
};

// ---- OBJ ----------------------------------------------------------------------------------------

TEST_F(Formats, ObjByteOrderMarks) {
  const std::string bom = "\xef\xbb\xbf";
  expect_four_colours(obj("newmtl m\nmap_Kd tex.png\n", bom + "mtllib a.mtl\n"));
  expect_four_colours(obj(bom + "newmtl m\nmap_Kd tex.png\n"));
}

// As Windows' shell and editors save "Unicode", in either byte order; 😀 takes two units.
std::string utf16(std::u16string_view text, bool big) {
  std::string out;
  for (const char16_t unit : std::u16string(1, u'\xfeff') + std::u16string(text)) {
    const char low = char(unit & 0xff), high = char(unit >> 8);
    out += big ? high : low;
    out += big ? low : high;
  }
  return out;
}

TEST_F(Formats, TextInUtf16) {
  for (const bool big : {false, true}) {
    const Loaded library = obj(utf16(u"newmtl m\r\nmap_Kd tex.png\r\n", big));
    expect_four_colours(library);
    EXPECT_TRUE(library.warnings.empty());
    const std::string square(kSquare);
    expect_four_colours(load(folder_.write(
        "a.obj", utf16(u"mtllib a.mtl\n" + std::u16string(square.begin(), square.end()), big))));
    folder_.write("Größe 😀.png", fixtures::four_colour_png());
    expect_four_colours(obj(utf16(u"newmtl m\nmap_Kd Größe 😀.png\n", big)));
    const Loaded off =
        load(folder_.write("a.off", utf16(u"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", big)));
    EXPECT_EQ(off.object.object.triangles.size(), 1U);
  }
  // Half a character at the end is no reason to read on.
  std::string cut = utf16(u"newmtl m\nmap_Kd tex.png\n", false) + "\x3d\xd8";
  expect_four_colours(obj(cut));
  expect_four_colours(obj(cut + "\n"));
}

TEST_F(Formats, NamesInQuotationMarks) {
  folder_.write("my materials.mtl", std::string("newmtl m\nmap_Kd \"tex.png\"\n"));
  const Loaded loaded = obj("", "mtllib \"my materials.mtl\"\n");
  expect_four_colours(loaded);
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST_F(Formats, ObjSeveralLibrariesInOneLineOrSeveral) {
  folder_.write("b.mtl", std::string("newmtl q\nKd 1 0 0\n"));
  folder_.write("c d.mtl", std::string("newmtl m\nmap_Kd tex.png\n"));
  expect_four_colours(obj("newmtl m\nmap_Kd tex.png\n", "mtllib b.mtl a.mtl\n"));
  expect_four_colours(obj("newmtl z\nKd 1 0 0\n", "mtllib b.mtl\nmtllib a.mtl\nmtllib c d.mtl\n"));
}

// However often and in whatever way they are named: thousands of spellings would cost as many
// reads.
TEST_F(Formats, FilesAreReadOnceByWhateverName) {
  folder_.write("a.mtl",
                std::string("newmtl m\nTr 1\nmap_Kd tex.png\nnewmtl n\nmap_Kd ./TEX.png\n"));
  const Loaded loaded = load(folder_.write(
      "a.obj", std::string("mtllib a.mtl\nmtllib ./a.mtl\nmtllib A.MTL\nmtllib C:\\me\\a.mtl\n") +
                   kSquare + "usemtl n\nv 2 0 0\nv 3 0 0\nv 3 1 0\nf 5/1 6/2 7/3\n"));
  EXPECT_EQ(std::count_if(loaded.warnings.begin(), loaded.warnings.end(),
                          [](const std::string& said) { return contains(said, "Tr 1"); }),
            1);
  EXPECT_EQ(loaded.object.object.materials.size(), 2U);
  EXPECT_EQ(loaded.object.object.textures.size(), 1U);
}

TEST_F(Formats, ObjLineEndsOfAllSystems) {
  std::string text = std::string("mtllib a.mtl\n") + kSquare;
  folder_.write("a.mtl", std::string("newmtl m\rmap_Kd tex.png\r"));
  for (const char* end : {"\r\n", "\r"}) {
    std::string other;
    for (const char c : text) other += c == '\n' ? std::string(end) : std::string(1, c);
    expect_four_colours(load(folder_.write("a.obj", other)));
  }
}

TEST_F(Formats, MtlMapOptions) {
  // Twice as many: the whole picture fills the lower left quarter.
  const Loaded tiled = obj("newmtl m\nmap_Kd -s 2 2 1 tex.png\n");
  EXPECT_EQ(seen_at(tiled, 0.125, 0.375), kRed);
  EXPECT_EQ(seen_at(tiled, 0.375, 0.375), kGreen);
  EXPECT_EQ(seen_at(tiled, 0.625, 0.875), kRed);
  const Loaded shifted = obj("newmtl m\nmap_Kd -o 0.5 tex.png\n");
  EXPECT_EQ(seen_at(shifted, 0.25, 0.75), kGreen);
  EXPECT_EQ(seen_at(shifted, 0.75, 0.75), kRed);
  const Loaded both = obj("newmtl m\nmap_Kd -o 0.5 0 0 -s 2 2 1 tex.png\n");
  EXPECT_EQ(seen_at(both, 0.125, 0.375), kGreen);
  // Half as strong on a base of half: c -> 0.5 + 0.5 c.
  const Loaded ranged = obj("newmtl m\nmap_Kd -mm 0.5 0.5 tex.png\n");
  EXPECT_EQ(seen_at(ranged, 0.25, 0.75), (Rgb{255, 128, 128}));
  const Loaded clamped = obj("newmtl m\nmap_Kd -clamp on -s 2 2 2 tex.png\n");
  EXPECT_EQ(seen_at(clamped, 0.9, 0.9), kGreen);
  expect_four_colours(obj("newmtl m\nmap_Kd -blendu on -bm 1 -texres 512 \"tex.png\"\n"));
}

TEST_F(Formats, MtlTransparencyThatMeansOpaque) {
  const Loaded meshlab = obj("newmtl m\nTr 1.000000\nmap_Kd tex.png\n");
  expect_four_colours(meshlab);
  EXPECT_TRUE(warned(meshlab, "Tr 1"));
  const Loaded both = obj("newmtl m\nd 1\nTr 1\nmap_Kd tex.png\n");
  expect_four_colours(both);
  EXPECT_TRUE(both.warnings.empty());
  const Loaded gone = obj("newmtl m\nd 0\nmap_Kd tex.png\n");
  EXPECT_EQ(seen_at(gone, 0.25, 0.75), kBlack);
  EXPECT_TRUE(warned(gone, "d 0"));
  const Loaded half = obj("newmtl m\nTr 0.5\nKd 1 1 1\n");
  EXPECT_EQ(seen_at(half, 0.5, 0.5)[0], linear_to_srgb8(0.5F));
}

TEST_F(Formats, MtlPicturesOfTransparencyAreSaid) {
  EXPECT_TRUE(warned(obj("newmtl m\nmap_Kd tex.png\nmap_d other.png\n"), "map_d: m"));
  // Its own alpha counts anyway.
  EXPECT_TRUE(obj("newmtl m\nmap_Kd tex.png\nmap_d -imfchan m tex.png\n").warnings.empty());
}

TEST_F(Formats, PicturesByAnyLetterCaseAndWindowsPath) {
  std::filesystem::create_directory(folder_ / "Textures");
  folder_.write("Textures/Wood Grain.PNG", fixtures::four_colour_png());
  for (const char* name :
       {"TEX.PNG", "C:\\work\\tex.png", ".\\Tex.png", "textures\\wood grain.png",
        "Textures/Wood%20Grain.PNG", "D:\\me\\model\\textures\\wood grain.png",
        "/home/me/Textures/Wood%20Grain.PNG", "../model/Textures/Wood Grain.PNG"})
    expect_four_colours(obj(fmt::format("newmtl m\nmap_Kd {}\n", name)));
}

TEST_F(Formats, MissingFilesAreNamedWithWhoAsksForThem) {
  const Loaded loaded = obj("newmtl m\nmap_Kd nothere.png\n");
  EXPECT_TRUE(warned(loaded, "nothere.png that a.mtl refers to"));
  ASSERT_EQ(loaded.object.picture_problems.size(), 1u);
  std::filesystem::remove(folder_ / "a.mtl");
  const Loaded without = load(folder_.write("b.obj", "mtllib gone.mtl\n" + std::string(kSquare)));
  EXPECT_TRUE(warned(without, "gone.mtl that b.obj refers to"));
  EXPECT_EQ(without.object.picture_problems.size(), 1u);
  std::string very_many;
  for (int i = 0; i < 1000; ++i) very_many += fmt::format("mtllib gone{}.mtl\n", i);
  EXPECT_LT(load(folder_.write("c.obj", very_many + kSquare)).warnings.size(), 30u);
  EXPECT_TRUE(warned(obj("newmtl other\nKd 1 0 0\n"), "no material library defines (m)"));
}

TEST_F(Formats, ObjWeightsOfVertices) {
  const Object object =
      load(folder_.write("w.obj", "v 0 0 0 2\nv 4 0 0 2\nv 0 4 8 4\nf 1 2 3\n")).object.object;
  EXPECT_EQ(object.bounds().max, Vec3(2, 1, 2));
}

TEST_F(Formats, ObjTheFirstDefinitionOfAMaterialCounts) {
  folder_.write("m.mtl", "newmtl a\nKd 1 0 0\nnewmtl a\nKd 0 0 1\n");
  const Loaded loaded =
      load(folder_.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"));
  EXPECT_EQ(seen_at(loaded, 0.2, 0.2), kRed);
}

TEST_F(Formats, ObjColoursOfVertices) {
  const auto corner_color = [&](const char* colors) {
    return seen_at(load(folder_.write("a.obj", fmt::format("v 0 0 0 {0}\nv 1 0 0 {0}\nv 0 1 0 {0}\n"
                                                           "f 1 2 3\n",
                                                           colors))),
                   0.2, 0.2);
  };
  EXPECT_EQ(corner_color("1 0.5 0"), (Rgb{255, 128, 0}));
  EXPECT_EQ(corner_color("255 128 0"), (Rgb{255, 128, 0}));
}

TEST_F(Formats, ObjSmallestAndLargestIndices) {
  for (const char* index :
       {"-9223372036854775808", "9223372036854775807", "99999999999999999999", "-4", "4"}) {
    const auto path =
        folder_.write("a.obj", fmt::format("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {}\n", index));
    EXPECT_TRUE(contains(refusal_of(path), "line 4")) << index;
  }
}

// Time and memory of these grew with the square.
using FormatsSlow = Formats;
TEST_F(FormatsSlow, ManyGroupsMaterialsAndCornersStayLinear) {
  const std::string square = "v 0 0 0\nv 20 0 0\nv 20 20 0\nv 0 20 0\n";
  std::string groups = square, materials = square, face = square + "f";
  for (int k = 0; k < 60000; ++k) {
    groups += fmt::format("o part{}\nf 1 2 3\n", k);
    materials += fmt::format("usemtl m{}\nf 1 2 3\n", k);
  }
  for (int k = 0; k < 300000; ++k) face += fmt::format(" {}", 1 + k % 4);
  EXPECT_EQ(load(folder_.write("g.obj", groups)).object.health.triangles, 1);
  EXPECT_EQ(load(folder_.write("m.obj", materials)).object.health.triangles, 1);
  EXPECT_LE(load(folder_.write("f.obj", face + "\n")).object.health.triangles, 4);
}

TEST_F(Formats, ReadingCanBeCancelled) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int k = 0; k < 10000; ++k) text += "f 1 2 3\n";
  RunContext context;
  context.cancel();
  EXPECT_THROW(load_object(folder_.write("a.obj", text), {}, context), Cancelled);
}

TEST_F(Formats, OneStatedColourIsAPicture) {
  EXPECT_TRUE(obj("newmtl m\nKd 1 0 0\n").object.object.has_appearance());
  EXPECT_FALSE(obj("newmtl m\nKd 1 1 1\n").object.object.has_appearance());
  EXPECT_FALSE(obj("newmtl m\n").object.object.has_appearance());
  EXPECT_TRUE(warned(obj("newmtl m\nKd 1 0 0\n"), "#ff0000"));
}

// ---- PLY ----------------------------------------------------------------------------------------

std::string ply_square(const std::string& comments, const std::string& face_properties,
                       const std::string& face) {
  return "ply\nformat ascii 1.0\n" + comments +
         "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\n" +
         face_properties + "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3" + face + "\n";
}

TEST_F(Formats, PlyCoordinatesOfFacesAndTrailingBlanks) {
  for (const char* comment :
       {"comment TextureFile tex.png\n", "comment TextureFile tex.png  \t\n",
        "comment TextureFile tex.png\r\n", "comment TextureFile \"tex.png\"\n"})
    expect_four_colours(
        load(folder_.write("a.ply", ply_square(comment, "property list uchar float texcoord\n",
                                               " 8 0 0 1 0 1 1 0 1"))));
}

TEST_F(Formats, PlySeveralPictures) {
  folder_.write("other.png", fixtures::png_of(1, 1, {{9, 8, 7}}));
  const std::string text = ply_square(
      "comment TextureFile other.png\ncomment TextureFile tex.png\n",
      "property list uchar float texcoord\nproperty int texnumber\n", " 8 0 0 1 0 1 1 0 1 1");
  expect_four_colours(load(folder_.write("a.ply", text)));
}

TEST_F(Formats, PlyPicturesNamedAfterTheModel) {
  folder_.write("a_0.png", fixtures::four_colour_png());
  expect_four_colours(load(folder_.write(
      "a.ply", ply_square("comment TextureFile <this>_0.png\n",
                          "property list uchar float texcoord\n", " 8 0 0 1 0 1 1 0 1"))));
}

TEST_F(Formats, PlyColoursOfFaces) {
  const std::string text = ply_square(
      "", "property uchar red\nproperty uchar green\nproperty uchar blue\n", " 10 200 30");
  EXPECT_EQ(seen_at(load(folder_.write("a.ply", text)), 0.5, 0.5), (Rgb{10, 200, 30}));
}

// Fractions, two bytes and one byte that all count up to 255.
TEST_F(Formats, PlyColoursThatCountTo255) {
  for (const char* type : {"uchar", "ushort", "int", "float", "double"}) {
    const std::string text = ply_square(
        "", fmt::format("property {0} red\nproperty {0} green\nproperty {0} blue\n", type),
        " 10 200 30");
    EXPECT_EQ(seen_at(load(folder_.write("a.ply", text)), 0.5, 0.5), (Rgb{10, 200, 30})) << type;
  }
  for (const auto& [type, values] :
       {std::pair{"float", " 1 0.5 0"}, std::pair{"ushort", " 65535 32768 0"}}) {
    const std::string text = ply_square(
        "", fmt::format("property {0} red\nproperty {0} green\nproperty {0} blue\n", type), values);
    EXPECT_EQ(seen_at(load(folder_.write("a.ply", text)), 0.5, 0.5), (Rgb{255, 128, 0})) << type;
  }
}

TEST_F(Formats, PlyDataThatBeginsLikeALineEnd) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\n"
      "property uchar y\nproperty uchar z\nelement face 1\n"
      "property list uchar uchar vertex_indices\nend_header\n";
  const char body[] = {10, 0, 0, 13, 0, 0, 10, 5, 0, 3, 0, 1, 2};
  text.append(body, sizeof body);
  const Loaded loaded = load(folder_.write("a.ply", text));
  EXPECT_EQ(loaded.object.object.bounds().size(), Vec3(3, 5, 0));
}

TEST_F(Formats, SentencesGoOnAfterANulByte) {
  constexpr char kText[] = "ply\nformat ascii 1.0\nelement ver\0tex\nend_header\n";
  const std::string text(kText, sizeof kText - 1);
  EXPECT_TRUE(contains(refusal_of(folder_.write("a.ply", text)), "'ver?tex' has no valid count"));
}

TEST_F(Formats, PlyTriangleStrips) {
  const Loaded loaded = load(folder_.write(
      "a.ply", std::string("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                           "property float y\nproperty float z\nelement tristrips 1\n"
                           "property list int int vertex_indices\nend_header\n"
                           "0 0 0\n1 0 0\n0 1 0\n1 1 0\n5 0 1 2 3 -1\n")));
  EXPECT_EQ(loaded.object.health.triangles, 2);
  EXPECT_EQ(loaded.object.health.flipped, 0);
  EXPECT_NEAR(loaded.object.health.area_mm2, 1, 1e-9);
}

// ---- OFF and STL --------------------------------------------------------------------------------

TEST_F(Formats, OffFacesOfAnySizeAndTheirColours) {
  std::string text = "OFF12 2 0\n", face = "12";
  for (int i = 0; i < 12; ++i) {
    text += fmt::format("{} {} 0\n", std::cos(i * M_PI / 6), std::sin(i * M_PI / 6));
    face += fmt::format(" {}", i);
  }
  text += face + " 255 0 0\n3 0 1 2 0.0 0.0 1.0\n";
  const Loaded loaded = load(folder_.write("a.off", text));
  EXPECT_EQ(loaded.object.health.triangles, 10);
  EXPECT_EQ(seen_at(loaded, -0.1, -0.1), kRed);
}

TEST_F(Formats, OffTextureCoordinatesAndBinaryFiles) {
  LoadOptions options;
  options.texture = folder_ / "tex.png";
  expect_four_colours(
      load(folder_.write("a.off",
                         "STOFF\n4 1 0\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n"
                         "4 0 1 2 3\n"),
           options));
  EXPECT_TRUE(contains(refusal_of(folder_.write("a.off", "OFF BINARY\n")), "export it as text"));
}

// A square of two facets in the plane z = 0 with their colour words.
Bytes stl_square(const std::string& header, std::uint16_t first, std::uint16_t second) {
  Bytes out(header.begin(), header.end());
  out.resize(80, ' ');
  out.insert(out.end(), {2, 0, 0, 0});
  const float corners[2][9] = {{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}};
  for (int f = 0; f < 2; ++f) {
    out.resize(out.size() + 12);
    const auto* raw = reinterpret_cast<const std::uint8_t*>(corners[f]);
    out.insert(out.end(), raw, raw + sizeof corners[f]);
    const std::uint16_t word = f == 0 ? first : second;
    out.insert(out.end(), {std::uint8_t(word), std::uint8_t(word >> 8)});
  }
  return out;
}

TEST_F(Formats, StlColoursOfVisCam) {
  const Loaded loaded =
      load(folder_.write("a.stl", stl_square("viscam", 0x8000 | 31 << 10, 0x8000 | 31)));
  EXPECT_EQ(seen_at(loaded, 0.8, 0.2), kRed);
  EXPECT_EQ(seen_at(loaded, 0.2, 0.8), kBlue);
  const Loaded partly = load(folder_.write("a.stl", stl_square("viscam", 0x8000 | 31 << 10, 31)));
  EXPECT_EQ(seen_at(partly, 0.2, 0.8), kWhite);
  EXPECT_FALSE(
      load(folder_.write("a.stl", stl_square("plain", 31, 0))).object.object.has_appearance());
}

TEST_F(Formats, StlColoursOfMagicsInBothConventions) {
  const std::string header = std::string("solid COLOR=") + '\x00' + '\xff' + '\x00' + '\xff';
  // The manual's: bit 15 clear is the facet's own colour, set is the object's.
  const Loaded manual = load(folder_.write("a.stl", stl_square(header, 31, 0xffff)));
  EXPECT_EQ(seen_at(manual, 0.8, 0.2), kRed);
  EXPECT_EQ(seen_at(manual, 0.2, 0.8), kGreen);
  // MeshLab's and others': set is the facet's own.
  const Loaded other =
      load(folder_.write("a.stl", stl_square(header, 0x8000 | 31, 0x8000 | 31 << 10)));
  EXPECT_EQ(seen_at(other, 0.8, 0.2), kRed);
  EXPECT_EQ(seen_at(other, 0.2, 0.8), kBlue);
  const Loaded whole = load(folder_.write("a.stl", stl_square(header, 0, 0)));
  EXPECT_EQ(seen_at(whole, 0.8, 0.2), kGreen);
}

TEST_F(Formats, StlBytesBehindTheTrianglesAndOpenNumbers) {
  const Bytes plain = stl_square("solid of a writer", 0, 0);
  const auto with = [&](std::array<std::uint8_t, 4> count, std::size_t more) {
    Bytes bytes = plain;
    std::copy(count.begin(), count.end(), bytes.begin() + 80);
    bytes.resize(bytes.size() + more, 7);
    return folder_.write("a.stl", bytes);
  };
  const Loaded footer = load(with({2, 0, 0, 0}, 37));
  EXPECT_EQ(footer.object.health.triangles, 2);
  EXPECT_TRUE(warned(footer, "37 bytes behind its 2 triangles"));
  for (const std::uint8_t byte : {0, 255}) {
    const Loaded open = load(with({byte, byte, byte, byte}, 0));
    EXPECT_EQ(open.object.health.triangles, 2);
    EXPECT_TRUE(warned(open, "it holds 2"));
  }
  EXPECT_NE(refusal_of(with({3, 0, 0, 0}, 0)), "");  // cut off
  EXPECT_NE(refusal_of(with({0, 0, 0, 0}, 1)), "");
}

// ---- glTF ---------------------------------------------------------------------------------------

class Gltf : public Formats {
 protected:
  // A unit square in glTF's frame (ours: z = 0, in metres), textured. All numbers lie in a.bin.
  Gltf() {
    for (const auto& p : {std::array<float, 2>{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      append(positions_, std::array<float, 3>{p[0], 0, -p[1]});
      append(uvs_, std::array<float, 2>{p[0], 1 - p[1]});
    }
    append(indices_, std::array<std::uint16_t, 6>{0, 1, 2, 0, 2, 3});
  }

  template <typename T>
  static void append(Bytes& out, const T& values) {
    const auto* raw = reinterpret_cast<const std::uint8_t*>(values.data());
    out.insert(out.end(), raw, raw + sizeof(values[0]) * values.size());
  }

  // One view and one accessor per part; each part's accessor without its bufferView.
  struct Piece {
    Bytes bytes;
    std::string accessor;
    std::string view_extra;
  };

  std::vector<Piece> plain() const {
    return {{positions_, R"("componentType": 5126, "count": 4, "type": "VEC3")", ""},
            {uvs_, R"("componentType": 5126, "count": 4, "type": "VEC2")", ""},
            {indices_, R"("componentType": 5123, "count": 6, "type": "SCALAR")", ""}};
  }

  Loaded gltf(const std::vector<Piece>& pieces, const std::string& material,
              const std::string& root = "", const std::string& attributes = "",
              const std::string& texture = R"("source": 0)", const std::string& primitive = "") {
    return load(write(pieces, material, root, attributes, texture, primitive));
  }

  std::filesystem::path write(const std::vector<Piece>& pieces, const std::string& material,
                              const std::string& root = "", const std::string& attributes = "",
                              const std::string& texture = R"("source": 0)",
                              const std::string& primitive = "") {
    Bytes bin;
    std::string views, accessors;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      while (bin.size() % 4) bin.push_back(0);
      views += fmt::format(R"({}{{"buffer": 0, "byteOffset": {}, "byteLength": {}{}}})",
                           i ? "," : "", bin.size(), pieces[i].bytes.size(), pieces[i].view_extra);
      if (!pieces[i].accessor.empty())
        accessors += fmt::format(R"({}{{"bufferView": {}, {}}})", accessors.empty() ? "" : ",", i,
                                 pieces[i].accessor);
      bin.insert(bin.end(), pieces[i].bytes.begin(), pieces[i].bytes.end());
    }
    folder_.write("a.bin", bin);
    return folder_.write(
        "a.gltf",
        fmt::format(
            R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1{}}},
"indices": 2, "material": 0{}}}]}}], "materials": [{{{}}}], "textures": [{{{}}}],
"images": [{{"uri": "tex.png"}}], "accessors": [{}], "bufferViews": [{}],
"buffers": [{{"uri": "a.bin", "byteLength": {}}}]{}}})",
            attributes, primitive, material, texture, accessors, views, bin.size(), root));
  }

  // The same with more in its node.
  Loaded with_node(const std::vector<Piece>& pieces, const std::string& more) {
    const Bytes written = read_file(write(pieces, kTextured));
    std::string text(written.begin(), written.end());
    const std::string plain_node = R"({"mesh": 0})";
    text.replace(text.find(plain_node), plain_node.size(), R"({"mesh": 0, )" + more + "}");
    return load(folder_.write("a.gltf", text));
  }

  static constexpr const char* kTextured =
      R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}})";
  static Rgb at(const Loaded& loaded, double x, double y) {
    return seen_at(loaded, 1000 * x, 1000 * y);
  }
  static void expect_picture(const Loaded& loaded) {
    EXPECT_EQ(at(loaded, 0.25, 0.75), kRed);
    EXPECT_EQ(at(loaded, 0.75, 0.75), kGreen);
    EXPECT_EQ(at(loaded, 0.25, 0.25), kBlue);
    EXPECT_EQ(at(loaded, 0.75, 0.25), kWhite);
  }

  Bytes positions_, uvs_, indices_;
};

TEST_F(Gltf, PlainForComparison) { expect_picture(gltf(plain(), kTextured)); }

TEST_F(Gltf, QuantisedAndNormalisedNumbers) {
  auto pieces = plain();
  // Positions in whole numbers of 10 m and 1 cm would be scaled by a node; here they are 0 or 1.
  pieces[0].bytes = {0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 255, 0, 0, 0, 255, 0};
  pieces[0].accessor = R"("componentType": 5120, "count": 4, "type": "VEC3")";
  pieces[0].view_extra = R"(, "byteStride": 4)";
  pieces[1].bytes = {0, 255, 0, 0, 255, 255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0};
  pieces[1].accessor = R"("componentType": 5121, "normalized": true, "count": 4, "type": "VEC2")";
  pieces[1].view_extra = R"(, "byteStride": 4)";
  expect_picture(gltf(pieces, kTextured, R"(, "extensionsRequired": ["KHR_mesh_quantization"])"));
}

TEST_F(Gltf, StripsAndFans) {
  for (const auto& [mode, order] : {std::pair{5, std::array<std::uint16_t, 4>{0, 1, 3, 2}},
                                    {6, std::array<std::uint16_t, 4>{0, 1, 2, 3}}}) {
    std::vector<Piece> pieces = plain();
    pieces[2].bytes.clear();
    append(pieces[2].bytes, order);
    pieces[2].accessor = R"("componentType": 5123, "count": 4, "type": "SCALAR")";
    const Loaded loaded =
        gltf(pieces, kTextured, "", "", R"("source": 0)", fmt::format(R"(, "mode": {})", mode));
    expect_picture(loaded);
    EXPECT_EQ(loaded.object.health.flipped, 0);
  }
}

TEST_F(Gltf, TheSetOfCoordinatesThatTheTextureNames) {
  std::vector<Piece> pieces = plain();
  pieces.push_back(pieces[1]);
  pieces[1].bytes.assign(pieces[1].bytes.size(), 0);
  expect_picture(
      gltf(pieces, R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}})",
           "", R"(, "TEXCOORD_1": 3)"));
}

TEST_F(Gltf, WebpTextures) {
  static constexpr std::uint8_t kFourColours[] = {
      0x52, 0x49, 0x46, 0x46, 0x2c, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56,
      0x50, 0x38, 0x4c, 0x1f, 0x00, 0x00, 0x00, 0x2f, 0x01, 0x40, 0x00, 0x00, 0x1f,
      0x20, 0x10, 0x48, 0xde, 0x1f, 0x3a, 0x8d, 0xf9, 0x17, 0x10, 0x14, 0xfc, 0x1f,
      0xdd, 0xfc, 0x47, 0x64, 0x0f, 0xe0, 0x06, 0x0c, 0x11, 0xfd, 0x0f, 0x01, 0x00};
  folder_.write("tex.png", Bytes(std::begin(kFourColours), std::end(kFourColours)));
  expect_picture(gltf(plain(), kTextured, R"(, "extensionsRequired": ["EXT_texture_webp"])", "",
                      R"("extensions": {"EXT_texture_webp": {"source": 0}})"));
}

TEST_F(Gltf, CompressedByDraco) {
  const fixtures::DracoMesh mesh =
      fixtures::draco_mesh({{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}},
                           {{0, 1}, {1, 1}, {1, 0}, {0, 0}}, {{0, 1, 2}, {0, 2, 3}});
  std::vector<Piece> pieces = plain();
  for (Piece& piece : pieces) piece.bytes.assign(piece.bytes.size(), 0);
  pieces.push_back({mesh.bytes, "", ""});
  expect_picture(
      gltf(pieces, kTextured, R"(, "extensionsRequired": ["KHR_draco_mesh_compression"])", "",
           R"("source": 0)",
           fmt::format(R"(, "extensions": {{"KHR_draco_mesh_compression": {{"bufferView": 3,
"attributes": {{"POSITION": {}, "TEXCOORD_0": {}}}}}}})",
                       mesh.positions, mesh.uvs)));
}

// The accessor says how whole numbers count; encoders leave the mesh's own note at no.
TEST_F(Gltf, ColoursCompressedByDracoCountAsTheirAccessorSays) {
  const fixtures::DracoMesh mesh =
      fixtures::draco_mesh({{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}},
                           {{0, 1}, {1, 1}, {1, 0}, {0, 0}}, {{0, 1, 2}, {0, 2, 3}}, {55, 13, 128});
  std::vector<Piece> pieces = plain();
  for (Piece& piece : pieces) piece.bytes.assign(piece.bytes.size(), 0);
  pieces.push_back({Bytes(12, 0),
                    R"("componentType": 5121, "normalized": true, "count": 4, "type": "VEC3")",
                    ""});
  pieces.push_back({mesh.bytes, "", ""});
  const Loaded loaded = gltf(pieces, R"("pbrMetallicRoughness": {})",
                             R"(, "extensionsRequired": ["KHR_draco_mesh_compression"])",
                             R"(, "COLOR_0": 3)", R"("source": 0)",
                             fmt::format(R"(, "extensions": {{"KHR_draco_mesh_compression":
{{"bufferView": 4, "attributes": {{"POSITION": {}, "COLOR_0": {}}}}}}})",
                                         mesh.positions, mesh.colors));
  const Object& object = loaded.object.object;
  ASSERT_FALSE(object.colors.empty());
  // glTF's vertex colours are linear.
  EXPECT_NEAR(object.colors[0][0].r, 55.0 / 255, 1e-6);
  EXPECT_NEAR(object.colors[0][0].g, 13.0 / 255, 1e-6);
  EXPECT_NEAR(object.colors[0][0].b, 128.0 / 255, 1e-6);
}

TEST_F(Gltf, CompressedByMeshoptimizer) {
  const std::vector<Piece> packed = {
      {fixtures::meshopt_vertices(positions_, 12), "", ""},
      {fixtures::meshopt_vertices(uvs_, 8), "", ""},
      {fixtures::meshopt_triangles({{0, 1, 2}, {0, 2, 3}}, 4), "", ""}};
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    std::vector<Piece> pieces = plain();
    std::size_t at = 0;
    const auto after = [](std::size_t end) { return (end + 3) / 4 * 4; };
    for (const Piece& piece : pieces) at = after(at + piece.bytes.size());
    const std::size_t stride[] = {12, 8, 2}, count[] = {4, 4, 6};
    for (std::size_t i = 0; i < 3; ++i) {
      pieces[i].bytes.assign(pieces[i].bytes.size(), 0);
      pieces[i].view_extra = fmt::format(
          R"(, "extensions": {{"{}": {{"buffer": 0, "byteOffset": {}, "byteLength": {},
"byteStride": {}, "count": {}, "mode": "{}"}}}})",
          name, at, packed[i].bytes.size(), stride[i], count[i],
          i < 2 ? "ATTRIBUTES" : "TRIANGLES");
      at = after(at + packed[i].bytes.size());
    }
    pieces.insert(pieces.end(), packed.begin(), packed.end());
    expect_picture(gltf(pieces, kTextured, fmt::format(R"(, "extensionsRequired": ["{}"])", name)));
  }
}

// Each node is placed in the one above it; a turn is counter-clockwise as one looks against its
// axis.
TEST_F(Gltf, NodesInNodes) {
  const Bytes written = read_file(write(plain(), kTextured));
  std::string text(written.begin(), written.end());
  const std::string one = R"({"mesh": 0})";
  text.replace(
      text.find(one), one.size(),
      R"({"translation": [5, 0, 0], "children": [1]},)"
      R"({"translation": [0, 0, 2], "rotation": [0, 0.70710678, 0, 0.70710678], "mesh": 0})");
  const Object& object = load(folder_.write("a.gltf", text)).object.object;
  const Box3 box = object.bounds();
  // Of the square from 0 to 1 along glTF's x and -z: a quarter turn about y takes x to -z and z to
  // x; z up, glTF's (x, y, z) is (x, -z, y).
  EXPECT_LT((box.min - 1000 * Vec3(4, -2, 0)).norm(), 0.1) << box.min.transpose();
  EXPECT_LT((box.max - 1000 * Vec3(5, -1, 0)).norm(), 0.1) << box.max.transpose();
}

// A mirrored part needs no repair: its faces are read the other way round.
TEST_F(Gltf, MirroredNodesLookOutwards) {
  const Object object = with_node(plain(), R"("scale": [-1, 1, 1])").object.object;
  for (std::size_t t = 0; t < object.triangles.size(); ++t)
    EXPECT_GT(face_normal(object, int(t)).z(), 0.9) << t;
}

TEST_F(Gltf, CopiesOfAMesh) {
  std::vector<Piece> pieces = plain();
  Bytes places;
  append(places, std::array<float, 6>{0, 0, 0, 2, 0, 0});
  pieces.push_back({places, R"("componentType": 5126, "count": 2, "type": "VEC3")", ""});
  const Loaded loaded = with_node(
      pieces, R"("extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 3}}})");
  EXPECT_EQ(loaded.object.health.triangles, 4);
  EXPECT_NEAR(loaded.object.object.bounds().max.x(), 3000, 1e-3);
  EXPECT_EQ(at(loaded, 2.25, 0.75), kRed);
}

// Twenty bytes of text ask for two triangles each.
TEST_F(Gltf, CopiesWithoutEndAreRefused) {
  const auto with_copies = [&](int copies) {
    const Bytes written = read_file(write(plain(), kTextured));
    std::string text(written.begin(), written.end()), children, nodes;
    for (int i = 1; i <= copies; ++i) {
      children += fmt::format("{}{}", i > 1 ? "," : "", i);
      nodes += R"(,{"mesh":0})";
    }
    const std::string plain_node = R"({"mesh": 0})";
    text.replace(text.find(plain_node), plain_node.size(),
                 "{\"children\":[" + children + "]}" + nodes);
    return folder_.write("a.gltf", text);
  };
  expect_picture(load(with_copies(100)));
  // Parts without triangles cost time too, by node and part.
  const Bytes written = read_file(with_copies(3000));
  std::string text(written.begin(), written.end());
  const std::size_t parts = text.find("\"primitives\": [") + 15;
  ASSERT_LT(parts, text.size());
  std::string points;
  for (int i = 0; i < 3000; ++i) points += R"({"attributes":{"POSITION":0},"mode":0},)";
  text.insert(parts, points);
  const std::string of_points = refusal_of(folder_.write("a.gltf", text));
  EXPECT_TRUE(contains(of_points, "copies come to too many")) << of_points;
  const std::string said = refusal_of(with_copies(260'000));
  EXPECT_TRUE(contains(said, "copies come to too many")) << said;
}

TEST_F(Gltf, SparseNumbers) {
  auto pieces = plain();
  // Corner 2 lies elsewhere, and the sparse part puts it right.
  const float wrong = 7;
  std::memcpy(&pieces[0].bytes[24], &wrong, 4);
  pieces[0].accessor +=
      R"(, "sparse": {"count": 1, "indices": {"bufferView": 3, "componentType": 5121}, "values": {"bufferView": 4}})";
  pieces.push_back({{2}, "", ""});
  Bytes right;
  append(right, std::array<float, 3>{1, 0, -1});
  pieces.push_back({right, "", ""});
  expect_picture(gltf(pieces, kTextured));
  pieces[3].bytes = {9};
  EXPECT_NE(refusal_of(write(pieces, kTextured)), "");
}

TEST_F(Gltf, AlphaOfVerticesUnderOpaque) {
  auto pieces = plain();
  pieces.push_back({{255, 255, 255, 9, 255, 255, 255, 9, 255, 255, 255, 9, 255, 255, 255, 9},
                    R"("componentType": 5121, "normalized": true, "count": 4, "type": "VEC4")",
                    ""});
  expect_picture(gltf(pieces, kTextured, "", R"(, "COLOR_0": 3)"));
  const Loaded blended =
      gltf(pieces, std::string(kTextured) + R"(, "alphaMode": "BLEND")", "", R"(, "COLOR_0": 3)");
  EXPECT_LT(at(blended, 0.25, 0.75)[0], 60);
}

// Factor times picture is compared with the cutoff; what passes is opaque.
TEST_F(Gltf, MaskedMaterialsShowInFullOrNotAtAll) {
  const auto with = [&](double alpha, double cutoff, bool pictured) {
    const Loaded loaded =
        gltf(plain(),
             fmt::format(R"("alphaMode": "MASK", "alphaCutoff": {}, "pbrMetallicRoughness":
{{"baseColorFactor": [1, 0, 0, {}]{}}})",
                         cutoff, alpha, pictured ? R"(, "baseColorTexture": {"index": 0})" : ""));
    return at(loaded, 0.25, 0.75);
  };
  constexpr Rgb kBare{0, 0, 0};  // of seen_at()
  for (const bool pictured : {false, true}) {
    EXPECT_EQ(with(0.8, 0.5, pictured), kRed);
    EXPECT_EQ(with(0.5, 0.5, pictured), kRed);
    EXPECT_EQ(with(0.3, 0.5, pictured), kBare);
    EXPECT_EQ(with(0.3, 0.2, pictured), kRed);
    EXPECT_EQ(with(0, 0.1, pictured), kBare);
  }
}

TEST_F(Gltf, SpecularGlossinessHasABaseColourToo) {
  expect_picture(gltf(
      plain(),
      R"("extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseTexture": {"index": 0}}})",
      R"(, "extensionsRequired": ["KHR_materials_pbrSpecularGlossiness"])"));
}

TEST_F(Gltf, ExtensionsThatDoNotTouchTheBaseColour) {
  for (const char* name : {"KHR_materials_variants", "KHR_materials_clearcoat",
                           "KHR_materials_transmission", "KHR_lights_punctual"})
    expect_picture(
        gltf(plain(), kTextured, fmt::format(R"(, "extensionsRequired": ["{}"])", name)));
  EXPECT_TRUE(
      contains(refusal_of(write(plain(), kTextured, R"(, "extensionsRequired": ["ACME_shape"])")),
               "ACME_shape"));
}

TEST_F(Gltf, TexturesThatCannotBeReadSayHowToExport) {
  const std::string basisu = R"("extensions": {"KHR_texture_basisu": {"source": 0}})";
  const std::string said = refusal_of(write(plain(), kTextured, "", "", basisu));
  EXPECT_TRUE(contains(said, "KTX2"));
  EXPECT_TRUE(contains(said, "PNG, JPEG or WebP"));
  // With another picture to fall back on it is read.
  expect_picture(gltf(plain(), kTextured, "", "", R"("source": 0, )" + basisu));
}

TEST_F(Gltf, PosesThatAreNotReadAreSaid) {
  const auto node = [&](const std::string& more) { return with_node(plain(), more); };
  EXPECT_TRUE(warned(node(R"("skin": 0)"), "by a skeleton, which"));
  EXPECT_TRUE(warned(node(R"("weights": [0, 0.5])"), "shape keys"));
  EXPECT_TRUE(node(R"("weights": [0, 0])").warnings.empty());
}

TEST_F(Gltf, MissingPicturesAreNamedWithTheModel) {
  std::filesystem::remove(folder_ / "tex.png");
  const Loaded loaded = gltf(plain(), kTextured);
  EXPECT_TRUE(warned(loaded, "tex.png that a.gltf refers to"));
  EXPECT_EQ(loaded.object.picture_problems.size(), 1u);
}

TEST_F(Gltf, ShortAndForgedContainers) {
  for (const std::uint8_t length : {0, 1, 12, 19, 20}) {
    Bytes bytes = {'g', 'l', 'T', 'F', 2, 0, 0, 0, length, 0, 0, 0, 0, 0, 0, 0, 'J', 'S', 'O', 'N'};
    EXPECT_NE(refusal_of(folder_.write("a.glb", bytes)), "") << int(length);
    bytes[12] = 200;
    EXPECT_NE(refusal_of(folder_.write("a.glb", bytes)), "") << int(length);
  }
}

// ---- 3MF ----------------------------------------------------------------------------------------

constexpr const char* kRelations =
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"r\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

constexpr const char* kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";

constexpr const char* kSquareVertices =
    "<vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
    "<vertex x=\"1\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices>";

// One string may be most of a file: it is scanned, parsed and decoded, and cancelled in each.
TEST_F(Gltf, IsGivenUpInsideALongString) {
  constexpr int kCharacters = 4'000'000, kLeastLooks = 3 * (kCharacters / 4096);
  const auto path = folder_.write(
      "a.gltf", fmt::format("{{\"asset\":{{\"version\":\"2.0\"}},\"buffers\":[{{\"byteLength\":{},"
                            "\"uri\":\"data:application/octet-stream;base64,{}\"}}]}}",
                            kCharacters / 4 * 3, std::string(kCharacters, 'A')));
  RunContext context;
  context.cancel_at_check(1'000'000);
  EXPECT_THROW(load_object(path, {}, context), InputError);  // it has no triangles
  EXPECT_GE(context.checks(), kLeastLooks);
}

// Looked at again after every entry, a list of so many would take minutes.
TEST_F(Gltf, ListsOfManyEntriesStayLinear) {
  std::string entries = "{}";
  for (int i = 1; i < 300000; ++i) entries += ",{}";
  EXPECT_TRUE(
      contains(refusal_of(folder_.write("a.gltf", "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[" +
                                                      entries + "],\"extras\":[" + entries + "]}")),
               "no triangles"));
}

class ThreeMf : public Formats {
 protected:
  static std::string model(const std::string& inside, const std::string& unit = "millimeter") {
    return fmt::format(
        "<?xml version=\"1.0\"?><model unit=\"{}\" xmlns=\"{}\" "
        "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\" "
        "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" "
        "xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\" "
        "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\">{}</model>",
        unit, kCore, inside);
  }

  Loaded package(std::vector<std::pair<std::string, std::string>> parts) {
    parts.insert(parts.begin(), {"_rels/.rels", kRelations});
    return load(folder_.write("a.3mf", fixtures::zip_of(parts)));
  }

  static std::string text(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

  static std::string square(const std::string& properties) {
    return fmt::format(
        "<mesh>{}<triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\" {}/>"
        "<triangle v1=\"0\" v2=\"2\" v3=\"3\" {}/></triangles></mesh>",
        kSquareVertices, properties,
        properties.find("p3=\"2\"") == std::string::npos ? properties
                                                         : "pid=\"2\" p1=\"0\" p2=\"2\" p3=\"3\"");
  }
};

TEST_F(ThreeMf, TexturesWithTheirSeamsAndThumbnails) {
  const std::string resources =
      "<resources><m:texture2d id=\"1\" path=\"/3D/Textures/t.png\" contenttype=\"image/png\"/>"
      "<m:texture2dgroup id=\"2\" texid=\"1\"><m:tex2coord u=\"0\" v=\"0\"/>"
      "<m:tex2coord u=\"1\" v=\"0\"/><m:tex2coord u=\"1\" v=\"1\"/><m:tex2coord u=\"0\" v=\"1\"/>"
      "</m:texture2dgroup><object id=\"3\">" +
      square("pid=\"2\" p1=\"0\" p2=\"1\" p3=\"2\"") +
      "</object></resources><build><item objectid=\"3\"/></build>";
  const Loaded loaded = package({{"3D/3dmodel.model", model(resources)},
                                 {"3D/Textures/t.png", text(fixtures::four_colour_png())},
                                 {"Metadata/thumbnail.png", text(fixtures::four_colour_png())}});
  expect_four_colours(loaded);
  EXPECT_TRUE(loaded.warnings.empty());
  const Loaded missing = package({{"3D/3dmodel.model", model(resources)}});
  EXPECT_TRUE(warned(missing, "t.png that a.3mf refers to"));
}

TEST_F(ThreeMf, ColoursOfCornersCompositesAndLayers) {
  const auto colored = [&](const std::string& groups, const std::string& properties) {
    return package({{"3D/3dmodel.model",
                     model("<resources>" + groups + "<object id=\"9\">" + square(properties) +
                           "</object></resources><build><item objectid=\"9\"/></build>")}});
  };
  const std::string base =
      "<basematerials id=\"1\"><base name=\"a\" displaycolor=\"#FF0000\"/>"
      "<base name=\"b\" displaycolor=\"#0000FFFF\"/></basematerials>";
  EXPECT_EQ(seen_at(colored(base, "pid=\"1\" p1=\"1\""), 0.5, 0.2), kBlue);
  const std::string composite = base +
                                "<m:compositematerials id=\"4\" matid=\"1\" matindices=\"0 1\">"
                                "<m:composite values=\"0.5 0.5\"/></m:compositematerials>";
  EXPECT_EQ(seen_at(colored(composite, "pid=\"4\" p1=\"0\""), 0.5, 0.2), (Rgb{128, 0, 128}));
  const std::string layers = base +
                             "<m:colorgroup id=\"5\"><m:color color=\"#00FF00\"/></m:colorgroup>"
                             "<m:multiproperties id=\"6\" pids=\"1 5\"><m:multi pindices=\"0 0\"/>"
                             "</m:multiproperties>";
  EXPECT_EQ(seen_at(colored(layers, "pid=\"6\" p1=\"0\""), 0.5, 0.2), kGreen);
  EXPECT_TRUE(colored(base, "pid=\"1\" p1=\"1\"").object.object.has_appearance());
}

TEST_F(ThreeMf, MirroredPartsLookOutwards) {
  const std::string resources =
      "<resources><object id=\"3\">" + square("") + "</object></resources>";
  const auto placed = [&](const std::string& transform) {
    return package(
               {{"3D/3dmodel.model", model(resources + "<build><item objectid=\"3\" transform=\"" +
                                           transform + "\"/></build>")}})
        .object.object;
  };
  for (const char* transform : {"1 0 0 0 1 0 0 0 1 0 0 0", "-1 0 0 0 1 0 0 0 1 0 0 0"}) {
    const Object object = placed(transform);
    for (std::size_t t = 0; t < object.triangles.size(); ++t)
      EXPECT_GT(face_normal(object, int(t)).z(), 0.9) << transform;
  }
}

TEST_F(ThreeMf, PartsOfTheProductionExtension) {
  const std::string inner =
      model("<resources><object id=\"1\">" + square("") + "</object></resources><build/>");
  const std::string outer = model(
      "<resources><object id=\"8\"><components>"
      "<component p:path=\"/3D/Objects/part_1.model\" objectid=\"1\" "
      "transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></components></object></resources>"
      "<build><item objectid=\"8\" transform=\"0 1 0 -1 0 0 0 0 1 0 0 0\"/></build>");
  const Loaded loaded = package({{"3D/3dmodel.model", outer}, {"3D/Objects/part_1.model", inner}});
  // Moved to x = 5, then turned by a quarter: x becomes y.
  EXPECT_NEAR((loaded.object.object.bounds().min - Vec3(-1, 5, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((loaded.object.object.bounds().max - Vec3(0, 6, 0)).norm(), 0, 1e-6);
}

TEST_F(ThreeMf, StreamedArchivesOfZip64) {
  const Loaded loaded = load(folder_.write(
      "a.3mf", fixtures::streamed_zip(
                   {{"_rels/.rels", kRelations},
                    {"3D/3dmodel.model", model("<resources><object id=\"1\">" + square("") +
                                               "</object></resources><build>"
                                               "<item objectid=\"1\"/></build>")}})));
  EXPECT_EQ(loaded.object.health.triangles, 2);
}

TEST_F(ThreeMf, SlicesAreNoVerticesAndLatticesAreSaid) {
  const Loaded loaded =
      package({{"3D/3dmodel.model",
                model("<resources><s:slicestack id=\"7\"><s:slice ztop=\"1\"><s:vertices>"
                      "<s:vertex x=\"1\" y=\"2\"/></s:vertices><s:polygon startv=\"0\"/></s:slice>"
                      "</s:slicestack><object id=\"1\" s:slicestackid=\"7\"><mesh>" +
                      std::string(kSquareVertices) +
                      "<triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles>"
                      "<b:beamlattice radius=\"1\"><b:beams><b:beam v1=\"0\" v2=\"9\"/></b:beams>"
                      "</b:beamlattice></mesh></object></resources>"
                      "<build><item objectid=\"1\"/></build>")}});
  EXPECT_EQ(loaded.object.health.triangles, 1);
  EXPECT_TRUE(warned(loaded, "beam lattices"));
}

TEST_F(ThreeMf, OfALatticeWithoutTrianglesItIsSaidWhatItIs) {
  const std::string lattice =
      model("<resources><object id=\"1\"><mesh>" + std::string(kSquareVertices) +
            "<triangles/><b:beamlattice radius=\"1\"><b:beams><b:beam v1=\"0\" v2=\"1\"/></b:beams>"
            "</b:beamlattice></mesh></object></resources><build><item objectid=\"1\"/></build>");
  try {
    package({{"3D/3dmodel.model", lattice}});
    ADD_FAILURE() << "it was loaded";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("only beam lattices, which are not read"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(ThreeMf, PaintOfSlicersIsNamed) {
  EXPECT_TRUE(warned(package({{"3D/3dmodel.model",
                               model("<resources><object id=\"1\">" + square("paint_color=\"4\"") +
                                     "</object></resources><build><item objectid=\"1\"/>"
                                     "</build>")}}),
                     "paint_color"));
}

TEST_F(ThreeMf, WhatItRequiresAndIsNotReadIsSaid) {
  const auto with = [&](const std::string& attributes) {
    std::string text = model("<resources><object id=\"1\">" + square("") +
                             "</object></resources><build><item objectid=\"1\"/></build>");
    text.insert(text.find("<model ") + 7, attributes + " ");
    return package({{"3D/3dmodel.model", text}});
  };
  EXPECT_TRUE(with("requiredextensions=\"m p s b\"").warnings.empty());
  EXPECT_TRUE(warned(with("xmlns:q=\"http://a.org/q\" requiredextensions=\"p q\""),
                     "requires the 3MF extension http://a.org/q, which is not read"));
}

TEST_F(ThreeMf, XmlInUtf16IsNamed) {
  try {
    package({{"3D/3dmodel.model", std::string("\xff\xfe<\0", 4)}});
    ADD_FAILURE() << "it was loaded";
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "UTF-16")) << error.what();
  }
}

// Names of characters end soon or are none: looking for the end of each of a million takes minutes.
TEST_F(ThreeMf, CharactersByName) {
  const auto unit = [&](const std::string& name) {
    return refusal_of(folder_.write(
        "a.3mf",
        fixtures::zip_of({{"_rels/.rels", kRelations}, {"3D/3dmodel.model", model("", name)}})));
  };
  EXPECT_TRUE(contains(unit("&lt;&#228;&#x1F600;&amp;&gt;"), "'<ä😀&>'"));
  EXPECT_TRUE(contains(unit("&amp"), "'&amp'"));
  EXPECT_TRUE(contains(unit(std::string(1'000'000, '&')), "'&&&"));
}

TEST_F(ThreeMf, SupportsAreNotDipped) {
  const Loaded loaded =
      package({{"3D/3dmodel.model",
                model("<resources><object id=\"1\">" + square("") +
                      "</object><object id=\"2\" "
                      "type=\"support\">" +
                      square("") +
                      "</object></resources><build><item objectid=\"1\"/>"
                      "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 9 0 0\"/></build>")}});
  EXPECT_EQ(loaded.object.health.triangles, 2);
}

TEST_F(ThreeMf, WhatIsSwitchedOffForPrintingIsLeftOutAndSaid) {
  const auto build = [&](const char* first, const char* second) {
    return package({{"3D/3dmodel.model",
                     model("<resources><object id=\"1\">" + square("") +
                           "</object></resources><build><item objectid=\"1\" " + first +
                           "/><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 9 0 0\" " +
                           second + "/></build>")}});
  };
  const Loaded one = build("printable=\"1\"", "printable=\"0\"");
  EXPECT_EQ(one.object.health.triangles, 2);
  ASSERT_FALSE(one.warnings.empty());
  EXPECT_TRUE(contains(one.warnings.front(), "switched off"));
  EXPECT_EQ(build("", "").object.health.triangles, 4);
  // Nothing on: all is meant.
  EXPECT_EQ(build("printable=\"0\"", "printable=\"0\"").object.health.triangles, 4);
}

// Bambu Studio and OrcaSlicer: one object of three components, of which one is to be dipped.
TEST_F(ThreeMf, HelperPartsOfBambuStudioAreLeftOut) {
  const std::string inner = model("<resources><object id=\"1\">" + square("") +
                                  "</object><object id=\"2\" type=\"other\">" + square("") +
                                  "</object><object id=\"3\" type=\"other\">" + square("") +
                                  "</object></resources><build/>");
  std::string components;
  for (int id = 1; id <= 3; ++id)
    components += fmt::format(
        "<component p:path=\"/3D/Objects/object_1.model\" objectid=\"{}\" "
        "transform=\"1 0 0 0 1 0 0 0 1 {} 0 0\"/>",
        id, 10 * id);
  const std::string outer = model("<resources><object id=\"4\"><components>" + components +
                                  "</components></object></resources><build>"
                                  "<item objectid=\"4\"/></build>");
  const auto with = [&](const std::string& settings) {
    return package({{"3D/3dmodel.model", outer},
                    {"3D/Objects/object_1.model", inner},
                    {"Metadata/model_settings.config", settings}});
  };
  const Loaded loaded = with(
      "<?xml version=\"1.0\"?><config><object id=\"4\">"
      "<metadata key=\"name\" value=\"a\"/>"
      "<part id=\"1\" subtype=\"normal_part\"><metadata key=\"extruder\" value=\"1\"/></part>"
      "<part id=\"2\" subtype=\"modifier_part\"/><part id=\"3\" subtype=\"negative_part\"/>"
      "</object><plate/></config>");
  EXPECT_EQ(loaded.object.health.triangles, 2);
  EXPECT_EQ(loaded.object.object.bounds().min, Vec3(10, 0, 0));
  EXPECT_EQ(loaded.object.object.bounds().max, Vec3(11, 1, 0));
  EXPECT_TRUE(warned(loaded, "modifiers"));
  EXPECT_TRUE(warned(loaded, "negative parts"));
  // Settings of another object, and such as cannot be read, change nothing.
  EXPECT_EQ(with("<config><object id=\"1\"><part id=\"2\" subtype=\"modifier_part\"/></object>"
                 "</config>")
                .object.health.triangles,
            6);
  EXPECT_EQ(with("<config><object id=").object.health.triangles, 6);
}

// PrusaSlicer: one mesh, of which ranges of triangles are volumes.
TEST_F(ThreeMf, HelperVolumesOfPrusaSlicerAreLeftOut) {
  const std::string mesh =
      "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
      "<vertex x=\"1\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/>"
      "<vertex x=\"9\" y=\"9\" z=\"9\"/></vertices><triangles>"
      "<triangle v1=\"0\" v2=\"1\" v3=\"4\"/><triangle v1=\"1\" v2=\"2\" v3=\"4\"/>"
      "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/><triangle v1=\"0\" v2=\"2\" v3=\"3\"/>"
      "<triangle v1=\"2\" v2=\"3\" v3=\"4\"/></triangles></mesh>";
  const auto with = [&](const std::string& modifier) {
    return package(
        {{"3D/3dmodel.model", model("<resources><object id=\"1\">" + mesh +
                                    "</object></resources><build><item objectid=\"1\"/></build>")},
         {"Metadata/Slic3r_PE_model.config",
          "<config><object id=\"1\" instances_count=\"1\">"
          "<volume firstid=\"4\" lastid=\"4\">" +
              modifier +
              "</volume><volume firstid=\"2\" lastid=\"3\">"
              "<metadata type=\"volume\" key=\"volume_type\" value=\"ModelPart\"/></volume>"
              "<volume firstid=\"0\" lastid=\"1\">" +
              modifier + "</volume></object></config>"}});
  };
  for (const char* modifier :
       {"<metadata type=\"volume\" key=\"volume_type\" value=\"ParameterModifier\"/>",
        "<metadata type=\"volume\" key=\"modifier\" value=\"1\"/>"}) {
    const Loaded loaded = with(modifier);
    EXPECT_EQ(loaded.object.health.triangles, 2);
    EXPECT_EQ(loaded.object.object.bounds().max, Vec3(1, 1, 0));
    EXPECT_TRUE(warned(loaded, "modifiers"));
  }
  EXPECT_EQ(with("").object.health.triangles, 5);
}

// Minutes otherwise.
TEST_F(ThreeMf, ListsOfManyEntriesStayLinear) {
  const std::string base =
      "<basematerials id=\"5\"><base name=\"a\" displaycolor=\"#FF0000\"/></basematerials>";
  const auto with = [&](const std::string& resources) {
    return model("<resources>" + base + resources + "<object id=\"1\">" +
                 square("pid=\"9\" p1=\"0\"") +
                 "</object></resources><build><item objectid=\"1\"/></build>");
  };
  const auto repeated = [](const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  // Of a hundred thousand materials each of many mixtures names the share of one.
  const Loaded mixed = package(
      {{"3D/3dmodel.model",
        with("<m:compositematerials id=\"9\" matid=\"5\" matindices=\"" + repeated("0 ", 100'000) +
             "\">" + repeated("<m:composite values=\"1\"/>", 20'000) +
             "</m:compositematerials>")}});
  EXPECT_EQ(seen_at(mixed, 0.25, 0.5), kRed);
  EXPECT_TRUE(contains(
      refusal_of(folder_.write(
          "a.3mf",
          fixtures::zip_of(
              {{"3D/3dmodel.model",
                with("<m:multiproperties id=\"9\" pids=\"" + repeated("5 ", 100'000) + "\">" +
                     repeated("<m:multi pindices=\"0\"/>", 20'000) + "</m:multiproperties>")}}))),
      "layers"));
  std::vector<std::pair<std::string, std::string>> parts;
  std::string textures =
      "<m:multiproperties id=\"9\" pids=\"5\"><m:multi pindices=\"0\"/></m:multiproperties>";
  for (int i = 0; i < 30'000; ++i) {
    parts.emplace_back(fmt::format("3D/{}.txt", i), "");
    textures += fmt::format(
        "<m:texture2d id=\"{}\" path=\"/3D/{}.png\" contenttype=\"image/png\"/>", i + 10, i);
  }
  parts.emplace_back("3D/3dmodel.model", with(textures));
  EXPECT_EQ(seen_at(package(parts), 0.25, 0.5), kRed);
}

TEST_F(ThreeMf, CopiesWithoutEndAreRefused) {
  const auto items = [&](int count, const std::string& object) {
    std::string text = "<resources>" + object + "</resources><build>";
    for (int i = 0; i < count; ++i) text += "<item objectid=\"1\"/>";
    return refusal_of(
        folder_.write("a.3mf", fixtures::zip_of({{"3D/3dmodel.model", model(text + "</build>")}})));
  };
  EXPECT_TRUE(contains(items(400000, "<object id=\"1\">" + square("") + "</object>"), "objects"));
  // Each object twice in the next: 2^25 copies.
  std::string nested;
  for (int i = 1; i <= 25; ++i)
    nested += fmt::format(
        "<object id=\"{}\"><components><component objectid=\"{}\"/>"
        "<component objectid=\"{}\"/></components></object>",
        i, i + 1, i + 1);
  nested += "<object id=\"26\">" + square("") + "</object>";
  EXPECT_TRUE(contains(items(1, nested), "copies"));
  EXPECT_TRUE(contains(
      items(1, "<object id=\"1\"><components><component objectid=\"1\"/></components></object>"),
      "nested"));
  // Vertices are copied with the object, whether triangles use them or not.
  std::string vertices;
  for (int i = 0; i < 20'000; ++i) vertices += "<vertex x=\"0\" y=\"0\" z=\"0\"/>";
  const std::string loose =
      "<object id=\"1\"><mesh><vertices><vertex x=\"9\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"9\" "
      "z=\"0\"/>" +
      vertices +
      "</vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object>";
  EXPECT_TRUE(contains(items(4000, loose), "copies"));
}

}  // namespace
}  // namespace hydrodip
