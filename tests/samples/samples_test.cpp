#include "samples/samples.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "image/files.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

// The mask takes longest to paint, so it is made once.
const Object& sample(const std::string& name) {
  static std::map<std::string, Object> made;
  const auto found = made.find(name);
  return found != made.end() ? found->second : made.emplace(name, make_sample(name)).first->second;
}

const Vec3& corner(const Object& object, std::size_t triangle, std::size_t k) {
  return object.positions[std::size_t(object.triangles[triangle][k])];
}

Vec3 area_vector(const Object& object, std::size_t triangle) {
  const Vec3 a = corner(object, triangle, 1) - corner(object, triangle, 0);
  const Vec3 b = corner(object, triangle, 2) - corner(object, triangle, 0);
  return 0.5 * a.cross(b);
}

double volume_mm3(const Object& object) {
  double volume = 0;
  for (std::size_t t = 0; t < object.triangles.size(); ++t)
    volume += corner(object, t, 0).dot(area_vector(object, t)) / 3;
  return volume;
}

std::uint8_t red_at(const Object& object, double u, double v) {
  const Image& image = *object.textures.front();
  return image.pixel(int(u * image.width_px), int((1 - v) * image.height_px))[0];
}

class EverySample : public testing::TestWithParam<std::string> {};

TEST_P(EverySample, IsClosed) {
  const Object& object = sample(GetParam());
  std::map<std::pair<int, int>, int> directed;
  for (const Triangle& t : object.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : directed) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(directed.count({edge.second, edge.first}));
  }
}

TEST_P(EverySample, FacesOutwardWithoutSlivers) {
  const Object& object = sample(GetParam());
  EXPECT_GT(volume_mm3(object), 0);
  for (std::size_t t = 0; t < object.triangles.size(); ++t)
    ASSERT_GT(area_vector(object, t).norm(), 1e-4);
}

TEST_P(EverySample, HangsInThePosedFrame) {
  const Box3 box = sample(GetParam()).bounds();
  EXPECT_NEAR(box.min.z(), 0, 1e-12);
  EXPECT_NEAR(box.center().x(), 0, 1e-9);
  EXPECT_NEAR(box.center().y(), 0, 1e-9);
}

TEST_P(EverySample, IsTexturedWithinItsTexture) {
  const Object& object = sample(GetParam());
  ASSERT_EQ(object.uvs.size(), object.triangles.size());
  ASSERT_EQ(object.material_of.size(), object.triangles.size());
  ASSERT_EQ(object.textures.size(), 1u);
  EXPECT_FALSE(object.textures.front()->empty());
  EXPECT_TRUE(object.has_appearance());
  for (const CornerUv& uvs : object.uvs)
    for (const Eigen::Vector2f& uv : uvs) {
      ASSERT_GE(uv.minCoeff(), 0.0f);
      ASSERT_LE(uv.maxCoeff(), 1.0f);
    }
}

// Looked at from below with y up, x runs to the left: u must too, or writing would be mirrored.
TEST_P(EverySample, IsNotMirroredSeenFromBelow) {
  const Object& object = sample(GetParam());
  int seen = 0;
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const Vec3 facing = area_vector(object, t).normalized();
    if (facing.z() > -0.5) continue;
    const Eigen::Vector2f a = object.uvs[t][1] - object.uvs[t][0];
    const Eigen::Vector2f b = object.uvs[t][2] - object.uvs[t][0];
    ASSERT_GT(a.x() * b.y() - a.y() * b.x(), 0.0f);
    ++seen;
  }
  EXPECT_GT(seen, 0);
}

