#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "artwork/fonts.h"
#include "base/error.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "hydrodip/hydrodip.h"
#include "ink/printer.h"
#include "job/jobs.h"
#include "job/nest.h"
#include "job/nest_parts.h"
#include "job/nest_run_sheet.h"
#include "job/nest_sheet.h"
#include "job/output.h"
#include "job/prepare.h"
#include "session/sheet_files.h"
#include "sheet/page_text.h"
#include "transfer/raster.h"

namespace hydrodip {
namespace {

void require_sheet(const DesignOptions& design, const RunContext& context) {
  require_memory(design, design.film.width_mm * design.film.height_mm);
  warn_if_draft(design, context);
  require_fonts("the pieces' names");
  if (design.film.shape == FilmShape::kDisc)
    throw InputError(
        "film.shape: parts share a rectangular sheet, and this is a disc; leave the shape out, or "
        "print each part by itself");
}

std::string picture_name(std::size_t part) { return fmt::format("part-{}.png", part + 1); }

std::vector<std::string> file_names(const Nest& nest) {
  std::vector<std::string> names = {"print.pdf", "print.png", "print.tif", "nest.html",
                                    "nest.json"};
  for (std::size_t p = 0; p < nest.parts.size(); ++p) names.push_back(picture_name(p));
  return names;
}

void announce(OutputFolder& folder, const Nest& nest) {
  std::vector<std::filesystem::path> inputs;
  for (const NestPart& part : nest.parts)
    inputs.insert(inputs.end(), part.job.prepared.files.begin(), part.job.prepared.files.end());
  folder.announce(file_names(nest), inputs);
  std::vector<std::string> others = prints();
  others.insert(others.end(), {"report.json", "report.html"});
  folder.supersede(others);
}

JobResult result_of(const Nest& nest, const OutputFolder& folder, std::string report,
                    const RunContext& context) {
  JobResult result;
  result.folder = folder.folder();
  result.files = file_names(nest);
  result.json = std::move(report);
  result.do_not_dip = !not_to_be_dipped(nest).empty();
  result.text = folder.told_replaced();
  for (std::size_t p = 0; p < nest.parts.size(); ++p)
    result.text += fmt::format("{}: {}\n", nest.parts[p].name(), nest.made[p].verdict());
  result.text += fmt::format(
      "wrote to {}:\n  print.pdf    the sheet with {} {}: print it at 100 % (no scaling)\n"
      "  print.png    what the sheet will look like\n  print.tif    its inks\n"
      "  nest.html    the run sheet: which part where\n  nest.json    the same for programs\n",
      folder.folder().string(), nest.pieces.size(), nest.pieces.size() == 1 ? "piece" : "pieces");
  for (const std::string& warning : context.warnings()) result.text += "warning: " + warning + "\n";
  return result;
}

}  // namespace

JobResult nest_job(const JobConfig& sheet, const NestRequest& request, const RunContext& context) {
  const RunScope scope(context.with_threads(sheet.threads));
  require_sheet(sheet.design, context);
  OutputFolder folder(sheet.output, sheet.earlier_result);
  const Printer printer = make_printer(sheet.printer);
  Nest nest;
  for (const NestRequest::Part& part : request.parts)
    nest.parts.push_back(prepare_part(part, sheet, printer, context));
  announce(folder, nest);
  share_out_film(nest, sheet.design.film, request.clearance_mm, context);
  nest.made = make_parts(nest.parts, context);

  for (const NestPart& part : nest.parts)
    warn_of_lost_letters("a part's name", part.file.stem().string(), "the sheet", context);
  Inking whole = whole_sheet(nest, raster_of(sheet.design.film, sheet.design.dpi));
  write_sheet_files(folder, std::move(whole.inks), whole.printed, printer, sheet_of(sheet, nest),
                    context);
  for (std::size_t p = 0; p < nest.parts.size(); ++p)
    write_png(folder.path(picture_name(p)),
              as_it_stands(nest.parts[p], nest.made[p], sheet.preview_width_px, context));
  std::string report = nest_json(nest, sheet, context);
  write_file(folder.path("nest.json"), report);
  write_file(folder.path("nest.html"), nest_run_sheet(nest, sheet));
  context.check_cancelled();
  folder.commit();
  return result_of(nest, folder, std::move(report), context);
}

}  // namespace hydrodip
