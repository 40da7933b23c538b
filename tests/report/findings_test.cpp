#include "report/findings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace hydrodip {
namespace {

Report good_report() {
  Report report;
  Coverage c;
  c.object_mm2 = 2000;
  c.downward_mm2 = 1000;
  c.covered_mm2 = c.covered_downward_mm2 = 960;
  c.film_on_object_mm2 = 900;
  c.stretch_max = 1.2;
  c.area_ratio_max = 1.15;
  report.coverage = c;
  report.angles = DipAngles{};
  report.angles->downward_mm2 = 1000;
  report.tear_stretch = 1.4;
  report.bleed_mm = 1;
  return report;
}

const Finding* find(const std::vector<Finding>& list, const std::string& key) {
  const auto at =
      std::find_if(list.begin(), list.end(), [&](const Finding& f) { return f.key == key; });
  return at == list.end() ? nullptr : &*at;
}

Concern concern(const Report& report, const std::string& key) {
  const std::vector<Finding> list = findings(report);
  const Finding* finding = find(list, key);
  EXPECT_TRUE(finding) << key;
  return finding ? finding->concern : Concern::kNone;
}

TEST(Findings, NothingToSayAgainstAGoodDip) {
  const std::vector<Finding> list = findings(good_report());
  EXPECT_EQ(concern_of(list), Concern::kNone);
  EXPECT_EQ(headline(concern_of(list)), "Good to dip");
  for (const char* key : {"coverage", "tears", "stretch", "steepness", "registration"})
    EXPECT_TRUE(find(list, key)) << key;
}

TEST(Findings, WhateverIsWrongSaysWhatToDo) {
  Report report = good_report();
  report.coverage->covered_downward_mm2 = 400;
  report.coverage->torn_mm2 = 500;
  report.coverage->stretch_max = 1.39;
  report.coverage->area_ratio_max = 1.5;
  report.angles->over_limit_mm2 = 700;
  report.ink = ReportInk{3.2, 2.4};
  report.colors = ReportColors{6, 12};
  report.figures = {{"out_of_gamut_share", "Share", 0.3, ""}};
  report.warnings = {"The bath is small: take a larger one."};
  const std::vector<Finding> list = findings(report);
  for (const Finding& finding : list) {
    if (finding.key == "registration") continue;
    EXPECT_NE(finding.concern, Concern::kNone) << finding.key;
    if (finding.key == "warning") continue;  // a sentence that says both
    EXPECT_FALSE(finding.advice.empty()) << finding.key;
  }
  EXPECT_EQ(list.size(), 9u);
  EXPECT_EQ(concern_of(list), Concern::kStop);
}

TEST(Findings, FewTearsAreAFlawAndManyAStop) {
  Report report = good_report();
  report.coverage->torn_mm2 = 20;
  EXPECT_EQ(concern(report, "tears"), Concern::kCare);
  report.coverage->torn_mm2 = 200;
  EXPECT_EQ(concern(report, "tears"), Concern::kStop);
}

TEST(Findings, WhatNoFilmBearsIsAStop) {
  Report report = good_report();
  report.tear_stretch = 0;
  report.coverage->stretch_max = 1.99;
  EXPECT_NE(concern_of(findings(report)), Concern::kStop);
  report.coverage->stretch_max = 25.96;
  EXPECT_EQ(concern(report, "stretch"), Concern::kStop);
  // The headline says not to.
  EXPECT_EQ(verdict_of(report).find("dip it like this"), std::string::npos);
  EXPECT_EQ(verdict_of(report).find("covers"), std::string::npos);
  // Nor is that left out where film is lost as well, or only a picture is wanted.
  report.coverage->torn_mm2 = 1;
  EXPECT_NE(verdict_of(report).find("25.96"), std::string::npos);
  report.wanted = ReportWanted{100, 100, 100};
  EXPECT_NE(verdict_of(report).find("25.96"), std::string::npos);
}

TEST(Findings, WhatWasNotComputedIsAStop) {
  Report report = good_report();
  report.equilibrium = {600, 1, 1600, 0};
  EXPECT_EQ(concern(report, "equilibrium"), Concern::kStop);
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
  EXPECT_NE(verdict_of(report).find("not"), std::string::npos);
  report.equilibrium = {600, 0, 1600, 0};  // found in the end
  EXPECT_EQ(find(findings(report), "equilibrium"), nullptr);
  EXPECT_EQ(concern_of(findings(report)), Concern::kNone);
}

TEST(Findings, WhatLandsMoreThanThreeMillimetresOffIsAStop) {
  Report report = good_report();
  report.equilibrium.unsettled_mm = 1.5;  // and 1.2 times the usual millimetre
  EXPECT_EQ(concern(report, "registration"), Concern::kNone);
  report.equilibrium.unsettled_mm = 1.9;
  EXPECT_EQ(concern(report, "registration"), Concern::kStop);
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
}

// Each of the two is a care of its own.
TEST(Findings, FilmNearItsLimitAndPaleFilmAreNamed) {
  const auto advice = [](const Report& report) {
    const std::vector<Finding> list = findings(report);
    return find(list, "stretch")->advice;
  };
  Report report = good_report();
  report.coverage->stretch_max = 0.89 * report.tear_stretch;
  EXPECT_EQ(concern(report, "stretch"), Concern::kNone);
  EXPECT_EQ(advice(report), "");
  report.coverage->stretch_max = 0.91 * report.tear_stretch;
  EXPECT_EQ(concern(report, "stretch"), Concern::kCare);
  EXPECT_NE(advice(report).find("activator"), std::string::npos);
  report = good_report();
  report.coverage->area_ratio_max = 1.29;
  EXPECT_EQ(concern(report, "stretch"), Concern::kNone);
  report.coverage->area_ratio_max = 1.31;
  EXPECT_EQ(concern(report, "stretch"), Concern::kCare);
  EXPECT_NE(advice(report).find("paler"), std::string::npos);
  EXPECT_EQ(advice(report).find("activator"), std::string::npos);
}

TEST(Findings, DoubtfulFilmIsNamed) {
  Report report = good_report();
  EXPECT_EQ(find(findings(report), "doubtful"), nullptr);
  report.coverage->doubtful_mm2 = 5;
  EXPECT_EQ(concern(report, "doubtful"), Concern::kNone);
  report.coverage->doubtful_mm2 = 200;
  EXPECT_EQ(concern(report, "doubtful"), Concern::kCare);
}

// A picture that lies where film may tear is not promised, however little of the object that is.
TEST(Findings, WhatOfThePictureIsDoubtfulIsTold) {
  Report report = good_report();
  report.coverage->doubtful_mm2 = 5;
  report.wanted = ReportWanted{100, 100, 100};
  EXPECT_EQ(concern(report, "doubtful"), Concern::kNone);
  EXPECT_EQ(verdict_of(report).find("perhaps"), std::string::npos);
  report.coverage->doubtful_mm2 = 200;  // elsewhere, where nothing shall be printed
  EXPECT_EQ(concern(report, "doubtful"), Concern::kNone);
  report.wanted->doubtful_mm2 = 57;
  EXPECT_EQ(concern(report, "doubtful"), Concern::kCare);
  const std::vector<Finding> list = findings(report);
  EXPECT_NE(find(list, "doubtful")->text.find("57 %"), std::string::npos);
  EXPECT_NE(find(list, "coverage")->text.find(", 57 % of it only perhaps."), std::string::npos);
  EXPECT_NE(verdict_of(report).find("100 % of what shall be printed, 57 % of it only perhaps"),
            std::string::npos);
  EXPECT_DOUBLE_EQ(nlohmann::json::parse(report_json(report))["wanted"]["doubtful_share"], 0.57);
  report.dips.resize(2);
  EXPECT_NE(verdict_of(report).find("57 % of it only perhaps"), std::string::npos);
}

TEST(Findings, WithoutFilmOnTheObjectNothingElseMatters) {
  Report report = good_report();
  report.coverage->film_on_object_mm2 = 0;
  const std::vector<Finding> list = findings(report);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].concern, Concern::kStop);
  EXPECT_NE(list[0].advice.find("--down"), std::string::npos);
}

