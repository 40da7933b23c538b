#include "report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "laid_film.h"
#include "report/viewer_assets.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using fixtures::film_under_ball;
using fixtures::kRadius;
using fixtures::two_coloured_ball;
using Json = nlohmann::json;

Report full_report() {
  Report report;
  report.tool_version = "1.2.3";
  report.command = "print";
  report.command_line = {"hydrodip", "print", "<script>alert(1)</script>.obj"};
  report.inputs = {{"model", "a/<script>alert(1)</script>.obj", "00ff", 1234567}};
  report.parameters = {{"film.width_mm", "mm", 210.0, false},
                       {"dip.scheme", "", std::string("\"paper\" & co"), true},
                       {"pose.rotate_deg", "deg", std::array<double, 3>{0, 0, 90}, true}};
  report.stages = {{"load", 0.25}, {"dip", 1.5}};
  report.rounds = {{"ink", 1, {{"largest_change_mm", "largest change", 0.5, "mm"}}}};
  report.coverage = Coverage{};
  report.angles = DipAngles{};
  report.angles->downward_mm2 = 200;
  report.angles->over_limit_mm2 = 50;
  report.mesh = MeshHealth{};
  report.figures = {{"psnr_db", "PSNR", 36.5, "dB"},
                    {"nothing_mm", "Nothing", std::numeric_limits<double>::quiet_NaN(), "mm"}};
  report.warnings = {"The <b>file</b> is \xff odd."};
  report.outputs = {{"print.pdf", "the sheet"}};
  report.peak_memory_bytes = 1000;
  return report;
}

TEST(Report, JsonHoldsEverythingAndNoNan) {
  const std::string text = report_json(full_report());
  EXPECT_EQ(text.find("NaN"), std::string::npos);
  EXPECT_EQ(text.find("nan"), std::string::npos);
  const Json json = Json::parse(text);
  EXPECT_EQ(json["schema_version"], 1);
  EXPECT_EQ(json["tool"]["version"], "1.2.3");
  EXPECT_EQ(json["inputs"][0]["bytes"], 1234567);
  EXPECT_EQ(json["parameters"]["film.width_mm"]["value"], 210.0);
  EXPECT_EQ(json["parameters"]["film.width_mm"]["unit"], "mm");
  EXPECT_EQ(json["parameters"]["pose.rotate_deg"]["value"][2], 90.0);
  EXPECT_EQ(json["seconds"]["total"], 1.75);
  EXPECT_EQ(json["seconds"]["stages"][1]["stage"], "dip");
  EXPECT_EQ(json["rounds"][0]["largest_change_mm"], 0.5);
  EXPECT_EQ(json["figures"]["psnr_db"], 36.5);
  EXPECT_TRUE(json["figures"]["nothing_mm"].is_null());
  EXPECT_EQ(json["dip_angles"]["over_limit_mm2"], 50);
  EXPECT_EQ(json["dip_angles"]["over_limit_share"], 0.25);
  EXPECT_EQ(json["warnings"].size(), 1u);
  EXPECT_EQ(json["verdict"], "No film lies on the object: check --down and --depth.");
}

TEST(Report, EmptyReportIsStillAReport) {
  const Json json = Json::parse(report_json({}));
  EXPECT_EQ(json["schema_version"], 1);
  EXPECT_FALSE(json.contains("coverage"));
  EXPECT_NE(report_html({}, {}).find("</html>"), std::string::npos);
}

TEST(Report, IsCalledByTheJobsNameElseByTheModels) {
  Report report = full_report();
  report.inputs = {{"model", "models/mask.obj", "00ff", 1}, {"texture", "mask.png", "00ff", 1}};
  EXPECT_EQ(Json::parse(report_json(report))["title"], "mask.obj");
  EXPECT_NE(report_html(report, {}).find("<h1>mask.obj</h1>"), std::string::npos);
  report.title = "Mask for Anna";
  EXPECT_EQ(Json::parse(report_json(report))["title"], "Mask for Anna");
}

TEST(Report, HtmlEscapesWhateverComesFromOutside) {
  const std::string html = report_html(full_report(), {});
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("<b>file"), std::string::npos);
  EXPECT_NE(html.find("&lt;script&gt;alert(1)&lt;/script&gt;.obj"), std::string::npos);
  EXPECT_NE(html.find("&quot;paper&quot; &amp; co"), std::string::npos);
}

TEST(Report, HtmlNeedsNothingElse) {
  const std::string html = report_html(full_report(), {{1, 2, 3, 4}, {5, 6, 7, 8}});
  EXPECT_EQ(html.find("http"), std::string::npos);
  EXPECT_NE(html.find("data:image/png;base64,AQIDBA=="), std::string::npos);
  EXPECT_NE(html.find("data:image/png;base64,BQYHCA=="), std::string::npos);
}

