#include "job/dips_together.h"

#include <algorithm>
#include <utility>

#include "base/run_scope.h"
#include "ink/discoloration.h"
#include "job/dips_pictures.h"
#include "job/dips_report.h"
#include "job/ways.h"

namespace hydrodip {

bool all_dips_are_given(const JobConfig& config) {
  return std::all_of(config.dips.begin(), config.dips.end(), [](const DipEntry& dip) {
    return dip.rotate_deg.has_value() || dip.down.has_value() || !dip.path.empty();
  });
}

DipsTogether put_together(const JobConfig& config, const PreparedObject& prepared, int texture_px,
                          const RunContext& context) {
  const RunScope scope(context);
  require_no_correction(config);
  require_no_pattern(*prepared.paint);
  const Targets targets = job_targets(config, prepared, context);
  const DipPlan plan = plan_dips(config, prepared, targets, false, context);
  MadeDips all = hang_up(config, prepared, plan, context);
  Timings times;
  const Printer printer = make_printer(config.printer);
  const SharedSurface shared = divide(all, printer, times, context);
  const Finish finish = make_dips(all, shared, printer, times, context);
  const FinishCheck check(finish, shared, context);
  DipsTogether look;
  const std::vector<ReportInput> inputs;
  const RunContext quiet = context.quiet();
  look.dry = dry_layers_of(all);
  warn_of(look.dry, quiet);
  const JobRecord record{"print",
                         config,
                         prepared,
                         inputs,
                         finish,
                         times,
                         quiet,
                         &all.dips.front().made.ink,
                         printer.model->name()};
  look.report = report_on(all, shared, check, record);
  PaintedFinish painted = paint_finish(all, shared, finish, texture_px);
  look.colors = std::move(painted.colors);
  look.parts = std::move(painted.parts);
  for (std::size_t k = 0; k < all.dips.size(); ++k) {
    Inking& laid = all.dips[k].made.ink.ink.inking;
    look.sheets.push_back(look_on_film(std::move(laid.inks), laid.printed, *printer.model));
    look.color_of.push_back(dip_color(k));
  }
  return look;
}

}  // namespace hydrodip
