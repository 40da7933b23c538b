#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "artwork/drawing.h"
#include "artwork/fonts.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "hydrodip/hydrodip.h"
#include "job/computed.h"
#include "job/job_record.h"
#include "job/jobs.h"
#include "job/output.h"
#include "job/prepare.h"
#include "job/print_dips.h"
#include "job/sheet_of.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "plan/fit.h"
#include "plan/hold.h"
#include "plan/sheet_packing.h"
#include "render/preview.h"
#include "report/findings.h"
#include "report/html.h"
#include "session/appearance_of.h"
#include "session/sheet_files.h"
#include "settings/activator.h"
#include "settings/params.h"

namespace hydrodip {
namespace {

using json = nlohmann::ordered_json;

// Film between the object and the tape: the less there is, the more it is stretched, and tears. As
// much as the sheet has room for, from the least to enough.
constexpr double kLeastClearance_mm = 10, kLeastClearancePerDepth = 0.25;
constexpr double kEnoughClearance_mm = 30, kEnoughClearancePerDepth = 1.5;
constexpr int kClearances = 32;  // tried between the two
// Lines to cut along, and what is written beside them, in the taped margin.
constexpr double kLine_mm = 0.2, kLabel_mm = 3, kTick_mm = 3;

// A part on a piece of film of its own.
struct Part {
  ReadyJob job;
  Room room;  // that its wet part takes
  int count = 1;
  std::filesystem::path file;  // its job's, or the model's

  std::string name() const { return file.filename().string(); }
  const FilmOptions& film() const { return job.config.design.film; }
};

// What is printed for it, and what is to be said of its dip.
struct MadePart {
  DesignedJob made;
  Report report;

  const Coverage& coverage() const { return *report.coverage; }
  Concern concern() const { return concern_of(findings(report)); }
  bool is_not_to_be_dipped() const { return concern() == Concern::kStop; }
  std::string verdict() const { return headline(concern()) + ". " + verdict_of(report); }
};

// One piece of the sheet.
struct Piece {
  std::size_t part;
  int number;  // from 1, over all
  PackedPiece place;
};

struct Nest {
  std::vector<Part> parts;
  std::vector<Piece> pieces;
  std::vector<MadePart> made;  // per part
};

Vec2 film_size(const FilmOptions& film) { return {film.width_mm, film.height_mm}; }

// From the least, at 0, to enough, at 1.
double clearance_mm(double depth_mm, double amount) {
  const double least = std::max(kLeastClearance_mm, kLeastClearancePerDepth * depth_mm);
  const double enough = std::max(kEnoughClearance_mm, kEnoughClearancePerDepth * depth_mm);
  return least + amount * (enough - least);
}

// The piece of an object: itself, free film, tape.
FilmOptions piece_for(const Room& room, const FilmOptions& sheet, double clearance) {
  FilmOptions piece = sheet;
  piece.shape = FilmShape::kRectangle;
  piece.width_mm = std::ceil(2 * (room.half_width_mm + clearance + sheet.margin_mm));
  piece.height_mm = std::ceil(2 * (room.half_height_mm + clearance + sheet.margin_mm));
  return piece;
}

// One sheet is printed and laid on the water in one way.
void require_the_sheets_own(const JobConfig& config, const JobConfig& sheet,
                            const std::string& name) {
  static const auto kOfTheSheet = std::to_array<const char*>(
      {"print.ink_side", "print.scale_x", "print.scale_y", "print.skew_deg", "print.color",
       "print.dpi", "ink.model", "ink.profile", "ink.intent", "film.swelling_x", "film.swelling_y",
       "film.margin_mm", "film.shape"});
  for (const char* of_sheet : kOfTheSheet) {
    const Parameter& p = find_parameter(of_sheet, "nest");
    const ParameterValue value = p.get(config);
    if (value == p.get(sheet) || value == p.default_value()) continue;
    throw InputError(
        fmt::format("{}: {} = {} holds for the whole sheet: give it to nest itself (--set, "
                    "--profile or --config), or take it out of the part's job",
                    name, of_sheet, show_value(p, value)));
  }
}

Part prepare_part(const NestRequest::Part& wanted, const JobConfig& sheet, const Printer& printer,
                  const RunContext& context) {
  JobConfig config = wanted.config;
  for (const std::filesystem::path& correction : {config.correction, sheet.correction})
    if (!correction.empty())
      throw InputError(fmt::format(
          "{}: a correction is of one dip on a sheet of its own, and parts that share a sheet get "
          "pieces of other sizes; leave it out, or print the part by itself",
          correction.string()));
  require_one_dip(config, "a part gets one piece of film; print it by itself");
  require_the_sheets_own(config, sheet, wanted.file.filename().string());
  config.printer = sheet.printer;
  config.design.dpi = sheet.design.dpi;
  PreparedObject prepared = prepare_object(config.model, config.object, context, config.design.dpi,
                                           config.design.inverse.samples_per_axis);
  require_appearance(prepared, config.model);
  find_what_is_asked(config, prepared, context);
  const TriangleMesh& mesh = prepared.posed.mesh();
  Trajectory trajectory = make_trajectory(config.design.trajectory, mesh.positions);
  const Room room = room_of(mesh, trajectory);
  return {{std::move(config), std::move(prepared), std::move(trajectory), printer},
          room,
          wanted.count,
          wanted.file};
}

void cut_pieces(std::vector<Part>& parts, const FilmOptions& sheet, double amount,
                std::optional<double> given_mm) {
  for (Part& part : parts)
    part.job.config.design.film = piece_for(
        part.room, sheet, given_mm ? *given_mm : clearance_mm(part.room.depth_mm, amount));
}

// As far as they find room.
std::vector<Piece> place(const std::vector<Part>& parts, const FilmOptions& sheet) {
  std::vector<Piece> pieces;
  std::vector<Vec2> sizes;
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (int n = 0; n < parts[p].count; ++n) {
      pieces.push_back({p, int(pieces.size()) + 1, {}});
      sizes.push_back(film_size(parts[p].film()));
    }
  const Vec2 room = film_size(sheet) - 2 * Vec2::Constant(sheet.margin_mm);
  const std::vector<PackedPiece> places = pack_pieces(sizes, room);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].place = places[i];
    pieces[i].place.corner_mm += Vec2::Constant(sheet.margin_mm);
  }
  return pieces;
}