TEST(Report, TheViewComesWithItsScene) {
  const std::string html = report_html(full_report(), {{1}, {2}, R"({"mark":1})"});
  const std::size_t scene =
      html.find(R"(<script type="application/json" id="scene">{"mark":1}</script>)");
  EXPECT_EQ(scene != std::string::npos, !viewer_script().empty());
  EXPECT_LT(html.find("id=\"verdict\""), html.find("id=\"viewer\""));
}

// Whatever is wrong with it: everything that has advice for the workshop.
Report bad_report() {
  Report report = full_report();
  Coverage& c = *report.coverage;
  c.object_mm2 = 2000;
  c.downward_mm2 = 1000;
  c.covered_mm2 = c.covered_downward_mm2 = 500;
  c.film_on_object_mm2 = 400;
  c.torn_mm2 = 300;
  c.doubtful_mm2 = 100;
  c.stretch_max = 1.6;
  c.area_ratio_max = 1.8;
  report.tear_stretch = 1.4;
  report.colors = ReportColors{6, 9};
  report.ink = ReportInk{2, 1, {}};
  report.better_way = "standing on its nose (--rotate 90,0,0)";
  report.title = "Lion & lamb";
  report.figures.push_back({"out_of_gamut_share", "", 0.25, ""});
  report.figures.push_back({"model_size_mm", "", std::array<double, 3>{100.2, 130, 30.4}, "mm"});
  return report;
}

TEST(Report, ACustomerReadsNothingOfTheWorkshop) {
  Report report = bad_report();
  const std::string workshop = report_html(report, {});
  report.for_customer = true;
  ReportPictures pictures;
  pictures.logo_png = {1, 2, 3, 4};
  const std::string html = report_html(report, pictures);
  const std::string words = html.substr(html.find("<main>"));
  for (const char* of_the_workshop :
       {"--", "_mm", "sha256", "00ff", ".obj", "a/", "1.2.3", "hydrodip", "paper", "CIEDE", "load",
        "print.pdf", "Activator", "activator", "odd"}) {
    EXPECT_EQ(words.find(of_the_workshop), std::string::npos) << of_the_workshop;
  }
  EXPECT_NE(workshop.find("--rotate"), std::string::npos);
  EXPECT_NE(words.find("<h1>Lion &amp; lamb</h1>"), std::string::npos);
  EXPECT_LT(words.find("data:image/png;base64,AQIDBA=="), words.find("<h1>"));
  EXPECT_NE(words.find("25 % of the picture has colours that these inks cannot give"),
            std::string::npos);
  EXPECT_NE(words.find("100 x 130 x 30 mm"), std::string::npos);
  // A dip that the workshop would not do is not promised.
  EXPECT_NE(words.find("It cannot be made well like this"), std::string::npos);
}

std::string customers_page(Report report, const ReportPictures& pictures) {
  report.for_customer = true;
  return report_html(report, pictures);
}

TEST(Report, ACustomerReadsOfGapsOnlyWherePictureIsLost) {
  Report report = bad_report();
  const auto tells_gaps = [&] {
    return customers_page(report, {{1}, {}}).find("places stay bare") != std::string::npos;
  };
  EXPECT_TRUE(tells_gaps());
  report.wanted = ReportWanted{100, 100, 100};
  EXPECT_FALSE(tells_gaps()) << "film tears, but where nothing is printed";
  EXPECT_NE(customers_page(report, {}).find("100 % of your picture comes out"), std::string::npos);
  report.wanted->covered_mm2 = 90;
  EXPECT_TRUE(tells_gaps());
}

TEST(Report, ACustomersDraftSaysSoAndPointsToNoPictureThatIsNotThere) {
  Report report = bad_report();
  const std::string with = customers_page(report, {{1}, {}});
  EXPECT_NE(with.find("as the picture shows"), std::string::npos);
  EXPECT_NE(with.find("compare the two pictures"), std::string::npos);
  EXPECT_EQ(with.find("raft"), std::string::npos);
  report.draft = true;
  const std::string draft = customers_page(report, {});
  for (const char* words : {"as the picture shows", "two pictures", "This is how it will look"})
    EXPECT_EQ(draft.find(words), std::string::npos) << words;
  EXPECT_NE(draft.find("Draft, not final"), std::string::npos);
  report.coverage->torn_mm2 = report.coverage->doubtful_mm2 = 0;
  EXPECT_NE(customers_page(report, {}).find("Draft, not final"), std::string::npos);
}

TEST(Report, ACustomersPageWithoutAPicturePromisesNoLook) {
  Report report = full_report();
  Coverage& c = *report.coverage;
  c.object_mm2 = c.downward_mm2 = c.covered_mm2 = c.covered_downward_mm2 = 1000;
  c.film_on_object_mm2 = 900;
  c.stretch_max = c.area_ratio_max = 1.1;
  EXPECT_NE(customers_page(report, {{1}, {}}).find("This is how it will look"), std::string::npos);
  const std::string without = customers_page(report, {});
  EXPECT_EQ(without.find("how it will look"), std::string::npos);
  EXPECT_NE(without.find("It can be made"), std::string::npos);
}

