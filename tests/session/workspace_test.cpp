#include "hydrodip/workspace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <latch>
#include <limits>
#include <mutex>
#include <thread>

#include "base/error.h"
#include "image/files.h"
#include "refusal.h"
#include "samples/samples.h"
#include "session/content_key.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

Image grey_picture(std::uint8_t grey) {
  Image image(8, 16);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = i % 4 == 3 ? std::uint8_t(255) : grey;
  return image;
}

class WorkspaceTest : public testing::Test {
 protected:
  WorkspaceTest() {
    write_sample("box", make_sample("box"), folder_.path());
    project_.model = folder_.path() / "box.obj";
    project_.design.film.width_mm = project_.design.film.height_mm = 120;
    project_.design.air.cells = kDraftAirCells;
    project_.design.film.elements = 2000;
    project_.design.trajectory.depth_mm = 4;
    project_.design.dip.step_mm = 1;
    project_.design.dpi = 50;
    project_.design.rounds_max = 2;
  }

  // How many values the request computes.
  template <class Request>
  std::size_t computed_by(const Request& request) {
    const std::size_t before = workspace_.computed();
    request();
    return workspace_.computed() - before;
  }
  std::size_t dip() {
    return computed_by([&] { workspace_.dipped(project_, Quality::kNormal, context_); });
  }
  std::size_t design_it() {
    return computed_by([&] { workspace_.designed(project_, Quality::kNormal, context_); });
  }
  // Of what is wanted in the middle of the side that enters first.
  float at_the_bottom() {
    const auto posed = workspace_.posed(project_, context_);
    const auto hit = posed->surface().first_hit({0, 0, -1}, {0, 0, 1}, 0, 10);
    return workspace_.paint(project_, Quality::kNormal, context_)
        ->color_at({hit->triangle, hit->u, hit->v})
        .g;
  }

  TemporaryFolder folder_;
  Project project_;
  Workspace workspace_;
  RunContext context_;
};

TEST_F(WorkspaceTest, RefusesWhatHasNoContentThatItCouldSee) {
  const DipOptions plain = project_.design.dip;
  const auto refused = [&] {
    const bool is = !refusal([&] { dip(); }).empty();
    project_.design.dip = plain;
    return is;
  };
  EXPECT_FALSE(refused());
  project_.design.dip.material.law = make_corotated_law(0);
  EXPECT_TRUE(refused());
  project_.design.dip.relaxed_steps = std::make_shared<RelaxedSteps>();
  EXPECT_TRUE(refused());
  project_.design.dip.make_solver = [](const FilmMesh& film) {
    return make_multigrid_solver(film);
  };
  EXPECT_TRUE(refused());
}

// Whatever changes a dip makes it another one.
TEST_F(WorkspaceTest, NumbersThatADipIsToldAreHeard) {
  project_.design.dip.material.tear_stretch = 1.02;
  const auto told_nothing = workspace_.dipped(project_, Quality::kNormal, context_);
  const std::size_t triangles = told_nothing->film->mesh().triangles.size();
  const DipOptions plain = project_.design.dip;
  const auto computed_with = [&](auto change) {
    project_.design.dip = plain;
    change(project_.design.dip);
    return dip();
  };
  const auto stiffen = [&](DipOptions& dip) {
    dip.modulus.assign(triangles, 1);
    std::fill_n(dip.modulus.begin(), triangles / 2, 50);
  };
  EXPECT_EQ(computed_with(stiffen), 1U);
  const auto stiff = workspace_.dipped(project_, Quality::kNormal, context_);
  EXPECT_NE(stiff->film->position, told_nothing->film->position);
  EXPECT_EQ(stiff->film->position, simulate(*workspace_.posed(project_, context_),
                                            {project_.design.film, project_.design.trajectory,
                                             project_.design.dip, project_.design.air})
                                       .film->position);
  const std::vector<double> never(triangles, std::numeric_limits<double>::infinity());
  EXPECT_EQ(computed_with([&](DipOptions& dip) { dip.tears_at_mm = never; }), 1U);
  EXPECT_EQ(computed_with([&](DipOptions& dip) {
              dip.moved_mm.assign(told_nothing->film->position.size(), 0);
            }),
            1U);
  EXPECT_EQ(computed_with([&](DipOptions& dip) { dip.steps_at_mm = {1, 2, 3, 4}; }), 1U);
  EXPECT_EQ(computed_with([&](DipOptions& dip) { dip.failed_share_max = 0.5; }), 1U);
  EXPECT_EQ(computed_with([](DipOptions&) {}), 0U);
}

