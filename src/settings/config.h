// What a job's parameters say, as the options of the rooms that it goes through. Filled from
// parameter records (settings/params.h) or by hand. Only pipelines see all of it: whoever does the
// work takes its own options.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artwork/layer.h"
#include "base/output_folder.h"
#include "coat/design.h"
#include "ink/printer.h"
#include "model_io/load.h"
#include "object/pose.h"
#include "plan/fit.h"

namespace hydrodip {

struct ObjectOptions {
  LoadOptions load;  // units, texture
  // A model in memory, in millimetres, instead of a file; null: the file.
  std::shared_ptr<const LoadedObject> given = {};
  PoseOptions pose;                   // size, down, rotation
  LinearColor base{1, 1, 1, 1};       // of the bare object
  std::vector<ArtworkLayer> artwork;  // over the model's own colours, the bottom layer first
};

enum class InkSide { kUp, kDown };

// The sheet's page.
struct PrintOptions {
  InkSide ink_side = InkSide::kUp;
  std::string job_name;      // in the sheet's margin; empty: the model's file name
  bool camera_marks = true;  // in the margin, where there is room
  bool outlines = false;     // where the water cuts the object, as thin lines
  // What the printer makes of a millimetre, and of a right angle between x and y.
  double scale_x = 1, scale_y = 1;
  double skew_deg = 0;
};

// What the operator keeps to at the bath; the paper's section 2 and appendix A.
struct ProcessOptions {
  double water_min_c = 27, water_max_c = 30;
  double soak_min_s = 60, soak_max_s = 80;  // from laying the film until it lies flat again
  double activator_g = 3.5;                 // per letter sheet
  double activator_tolerance_g = 0.5;       // per letter sheet
  double activator_wait_s = 30;
  double speed_mm_per_min = 100;  // of the dip
  double dwell_s = 10;            // at depth, at least
  double lift_mm_per_min = 300;
  double dry_min_h = 2, dry_max_h = 3;
};

// What things cost, to add up what a piece does. Prices in a currency of the person's own.
struct CostOptions {
  std::string currency;
  double film_per_m2 = 0;
  double ink_per_ml = 0;
  double ink_ml_per_m2 = 10;  // that full coverage of one ink takes; printers differ
  double activator_per_g = 0;
  double per_piece = 0;  // the bare part, coats, labour
};

enum class StageDriver { kZaber, kMarlin };
enum class StageDown { kPlus, kMinus };

// The linear stage that carries the object. Positions count as the stage counts them, from home.
// The defaults are the paper's: Zaber A-LST0750B-E01, 750 mm, 6.35 mm of travel per turn of 12800
// microsteps.
struct StageOptions {
  StageDriver driver = StageDriver::kZaber;
  std::string port;  // "/dev/ttyUSB0"
  int baud = 115200;
  int address = 1;  // in a chain of Zaber devices
  double microstep_um = 0.49609375;
  double travel_mm = 750;             // 0: not checked
  StageDown down = StageDown::kPlus;  // which way the object goes down
  double lowest_mm = 0;      // position beyond which it never goes down; 0: the stage's own limit
  double water_mm = 0;       // position where the object's lowest point meets the water; 0: unknown
  double clearance_mm = 40;  // between object and water while people work
  double approach_mm = 5;    // above the water, where the dip's constant speed begins
  double travel_mm_per_min = 600;  // where no water is near
};

// One of several parts that share a sheet, as a [[part]] table gives it.
struct PartEntry {
  std::filesystem::path job;  // a model, or a job's file
  int count = 1;
};

// One of several dips, as a job's [[dip]] table gives it. What is not given is looked for.
struct DipEntry {
  std::optional<ModelSide> down;
  std::optional<Vec3> rotate_deg;
  bool find_rotation = false;  // rotate_deg = "auto", whatever `down` says
  std::optional<double> depth_mm;
  std::vector<Keyframe> path;        // the way in; empty: straight down
  bool locked = false;               // planning leaves it as it is
  std::filesystem::path correction;  // what dips of it told; empty: nothing
};

// What is looked for, and how several dips share the object.
struct PlanOptions {
  bool find_pose = false;   // object.rotate_deg = auto
  bool find_depth = false;  // dip.depth_mm = auto
  bool found_pose = false;  // was left to be found, and is; likewise:
  bool found_depth = false;
  int dips = 0;                      // how many to plan; 0: as many as the job names, or one
  double overlap_mm = 2;             // how wide neighbouring dips fade into each other
  std::filesystem::path importance;  // a picture of what matters; empty: the paint says it
  bool suggest = true;               // look for a better way where one should not dip like this
};

// Whose page report.html is.
struct ReportOptions {
  bool for_customer = false;   // who ordered the piece: what comes out, in plain words
  std::filesystem::path logo;  // a picture above it; empty: none
};

struct JobConfig {
  std::filesystem::path model;
  std::filesystem::path film_image;  // simulate: the image that was printed; may be empty
  std::filesystem::path output;      // folder
  EarlierResult earlier_result = EarlierResult::kReplaced;  // in that folder
  // For the report only.
  std::vector<std::filesystem::path> settings_files;  // profiles and configs that were read
  std::vector<std::string> command_line;

  ObjectOptions object;
  BathOptions bath;
  DesignOptions design;  // film, dip, ink
  PrinterOptions printer;
  PrintOptions print;
  std::filesystem::path correction;  // that design.film.correction was read from; may be empty
  ProcessOptions process;
  CostOptions cost;
  StageOptions stage;
  std::vector<PartEntry> parts;
  PlanOptions plan;
  ReportOptions report;
  std::vector<DipEntry> dips;  // none: one dip, by object, film and design
  std::string up;              // of the model as it stands, "+z"; empty: as its format has it
  int preview_width_px = 1600;
  int preview_texture_px = 2048;
  bool pictures = true;  // preview.png, maps.png, gamut.png and the 3D view of report.html
  int threads = 0;       // 0: all cores
};

}  // namespace hydrodip
