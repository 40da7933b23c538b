#include "report/findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "dip/dip.h"
#include "report/shares.h"
#include "transfer/allotment.h"

namespace hydrodip {
namespace {

constexpr double kMostOfAPicture = 0.5;      // of one on a side of the object: less is a fragment
constexpr double kHardlyAPicture = 0.25;     // the same, of one that goes around it
constexpr double kOneSide = 0.5;             // of the object's surface
constexpr double kMuchTorn = 0.1;            // of the film that meets the object
constexpr double kMuchBareAround = 1.0 / 3;  // of what comes to any of several films
constexpr double kMuchAir = 0.02;            // of the object's surface
constexpr double kSomeEscapes = 0.05;        // of a pocket
constexpr double kFewWrinkles = 0.01;        // of the film on the object
constexpr double kNearLimit = 0.9;           // of the tear stretch
constexpr double kMuchSteep = 0.1;           // of what faces down
constexpr double kHardlyAnything = 0.002;    // of the surface: a dip not worth its sheet
constexpr double kLittleGained = 0.03;       // the same, of a dip whose film is mostly lost
constexpr double kMostlyTorn = 0.5;          // of a dip's film that meets the object
constexpr double kFarOff_mm = 3;             // from there on a picture is not on the object

Finding no_film(const Coverage& c, bool inside_out) {
  Finding finding{"coverage", Concern::kStop, "Coverage", "0 %", "", ""};
  if (inside_out) {
    finding.text = fmt::format("No film stays on the object: {}.", kLooksInwards);
    finding.advice = fmt::format("To mend it, {}.", kTurnNormals);
  } else if (c.torn_mm2 > 0) {
    finding.text = "All film that meets the object tears.";
    finding.advice =
        "Turn a flatter side down with --rotate or --down, or use a film that bears "
        "more (material.tear_stretch).";
  } else {
    finding.text = "No film lies on the object.";
    finding.advice = "Check which side goes down (--down) and how deep (--depth).";
  }
  return finding;
}

std::string after_dips(std::size_t dips) {
  return dips == 1 ? "after 1 dip" : fmt::format("after {} dips", dips);
}

bool goes_around(const ReportWanted& picture, const Coverage& c) {
  return picture.object_mm2 > kOneSide * c.object_mm2;
}

// A picture on one side can be held down; of one that goes around no single dip brings all.
Finding coverage_of_wanted(const ReportWanted& wanted, const Coverage& c,
                           const std::string& beyond_best) {
  const bool nearly_all = wanted.covered_share() >= kWholePicture;
  const bool hardly =
      wanted.covered_share() < (goes_around(wanted, c) ? kHardlyAPicture : kMostOfAPicture);
  Finding finding{"coverage",
                  nearly_all ? Concern::kNone
                  : hardly   ? Concern::kStop
                             : Concern::kCare,
                  "Coverage",
                  percent(wanted.covered_share()),
                  "of what shall be printed gets film that holds" + only_perhaps(wanted) + ".",
                  ""};
  if (!nearly_all)
    finding.advice = !beyond_best.empty()
                         ? beyond_best
                         : "Hold what shall be printed down (--rotate auto finds how), or give the "
                           "rest other dips (--dips).";
  return finding;
}

// What to do about surface that stays bare where all of it shall be printed.
std::string give_it_more_dips(const Report& report, bool hardly) {
  const std::string bare = "What stays bare shows the object's own colour: ";
  if (report.one_dip_only)
    return bare + "paint the object to match (object.base_color)" +
           (report.found_best ? "." : ", or hold it another way (--rotate auto).");
  return bare + (hardly ? "give it other dips, turned: 'hydrodip plan' with --dips finds them, and "
                          "says how much each one adds."
                        : "give it other dips, turned (--dips), or paint the object to match "
                          "(object.base_color).");
}

Finding coverage(const Report& report) {
  const Coverage& c = *report.coverage;
  if (!(c.film_on_object_mm2 > 0)) return no_film(c, is_inside_out(report));
  if (report.wanted) return coverage_of_wanted(*report.wanted, c, beyond_best_dip(report));
  // Whatever faces down: of one of several dips, the others do the rest.
  const bool hardly = c.covered_share() < kHardlyAPicture && report.dip_of < 2;
  // The same measure whatever becomes of the film, so that figures compare. Beside film that is
  // lost, the share of what faces down would tell little.
  if (c.torn_mm2 > 0)
    return {"coverage",
            Concern::kCare,
            "Coverage",
            percent(c.covered_share()),
            "of the object gets film that holds.",
            give_it_more_dips(report, hardly)};
  const bool enough = c.covered_downward_share() >= kNearlyAll && !hardly;
  return {"coverage",
          enough ? Concern::kNone : Concern::kCare,
          "Coverage",
          percent(c.covered_share()),
          fmt::format("of the object gets film, {} of what faces down.",
                      percent(c.covered_downward_share())),
          enough ? "" : give_it_more_dips(report, hardly)};
}

// Torn film is a loss where something shall be printed and no dip brings it. Several dips that
// shall colour an object all around tear somewhere on every real one, however they are planned: of
// theirs a person touches up what stays bare, up to a third.
bool much_is_lost(const Report& report) {
  const Coverage& c = *report.coverage;
  const std::optional<double> missed = missed_share(report);
  const bool around = report.dips.size() > 1 && (!report.wanted || goes_around(*report.wanted, c));
  return c.torn_share() > kMuchTorn &&
         (!missed || *missed > (around ? kMuchBareAround : kMuchTorn));
}

Finding tears(const Report& report) {
  const Coverage& c = *report.coverage;
  if (!(c.torn_mm2 > 0))
    return {"tears", Concern::kNone, "Tears", "none", "The film holds everywhere.", ""};
  if (report.wanted && report.wanted->missed_share() < 1 - kWholePicture)
    return {"tears",
            Concern::kCare,
            "Tears",
            percent(c.torn_share()),
            "of the film that meets the object tears, where nothing shall be printed.",
            "Take torn film off the water and the object before it dries."};
  const bool much = much_is_lost(report);
  return {"tears",
          much ? Concern::kStop : Concern::kCare,
          "Tears",
          percent(c.torn_share()),
          report.finished_image
              ? "of the film that meets the object tears; what the image has there is lost."
              : "of the film that meets the object tears; nothing is printed there.",
          "Turn steep sides down (--rotate, --down), dip less deep (--depth) and the rest in "
          "another turn, or use a film that bears more."};
}

bool is_of_several(const Report& report) { return report.dips.size() > 1 || report.dip_of > 1; }

// Of what shall be printed, if that is not everywhere.
double gain_of(const ReportDip& dip) { return dip.gained_wanted_share.value_or(dip.gained_share); }

bool is_idle(const ReportDip& dip) { return dip.blank || gain_of(dip) < kHardlyAnything; }

bool is_hardly_worth_it(const ReportDip& dip) {
  return !is_idle(dip) && gain_of(dip) < kLittleGained && dip.torn_share > kMostlyTorn;
}

// No dip inks what it tears, and another one may bring what belongs there: all are judged by what
// none brings, and each by itself not at all.
Finding tears_of_several(const Report& report) {
  const Coverage& c = *report.coverage;
  const std::optional<double> missed = missed_share(report);
  if (!(c.torn_mm2 > 0)) return tears(report);
  const bool lost = !report.dips.empty() && much_is_lost(report);
  std::string text =
      "of the film that meets the object tears. Nothing is printed on it; what no other dip "
      "brings there stays bare";
  if (!report.dips.empty() && missed)
    text += fmt::format(": {} of {} that comes to a film", percent(*missed),
                        report.wanted ? "what shall be printed" : "the surface");
  return {"tears",
          lost ? Concern::kStop : Concern::kCare,
          "Tears",
          percent(c.torn_share()),
          text + ".",
          !lost ? "Take torn film off the water and the object before it dries."
          : more_dips_may_help(report)
              ? fmt::format(
                    "Make more dips ('hydrodip plan' with --dips {} looks for them), or use a film "
                    "that bears more.",
                    report.dips.size() + 1)
              : "Use a film that bears more, or hold the object another way: 'hydrodip plan' looks "
                "for ways."};
}

// " (--dips 5)": how to do without so many.
std::string with_fewer(std::size_t dips, std::size_t fewer) {
  return fmt::format(" (--dips {})", dips - fewer);
}

std::vector<std::size_t> numbers_of(const std::vector<ReportDip>& dips,
                                    bool (*is_meant)(const ReportDip&)) {
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < dips.size(); ++k)
    if (is_meant(dips[k])) numbers.push_back(k + 1);
  return numbers;
}

// A sheet, a bath and an afternoon for nothing.
void add_idle_dips(const std::vector<ReportDip>& dips, std::vector<Finding>& list) {
  const std::vector<std::size_t> idle = numbers_of(dips, is_idle);
  if (idle.empty()) return;
  const bool one = idle.size() == 1;
  list.push_back(
      {"idle_dips", Concern::kStop, one ? "A dip for nothing" : "Dips for nothing",
       fmt::format("{}", fmt::join(idle, ", ")),
       one ? "adds hardly anything to what the others bring: its sheet is all but blank."
           : "add hardly anything to what the others bring: their sheets are all but blank.",
       idle.size() < dips.size()
           ? fmt::format("Leave {} out{}, or hold the object another way.", one ? "it" : "them",
                         with_fewer(dips.size(), idle.size()))
           : "Hold the object another way: 'hydrodip plan' looks for ways."});
}

// Or for next to nothing.
void add_poor_dips(const Report& report, std::vector<Finding>& list) {
  const std::vector<ReportDip>& dips = report.dips;
  const std::vector<std::size_t> poor = numbers_of(dips, is_hardly_worth_it);
  if (poor.empty() || poor.size() == dips.size()) return;
  const bool one = poor.size() == 1;
  const std::string of = report.wanted ? "what shall be printed" : "the surface";
  const ReportDip& first = dips[poor.front() - 1];
  list.push_back(
      {"poor_dips", Concern::kCare,
       one ? "A dip hardly worth its film" : "Dips hardly worth their film",
       fmt::format("{}", fmt::join(poor, ", ")),
       one ? fmt::format("adds {} of {}, and {} of its film that meets the object tears.",
                         percent(gain_of(first)), of, percent(first.torn_share))
           : fmt::format("add less than {} of {} each, and most of their film tears.",
                         percent(kLittleGained), of),
       fmt::format("{}{} {} nearly as much.", one ? "One fewer" : "Fewer",
                   with_fewer(dips.size(), poor.size()), one ? "brings" : "bring")});
}

// What is in the way of one of them is in the way of all.
void add_obstacles(const std::vector<ReportDip>& dips, std::vector<Finding>& list) {
  for (std::size_t k = 0; k < dips.size(); ++k)
    if (const auto& obstacle = dips[k].obstacle)
      list.push_back({"dip", obstacle->forbids ? Concern::kStop : Concern::kCare,
                      fmt::format("Dip {}", k + 1), obstacle->what, obstacle->text,
                      obstacle->advice});
}

// Rounded before it is written: -0.3 is not "-0".
std::string place(const Vec3& p) {
  const auto whole = [](double value) { return std::round(value) + 0.0; };
  return fmt::format("({:.0f}, {:.0f}, {:.0f}) mm of the posed object", whole(p.x()), whole(p.y()),
                     whole(p.z()));
}

// Pressed together, or lifted out of the water on the way: only where there is any worth naming.
void add_slack_film(const Coverage& c, std::vector<Finding>& list) {
  if (c.wrinkled_mm2 > kFewWrinkles * c.covered_mm2)
    list.push_back({"wrinkles", Concern::kCare, "Wrinkles",
                    percent(Coverage::share(c.wrinkled_mm2, c.covered_mm2)),
                    "of the film on the object is pressed together and wrinkles.",
                    "Let the object come down straighter there, or roll it less "
                    "(material.wrinkle_stretch says what the film bears)."});
  if (c.lifted_mm2 > 0)
    list.push_back(
        {"lifted", Concern::kCare, "Lifted out", fmt::format("{:.0f} mm2", c.lifted_mm2),
         fmt::format("of film comes out of the water again on the way, around {}; it may peel off "
                     "or drain there.",
                     place(c.lifted_at)),
         "Turn the object about an edge that is outside of the water line, or lower it while it "
         "turns."});
}

std::string let_out(const AirPocket& pocket) {
  if (pocket.lets_out)
    return fmt::format(
        "Tilt the object by {:.0f} degrees (dip.tilt_deg={:.0f}, dip.tilt_toward_deg={:.0f}), or "
        "drill a vent at its highest point.",
        pocket.lets_out->tilt_deg, pocket.lets_out->tilt_deg, pocket.lets_out->toward_deg);
  return "Drill a vent at its highest point, or turn another side down (--rotate, --down).";
}

void add_air(const TrappedAir& air, const Coverage& c, std::vector<Finding>& list) {
  if (air.area_mm2() > 0) {
    const AirPocket& pocket = air.pockets.front();
    const bool much = air.area_mm2() > kMuchAir * c.object_mm2;
    std::string text = fmt::format("of the surface stays dry: {} ml of air cannot get out",
                                   plain_number(air.volume_mm3() / 1000));
    text += air.pockets.size() == 1 ? fmt::format(" from below {}.", place(pocket.top))
                                    : fmt::format(" of {} hollows; the largest reaches up to {}.",
                                                  air.pockets.size(), place(pocket.top));
    std::string advice = let_out(pocket);
    if (pocket.escapes_share > kSomeEscapes)
      advice += fmt::format(" {} of it gets out as the object turns on, under film that may burst.",
                            percent(pocket.escapes_share));
    list.push_back({"air", much ? Concern::kStop : Concern::kCare, "Trapped air",
                    fmt::format("{:.0f} mm2", air.area_mm2()), std::move(text), std::move(advice)});
  }
  if (!air.vents.empty())
    list.push_back(
        {"vent", Concern::kCare, "Vent", fmt::format("{:.1f} mm", air.vents.front().width_mm),
         fmt::format("wide hole in the surface at {} lets air out: if the real object has none "
                     "there, {:.0f} mm2 stay dry.",
                     place(air.vents.front().at), air.vents.front().area_mm2),
         "Close the hole in the model if it is not real."});
}

Finding stretch(const Coverage& c, double tear_stretch) {
  Finding finding{
      "stretch", Concern::kNone, "Largest stretch", fmt::format("{:.2f} times", c.stretch_max), "",
      ""};
  finding.text = fmt::format("The area grows up to {:.2f} times, {:.2f} on average.",
                             c.area_ratio_max, c.area_ratio_mean);
  const bool beyond = tear_stretch > 0 && c.stretch_max > tear_stretch;
  if (beyond)
    finding.text += fmt::format(
        " A little of it is stretched beyond the {:.2f} that this film bears, and may tear.",
        tear_stretch);
  else if (tear_stretch > 0)
    finding.text += fmt::format(" This film bears {:.2f}.", tear_stretch);
  const bool near_limit = tear_stretch > 0 && c.stretch_max > kNearLimit * tear_stretch;
  if (c.stretch_max > kMostStretch) {
    finding.concern = Concern::kStop;
    finding.text += fmt::format(" No film bears more than {:g}.", kMostStretch);
    finding.advice =
        "Turn steep sides and deep recesses away (--rotate, --down), dip less deep (--depth), and "
        "let the film tear (material.tear_stretch), so that the rest can be told.";
    return finding;
  }
  if (near_limit) {
    finding.concern = Concern::kCare;
    finding.advice =
        "Near its limit the film may tear: spray a little less activator, and lower "
        "slowly and steadily.";
  }
  if (c.area_ratio_max > kPale) {
    finding.concern = Concern::kCare;
    finding.advice += std::string(finding.advice.empty() ? "" : " ") +
                      "Colours thin out where it stretches: expect them paler there.";
  }
  return finding;
}

Finding steepness(const DipAngles& angles) {
  const double share = angles.over_limit_share();
  Finding finding{"steepness",
                  share > kMuchSteep ? Concern::kCare : Concern::kNone,
                  "Steep sides",
                  percent(share),
                  "",
                  ""};
  finding.text = fmt::format("of the surface that faces down is steeper than {:.0f} degrees.",
                             kDipAngleLimit_deg);
  if (share > kMuchSteep)
    finding.advice =
        "Film stretches most and comes off most easily there: turn the object so that little of "
        "what matters is steep.";
  return finding;
}

// Where torn film is lost, the rest may still be known; where it is not, nothing is promised.
void add_doubtful(const Coverage& c, const std::optional<ReportWanted>& wanted,
                  std::vector<Finding>& list) {
  if (!(c.doubtful_mm2 > 0)) return;
  Finding finding{"doubtful",
                  Concern::kNone,
                  "Doubtful",
                  percent(c.doubtful_share()),
                  "of the object gets film that may tear after all, or whose place depends on how "
                  "torn film falls.",
                  ""};
  if (wanted && wanted->covered_mm2 > 0)
    finding.text += wanted->doubtful_mm2 > 0
                        ? fmt::format(" Of what shall be printed and gets film it is {}.",
                                      percent(wanted->doubtful_share()))
                        : " Nothing of what shall be printed lies there.";
  if ((wanted ? wanted->doubtful_share() : Coverage::share(c.doubtful_mm2, c.covered_mm2)) >
      kLittleDoubt) {
    finding.concern = Concern::kCare;
    finding.advice =
        "Let nothing that matters lie there. How much your film bears a test dip tells "
        "(material.safe_stretch, material.tear_stretch, material.lost_stretch).";
  }
  list.push_back(std::move(finding));
}

Finding equilibrium(const ReportEquilibrium& e) {
  return {"equilibrium",
          Concern::kStop,
          "Not computed",
          fmt::format("{} of {} steps", e.unconverged_steps, e.steps),
          fmt::format("found no equilibrium of the film: its place is known to {} mm only.",
                      plain_number(e.residual_mm)),
          "Turn steep sides and deep recesses away, dip less deep, or let the film tear "
          "(material.tear_stretch)."};
}

// How far colours land off at worst.
double off_mm(const Coverage& c, const ReportEquilibrium& e) {
  return kUsualMiss_mm * std::max(1.0, c.stretch_max) + e.unknown_mm();
}

Finding registration(const Report& report) {
  const Coverage& c = *report.coverage;
  const double bleed_mm = report.bleed_mm;
  const double off = off_mm(c, report.equilibrium);
  Finding finding{
      "registration", Concern::kNone, "Registration", fmt::format("{:.1f} mm", off), "", ""};
  finding.text = fmt::format(
      "is how far colours land off, at worst, when the object meets the film {:.0f} mm off its "
      "place, which is usual by hand.",
      kUsualMiss_mm);
  if (off > kFarOff_mm) {
    finding.concern = Concern::kStop;
    finding.advice = fmt::format(
        "A picture that is more than {:.0f} mm off is not where it belongs: turn steep sides away "
        "or dip less deep.",
        kFarOff_mm);
    return finding;
  }
  finding.advice =
      "Hang the object over the centre ticks of the sheet, turned as the marks say, and come "
      "straight down.";
  if (bleed_mm > 0)
    finding.advice +=
        fmt::format(" The bleed of {:.1f} mm keeps edges from showing bare.", bleed_mm);
  return finding;
}

Finding ink(const ReportInk& ink) {
  Finding finding{
      "ink", Concern::kNone, "Heaviest ink", fmt::format("{:.0f} %", 100 * ink.density_max), "",
      ""};
  finding.text = fmt::format(
      "is the largest sum of cyan, magenta, yellow and black. Over the sheet they come to {:.2f}, "
      "{:.2f}, {:.2f} and {:.2f} %.",
      100 * ink.mean[0], 100 * ink.mean[1], 100 * ink.mean[2], 100 * ink.mean[3]);
  if (!(ink.density_limit > 0)) {
    finding.advice = "Compare it with what your printer and film bear.";
  } else if (ink.density_max > ink.density_limit + 1e-6) {
    finding.concern = Concern::kCare;
    finding.advice =
        fmt::format("The limit is {:.0f} %: more ink than that runs. Print with an ink limit.",
                    100 * ink.density_limit);
  } else {
    finding.text += fmt::format(" The limit is {:.0f} %.", 100 * ink.density_limit);
  }
  return finding;
}

Finding colors(const ReportColors& colors) {
  const auto difference = [](double value) {
    return value > 0 && value < 0.05 ? std::string("under 0.1") : fmt::format("{:.1f}", value);
  };
  const bool plain = colors.error_most_of > kPlainDifference;
  Finding finding{"colors",
                  plain ? Concern::kCare : Concern::kNone,
                  "Colour error",
                  difference(colors.error_mean),
                  "",
                  ""};
  finding.text = fmt::format(
      "on average where film lies (CIEDE2000; 1 is just visible); on 95 % of it no more than {}.",
      colors.error_most_of < 0.05 ? "0.1" : difference(colors.error_most_of));
  if (plain) finding.advice = "Where it is above 5 the difference is plain to see.";
  return finding;
}

// A number among the report's figures.
std::optional<double> figure(const Report& report, const std::string& key) {
  for (const ReportFigure& f : report.figures) {
    if (f.key == key && std::holds_alternative<double>(f.value)) return std::get<double>(f.value);
  }
  return std::nullopt;
}

Finding gamut(double share) {
  Finding finding{"gamut",
                  share > kMuchOutOfGamut ? Concern::kCare : Concern::kNone,
                  "Out of gamut",
                  percent(share),
                  "of the covered surface has colours that the inks cannot give there.",
                  ""};
  if (share > kMuchOutOfGamut)
    finding.advice = "The nearest ones are printed; gamut.policy chooses how.";
  return finding;
}

Finding coverage_of_dips(const Report& report) {
  const Coverage& c = *report.coverage;
  const std::optional<ReportWanted>& wanted = report.wanted;
  const std::size_t dips = report.dips.size();
  const bool more = more_dips_may_help(report);
  if (wanted) {
    Finding finding = coverage_of_wanted(*wanted, c, "");
    finding.text = fmt::format("of what shall be printed gets film that holds {}{}.",
                               after_dips(dips), only_perhaps(wanted));
    if (!finding.advice.empty())
      finding.advice = more
                           ? "Plan more dips (--dips): 'hydrodip plan' says how much each one adds."
                           : "Hold the object another way: 'hydrodip plan' looks for ways.";
    return finding;
  }
  const bool nearly_all = c.covered_share() >= kNearlyAll;
  Finding finding{"coverage",
                  nearly_all ? Concern::kNone : Concern::kCare,
                  "Coverage",
                  percent(c.covered_share()),
                  fmt::format("of the object is under film {}.", after_dips(dips)),
                  ""};
  if (!nearly_all)
    finding.advice = fmt::format(
        "What stays bare shows the object's own colour: {}paint the object to match "
        "(object.base_color).",
        more ? "plan more dips (--dips), or " : "");
  return finding;
}

Finding seams(const ReportSeams& s) {
  const bool plain = s.error_mean > kPlainDifference;
  return {
      "seams",
      plain ? Concern::kCare : Concern::kNone,
      "Seams",
      fmt::format("{:.0f} mm", s.length_mm),
      fmt::format("long together, where two dips fade into each other over {:g} mm. Their "
                  "colour error is {:.1f} on average (CIEDE2000), and {:.1f} if each later dip "
                  "lands {:g} mm off.",
                  s.overlap_mm, s.error_mean, s.error_mean_off, s.off_mm),
      "Let each coat dry before the next dip, and hang the object by the run sheet of that dip."};
}

Finding warning(const std::string& sentence) {
  return {"warning", Concern::kCare, "Note", "", sentence, ""};
}

}  // namespace

