// A small dip of a ball, and what is seen of it: all of it some way off where it was meant to be.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "contains.h"
#include "job/jobs.h"
#include "refusal.h"
#include "register/printed_film.h"
#include "register/register.h"
#include "register/seen_dip.h"
#include "register/seen_places.h"
#include "rig/rig_job.h"
#include "samples/samples.h"
#include "scan/board.h"
#include "settings/correction_file.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using Moved = std::function<Vec2(const Vec2&)>;

Moved by(const Vec2& shift) {
  return [shift](const Vec2& u) { return Vec2(u + shift); };
}

class SeenOfAJob : public testing::Test {
 protected:
  SeenOfAJob() {
    write_sample(model_, make_sample(model_), folder_.path());
    dip("job", {});
  }

  // With that correction; none: without.
  void dip(const std::string& name, const std::filesystem::path& correction) {
    JobConfig config;
    config.model = folder_ / (model_ + ".obj");
    config.object.pose.rotate_deg = rotate_deg_;
    config.output = folder_ / name;
    config.design.film.elements = 2000;
    config.design.film.width_mm = config.design.film.height_mm = 160;
    config.design.trajectory.depth_mm = 12;
    config.design.dip.step_mm = 1;
    config.design.air.cells = 0;
    config.pictures = false;
    if (!correction.empty()) {
      config.correction = correction;
      config.design.film.correction = read_correction_field(correction);
    }
    simulate_job(config, RunContext());
  }

  RigJob job(const std::string& name = "job") const { return load_rig_job(folder_ / name, {}); }
  PrintedFilm film(const std::string& name = "job") const {
    return read_printed_film(job(name), RunContext());
  }

  // Where the film lies on the ball, `moved` on the sheet.
  static SeenPlaces places(const PrintedFilm& film, const Moved& moved) {
    SeenPlaces seen;
    for (std::size_t v = 0; v < film.film->position.size(); ++v)
      if (film.film->state[v] == VertexState::kAttached)
        seen.places.push_back({moved(film.film->mesh().u[v]), film.film->position[v]});
    return seen;
  }
  SeenDip seen(const PrintedFilm& film, const Moved& moved) const {
    return seen_dip("places.csv", places(film, moved), film, context_);
  }

  std::filesystem::path table(const std::string& name, const PrintedFilm& film,
                              const Moved& moved) const {
    std::string text = "film_x_mm,film_y_mm,x,y,z\n";
    for (const SeenPlace& place : places(film, moved).places)
      text += fmt::format("{},{},{},{},{}\n", place.printed.x(), place.printed.y(),
                          place.position.x(), place.position.y(), place.position.z());
    write_file(folder_ / name, text);
    return folder_ / name;
  }
  // As a scan that shows the corners of a board, which landed `off` from where they were meant.
  std::filesystem::path scan(const PrintedFilm& film, const Board& board, const Vec2& off,
                             bool mirrored = false) const {
    std::string text = "column,row,x,y,z\n";
    constexpr int kMost = 12;
    for (int column = -kMost; column <= kMost; ++column)
      for (int row = -kMost; row <= kMost; ++row) {
        const auto at = film.map->to_object(board.on_film({column, row}) - off);
        if (!at) continue;
        Vec3 position = position_at(film.posed.mesh(), *at);
        if (mirrored) position.x() *= -1;
        text += fmt::format("{},{},{},{},{}\n", (mirrored ? -column : column) + kMost, row + kMost,
                            position.x(), position.y(), position.z());
      }
    write_file(folder_ / "scan.csv", text);
    return folder_ / "scan.csv";
  }

  std::string corrected(const RigJob& job, const std::filesystem::path& places) const {
    CorrectRequest request;
    request.scans = {places};
    return correct_job(job, request, RunContext()).text;
  }

  std::string model_ = "sphere";
  Vec3 rotate_deg_ = Vec3::Zero();
  TemporaryFolder folder_;
  RunContext context_;
};

TEST_F(SeenOfAJob, AllOfItIsAsFarOffAsItLies) {
  const PrintedFilm printed = film();
  const SeenDip off = seen(printed, by({3, -4}));
  EXPECT_GT(off.samples.size(), 50U);
  EXPECT_NEAR(off.rms_off_mm, 5, 0.02);
  EXPECT_LT((off.mean_off - Vec2(3, -4)).norm(), 0.02);
  EXPECT_TRUE(context_.warnings().empty());
  // As far on the object, where film is hardly stretched.
  EXPECT_NEAR(off.rms_on_object_mm, 5, 0.7);
}

