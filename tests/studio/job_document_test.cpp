// A job's document by itself: revisions, and where it is saved.
#include "studio/job_document.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "studio/api_error.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

class JobDocumentTest : public testing::Test {
 protected:
  static Json turned(const char* down) {
    Json document;
    document["object"]["down"] = down;
    return document;
  }
  bool accept(const Json& json) { return document.accept(json, document.checked(json)); }

  TemporaryFolder folder;
  JobDocument document{folder.path(), Json()};
};

TEST_F(JobDocumentTest, TheSameAgainStaysSaved) {
  EXPECT_FALSE(accept(turned("+x")));
  EXPECT_LT(document.saved_revision(), document.revision());
  document.set_saved();
  EXPECT_TRUE(accept(turned("+x")));
  EXPECT_EQ(document.saved_revision(), document.revision());
  EXPECT_FALSE(accept(turned("-x")));
  EXPECT_LT(document.saved_revision(), document.revision());
}

// As after a crash.
TEST_F(JobDocumentTest, ComesBackAsItWasKept) {
  accept(turned("+x"));
  document.rename("mask");
  document.save(RunContext());
  accept(turned("-x"));
  const JobDocument again(folder.path(), document.state(true));
  EXPECT_EQ(again.json(), document.json());
  EXPECT_EQ(again.revision(), document.revision());
  EXPECT_EQ(again.saved_revision(), document.saved_revision());
  EXPECT_EQ(again.where(), document.where());
  EXPECT_EQ(again.state(true), document.state(true));
  EXPECT_EQ(again.config().object.pose.down, ModelSide::kMinusX);
}

TEST_F(JobDocumentTest, ANameIsARevisionUnlessItIsTheSame) {
  EXPECT_FALSE(document.rename(""));
  EXPECT_TRUE(document.rename("mask"));
  const long revision = document.revision();
  EXPECT_FALSE(document.rename("mask"));
  EXPECT_EQ(document.revision(), revision);
  EXPECT_EQ(document.name(), "mask");
}

// Nothing of it changes when what it would become is refused.
TEST_F(JobDocumentTest, WhatIsRefusedChangesNothing) {
  accept(turned("+x"));
  const Json before = document.state(true);
  EXPECT_THROW(document.checked(turned("sideways")), ApiError);
  EXPECT_EQ(document.state(true), before);
}

// Nor does a file that may take its place, before that is accepted.
TEST_F(JobDocumentTest, AFileThatIsRefusedChangesNothing) {
  write_file(folder / "box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_file(folder / "job.toml", "[output]\nno_clobber = \"on\"\n[object]\nfile = \"box.obj\"\n");
  const Json before = document.state(true);
  const OtherJob other = document.by_file(folder / "job.toml", config_of_file(folder / "job.toml"));
  Json refused = other.document;
  refused["object"]["down"] = "sideways";
  EXPECT_THROW(document.checked(refused, other.machine), ApiError);
  Json after = document.state(true);
  after["granted"] = before["granted"];  // the model that the file names
  EXPECT_EQ(after, before);
  document.replace_by(other);
  document.accept(other.document, document.checked(other.document));
  EXPECT_EQ(document.where(), folder / "job.toml");
  EXPECT_EQ(document.machine_names(), std::vector<std::string>{"output.no_clobber"});
}

// A job file says nothing of the job's name, nor of what its page shows.
TEST_F(JobDocumentTest, AFileThatTakesItsPlaceLeavesNameAndPage) {
  write_file(folder / "box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  Json own = turned("+x");
  own["name"] = "helmet";
  own["page"] = {{"dip", 1}};
  accept(own);
  const OtherJob other = document.by_file(folder / "box.obj", config_of_file(folder / "box.obj"));
  EXPECT_EQ(other.document["name"], "helmet");
  EXPECT_EQ(other.document["page"], own["page"]);
  EXPECT_FALSE(other.document["object"].contains("down"));
}

TEST_F(JobDocumentTest, AModelThatIsNotThereIsNoJob) {
  EXPECT_THROW(config_of_file(folder / "none.obj"), InputError);
  write_file(folder / "empty.toml", "[print]\ndpi = 100\n");
  EXPECT_THROW(config_of_file(folder / "empty.toml"), InputError);
}

}  // namespace
}  // namespace hydrodip
