#include "base/shard.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace hydrodip {
namespace {

TEST(Shard, PartsAreTheWholeAndShareNothing) {
  for (const int of : {1, 2, 3, 7}) {
    for (std::size_t task = 0; task < 20; ++task) {
      int owners = 0;
      for (int number = 1; number <= of; ++number) owners += Shard{number, of}.has(task) ? 1 : 0;
      EXPECT_EQ(owners, 1) << task << " of " << of;
    }
  }
}

TEST(Shard, IsReadAsItIsWritten) {
  EXPECT_EQ(parse_shard("3/8").number, 3);
  EXPECT_EQ(parse_shard("3/8").of, 8);
  EXPECT_EQ(parse_shard("").of, 1);
  for (const char* bad :
       {"3", "0/8", "9/8", "1/0", "a/b", "1/2x", "-1/2", "1/", "/2", "1/9999999999"})
    EXPECT_THROW(parse_shard(bad), InputError) << bad;
}

}  // namespace
}  // namespace hydrodip
