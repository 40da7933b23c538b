// A job that is being worked on: brings together its document, who looks at it, what is computed of
// it, and long work.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/context.h"
#include "studio/dropped_files.h"
#include "studio/event_stream.h"
#include "studio/job_document.h"
#include "studio/job_store.h"
#include "studio/json.h"
#include "studio/live.h"
#include "studio/shown_job.h"
#include "studio/shown_results.h"
#include "studio/tabs.h"
#include "studio/tasks.h"

namespace hydrodip {

// For any number of threads. Everything throws ApiError.
class OpenJob {
 public:
  // `run`: this run's name; `numbers`: how many IDs it has given, in whatever job, so that none
  // comes to mean something else. The job is in the store. Throws ApiError busy if another studio
  // has it.
  OpenJob(JobStore store, std::string job, std::string run,
          std::shared_ptr<std::atomic<long>> numbers);
  ~OpenJob();
  OpenJob(const OpenJob&) = delete;
  OpenJob& operator=(const OpenJob&) = delete;

  // ---- the document ----

  // Answer of GET /api/jobs/J.
  Json describe() const;
  struct Change {
    std::string client;
    std::optional<long> base;  // none: whatever is there
    Json document;
    bool live = false;
    std::size_t dip = 0;
  };
  // Answer of PUT .../document. Throws ApiError stale with the newest in describe().
  Json put(const Change& change);
  // A model or a job's file from this machine, as the command line names it.
  void open_file(const std::filesystem::path& file);
  Json adopt(const std::vector<std::string>& files, const std::string& client);
  Json save(const std::string& name);
  // What a profile sets, as a patch of the document. Throws InputError for one that is broken.
  Json patch_of_profile(const std::filesystem::path& profile);
  // Keeps what the job has for film, printer and bath under that name; what the profile has beside
  // that stays. Throws InputError.
  void save_profile(const std::filesystem::path& folder, const std::string& name) const;
  // The job file's text, as it would be written into that folder.
  std::string job_toml(const std::filesystem::path& folder) const;
  // Everything that the job needs, in an archive that is made anew.
  std::filesystem::path pack() const;
  void reload();
  std::string name() const;

  // ---- files ----

  // Where an upload is to be written, and its name when it is whole.
  struct Upload {
    std::string name;
    std::filesystem::path file;
    std::uintmax_t most_bytes = 0;
  };
  Upload begin_upload(const std::string& name);
  Json end_upload(const Upload& upload);
  std::filesystem::path file(const std::string& name) const;
  // Its folder in the store.
  const std::filesystem::path& home() const { return document_.home(); }
  std::filesystem::path thumbnail() const { return home() / kThumbnail; }

  // ---- tabs ----

  std::shared_ptr<EventStream> connect(const std::string& client);
  void disconnect(const std::string& client, const std::shared_ptr<EventStream>& stream);
  void take_pen(const std::string& client);
  bool has_tabs() const;
  bool has_tab_but(const std::string& client) const;
  // Since when nobody has looked at it and nothing is done; nothing: it is in use.
  std::optional<std::chrono::steady_clock::time_point> idle_since() const;
  // Ends all lines, and work for it throws Cancelled.
  void say_goodbye(const std::string& text);
  // From now on nothing of it is kept, nobody can connect, and work for it throws Cancelled. False:
  // it is in use.
  bool let_go();

  // ---- what was computed ----

  const ShownJob& shown() const { return shown_; }
  Json counts() const;

  // ---- long work ----

  std::string start_task(const Json& request);
  void cancel_task(const std::string& task);
  std::filesystem::path task_folder(const std::string& task) const;

 private:
  std::string address() const { return "/api/jobs/" + job_; }
  void accept(const Json& document, const JobConfig& config, const std::string& client, bool live,
              std::size_t dip, bool tell_client);
  std::shared_ptr<const Model> read_unlocked(const UnreadFiles& files,
                                             std::unique_lock<std::mutex>& lock);
  void become(const OtherJob& other, const std::string& client);
  void ask(bool live);
  void autosave() const;
  void keep_as_left() const;
  void tell_saved() const;
  void tell_files() const;
  Json files_json() const;

  const RunContext work_;  // all that is done for it besides tasks and what Live computes
  const JobStore store_;
  const std::string job_, run_;
  const FolderLock held_;
  ShownIds ids_;

  mutable std::mutex packing_;  // before mutex_
  mutable std::mutex mutex_;
  JobDocument document_;
  DroppedFiles dropped_{document_.files()};
  std::size_t dip_ = 0;
  Tabs tabs_;
  bool at_rest_ = false;  // nobody looks: what is shown may be older than the document
  bool let_go_ = false;   // the store has forgotten it
  long reloads_ = 0;
  ShownJob shown_;

  std::unique_ptr<Tasks> tasks_;
  std::unique_ptr<Live> live_;  // last: ends first
};

}  // namespace hydrodip