// Turning it would help nothing, so that is not what is advised.
TEST(Findings, WhereNoFilmStaysOnWhatLooksInwardsThatIsSaid) {
  Report report = good_report();
  report.coverage->film_on_object_mm2 = 0;
  report.coverage->torn_mm2 = 500;
  report.mesh = MeshHealth{.boundary_edges = 4, .inside_out = true};
  const std::vector<Finding> list = findings(report);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_NE(list[0].text.find(kLooksInwards), std::string::npos);
  EXPECT_NE(list[0].advice.find(kTurnNormals), std::string::npos);
  EXPECT_EQ(verdict_of(report),
            "No film stays on the object: its faces look inwards; turn their normals round in the "
            "program that made it.");
  EXPECT_NE(short_verdict(report).find(kLooksInwards), std::string::npos);
  const std::string of_one = verdict_of(report);
  report.dips.resize(2);
  EXPECT_EQ(verdict_of(report), of_one);
}

// The map's slope is the stretch: a millimetre beside on the film is that much on the object.
TEST(Findings, RegistrationErrorGrowsWithStretch) {
  const std::vector<Finding> list = findings(good_report());
  EXPECT_EQ(find(list, "registration")->figure, "1.2 mm");
}

// Film that is lost and a share near 100 % of what faces down would contradict each other.
TEST(Findings, BesideTearsCoverageIsOfTheWholeObject) {
  Report report = good_report();
  report.coverage->covered_downward_mm2 = report.coverage->downward_mm2;
  report.coverage->torn_mm2 = 200;
  const std::vector<Finding> list = findings(report);
  const Coverage& c = *report.coverage;
  EXPECT_EQ(std::stod(find(list, "coverage")->figure), std::round(100 * c.covered_share()));
  EXPECT_EQ(verdict_of(report).find("100 %"), std::string::npos);
  EXPECT_EQ(short_verdict(report).find("100 %"), std::string::npos);
}