TEST_F(WorkspaceTest, OnlyWhatAChangeTouchesIsComputedAgain) {
  EXPECT_EQ(dip(), 3U);  // model, pose, dip
  EXPECT_EQ(dip(), 0U);
  EXPECT_EQ(design_it(), 1U);
  project_.base = {0.5F, 0.5F, 0.5F, 1};  // shows in the print only
  EXPECT_EQ(dip(), 0U);
  EXPECT_EQ(design_it(), 1U);
  project_.design.dip.material.z_stretch = 0.5;
  EXPECT_EQ(dip(), 1U);
  project_.pose.rotate_deg = {0, 0, 30};
  EXPECT_EQ(dip(), 2U);  // pose, dip
  project_.pose.rotate_deg = {0, 0, 0};
  EXPECT_EQ(dip(), 0U);  // known from before
  EXPECT_EQ(computed_by([&] { workspace_.dipped(project_, Quality::kDraft, context_); }), 0U)
      << "this film is as coarse as a draft's already";
}

TEST_F(WorkspaceTest, LooksAtALargeModelWithFewerTriangles) {
  write_sample("sphere", make_sample("sphere"), folder_.path());
  project_.model = folder_.path() / "sphere.obj";
  project_.design.trajectory.depth_mm = 12;
  const auto whole = workspace_.model(project_, context_);
  const auto dipped = workspace_.dipped(project_, Quality::kNormal, context_);
  project_.most_triangles = whole->object->triangles.size();
  EXPECT_EQ(workspace_.model(project_, context_), whole);
  project_.most_triangles /= 4;
  const auto coarse = workspace_.model(project_, context_);
  EXPECT_LE(coarse->object->triangles.size(), project_.most_triangles);
  EXPECT_EQ(coarse->object->bounds().max, whole->object->bounds().max);
  const auto sketched = workspace_.dipped(project_, Quality::kNormal, context_);
  EXPECT_NEAR(sketched->coverage.covered_share(), dipped->coverage.covered_share(), 0.02);
}

// Whatever changes how a project is dipped or printed makes it another one.
TEST_F(WorkspaceTest, WhatAProjectSaysIsHeard) {
  project_.artwork.emplace_back();
  project_.artwork[0].text = "A";
  project_.design.trajectory.depth_mm = 0;
  project_.design.trajectory.path = {{0, 0, 0, 0, 0, 0}, {4, 0, 0, 0, 0, 0}};
  dip();
  design_it();
  const Project plain = project_;
  const auto asks_anew = [&](const auto& change) {
    project_ = plain;
    EXPECT_EQ(dip() + design_it(), 0U);
    change(project_);
    return dip() + design_it() > 0;
  };
  EXPECT_TRUE(asks_anew([](Project& p) { p.design.film.swelling_x = 1.02; }));
  EXPECT_TRUE(asks_anew([](Project& p) { p.design.film.swelling_y = 1.02; }));
  EXPECT_TRUE(asks_anew([](Project& p) { p.design.trajectory.path[1].shift_x_mm = 1; }));
  EXPECT_TRUE(asks_anew([](Project& p) { p.design.inking.limit = 1; }));
  EXPECT_TRUE(asks_anew([](Project& p) { p.design.stiffness.ratio = 30; }));
  EXPECT_TRUE(asks_anew([](Project& p) { p.artwork[0].font = "serif"; }));
  EXPECT_TRUE(asks_anew([](Project& p) { p.artwork[0].turn_deg = 20; }));
}

