#include "history/history_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

struct CostedRun {
  DipRun run;
  DipUse use;
  bool print_known = true;  // false: charged by today's print
};

struct Totals {
  int dips = 0, good = 0, failed = 0, not_judged = 0;
  int without_ink = 0;  // dips whose print does not say how much ink is laid
  DipUse use;
  double judged_cost = 0;  // of the good and the failed ones

  // With what failed; whether what is not judged is a piece is not known.
  std::optional<double> cost_of_good_piece() const {
    return good > 0 ? std::optional(judged_cost / good) : std::nullopt;
  }
};

bool is_priced(const CostOptions& cost) {
  return cost.film_per_m2 > 0 || cost.ink_per_ml > 0 || cost.activator_per_g > 0 ||
         cost.per_piece > 0;
}

bool is_judged(const DipRun& run) { return run.outcome == "good" || run.outcome == "failed"; }

// A run that was given up before film lay on the water used none.
bool used_film(const DipRun& run) {
  return is_judged(run) || run.outcome == "done" || run.soak_s || run.activator_g;
}

// Each by the print that it was dipped with, which may be none of today's.
std::vector<CostedRun> costed(std::vector<DipRun> runs, const History& history, const RigJob& job) {
  std::vector<CostedRun> list;
  for (DipRun& run : runs) {
    std::optional<SheetUse> sheet = job.sheet;
    bool known = run.report_sha256 == job.report_sha256;
    if (!known) {
      sheet = sheet_use(history.report(run.report_sha256));
      known = sheet.has_value();
    }
    const DipUse use = use_of(run, sheet.value_or(job.sheet), job.config.cost);
    list.push_back({std::move(run), use, known});
  }
  return list;
}

Totals totals_of(const std::vector<CostedRun>& runs) {
  Totals totals;
  for (const auto& [run, use, known] : runs) {
    if (!used_film(run)) continue;
    ++totals.dips;
    ++(run.outcome == "good"     ? totals.good
       : run.outcome == "failed" ? totals.failed
                                 : totals.not_judged);
    totals.use.film_m2 += use.film_m2;
    if (use.ink_ml)
      *totals.use.ink_ml += *use.ink_ml;
    else
      ++totals.without_ink;
    totals.use.activator_g += use.activator_g;
    totals.use.cost += use.cost;
    if (is_judged(run)) totals.judged_cost += use.cost;
  }
  if (totals.dips > 0 && totals.without_ink == totals.dips) totals.use.ink_ml.reset();
  return totals;
}

