#include "studio/tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "base/error.h"
#include "image/files.h"
#include "job/dip_plan.h"
#include "job/job_progress.h"
#include "job/jobs.h"
#include "render/hold_pictures.h"
#include "report/findings.h"
#include "report/plain_words.h"
#include "rig/rig.h"
#include "settings/params.h"
#include "settings/settings.h"
#include "studio/api_error.h"
#include "studio/job_files.h"
#include "studio/job_store.h"

namespace hydrodip {
namespace {

using Steady = std::chrono::steady_clock;

constexpr auto kBetweenReports = std::chrono::milliseconds(150);

// ---- what is done ----

// As `hydrodip print JOB.toml` does it, and a run sheet for the bench beside each sheet.
JobResult print_from(const TaskRequest& request, const RunContext& context) {
  JobConfig config = configured(request.job.string(), {});
  config.object.load.confined_to = request.config.object.load.confined_to;
  config.output = request.folder;
  JobResult result = print_job(config, context);
  std::vector<std::string> sheets = result.dips;
  if (sheets.empty()) sheets.emplace_back();
  for (const std::string& dip : sheets) {
    context.progress("drawing the run sheets", 0);
    rig_sheet(load_rig_job(result.folder / dip, {}), "", {}, context.quiet());
  }
  return result;
}

Json files_json(const TaskRequest& request) {
  static const std::vector<std::pair<std::string, std::string>> known = {
      {"print.pdf", "the sheet: print it at 100 %, no scaling"},
      {"run-sheet.pdf", "what to do at the bath, step by step"},
      {"report.html", "everything about this job"},
      {"preview.png", "what was asked for beside what comes out"},
      {"print.png", "the film image, with its resolution"},
      {"print.tif", "the film image in the printer's inks"},
      {"dips.png", "which dip does which part"},
      {"maps.png", "where the film stretches and tears"},
      {"gamut.png", "where colours cannot be reached"},
      {"preview.glb", "the result in 3D"},
      {"film.ply", "the film after the dip"},
      {"report.json", "the report for programs"}};
  std::vector<std::pair<std::string, std::filesystem::path>> found;
  std::error_code error;
  for (auto entry = std::filesystem::recursive_directory_iterator(request.folder, error);
       !error && entry != std::filesystem::recursive_directory_iterator(); entry.increment(error))
    if (entry->is_regular_file(error))
      found.emplace_back(entry->path().lexically_relative(request.folder).string(), entry->path());
  std::sort(found.begin(), found.end());
  Json list = Json::array();
  for (const auto& [what, text] : known)
    for (const auto& [name, path] : found) {
      if (path.filename() != what) continue;
      std::error_code none;
      list.push_back({{"file", name},
                      {"text", text},
                      {"bytes", std::filesystem::file_size(path, none)},
                      {"url", request.address + "/files/" + name}});
    }
  return list;
}

Concern concern_called(const std::string& name) {
  for (const Concern concern : {Concern::kNone, Concern::kCare})
    if (concern_name(concern) == name) return concern;
  return Concern::kStop;
}

Json warnings_of(const RunContext& context) {
  Json list = Json::array();
  for (const std::string& warning : context.warnings()) list.push_back(in_plain_words(warning));
  return list;
}

Json print_result(const TaskRequest& request, const RunContext& context) {
  const JobResult done = print_from(request, context);
  const Json report = Json::parse(done.json);
  const std::string verdict = report.value("verdict", "");
  const std::string concern = report.value("concern", "");
  return {{"where", shown_path(request.folder)},
          {"verdict",
           {{"concern", concern},
            {"headline", headline(concern_called(concern))},
            {"text", in_plain_words(verdict)}}},
          {"files", files_json(request)},
          {"zip", request.address + "/files.zip"},
          {"warnings", warnings_of(context)}};
}

Image part_of(const Image& whole, const HoldPlace& at) {
  Image part(at.width_px, at.height_px);
  for (int y = 0; y < at.height_px; ++y)
    std::copy_n(whole.pixel(at.left_px, at.top_px + y), 4 * std::size_t(at.width_px),
                part.pixel(0, y));
  return part;
}

// Parts of one picture, each as a file of its own.
std::vector<std::string> cut(const Image& whole, const std::vector<HoldPlace>& places,
                             const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const HoldPlace& place : places) {
    names.push_back(fmt::format("way-{}.png", names.size() + 1));
    save_png(folder / names.back(), part_of(whole, place));
  }
  return names;
}

// Of each way to hold the object what its film covers, seen from below: what shows its difference
// when it is small.
std::vector<std::string> cut_holds(const std::filesystem::path& page,
                                   const std::filesystem::path& folder, std::size_t ways) {
  const Image whole = load_image(page);
  std::vector<HoldPlace> places;
  places.reserve(ways);
  for (std::size_t way = 0; way < ways; ++way)
    places.push_back(hold_from_below(whole.width_px, int(way)));
  return cut(whole, places, folder);
}

std::vector<std::string> cut_rows(const std::filesystem::path& picture,
                                  const std::filesystem::path& folder, std::size_t rows) {
  const Image whole = load_image(picture);
  const int height = whole.height_px / int(std::max<std::size_t>(1, rows));
  std::vector<HoldPlace> places;
  places.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row)
    places.push_back({0, int(row) * height, whole.width_px, height});
  return cut(whole, places, folder);
}