const Piece* first_left_out(const std::vector<Piece>& pieces) {
  for (const Piece& piece : pieces)
    if (!piece.place.placed) return &piece;
  return nullptr;
}

// Sizes the pieces and places them.
void share_out_film(Nest& nest, const FilmOptions& sheet, std::optional<double> given_mm,
                    const RunContext& context) {
  for (int k = given_mm ? 0 : kClearances; k >= 0; --k) {
    cut_pieces(nest.parts, sheet, double(k) / kClearances, given_mm);
    nest.pieces = place(nest.parts, sheet);
    if (!first_left_out(nest.pieces)) break;
    context.check_cancelled();
  }
  if (const Piece* left_out = first_left_out(nest.pieces)) {
    const Part& part = nest.parts[left_out->part];
    throw InputError(fmt::format(
        "the film of {:g} x {:g} mm holds {} of the {} parts ({} needs a piece of {:.0f} x {:.0f} "
        "mm); take a larger --film, fewer parts, or less --clearance",
        sheet.width_mm, sheet.height_mm,
        std::count_if(nest.pieces.begin(), nest.pieces.end(),
                      [](const Piece& piece) { return piece.place.placed; }),
        nest.pieces.size(), part.name(), part.film().width_mm, part.film().height_mm));
  }
  for (const Part& part : nest.parts) {
    require_fit(part.job.prepared.posed.size_mm(), part.room, part.film(), part.job.config.bath,
                context);
    require_on_film(part.job.prepared, part.film());
  }
}

// ---- the parts' dips ----

MadePart make_part(const Part& part, Timings& timings, const RunContext& context) {
  const ReadyJob& job = part.job;
  DesignedJob made = designed(job, {.wanted = false, .stretch = false}, timings, context);
  const RunContext silent = context.quiet();
  const std::vector<ReportInput> inputs;
  JobRecord record{"print", job.config,         job.prepared,
                   inputs,  made.finish,        timings,
                   silent,  &made.designed.ink, job.printer.model->name()};
  record.wanted = wanted_coverage(made.designed.dipped, *job.prepared.paint,
                                  doubtful_stretch(job.config.design.dip.material));
  for (const DryLayer& layer : dry_layers(job.prepared.artwork, made.designed.dipped)) {
    silent.warn(layer.told);  // for the report
    context.warn(part.name() + ": " + layer.told);
  }
  Report report = make_report(record);
  return {std::move(made), std::move(report)};
}

