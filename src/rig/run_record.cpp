#include "rig/run_record.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

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

struct PastRun {
  std::vector<std::string> steps;
  bool finished = true;
  // Nothing became of what was prepared before it: it ended before it had asked whether to keep
  // that, or only moved the stage about.
  bool says_nothing = false;
};

PastRun past_run(const std::filesystem::path& folder) {
  PastRun run;
  std::ifstream log(folder / "log.jsonl");
  if (!log) return run;
  run.finished = false;
  std::string action, ended_at = "start";
  bool decided = false;
  for (std::string line; std::getline(log, line);) {
    const Json entry = parsed_json<Json>(line);
    if (!entry.is_object() || !entry.contains("event") || !entry["event"].is_string()) continue;
    const auto text = [&](const char* key) {
      return entry.contains(key) && entry[key].is_string() ? entry[key].get<std::string>() : "";
    };
    const std::string event = entry["event"];
    if (event == "start") action = text("action");
    if (event == "taken up" || event == "not taken up") decided = true;
    if ((event == "step done" || event == "step kept") && !text("step").empty())
      run.steps.push_back(text("step"));
    if (event == "end") {
      ended_at = text("step");
      run.finished = text("outcome") == "done";
    }
  }
  if (action.empty()) {
    run.says_nothing = !run.finished && !decided && run.steps.empty() && ended_at == "start";
  } else {
    // 'rig stage', which nobody takes up again; a dip uses up film and object.
    run.finished = true;
    run.says_nothing = action != "dip";
  }
  return run;
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
  if (!log_) {
    const int error = errno;
    if (lines_.size() == 1) {  // of a run that has not begun
      log_.close();
      std::error_code ignored;
      std::filesystem::remove(folder_ / "log.jsonl", ignored);
      std::filesystem::remove(folder_, ignored);
    }
    throw InputError(fmt::format(
        "{}: '{}' cannot be written ({}); free space, and begin again: a dip without its log is "
        "not in the history",
        (folder_ / "log.jsonl").string(), event, std::generic_category().message(error)));
  }
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
  std::error_code ignored;
  int number = 0;
  while (std::filesystem::exists(job.folder / run_name(number + 1), ignored)) ++number;
  for (; number > 0; --number) {
    PastRun run = past_run(job.folder / run_name(number));
    if (run.says_nothing) continue;
    if (run.finished) return {};
    return {run_name(number), std::move(run.steps)};
  }
  return {};
}

}  // namespace hydrodip