// Whoever changes the depth a little must not read of another share of another thing.
TEST(Findings, CoverageIsOfTheSameWhetherOrNotFilmTears) {
  Report report = good_report();
  const std::string told =
      std::to_string(std::lround(100 * report.coverage->covered_share())) + " % of the object";
  for (const double torn_mm2 : {0.0, 200.0}) {
    report.coverage->torn_mm2 = torn_mm2;
    const std::vector<Finding> list = findings(report);
    const Finding& coverage = *find(list, "coverage");
    EXPECT_NE((coverage.figure + " " + coverage.text).find(told), std::string::npos) << torn_mm2;
    EXPECT_NE(verdict_of(report).find(told), std::string::npos) << verdict_of(report);
    EXPECT_NE(short_verdict(report).find(told), std::string::npos) << short_verdict(report);
  }
}

// A sheet that brings nothing, and film of which most is lost, are no dips to make; torn film alone
// is none of their business, as another dip may bring what belongs there.
TEST(Findings, OfSeveralDipsNoneIsMadeForNothing) {
  Report report = good_report();
  report.coverage->film_on_object_mm2 = 1000;
  report.coverage->torn_mm2 = 1500;  // 60 % of what meets the object
  report.together = ReportWanted{2000, 1000, 960};
  report.dips.resize(2);
  report.dips[0].gained_share = 0.3;
  report.dips[1].gained_share = 0.1;
  EXPECT_EQ(concern_of(findings(report)), Concern::kCare);
  report.dips[1].gained_share = 0;
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
  EXPECT_EQ(find(findings(report), "idle_dips")->figure, "2");
  report.dips[1].gained_share = 0.1;
  report.dips[1].blank = true;  // film that covers, and brings no ink
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
  report.dips[1].blank = false;
  report.dips[1].gained_wanted_share = 0;  // it lies where nothing shall be printed
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
  report.dips[1].gained_wanted_share = 0.05;
  EXPECT_EQ(concern_of(findings(report)), Concern::kCare);
}