TEST_P(EverySample, WritesTheSameModelAndTheSameBytes) {
  const TemporaryFolder folder;
  const std::string name = GetParam();
  const std::vector<std::string> files = write_sample(name, make_sample(name), folder.path());
  EXPECT_EQ(files, (std::vector<std::string>{name + ".obj", name + ".mtl", name + ".png"}));

  const Object& object = sample(name);
  std::ifstream in(folder.path() / (name + ".obj"));
  std::vector<Vec3> positions;
  std::vector<Eigen::Vector2d> uvs;
  std::size_t faces = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3 p;
      words >> p.x() >> p.y() >> p.z();
      positions.push_back(p);
    } else if (kind == "vt") {
      Eigen::Vector2d uv;
      words >> uv.x() >> uv.y();
      uvs.push_back(uv);
    } else if (kind == "f") {
      ASSERT_LT(faces, object.triangles.size());
      for (std::size_t k = 0; k < 3; ++k) {
        long vertex = 0, uv = 0;
        char slash = 0;
        words >> vertex >> slash >> uv;
        ASSERT_EQ(vertex, object.triangles[faces][k] + 1);
        ASSERT_TRUE(uv >= 1 && std::size_t(uv) <= uvs.size());
        ASSERT_LT((uvs[std::size_t(uv - 1)] - object.uvs[faces][k].cast<double>()).norm(), 1e-7);
      }
      ++faces;
    }
    ASSERT_FALSE(words.fail()) << line;
  }
  EXPECT_EQ(faces, object.triangles.size());
  ASSERT_EQ(positions.size(), object.positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    ASSERT_LT((positions[i] - object.positions[i]).norm(), 1e-6);

  // object was made by another call than the files.
  EXPECT_EQ(load_image(folder.path() / (name + ".png")).rgba, object.textures.front()->rgba);
  const std::vector<std::uint8_t> mtl = read_file(folder.path() / (name + ".mtl"));
  EXPECT_NE(std::string(mtl.begin(), mtl.end()).find("map_Kd " + name + ".png"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Samples, EverySample,
                         testing::Values("sphere", "pyramid", "ellipsoid", "mask", "box"),
                         [](const auto& name) { return name.param; });

TEST(SamplesTest, ListsWhatItMakes) {
  std::vector<std::string> names;
  for (const SampleInfo& info : samples()) names.push_back(info.name);
  EXPECT_EQ(names, (std::vector<std::string>{"sphere", "pyramid", "ellipsoid", "mask", "box"}));
}

TEST(SamplesTest, NamesTheNearestSampleWhenRefusing) {
  try {
    make_sample("pyramide");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'pyramid'"), std::string::npos) << error.what();
  }
}

TEST(SamplesTest, SphereHasItsRadius) {
  const Object& object = sample("sphere");
  double error = 0;
  for (const Vec3& p : object.positions)
    error = std::max(error, std::abs((p - Vec3(0, 0, 30)).norm() - 30));
  EXPECT_LT(error, 1e-6);
  const double exact = 4.0 / 3 * M_PI * 30 * 30 * 30;
  EXPECT_NEAR(volume_mm3(object) / exact, 1, 1e-3);
}

TEST(SamplesTest, EllipsoidLiesOnItsQuadric) {
  for (const Vec3& p : sample("ellipsoid").positions) {
    const Vec3 q((p.x()) / 45, p.y() / 30, (p.z() - 24) / 24);
    ASSERT_NEAR(q.norm(), 1, 1e-9);
  }
}

TEST(SamplesTest, PyramidPointsDownAtLessThan40Degrees) {
  const Object& object = sample("pyramid");
  EXPECT_NEAR(volume_mm3(object), 60.0 * 60 * 24 / 3, 1e-6);
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const Vec3 normal = area_vector(object, t).normalized();
    if (normal.z() < 0) {
      EXPECT_LT(std::acos(-normal.z()) * 180 / M_PI, 40);
    }
  }
}

TEST(SamplesTest, BoxIsFlatAtTheBottomAndUprightAtTheSides) {
  const Object& object = sample("box");
  EXPECT_LT((object.bounds().size() - Vec3(40, 40, 15)).norm(), 1e-12);
  EXPECT_NEAR(volume_mm3(object), 40.0 * 40 * 15, 1e-6);
  double bottom_mm2 = 0;
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const Vec3 area = area_vector(object, t);
    const double upright = std::abs(area.normalized().z());
    EXPECT_TRUE(upright < 1e-12 || upright > 1 - 1e-12);
    if (area.z() >= 0) continue;
    bottom_mm2 -= area.z();
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(corner(object, t, k).z(), 0);
  }
  EXPECT_NEAR(bottom_mm2, 1600, 1e-9);
}

// Unfolded without stretch: every edge of the bottom and the walls is as long in the texture.
TEST(SamplesTest, BoxTextureIsIsometric) {
  const Object& object = sample("box");
  for (std::size_t t = 0; t < object.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const double there = (corner(object, t, (k + 1) % 3) - corner(object, t, k)).norm();
      const double drawn = 70.0 * double((object.uvs[t][(k + 1) % 3] - object.uvs[t][k]).norm());
      EXPECT_NEAR(there, drawn, 1e-4);
    }
}

TEST(SamplesTest, MaskFitsA4AndIsGentleEnoughForFilm) {
  const Object& object = sample("mask");
  const Vec3 size = object.bounds().size();
  EXPECT_NEAR(size.x(), 100, 2);
  EXPECT_NEAR(size.y(), 130, 2);
  EXPECT_GT(size.z(), 28);
  EXPECT_LT(size.z(), 35);
  double front = 0, steep = 0, inner_steepest_deg = 0;
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    const Vec3 area = area_vector(object, t);
    if (area.z() >= 0) continue;
    const double slope_deg = std::acos(std::min(1.0, -area.z() / area.norm())) * 180 / M_PI;
    front += area.norm();
    if (slope_deg > 45) steep += area.norm();
    const Vec3& p = corner(object, t, 0);
    if (std::hypot(p.x() / 43, p.y() / 56) < 1)
      inner_steepest_deg = std::max(inner_steepest_deg, slope_deg);
  }
  EXPECT_LT(steep / front, 0.13);  // the rim
  EXPECT_LT(inner_steepest_deg, 50);
}

TEST(SamplesTest, MaskIsSymmetricInShapeButNotInPaint) {
  const Object& object = sample("mask");
  double skew = 0;
  for (const Vec3& p : object.positions) skew += p.x();
  EXPECT_NEAR(skew, 0, 1e-6);
  int different = 0;
  for (int i = 1; i < 50; ++i)
    for (int j = 1; j < 100; ++j)
      if (std::abs(red_at(object, i / 100.0, j / 100.0) -
                   red_at(object, 1 - i / 100.0, j / 100.0)) > 30)
        ++different;
  EXPECT_GT(different, 100);
}

// The nose tip enters the water first, and the paint has the eyes above it and the lips below.
TEST(SamplesTest, MaskIsPaintedWhereItsFeaturesAre) {
  const Object& object = sample("mask");
  for (const Vec3& p : object.positions)
    if (p.z() == 0) {
      EXPECT_NEAR(p.x(), 0, 1);
      EXPECT_NEAR(p.y(), -12, 5);
    }
  const Image& image = *object.textures.front();
  const auto color_at = [&](double x, double y) {
    return image.pixel(int((0.5 + x / 110) * image.width_px),
                       int((0.5 - y / 140) * image.height_px));
  };
  for (const double side : {-1.0, 1.0}) EXPECT_LT(color_at(side * 20.6, 9.6)[0], 60);  // pupils
  EXPECT_GT(color_at(0, -43.5)[0], 3 * color_at(0, -43.5)[1]);                         // lips
}

}  // namespace
}  // namespace hydrodip