// Two large models that are looked at with as many triangles are two all the same.
TEST_F(WorkspaceTest, TheFewerTrianglesAreThoseOfTheModel) {
  write_sample("sphere", make_sample("sphere"), folder_.path());
  write_sample("ellipsoid", make_sample("ellipsoid"), folder_.path());
  project_.most_triangles = 500;
  project_.model = folder_.path() / "sphere.obj";
  const Vec3 sphere = workspace_.model(project_, context_)->object->bounds().size();
  project_.model = folder_.path() / "ellipsoid.obj";
  const Vec3 ellipsoid = workspace_.model(project_, context_)->object->bounds().size();
  EXPECT_EQ(ellipsoid, load(project_.model).object->bounds().size());
  EXPECT_NE(ellipsoid, sphere);
}

TEST_F(WorkspaceTest, AnotherPrinterPrintsOtherwise) {
  EXPECT_EQ(design_it(), 3U);  // model, pose, design
  project_.printer.color = PrintColor::kCmyk;
  EXPECT_EQ(design_it(), 1U);
  project_.printer.color = {};
  EXPECT_EQ(design_it(), 0U);
}

// What was asked for last stays when there is no room for all.
TEST_F(WorkspaceTest, LetsGoOfWhatNobodyAskedForForTheLongest) {
  const auto dip_turned = [&](Workspace& workspace, double turn_deg) {
    project_.pose.rotate_deg.z() = turn_deg;
    const std::size_t before = workspace.computed();
    workspace.dipped(project_, Quality::kNormal, context_);
    return workspace.computed() - before;
  };
  dip_turned(workspace_, 0);
  const std::size_t one = workspace_.memory_bytes();
  dip_turned(workspace_, 20);
  Workspace two(workspace_.memory_bytes() + (workspace_.memory_bytes() - one) / 4);
  EXPECT_EQ(dip_turned(two, 0), 3U);
  EXPECT_EQ(dip_turned(two, 20), 2U);
  EXPECT_EQ(dip_turned(two, 0), 0U);
  EXPECT_GT(dip_turned(two, 40), 0U);  // no room for the dip at 20
  EXPECT_EQ(dip_turned(two, 0), 0U);
  EXPECT_GT(dip_turned(two, 20), 0U);
}

TEST(ContentKeys, TextsDoNotRunIntoEachOther) {
  ContentKey one("key"), other("key");
  one.add(std::string("ab")).add(std::string("c"));
  other.add(std::string("a")).add(std::string("bc"));
  EXPECT_NE(one.text(), other.text());
}

TEST_F(WorkspaceTest, ValuesAreThoseOfTheStepsThemselves) {
  const auto made = workspace_.designed(project_, Quality::kNormal, context_);
  const Model model = load(project_.model);
  const PosedObject posed = pose(model);
  const Designed alone = design(posed, *paint_of(model), project_.design);
  EXPECT_EQ(made->ink.ink.inking.inks.cmyk, alone.ink.ink.inking.inks.cmyk);
  EXPECT_EQ(made->dipped.film->position, alone.dipped.film->position);
  const auto picture = workspace_.picture(project_, Quality::kNormal, 400, context_);
  EXPECT_EQ(picture->rgba, render(finish(paint_of(model), {alone}), 400).rgba);
}

TEST_F(WorkspaceTest, AChangedFileIsReadAgain) {
  const auto before = workspace_.model(project_, context_);
  Object half = make_sample("box");
  for (Vec3& p : half.positions) p *= 0.5;
  write_sample("box", half, folder_.path());
  const auto after = workspace_.model(project_, context_);
  EXPECT_NEAR(after->object->bounds().size().x(), 0.5 * before->object->bounds().size().x(), 1e-9);
  // The same content once more, however new the file: nothing is posed or dipped again.
  dip();
  write_sample("box", half, folder_.path());
  EXPECT_EQ(dip(), 0U);
}

