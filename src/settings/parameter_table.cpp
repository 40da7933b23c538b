// The parameter tables, one per options struct. A new parameter is one line here.
#include <fmt/format.h>

#include <utility>

#include "settings/dip_tables.h"
#include "settings/hex_color.h"
#include "settings/params.h"
#include "settings/path_file.h"

namespace hydrodip {
namespace {

// How a record reaches its member: a stateless function from the config to the member.
template <class Member>
using Access = Member& (*)(JobConfig&);

template <class Member>
const Member& read(Access<Member> access, const JobConfig& config) {
  return access(const_cast<JobConfig&>(config));  // access only forms a reference
}

Parameter number(std::string name, std::string unit, double min, double max, Access<double> access,
                 std::string help, std::string zero = "") {
  Parameter p{std::move(name),
              std::move(unit),
              ParameterType::kNumber,
              min,
              max,
              std::move(zero),
              "",
              {},
              std::move(help),
              {},
              {}};
  p.get = [access](const JobConfig& c) { return ParameterValue(read(access, c)); };
  p.set = [access](JobConfig& c, const ParameterValue& v) { access(c) = std::get<double>(v); };
  return p;
}

Parameter integer(std::string name, std::string unit, int min, int max, Access<int> access,
                  std::string help, std::string zero = "") {
  Parameter p{std::move(name),
              std::move(unit),
              ParameterType::kInteger,
              double(min),
              double(max),
              std::move(zero),
              "",
              {},
              std::move(help),
              {},
              {}};
  p.get = [access](const JobConfig& c) { return ParameterValue(double(read(access, c))); };
  p.set = [access](JobConfig& c, const ParameterValue& v) { access(c) = int(std::get<double>(v)); };
  return p;
}

Parameter text(std::string name, ParameterType type, Access<std::string> access, std::string help) {
  Parameter p{std::move(name), "", type, 0, 0, "", "", {}, std::move(help), {}, {}};
  p.get = [access](const JobConfig& c) { return ParameterValue(read(access, c)); };
  p.set = [access](JobConfig& c, const ParameterValue& v) { access(c) = std::get<std::string>(v); };
  return p;
}

// Inside linear light.
Parameter color(std::string name, Access<LinearColor> access, std::string help) {
  Parameter p{
      std::move(name), "", ParameterType::kColor, 0, 0, "", "", {}, std::move(help), {}, {}};
  p.get = [access](const JobConfig& c) { return ParameterValue(hex_of(read(access, c))); };
  p.set = [access](JobConfig& c, const ParameterValue& v) {
    access(c) = parse_color(std::get<std::string>(v)).value();
  };
  return p;
}

Parameter path(std::string name, Access<std::filesystem::path> access, std::string help) {
  Parameter p{std::move(name), "", ParameterType::kPath, 0, 0, "", "", {}, std::move(help), {}, {}};
  p.get = [access](const JobConfig& c) { return ParameterValue(read(access, c).string()); };
  p.set = [access](JobConfig& c, const ParameterValue& v) { access(c) = std::get<std::string>(v); };
  return p;
}

Parameter vector(std::string name, std::string unit, double min, double max, Access<Vec3> access,
                 std::string help) {
  Parameter p{std::move(name),
              std::move(unit),
              ParameterType::kVector,
              min,
              max,
              "",
              "",
              {},
              std::move(help),
              {},
              {}};
  p.get = [access](const JobConfig& c) {
    const Vec3& v = read(access, c);
    return ParameterValue(std::array<double, 3>{v.x(), v.y(), v.z()});
  };
  p.set = [access](JobConfig& c, const ParameterValue& v) {
    const auto& xyz = std::get<std::array<double, 3>>(v);
    access(c) = Vec3(xyz[0], xyz[1], xyz[2]);
  };
  return p;
}

Parameter way_in(std::string name, Access<std::vector<Keyframe>> access, std::string help) {
  Parameter p{
      std::move(name), "", ParameterType::kWayIn, 0, 0, "", "", {}, std::move(help), {}, {}};
  p.get = [access](const JobConfig& c) { return ParameterValue(rows_of(read(access, c))); };
  p.set = [access](JobConfig& c, const ParameterValue& v) {
    const auto& rows = std::get<std::string>(v);
    access(c) = rows.empty() ? std::vector<Keyframe>() : path_of_rows(rows, "path");
  };
  return p;
}

// The same parameter, for which "auto" may stand: then `flag` is set, and the value looked for.
Parameter or_auto(Parameter p, Access<bool> flag) {
  p.word = "auto";
  p.get = [flag, get = p.get](const JobConfig& c) {
    return read(flag, c) ? ParameterValue(std::string("auto")) : get(c);
  };
  p.set = [flag, set = p.set](JobConfig& c, const ParameterValue& v) {
    flag(c) = std::holds_alternative<std::string>(v);
    if (!flag(c)) set(c, v);
  };
  return p;
}

// The choices are the enumerators' names in order.
template <class Enum>
Parameter choice(std::string name, std::vector<std::pair<std::string, Enum>> values,
                 Access<Enum> access, std::string help) {
  Parameter p{
      std::move(name), "", ParameterType::kChoice, 0, 0, "", "", {}, std::move(help), {}, {}};
  for (const auto& [label, value] : values) p.choices.push_back(label);
  p.get = [access, values](const JobConfig& c) {
    for (const auto& [label, value] : values)
      if (value == read(access, c)) return ParameterValue(label);
    return ParameterValue(std::string());
  };
  p.set = [access, values](JobConfig& c, const ParameterValue& v) {
    for (const auto& [label, value] : values)
      if (label == std::get<std::string>(v)) access(c) = value;
  };
  return p;
}

Parameter choice(std::string name, const std::vector<std::string>& values,
                 Access<std::string> access, std::string help) {
  std::vector<std::pair<std::string, std::string>> pairs;
  pairs.reserve(values.size());
  for (const std::string& value : values) pairs.emplace_back(value, value);
  return choice<std::string>(std::move(name), std::move(pairs), access, std::move(help));
}

// Choices that have names already.
template <class Enum>
std::vector<std::pair<std::string, Enum>> named(const char* (*name)(Enum),
                                                const std::vector<Enum>& values) {
  std::vector<std::pair<std::string, Enum>> pairs;
  pairs.reserve(values.size());
  for (const Enum value : values) pairs.emplace_back(name(value), value);
  return pairs;
}

using C = JobConfig;

std::vector<Parameter> object_records() {
  return {
      path(
          "object.file", [](C& c) -> std::filesystem::path& { return c.model; },
          "the model, in a job's file: relative to that file"),
      choice(
          "object.units", {"", "mm", "cm", "m", "in"},
          [](C& c) -> std::string& { return c.object.load.units; },
          "unit of the model's coordinates; empty: what the format says, else mm"),
      number(
          "object.size_mm", "mm", 0.1, 5000, [](C& c) -> double& { return c.object.pose.size_mm; },
          "scale the model so that its largest extent is this", "the model's own size"),
      choice<ModelSide>(
          "object.down",
          named(side_name, {ModelSide::kMinusZ, ModelSide::kPlusZ, ModelSide::kMinusY,
                            ModelSide::kPlusY, ModelSide::kMinusX, ModelSide::kPlusX}),
          [](C& c) -> ModelSide& { return c.object.pose.down; },
          "the model's side that enters the water first"),
      or_auto(vector(
                  "object.rotate_deg", "deg", -3600, 3600,
                  [](C& c) -> Vec3& { return c.object.pose.rotate_deg; },
                  "then turn about the fixed axes x, y, z, in that order; auto: as it dips best"),
              [](C& c) -> bool& { return c.plan.find_pose; }),
      choice(
          "object.up", {"", "+y", "+z", "+x", "-x", "-y", "-z"},
          [](C& c) -> std::string& { return c.up; },
          "the model's way up when it stands, for pictures; empty: as its format has it"),
      path(
          "object.texture", [](C& c) -> std::filesystem::path& { return c.object.load.texture; },
          "image that replaces the model's textures; in a file: relative to that file"),
      color(
          "object.base_color", [](C& c) -> LinearColor& { return c.object.base; },
          "colour of the bare object, sRGB, #rrggbb"),
  };
}

std::vector<Parameter> film_records() {
  return {
      number(
          "film.width_mm", "mm", 10, 3000, [](C& c) -> double& { return c.design.film.width_mm; },
          "width of the whole sheet (x)"),
      number(
          "film.height_mm", "mm", 10, 3000, [](C& c) -> double& { return c.design.film.height_mm; },
          "height of the whole sheet (y)"),
      choice<FilmShape>(
          "film.shape", {{"rectangle", FilmShape::kRectangle}, {"disc", FilmShape::kDisc}},
          [](C& c) -> FilmShape& { return c.design.film.shape; },
          "outline of the film; disc: inscribed in the smaller extent"),
      number(
          "film.margin_mm", "mm", 0, 500, [](C& c) -> double& { return c.design.film.margin_mm; },
          "width of the taped, clamped rim"),
      integer(
          "film.elements", "", 8, 4000000, [](C& c) -> int& { return c.design.film.elements; },
          "triangles of the simulated film"),
      number(
          "film.grading", "", 1, 20, [](C& c) -> double& { return c.design.film.grading; },
          "cell size at the rim over that at the centre; with dip.scheme=paper: 1"),
      number(
          "film.swelling_x", "", 0.8, 1.5, [](C& c) -> double& { return c.design.film.swelling_x; },
          "width of the film on the water over that of the sheet, as 'hydrodip register' finds it"),
      number(
          "film.swelling_y", "", 0.8, 1.5, [](C& c) -> double& { return c.design.film.swelling_y; },
          "the same of its height"),
      path(
          "film.correction", [](C& c) -> std::filesystem::path& { return c.correction; },
          "what 'hydrodip correct' found out by earlier dips of the same job; empty: nothing"),
  };
}

std::vector<Parameter> bath_records() {
  return {
      number(
          "bath.width_mm", "mm", 10, 5000, [](C& c) -> double& { return c.bath.width_mm; },
          "longer or shorter side of the bath"),
      number(
          "bath.height_mm", "mm", 10, 5000, [](C& c) -> double& { return c.bath.height_mm; },
          "the bath's other side"),
      number(
          "bath.depth_mm", "mm", 1, 5000, [](C& c) -> double& { return c.bath.depth_mm; },
          "depth of the water"),
  };
}

std::vector<Parameter> dip_records() {
  return {
      number(
          "dip.step_mm", "mm", 0.001, 10, [](C& c) -> double& { return c.design.dip.step_mm; },
          "how far the object is lowered in one step of the simulation"),
      choice<bool>(
          "dip.steps", {{"as-needed", false}, {"even", true}},
          [](C& c) -> bool& { return c.design.dip.even_steps; },
          "as-needed: straight down, steps grow to four times dip.step_mm, but to no more than "
          "0.4 mm, where that costs no accuracy; even: all are dip.step_mm long"),
      integer(
          "dip.air_cells", "", 0, 100000000, [](C& c) -> int& { return c.design.air.cells; },
          "cubes into which the space around the object is cut to look for trapped air; 0: none is "
          "looked for"),
      or_auto(number(
                  "dip.depth_mm", "mm", 0.001, 5000,
                  [](C& c) -> double& { return c.design.trajectory.depth_mm; },
                  "how deep the object is dipped; auto: as deep as is good", "the whole object"),
              [](C& c) -> bool& { return c.plan.find_depth; }),
      number(
          "dip.tilt_deg", "deg", -85, 85,
          [](C& c) -> double& { return c.design.trajectory.tilt_deg; },
          "lean the object over by so much and dip it like that"),
      number(
          "dip.roll_deg", "deg", -170, 170,
          [](C& c) -> double& { return c.design.trajectory.roll_deg; },
          "lay the object over by so much more on its way down"),
      number(
          "dip.tilt_toward_deg", "deg", -360, 360,
          [](C& c) -> double& { return c.design.trajectory.tilt_toward_deg; },
          "where its top leans to: degrees from +x to +y"),
      way_in(
          "path", [](C& c) -> std::vector<Keyframe>& { return c.design.trajectory.path; },
          "CSV file with the way into the water: lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,"
          "turn_y_deg,turn_z_deg; empty: straight down"),
      vector(
          "dip.pivot_mm", "mm", -5000, 5000,
          [](C& c) -> Vec3& { return c.design.trajectory.pivot_mm; },
          "point of the posed object about which a path turns"),
      choice<DipMethod>(
          "dip.method",
          {{"full", DipMethod::kFull},
           {"single-step", DipMethod::kSingleStep},
           {"projection", DipMethod::kProjection}},
          [](C& c) -> DipMethod& { return c.design.dip.method; },
          "full; single-step: draped at once, never glued; projection: straight up"),
      choice<DipScheme>(
          "dip.scheme", {{"contact-line", DipScheme::kContactLine}, {"paper", DipScheme::kPaper}},
          [](C& c) -> DipScheme& { return c.design.dip.scheme; },
          "of dip.method=full: contact line resolved inside triangles, or the paper's literal "
          "steps"),
  };
}

std::vector<Parameter> material_records() {
  return {
      number(
          "material.z_stretch", "", 0, 5,
          [](C& c) -> double& { return c.design.dip.material.z_stretch; },
          "vertical scale of the film's rest shape: how it follows slopes"),
      number(
          "material.tear_stretch", "", 1, 100,
          [](C& c) -> double& { return c.design.dip.material.tear_stretch; },
          "largest principal stretch that the film bears", "the film never tears"),
      number(
          "material.safe_stretch", "", 1, 100,
          [](C& c) -> double& { return c.design.dip.material.safe_stretch; },
          "largest principal stretch up to which film surely holds; beyond it is doubtful"),
      number(
          "material.lost_stretch", "", 1, 100,
          [](C& c) -> double& { return c.design.dip.material.lost_stretch; },
          "principal stretch from which on no film holds"),
      number(
          "material.wrinkle_stretch", "", 0, 1,
          [](C& c) -> double& { return c.design.dip.material.wrinkle_stretch; },
          "smallest principal stretch that the film bears without wrinkles"),
      number(
          "material.poisson", "", 0, 0.499,
          [](C& c) -> double& { return c.design.dip.material.poisson; },
          "Poisson's ratio of the film"),
      number(
          "material.ink_stiffness_ratio", "", 1, 1e6,
          [](C& c) -> double& { return c.design.stiffness.ratio; },
          "modulus of film at ink density 1 over that of blank film; 1: ink does not stiffen"),
  };
}

std::vector<Parameter> ink_records() {
  return {
      integer(
          "ink.rounds_max", "", 1, 100, [](C& c) -> int& { return c.design.rounds_max; },
          "most rounds of simulating with the ink's stiffness; 1: even stiffness"),
      number(
          "ink.filter_mm", "mm", 0.01, 20,
          [](C& c) -> double& { return c.design.stiffness.filter_mm; },
          "ink stiffens the film evenly over a square of this side"),
      choice<InkModel>(
          "ink.model", {{"device", InkModel::kDevice}, {"profile", InkModel::kProfile}},
          [](C& c) -> InkModel& { return c.printer.model; },
          "colours to inks: plain formula, or ICC profile (ink.profile or an installed one)"),
      path(
          "ink.profile", [](C& c) -> std::filesystem::path& { return c.printer.profile; },
          "the printer's ICC profile, CMYK or RGB; in a file: relative to that file"),
      choice<RenderingIntent>(
          "ink.intent",
          {{"relative", RenderingIntent::kRelative},
           {"perceptual", RenderingIntent::kPerceptual},
           {"saturation", RenderingIntent::kSaturation},
           {"absolute", RenderingIntent::kAbsolute}},
          [](C& c) -> RenderingIntent& { return c.printer.intent; },
          "how the profile brings colours into the printer's range"),
      number(
          "ink.limit", "", 0.1, 4, [](C& c) -> double& { return c.design.inking.limit; },
          "largest sum of inks at a point that film and printer bear; 4: no limit"),
      choice<bool>(
          "ink.compensation", {{"on", true}, {"off", false}},
          [](C& c) -> bool& { return c.design.inking.compensate; },
          "print more ink where the film will stretch"),
      choice<GamutPolicy>(
          "gamut.policy",
          {{"clip", GamutPolicy::kClip},
           {"scale", GamutPolicy::kScale},
           {"soft", GamutPolicy::kSoft}},
          [](C& c) -> GamutPolicy& { return c.design.inking.policy; },
          "where more ink is needed than fits: cut, lighten the whole image, or hold back "
          "smoothly"),
  };
}

std::vector<Parameter> print_records() {
  return {
      number(
          "print.dpi", "dpi", 36, 1200, [](C& c) -> double& { return c.design.dpi; },
          "resolution of the film image"),
      number(
          "print.bleed_mm", "mm", 0, 50, [](C& c) -> double& { return c.design.inverse.bleed_mm; },
          "colour extended around the region that touches the object"),
      integer(
          "print.samples", "", 1, 8, [](C& c) -> int& { return c.design.inverse.samples_per_axis; },
          "samples per pixel along each axis"),
      choice<InkSide>(
          "print.ink_side", {{"up", InkSide::kUp}, {"down", InkSide::kDown}},
          [](C& c) -> InkSide& { return c.print.ink_side; },
          "which side of the film carries the ink on the water; down: mirrored"),
      choice<PrintColor>(
          "print.color", {{"rgb", PrintColor::kRgb}, {"cmyk", PrintColor::kCmyk}},
          [](C& c) -> PrintColor& { return c.printer.color; },
          "colours of print.pdf: rgb for desktop printers, cmyk for print shops"),
      text(
          "print.job_name", ParameterType::kText,
          [](C& c) -> std::string& { return c.print.job_name; },
          "name in the sheet's margin; empty: the model's file name"),
      choice<bool>(
          "print.marks", {{"on", true}, {"off", false}},
          [](C& c) -> bool& { return c.print.camera_marks; },
          "marks for 'hydrodip register' in the margin of print.pdf, where there is room for them"),
      choice<bool>(
          "print.outlines", {{"on", true}, {"off", false}},
          [](C& c) -> bool& { return c.print.outlines; },
          "thin lines beside the colours of print.pdf, to aim by: where the water cuts the object, "
          "just after the first touch and in the end"),
      number(
          "print.scale_x", "", 0.9, 1.1, [](C& c) -> double& { return c.print.scale_x; },
          "what the printer makes of 1 mm across; print.pdf is drawn so that it comes out true"),
      number(
          "print.scale_y", "", 0.9, 1.1, [](C& c) -> double& { return c.print.scale_y; },
          "the same along the sheet"),
      number(
          "print.skew_deg", "deg", -5, 5, [](C& c) -> double& { return c.print.skew_deg; },
          "how far the printer leans upright lines over to the right"),
  };
}

std::vector<Parameter> process_records() {
  return {
      number(
          "process.water_min_c", "C", 0, 100, [](C& c) -> double& { return c.process.water_min_c; },
          "coolest the water may be, through the whole process"),
      number(
          "process.water_max_c", "C", 0, 100, [](C& c) -> double& { return c.process.water_max_c; },
          "warmest the water may be"),
      number(
          "process.soak_min_s", "s", 0, 3600, [](C& c) -> double& { return c.process.soak_min_s; },
          "from laying the film on the water until it lies flat again, at least"),
      number(
          "process.soak_max_s", "s", 0, 3600, [](C& c) -> double& { return c.process.soak_max_s; },
          "the same, at most"),
      number(
          "process.activator_g", "g", 0, 1000,
          [](C& c) -> double& { return c.process.activator_g; },
          "activator per letter sheet of film; scaled to the job's film"),
      number(
          "process.activator_tolerance_g", "g", 0, 1000,
          [](C& c) -> double& { return c.process.activator_tolerance_g; },
          "how far that may be off, per letter sheet"),
      number(
          "process.activator_wait_s", "s", 0, 3600,
          [](C& c) -> double& { return c.process.activator_wait_s; },
          "from spraying the activator to the dip"),
      number(
          "process.speed_mm_per_min", "mm/min", 1, 6000,
          [](C& c) -> double& { return c.process.speed_mm_per_min; }, "speed of the dip"),
      number(
          "process.dwell_s", "s", 0, 3600, [](C& c) -> double& { return c.process.dwell_s; },
          "how long the object stays down, at least"),
      number(
          "process.lift_mm_per_min", "mm/min", 1, 6000,
          [](C& c) -> double& { return c.process.lift_mm_per_min; },
          "speed of lifting the object out"),
      number(
          "process.dry_min_h", "h", 0, 1000, [](C& c) -> double& { return c.process.dry_min_h; },
          "drying, at least"),
      number(
          "process.dry_max_h", "h", 0, 1000, [](C& c) -> double& { return c.process.dry_max_h; },
          "drying, at most"),
  };
}

std::vector<Parameter> cost_records() {
  return {
      text(
          "cost.currency", ParameterType::kText,
          [](C& c) -> std::string& { return c.cost.currency; }, "of the prices, as in EUR"),
      number(
          "cost.film_per_m2", "/m2", 0, 1e6, [](C& c) -> double& { return c.cost.film_per_m2; },
          "price of film"),
      number(
          "cost.ink_per_ml", "/ml", 0, 1e6, [](C& c) -> double& { return c.cost.ink_per_ml; },
          "price of ink"),
      number(
          "cost.ink_ml_per_m2", "ml/m2", 0, 1000,
          [](C& c) -> double& { return c.cost.ink_ml_per_m2; },
          "ink that full coverage of one colour takes; the printer's own figure"),
      number(
          "cost.activator_per_g", "/g", 0, 1e6,
          [](C& c) -> double& { return c.cost.activator_per_g; }, "price of activator"),
      number(
          "cost.per_piece", "", 0, 1e9, [](C& c) -> double& { return c.cost.per_piece; },
          "whatever else a piece costs: the bare part, coats, labour"),
  };
}

std::vector<Parameter> stage_records() {
  return {
      choice<StageDriver>(
          "stage.driver", {{"zaber", StageDriver::kZaber}, {"marlin", StageDriver::kMarlin}},
          [](C& c) -> StageDriver& { return c.stage.driver; },
          "what moves the object: a Zaber stage, or the Z axis of a printer with Marlin"),
      text(
          "stage.port", ParameterType::kText, [](C& c) -> std::string& { return c.stage.port; },
          "serial port, as in /dev/ttyUSB0"),
      integer(
          "stage.baud", "", 1200, 1000000, [](C& c) -> int& { return c.stage.baud; },
          "serial speed"),
      integer(
          "stage.address", "", 1, 99, [](C& c) -> int& { return c.stage.address; },
          "number of the device in a chain of Zaber devices"),
      number(
          "stage.microstep_um", "um", 0.0001, 1000,
          [](C& c) -> double& { return c.stage.microstep_um; },
          "Zaber: travel per microstep, from the stage's data sheet"),
      number(
          "stage.travel_mm", "mm", 1, 5000, [](C& c) -> double& { return c.stage.travel_mm; },
          "Zaber: length of travel from the data sheet, to check the stage by", "not checked"),
      choice<StageDown>(
          "stage.down", {{"plus", StageDown::kPlus}, {"minus", StageDown::kMinus}},
          [](C& c) -> StageDown& { return c.stage.down; },
          "the way the object goes down: plus is away from home on a Zaber stage"),
      number(
          "stage.lowest_mm", "mm", 0.001, 5000, [](C& c) -> double& { return c.stage.lowest_mm; },
          "position beyond which it never goes down", "the stage's own limit"),
      number(
          "stage.water_mm", "mm", 0.001, 5000, [](C& c) -> double& { return c.stage.water_mm; },
          "position at which the object's lowest point meets the water", "unknown"),
      number(
          "stage.clearance_mm", "mm", 1, 2000, [](C& c) -> double& { return c.stage.clearance_mm; },
          "between object and water while people work"),
      number(
          "stage.approach_mm", "mm", 1, 500, [](C& c) -> double& { return c.stage.approach_mm; },
          "above the water, where the dip's constant speed begins"),
      number(
          "stage.travel_mm_per_min", "mm/min", 1, 6000,
          [](C& c) -> double& { return c.stage.travel_mm_per_min; },
          "speed where no water is near"),
  };
}

std::vector<Parameter> plan_records() {
  return {
      integer(
          "plan.dips", "", 1, kMostDips, [](C& c) -> int& { return c.plan.dips; },
          "how many dips to plan", "as many as the job names"),
      number(
          "plan.overlap_mm", "mm", 0, 50, [](C& c) -> double& { return c.plan.overlap_mm; },
          "how wide the inks of neighbouring dips fade into each other"),
      path(
          "plan.importance", [](C& c) -> std::filesystem::path& { return c.plan.importance; },
          "picture over the model's UVs of what matters: white in full, black not at all"),
      choice<bool>(
          "plan.suggest", {{"on", true}, {"off", false}},
          [](C& c) -> bool& { return c.plan.suggest; },
          "say how else to dip it where the verdict is not to, which takes seconds to find out"),
  };
}

std::vector<Parameter> report_records() {
  return {
      choice<bool>(
          "report.for", {{"workshop", false}, {"customer", true}},
          [](C& c) -> bool& { return c.report.for_customer; },
          "who reads report.html; customer: what comes out, in plain words, and nothing of the "
          "workshop"),
      path(
          "report.logo", [](C& c) -> std::filesystem::path& { return c.report.logo; },
          "picture above report.html: PNG, JPEG, SVG"),
  };
}

std::vector<Parameter> run_records() {
  return {
      integer(
          "preview.width_px", "px", 64, 8192, [](C& c) -> int& { return c.preview_width_px; },
          "width of preview.png"),
      integer(
          "preview.texture_px", "px", 64, 8192, [](C& c) -> int& { return c.preview_texture_px; },
          "longest side of the textures in preview.glb"),
      choice<bool>(
          "preview.pictures", {{"on", true}, {"off", false}},
          [](C& c) -> bool& { return c.pictures; },
          "preview.png, maps.png, gamut.png and the 3D view of report.html, which take seconds"),
      choice<EarlierResult>(
          "output.no_clobber", {{"off", EarlierResult::kReplaced}, {"on", EarlierResult::kKept}},
          [](C& c) -> EarlierResult& { return c.earlier_result; },
          "on: refuse to replace an earlier result in the output folder"),
      integer(
          "run.threads", "", 1, 1024, [](C& c) -> int& { return c.threads; },
          "processor threads; the result does not depend on it", "all cores"),
  };
}

}  // namespace

const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list;
    for (auto table : {object_records, film_records, bath_records, dip_records, material_records,
                       ink_records, print_records, process_records, cost_records, stage_records,
                       plan_records, report_records, run_records})
      for (Parameter& p : table()) list.push_back(std::move(p));
    return list;
  }();
  return all;
}

}  // namespace hydrodip
