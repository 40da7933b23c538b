#include "calibrate/measured_dip.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

DipFacts facts() {
  DipFacts facts;
  facts.film = "maker, product";
  facts.printer = "printer";
  facts.ink = "ink";
  facts.activator = "activator";
  facts.water_c = 28.5;
  facts.soak_s = 70;
  facts.activator_g = 3.4;
  facts.wait_s = 30;
  facts.owner = "Somebody \"else\", é";
  facts.licence = "CC-BY-4.0";
  return facts;
}

MeasuredDip some_dip() {
  MeasuredDip dip;
  dip.object = "pyramid";
  dip.depth_mm = 21.3;
  dip.board = tint_board(4);
  dip.film.width_mm = 215.9;
  dip.film.height_mm = 279.4;
  dip.film.swelling_x = 1.025;
  dip.film.swelling_y = 1.013;
  dip.facts = facts();
  for (int i = 0; i < 12; ++i) {
    dip.scan.grid.position.push_back({0.1 * i, 1.0 / (i + 1), -3.7e-5 * i});
    dip.scan.grid.place.push_back({i % 4 - 2, i / 4});
    dip.scan.grid.patch.push_back(i / 8);
  }
  dip.scan_file = "scan.csv";
  dip.source = {'a', 'b', 0, 255};
  return dip;
}

class MeasuredDipTest : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(MeasuredDipTest, ComesBackToTheLastDigit) {
  const MeasuredDip dip = some_dip();
  write_measured_dip(folder_ / "a.zip", dip);
  const MeasuredDip back = read_measured_dip(folder_ / "a.zip");
  EXPECT_EQ(back.object, dip.object);
  EXPECT_EQ(back.depth_mm, dip.depth_mm);
  EXPECT_EQ(back.board.ink, dip.board.ink);
  EXPECT_EQ(back.board.square_mm, dip.board.square_mm);
  EXPECT_EQ(back.board.about_square, dip.board.about_square);
  EXPECT_EQ(back.film.width_mm, dip.film.width_mm);
  EXPECT_TRUE(back.says_swelling);
  EXPECT_EQ(back.film.swelling_x, dip.film.swelling_x);
  EXPECT_EQ(back.film.swelling_y, dip.film.swelling_y);
  EXPECT_EQ(back.facts.owner, dip.facts.owner);
  EXPECT_EQ(back.facts.water_c, dip.facts.water_c);
  EXPECT_FALSE(back.facts.speed_mm_per_min);
  EXPECT_EQ(back.scan.grid.position, dip.scan.grid.position);
  EXPECT_EQ(back.scan.grid.place, dip.scan.grid.place);
  EXPECT_EQ(back.scan.grid.patch, dip.scan.grid.patch);
  EXPECT_EQ(back.source, dip.source);
}

TEST_F(MeasuredDipTest, TheSameDipIsTheSameBytes) {
  write_measured_dip(folder_ / "a.zip", some_dip());
  write_measured_dip(folder_ / "b.zip", some_dip());
  EXPECT_EQ(read_file(folder_ / "a.zip"), read_file(folder_ / "b.zip"));
}

TEST_F(MeasuredDipTest, WhatWasDamagedAnywhereIsRefusedOrTheSame) {
  const MeasuredDip dip = some_dip();
  write_measured_dip(folder_ / "a.zip", dip);
  const std::vector<std::uint8_t> whole = read_file(folder_ / "a.zip");
  for (std::size_t i = 0; i < whole.size(); i += 3) {
    std::vector<std::uint8_t> bytes = whole;
    bytes[i] ^= 0x55;
    write_file(folder_ / "b.zip", bytes.data(), bytes.size());
    try {
      const MeasuredDip back = read_measured_dip(folder_ / "b.zip");
      EXPECT_EQ(back.scan.grid.position, dip.scan.grid.position) << i;
      EXPECT_EQ(back.depth_mm, dip.depth_mm) << i;
    } catch (const InputError&) {  // as it should
    }
  }
  write_file(folder_ / "c.zip", whole.data(), whole.size() / 2);
  EXPECT_NE(refusal([&] { read_measured_dip(folder_ / "c.zip"); }), "");
}

TEST_F(MeasuredDipTest, WhatIsMissingIsAskedForAllAtOnce) {
  const auto asks = [](const DipFacts& facts) { return refusal([&] { require_facts(facts); }); };
  EXPECT_EQ(asks(facts()), "");
  DipFacts some = facts();
  some.printer.clear();
  some.soak_s.reset();
  EXPECT_NE(asks(some).find("say --printer, --soak-s"), std::string::npos) << asks(some);
  DipFacts hot = facts();
  hot.water_c = 400;
  EXPECT_NE(asks(hot).find("--water-c"), std::string::npos);
  for (const char* date : {"yesterday", "27.11.2026", "2026-13-01", "2026-02-30", "2026-11-271"}) {
    DipFacts dated = facts();
    dated.dipped_on = date;
    EXPECT_NE(asks(dated).find("--dipped-on"), std::string::npos) << date;
  }
  DipFacts dated = facts();
  dated.dipped_on = "2028-02-29";
  EXPECT_EQ(asks(dated), "");
  DipFacts licence = facts();
  licence.licence = "do what you want";
  EXPECT_NE(asks(licence).find("SPDX"), std::string::npos);
}

}  // namespace
}  // namespace hydrodip
