#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/json_text.h"
#include "base/nearest_name.h"
#include "base/shell_word.h"
#include "rig/finish_run.h"
#include "rig/rig.h"
#include "rig/stage_session.h"

namespace hydrodip {
namespace {

const std::vector<std::string>& action_names() {
  static const std::vector<std::string> names = {"find",     "status", "home",   "jog",
                                                 "approach", "dip",    "retract"};
  return names;
}

using Json = nlohmann::ordered_json;

JobResult answer(const std::string& action, const std::string& text, const Json& members) {
  JobResult result;
  result.text = text;
  Json all = {{"action", action}};
  all.update(members);
  result.json = json_answer("rig stage", all);
  return result;
}

JobResult told(const std::string& action, const std::string& text) {
  return answer(action, text, {{"text", text}});
}

Json state_json(const StageOptions& stage, const StageState& state) {
  return {{"port", stage.port},
          {"position_mm", state.position_known ? Json(state.position_mm) : Json()},
          {"homed", state.homed},
          {"moving", state.moving},
          {"fault", state.fault}};
}

// As describe_plan() tells them; null: it stands still, or the water level is not known.
Json movements_json(const RigJob& job, std::optional<double> water_mm) {
  const auto position = [&](double height_mm) {
    return water_mm ? Json(stage_position_mm(job.config.stage, *water_mm, height_mm)) : Json();
  };
  Json list = Json::array();
  for (const PlannedMove& move : plan_dip(job))
    list.push_back({{"phase", move.phase},
                    {"from_mm", move.from_height_mm},
                    {"to_mm", move.to_height_mm},
                    {"mm_per_min", move.mm_per_min > 0 ? Json(move.mm_per_min) : Json()},
                    {"seconds", move.seconds},
                    {"from_position_mm", position(move.from_height_mm)},
                    {"to_position_mm", position(move.to_height_mm)}});
  return list;
}

bool needs_job(const std::string& action) {
  return action == "approach" || action == "dip" || action == "retract";
}

void check_action(const StageAction& action, const RigJob* job) {
  const auto& names = action_names();
  if (std::find(names.begin(), names.end(), action.action) == names.end())
    throw InputError(
        fmt::format("rig stage: '{}' is none of find, status, home, jog, approach, dip, retract{}",
                    action.action, did_you_mean(action.action, names)));
  if (needs_job(action.action) && !job)
    throw InputError(
        fmt::format("rig stage {}: name the job's folder as well, as in 'hydrodip rig "
                    "stage {} mask-print'",
                    action.action, action.action));
}

// What the stage did last is asked of the session even when it never came to be.
RunEnd end_of(const std::optional<StageSession>& session, const std::string& action) {
  if (!session) return {action, {}, {}, false};
  return {action, session->trace(), session->last_rest(), false};
}

double require_level(const RigJob& job) {
  if (const auto level = known_water_level_mm(job)) return *level;
  throw InputError(fmt::format(
      "the water level is not known yet: give --set stage.water_mm=..., or find it: hydrodip rig "
      "stage approach {}",
      shell_word(job.folder.string())));
}

void perform(StageSession& session, const StageAction& action, const RigJob* job) {
  if (action.action == "home") return session.ensure_home(true);
  session.ensure_home();
  if (action.action == "jog") {
    session.require_jog(action.jog_mm);
    session.require_yes(fmt::format("The stage will move by {:g} mm.", action.jog_mm));
    return session.jog(action.jog_mm);
  }
  if (action.action == "approach") {
    session.require_yes("The stage will move as you tell it.");
    const double water_mm = session.find_water_level();
    save_water_level(*job, water_mm);
    return session.lift_clear(water_mm);
  }
  const double water_mm = require_level(*job);
  if (action.action == "retract") {
    session.require_yes("The stage will lift the object.");
    return session.perform(*job, water_mm, "retract");
  }
  // What goes in has to come out again.
  for (const PlannedMove& move : plan_dip(*job)) session.require_reach(water_mm, move);
  session.require_yes("The stage will dip the object.");
  for (const char* phase : {"approach", "dip", "dwell"}) session.perform(*job, water_mm, phase);
}

JobResult status(const StageOptions& stage, Bench& bench, const RunContext& context) {
  StageSession session(stage, bench, nullptr, context);
  const std::string text = session.describe() + "\n" + session.describe_state() + "\n";
  return answer("status", text, state_json(stage, session.state()));
}

std::vector<std::string> ports() {
  std::vector<std::string> list;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("ttyUSB") || name.starts_with("ttyACM")) list.push_back(entry.path());
  }
  std::sort(list.begin(), list.end());
  return list;
}

