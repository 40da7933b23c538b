#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "calibrate/calibrate.h"
#include "calibrate/checkerboard_dip.h"
#include "calibrate/expectation.h"
#include "calibrate/kit_shapes.h"
#include "calibrate/printed_board.h"
#include "calibrate/tear_limit.h"
#include "export/stl.h"
#include "ink/color_model.h"
#include "job/sheet_of.h"
#include "settings/activator.h"
#include "sheet/film_marks.h"
#include "sheet/page_writer.h"
#include "sheet/sheet.h"

namespace hydrodip {
namespace {

// Of the tear film: to be seen well, and to stretch as prints do.
constexpr std::uint8_t kEvenInk = 102;

constexpr PaperSize kA4 = {210, 297}, kLetter = {215.9, 279.4};

PaperSize paper_for(const FilmOptions& film) {
  const double shorter = std::min(film.width_mm, film.height_mm);
  return shorter == kLetter.width_mm ? kLetter : kA4;
}

// Black and white, as a desktop printer takes it.
Image as_image(const InkImage& inks) {
  Image image(inks.width_px, inks.height_px);
  for (std::size_t i = 0; i < inks.cmyk.size(); i += 4) {
    image.rgba[i] = image.rgba[i + 1] = image.rgba[i + 2] = std::uint8_t(255 - inks.cmyk[i + 3]);
    // What is white is not printed.
    image.rgba[i + 3] = inks.cmyk[i + 3] > 0 ? 255 : 0;
  }
  return image;
}

void write_film(const std::filesystem::path& path, const JobConfig& config, const Board& board,
                const RunContext& context) {
  const PrintedBoard printed = print_board(config.design.film, board);
  SheetOptions sheet;
  sheet.width_mm = config.design.film.width_mm;
  sheet.height_mm = config.design.film.height_mm;
  sheet.margin_mm = config.design.film.margin_mm;
  sheet.disc = config.design.film.shape == FilmShape::kDisc;
  sheet.ink_side_up = config.print.ink_side == InkSide::kUp;
  sheet.dpi = printed.raster.dpi;
  sheet.printer = printer_of(config.print);
  sheet.job_name = board.period == 1 ? std::string("calibration, how far film holds")
                                     : fmt::format("calibration, {}, {:g} mm squares", board.name,
                                                   board.square_mm);
  const Image image = as_image(printed.inks);
  write_print_pdf(path, image, srgb_profile(), sheet, context);
}

// Alike everywhere, so that ink does not show in where film is stretched.
Board even_film(double square_mm) { return {"even", square_mm, false, 1, {kEvenInk}}; }

// ---- the page to work by ----

std::string scans_of(const std::vector<std::string>& objects) {
  std::string text;
  for (const std::string& object : objects) text += fmt::format(" {}=FILE", object);
  return text;
}

// What the dome's and the fit's sections take.
constexpr double kLastSections_mm = 81;

void write_instructions(const std::filesystem::path& path, const JobConfig& config,
                        const std::vector<std::string>& objects, const Board& board,
                        const RunContext& context) {
  const ProcessOptions& process = config.process;
  PdfDocument pdf;
  pdf.set_title("Calibrating a film");
  PageWriter page(pdf, paper_for(config.design.film));
  const auto say = [&](const std::string& words) {
    page.paragraph(page.left(), page.width(), words, PageWriter::kBody_pt);
    page.y -= 1.5;
  };
  page.y -= 6;
  page.text(page.left(), page.y, "Calibrating a film", PageWriter::kTitle_pt, PdfFont::kBold);
  page.y -= 3;
  say("Dip a printed board of squares onto shapes that are known, scan where its corners came to "
      "lie, "
      "and let hydrodip find the film's parameters. One dip of each shape takes an afternoon; a "
      "second one of each tells how alike your dips are.");

  page.heading("Shapes");
  page.task(
      "Print the STL files as they stand, flat end down, without supports, in a matt light colour; "
      "layers of 0.1 mm. Sand and prime them: the film shows every layer.");
  page.task(fmt::format(
      "Screw a tripod plate (1/4-20) into the {:g} mm hole in the flat end; the screw cuts its own "
      "thread. Hang the shape with its flat end up and level.",
      kMountHole_mm));

  page.heading("Film");
  const FilmOptions& film = config.design.film;
  const Activator activator = activator_for(process, film);
  page.task(
      fmt::format("Print checkerboard.pdf once for each dip at 100 %, no scaling; the ruler in its "
                  "margin must measure true. Four squares together are {:g} mm wide.",
                  4 * board.square_mm),
      {"Four squares, mm"});
  page.task(fmt::format("Tape {:g} mm around all four edges. Dry for as long as your ink needs.",
                        tape_mm(film.width_mm, film.height_mm, film.margin_mm, false)));

  page.heading("Dip");
  for (const std::string& text : objects) {
    RunContext quiet = context.quiet();
    const CalibrationObject object = calibration_object(text, config, quiet);
    page.task(fmt::format("{}: its tip {:g} mm below the water, {:g} mm/min, over {} in the "
                          "middle of the film (to 1 mm), no turn.",
                          object.name, object.depth_mm, process.speed_mm_per_min,
                          board.about_square ? "the dark square" : "the corner"),
              {"Depth reached, mm"});
  }
  page.task(fmt::format(
      "Water {} °C; film soaks {} s until it lies flat; {}; then dip. Exactly as in "
      "the jobs to come.",
      span_in_words(process.water_min_c, process.water_max_c),
      span_in_words(process.soak_min_s, process.soak_max_s),
      activator.mass_g > 0
          ? fmt::format("activator {}; wait {:g} s", in_words(activator), process.activator_wait_s)
          : "no activator"));
  page.task(
      "Film swells on the water, by two or three percent as a rule, and is calibrated wrongly if "
      "nobody says so. Before the activator, find out by how much: a photo for 'hydrodip register' "
      "of another sheet of this film with a job's marks, or a rule held over two far squares.",
      {"Swollen across, %", "Swollen along, %"});
  page.task("Clear the surface, lift the shape out, rinse it, let it dry.");

  page.heading("Scan");
  page.task(
      "Scan the printed side with its colours; 5 samples a millimetre or better. Keep "
      "millimetres. With a texture or coloured vertices the scan does as it is (OBJ, PLY, GLB): "
      "cut "
      "off all but the shape. Else:");
  page.task(
      board.about_square
          ? "On the scan, draw a quad mesh: a vertex on every corner of every dark square, a face "
            "for every dark square and for every pale one between them. Leave out what tore or is "
            "not to be seen. Or write a table: column,row,x,y,z, a line per corner. Save as OBJ, "
            "PLY or CSV; its pose does not matter."
          : "On the scan, draw a quad mesh: a vertex on every corner where two black squares meet, "
            "a face for every square. Leave out what tore or is not to be seen. Or write a table: "
            "column,row,x,y,z, a line per corner. Save as OBJ, PLY or CSV; its pose does not "
            "matter.");

  if (page.y < kLastSections_mm) page.new_page();
  page.heading("How far the film holds");
  page.task(
      fmt::format("Print tear-film.pdf, and dip it like the others with the dome ({:g} mm, "
                  "{:g} mm/min). On the dried dome count grooves from the tip outwards, every "
                  "fifth is wide: which is the first one on which film is torn anywhere?",
                  kDomeDepth_mm, process.speed_mm_per_min),
      {"Torn from ring"});

  page.heading("Fit");
  say(fmt::format("hydrodip measure{}    shows at once whether the scans are read well.",
                  scans_of(objects)));
  say(fmt::format("hydrodip calibrate{} -o my-film", scans_of(objects)));
  say("With the film's swelling: --film-state registration.json, or --set film.swelling_x=1.025 "
      "--set film.swelling_y=1.015 for 2.5 and 1.5 %.");
  say("With the dome's reading: --torn-ring N, once for each dip of it.");
  say("Where you dipped deeper or less, say so: sphere-90@18.5=FILE. Then print with "
      "--profile my-film/profile.toml.");
  pdf.save(path);
}

// ---- how well the parameters will be known ----

constexpr double kRatios[] = {3, 10, 30, 100, 300, 1000, 3000};
// Drafts are enough: to say a standard deviation to a tenth.
constexpr int kExpectedElements = 10000;
constexpr double kExpectedStep_mm = 0.4;

std::vector<Expectation> expectations(const std::vector<CalibrationObject>& objects,
                                      const Board& board, const JobConfig& config, double noise_mm,
                                      const RunContext& context) {
  std::vector<Expectation> list;
  if (noise_mm == 0) return list;
  if (!(noise_mm > 0 && noise_mm <= 10))
    throw InputError("--expect: give a scan's noise in mm, above 0 and up to 10");
  DesignOptions draft = config.design;
  draft.film.elements = std::min(draft.film.elements, kExpectedElements);
  draft.dip.step_mm = std::max(draft.dip.step_mm, kExpectedStep_mm);
  const CheckeredFilm film = checkered_film(draft, board);
  FilmParameters truth = film_parameters(config.design);
  for (const double ratio : kRatios) {
    context.progress("expecting", double(list.size()) / double(std::size(kRatios)));
    truth.stiffness_ratio = ratio;
    list.push_back(expect(objects, film, draft, truth, noise_mm, context));
  }
  context.progress("expecting", 1);
  return list;
}

std::string text_of(const std::vector<Expectation>& expected, double noise_mm) {
  if (expected.empty()) return {};
  std::string text = fmt::format(
      "With {:g} mm of noise on each coordinate, one scan of each shape ({} corners) is expected "
      "to tell, to a standard deviation:\n  {:>8} {:>12} {:>14} {:>10}\n",
      noise_mm, expected.front().corners, "if ratio", "z_stretch", "ratio by", "poisson");
  for (const Expectation& e : expected)
    text += fmt::format("  {:>8g} {:>12.4f} {:>14} {:>10.3f}\n", e.truth.stiffness_ratio,
                        e.z_stretch, fmt::format("x {:.2f}", std::exp(e.ln_ratio)), e.poisson);
  return text;
}

nlohmann::ordered_json json_of(const std::vector<Expectation>& expected, double noise_mm) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Expectation& e : expected)
    list.push_back({{"ink_stiffness_ratio", e.truth.stiffness_ratio},
                    {"deviation",
                     {{"z_stretch", e.z_stretch},
                      {"ln_ink_stiffness_ratio", e.ln_ratio},
                      {"poisson", e.poisson}}}});
  return {{"noise_mm", noise_mm}, {"corners", expected.front().corners}, {"films", list}};
}