// No more are proposed than there may be, nor where one is for nothing already.
TEST(Findings, OneDipMoreIsProposedWhereThereMayBeOne) {
  Report report = good_report();
  report.coverage->torn_mm2 = 1500;
  report.together = ReportWanted{2000, 1000, 500};
  const auto advice = [&](const char* key) { return find(findings(report), key)->advice; };
  const auto with_dips = [&](int dips) {
    report.dips.assign(std::size_t(dips), {});
    for (ReportDip& dip : report.dips) dip.gained_share = 0.02;
  };
  with_dips(23);
  EXPECT_EQ(concern(report, "tears"), Concern::kStop);
  EXPECT_TRUE(advice("tears").find("--dips 24") != std::string::npos) << advice("tears");
  EXPECT_TRUE(advice("coverage").find("--dips") != std::string::npos) << advice("coverage");
  report.dips.back().gained_share = 0;
  EXPECT_EQ(advice("tears").find("--dips"), std::string::npos) << advice("tears");
  with_dips(24);
  EXPECT_EQ(concern(report, "tears"), Concern::kStop);
  for (const char* key : {"tears", "coverage"})
    EXPECT_EQ(advice(key).find("--dips"), std::string::npos) << advice(key);
  report.wanted = ReportWanted{1500, 1000, 500};
  EXPECT_EQ(advice("coverage").find("--dips"), std::string::npos) << advice("coverage");
}

// All of what faces down may be little of an object that shall be coloured all around.
TEST(Findings, ADipThatColoursLittleOfTheObjectIsToldToBeOneOfSeveral) {
  Report report = good_report();
  report.coverage->object_mm2 = 50000;  // 2 % of it
  EXPECT_EQ(concern(report, "coverage"), Concern::kCare);
  const Finding told = findings(report).front();
  EXPECT_EQ(told.key, "coverage");
  EXPECT_EQ(told.figure, "1.9 %");
  EXPECT_NE(told.advice.find("hydrodip plan"), std::string::npos) << told.advice;
  EXPECT_EQ(concern_of(findings(report)), Concern::kCare);
  report.wanted = ReportWanted{960, 960, 960};  // a picture on one side, all of it
  EXPECT_EQ(concern(report, "coverage"), Concern::kNone);
  report.wanted.reset();
  report.dip_number = 1, report.dip_of = 2;  // others do the rest
  EXPECT_EQ(concern(report, "coverage"), Concern::kNone);
}

// Much film for little: nobody forbids it, and who plans is told.
TEST(Findings, ADipThatTearsMostOfItsFilmForLittleIsHardlyWorthIt) {
  Report report = good_report();
  report.coverage->torn_mm2 = 1500;
  report.together = ReportWanted{2000, 1000, 960};
  report.dips.resize(3);
  for (ReportDip& dip : report.dips) dip.gained_share = 0.3;
  report.dips[1].gained_share = 0.02;
  EXPECT_EQ(find(findings(report), "poor_dips"), nullptr);  // it closes a gap
  report.dips[1].torn_share = 0.88;
  EXPECT_EQ(concern(report, "poor_dips"), Concern::kCare);
  EXPECT_EQ(find(findings(report), "poor_dips")->figure, "2");
  EXPECT_NE(find(findings(report), "poor_dips")->text.find("2.0 % of the surface"),
            std::string::npos);
  EXPECT_NE(find(findings(report), "poor_dips")->advice.find("--dips 2"), std::string::npos);
  report.dips[1].gained_share = 0.04;
  EXPECT_EQ(find(findings(report), "poor_dips"), nullptr);
  report.dips[1].gained_wanted_share = 0.01;
  EXPECT_NE(find(findings(report), "poor_dips"), nullptr);
  report.dips[1].gained_wanted_share = 0;  // nothing at all is another matter
  EXPECT_EQ(find(findings(report), "poor_dips"), nullptr);
  EXPECT_EQ(find(findings(report), "idle_dips")->figure, "2");
  EXPECT_NE(find(findings(report), "idle_dips")->advice.find("--dips 2"), std::string::npos);
}