// What a page does not show it does not name.
TEST(Report, FindingsSayWhereOnThePageTheyAreSeen) {
  Report report = bad_report();
  const auto names = [&](const ReportPictures& pictures, const std::string& words) {
    return report_html(report, pictures).find(words) != std::string::npos;
  };
  const std::string tears = "The overlay &quot;tears&quot; shows where.";
  const std::string colors = "The overlay &quot;colour error&quot; shows where.";
  const std::string map = "The map under &quot;Where it is difficult&quot; shows where.";
  const ReportPictures of_a_draft;
  for (const std::string& words : {tears, colors, map}) EXPECT_FALSE(names(of_a_draft, words));
  const ReportPictures all{{1}, {2}, R"({"mark":1})"};
  const bool has_view = !viewer_script().empty();
  EXPECT_EQ(names(all, tears), has_view);
  EXPECT_EQ(names(all, colors), has_view);
  EXPECT_TRUE(names(all, map));
  // The view of several dips shows the finish, not one film.
  report.dips = {ReportDip{}, ReportDip{}};
  const ReportPictures finish{{1}, {}, R"({"mark":1})", {3}};
  EXPECT_FALSE(names(finish, tears));
  EXPECT_FALSE(names(finish, map));
  EXPECT_EQ(names(finish, colors), has_view);
}

TEST(Report, HtmlTagsAreBalanced) {
  Report customers = bad_report();
  customers.for_customer = true;
  const std::string html =
      report_html(full_report(), {{1, 2, 3}, {4, 5, 6}}) + report_html(customers, {{1, 2, 3}, {}});
  const auto count = [&](const std::string& what) {
    long n = 0;
    for (std::size_t at = html.find(what); at != std::string::npos; at = html.find(what, at + 1))
      ++n;
    return n;
  };
  for (const std::string tag : {"table", "tr", "td", "section", "div", "dl", "ul", "li", "code"}) {
    EXPECT_EQ(count("<" + tag + ">") + count("<" + tag + " "), count("</" + tag + ">")) << tag;
  }
}

TEST(Report, InputsCarryTheirHash) {
  const TemporaryFolder folder;
  write_file(folder / "abc.txt", std::string("abc"));
  const ReportInput input = describe_input("model", folder / "abc.txt");
  EXPECT_EQ(input.bytes, 3u);
  EXPECT_EQ(input.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_THROW(describe_input("model", folder / "missing"), InputError);
}

TEST(Coverage, CapOfABall) {
  const double reach = 16;
  const Object of_48 = two_coloured_ball(48);
  const Surface surface(of_48.positions, of_48.triangles);
  const Coverage c = measure_coverage(of_48, surface, film_under_ball(reach));
  const double ball = 4 * std::numbers::pi * kRadius * kRadius;
  EXPECT_NEAR(c.object_mm2, ball, 0.003 * ball);
  EXPECT_NEAR(c.downward_mm2, ball / 2, 0.003 * ball);
  // The film is cut off along whole triangles: the reach is uncertain by about a cell.
  const double cell = film_under_ball(reach).mesh().cell_mm;
  const auto cap = [](double r) {
    return 2 * std::numbers::pi * kRadius * (kRadius - std::sqrt(kRadius * kRadius - r * r));
  };
  EXPECT_GT(c.covered_mm2, cap(reach - 1.5 * cell));
  EXPECT_LT(c.covered_mm2, cap(reach));
  EXPECT_EQ(c.covered_mm2, c.covered_downward_mm2);
  EXPECT_NEAR(c.area_ratio_mean, c.covered_mm2 / c.film_on_object_mm2, 0.01);
  EXPECT_LE(c.stretch_max, 1 / 0.6 + 1e-9);
  EXPECT_GT(c.stretch_max, c.stretch_mean);
  EXPECT_EQ(c.torn_share(), 0);
}

TEST(Coverage, TornFilmNoLongerCovers) {
  DippedFilm film = film_under_ball();
  const Object ball = two_coloured_ball();
  const Surface surface(ball.positions, ball.triangles);
  const Coverage before = measure_coverage(ball, surface, film);
  for (std::size_t t = 0; t < film.torn.size(); ++t) film.torn[t] = film.lies_on_object(t) ? 1 : 0;
  const Coverage after = measure_coverage(ball, surface, film);
  EXPECT_EQ(after.covered_mm2, 0);
  EXPECT_EQ(after.torn_mm2, before.film_on_object_mm2);
  EXPECT_EQ(after.torn_share(), 1);
  EXPECT_EQ(after.stretch_mean, 1);
}

}  // namespace
}  // namespace hydrodip
