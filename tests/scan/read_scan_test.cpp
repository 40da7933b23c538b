#include "scan/read_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

class ReadScanTest : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, const std::string& text) const {
    write_file(folder_ / name, text);
    return folder_ / name;
  }

  // What is said about a file.
  std::string complaint(const std::filesystem::path& path, const ScanOptions& options = {}) const {
    try {
      read(path, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  static Scan read(const std::filesystem::path& path, const ScanOptions& options = {}) {
    return read_corner_scan(path, options, RunContext());
  }

  TemporaryFolder folder_;
};

CornerGrid bent_board(int columns, int rows, double mm = 1) {
  CornerGrid grid;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      grid.position.push_back(mm * Vec3(5.0 * i, 5.5 * j, 0.1 * i * i));
      grid.place.push_back({i, j});
      grid.patch.push_back(0);
    }
  return grid;
}

TEST_F(ReadScanTest, TablesComeBackAsTheyWere) {
  const CornerGrid board = bent_board(5, 4);
  write_scan_table(folder_ / "a.csv", board, "a comment");
  const Scan scan = read(folder_ / "a.csv");
  ASSERT_EQ(scan.grid.position.size(), board.position.size());
  for (std::size_t c = 0; c < board.position.size(); ++c) {
    EXPECT_LT((scan.grid.position[c] - board.position[c]).norm(), 1e-6);
    EXPECT_EQ(scan.grid.place[c], board.place[c]);
  }
  EXPECT_FALSE(scan.synthetic);
}

TEST_F(ReadScanTest, QuadsHaveTheSameLengthsAsTheTable) {
  const CornerGrid board = bent_board(6, 5);
  write_scan_quads(folder_ / "a.obj", board, kSyntheticMark);
  const Scan scan = read(folder_ / "a.obj");
  EXPECT_TRUE(scan.synthetic);
  EXPECT_EQ(scan.grid.position.size(), 30u);
  double sum = 0, expected = 0;
  const auto total = [](const CornerGrid& grid) {
    double lengths = 0;
    for (const GridLength& length : grid_lengths(grid))
      lengths +=
          (grid.position[std::size_t(length.from)] - grid.position[std::size_t(length.to)]).norm();
    return lengths;
  };
  sum = total(scan.grid), expected = total(board);
  EXPECT_NEAR(sum, expected, 1e-3);  // the reader keeps single precision
}

TEST_F(ReadScanTest, SeparatorsAndHeadingsAreFree) {
  const char* text =
      "# corners\r\nColumn; Row; X; Y; Z\r\n0; 0; 0; 0; 0\r\n1; 0; 5; 0; 0\r\n0; 1; 0; 5; 0\r\n"
      "-1; 0; -5; 0; 1e-1\r\n";
  EXPECT_EQ(read(file("a.csv", text)).grid.position.size(), 4u);
  EXPECT_EQ(read(file("a.txt", "0 0 0 0 0\n1\t0 5 0 0\n0 1 0 5 0\n1 1 5 5 0")).grid.position.size(),
            4u);
}

// What a German spreadsheet writes, in Windows' Unicode too: the same numbers.
TEST_F(ReadScanTest, DecimalCommasBetweenSemicolonsOrTabs) {
  const std::vector<Vec3> points =
      read(file("a.csv",
                "0,0,0.5,-1.25,0\n1,0,5.5,-1.25,1e-1\n0,1,0.5,3.75,0\n1,1,5.5,3.75,-0.25\n"),
           {})
          .grid.position;
  const std::string semicolons =
      "Spalte;Zeile;x;y;z\r\n0;0;0,5;-1,25;0\r\n1;0;5,5;-1,25;1e-1\r\n0;1;0,5;3,75;0\r\n"
      "\"1\";\"1\";\"5,5\";\"3,75\";\"-0,25\"\r\n";
  std::string tabs = semicolons, utf16 = "\xff\xfe";
  std::replace(tabs.begin(), tabs.end(), ';', '\t');
  for (const char c : semicolons) utf16 += {c, '\0'};
  for (const std::string& text : {semicolons, tabs, utf16})
    EXPECT_EQ(read(file("b.csv", text)).grid.position, points) << text;
}

TEST_F(ReadScanTest, AWrongUnitIsNamed) {
  const struct {
    double mm;
    const char* unit;
  } kCases[] = {{0.1, "cm"}, {1 / 25.4, "in"}, {0.001, "m"}};
  for (const auto& wrong : kCases) {
    const std::string name = std::string(wrong.unit) + ".obj";
    // Six decimals of a metre are a micrometre.
    write_scan_quads(folder_ / name, bent_board(4, 4, wrong.mm), "scan");
    EXPECT_NE(complaint(folder_ / name).find(std::string("--scan-units ") + wrong.unit),
              std::string::npos)
        << complaint(folder_ / name);
    const Scan scan = read(folder_ / name, {.units = wrong.unit});
    EXPECT_NEAR((scan.grid.position[0] - scan.grid.position[1]).norm(), 5, 0.6);
  }
  write_scan_table(folder_ / "mm.csv", bent_board(4, 4), "scan");
  EXPECT_NE(complaint(folder_ / "mm.csv", {.units = "in"}).find("--scan-units mm"),
            std::string::npos);
  EXPECT_NE(complaint(folder_ / "mm.csv", {.square_mm = 8}).find("--square"), std::string::npos);
  EXPECT_NE(complaint(folder_ / "mm.csv", {.units = "ft"}).find("mm, cm, m or in"),
            std::string::npos);
}

TEST_F(ReadScanTest, TrianglesAreRefusedWithTheWayOut) {
  const char* text = "v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\nf 1 2 3\nf 1 3 4\n";
  const std::string said = complaint(file("a.obj", text));
  EXPECT_NE(said.find("triangles"), std::string::npos) << said;
  EXPECT_NE(said.find("quad"), std::string::npos) << said;
  EXPECT_NE(complaint(file("b.obj",
                           "v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\nv 9 9 9\nf 1 2 3 4\n"
                           "f 1 2 5\n"))
                .find("do not have four corners"),
            std::string::npos);
}

TEST_F(ReadScanTest, BrokenFilesAreRefused) {
  for (const char* text :
       {"", "0,0,0,0\n", "0,0,a,0,0\n", "0.5,0,1,1,1\n", "0,0,0,0,0\n0,0,5,0,0\n", "0,0,0,0,0,7\n",
        "0,0,nan,0,0\n", "0,0,0,0,0\n1,0,5,0,0\n"})
    EXPECT_NE(complaint(file("a.csv", text)), "") << text;
  EXPECT_NE(complaint(folder_ / "missing.csv"), "");
  EXPECT_NE(complaint(file("a.stl", "x")), "");
  EXPECT_NE(complaint(file("a.obj", "v 0 0 0\n")), "");
  EXPECT_NE(complaint(file("a.ply", "ply\nnonsense")), "");
  // All corners in one place.
  EXPECT_NE(complaint(file("b.csv", "0,0,1,1,1\n1,0,1,1,1\n0,1,1,1,1\n1,1,1,1,1\n")), "");
}

// A scanner's mesh may have millions of faces.
TEST_F(ReadScanTest, EndsWhenTheJobIsCancelled) {
  write_scan_quads(folder_ / "a.obj", bent_board(6, 5), "scan");
  RunContext job;
  job.cancel();
  EXPECT_THROW(read_corner_scan(folder_ / "a.obj", {}, job), Cancelled);
  EXPECT_THROW(read_scan(folder_ / "a.obj", {}, job), Cancelled);
}

TEST_F(ReadScanTest, ACornerThatIsGivenTwiceIsToldWithItsLines) {
  const std::string corners = "0,0,0,0,0\n1,0,5,0,0\n0,1,0,5,0\n1,1,5,5,0\n2,0,10,0,0\n";
  EXPECT_EQ(complaint(file("a.csv", corners)), "");
  const std::string why = complaint(file("a.csv", corners + "1,1,5,5,0.1\n"));
  EXPECT_NE(why.find("lines 4 and 6 give the same corner (column 1, row 1)"), std::string::npos)
      << why;
}

// Columns and rows turn the same way in space as on the scan that nobody mirrored.
TEST_F(ReadScanTest, AMirroredMeshTurnedBackHasItsRowsTurnedBack) {
  const CornerGrid board = bent_board(5, 4);
  CornerGrid mirror = board;
  for (Vec3& p : mirror.position) p.x() = -p.x();
  for (GridPlace& place : mirror.place) place[0] = -place[0];  // its faces look outwards again
  const auto turns = [](const CornerGrid& grid) {
    std::map<GridPlace, Vec3> at;
    for (std::size_t c = 0; c < grid.place.size(); ++c) at[grid.place[c]] = grid.position[c];
    double sum = 0;
    for (const auto& [place, p] : at) {
      const auto right = at.find({place[0] + 1, place[1]}), up = at.find({place[0], place[1] + 1});
      if (right != at.end() && up != at.end()) sum += (right->second - p).cross(up->second - p).z();
    }
    return sum;
  };
  write_scan_quads(folder_ / "a.obj", board, "as it is");
  write_scan_quads(folder_ / "m.obj", mirror, "mirrored");
  const double as_it_is = turns(read(folder_ / "a.obj").grid);
  EXPECT_NEAR(turns(read(folder_ / "m.obj", {.mirrored = true}).grid), as_it_is, 1e-3);
  EXPECT_NEAR(turns(read(folder_ / "m.obj").grid), as_it_is, 1e-3);  // alike, but not the object
  EXPECT_GT(std::abs(as_it_is), 100);
}

TEST_F(ReadScanTest, MirroringTwiceIsNothing) {
  const CornerGrid board = bent_board(5, 4);
  CornerGrid mirror = board;
  for (Vec3& p : mirror.position) p.x() = -p.x();
  write_scan_table(folder_ / "a.csv", mirror, "mirrored");
  const Scan scan = read(folder_ / "a.csv", {.mirrored = true});
  for (std::size_t c = 0; c < board.position.size(); ++c)
    EXPECT_LT((scan.grid.position[c] - board.position[c]).norm(), 1e-6);
}

}  // namespace
}  // namespace hydrodip