Json orient_result(const TaskRequest& request, const RunContext& context) {
  JobConfig config = request.config;
  config.output = request.folder;
  config.plan.find_depth = config.plan.find_depth || !(config.design.trajectory.depth_mm > 0);
  config.pictures = true;
  config.preview_width_px = 1000;
  const JobResult done = orient_job(config, context);
  const Json found = Json::parse(done.json);
  const auto names =
      cut_holds(request.folder / "orient.png", request.folder, found["poses"].size());
  Json ways = Json::array();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Json& pose = found["poses"][k];
    ways.push_back(
        {{"text", pose["text"]},
         {"covered_share", pose["covered_share"]},
         {"torn_share", pose["torn_share"]},
         {"doubtful_share", pose["doubtful_share"]},
         {"score", pose["score"]},
         {"picture", request.address + "/files/" + names[k]},
         {"patch",
          {{"object", {{"down", pose["down"]}, {"rotate_deg", pose["rotate_deg"]}}},
           {"dip", {{"depth_mm", pose["depth_mm"]}, {"tilt_deg", nullptr}, {"roll_deg", nullptr}}},
           {"path", nullptr}}}});
  }
  Json result;
  result["ways"] = ways;
  return result;
}

PoseOptions pose_in(const Json& planned) {
  JobConfig config;
  apply_settings(config, {{"object.down", planned["down"].get<std::string>(), true, "", "plan"},
                          {"object.rotate_deg", planned["rotate_deg"].get<std::vector<double>>(),
                           true, "", "plan"}});
  return config.object.pose;
}

void keep_own(Json& planned, const TaskRequest& request) {
  const auto same = dip_held_so(request.config, pose_in(planned));
  if (!same) return;
  if (request.config.dips[*same].locked) planned["locked"] = true;
  if (!request.config.dips[*same].correction.empty())
    planned["correction"] = request.dips[*same]["correction"];
}

Json plan_result(const TaskRequest& request, const RunContext& context) {
  JobConfig config = request.config;
  config.output = request.folder;
  config.pictures = true;
  config.preview_width_px = 1000;
  const JobResult done = plan_job(config, context);
  const Json found = Json::parse(done.json);
  const auto names = cut_rows(request.folder / "plan.png", request.folder, found["dips"].size());
  Json dips = Json::array(), patch = Json::array(), covered = Json::array(),
       covered_wanted = Json::array();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Json& dip = found["dips"][k];
    covered.push_back(dip["covered_share"]);
    if (const Json& after = found["coverage"][k]; after.contains("covered_wanted_share"))
      covered_wanted.push_back(after["covered_wanted_share"]);
    dips.push_back({{"text", dip["text"]},
                    {"gained_share", dip["gained_share"]},
                    {"covered_share", dip["covered_share"]},
                    {"torn_share", dip["torn_share"]},
                    {"picture", request.address + "/files/" + names[k]}});
    Json entry = {{"down", dip["down"]}, {"rotate_deg", dip["rotate_deg"]}};
    if (dip["path"].is_null())
      entry["depth_mm"] = dip["depth_mm"];
    else
      entry["path"] = dip["path"];
    keep_own(entry, request);
    patch.push_back(entry);
  }
  return {{"covered_share", covered},
          {"covered_wanted_share", covered_wanted},
          {"dips", dips},
          {"patch", {{"dips", patch}}},
          {"warnings", warnings_of(context)}};
}

Json do_task(const TaskRequest& request, const RunContext& context) {
  if (request.kind == "print") return print_result(request, context);
  if (request.kind == "orient") return orient_result(request, context);
  return plan_result(request, context);
}

}  // namespace

// ---- tasks ----

struct Tasks::Task {
  explicit Task(TaskRequest its_request)
      : request(std::move(its_request)), progress(request.kind) {}