// As it fits into a line of a table.
std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](const char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

std::string or_dash(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

std::string money(double value, const CostOptions& cost) {
  return fmt::format("{:.2f}{}{}", value, cost.currency.empty() ? "" : " ", cost.currency);
}

// Where the film lay, off its place: to the right, to the top.
std::string off_place(const DipRun& run) {
  if (!run.registration_x_mm || !run.registration_y_mm) return "-";
  return fmt::format("{:+.2f} {:+.2f}", *run.registration_x_mm, *run.registration_y_mm);
}

std::string table(const std::vector<CostedRun>& runs, const RigJob& job) {
  const bool priced = is_priced(job.config.cost);
  const bool registered = std::ranges::any_of(
      runs, [](const CostedRun& costed) { return off_place(costed.run) != "-"; });
  std::string text = fmt::format(
      "{:<9} {:<17} {:<10} {:<10} {:<10} {:>11} {:>6} {:>11}{}{}  notes\n", "run", "begun (UTC)",
      "batch", "label", "outcome", "water C", "soak s", "activator g",
      registered ? fmt::format(" {:>15}", "film off x y mm") : "", priced ? "      cost" : "");
  for (const auto& [run, use, known] : runs) {
    const std::string water =
        or_dash(run.water_before_c, 1) +
        (run.water_after_c ? " to " + or_dash(run.water_after_c, 1) : std::string());
    text += fmt::format("{:<9} {:<17} {:<10} {:<10} {:<10} {:>11} {:>6} {:>11}", run.id,
                        run.started_utc.substr(0, 16), run.batch, run.label, run.outcome, water,
                        or_dash(run.soak_s, 0), or_dash(run.activator_g, 1));
    if (registered) text += fmt::format(" {:>15}", off_place(run));
    if (priced) text += fmt::format(" {:>9.2f}", use.cost);
    text += run.notes.empty() ? "\n" : "  " + in_one_line(run.notes) + "\n";
  }
  return text;
}

std::string dips_of(int count) { return fmt::format("{} dip{}", count, count == 1 ? "" : "s"); }

std::string ink_text(const Totals& totals) {
  if (!totals.use.ink_ml) return "ink not known";
  std::string text = fmt::format("about {:.2f} ml of ink", *totals.use.ink_ml);
  if (totals.without_ink > 0)
    text += fmt::format(" (without that of {}, not known)", dips_of(totals.without_ink));
  return text;
}

std::string sum(const Totals& totals, const RigJob& job) {
  const CostOptions& cost = job.config.cost;
  std::string text = fmt::format(
      "\n{}: {} good, {} failed, {} not judged ('--run RUN --outcome good' or failed)\n"
      "used: {:.3f} m2 of film, {}, {:.1f} g of activator\n",
      dips_of(totals.dips), totals.good, totals.failed, totals.not_judged, totals.use.film_m2,
      ink_text(totals), totals.use.activator_g);
  if (!is_priced(cost))
    return text + "no prices are set: --set cost.film_per_m2=..., or in a profile\n";
  text += fmt::format("cost: {}", money(totals.use.cost, cost));
  if (const auto piece = totals.cost_of_good_piece()) {
    text += fmt::format("; a good piece: {}", money(*piece, cost));
    if (totals.not_judged > 0)
      text += fmt::format(" (without {} not judged)", dips_of(totals.not_judged));
  }
  if (cost.ink_per_ml > 0 && totals.without_ink > 0)
    text += fmt::format("; without the ink of {}, of which the print does not say how much",
                        dips_of(totals.without_ink));
  return text + "\n";
}

// What the figures above are to be taken with.
std::string reservations(const std::vector<CostedRun>& runs, const History& history) {
  std::string text;
  std::string by_todays;
  for (const CostedRun& costed : runs)
    if (!costed.print_known && used_film(costed.run))
      by_todays += (by_todays.empty() ? "" : ", ") + costed.run.id;
  if (!by_todays.empty())
    text += fmt::format(
        "the prints that these were dipped with were not kept, and today's stands for them: {}\n",
        by_todays);
  for (const std::string& run : history.unread())
    text += fmt::format(
        "{}: its log.jsonl is empty or damaged, so that it is not in the history; '--add' tells of "
        "a dip that it was\n",
        run);
  return text;
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json json_of(const CostedRun& costed, const RigJob& job) {
  const auto& [run, use, known] = costed;
  return {{"run", run.id},
          {"started_utc", run.started_utc},
          {"report_sha256", run.report_sha256},
          {"same_print", run.report_sha256 == job.report_sha256},
          {"batch", run.batch},
          {"label", run.label},
          {"outcome", run.outcome},
          {"water_before_c", or_null(run.water_before_c)},
          {"water_after_c", or_null(run.water_after_c)},
          {"soak_s", or_null(run.soak_s)},
          {"activator_g", or_null(run.activator_g)},
          {"registration_x_mm", or_null(run.registration_x_mm)},
          {"registration_y_mm", or_null(run.registration_y_mm)},
          {"registration_deg", or_null(run.registration_deg)},
          {"notes", run.notes},
          {"film_m2", use.film_m2},
          {"ink_ml", or_null(use.ink_ml)},
          {"print_known", known},
          {"cost", use.cost}};
}

std::string json_of(const std::vector<CostedRun>& runs, const Totals& totals, const RigJob& job,
                    const History& history) {
  Json list = Json::array();
  for (const CostedRun& run : runs) list.push_back(json_of(run, job));
  return json_answer("history",
                     {{"job", job.folder.string()},
                      {"title", job.title},
                      {"currency", job.config.cost.currency},
                      {"runs", list},
                      {"unread_runs", history.unread()},
                      {"totals",
                       {{"dips", totals.dips},
                        {"good", totals.good},
                        {"failed", totals.failed},
                        {"not_judged", totals.not_judged},
                        {"film_m2", totals.use.film_m2},
                        {"ink_ml", or_null(totals.use.ink_ml)},
                        {"dips_without_ink", totals.without_ink},
                        {"activator_g", totals.use.activator_g},
                        {"cost", totals.use.cost},
                        {"cost_per_good_piece", or_null(totals.cost_of_good_piece())}}}});
}

// Those of one batch; empty: all.
std::vector<DipRun> of_batch(std::vector<DipRun> runs, const std::string& batch) {
  if (batch.empty()) return runs;
  std::vector<std::string> known;
  for (const DipRun& run : runs)
    if (!run.batch.empty() && std::ranges::find(known, run.batch) == known.end())
      known.push_back(run.batch);
  std::erase_if(runs, [&](const DipRun& run) { return run.batch != batch; });
  if (runs.empty())
    throw InputError(fmt::format(
        "no dip of this job is of batch '{}'; {}", batch,
        known.empty() ? "none has a batch" : fmt::format("there are: {}", fmt::join(known, ", "))));
  return runs;
}

// What else is asked for would be passed over.
void require_settings_alone(const HistoryRequest& request) {
  const bool alone = !request.add && request.amend_run.empty() && request.remove_run.empty() &&
                     request.fields.empty() && request.batch_only.empty();
  if (!request.settings_run.empty() && !alone)
    throw InputError(fmt::format(
        "--settings {} only prints what that dip was made by: leave out what else is said or asked",
        request.settings_run));
}

// The report.json that a run was dipped by, as it was then.
JobResult report_of_run(const History& history, const std::string& id) {
  const std::vector<DipRun> runs = history.runs();
  const auto run = std::ranges::find_if(runs, [&](const DipRun& r) { return r.id == id; });
  if (run == runs.end())
    throw InputError(
        fmt::format("there is no run '{}'; 'hydrodip history JOB_DIR' lists them", id));
  const std::string report = history.report(run->report_sha256);
  if (report.empty())
    throw InputError(
        fmt::format("the settings of run '{}' were not kept: the job had been printed anew before "
                    "its history was looked at",
                    id));
  JobResult result;
  result.text = result.json = report;
  return result;
}

}  // namespace

DipUse use_of(const DipRun& run, const SheetUse& sheet, const CostOptions& cost) {
  DipUse use;
  if (!used_film(run)) return use;
  use.film_m2 = sheet.film_m2;
  use.ink_ml.reset();
  if (sheet.ink_coverage > 0) use.ink_ml = use.film_m2 * sheet.ink_coverage * cost.ink_ml_per_m2;
  use.activator_g = run.activator_g.value_or(0);
  use.cost = use.film_m2 * cost.film_per_m2 + use.ink_ml.value_or(0) * cost.ink_per_ml +
             use.activator_g * cost.activator_per_g;
  if (sheet.first_of_piece) use.cost += cost.per_piece;
  return use;
}

JobResult history_job(const RigJob& job, const HistoryRequest& request, Clock& clock) {
  require_settings_alone(request);
  // Before a history is made for it.
  History::require_fields(request.fields);
  for (const std::string& id : {request.amend_run, request.remove_run})
    if (!id.empty()) History(job.folder, true).require_run(id);
  History history(job.folder,
                  !request.add && request.amend_run.empty() && request.remove_run.empty());
  if (!request.settings_run.empty()) return report_of_run(history, request.settings_run);
  JobResult result;
  if (request.add)
    result.text =
        fmt::format("added {}\n\n", history.add(clock.utc(), job.report_sha256, request.fields));
  if (!request.amend_run.empty()) history.amend(request.amend_run, request.fields);
  if (!request.remove_run.empty()) {
    history.remove(request.remove_run);
    result.text = fmt::format("removed {}\n\n", request.remove_run);
  }
  const std::vector<CostedRun> runs =
      costed(of_batch(history.runs(), request.batch_only), history, job);
  const Totals totals = totals_of(runs);
  result.folder = job.folder;
  result.text += runs.empty()
                     ? "nothing was dipped yet: 'hydrodip rig guide' keeps what was done, and "
                       "'hydrodip history JOB_DIR --add' what was done without it\n"
                     : table(runs, job) + sum(totals, job);
  result.text += reservations(runs, history);
  result.json = json_of(runs, totals, job, history);
  return result;
}

}  // namespace hydrodip