void make_parts(Nest& nest, const RunContext& context) {
  Timings timings;
  for (const Part& part : nest.parts) {
    nest.made.push_back(make_part(part, timings, context));
    const MadePart& made = nest.made.back();
    if (made.is_not_to_be_dipped())
      context.warn(fmt::format("{}: do not dip it like this: {}; 'hydrodip plan' looks for ways.",
                               part.name(), short_verdict(made.report)));
  }
}

// "2, 3"
std::string not_to_be_dipped(const Nest& nest) {
  std::string numbers;
  for (const Piece& piece : nest.pieces)
    if (nest.made[piece.part].is_not_to_be_dipped())
      numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", piece.number);
  return numbers;
}

// ---- the sheet ----

// A rectangle of pixels on the sheet, and how a piece's own pixels lie in it.
class PieceOnSheet {
 public:
  PieceOnSheet(const Piece& piece, const SheetRaster& own, const SheetRaster& sheet)
      : width_(own.width_px()), height_(own.height_px()), turned_(piece.place.turned) {
    const double pixel_mm = kMmPerInch / sheet.dpi;
    left_ = int(std::lround(piece.place.corner_mm.x() / pixel_mm));
    const int bottom = int(std::lround(piece.place.corner_mm.y() / pixel_mm));
    left_ = std::clamp(left_, 0, std::max(0, sheet.width_px() - wide()));
    top_ =
        std::clamp(sheet.height_px() - bottom - high(), 0, std::max(0, sheet.height_px() - high()));
  }
  int wide() const { return turned_ ? height_ : width_; }
  int high() const { return turned_ ? width_ : height_; }

  // Copies what is printed of the piece. Turned: its right edge is up on the sheet.
  void copy(const Inking& from, Inking& sheet) const {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        if (!from.printed.contains(x, y)) continue;
        const int to_x = left_ + (turned_ ? y : x);
        const int to_y = top_ + (turned_ ? width_ - 1 - x : y);
        if (to_x >= sheet.inks.width_px || to_y >= sheet.inks.height_px) continue;
        std::copy_n(from.inks.pixel(x, y), 4, sheet.inks.pixel(to_x, to_y));
        sheet.printed.insert(to_x, to_y);
      }
  }

 private:
  int width_, height_;
  bool turned_;
  int left_ = 0, top_ = 0;
};

// Black on a piece: where `alpha` says so.
void blacken(Inking& laid, int x, int y, std::uint8_t alpha) {
  if (alpha == 0 || x < 0 || y < 0 || x >= laid.inks.width_px || y >= laid.inks.height_px) return;
  std::uint8_t* inks = laid.inks.pixel(x, y);
  inks[3] = std::max(inks[3], alpha);
  laid.printed.insert(x, y);
}

// What is needed to cut a piece out and to know it again.
void mark_piece(Inking& laid, const std::string& label, double margin_mm, double dpi) {
  const int width = laid.inks.width_px, height = laid.inks.height_px;
  const double pixels_per_mm = dpi / kMmPerInch;
  const int line = std::max(1, int(std::lround(kLine_mm * pixels_per_mm)));
  for (int x = 0; x < width; ++x)
    for (int k = 0; k < line; ++k) {
      blacken(laid, x, k, 255);
      blacken(laid, x, height - 1 - k, 255);
    }
  for (int y = 0; y < height; ++y)
    for (int k = 0; k < line; ++k) {
      blacken(laid, k, y, 255);
      blacken(laid, width - 1 - k, y, 255);
    }
  // Where the object's middle belongs.
  const int tick = int(std::min(kTick_mm, 0.5 * margin_mm) * pixels_per_mm);
  for (int k = 0; k < tick; ++k)
    for (int across = 0; across < line; ++across) {
      blacken(laid, width / 2 + across, k, 255);
      blacken(laid, width / 2 + across, height - 1 - k, 255);
      blacken(laid, k, height / 2 + across, 255);
      blacken(laid, width - 1 - k, height / 2 + across, 255);
    }
  if (margin_mm < kLabel_mm + 2) return;
  const Drawing text = Drawing::from_text(label, "sans bold", {0, 0, 0, 1});
  double high_mm = kLabel_mm, wide_mm = high_mm * text.aspect();
  const double room_mm = width / pixels_per_mm - 4;
  if (wide_mm > room_mm) {
    high_mm *= room_mm / wide_mm;
    wide_mm = room_mm;
  }
  const Image letters = text.pixels(std::max(1, int(wide_mm * pixels_per_mm)),
                                    std::max(1, int(high_mm * pixels_per_mm)));
  const int left = (width - letters.width_px) / 2;
  const int top = height - int((0.5 * margin_mm + 0.5 * high_mm) * pixels_per_mm);
  for (int y = 0; y < letters.height_px; ++y)
    for (int x = 0; x < letters.width_px; ++x)
      blacken(laid, left + x, top + y, letters.pixel(x, y)[3]);
}

