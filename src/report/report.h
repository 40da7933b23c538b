// report.json and report.html: everything that is known about a finished job, for programs and for
// people. Fill a Report, then write it; what is left at its default is left out where it would
// say nothing.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "air/air.h"
#include "dip/way_point.h"
#include "object/dip_angles.h"
#include "object/health.h"
#include "transfer/coverage.h"

namespace hydrodip {

// Raised when a key changes its meaning or goes away; new keys alone do not raise it.
inline constexpr int kReportSchemaVersion = 1;

struct ReportInput {
  std::string role;  // "model", "texture", "settings", "path", "film image", "correction"
  std::string path;  // as given
  std::string sha256;
  std::uint64_t bytes = 0;
};

// Reads the file. Throws InputError if it cannot be read.
ReportInput describe_input(const std::string& role, const std::filesystem::path& path);

using ReportValue = std::variant<double, std::int64_t, bool, std::string, std::array<double, 3>>;

struct ReportParameter {
  std::string name;
  std::string unit;  // "" for none
  ReportValue value;
  bool changed = false;  // differs from the default: shown first on the page
};

struct ReportStage {
  std::string name;  // "dip"
  double seconds = 0;
};

// A figure beyond the fixed ones, as name_with_unit: e.g. {"immersion_depth_mm", "Immersion", 42.5,
// "mm"}.
struct ReportFigure {
  std::string key;    // in report.json; unit in the name
  std::string label;  // on the page
  ReportValue value;
  std::string unit;
};

// One round of an iteration that has to converge, with whatever measures it.
struct ReportRound {
  std::string process;  // "dip", "ink"
  int round = 0;
  std::vector<ReportFigure> figures;
};

struct ReportOutput {
  std::string name;         // "print.pdf"
  std::string description;  // "the sheet: print it at 100 %, ink side up"
};

// Ink densities: sums of c, m, y, k, each up to 1.
struct ReportInk {
  double density_max = 0;
  double density_limit = 0;  // 0: none is set
  // Cyan, magenta, yellow, black: mean over the sheet, without the marks in its margin.
  std::array<double, 4> mean{};
};

// CIEDE2000 between wanted and predicted colour, over the covered surface.
struct ReportColors {
  double error_mean = 0;
  double error_most_of = 0;  // 95 % of the surface has no more
};

// Where something shall be printed, if that is not everywhere: of the object's surface.
struct ReportWanted {
  double object_mm2 = 0;
  double reached_mm2 = 0;  // of it: comes into the water and faces down
  double covered_mm2 = 0;  // of it: gets whole film
  // Of that: film that may tear after all, or lie elsewhere; see Coverage::doubtful_mm2.
  double doubtful_mm2 = 0;
  // A place where something shall be printed.
  void add(double mm2, bool reached, bool covered, bool doubtful) {
    object_mm2 += mm2;
    reached_mm2 += reached ? mm2 : 0;
    covered_mm2 += covered ? mm2 : 0;
    doubtful_mm2 += doubtful ? mm2 : 0;
  }
  double doubtful_share() const { return Coverage::share(doubtful_mm2, covered_mm2); }
  double covered_share() const { return Coverage::share(covered_mm2, object_mm2); }
  double missed_share() const { return Coverage::share(reached_mm2 - covered_mm2, reached_mm2); }
};

// Why a dip is not to be made, or what to mind of it, whatever others bring: what, in words, and
// how to mend it.
struct ReportObstacle {
  std::string what, text, advice;  // "Trapped air: 242 mm2", "of the surface stays dry..."
  bool forbids = true;
};

// One of several dips, in the order in which they are made. Shares of the object's whole surface.
struct ReportDip {
  std::string down;  // "-z"
  std::array<double, 3> rotate_deg{};
  double depth_mm = 0;
  std::string hold;          // in words
  std::string folder;        // of its sheet: "dip-1"
  double part_share = 0;     // printed by this dip
  double gained_share = 0;   // covered by it and none before
  double covered_share = 0;  // under film after this dip
  double torn_share = 0;     // of its film that meets the object
  std::optional<ReportObstacle> obstacle;
  // Like gained_share, of what shall be printed, if that is not everywhere.
  std::optional<double> gained_wanted_share;
  bool blank = false;          // its sheet has no ink
  std::vector<Keyframe> path;  // its way in; empty: straight down
};

// Where several dips meet.
struct ReportSeams {
  double length_mm = 0;  // 0: no two films meet
  double overlap_mm = 0;
  double error_mean = 0;      // CIEDE2000 there
  double off_mm = 0;          // if every later dip lands that far off:
  double error_mean_off = 0;  // CIEDE2000 there, in the mean of four directions
};

// How well the film's equilibrium is known; defaults: as well as is ever needed.
struct ReportEquilibrium {
  long steps = 0, unconverged_steps = 0;  // of the dip that is printed for
  double residual_mm = 0;                 // the furthest that film still moved in one of the latter
  double unsettled_mm = 0;                // what ink that has not settled still moves it
  double unknown_mm() const { return unsettled_mm + (unconverged_steps > 0 ? residual_mm : 0); }
};

struct Report {
  std::string tool_version;
  std::string command;                    // "print"
  std::vector<std::string> command_line;  // may be empty
  std::string title;                      // the job's name; empty: the first input's file name
  bool for_customer = false;              // whose page it is; see report_html()
  bool draft = false;                     // coarse: not to be dipped through

