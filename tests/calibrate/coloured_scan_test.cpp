#include "coloured_scan.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "export/glb_writer.h"
#include "image/files.h"
#include "refusal.h"
#include "scan/dark_squares.h"
#include "scan/read_scan.h"
#include "scans.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

// Many views: bench/calibrate/corners.cpp.
class ColouredScanSlow : public testing::Test {
 protected:
  // As a scanner exports it.
  std::filesystem::path write(const Object& object) {
    std::string text = "mtllib scan.mtl\nusemtl print\n", faces;
    for (const Vec3& p : object.positions)
      text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x(), p.y(), p.z());
    std::size_t number = 0;
    for (std::size_t t = 0; t < object.triangles.size(); ++t) {
      faces += "f";
      for (std::size_t k = 0; k < 3; ++k) {
        text += fmt::format("vt {:.6f} {:.6f}\n", object.uvs[t][k].x(), object.uvs[t][k].y());
        faces += fmt::format(" {}/{}", object.triangles[t][k] + 1, ++number);
      }
      faces += "\n";
    }
    write_file(folder_ / "scan.obj", text + faces);
    write_file(folder_ / "scan.mtl", "newmtl print\nKd 1 1 1\nmap_Kd print.png\n");
    save_png(folder_ / "print.png", *object.textures.front());
    return folder_ / "scan.obj";
  }

  RunContext context_;
  TemporaryFolder folder_;
};

TEST_F(ColouredScanSlow, CornersOfAPyramidAreWhereTheDipLaidThem) {
  const scans::Truth truth("pyramid", {0.65, 30, 0.1}, context_);
  const scans::ColouredScans scanner(truth.object, truth.surface, truth.dip, 0.1);
  const scans::ColouredScans::Scan scan = scanner.scan(1);
  const CornerGrid grid = grid_of_dark_squares(find_dark_squares(scan.object, 5));
  const scans::CornersFound found =
      scans::judge(grid, scan, truth.dip.landing(truth.object), {12, 12});
  EXPECT_GE(found.corners, 40u);
  EXPECT_EQ(found.misnumbered, 0u);
  EXPECT_LT(found.worst_mm, 0.1);
  EXPECT_LT(found.rms_mm, 0.07);
}

// Of a pyramid's squares, those over the tip and beside it were not found: straight across, the
// next ones are no further than neighbours may be, but over the tip they are.
TEST(DarkSquares, AreNoNeighboursAcrossATip) {
  const auto on_face = [](double side, double along_mm) {
    const Vec3 up = Vec3(side, 0, 0.8).normalized(), aside(0, side, 0);
    const Vec3 middle = along_mm * up;
    DarkSquare square;
    square.normal = aside.cross(up);
    const Vec3 a = 2.5 * aside, b = 2.9 * up;
    square.corner = {middle - a - b, middle + a - b, middle + a + b, middle - a + b};
    return square;
  };
  std::vector<DarkSquare> squares;
  for (const double side : {1.0, -1.0})
    for (const double along_mm : {11.9, 24.0}) squares.push_back(on_face(side, along_mm));
  ASSERT_LT(squares[0].normal.z(), 0);
  ASSERT_LT((squares[0].middle() - squares[2].middle()).norm(), 6.5 * 2.9);
  const CornerGrid grid = grid_of_dark_squares(squares);
  ASSERT_EQ(grid.patch.size(), 16u);
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_EQ(grid.patch[c], grid.patch[0]);
    EXPECT_NE(grid.patch[c], grid.patch[c + 8]);
  }
}

// Through its files, as every scan; and its places on the board are found.
TEST_F(ColouredScanSlow, ASphereIsReadFromItsFilesAndLaidOnTheSphere) {
  const scans::Truth truth("sphere", {0.65, 30, 0.1}, context_);
  const scans::ColouredScans scanner(truth.object, truth.surface, truth.dip, 0.1);
  const scans::ColouredScans::Scan scan = scanner.scan(2);
  const std::vector<Subject> subjects =
      load_subjects({"sphere=" + write(scan.object).string()}, scans::settings(),
                    scans::quick_config(), context_);
  const CornerGrid& grid = subjects[0].scan.grid;
  const scans::CornersFound found =
      scans::judge(grid, scan, truth.dip.landing(truth.object), {12, 12});
  EXPECT_GE(found.corners, 40u);
  EXPECT_EQ(found.misnumbered, 0u);
  EXPECT_LT(found.worst_mm, 0.1);
  ASSERT_TRUE(subjects[0].match);
  std::size_t near = 0;
  for (std::size_t c = 0; c < grid.position.size(); ++c) {
    if (!subjects[0].place[c]) continue;
    const auto landed = truth.dip.landing(truth.object)(*subjects[0].place[c]);
    near += landed && (subjects[0].match->pose * grid.position[c] - *landed).norm() < 1;
  }
  EXPECT_GE(near, 9 * grid.position.size() / 10);
}