std::string label_of(const Piece& piece, const Nest& nest) {
  return fmt::format("{}: {}{}", piece.number, nest.parts[piece.part].file.stem().string(),
                     nest.made[piece.part].is_not_to_be_dipped() ? " - DO NOT DIP" : "");
}

Inking whole_sheet(const Nest& nest, const SheetRaster& sheet) {
  Inking whole = no_ink(sheet.width_px(), sheet.height_px());
  for (const Piece& piece : nest.pieces) {
    const Designed& designed = nest.made[piece.part].made.designed;
    Inking own = designed.ink.ink.inking;
    mark_piece(own, label_of(piece, nest), nest.parts[piece.part].film().margin_mm, sheet.dpi);
    const PieceOnSheet on(piece, designed.raster, sheet);
    on.copy(own, whole);
  }
  return whole;
}

// ---- the run sheet ----

json described(const Nest& nest) {
  json list = json::array();
  for (const Piece& piece : nest.pieces) {
    const Part& part = nest.parts[piece.part];
    const MadePart& made = nest.made[piece.part];
    const Coverage& coverage = made.coverage();
    list.push_back({{"number", piece.number},
                    {"model", part.job.config.model.string()},
                    {"from_left_mm", piece.place.corner_mm.x()},
                    {"from_bottom_mm", piece.place.corner_mm.y()},
                    {"width_mm", part.film().width_mm},
                    {"height_mm", part.film().height_mm},
                    {"turned", piece.place.turned},
                    {"depth_mm", part.job.trajectory.depth_mm()},
                    {"covered_downward_share", coverage.covered_downward_share()},
                    {"torn_share", coverage.torn_share()},
                    {"concern", concern_name(made.concern())},
                    {"verdict", verdict_of(made.report)}});
  }
  return list;
}

std::string covered_words(const Report& report) {
  return report.wanted
             ? fmt::format("{:.0f} % of the picture", 100 * report.wanted->covered_share())
             : fmt::format("{:.0f} % of the object", 100 * report.coverage->covered_share());
}

// "Pieces 1, 2"
std::string pieces_of(const Nest& nest, std::size_t part) {
  std::vector<int> numbers;
  for (const Piece& piece : nest.pieces)
    if (piece.part == part) numbers.push_back(piece.number);
  return fmt::format("{} {}", numbers.size() == 1 ? "Piece" : "Pieces", fmt::join(numbers, ", "));
}

// What is the same for all of them.
std::string bench_figures(const JobConfig& sheet) {
  const ProcessOptions& process = sheet.process;
  return fmt::format(
      "<p>Each: water {} °C; film on the water, ink side {}, {} s until it lies flat; {}dip at "
      "{:g} mm/min; hold {:g} s at least; clear the water; lift at {:g} mm/min; rinse; dry{}.</p>",
      span_in_words(process.water_min_c, process.water_max_c),
      sheet.print.ink_side == InkSide::kUp ? "up" : "down",
      span_in_words(process.soak_min_s, process.soak_max_s),
      process.activator_g > 0 ? fmt::format("activator; wait {:g} s; ", process.activator_wait_s)
                              : "",
      process.speed_mm_per_min, process.dwell_s, process.lift_mm_per_min,
      process.dry_max_h > 0 ? " " + span_in_words(process.dry_min_h, process.dry_max_h) + " h"
                            : "");
}

