#include "rig/run_record.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/json_nesting.h"
#include "base/json_text.h"
#include "base/output_folder.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostRuns = 100000;

std::string run_name(int number) { return fmt::format("rig-{}", number); }

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '&')
      result += "&amp;";
    else
      result += c;
  }
  return result;
}

std::string speed_row(const std::optional<SpeedCheck>& speed) {
  if (!speed) return "";
  return fmt::format(
      "<p>Speed of the dip: {:.2f} mm/min of {:g}, an error of {:+.3f} %. Largest distance between "
      "commanded and reported position: {:.3f} mm.</p>\n",
      speed->measured_mm_per_min, speed->commanded_mm_per_min, speed->error_percent(),
      speed->largest_deviation_mm);
}

}  // namespace

RunRecord::RunRecord(const RigJob& job, Clock& clock)
    : job_(job), clock_(clock), start_s_(clock.now_s()) {
  for (int number = 1; number < kMostRuns; ++number) {
    folder_ = job.folder / run_name(number);
    std::error_code error;
    if (std::filesystem::create_directory(folder_, error)) break;
    if (error)
      throw InputError(fmt::format("{}: cannot be made ({}); choose a job folder that is yours",
                                   folder_.string(), error.message()));
  }
  log_.open(folder_ / "log.jsonl", std::ios::app);
  if (!log_)
    throw InputError(fmt::format("{}: cannot be written", (folder_ / "log.jsonl").string()));
}

void RunRecord::note(const std::string& event, const LogFields& fields) {
  Json line = {{"time", clock_.utc()},
               {"elapsed_s", std::round(1e3 * (clock_.now_s() - start_s_)) / 1e3},
               {"event", event}};
  for (const auto& [name, value] : fields)
    std::visit([&, key = name](const auto& v) { line[key] = v; }, value);
  lines_.push_back(json_line(line));
  errno = 0;
  log_.clear();
  log_ << lines_.back() << '\n' << std::flush;
  if (!log_)
    throw InputError(fmt::format(
        "{}: '{}' cannot be written ({}); free space, and begin again: a dip without its log is "
        "not in the history",
        (folder_ / "log.jsonl").string(), event, std::generic_category().message(errno)));
}

std::vector<std::string> RunRecord::finish(const Trace& trace) {
  std::vector<std::string> files = {"log.jsonl"};
  OutputFolder output(folder_);
  const std::string svg = trace_svg(trace, job_.config.stage.down == StageDown::kPlus);
  if (!trace.empty()) {
    write_file(output.path("trace.csv"), trace_csv(trace));
    write_file(output.path("trace.svg"), svg);
    files.insert(files.end(), {"trace.csv", "trace.svg"});
  }
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<style>body{{font-family:sans-serif;max-width:760px;margin:2em auto;color:#222}}"
      "pre{{background:#f4f4f4;padding:1em;overflow-x:auto;font-size:12px}}</style></head>\n"
      "<body><h1>{0}</h1>\n<p>Depth {1:.2f} mm.</p>\n{2}{3}<h2>Log</h2>\n<pre>",
      escaped(job_.title + ", " + folder_.filename().string()), job_.depth_mm,
      speed_row(check_speed(trace, "dip", job_.config.process.speed_mm_per_min)),
      trace.empty() ? "<p>No stage took part.</p>\n" : svg);
  for (const std::string& line : lines_) page += escaped(line) + "\n";
  write_file(output.path("report.html"), page + "</pre></body></html>\n");
  files.emplace_back("report.html");
  output.commit();
  return files;
}

BrokenRun last_broken_run(const RigJob& job) {
  BrokenRun run;
  std::error_code ignored;
  for (int number = 1; std::filesystem::exists(job.folder / run_name(number), ignored); ++number)
    run.name = run_name(number);
  std::ifstream log(job.folder / run.name / "log.jsonl");
  bool finished = run.name.empty() || !log;
  for (std::string line; std::getline(log, line);) {
    const Json entry = parsed_json<Json>(line);
    if (!entry.is_object() || !entry.contains("event") || !entry["event"].is_string()) continue;
    const bool is_done = entry["event"] == "step done" || entry["event"] == "step kept";
    if (is_done && entry.contains("step") && entry["step"].is_string())
      run.steps.push_back(entry["step"]);
    // Only guided runs can be taken up again.
    if (entry["event"] == "end")
      finished =
          !entry.contains("guided") || (entry.contains("outcome") && entry["outcome"] == "done");
  }
  return finished ? BrokenRun{} : run;
}

}  // namespace hydrodip