bool more_dips_may_help(const Report& report) {
  return report.dips.size() < std::size_t(kMostDips) &&
         std::none_of(report.dips.begin(), report.dips.end(),
                      [](const ReportDip& dip) { return is_idle(dip) || is_hardly_worth_it(dip); });
}

std::string beyond_best_dip(const Report& report) {
  if (!report.found_best) return "";
  const std::string dips = report.one_dip_only ? "" : "give the rest other dips (--dips 2)";
  const std::string picture =
      report.has_artwork ? "make the picture smaller (--art-size) or put it elsewhere (--art-at)"
                         : "";
  return fmt::format(
      "This is the best single dip that was found: {}{}{}.", dips,
      dips.empty() || picture.empty() ? "" : ", or ",
      dips.empty() && picture.empty() ? "make the object smaller (--size)" : picture);
}

std::vector<Finding> findings(const Report& report) {
  std::vector<Finding> list;
  if (report.coverage) {
    const Coverage& c = *report.coverage;
    const bool several = !report.dips.empty() && c.film_on_object_mm2 > 0;
    list.push_back(several ? coverage_of_dips(report) : coverage(report));
    if (!report.better_way.empty())
      list.push_back({"better_way", Concern::kNone, "Better", "", report.better_way + ".", ""});
    add_idle_dips(report.dips, list);
    add_poor_dips(report, list);
    add_obstacles(report.dips, list);
    if (report.seams && report.seams->length_mm > 0) list.push_back(seams(*report.seams));
    if (c.film_on_object_mm2 > 0) {
      list.push_back(is_of_several(report) ? tears_of_several(report) : tears(report));
      add_doubtful(c, report.wanted, list);
      list.push_back(stretch(c, report.tear_stretch));
      add_slack_film(c, list);
      // Each of several tells its own.
      if (report.air && report.dips.size() < 2) add_air(*report.air, c, list);
      if (report.angles) list.push_back(steepness(*report.angles));
      list.push_back(registration(report));
    }
    if (report.equilibrium.unconverged_steps > 0) list.push_back(equilibrium(report.equilibrium));
  }
  if (report.ink) list.push_back(ink(*report.ink));
  if (report.colors) list.push_back(colors(*report.colors));
  if (const auto share = figure(report, "out_of_gamut_share")) list.push_back(gamut(*share));
  for (const std::string& sentence : report.warnings) {
    if (!sentence.empty()) list.push_back(warning(sentence));
  }
  return list;
}

const Finding* first_obstacle(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings)
    if (finding.concern == Concern::kStop && finding.key != "tears" && finding.key != "stretch" &&
        finding.key != "coverage")
      return &finding;
  return nullptr;
}

Concern concern_of(const std::vector<Finding>& findings) {
  Concern gravest = Concern::kNone;
  for (const Finding& finding : findings) gravest = std::max(gravest, finding.concern);
  return gravest;
}

std::string headline(Concern concern) {
  if (concern == Concern::kNone) return "Good to dip";
  return concern == Concern::kCare ? "Can be dipped; mind a few things" : "Do not dip it like this";
}

std::string concern_name(Concern concern) {
  if (concern == Concern::kNone) return "none";
  return concern == Concern::kCare ? "care" : "stop";
}

}  // namespace hydrodip
