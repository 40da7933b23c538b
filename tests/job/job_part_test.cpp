#include "job/job_part.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"

namespace hydrodip {
namespace {

TEST(JobPart, WarnsInItsNameAndTellsTheRestAsItIs) {
  const RunContext context;
  std::vector<std::string> told;
  context.on_progress([&](const std::string& activity, double) { told.push_back(activity); });
  context.on_log([&](const std::string& line) { told.push_back(line); });
  context.warn("of all");
  do_part("cup.obj", context, [](const RunContext& own) {
    own.progress("dipping", 0.5);
    own.log("a line");
    own.warn("it is open");
  });
  EXPECT_EQ(context.warnings(), (std::vector<std::string>{"of all", "cup.obj: it is open"}));
  EXPECT_EQ(told, (std::vector<std::string>{"dipping", "a line"}));
}

TEST(JobPart, EndsWhenTheJobIsCancelled) {
  const RunContext context;
  context.cancel();
  EXPECT_THROW(do_part("cup.obj", context, [](const RunContext& own) { own.check_cancelled(); }),
               Cancelled);
}

}  // namespace
}  // namespace hydrodip