TEST_F(SeenOfAJob, PlacesFarOffOrBesideTheObjectAreLeftOut) {
  const PrintedFilm printed = film();
  int number = 0;
  const Moved some_far = [&](const Vec2& u) -> Vec2 { return u + Vec2(++number % 3 ? 1 : 25, 0); };
  const SeenDip off = seen(printed, some_far);
  EXPECT_NEAR(off.rms_off_mm, 1, 0.02);
  EXPECT_NEAR(double(off.samples.size()), 2.0 / 3 * number, 1);
  EXPECT_FALSE(context_.warnings().empty());
  SeenPlaces elsewhere = places(printed, by({1, 0}));
  for (std::size_t i = 0; i < elsewhere.places.size(); ++i)
    if (i % 3 != 0) elsewhere.places[i].position += Vec3(0, 0, -40);
  EXPECT_TRUE(contains(refusal([&] { seen_dip("places.csv", elsewhere, printed, context_); }),
                       "check that it is"));
}

TEST_F(SeenOfAJob, AMirroredSheetIsRefused) {
  const PrintedFilm printed = film();
  const Moved mirrored = [](const Vec2& u) { return Vec2(-u.x(), u.y()); };
  EXPECT_TRUE(contains(refusal([&] { seen(printed, mirrored); }), "mirror image"));
}

TEST_F(SeenOfAJob, ADipIsNoWitnessTwice) {
  const PrintedFilm printed = film();
  const SeenDip one = seen(printed, by({1, 0})), other = seen(printed, by({1, 2}));
  EXPECT_TRUE(contains(refusal([&] {
                         require_different({one, other, one});
                       }),
                       "give each dip once"));
  EXPECT_NO_THROW(require_different({one, other}));
  // Two dips 2 mm apart: each 1 mm off their mean, as a sample of two tells it.
  EXPECT_NEAR(between_dips_mm({one, other}), std::sqrt(2.0), 0.02);
  EXPECT_EQ(between_dips_mm({one}), 0);
}

TEST_F(SeenOfAJob, AScanIsReadAsTheBoardThatFitsClearlyBetter) {
  const PrintedFilm printed = film();
  const FilmOptions sheet = job().config.design.film;
  CorrectRequest request;
  request.aligned = true;
  for (const Board& board : {tint_board(5), black_board(5)}) {
    const SeenPlaces seen =
        read_seen_places(scan(printed, board, {0.5, 0.3}), printed, sheet, request, context_);
    EXPECT_EQ(seen.board, board.name);
    EXPECT_GT(seen.places.size(), 20U);
    EXPECT_NEAR(seen_dip("scan.csv", seen, printed, context_).rms_off_mm, std::hypot(0.5, 0.3),
                0.1);
  }
  // Halfway from one board to the other.
  const auto between = scan(printed, tint_board(5), {1.25, 1.25});
  const auto read = [&] { return read_seen_places(between, printed, sheet, request, context_); };
  EXPECT_TRUE(contains(refusal([&] { read(); }), "say which one was dipped"));
  request.board = "tints";
  EXPECT_EQ(read().board, "tints");
}

// Of an object that is not its own mirror image.
TEST_F(SeenOfAJob, AMirroredScanIsRefused) {
  model_ = "pyramid";
  write_sample(model_, make_sample(model_), folder_.path());
  rotate_deg_ = {12, -20, 25};
  dip("leaning", {});
  const PrintedFilm printed = film("leaning");
  const FilmOptions sheet = job("leaning").config.design.film;
  CorrectRequest request;
  request.board = "black";
  const auto read = [&](bool mirrored) {
    return refusal([&] {
      read_seen_places(scan(printed, black_board(5), {0.5, 0.3}, mirrored), printed, sheet, request,
                       context_);
    });
  };
  EXPECT_EQ(read(false), "");
  EXPECT_TRUE(contains(read(true), "only the scan's mirror image fits")) << read(true);
}