// As far as the configuration knows the stage: it is not asked.
void require_within_travel(const RigJob& job, double water_mm) {
  const StageOptions& stage = job.config.stage;
  for (const PlannedMove& move : plan_dip(job)) {
    const double position_mm = stage_position_mm(stage, water_mm, move.to_height_mm);
    if (stage.travel_mm > 0 && (position_mm < 0 || position_mm > stage.travel_mm))
      throw StageError(fmt::format(
          "{}: {:.2f} mm is beyond the stage's travel of 0 to {:g} mm (stage.travel_mm): hang the "
          "object higher or lower, or dip less of it",
          move.phase, position_mm, stage.travel_mm));
  }
}

}  // namespace

JobResult rig_stage(const StageAction& action, const RigJob* job, const StageOptions& stage,
                    Bench& bench, const RunContext& context) {
  check_action(action, job);
  if (job) require_lowering_only(*job);
  if (action.action == "find") return rig_find(stage, bench, context);
  if (action.dry_run) {
    if (!job) return told(action.action, fmt::format("{}: nothing was moved\n", action.action));
    const std::optional<double> water_mm = known_water_level_mm(*job);
    if (water_mm) require_within_travel(*job, *water_mm);
    const std::string text = describe_plan(*job, water_mm) + "Nothing was moved.\n";
    return answer(action.action, text,
                  {{"movements", movements_json(*job, water_mm)}, {"text", text}});
  }
  if (action.action == "status") return status(stage, bench, context);
  if (action.action == "dip" || action.action == "retract") require_level(*job);

  std::optional<StageSession> session;
  if (!job) {
    session.emplace(stage, bench, nullptr, context);
    perform(*session, action, nullptr);
    return answer(action.action, session->describe_state() + "\n",
                  state_json(stage, session->state()));
  }
  RunRecord record(*job, bench.clock);
  record.note("start", {{"job", job->title}, {"action", action.action}});
  JobResult result = finish_run(
      record, "rig stage",
      [&] {
        session.emplace(stage, bench, &record, context);
        perform(*session, action, job);
      },
      [&] { return end_of(session, action.action); });
  result.text = session->describe_state() + "\n" + result.text;
  return result;
}

JobResult rig_find(const StageOptions& stage, Bench& bench, const RunContext& context) {
  const std::vector<std::string> list =
      stage.port.empty() ? ports() : std::vector<std::string>{stage.port};
  std::string text;
  Json found_at = Json::array();
  for (const std::string& port : list) {
    StageOptions options = stage;
    options.port = port;
    options.travel_mm = 0;  // whatever it is
    std::string found;
    bool is_stage = false;
    try {
      found = StageSession(options, bench, nullptr, context).describe();
      is_stage = true;
    } catch (const InputError& error) {
      found = error.what();
    } catch (const StageError&) {
      found = "no answer as a stage of this kind (stage.driver, stage.baud, stage.address)";
    }
    text += fmt::format("{}  {}\n", port, found);
    found_at.push_back({{"port", port}, {"is_stage", is_stage}, {"found", found}});
  }
  if (list.empty()) text = "no serial port (/dev/ttyUSB*, /dev/ttyACM*) on this computer\n";
  return answer("find", text, {{"ports", found_at}});
}

}  // namespace hydrodip
