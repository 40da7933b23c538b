// Photos by code, of film of two jobs on sheets of one size.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "base/file.h"
#include "camera/tank.h"
#include "image/files.h"
#include "register/register.h"
#include "register/tank_file.h"
#include "scene.h"
#include "sheet/film_marks.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using fixtures::boxes_on_a4;
using fixtures::draw_boxes;
using fixtures::phone_lens;
using fixtures::random_view;

constexpr double kWater_mm = 22;  // below the rim

Box2 a4() { return {Vec2(-105, -148.5), Vec2(105, 148.5)}; }

void save(const std::filesystem::path& file, const GrayImage& gray, bool mirrored = false) {
  Image image(gray.width_px, gray.height_px);
  for (std::size_t i = 0; i < gray.value.size(); ++i) {
    std::fill_n(&image.rgba[4 * i], 3, gray.value[i]);
    image.rgba[4 * i + 3] = 255;
  }
  save_png(file, image, 0, mirrored);
}

Tank calibrated_tank() {
  std::mt19937 random(1);
  const auto truth = fixtures::synthetic_tank(false);
  std::vector<SeenPhoto> photos;
  photos.reserve(12);
  for (int n = 0; n < 12; ++n)
    photos.push_back({"photo", truth.seen(phone_lens(), random_view(random, 28), 0.03, random)});
  Tank tank = calibrate_tank(photos, 4000, 3000, RunContext());
  tank.water_below_mm = kWater_mm;
  return tank;
}

// An A4 sheet with its marks, a little off its place.
GrayImage photo_of(const std::vector<Box2>& printed) {
  std::vector<Box2> boxes = printed;
  for (const MarkPlace& mark : film_marks(210, 297, 10))
    for (const Box2& box : mark_boxes(mark)) boxes.push_back(box);
  const auto film = draw_boxes(boxes, a4());
  const auto tank = fixtures::synthetic_tank(true);
  std::mt19937 random(5);
  fixtures::Scene scene;
  scene.lens = phone_lens();
  scene.camera = random_view(random);
  scene.sheets = tank.sheets();
  scene.sheets.push_back({&film, {Vec3(0, 0, 0.01), Vec3(1.4, -2.2, -kWater_mm)}});
  scene.shade = {0.35, -0.2};
  return photograph(scene);
}

TEST(SlowRegister, AnotherJobsFilmIsToldFromTheOwn) {
  const TemporaryFolder folder;
  write_file(folder / "camera.json", tank_as_json(calibrated_tank()));
  save(folder / "photo.png", photo_of(boxes_on_a4(1)));
  const auto told = [&](std::uint32_t print, InkSide side) {
    RigJob job;
    job.folder = folder.path();
    job.config.design.film.width_mm = 210;
    job.config.design.film.height_mm = 297;
    job.config.design.film.margin_mm = 10;
    job.config.print.ink_side = side;
    save(folder / "print.png", draw_boxes(boxes_on_a4(print), a4(), 4).gray,
         side == InkSide::kDown);
    RegisterRequest request;
    request.photo = folder / "photo.png";
    request.camera = folder / "camera.json";
    return register_job(job, request, RunContext()).text;
  };
  for (const InkSide side : {InkSide::kUp, InkSide::kDown}) {
    EXPECT_EQ(told(1, side).find("warning"), std::string::npos);
    const std::string another = told(2, side);
    EXPECT_NE(another.find("photo.png: the film in it does not look like"), std::string::npos)
        << another;
  }
}

// Wherever it was to lie before, and however that was turned.
TEST(SlowRegister, AFilmThatSaysWhereFilmIsToLieLiesThere) {
  const TemporaryFolder folder;
  Tank tank = calibrated_tank();
  tank.place = {{5, -3}, 40};
  write_file(folder / "camera.json", tank_as_json(tank));
  save(folder / "photo.png", photo_of(boxes_on_a4(1)));
  RigJob job;
  job.folder = folder.path();
  job.config.design.film.width_mm = 210;
  job.config.design.film.height_mm = 297;
  job.config.design.film.margin_mm = 10;
  RegisterRequest request;
  request.photo = folder / "photo.png";
  request.camera = folder / "camera.json";
  request.set_place = true;
  request.water_below_mm = kWater_mm + 2;
  register_job(job, request, RunContext());
  // How high the water stood for that photo is said of that photo.
  EXPECT_EQ(read_tank(folder / "camera.json").water_below_mm, kWater_mm);
  request.set_place = false;
  const auto found = nlohmann::json::parse(register_job(job, request, RunContext()).json);
  EXPECT_NEAR(found["shift_mm"]["x"], 0, 1e-3);
  EXPECT_NEAR(found["shift_mm"]["y"], 0, 1e-3);
  EXPECT_NEAR(found["turn_deg"]["value"], 0, 1e-3);
}

}  // namespace
}  // namespace hydrodip
