#include "export/scene.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "export/packer.h"
#include "export/scene_object.h"
#include "laid_film.h"

namespace hydrodip {
namespace {

using fixtures::film_under_ball;
using fixtures::kRadius;
using fixtures::two_coloured_ball;
using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

Bytes from_base64(const std::string& text) {
  Bytes bytes;
  unsigned group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    group = group << 6 | unsigned(std::strchr(digits, c) - digits);
    bits += 6;
    if (bits >= 8) bytes.push_back(std::uint8_t(group >> (bits -= 8)));
  }
  return bytes;
}

// What the page's reader does (viewer/scene.js), in other words.
class Unpacked {
 public:
  explicit Unpacked(const std::string& text) : bytes_(50'000'000) {
    const Bytes packed = from_base64(text);
    uLongf size = bytes_.size();
    EXPECT_EQ(uncompress(bytes_.data(), &size, packed.data(), packed.size()), Z_OK);
    bytes_.resize(size);
  }

  std::vector<std::uint32_t> numbers(const Json& place) const {
    const std::size_t offset = place["offset"], count = place["count"], width = place["bytes"],
                      delta = place["delta"];
    const std::uint64_t range = std::uint64_t(1) << (8 * width);
    std::vector<std::uint32_t> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t value = 0;
      for (std::size_t plane = 0; plane < width; ++plane)
        value += std::uint64_t(bytes_.at(offset + plane * count + i)) << (8 * plane);
      values[i] = std::uint32_t((value + (i < delta ? 0 : values[i - delta])) % range);
    }
    return values;
  }

  std::vector<double> lengths(const Json& place) const {
    std::vector<double> values;
    const std::size_t components = place["low"].size();
    for (const std::uint32_t step : numbers(place)) {
      const std::size_t k = values.size() % components;
      values.push_back(place["low"][k].get<double>() + step * place["step"][k].get<double>());
    }
    return values;
  }

 private:
  Bytes bytes_;
};

DipHistory some_history(const DippedFilm& film) {
  DipHistory history;
  std::vector<Vec3> flat;
  for (const Vec2& u : film.mesh().u) flat.emplace_back(u.x(), u.y(), 0);
  history.record(0, 1, Moment{}, flat,
                 std::vector<VertexState>(flat.size(), VertexState::kUnattached));
  history.record(1, 1, Moment::at_depth(film.depth_mm), film.position, film.state);
  return history;
}

Image plain_sheet() {
  Image sheet(80, 100);
  for (std::uint8_t& byte : sheet.rgba) byte = 200;
  return sheet;
}

TEST(Packer, EveryWidthComesBack) {
  Packer packer;
  const std::vector<std::uint8_t> a = {0, 255, 7, 7, 3};
  const std::vector<std::uint16_t> b = {65535, 0, 1, 40000};
  const std::vector<std::uint32_t> c = {4000000000u, 1, 0, 17};
  const auto place = [](const Packer::Place& p) {
    return Json{{"offset", p.offset}, {"count", p.count}, {"bytes", p.bytes}, {"delta", p.delta}};
  };
  const Json pa = place(packer.add(a, 2)), pb = place(packer.add(b)), pc = place(packer.add(c, 3));
  const Unpacked data(packer.finish());
  EXPECT_EQ(data.numbers(pa), std::vector<std::uint32_t>(a.begin(), a.end()));
  EXPECT_EQ(data.numbers(pb), std::vector<std::uint32_t>(b.begin(), b.end()));
  EXPECT_EQ(data.numbers(pc), c);
}