// Nobody can do with fewer dips and make more of them.
TEST(Findings, WhereADipIsForNothingOrHardlyAnythingNoneAdvisesMoreDips) {
  const auto advises_more = [](const Report& report) {
    for (const Finding& finding : findings(report))
      for (const char* more : {"ore dips", "--dips 4"})
        if (finding.advice.find(more) != std::string::npos) return true;
    return false;
  };
  Report report = good_report();
  report.coverage->torn_mm2 = 1500;
  report.together = ReportWanted{2000, 1500, 600};
  report.dips.resize(3);
  for (ReportDip& dip : report.dips) dip.gained_share = 0.1;
  for (const bool is_picture : {false, true}) {
    if (is_picture) report.wanted = ReportWanted{500, 500, 200};
    EXPECT_EQ(concern(report, "tears"), Concern::kStop);
    report.dips[1] = {};
    report.dips[1].gained_share = 0.1;
    EXPECT_TRUE(advises_more(report));
    EXPECT_TRUE(more_dips_may_help(report));
    Report most = report;
    most.dips.resize(24, most.dips[0]);
    EXPECT_FALSE(advises_more(most)) << "a job has no more";
    report.dips[1].gained_share = 0;
    ASSERT_NE(find(findings(report), "idle_dips"), nullptr);
    EXPECT_FALSE(advises_more(report));
    report.dips[1].gained_share = 0.02;
    report.dips[1].torn_share = 0.9;
    ASSERT_NE(find(findings(report), "poor_dips"), nullptr);
    EXPECT_FALSE(advises_more(report));
    EXPECT_FALSE(more_dips_may_help(report));
  }
}

// Where a little air stays is told of its dip, and forbids nothing; once, and not of all.
TEST(Findings, AirOfOneOfSeveralDipsIsToldOfThatDip) {
  Report report = good_report();
  TrappedAir air;
  air.pockets.resize(1);
  air.pockets[0].area_mm2 = 1;
  report.air = std::make_shared<const TrappedAir>(air);
  EXPECT_EQ(concern(report, "air"), Concern::kCare);
  report.dips.resize(2);
  for (ReportDip& dip : report.dips) dip.gained_share = 0.3;
  report.dips[1].obstacle =
      ReportObstacle{"Trapped air: 1 mm2", "stays dry", "Drill a vent.", false};
  EXPECT_EQ(find(findings(report), "air"), nullptr);
  EXPECT_EQ(concern(report, "dip"), Concern::kCare);
  EXPECT_EQ(find(findings(report), "dip")->title, "Dip 2");
  EXPECT_NE(concern_of(findings(report)), Concern::kStop);
}