// A flat board, of which everything is known, with texels of 0.1 mm.
constexpr int kTexels = 450;  // whole texels to a square
constexpr double kSide_mm = 45;

std::shared_ptr<Image> flat_board() {
  auto image = std::make_shared<Image>(kTexels, kTexels);
  for (int y = 0; y < kTexels; ++y)
    for (int x = 0; x < kTexels; ++x) {
      const double a = kSide_mm * (x + 0.5) / kTexels, b = kSide_mm * (y + 0.5) / kTexels;
      const bool dark = int(a / 5) % 2 == 1 && int(b / 5) % 2 == 1;
      std::uint8_t* pixel = image->pixel(x, kTexels - 1 - y);
      pixel[0] = pixel[1] = pixel[2] = dark ? 20 : 240;
      pixel[3] = 255;
    }
  return image;
}

// glTF is in metres, and nobody has to say so.
TEST(ColouredScan, OfGltfIsReadInItsFormatsUnit) {
  const TemporaryFolder folder;
  save_png(folder / "board.png", *flat_board());
  GlbWriter writer;
  writer.add_texture(read_file(folder / "board.png"), "image/png", "board");
  const int material =
      writer.add_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  const auto side = float(0.001 * kSide_mm);
  GlbMesh mesh;
  mesh.positions = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  writer.add_mesh("board", mesh, {{0, 6, material, material}});
  const std::vector<std::uint8_t> bytes = writer.finish();
  write_file(folder / "board.glb", bytes.data(), bytes.size());
  const RunContext context;
  const CornerGrid grid = read_scan(folder / "board.glb", {}, context).grid;
  ASSERT_EQ(grid.position.size(), 64u);
  for (std::size_t c = 1; c < grid.position.size(); ++c) {
    const Vec2 apart(grid.place[c][0] - grid.place[0][0], grid.place[c][1] - grid.place[0][1]);
    EXPECT_NEAR((grid.position[c] - grid.position[0]).norm(), 5 * apart.norm(), 0.06);
  }
  EXPECT_NE(refusal([&] { read_scan(folder / "board.glb", {.units = "mm"}, context); }), "");
}

TEST(DarkSquaresTest, OnAFlatSheetSquaresAreSquares) {
  Object sheet;
  sheet.positions = {{0, 0, 0}, {kSide_mm, 0, 0}, {kSide_mm, kSide_mm, 0}, {0, kSide_mm, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  sheet.material_of = {0, 0};
  sheet.materials.resize(1);
  sheet.materials[0].texture = 0;
  using Uv = Eigen::Vector2f;
  sheet.uvs = {{Uv(0, 0), Uv(1, 0), Uv(1, 1)}, {Uv(0, 0), Uv(1, 1), Uv(0, 1)}};
  sheet.textures.push_back(flat_board());
  const CornerGrid grid = grid_of_dark_squares(find_dark_squares(sheet, 5));
  ASSERT_EQ(grid.position.size(), 64u);  // of 4 by 4 squares
  for (std::size_t c = 0; c < grid.position.size(); ++c) {
    EXPECT_EQ(grid.patch[c], 0);
    for (int k = 0; k < 2; ++k)
      EXPECT_NEAR(grid.position[c][k], 5 * std::round(grid.position[c][k] / 5), 0.04);
    for (std::size_t d = 0; d < c; ++d) {
      // Lengths on the sheet are those of the places.
      const Vec2 apart(grid.place[c][0] - grid.place[d][0], grid.place[c][1] - grid.place[d][1]);
      EXPECT_NEAR((grid.position[c] - grid.position[d]).norm(), 5 * apart.norm(), 0.06);
    }
  }
}

}  // namespace
}  // namespace hydrodip