// RFC 4648.
TEST(Packer, Base64IsFilledUp) {
  const auto of = [](const std::string& text) { return base64(Bytes(text.begin(), text.end())); };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

// A tear line runs through triangles; those are shown whole that are so for the most part.
TEST(Scene, ATriangleOfWhichLittleIsWholeIsTorn) {
  const Object ball = two_coloured_ball(4);
  DippedFilm film = film_under_ball();
  for (const Vec2& u : film.mesh().u) film.excess.push_back(0.8 * u.x() + 0.6 * u.y());
  const DipHistory history = some_history(film);
  RunContext context;
  const Json scene = Json::parse(scene_json({ball, film, history, Image()}, context));
  const std::vector<std::uint32_t> torn = Unpacked(scene["data"]).numbers(scene["film"]["torn"]);
  int mostly_torn = 0, mostly_whole = 0;
  for (std::size_t t = 0; t < torn.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    constexpr int kSteps = 20;
    int whole = 0, all = 0;
    for (int a = 0; a <= kSteps; ++a)
      for (int b = 0; a + b <= kSteps; ++b, ++all)
        whole += film.excess_at(t, Vec3(a, b, kSteps - a - b) / kSteps) <= 0;
    const double share = double(whole) / all;
    if (std::abs(share - 0.5) < 0.1 || share == 1) continue;
    EXPECT_EQ(torn[t] != 0, share < 0.5) << t;
    (share < 0.5 ? mostly_torn : mostly_whole) += 1;
  }
  EXPECT_GT(mostly_torn, 0);
  EXPECT_GT(mostly_whole, 0);
}

// Seen from the object, the water comes up to it.
TEST(Scene, AMovedObjectStandsOverTheWaterOfItsMoment) {
  const Object ball = two_coloured_ball(4);
  const DippedFilm film = film_under_ball();
  DipHistory history = some_history(film);
  Moment moment;
  moment.moved = true;
  moment.travelled_mm = moment.level_mm = 7;
  moment.shift = Vec3(1, 2, 3);
  history.record(2, 2, moment, film.position, film.state);
  RunContext context;
  const Json scene = Json::parse(scene_json({ball, film, history, Image()}, context));
  const Json pose = scene["film"]["frames"]["poses"].at(0);
  EXPECT_EQ(pose, Json({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, -4, 1}));
}

TEST(Scene, EverythingComesBack) {
  const Object ball = two_coloured_ball();
  const DippedFilm film = film_under_ball();
  const DipHistory history = some_history(film);
  const Image sheet = plain_sheet();
  SceneSource source{ball, film, history, sheet, 80, 100};
  source.standing = {Vec3::UnitX(), Vec3::UnitZ()};
  source.first_look = {0, -1, 0};
  RunContext context;
  const Json scene = Json::parse(scene_json(source, context));
  EXPECT_EQ(scene["standing"], Json({{"up", {1, 0, 0}}, {"front", {0, 0, 1}}}));
  EXPECT_EQ(scene["first_look"], Json({0, -1, 0}));
  const Unpacked data(scene["data"]);

  const std::vector<double> positions = data.lengths(scene["object"]["position"]);
  const std::vector<std::uint32_t> indices = data.numbers(scene["object"]["index"]);
  ASSERT_EQ(indices.size(), 3 * ball.triangles.size());
  for (const std::uint32_t i : indices) {
    const Vec3 p(positions.at(3 * i), positions.at(3 * i + 1), positions.at(3 * i + 2));
    ASSERT_NEAR((p - Vec3(0, 0, kRadius)).norm(), kRadius, 0.002);
  }

  const std::vector<double> u = data.lengths(scene["film"]["u"]);
  const std::vector<double> frames = data.lengths(scene["film"]["frames"]);
  const std::vector<double> stretch = data.lengths(scene["film"]["stretch"]);
  ASSERT_EQ(frames.size(), 2 * 3 * film.position.size());
  for (std::size_t v = 0; v < film.position.size(); ++v) {
    ASSERT_NEAR(u[2 * v], film.mesh().u[v].x(), 0.002);
    ASSERT_NEAR(u[2 * v + 1], film.mesh().u[v].y(), 0.002);
    ASSERT_NEAR(frames[3 * v + 2], 0, 0.002);
    const std::size_t last = 3 * (film.position.size() + v);
    const double z = film.mesh().on_rim[v] ? film.depth_mm : film.position[v].z();
    ASSERT_NEAR(frames[last + 2], z, 0.002);
    ASSERT_NEAR(stretch[v], film.stretch[v], 1e-4);
  }
  EXPECT_EQ(scene["film"]["frames"]["levels"], Json({0, film.depth_mm}));
}

TEST(Scene, FitsIntoAScriptElement) {
  Object ball = two_coloured_ball(4);
  ball.materials[0].name = "</script><script>alert(1)</script>";
  const DippedFilm film = film_under_ball();
  const DipHistory history = some_history(film);
  const Image sheet = plain_sheet();
  RunContext context;
  const std::string text = scene_json({ball, film, history, sheet}, context);
  EXPECT_EQ(text.find('<'), std::string::npos);
  for (const char c : text) ASSERT_TRUE(c >= 0x20 && c < 0x7f);
}

TEST(Scene, TheBareObjectAndNoDip) {
  const Object ball = two_coloured_ball(4);
  DippedFilm film = film_under_ball(-1);
  RunContext context;
  const Json scene = Json::parse(scene_json({ball, film, DipHistory(), Image()}, context));
  EXPECT_FALSE(scene["sheet"].contains("picture"));
  EXPECT_EQ(scene["film"]["frames"]["levels"].size(), 0u);
}

TEST(ShownObject, SimplifiesWhatIsTooMuchForAPage) {
  const Object ball = two_coloured_ball(40);
  const ShownObject whole = shown_object(ball, 1000000);
  EXPECT_FALSE(whole.simplified);
  EXPECT_EQ(whole.indices.size(), 3 * ball.triangles.size());
  const ShownObject less = shown_object(ball, 2000);
  EXPECT_TRUE(less.simplified);
  EXPECT_LE(less.indices.size(), 3u * 2000);
  EXPECT_GT(less.indices.size(), 3u * 300);
  for (const ShownVertex& v : less.vertices) {
    const double radius =
        std::hypot(double(v.position[0]), double(v.position[1]), double(v.position[2]) - kRadius);
    ASSERT_NEAR(radius, kRadius, 0.15 * kRadius);
  }
}

TEST(ShownObject, GroupsByMaterial) {
  const Object ball = two_coloured_ball(6);
  const ShownObject shown = shown_object(ball, 1000000);
  ASSERT_EQ(shown.groups.size(), 2u);
  for (const ShownGroup& group : shown.groups) {
    for (std::size_t i = group.begin; i < group.begin + group.count; i += 3) {
      float x = 0;
      for (std::size_t k = 0; k < 3; ++k) x += shown.vertices[shown.indices[i + k]].position[0];
      EXPECT_EQ(x < 0, group.material == 0);
    }
  }
}

}  // namespace
}  // namespace hydrodip