// What no film brings counts, and if that is not known, the torn film: of a picture on one side by
// the rule of one dip, of what goes around the object once it is more than a third.
TEST(Findings, TornFilmOfSeveralDipsIsAStopWhereNoOtherBringsWhatIsLost) {
  Report report = good_report();
  report.coverage->torn_mm2 = 1100;  // 55 %
  report.dips.resize(2);
  for (ReportDip& dip : report.dips) dip.gained_share = 0.3;
  EXPECT_EQ(concern(report, "tears"), Concern::kStop);
  report.together = ReportWanted{2000, 1500, 900};
  EXPECT_EQ(concern(report, "tears"), Concern::kStop);
  EXPECT_NE(find(findings(report), "tears")->text.find("40 % of the surface"), std::string::npos);
  EXPECT_NE(find(findings(report), "tears")->advice.find("--dips 3"), std::string::npos);
  EXPECT_DOUBLE_EQ(nlohmann::json::parse(report_json(report))["missed_share"], 0.4);
  report.together = ReportWanted{2000, 1500, 1200};
  EXPECT_EQ(concern(report, "tears"), Concern::kCare);
  report.dips.resize(1);  // one alone
  EXPECT_EQ(concern(report, "tears"), Concern::kStop);
  report.dips.resize(2);
  report.dips[1].gained_share = 0.3;
  report.coverage->object_mm2 = 2000;
  report.wanted = ReportWanted{2000, 1500, 1200};
  EXPECT_EQ(concern(report, "tears"), Concern::kCare);
  report.wanted = ReportWanted{2000, 1500, 900};
  EXPECT_EQ(concern(report, "tears"), Concern::kStop);
  report.wanted = ReportWanted{500, 500, 490};  // what tears is not of the picture
  EXPECT_EQ(concern(report, "tears"), Concern::kCare);
  report.wanted = ReportWanted{500, 500, 400};
  EXPECT_EQ(concern(report, "tears"), Concern::kStop);
}

TEST(Findings, AFragmentOfThePictureIsNoDip) {
  Report report = good_report();
  report.coverage->object_mm2 = 1000;
  report.wanted = ReportWanted{200, 100, 100};
  EXPECT_EQ(concern_of(findings(report)), Concern::kCare);
  report.wanted = ReportWanted{200, 98, 98};
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
  report.wanted = ReportWanted{200, 12, 10};
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
  // Around the object: what a straight dip reaches of it at best is less than half.
  report.wanted = ReportWanted{900, 300, 300};
  EXPECT_EQ(concern_of(findings(report)), Concern::kCare);
  report.wanted = ReportWanted{900, 220, 220};
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
}

// The bare rest of an object is nothing that dips of a small picture have to bring.
TEST(Findings, OfSeveralDipsThePictureCountsWhereThereIsOne) {
  Report report = good_report();
  report.coverage->object_mm2 = 1000;
  report.coverage->covered_mm2 = 400;
  report.dips.resize(2);
  report.dips[0].gained_share = report.dips[1].gained_share = 0.2;
  EXPECT_EQ(find(findings(report), "coverage")->figure, "40 %");
  report.wanted = ReportWanted{200, 200, 198};
  EXPECT_EQ(find(findings(report), "coverage")->figure, "99 %");
  EXPECT_NE(verdict_of(report).find("99 % of what shall be printed"), std::string::npos);
  EXPECT_EQ(verdict_of(report).find("40 %"), std::string::npos);
}

// Whatever stops a dip is in its sentence, and then it does not end with "dip it like this".
TEST(Findings, TheSentenceNamesWhatIsInTheWay) {
  Report report = good_report();
  EXPECT_NE(verdict_of(report).find("dip it like this."), std::string::npos);
  TrappedAir air;
  air.pockets.resize(1);
  air.pockets[0].area_mm2 = 608;
  report.air = std::make_shared<const TrappedAir>(air);
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
  EXPECT_EQ(verdict_of(report).find("dip it like this."), std::string::npos);
  EXPECT_NE(verdict_of(report).find("608 mm2"), std::string::npos);
  report.coverage->torn_mm2 = 20;
  EXPECT_NE(verdict_of(report).find("608 mm2"), std::string::npos);
}

// Film that is said never to tear is not said to tear; what is lost folds over.
TEST(Findings, FilmThatNeverTearsFolds) {
  Report report = good_report();
  report.tear_stretch = 0;
  report.coverage->torn_mm2 = 20;
  EXPECT_EQ(verdict_of(report).find("tears"), std::string::npos);
  EXPECT_NE(verdict_of(report).find("folds"), std::string::npos);
}