  std::vector<ReportInput> inputs;
  std::vector<ReportParameter> parameters;
  std::vector<ReportStage> stages;  // in the order they ran
  double total_seconds = 0;         // 0: the sum of the stages
  std::vector<ReportRound> rounds;
  std::vector<WayPoint> way_in;        // empty: straight down
  std::optional<Coverage> coverage;    // nothing was dipped: absent
  std::optional<ReportWanted> wanted;  // absent: unknown, or all of the surface
  ReportEquilibrium equilibrium;
  // Likewise; of several dips that of all, each in its own pose.
  std::shared_ptr<const TrappedAir> air;
  std::optional<DipAngles> angles;
  std::optional<MeshHealth> mesh;
  std::optional<ReportInk> ink;
  std::optional<ReportColors> colors;
  int dip_number = 0, dip_of = 0;  // of one among several dips; 0: it is the only one
  std::vector<ReportDip> dips;     // several; `coverage` is then that of all together
  // Of several dips: like `wanted`, of the whole surface, whatever shall be printed on it.
  std::optional<ReportWanted> together;
  std::optional<ReportSeams> seams;
  std::string better_way;   // how else to dip it; empty: unknown, or there is none
  double tear_stretch = 0;  // the film's limit; 0: it never tears
  double bleed_mm = 0;
  bool finished_image = false;  // is printed as it is, wherever film holds or not
  bool one_dip_only = false;    // what lies on the film belongs to one
  bool found_best = false;      // the best way to hold it was looked for, and this is it
  bool has_artwork = false;
  std::vector<ReportFigure> figures;
  std::vector<std::string> warnings;
  std::vector<ReportOutput> outputs;
  std::uint64_t peak_memory_bytes = 0;  // 0: unknown
};

// As its sheet has it; empty without name and inputs.
std::string title_of(const Report& report);

// Of what comes to the film, of several dips to that of any, and shall be printed: what gets no
// film that holds. Nothing where that is not known.
std::optional<double> missed_share(const Report& report);

// ", 57 % of it only perhaps": how much of what shall be printed and gets film is doubtful; empty
// where that is little.
std::string only_perhaps(const std::optional<ReportWanted>& wanted);

// Whether that is why no film stays on the object.
bool is_inside_out(const Report& report);

// Where no film stays on the object: why, and how to mend it. `inside_out`: as MeshHealth's.
std::string no_film_verdict(const Coverage& coverage, bool inside_out);

// Some words of it, for a caption or a band: what forbids the dip besides the film, if anything
// does, and what becomes of the film. Of a report that has its coverage.
std::string short_verdict(const Report& report);

// A plain sentence or two: how much is covered, how far the film
// stretches, whether it tears, and, if it is not to be dipped like this, why not.
std::string verdict_of(const Report& report);

// JSON in UTF-8, keys always in the same order, areas in mm2 and lengths in mm; what is not a
// number is null. "seconds" and "peak_memory_bytes" alone depend on the machine.
std::string report_json(const Report& report);

// Dip angles as the JSON object that reports hold.
std::string dip_angles_json(const DipAngles& angles);

// What the page shows besides words.
struct ReportPictures {
  std::vector<std::uint8_t> preview_png;  // the files' bytes; empty: none
  std::vector<std::uint8_t> maps_png;
  std::string scene = {};                   // scene_json() for the 3D view; empty: none
  std::vector<std::uint8_t> dips_png = {};  // of several dips
  std::vector<std::uint8_t> logo_png = {};  // above all
};

// One self-contained page that needs no network; every text is escaped. Words and pictures come
// without scripts, so that they can be read anywhere and printed; where scripts and WebGL work, the
// 3D view takes the place of the preview picture. A customer's page says what comes out, in plain
// words: no commands, paths, parameters or times.
std::string report_html(const Report& report, const ReportPictures& pictures);

void write_report_json(const std::filesystem::path& path, const Report& report);
void write_report_html(const std::filesystem::path& path, const Report& report,
                       const ReportPictures& pictures);

}  // namespace hydrodip
