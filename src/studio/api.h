// The studio's interface over HTTP: docs/studio-api.md.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "studio/guard.h"
#include "studio/http.h"
#include "studio/job_store.h"
#include "studio/json.h"
#include "studio/open_job.h"
#include "studio/sample_shelf.h"

namespace hydrodip {

class Api {
 public:
  // `quit`: what ends the program. `profiles`: the person's own, a folder that need not be there.
  Api(JobStore store, Guard guard, std::string run, std::function<void()> quit,
      std::filesystem::path profiles = {});

  // For HttpServer.
  Admission admit(const HttpRequest& request) const;
  HttpAnswer answer(HttpRequest& request);

  // A file that the command line named, as a job of its own, or as that which was opened from it
  // before and not saved. Throws InputError.
  void open_file(const std::filesystem::path& file);

  // Makes the samples ready that have never been opened, until cancelled.
  void warm_up(const RunContext& context) { shelf_.fill(context); }

  // Lets go of jobs that nobody looks at.
  void tidy();
  // Ends all events and all work; documents stay.
  void end(const std::string& farewell);

 private:
  HttpAnswer route(HttpRequest& request);
  Json hello(const HttpRequest& request);
  Json recent(const HttpRequest& request);
  HttpAnswer new_job(HttpRequest& request);
  HttpAnswer job_route(HttpRequest& request, const std::vector<std::string>& parts);
  void forget(const std::string& job);
  std::shared_ptr<OpenJob> job(const std::string& name);

  const JobStore store_;
  SampleShelf shelf_;
  const Guard guard_;
  const std::string run_;
  const std::function<void()> quit_;
  const std::filesystem::path profiles_;
  std::string opened_;
  const std::shared_ptr<std::atomic<long>> numbers_ = std::make_shared<std::atomic<long>>(0);
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<OpenJob>> jobs_;
};

}  // namespace hydrodip
