// Long work that was asked for, in the background: print, orient, plan.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/context.h"
#include "settings/config.h"
#include "studio/json.h"

namespace hydrodip {

struct TaskRequest {
  std::string name;  // unlike any other's
  std::string kind;  // "print"
  long revision = 0;
  JobConfig config;               // of orient and plan: as it is
  std::filesystem::path job;      // of print: its job file, from which the bytes are made
  std::filesystem::path folder;   // where its files go
  Json dips;                      // of plan: the document's, which names files as the page does
  std::string address;            // of these files for the page
  std::filesystem::path uploads;  // whose files sentences call by their names alone
};

class Tasks {
 public:
  // `tell` is called by any thread whenever a task has changed.
  explicit Tasks(std::function<void(const Json& task)> tell);
  // Cancels all.
  ~Tasks();
  Tasks(const Tasks&) = delete;
  Tasks& operator=(const Tasks&) = delete;

  // Throws ApiError busy if one of that kind is running.
  void require_free(const std::string& kind) const;
  // Throws ApiError: busy as above; failed if the machine can begin no thread.
  void start(TaskRequest request);
  // False: there is no such task.
  bool cancel(const std::string& task);
  // TASKs of docs/studio-api.md: the last of each kind.
  Json list() const;
  // The folder of a task's files; empty if there is none.
  std::filesystem::path folder(const std::string& task) const;
  bool any_running() const;

 private:
  struct Task;

  void require_none_running(const std::string& kind) const;
  void run(Task& task);
  Json json_of(const Task& task) const;
  void change(Task& task, const std::function<void()>& how, bool always);

  const std::function<void(const Json&)> tell_;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Task>> tasks_;
};

}  // namespace hydrodip