void require_enough_squares(const Board& board, const FilmOptions& film) {
  constexpr double kFewest = 8;
  const double side_mm = std::min(film.width_mm, film.height_mm) - 2 * film.margin_mm;
  if (side_mm < kFewest * board.square_mm)
    throw InputError(fmt::format(
        "--square {:g}: that are fewer than {:g} squares on the short side of the sheet "
        "({:g} mm without its margins), too few to tell anything; give at most {:.1f}",
        board.square_mm, kFewest, side_mm, std::floor(10 * side_mm / kFewest) / 10));
}

}  // namespace

JobResult kit_job(const JobConfig& config, const CalibrationRequest& request,
                  const RunContext& context) {
  const RunScope scope(context.with_threads(config.threads));
  require_no_correction_of_board(config);
  const Board board = board_named(request.board, request.square_mm);
  require_enough_squares(board, config.design.film);
  std::vector<CalibrationObject> objects;
  for (const std::string& text : request.scans)  // refuses what does not fit the film
    objects.push_back(calibration_object(text, config, context));
  const std::vector<Expectation> expected =
      expectations(objects, board, config, request.expected_noise_mm, context);
  OutputFolder folder(config.output, config.earlier_result);
  JobResult result;
  for (const KitShape& shape : kit_shapes()) {
    const std::string name = std::string(shape.name) + ".stl";
    write_stl(folder.path(name), kit_shape(shape), "hydrodip calibration shape, mm");
    result.files.push_back(name);
  }
  write_stl(folder.path("dome.stl"), dome_to_print(), "hydrodip calibration dome, mm");
  result.files.push_back("dome.stl");
  write_film(folder.path("checkerboard.pdf"), config, board, context);
  write_instructions(folder.path("instructions.pdf"), config, request.scans, board, context);
  write_film(folder.path("tear-film.pdf"), config, even_film(board.square_mm), context);
  result.files.insert(result.files.end(),
                      {"checkerboard.pdf", "tear-film.pdf", "instructions.pdf"});
  folder.announce(result.files, config.settings_files);
  context.check_cancelled();
  folder.commit();

  result.folder = config.output;
  result.text = folder.told_replaced();
  for (const std::string& file : result.files)
    result.text += fmt::format("wrote {}\n", (config.output / file).string());
  result.text += text_of(expected, request.expected_noise_mm);
  for (const std::string& warning : context.warnings())
    result.text += fmt::format("warning: {}\n", warning);
  nlohmann::ordered_json json = {
      {"folder", config.output.string()}, {"board", board.name}, {"files", result.files}};
  if (!expected.empty()) json["expected"] = json_of(expected, request.expected_noise_mm);
  result.json = json_answer("calibrate kit", json);
  return result;
}

}  // namespace hydrodip
