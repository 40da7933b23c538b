#include "guided.h"

#include <fmt/format.h>

#include "session.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;

constexpr double kSlack_mm = 0.0025;

// Short waits, so that faults fall into movements.
RigJob short_job(const fs::path& folder, Machine machine, const std::string& port) {
  SettingSources sources;
  for (const char* setting :
       {"process.soak_min_s=1", "process.activator_wait_s=2", "process.dwell_s=1",
        "process.speed_mm_per_min=200", "process.lift_mm_per_min=400", "stage.clearance_mm=20"})
    sources.sets.push_back(parse_set(setting));
  RigJob job = load_rig_job(folder, sources);
  job.config.stage.port = port;
  if (machine == Machine::kMarlin) job.config.stage.driver = StageDriver::kMarlin;
  return job;
}

// What the log's last line says must be so.
std::string wrong_log(const fs::path& run, const std::string& outcome, const std::string& message,
                      const Emulator& machine) {
  const auto lines = read_log(run);
  if (lines.empty() || lines.back()["event"] != "end") return "the log has no end";
  const nlohmann::json& end = lines.back();
  if (end["outcome"] != outcome) return "the log says " + end["outcome"].dump();
  if (outcome == "failed" && end["message"] != message)
    return "the log says " + end["message"].dump() + " instead of " + message;
  if (end.value("stage_stands_still", false) && end.value("stage_knows_its_place", false) &&
      std::abs(end["stage_position_mm"].get<double>() - machine.position_mm()) > kSlack_mm)
    return fmt::format("the log says {}, and it stands at {:.4f}", end.dump(),
                       machine.position_mm());
  if (!fs::exists(run / "report.html")) return "there is no report";
  return "";
}

}  // namespace

std::string random_guided_faults(Machine machine, unsigned seed, const fs::path& folder,
                                 std::string& story) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  write_rig_report(folder, nlohmann::json::object());
  GuidedBench guided(machine, seed);
  guided.person.soak_s = 2;
  guided.person.jogs = {"40", "-2.5"};
  const RigJob job = short_job(folder, machine, guided.emulator->port());
  // A run without faults takes 75 s.
  story = draw_faults(seed, 75, *guided.emulator, guided.clock, guided.context);

  // Water at 37.5 mm, so the dip ends at 67 mm and the lift 20 mm over the water.
  Referee referee(*guided.emulator, guided.clock);
  referee.start();
  guided.person.on_show = [&](const std::string& line) {
    if (line.starts_with("dip "))
      referee.movement("dip", 67, job.config.process.speed_mm_per_min);
    else if (line.starts_with("retract "))
      referee.movement("retract", 17.5, 0);
    else
      referee.standstill();
  };

  std::string outcome = "done", message;
  try {
    rig_guide(job, guided.bench, guided.context);
  } catch (const Cancelled& cancelled) {
    outcome = "cancelled";
    message = cancelled.what();
  } catch (const std::runtime_error& error) {
    outcome = "failed";
    message = error.what();
  }
  story += outcome == "done" ? "finished" : message;

  const Emulator& stage = *guided.emulator;
  const bool homing = message.find("may still be homing") != std::string::npos;
  const bool later = runs_out_later(stage, message);
  if (later) guided.clock.sleep(kLongestFault_s);
  if (stage.moving() && !homing) return "the run is over and the machine moves";
  const double place_mm = stage.position_mm();
  guided.clock.sleep(5);
  if (!homing && stage.position_mm() != place_mm) return "the machine moved after the run";
  if (stage.moved_unhomed()) return "the machine was moved without a home";
  if (stage.disobeyed_s() && !later)
    return fmt::format("a stop was due, and at {:.3f} s the machine moved", *stage.disobeyed_s());
  if (outcome != "done" && message.size() < 20) return "no clear message: '" + message + "'";
  return wrong_log(folder / "rig-1", outcome, message, stage);
}

}  // namespace hydrodip
