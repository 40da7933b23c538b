#include "job/sheet_of.h"

#include <cmath>
#include <numbers>

#include "dip/outlines.h"
#include "report/findings.h"

namespace hydrodip {

PrinterScale printer_of(const PrintOptions& print) {
  const double lean = std::tan(print.skew_deg * std::numbers::pi / 180);
  return {print.scale_x, print.scale_y, print.scale_y * lean};
}

bool makes_sheet(const std::string& command) { return command == "print" || command == "pattern"; }

std::string draft_alarm(const DesignOptions& options) {
  return is_draft(options) ? "DRAFT: not to be dipped through" : "";
}

SheetOptions sheet_of(const JobConfig& config) {
  SheetOptions sheet;
  sheet.width_mm = config.design.film.width_mm;
  sheet.height_mm = config.design.film.height_mm;
  sheet.margin_mm = config.design.film.margin_mm;
  sheet.dpi = config.design.dpi;
  sheet.disc = config.design.film.shape == FilmShape::kDisc;
  sheet.ink_side_up = config.print.ink_side == InkSide::kUp;
  sheet.camera_marks = config.print.camera_marks;
  sheet.printer = printer_of(config.print);
  sheet.job_name =
      config.print.job_name.empty() ? config.model.filename().string() : config.print.job_name;
  return sheet;
}

SheetOptions sheet_of(const JobConfig& config, const PosedObject& posed) {
  SheetOptions sheet = sheet_of(config);
  if (!config.print.outlines) return sheet;
  const TriangleMesh& mesh = posed.mesh();
  const DipOutlines dip = dip_outlines(make_trajectory(config.design.trajectory, mesh.positions),
                                       mesh.positions, mesh.triangles);
  // On the flat film, which may have swollen since it was printed.
  const Vec2 swelling(config.design.film.swelling_x, config.design.film.swelling_y);
  for (const auto& outline : {dip.first_touch, dip.full_depth})
    for (const auto& [a, b] : outline)
      sheet.outlines.push_back({a.cwiseQuotient(swelling), b.cwiseQuotient(swelling)});
  return sheet;
}

SheetOptions sheet_of(const JobConfig& config, const PosedObject& posed, const Report& report) {
  SheetOptions sheet = sheet_of(config, posed);
  if (concern_of(findings(report)) == Concern::kStop)
    sheet.alarm = "DO NOT DIP: " + short_verdict(report);
  else
    sheet.alarm = draft_alarm(config.design);
  return sheet;
}

}  // namespace hydrodip