  const TaskRequest request;
  RunContext context;
  JobProgress progress;
  std::string state = "running", activity = "beginning";
  Json error, result;
  Steady::time_point begun = Steady::now(), told = {};
  double took_s = 0;
  std::thread thread;
};

Tasks::Tasks(std::function<void(const Json& task)> tell) : tell_(std::move(tell)) {}

Tasks::~Tasks() {
  for (const auto& task : tasks_) task->context.cancel();
  for (const auto& task : tasks_) task->thread.join();
}

// With the lock.
void Tasks::require_none_running(const std::string& kind) const {
  for (const auto& task : tasks_)
    if (task->state == "running" && task->request.kind == kind)
      throw ApiError(409, "busy", "That is being done already; cancel it first.");
}

void Tasks::require_free(const std::string& kind) const {
  const std::lock_guard lock(mutex_);
  require_none_running(kind);
}

void Tasks::start(TaskRequest request) {
  const std::lock_guard lock(mutex_);
  require_none_running(request.kind);
  request.address += "/" + request.name;
  tasks_.push_back(std::make_unique<Task>(std::move(request)));
  Task& task = *tasks_.back();
  try {
    task.thread = std::thread([this, &task] { run(task); });
  } catch (const std::system_error&) {
    tasks_.pop_back();
    throw ApiError(500, "failed",
                   "This machine has no room for more work now; end other programs and try again.");
  }
}

void Tasks::change(Task& task, const std::function<void()>& how, bool always) {
  Json told;
  {
    const std::lock_guard lock(mutex_);
    how();
    if (!always && Steady::now() - task.told < kBetweenReports) return;
    task.told = Steady::now();
    told = json_of(task);
  }
  tell_(told);
}

void Tasks::run(Task& task) {
  change(
      task, [] {}, true);
  task.context.on_progress([&](const std::string& activity, double fraction) {
    change(
        task,
        [&] {
          task.activity = activity;
          task.progress.update(activity, fraction);
        },
        false);
  });
  std::string state = "failed";
  Json error, result;
  const auto failed = [&](const char* code, const std::string& text) {
    error = {{"code", code}, {"text", in_plain_words(without_folder(text, task.request.uploads))}};
  };
  try {
    result = do_task(task.request, task.context);
    state = "done";
  } catch (const Cancelled&) {
    state = "cancelled";
  } catch (const InputError& problem) {
    failed("input", problem.what());
  } catch (const DipError& problem) {
    failed("dip", problem.what());
  } catch (const std::bad_alloc&) {
    failed("memory", "There is not enough memory for this.");
  } catch (const std::exception& problem) {
    failed("failed", problem.what());
  }
  change(
      task,
      [&] {
        task.state = state;
        task.error = error;
        task.result = result;
        task.took_s = std::chrono::duration<double>(Steady::now() - task.begun).count();
      },
      true);
}

Json Tasks::json_of(const Task& task) const {
  const bool running = task.state == "running";
  const double elapsed =
      running ? std::chrono::duration<double>(Steady::now() - task.begun).count() : task.took_s;
  const double left = running ? task.progress.left_s(elapsed) : -1;
  return {{"task", task.request.name},
          {"kind", task.request.kind},
          {"state", task.state},
          {"revision", task.request.revision},
          {"activity", task.activity},
          {"fraction", task.state == "done" ? 1 : task.progress.fraction()},
          {"elapsed_s", std::round(10 * elapsed) / 10},
          {"left_s", left < 0 ? Json() : Json(std::round(10 * left) / 10)},
          {"error", task.error},
          {"result", task.result}};
}

bool Tasks::cancel(const std::string& name) {
  const std::lock_guard lock(mutex_);
  for (const auto& task : tasks_)
    if (task->request.name == name) {
      task->context.cancel();
      return true;
    }
  return false;
}

Json Tasks::list() const {
  const std::lock_guard lock(mutex_);
  Json list = Json::array();
  for (const char* kind : {"print", "orient", "plan"})
    for (auto task = tasks_.rbegin(); task != tasks_.rend(); ++task)
      if ((*task)->request.kind == kind) {
        list.push_back(json_of(**task));
        break;
      }
  return list;
}

std::filesystem::path Tasks::folder(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  for (const auto& task : tasks_)
    if (task->request.name == name) return task->request.folder;
  return {};
}

bool Tasks::any_running() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(tasks_.begin(), tasks_.end(),
                     [](const auto& task) { return task->state == "running"; });
}

}  // namespace hydrodip
