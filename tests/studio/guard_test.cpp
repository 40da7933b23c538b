#include "studio/guard.h"

#include <gtest/gtest.h>

#include <string>

namespace hydrodip {
namespace {

bool is_answered(const Guard& guard, const std::string& host) {
  HttpRequest request;
  request.method = "GET";
  request.header = [&](const std::string& name) { return name == "Host" ? host : std::string(); };
  return !guard.refuses_origin(request);
}

// Whoever owns a name can point it here; nobody owns a number.
TEST(Guard, AnswersToNumbersAndNotToNames) {
  Guard guard;
  guard.hosts = {"127.0.0.1:4714"};
  EXPECT_TRUE(is_answered(guard, "127.0.0.1:4714"));
  EXPECT_FALSE(is_answered(guard, "192.168.1.5:4714")) << "nobody said so";
  guard.numbers = true;
  for (const char* host : {"127.0.0.1:4714", "192.168.1.5:4714", "[fd00::5]:4714"})
    EXPECT_TRUE(is_answered(guard, host)) << host;
  for (const char* host : {"", "evil.example:4714", "1evil.example",
                           "192.168.1.5.evil.example:4714", "fd00::5:4714x", "localhost:4714"})
    EXPECT_FALSE(is_answered(guard, host)) << host;
}

}  // namespace
}  // namespace hydrodip
