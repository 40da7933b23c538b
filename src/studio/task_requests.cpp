#include "studio/task_requests.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "base/file.h"
#include "settings/dip_tables.h"
#include "settings/job_file.h"
#include "studio/api_error.h"
#include "studio/job_copies.h"

namespace hydrodip {
namespace {

void prepare_plan(TaskRequest& task, const Json& request, const JobDocument& document) {
  const Json dips = request.value("dips", Json(2));
  if (!dips.is_number_integer())
    throw ApiError(400, "bad-request", "The request's dips is no whole number.");
  task.config.plan.dips = int(std::clamp<std::int64_t>(dips.get<std::int64_t>(), 0, kMostDips + 1));
  if (task.config.plan.dips < 1 || task.config.plan.dips > kMostDips)
    throw ApiError(422, "bad-value", fmt::format("A job has 1 to {} dips.", kMostDips),
                   "plan.dips");
  task.dips = document.json().value("dips", Json::array());
}

void prepare_orient(TaskRequest& task) {
  // Looked for anew, whatever is said now; the depth too.
  task.config.design.trajectory = TrajectoryOptions{};
  task.config.dips.clear();
}

void prepare_print(TaskRequest& task, const JobDocument& document) {
  const std::filesystem::path &home = document.home(), &where = document.where();
  task.job = home / "job.toml";
  write_whole(task.job, job_file(task.config, home, document.machine_names()));
  const std::string name = where.empty() ? file_name_of(document.name()) : where.stem().string();
  const bool ours = where.empty() || where.parent_path() == document.files().uploads();
  task.folder = ours ? home / "print" / name : where.parent_path() / (name + "-print");
}

}  // namespace

std::string kind_of_task(const Json& request) {
  const Json named = request.value("kind", Json());
  std::string kind = named.is_string() ? named.get<std::string>() : "";
  if (kind != "print" && kind != "orient" && kind != "plan")
    throw ApiError(400, "bad-request", "A task is print, orient or plan.");
  return kind;
}

void prepare_task(TaskRequest& task, const Json& request, const JobDocument& document) {
  task.uploads = document.files().uploads();
  task.config = document.checked(document.json());
  task.revision = document.revision();
  if (task.config.model.empty())
    throw ApiError(422, "no-model", "There is no model yet: drop one here, or open a sample.");
  if (task.kind == "plan") prepare_plan(task, request, document);
  if (task.kind == "orient") prepare_orient(task);
  if (task.kind == "print") prepare_print(task, document);
}

}  // namespace hydrodip
