#include "rig/finish_run.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace hydrodip {
namespace {

void note_end(RunRecord& record, const std::string& outcome, const std::string& message,
              const RunEnd& end) {
  LogFields fields = {{"outcome", outcome}, {"step", end.step}};
  if (end.guided) fields.emplace_back("guided", true);
  if (!message.empty()) fields.emplace_back("message", message);
  if (end.rest) {
    fields.emplace_back("stage_stands_still", end.rest->confirmed);
    fields.emplace_back("stage_knows_its_place", end.rest->place_known);
    fields.emplace_back("stage_position_mm", end.rest->position_mm);
  }
  record.note("end", fields);
}

}  // namespace

JobResult finish_run(RunRecord& record, const std::function<void()>& run,
                     const std::function<RunEnd()>& end) {
  try {
    run();
  } catch (const Cancelled& cancelled) {
    note_end(record, "cancelled", cancelled.what(), end());
    record.finish(end().trace);
    const std::string what = cancelled.what();
    throw Cancelled(fmt::format("{}; the log is in {}",
                                what == Cancelled().what() ? "stopped by you" : what,
                                record.folder().string()));
  } catch (const std::exception& error) {
    note_end(record, "failed", error.what(), end());
    record.finish(end().trace);
    throw;
  }
  note_end(record, "done", "", end());
  JobResult result;
  result.folder = record.folder();
  result.files = record.finish(end().trace);
  result.text = fmt::format("wrote to {}:", result.folder.string());
  for (const std::string& file : result.files) result.text += " " + file;
  result.text += "\n";
  result.json =
      nlohmann::ordered_json{{"folder", result.folder.string()}, {"files", result.files}}.dump(
          2, ' ', false, nlohmann::json::error_handler_t::replace) +
      "\n";
  return result;
}

}  // namespace hydrodip
