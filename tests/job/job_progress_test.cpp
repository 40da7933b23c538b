// What a job says of how far it is.
#include "job/job_progress.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

TEST(JobProgress, OnlyRisesAndKnowsNoEndBeforeTheEnd) {
  for (const char* command : {"print", "simulate", "nest", "orient", "plan"}) {
    JobProgress progress(command);
    double last = 0;
    for (const char* activity :
         {"loading", "dipping", "mapping", "dipping", "dipping", "dipping", "writing the sheet",
          "trying directions", "dipping the best for good", "drawing the previews", "dipping"})
      for (double f = 0; f <= 1; f += 0.25) {
        progress.update(activity, f);
        EXPECT_GE(progress.fraction(), last);
        EXPECT_LT(progress.fraction(), 1);
        last = progress.fraction();
      }
    EXPECT_GT(last, 0.5);
  }
}

TEST(JobProgress, TellsNothingOfWhatItDoesNotKnow) {
  JobProgress progress("sweep");
  progress.update("running", 0.5);
  EXPECT_EQ(progress.fraction(), 0);
  EXPECT_LT(progress.left_s(10), 0);
}

}  // namespace
}  // namespace hydrodip