std::string how_to_dip(const Part& part, const ProcessOptions& process) {
  const Activator activator = activator_for(process, part.film());
  const PoseOptions& pose = part.job.config.object.pose;
  return fmt::format("It hangs {} ({}), {:.1f} mm deep at the end. Activator: {}.",
                     describe_hold(pose, way_up(part.job.config)), hold_options(pose),
                     part.job.trajectory.depth_mm(), in_words(activator));
}

// On the sheet as it is printed, which is mirrored if its ink goes down onto the water.
double from_left_mm(const Piece& piece, const Part& part, const JobConfig& sheet) {
  const double x_mm = piece.place.corner_mm.x();
  if (sheet.print.ink_side == InkSide::kUp) return x_mm;
  const double wide_mm = piece.place.turned ? part.film().height_mm : part.film().width_mm;
  return sheet.design.film.width_mm - x_mm - wide_mm;
}

std::string run_sheet(const Nest& nest, const JobConfig& sheet) {
  const bool up = sheet.print.ink_side == InkSide::kUp;
  std::string page = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>hydrodip run sheet</title>"
      "<style>body{{font:16px sans-serif;margin:2em}}td,th{{padding:.3em .8em;text-align:left;"
      "border-bottom:1px solid #ccc}}img{{max-height:24em;border:1px solid #ccc}}"
      ".stop{{color:#b00020}}.wide{{overflow-x:auto}}img{{max-width:100%}}</style>"
      "<h1>Run sheet: {} parts on one film of {:g} x {:g} mm</h1>"
      "<p>Print print.pdf at 100 %, cut along the lines, tape each piece over {:g} mm all around, "
      "and dip each part on its own piece, over the middle between its four ticks, with the "
      "piece's "
      "writing towards you.</p>"
      "{}{}<p><img src=\"print.png\" alt=\"the sheet\"></p>"
      "<div class=\"wide\"><table><tr><th>piece<th>part<th>from the left edge<th>from the lower "
      "edge<th>size<th>writing "
      "on the sheet<th>depth of the dip<th>covered<th>torn<th>verdict</tr>",
      nest.pieces.size(), sheet.design.film.width_mm, sheet.design.film.height_mm,
      sheet.design.film.margin_mm,
      is_draft(sheet.design)
          ? "<p class=\"stop\">" + html_escaped(draft_alarm(sheet.design)) + "</p>"
          : "",
      up ? ""
         : "<p>The sheet is printed mirrored: its ink goes down onto the water, and through "
           "the film the writing reads as it should. Places below are those on the print.</p>");
  for (const Piece& piece : nest.pieces) {
    const Part& part = nest.parts[piece.part];
    const MadePart& made = nest.made[piece.part];
    page += fmt::format(
        "<tr><td>{}<td>{}<td>{:.0f} mm<td>{:.0f} mm<td>{:g} x {:g} mm<td>{}<td>{:.1f} "
        "mm<td>{}<td>{:.1f} %<td class=\"{}\">{}</tr>",
        piece.number, html_escaped(part.name()), from_left_mm(piece, part, sheet),
        piece.place.corner_mm.y(), part.film().width_mm, part.film().height_mm,
        !piece.place.turned ? "below"
        : up                ? "upright, on the right"
                            : "upright, on the left",
        part.job.trajectory.depth_mm(), covered_words(made.report),
        100 * made.coverage().torn_share(), concern_name(made.concern()), headline(made.concern()));
  }
  page += "</table></div>";
  page += bench_figures(sheet);
  for (std::size_t p = 0; p < nest.parts.size(); ++p)
    page += fmt::format(
        "<h2>{}: {}</h2><p class=\"{}\">{}</p><p>{}</p><img src=\"part-{}.png\" alt=\"wanted and "
        "predicted\">",
        pieces_of(nest, p), html_escaped(nest.parts[p].name()),
        concern_name(nest.made[p].concern()), html_escaped(nest.made[p].verdict()),
        html_escaped(how_to_dip(nest.parts[p], sheet.process)), p + 1);
  return page + "</html>\n";
}

// Whatever side it is dipped with, people know it upright.
Image as_it_stands(const Part& part, const MadePart& made, int width_px,
                   const RunContext& context) {
  const DippedObject& dipped = made.made.designed.dipped;
  PreviewOptions options;
  options.width_px = width_px;
  options.base = made.made.finish.paint().base();
  options.standing = standing_of(dipped.posed, way_up(part.job.config));
  std::vector<PreviewPair> pairs(1);
  pairs[0].shown = appearance_of(made.made.finish);
  return render_previews(dipped.posed.mesh(), dipped.posed.surface(), *dipped.film, pairs, options,
                         context)
      .front();
}

