#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "base/file.h"
#include "export/film_ply.h"
#include "laid_film.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using fixtures::film_under_ball;

// Reads little-endian values off the front of a byte string.
class Reader {
 public:
  explicit Reader(std::string bytes) : bytes_(std::move(bytes)) {}
  std::uint8_t u8() { return std::uint8_t(bytes_.at(at_++)); }
  std::uint32_t u32() {
    std::uint32_t value = 0;
    for (int shift = 0; shift < 32; shift += 8) value |= std::uint32_t(u8()) << shift;
    return value;
  }
  float f32() { return std::bit_cast<float>(u32()); }
  bool done() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

struct Ply {
  std::vector<std::string> header;
  std::string body;
};

Ply split(const std::vector<std::uint8_t>& bytes) {
  const std::string text(bytes.begin(), bytes.end());
  const std::string end = "end_header\n";
  const std::size_t cut = text.find(end) + end.size();
  Ply ply;
  ply.body = text.substr(cut);
  std::istringstream lines(text.substr(0, cut));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("comment", 0) != 0) ply.header.push_back(line);
  }
  return ply;
}

TEST(FilmPly, HeaderIsTheContract) {
  const TemporaryFolder folder;
  const DippedFilm film = film_under_ball();
  write_film_ply(folder / "film.ply", film);
  const std::vector<std::string> expected = {
      "ply",
      "format binary_little_endian 1.0",
      "element vertex " + std::to_string(film.position.size()),
      "property float x",
      "property float y",
      "property float z",
      "property float u",
      "property float v",
      "property uchar state",
      "property float area_ratio",
      "property float stretch",
      "element face " + std::to_string(film.mesh().triangles.size()),
      "property list uchar int vertex_indices",
      "end_header"};
  EXPECT_EQ(split(read_file(folder / "film.ply")).header, expected);
}

TEST(FilmPly, EveryValueComesBack) {
  const TemporaryFolder folder;
  DippedFilm film = film_under_ball();
  for (std::size_t v = 0; v < film.position.size(); ++v) {  // no two numbers of a vertex alike
    film.position[v] = Vec3(-film.position[v].y() + 3, film.position[v].x(), film.position[v].z());
    film.stretch[v] = 2 + 0.5 * film.area_ratio[v];
  }
  write_film_ply(folder / "film.ply", film);
  Reader in(split(read_file(folder / "film.ply")).body);
  for (std::size_t v = 0; v < film.position.size(); ++v) {
    for (int k = 0; k < 3; ++k) ASSERT_EQ(in.f32(), float(film.position[v][k]));
    for (int k = 0; k < 2; ++k) ASSERT_EQ(in.f32(), float(film.mesh().u[v][k]));
    ASSERT_EQ(in.u8(), std::uint8_t(film.state[v]));
    ASSERT_EQ(in.f32(), float(film.area_ratio[v]));
    ASSERT_EQ(in.f32(), float(film.stretch[v]));
  }
  for (const Triangle& triangle : film.mesh().triangles) {
    ASSERT_EQ(in.u8(), 3);
    for (const std::int32_t v : triangle) ASSERT_EQ(in.u32(), std::uint32_t(v));
  }
  EXPECT_TRUE(in.done());
}

TEST(FilmPly, NeverHoldsWhatIsNotANumber) {
  const TemporaryFolder folder;
  DippedFilm film = film_under_ball();
  film.stretch[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_film_ply(folder / "film.ply", film), DipError);
  EXPECT_FALSE(std::filesystem::exists(folder / "film.ply"));
}

}  // namespace
}  // namespace hydrodip
