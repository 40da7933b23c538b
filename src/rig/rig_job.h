// A finished job, read back from its folder, as far as the bench needs it.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "dip/way_point.h"
#include "settings/activator.h"
#include "settings/config.h"
#include "settings/settings.h"

namespace hydrodip {

// What one dip takes by its print.
struct SheetUse {
  double film_m2 = 0;  // its whole sheet
  double ink_coverage =
      0;  // what full coverage of each ink would take, as a part of it; 0: unknown
  bool first_of_piece = true;  // false: of several dips, not the first of its piece
};

struct RigJob {
  std::filesystem::path folder;
  std::string title;
  JobConfig config;     // the job's own parameters, then profile, configuration and --set of today
  double depth_mm = 0;  // of its deepest point
  std::vector<WayPoint> way_in;        // from the first touch on; empty: straight down
  Vec3 object_size_mm = Vec3::Zero();  // as posed
  std::string model_sha256;            // of config.model, when it was printed
  std::string correction_sha256;       // of config.correction, then; empty: none, or not known
  std::vector<std::filesystem::path> settings_files;  // that it was printed by, later ones win
  bool has_artwork = false;                           // of which config knows nothing
  std::vector<std::string> warnings;
  // "Do not dip it like this: ...", or that it is a draft; empty: nothing forbids it.
  std::string alarm;
  std::string report_sha256;
  SheetUse sheet;            // as printed
  std::string batch, label;  // of the piece that is dipped; may be empty
  int earlier_dips = 0;      // of several dips: those that are done before
  int next_dip = 0;          // of several dips: the one that follows; 0: none
};

// Reads FOLDER/report.json of a print or simulate job. Throws InputError if it is none.
RigJob load_rig_job(const std::filesystem::path& folder, const SettingSources& sources);

// The same of a report.json's text. Nothing if it is none of a dip.
std::optional<SheetUse> sheet_use(const std::string& report);

// Throws InputError if config.model is not there. Paths of a print are relative to where it ran;
// load_rig_job looks for them there, if that is here or a folder above the job's.
void require_model(const RigJob& job);

// Where the object hangs as it first touches the water: in the bath, from the posed-object frame.
Eigen::Isometry3d hanging_pose(const RigJob& job);
// With one digit, never as -0.0.
std::string tenths(double value);
// How that differs from the pose, in words: "turned by 0.0, 20.0 and 0.0 degrees ..."; empty: not.
std::string hung_otherwise(const RigJob& job);

// Whether the object shifts or turns while it comes down, so that lowering it is not enough.
bool moves_aside(const RigJob& job);
// Throws InputError if it does.
void require_lowering_only(const RigJob& job);

// What the process facts mean for this job's film.
Activator activator_for(const JobConfig& config);
double bath_litres(const BathOptions& bath);
double tape_mm(const JobConfig& config);  // of the sheet's edge, all around
// "Tape 3 mm around all four edges": what is to be done with them.
std::string taping(const JobConfig& config);
double ruler_mm(const JobConfig& config);  // of the ruler in the sheet's margin; 0: it has none

// The stage position at which the object's lowest point meets the water: stage.water_mm, else what
// was found last and saved in the folder.
std::optional<double> known_water_level_mm(const RigJob& job);
void save_water_level(const RigJob& job, double position_mm);

// How far the object travels in the water: at process.speed_mm_per_min.
double in_water_mm(const RigJob& job);

// One movement of the dip. Heights: of the object's lowest point over the water, mm.
struct PlannedMove {
  std::string phase;
  double from_height_mm = 0, to_height_mm = 0;
  double mm_per_min = 0;  // 0: it stands still
  double seconds = 0;
};
// Approach, dip, dwell, retract.
std::vector<PlannedMove> plan_dip(const RigJob& job);
// The stage position of a height.
double stage_position_mm(const StageOptions& stage, double water_mm, double height_mm);

// The plan as a table; with stage positions where the water level is known.
std::string describe_plan(const RigJob& job, std::optional<double> water_mm);

}  // namespace hydrodip