TEST_F(WorkspaceTest, MemoryIsBounded) {
  const auto one = workspace_.dipped(project_, Quality::kNormal, context_);
  const std::size_t most = workspace_.memory_bytes() + 1000;
  Workspace small(most);
  std::shared_ptr<const DippedObject> first;
  for (int turn = 0; turn < 6; ++turn) {
    project_.pose.rotate_deg.z() = 15.0 * turn;
    const auto dipped = small.dipped(project_, Quality::kNormal, context_);
    if (!first) first = dipped;
    EXPECT_LE(small.memory_bytes(), most);
  }
  // What a caller holds outlives its place in the workspace.
  EXPECT_EQ(first->film->position, one->film->position);
}

TEST_F(WorkspaceTest, ANewerRequestCancelsTheOlder) {
  project_.design.film.elements = 40000;
  project_.design.dip.step_mm = 0.01;
  const RunContext older = workspace_.newest();
  std::latch dipping(1);
  std::once_flag told;
  older.on_progress([&](const std::string& activity, double) {
    if (activity == "dipping") std::call_once(told, [&] { dipping.count_down(); });
  });
  std::atomic<bool> cancelled = false;
  std::thread request([&] {
    try {
      workspace_.dipped(project_, Quality::kNormal, older);
    } catch (const Cancelled&) {
      cancelled = true;
    }
  });
  dipping.wait();
  const RunContext newer = workspace_.newest();
  request.join();
  EXPECT_TRUE(cancelled);
  EXPECT_FALSE(newer.cancelled());
  // Nothing half-made is left.
  project_.design.film.elements = 2000;
  project_.design.dip.step_mm = 1;
  const auto again = workspace_.dipped(project_, Quality::kNormal, newer);
  EXPECT_EQ(again->film->position, simulate(*workspace_.posed(project_, newer),
                                            {project_.design.film, project_.design.trajectory,
                                             project_.design.dip, project_.design.air})
                                       .film->position);
}

TEST_F(WorkspaceTest, TwoWhoAskForTheSameShareOneComputation) {
  project_.design.film.elements = 20000;
  std::shared_ptr<const DippedObject> a, b;
  std::thread other([&] { a = workspace_.dipped(project_, Quality::kNormal, RunContext()); });
  b = workspace_.dipped(project_, Quality::kNormal, RunContext());
  other.join();
  EXPECT_EQ(a, b);
  EXPECT_EQ(workspace_.computed(), 3U);
}

TEST_F(WorkspaceTest, ArtworkIsSeenAndItsFileWatched) {
  const auto picture = folder_.path() / "art.png";
  const auto plain = [&](std::uint8_t grey) { save_png(picture, grey_picture(grey)); };
  plain(0);
  dip();
  design_it();
  project_.artwork.emplace_back();
  project_.artwork[0].image = picture;
  EXPECT_EQ(design_it(), 2U);  // paint, design
  EXPECT_EQ(design_it(), 0U);
  EXPECT_EQ(dip(), 0U);  // where film of even stiffness goes has nothing to do with it
  EXPECT_EQ(at_the_bottom(), 0);
  plain(255);
  std::filesystem::last_write_time(
      picture, std::filesystem::last_write_time(picture) + std::chrono::seconds(5));
  EXPECT_EQ(at_the_bottom(), 1);
  project_.artwork[0].opacity = 0.5;
  EXPECT_EQ(design_it(), 2U);
}

TEST_F(WorkspaceTest, AnotherPictureAtHandIsSeen) {
  project_.artwork.emplace_back();
  ArtworkLayer& layer = project_.artwork[0];
  layer.picture = std::make_shared<const Image>(grey_picture(0));
  EXPECT_EQ(at_the_bottom(), 0);
  layer.picture = std::make_shared<const Image>(grey_picture(255));
  EXPECT_EQ(at_the_bottom(), 1);
  // Pixels count, and not where they lie.
  layer.picture = std::make_shared<const Image>(grey_picture(0));
  EXPECT_EQ(computed_by([&] { EXPECT_EQ(at_the_bottom(), 0); }), 0U);
  // The same bytes in other rows are another picture.
  auto wide = std::make_shared<Image>(grey_picture(0));
  std::swap(wide->width_px, wide->height_px);
  layer.picture = wide;
  EXPECT_EQ(computed_by([&] { at_the_bottom(); }), 1U);
}

}  // namespace
}  // namespace hydrodip