TEST_F(SeenOfAJob, TheCorrectionIsUndoneWhereItChangesFast) {
  PrintedFilm printed = film();
  auto field = std::make_shared<FilmCorrection>();
  field->first = {-80, -80};
  field->pitch_mm = 5;
  field->nx = field->ny = 33;
  for (int j = 0; j < field->ny; ++j)
    for (int i = 0; i < field->nx; ++i)
      field->move.emplace_back(2 * std::sin(0.2 * i), 1.5 * std::cos(0.25 * j + 0.1 * i));
  printed.correction = field;
  for (const Vec2& model : {Vec2(0, 0), Vec2(-31, 12), Vec2(44, -50)})
    EXPECT_LT((printed.to_model(model + field->at(model)) - model).norm(), 1e-6);
}

TEST_F(SeenOfAJob, FilmOfAnotherSheetIsNotThatJobs) {
  RigJob other = job();
  other.config.design.film.width_mm += 2;
  EXPECT_TRUE(contains(refusal([&] { read_printed_film(other, RunContext()); }),
                       "does not belong to the report.json"));
}

// film.ply does not say it.
TEST_F(SeenOfAJob, FilmThatIsStretchedBeyondWhatItBearsIsTorn) {
  RigJob weak = job();
  weak.config.design.dip.material.tear_stretch = 1.02;
  const PrintedFilm printed = read_printed_film(weak, RunContext());
  std::size_t torn = 0;
  for (std::size_t t = 0; t < printed.film->torn.size(); ++t) {
    double most = 0;
    for (const std::int32_t v : printed.film->mesh().triangles[t])
      most = std::max(most, printed.film->stretch[std::size_t(v)]);
    EXPECT_EQ(printed.film->torn[t] != 0, most > 1.02);
    torn += printed.film->torn[t];
  }
  EXPECT_GT(torn, 0U);
  EXPECT_LT(torn, printed.film->torn.size());
}

TEST_F(SeenOfAJob, ItsCorrectionTakesOutWhatWasSeen) {
  const PrintedFilm printed = film();
  const std::string said = corrected(job(), table("places.csv", printed, by({1, 0})));
  EXPECT_TRUE(contains(said, "off by 1.00") || contains(said, "off by 0.99")) << said;
  EXPECT_TRUE(contains(said, "--correction ")) << said;
  EXPECT_FALSE(contains(said, "warning")) << said;
  const CorrectionFile first = read_correction(folder_ / "job" / "correction.json");
  EXPECT_LT((first.field.at({0, 0}) - Vec2(1, 0)).norm(), 0.05);
  // Printed with it and seen again, 0.5 mm off on another day: both days count, and what the first
  // print was corrected by stays, as its film is read by it.
  dip("job", folder_ / "job" / "correction.json");
  const auto before = read_file(folder_ / "job" / "correction.json");
  const PrintedFilm again = film();
  const std::string next = corrected(job(), table("again.csv", again, by({0, 0.5})));
  EXPECT_TRUE(contains(next, "correction-2.json")) << next;
  EXPECT_EQ(read_file(folder_ / "job" / "correction.json"), before);
  const CorrectionFile second = read_correction(folder_ / "job" / "correction-2.json");
  EXPECT_NEAR(double(second.samples.size()), 2.0 * double(first.samples.size()),
              0.05 * double(first.samples.size()));
  EXPECT_LT((second.field.at({0, 0}) - Vec2(1, 0.25)).norm(), 0.1);
}

TEST_F(SeenOfAJob, ACorrectionThatHasChangedSinceIsNotThePrints) {
  corrected(job(), table("places.csv", film(), by({1, 0})));
  std::filesystem::copy_file(folder_ / "job" / "correction.json", folder_ / "own.json");
  dip("second", folder_ / "own.json");
  EXPECT_EQ(refusal([&] { film("second"); }), "");
  const auto bytes = read_file(folder_ / "own.json");
  write_file(folder_ / "own.json", std::string(bytes.begin(), bytes.end()) + "\n");
  EXPECT_TRUE(contains(refusal([&] { film("second"); }), "has changed since the job"));
}

TEST_F(SeenOfAJob, WhatItWasPrintedOfIsTold) {
  const auto csv = table("places.csv", film(), by({1, 0}));
  RigJob changed = job();
  ASSERT_FALSE(changed.model_sha256.empty());
  changed.model_sha256 = std::string(64, '0');
  EXPECT_TRUE(contains(corrected(changed, csv), "has changed since it was printed"));
  RigJob second = job();
  second.earlier_dips = 1;
  EXPECT_TRUE(contains(corrected(second, csv), "in this dip's [[dip]] table"));
}

}  // namespace
}  // namespace hydrodip
