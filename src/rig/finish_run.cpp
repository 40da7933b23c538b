#include "rig/finish_run.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"

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

// Of a run that did not come to its end. Why it did not is said, not that this cannot be written.
void leave_end(RunRecord& record, const std::string& outcome, const std::string& message,
               const RunEnd& end) {
  try {
    note_end(record, outcome, message, end);
    record.finish(end.trace);
  } catch (const InputError&) {
  }
}

}  // namespace

JobResult finish_run(RunRecord& record, const std::string& command,
                     const std::function<void()>& run, const std::function<RunEnd()>& end) {
  try {
    run();
  } catch (const Cancelled& cancelled) {
    leave_end(record, "cancelled", cancelled.what(), end());
    const std::string what =
        cancelled.what() == std::string(Cancelled().what()) ? "stopped by you" : cancelled.what();
    throw Cancelled(fmt::format("{} log is in {}", what + (what.ends_with('.') ? " The" : "; the"),
                                record.folder().string()));
  } catch (const std::exception& error) {
    leave_end(record, "failed", error.what(), end());
    throw;
  }
  note_end(record, "done", "", end());
  JobResult result;
  result.folder = record.folder();
  result.files = record.finish(end().trace);
  result.text = fmt::format("wrote to {}:", result.folder.string());
  for (const std::string& file : result.files) result.text += " " + file;
  result.text += "\n";
  result.json = json_answer(command, {{"folder", result.folder.string()}, {"files", result.files}});
  return result;
}

}  // namespace hydrodip
