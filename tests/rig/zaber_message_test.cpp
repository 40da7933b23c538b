#include "rig/zaber_message.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

// The definition: all bytes after the first character, and the checksum, add up to 0 modulo 256.
TEST(ZaberMessage, ChecksumMakesTheSumZero) {
  for (const std::string text : {"01 tools echo", "1 0 07 move abs 10000", "", "\x7f\x7f\x02"}) {
    int sum = std::stoi(zaber_checksum(text), nullptr, 16);
    for (const char c : text) sum += static_cast<unsigned char>(c);
    EXPECT_EQ(sum % 256, 0) << text;
    EXPECT_EQ(zaber_checksum(text).size(), 2u);
  }
}

TEST(ZaberMessage, CommandCarriesAddressAxisNumberAndChecksum) {
  EXPECT_EQ(zaber_command(1, 0, 7, "move abs 10000"), "/1 0 07 move abs 10000:BA\n");
  EXPECT_EQ(zaber_command(2, 0, 99, ""), "/2 0 99:EC\n");
}

TEST(ZaberMessage, ReadsRepliesAsTheManualPrintsThem) {
  ZaberReply reply;
  ASSERT_EQ(read_zaber_line("@01 0 OK IDLE -- 0", false, reply), ZaberLine::kReply);
  EXPECT_EQ(reply.address, 1);
  EXPECT_EQ(reply.id, -1);
  EXPECT_TRUE(reply.accepted);
  EXPECT_FALSE(reply.busy);
  EXPECT_EQ(reply.flag, "");
  EXPECT_EQ(reply.data, "0");

  ASSERT_EQ(read_zaber_line("@12 1 34 RJ BUSY WR BADDATA", false, reply), ZaberLine::kReply);
  EXPECT_EQ(reply.address, 12);
  EXPECT_EQ(reply.axis, 1);
  EXPECT_EQ(reply.id, 34);
  EXPECT_FALSE(reply.accepted);
  EXPECT_TRUE(reply.busy);
  EXPECT_EQ(reply.flag, "WR");
  EXPECT_EQ(reply.data, "BADDATA");

  EXPECT_EQ(read_zaber_line("!01 1 IDLE --", false, reply), ZaberLine::kOther);
  EXPECT_EQ(read_zaber_line("#01 0 Visit www.zaber.com", false, reply), ZaberLine::kOther);
}

TEST(ZaberMessage, AnyChangedCharacterIsNoticed) {
  const std::string body = "01 0 07 OK BUSY -- 123456";
  const std::string line = "@" + body + ":" + zaber_checksum(body);
  ZaberReply reply;
  ASSERT_EQ(read_zaber_line(line, true, reply), ZaberLine::kReply);
  for (std::size_t i = 1; i < line.size(); ++i)
    for (int bit = 0; bit < 7; ++bit) {
      std::string damaged = line;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      if (damaged[i] == '\r' || damaged[i] == '\n') continue;
      // A lower-case digit of the checksum is the same digit, but no device sends it.
      EXPECT_EQ(read_zaber_line(damaged, true, reply), ZaberLine::kDamaged) << damaged;
    }
  EXPECT_EQ(read_zaber_line("@" + body, true, reply), ZaberLine::kDamaged);
}

TEST(ZaberMessage, RubbishIsDamagedAndNothingWorse) {
  ZaberReply reply;
  for (const std::string line : {"", "@", "@01", "@01 0 OK", "@01 0 OK IDLE", "@aa 0 OK IDLE -- 0",
                                 "@01 0 OK SLEEPY -- 0", ":", "::::", "@01 0 OK IDLE --- 0"})
    EXPECT_EQ(read_zaber_line(line, false, reply), ZaberLine::kDamaged) << line;
}

TEST(ZaberMessage, FaultsStopAndNotesDoNot) {
  for (const std::string flag : {"FS", "FD", "FB", "FE", "FZ", "WT", "WV", "WL", "NC"})
    EXPECT_NE(zaber_fault(flag), "") << flag;
  for (const std::string flag : {"", "WR", "WH", "NI", "NU"}) EXPECT_EQ(zaber_fault(flag), "");
  EXPECT_TRUE(zaber_flag_means_not_homed("WR"));
  EXPECT_TRUE(zaber_flag_means_not_homed("WH"));
  EXPECT_FALSE(zaber_flag_means_not_homed(""));
}

}  // namespace
}  // namespace hydrodip
