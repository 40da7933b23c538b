#include "register_commands.h"

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "rig/rig_job.h"

namespace hydrodip {
namespace {

constexpr const char* kReadingGroup = "Readings";
constexpr const char* kCameraGroup = "Camera";
constexpr const char* kScanGroup = "Scans";

void declare_printer(CLI::App& app, Request& request) {
  declare_output(app, request, "the current folder");
  declare_reporting(app, request);
  PrinterRequest& printer = request.printer;
  app.add_option_function<std::string>(
         "--readings",
         [&printer](const std::string& text) {
           const std::vector<double> mm = numbers_of("--readings", text, 4, 4);
           printer.readings = PrinterReadings{mm[0], mm[1], mm[2], mm[3]};
         },
         "lengths on the printed test sheet, in mm: A-B, A-C, A-D and C-B")
      ->group(kReadingGroup)
      ->type_name("AB,AC,AD,CB");
  app.add_option("--scan", printer.scan, "or a scan of the test sheet, from a flatbed scanner")
      ->group(kReadingGroup)
      ->type_name("IMG");
  app.add_option("--scan-dpi", printer.scan_dpi,
                 "its resolution (default: what the picture records)")
      ->group(kReadingGroup)
      ->type_name("DPI")
      ->check(between(50, 5000));
  app.add_option("--save", printer.profile,
                 "keep it in this profile of yours (default: printer.toml in the output folder)")
      ->group(kReadingGroup)
      ->type_name("NAME");
  declare_film(app, request);
  declare_configuration(app, request);
}

JobResult run_printer(const Request& request, const RunContext& context) {
  PrinterRequest printer = request.printer;
  if (printer.readings && !printer.scan.empty())
    throw InputError("--readings and --scan say the same: give one of them");
  const bool told = printer.readings || !printer.scan.empty();
  if (!told && !printer.profile.empty())
    throw InputError(
        "--save keeps what the printed test sheet tells: give its --readings or a --scan of it");
  if (printer.scan_dpi > 0 && printer.scan.empty())
    throw InputError("--scan-dpi is the resolution of a --scan, and there is none");
  if (!printer.profile.empty() && !request.output.empty())
    throw InputError("--save keeps it in a profile, and -o in a folder: give one of them");
  printer.profile_folder = profile_folder();
  JobConfig config = configure(request, context);
  if (config.output.empty()) config.output = ".";
  return printer_job(config, printer, context);
}

void declare_board(CLI::App& app, Request& request) {
  declare_output(app, request, "the current folder");
  app.add_option("--paper", request.paper, "default: a4")->group("Output")->type_name("a4|letter");
  declare_reporting(app, request);
  declare_configuration(app, request);
}

JobResult run_board(const Request& request, const RunContext& context) {
  JobConfig config = configure(request, context);
  if (config.output.empty()) config.output = ".";
  return board_job(config, request.paper, context);
}

void declare_register(CLI::App& app, Request& request) {
  app.add_option("PHOTO", request.photos,
                 "photo of the film on the water with the board on the rim in it, then the job's "
                 "folder JOB_DIR; with --calibrate-camera photos of the board alone")
      ->type_name("");
  RegisterRequest& registration = request.registration;
  app.add_option("--camera", registration.camera,
                 "the camera's calibration (default: camera.json in the job's folder, or here)")
      ->group(kCameraGroup)
      ->type_name("FILE.json");
  app.add_flag("--calibrate-camera", request.calibrate_camera,
               "make that file from photos of the board, 12 or so from all sides")
      ->group(kCameraGroup);
  app.add_option("-o,--output", request.output,
                 "of --calibrate-camera: the file to write (default: camera.json)")
      ->group(kCameraGroup)
      ->type_name("FILE.json");
  app.add_option_function<double>(
         "--water-below", [&registration](const double& mm) { registration.water_below_mm = mm; },
         "how far the water stands below the strips on the rim (default: as the camera's file "
         "says; 0)")
      ->group(kCameraGroup)
      ->type_name("MM")
      ->check(between(-500.0, 500.0));
  app.add_option("--water-sigma", registration.water_sigma_mm,
                 "how well that is known (default: 0.3)")
      ->group(kCameraGroup)
      ->type_name("MM")
      ->check(between(0.01, 10.0));
  app.add_option("--tolerance", registration.tolerance_mm,
                 "how far the marks may lie off an evenly swollen sheet, rms (default: 1)")
      ->group(kCameraGroup)
      ->type_name("MM")
      ->check(between(0.01, 50.0));
  app.add_flag("--set-place", registration.set_place,
               "this film lies as film is to lie: keep that in the camera's file")
      ->group(kCameraGroup);
  declare_reporting(app, request);
  declare_configuration(app, request);
}

JobResult run_register(const Request& request, const RunContext& context) {
  const std::vector<std::string>& given = request.photos;
  if (request.calibrate_camera) {
    const RegisterRequest untold;
    if (!request.registration.camera.empty() || request.registration.set_place)
      throw InputError(
          "--camera and --set-place are of a photo of film; --calibrate-camera writes to the file "
          "of -o");
    if (request.registration.water_sigma_mm != untold.water_sigma_mm ||
        request.registration.tolerance_mm != untold.tolerance_mm)
      throw InputError(
          "--water-sigma and --tolerance are of a photo of film; the camera's file keeps neither");
    if (given.empty())
      throw InputError("name the photos, as in 'hydrodip register --calibrate-camera board-*.jpg'");
    CameraRequest camera;
    camera.photos.assign(given.begin(), given.end());
    camera.file = request.output.empty() ? "camera.json" : request.output;
    camera.water_below_mm = request.registration.water_below_mm;
    return calibrate_camera_job(camera, context);
  }
  if (given.size() != 2)
    throw InputError(
        "name one photo and the job's folder, as in 'hydrodip register photo.jpg mask-print'");
  if (!request.output.empty())
    throw InputError(
        "-o is of --calibrate-camera; what a photo tells is written into the job's folder");
  RegisterRequest registration = request.registration;
  registration.photo = given[0];
  return register_job(configure_printed(request, given[1], context), registration, context);
}

void declare_correct(CLI::App& app, Request& request) {
  app.add_option("JOB_DIR", request.model, "folder that 'hydrodip print' wrote")->type_name("");
  app.add_option(
         "SCAN", request.jobs,
         "what dips of it came to: the corners of the kit's board as a quad mesh (OBJ, PLY) or "
         "a table (CSV), a scan with its colours, or a table of places with the header "
         "film_x_mm,film_y_mm,x,y,z; several dips are averaged")
      ->type_name("");
  CorrectRequest& correction = request.correction;
  app.add_option("--board", correction.board,
                 "which board was dipped, tints (what the kit prints) or black (default: the one "
                 "that fits clearly better)")
      ->group(kScanGroup)
      ->type_name("tints|black");
  app.add_option("--square", correction.square_mm,
                 "side of the board's squares (default: as the board's)")
      ->group(kScanGroup)
      ->type_name("MM")
      ->check(between(0.5, 100.0));
  app.add_option("--scan-units", correction.scan_units,
                 "unit of the scans (default: what the format says, as glTF's metres, else mm)")
      ->group(kScanGroup)
      ->type_name("mm|cm|m|in");
  app.add_flag("--aligned", correction.aligned,
               "the scans are in the posed object's frame: do not register them")
      ->group(kScanGroup);
  declare_reporting(app, request);
  declare_configuration(app, request);
}

JobResult run_correct(const Request& request, const RunContext& context) {
  if (request.model.empty() || request.jobs.empty())
    throw InputError(
        "name the job's folder and what came of it, as in 'hydrodip correct mask-print scan.obj'");
  CorrectRequest correction = request.correction;
  correction.scans.assign(request.jobs.begin(), request.jobs.end());
  return correct_job(configure_printed(request, request.model, context), correction, context);
}

}  // namespace

std::vector<Command> register_commands() {
  return {
      {"calibrate printer", "how true a printer prints: a test sheet, and what it says",
       "Without readings it writes printer-test.pdf. With them, or a scan of that sheet, it "
       "writes\n"
       "print.scale_x, print.scale_y and print.skew_deg; every sheet printed with that profile is\n"
       "drawn the other way, so that it comes out true. See docs/registration.md.",
       declare_printer, run_printer},
      {"register",
       "where the film lies on the water, from a photo of it",
       "Says how far it lies off its place, how much it has swollen and what that leaves\n"
       "unexplained, each with its uncertainty, and how to move the frame. Writes\n"
       "registration.json (for 'hydrodip print --film-state') and registration.png into JOB_DIR.\n"
       "  hydrodip register board\n"
       "  hydrodip register --calibrate-camera --water-below 22 board-*.jpg\n"
       "  hydrodip register photo.jpg mask-print\n"
       "See docs/registration.md.",
       declare_register,
       run_register,
       {},
       "PHOTO JOB_DIR"},
      {"register board", "marks for the tank's rim, to print and glue",
       "Writes board.pdf, drawn true for the printer of the --profile that 'calibrate printer' "
       "made.",
       declare_board, run_board},
      {"correct", "what a second print has to do otherwise, from dips of the first",
       "Writes correction.json and correction.png into JOB_DIR. Print again with\n"
       "--correction JOB_DIR/correction.json. See docs/registration.md.",
       declare_correct, run_correct},
  };
}

}  // namespace hydrodip