TEST(Findings, NumbersInSentencesAreForPeople) {
  Report report = good_report();
  TrappedAir air;
  air.pockets.resize(1);
  air.pockets[0].area_mm2 = 608;
  air.pockets[0].volume_mm3 = 284e3;
  air.pockets[0].top = Vec3(-0.4, -1, 4);
  report.air = std::make_shared<const TrappedAir>(air);
  report.equilibrium = {600, 1, 1600, 0};
  report.colors = ReportColors{0.1, 0.04};
  const std::vector<Finding> list = findings(report);
  EXPECT_NE(find(list, "air")->text.find("284 ml"), std::string::npos);
  EXPECT_NE(find(list, "air")->text.find("(0, -1, 4) mm"), std::string::npos);
  EXPECT_NE(find(list, "equilibrium")->text.find("1600 mm"), std::string::npos);
  EXPECT_NE(find(list, "colors")->text.find("no more than 0.1."), std::string::npos);
  // Of both, what stands in a caption and in a sentence.
  report.equilibrium = {};
  report.coverage->torn_mm2 = 90;  // 9.09 % of what meets the object
  report.coverage->covered_mm2 = 178;
  for (const std::string& told : {short_verdict(report), verdict_of(report)}) {
    EXPECT_NE(told.find("8.9 % of the object"), std::string::npos) << told;
    EXPECT_NE(told.find("9.1 % of "), std::string::npos) << told;
  }
}

// All together are no better than one that is not to be made.
TEST(Findings, AnObstacleOfOneDipIsOneOfAll) {
  Report report = good_report();
  report.dips.resize(2);
  for (ReportDip& dip : report.dips) dip.gained_share = 0.3;
  ASSERT_NE(concern_of(findings(report)), Concern::kStop);
  report.dips[1].obstacle = ReportObstacle{"Trapped air: 242 mm2", "stays dry", "Drill a vent."};
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
  EXPECT_NE(verdict_of(report).find("Dip 2: Trapped air: 242 mm2"), std::string::npos);
}

// One [[dip]] is a dip like any other.
TEST(Findings, ASingleDipInATableIsJudgedAsOne) {
  Report report = good_report();
  report.coverage->torn_mm2 = 200;
  ASSERT_EQ(concern(report, "tears"), Concern::kStop);
  report.dips.resize(1);
  report.dips[0].gained_share = 0.3;
  EXPECT_EQ(concern(report, "tears"), Concern::kStop);
  EXPECT_EQ(find(findings(report), "coverage")->text, "of the object is under film after 1 dip.");
}

// What is printed as it is, is printed on film that tears as well.
TEST(Findings, NothingIsLeftOutOfAFinishedImage) {
  Report report = good_report();
  report.coverage->torn_mm2 = 200;
  EXPECT_NE(find(findings(report), "tears")->text.find("nothing is printed"), std::string::npos);
  report.finished_image = true;
  EXPECT_EQ(find(findings(report), "tears")->text.find("nothing is printed"), std::string::npos);
}

// Two films that do not meet have no seam whose colours could be off.
TEST(Findings, WithoutASeamNothingIsSaidOfIt) {
  Report report = good_report();
  report.dips.resize(2);
  report.seams = ReportSeams{};
  EXPECT_EQ(find(findings(report), "seams"), nullptr);
  report.seams->length_mm = 12;
  EXPECT_NE(find(findings(report), "seams"), nullptr);
}

TEST(Findings, StretchBeyondTheLimitIsSaidToBeThat) {
  Report report = good_report();
  report.tear_stretch = 1.4;
  report.coverage->stretch_max = 1.49;
  EXPECT_NE(find(findings(report), "stretch")->text.find("beyond the 1.40"), std::string::npos);
}

