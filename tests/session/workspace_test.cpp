#include "hydrodip/workspace.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "base/error.h"
#include "image/files.h"
#include "samples/samples.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

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

  TemporaryFolder folder_;
  Project project_;
  Workspace workspace_;
  RunContext context_;
};

TEST_F(WorkspaceTest, RefusesALawWhoseContentItCannotSee) {
  project_.design.dip.material.law = make_corotated_law(0);
  EXPECT_THROW(workspace_.dipped(project_, Quality::kNormal, context_), InputError);
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
  std::atomic<bool> cancelled = false;
  std::thread request([&] {
    try {
      workspace_.dipped(project_, Quality::kNormal, older);
    } catch (const Cancelled&) {
      cancelled = true;
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
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
  const auto plain = [&](std::uint8_t grey) {
    Image image(8, 8);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
      image.rgba[i] = i % 4 == 3 ? std::uint8_t(255) : grey;
    save_png(picture, image);
  };
  plain(0);
  dip();
  design_it();
  project_.artwork.emplace_back();
  project_.artwork[0].image = picture;
  EXPECT_EQ(design_it(), 2U);  // paint, design
  EXPECT_EQ(design_it(), 0U);
  EXPECT_EQ(dip(), 0U);  // where film of even stiffness goes has nothing to do with it
  const auto at_the_bottom = [&] {
    const auto posed = workspace_.posed(project_, context_);
    const auto hit = posed->surface().first_hit({0, 0, -1}, {0, 0, 1}, 0, 10);
    return workspace_.paint(project_, Quality::kNormal, context_)
        ->color_at({hit->triangle, hit->u, hit->v})
        .g;
  };
  EXPECT_EQ(at_the_bottom(), 0);
  plain(255);
  std::filesystem::last_write_time(
      picture, std::filesystem::last_write_time(picture) + std::chrono::seconds(5));
  EXPECT_EQ(at_the_bottom(), 1);
  project_.artwork[0].opacity = 0.5;
  EXPECT_EQ(design_it(), 2U);
}

}  // namespace
}  // namespace hydrodip