SheetOptions sheet_options(const JobConfig& config, const Nest& nest) {
  SheetOptions sheet = sheet_of(config);
  // Of pieces that are cut out nobody finds the sheet's own rim and marks.
  sheet.disc = sheet.camera_marks = false;
  if (config.print.job_name.empty()) sheet.job_name = fmt::format("{} parts", nest.pieces.size());
  const std::string bad = not_to_be_dipped(nest);
  sheet.alarm = bad.empty() ? draft_alarm(config.design) : "DO NOT DIP " + bad;
  return sheet;
}

std::vector<std::string> file_names(std::size_t parts) {
  std::vector<std::string> names = {"print.pdf", "print.png", "print.tif", "nest.html",
                                    "nest.json"};
  for (std::size_t p = 0; p < parts; ++p) names.push_back(fmt::format("part-{}.png", p + 1));
  return names;
}

}  // namespace

JobResult nest_job(const JobConfig& sheet, const NestRequest& request, const RunContext& context) {
  const RunScope scope(context.with_threads(sheet.threads));
  require_memory(sheet.design, sheet.design.film.width_mm * sheet.design.film.height_mm);
  warn_if_draft(sheet.design, context);
  require_fonts("the pieces' names");
  if (sheet.design.film.shape == FilmShape::kDisc)
    throw InputError(
        "film.shape: parts share a rectangular sheet, and this is a disc; leave the shape out, or "
        "print each part by itself");
  OutputFolder folder(sheet.output, sheet.earlier_result);
  const Printer printer = make_printer(sheet.printer);
  Nest nest;
  std::vector<std::filesystem::path> inputs;
  for (const NestRequest::Part& part : request.parts) {
    nest.parts.push_back(prepare_part(part, sheet, printer, context));
    const auto& files = nest.parts.back().job.prepared.files;
    inputs.insert(inputs.end(), files.begin(), files.end());
  }
  folder.announce(file_names(nest.parts.size()), inputs);
  std::vector<std::string> others = prints();
  others.insert(others.end(), {"report.json", "report.html"});
  folder.supersede(others);
  share_out_film(nest, sheet.design.film, request.clearance_mm, context);

  make_parts(nest, context);
  Inking whole = whole_sheet(nest, raster_of(sheet.design.film, sheet.design.dpi));
  write_sheet_files(folder, std::move(whole.inks), whole.printed, printer,
                    sheet_options(sheet, nest), context);
  for (std::size_t p = 0; p < nest.parts.size(); ++p)
    write_png(folder.path(fmt::format("part-{}.png", p + 1)),
              as_it_stands(nest.parts[p], nest.made[p], sheet.preview_width_px, context));
  const json report = {{"schema_version", 1},
                       {"command", "nest"},
                       {"film_mm", {sheet.design.film.width_mm, sheet.design.film.height_mm}},
                       {"pieces", described(nest)},
                       {"warnings", context.warnings()}};
  const std::string text = json_text(report);
  write_file(folder.path("nest.json"), text);
  write_file(folder.path("nest.html"), run_sheet(nest, sheet));
  context.check_cancelled();
  folder.commit();

  JobResult result;
  result.folder = folder.folder();
  result.files = file_names(nest.parts.size());
  result.json = text;
  result.do_not_dip = !not_to_be_dipped(nest).empty();
  result.text = folder.told_replaced();
  for (std::size_t p = 0; p < nest.parts.size(); ++p)
    result.text += fmt::format("{}: {}\n", nest.parts[p].name(), nest.made[p].verdict());
  result.text += fmt::format(
      "wrote to {}:\n  print.pdf    the sheet with {} pieces: print it at 100 % (no scaling)\n"
      "  print.png    what the sheet will look like\n  print.tif    its inks\n"
      "  nest.html    the run sheet: which part where\n  nest.json    the same for programs\n",
      folder.folder().string(), nest.pieces.size());
  for (const std::string& warning : context.warnings()) result.text += "warning: " + warning + "\n";
  return result;
}

}  // namespace hydrodip