// A logo that lands whole, on an object whose other film tears.
TEST(Findings, FilmThatTearsWhereNothingIsPrintedForbidsNothing) {
  Report report = good_report();
  report.coverage->torn_mm2 = 500;
  EXPECT_EQ(concern_of(findings(report)), Concern::kStop);
  report.wanted = ReportWanted{100, 100, 100};
  std::vector<Finding> list = findings(report);
  EXPECT_EQ(concern_of(list), Concern::kCare);
  EXPECT_NE(find(list, "tears")->text.find("where nothing shall be printed"), std::string::npos);
  EXPECT_EQ(find(list, "coverage")->figure, "100 %");
  EXPECT_EQ(find(list, "coverage")->concern, Concern::kNone);
  // A part of it stays out of the water: nothing is spoilt, but it is said.
  report.wanted = ReportWanted{200, 100, 100};
  list = findings(report);
  EXPECT_EQ(find(list, "tears")->concern, Concern::kCare);
  EXPECT_EQ(find(list, "coverage")->figure, "50 %");
  EXPECT_EQ(find(list, "coverage")->concern, Concern::kCare);
  // A fifth of it is torn.
  report.wanted = ReportWanted{100, 100, 80};
  EXPECT_EQ(concern(report, "tears"), Concern::kStop);
}

TEST(Findings, SeveralDipsAreJudgedTogether) {
  Report report = good_report();
  report.dips.resize(3);
  report.coverage->covered_mm2 = 0.95 * report.coverage->object_mm2;
  report.seams = ReportSeams{120, 2, 1.2, 1, 3.5};
  std::vector<Finding> list = findings(report);
  EXPECT_EQ(find(list, "coverage")->figure, "95 %");
  EXPECT_EQ(find(list, "coverage")->concern, Concern::kNone);
  EXPECT_EQ(find(list, "seams")->figure, "120 mm");
  report.coverage->covered_mm2 = 0.5 * report.coverage->object_mm2;
  EXPECT_EQ(concern(report, "coverage"), Concern::kCare);
  const auto json = nlohmann::json::parse(report_json(report));
  EXPECT_EQ(json["dips"].size(), 3u);
  EXPECT_EQ(json["seams"]["error_mean_off_ciede2000"], 3.5);
}

// Who looked for the best way is not sent to look for it.
TEST(Findings, BeyondTheBestWayThatWasFoundOtherThingsHelp) {
  Report report = good_report();
  report.wanted = ReportWanted{500, 400, 300};
  EXPECT_EQ(beyond_best_dip(report), "");
  EXPECT_NE(find(findings(report), "coverage")->advice.find("--rotate auto"), std::string::npos);
  report.found_best = report.has_artwork = true;
  const std::string advice = find(findings(report), "coverage")->advice;
  EXPECT_EQ(advice.find("--rotate"), std::string::npos) << advice;
  EXPECT_NE(advice.find("best single dip"), std::string::npos) << advice;
  EXPECT_NE(advice.find("--dips 2"), std::string::npos) << advice;
  EXPECT_NE(advice.find("--art-size"), std::string::npos) << advice;
  report.one_dip_only = true;
  EXPECT_EQ(beyond_best_dip(report).find("--dips"), std::string::npos);
  report.has_artwork = false;
  EXPECT_NE(beyond_best_dip(report).find("--size"), std::string::npos);
}

TEST(Findings, TheBetterWayIsQuoted) {
  Report report = good_report();
  report.better_way = "lying on its -x side";
  EXPECT_NE(find(findings(report), "better_way")->text.find("-x side"), std::string::npos);
}

TEST(Findings, AreInTheJson) {
  const auto json = nlohmann::json::parse(report_json(good_report()));
  EXPECT_EQ(json["concern"], "none");
  EXPECT_EQ(json["findings"].size(), 5u);
  EXPECT_EQ(json["findings"][1]["figure"], "none");
}

}  // namespace
}  // namespace hydrodip
