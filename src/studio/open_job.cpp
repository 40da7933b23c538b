#include "studio/open_job.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/unicode.h"
#include "job/profile_jobs.h"
#include "settings/settings.h"
#include "studio/adoption.h"
#include "studio/api_error.h"
#include "studio/document.h"
#include "studio/job_copies.h"
#include "studio/task_requests.h"

namespace hydrodip {
namespace {

Json or_null(const std::string& id) { return id.empty() ? Json() : Json(id); }

FolderLock held(const JobStore& store, const std::string& job) {
  FolderLock lock = store.hold(job);
  if (lock.state() == FolderLock::State::kTaken)
    throw ApiError(409, "busy", "The job is open in another studio; go on there, or end that one.");
  return lock;
}

}  // namespace

OpenJob::OpenJob(JobStore store, std::string job, std::string run,
                 std::shared_ptr<std::atomic<long>> numbers)
    : store_(std::move(store)),
      job_(std::move(job)),
      run_(std::move(run)),
      held_(held(store_, job_)),
      ids_(run_, std::move(numbers)),
      document_(store_.home(job_), store_.read(job_)),
      shown_(mutex_, tabs_, ids_, address(), document_.files().uploads(), work_) {
  tasks_ = std::make_unique<Tasks>([this](const Json& task) {
    const std::lock_guard lock(mutex_);
    tabs_.tell("task", task);
  });
  live_ = std::make_unique<Live>(shown_.sinks());
  at_rest_ = true;  // until somebody looks, or changes it
}

OpenJob::~OpenJob() {
  work_.cancel();
  live_.reset();
  tasks_.reset();
}

// ---- the document ----

Json OpenJob::describe() const {
  const Json tasks = tasks_->list();
  const std::lock_guard lock(mutex_);
  return {{"job", job_},
          {"name", document_.name()},
          {"where", document_.shown_where()},
          {"revision", document_.revision()},
          {"saved_revision", document_.saved_revision()},
          {"document", document_.json()},
          {"dip", dip_},
          {"files", files_json()},
          {"mesh", or_null(shown_.results().model_mesh())},
          {"tasks", tasks},
          {"result", or_null(shown_.results().newest_result())}};
}

Json OpenJob::put(const Change& change) {
  const std::lock_guard lock(mutex_);
  tabs_.require_pen(change.client);
  if (change.base && *change.base != document_.revision())
    throw ApiError(409, "stale", "The job was changed meanwhile.");
  const JobConfig config = document_.checked(change.document);
  accept(change.document, config, change.client, change.live, change.dip, false);
  Json answer;
  answer["revision"] = document_.revision();
  return answer;
}

// With the lock.
void OpenJob::accept(const Json& document, const JobConfig& config, const std::string& client,
                     bool live, std::size_t dip, bool tell_client) {
  dip_ = dip;
  if (document_.accept(document, config)) tell_saved();
  ask(live);
  const Json event = {
      {"revision", document_.revision()}, {"document", document_.json()}, {"client", client}};
  tabs_.tell_others(tell_client ? "" : client, "document", event);
  if (!live) autosave();  // last: what the disk has no room for holds all the same
}

// With the lock.
void OpenJob::ask(bool live) {
  at_rest_ = false;
  Json content = document_.json();
  if (content.is_object()) {
    content.erase("name");
    content.erase("page");
  }
  live_->ask({document_.config(), document_.revision(), dip_,
              fmt::format("{} {}", reloads_, text_of(content)), live});
}

// With the lock.
void OpenJob::autosave() const {
  if (let_go_) throw no_such_job();
  try {
    store_.write(job_, document_.state(!tabs_.none()));
  } catch (const InputError&) {
    throw ApiError(500, "failed",
                   "The job cannot be kept on this machine's disk; free some space, and change "
                   "something again.");
  }
}

// With the lock. Nobody is left who could be told that it was not kept; whoever made the changes
// before was.
void OpenJob::keep_as_left() const {
  if (let_go_) return;
  try {
    store_.write_left(job_, document_.state(!tabs_.none()));
  } catch (const std::exception&) {
  }
}

// With the lock.
void OpenJob::tell_saved() const {
  tabs_.tell("saved",
             {{"saved_revision", document_.saved_revision()}, {"where", document_.shown_where()}});
}

// With the lock.
void OpenJob::become(const OtherJob& other, const std::string& client) {
  const JobConfig config = document_.checked(other.document, other.machine);
  document_.replace_by(other);
  accept(other.document, config, client, false, 0, true);
}

void OpenJob::open_file(const std::filesystem::path& file) {
  const JobConfig config = config_of_file(file);
  const std::lock_guard lock(mutex_);
  become(document_.by_file(file, config), "");
  if (is_job_file(file)) document_.set_saved();
  autosave();
}

// By what shows it afterwards, so that a large model is read once. The lock is given away
// meanwhile.
std::shared_ptr<const Model> OpenJob::read_unlocked(const UnreadFiles& files,
                                                    std::unique_lock<std::mutex>& lock) {
  LoadOptions own = document_.config().object.load;
  own.texture.clear();
  own.confined_to = document_.files().uploads();
  lock.unlock();
  std::shared_ptr<const Model> read = files.read(
      [&](const std::filesystem::path& model) { return live_->model(model, own, work_); });
  lock.lock();
  return read;
}

Json OpenJob::adopt(const std::vector<std::string>& given, const std::string& client) {
  std::unique_lock lock(mutex_);
  tabs_.require_pen(client);
  Adoption adoption(dropped_.take_in(given));
  OtherJob other;
  try {
    if (!adoption.job().empty()) {
      other = document_.by_uploaded(adoption.job());
    } else {
      // What is broken must not take the place of what was good.
      if (const UnreadFiles unread = dropped_.unread(adoption.names()); !unread.empty()) {
        const std::shared_ptr<const Model> read = read_unlocked(unread, lock);
        tabs_.require_pen(client);  // meanwhile the job was anybody's
        if (read) {
          for (const auto& file : read->files) adoption.add_part(document_.files().grant(file));
          adoption.set_texture(texture_for(*read, adoption.model(), adoption.names()));
        }
      }
      other = document_.by_itself();
    }
    adoption.put_into(other.document);
  } catch (const InputError& error) {
    if (!lock) lock.lock();
    dropped_.refuse(adoption.names());
    throw bad_file(error.what(), document_.files());
  }
  become(other, client);
  dropped_.accept(adoption.names());
  tell_files();
  return {{"revision", document_.revision()},
          {"document", document_.json()},
          {"adopted", adoption.told()}};
}

std::string OpenJob::job_toml(const std::filesystem::path& folder) const {
  const std::lock_guard lock(mutex_);
  return document_.job_file_text(folder);
}

Json OpenJob::save(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (document_.rename(cut_utf8(name, kLongestName)))
    tabs_.tell("document",
               {{"revision", document_.revision()}, {"document", document_.json()}, {"client", ""}},
               true);
  const std::filesystem::path former = document_.save(work_);
  tell_saved();
  autosave();
  // Last, so that whatever fails before leaves a file where the job says that it is.
  std::error_code ignored;
  if (!former.empty()) std::filesystem::remove(former, ignored);
  return {{"saved_revision", document_.saved_revision()}, {"where", document_.shown_where()}};
}

Json OpenJob::patch_of_profile(const std::filesystem::path& profile) {
  JobConfig config;
  SettingSources sources;
  sources.profiles = {profile};
  apply_sources(config, sources);
  const std::lock_guard lock(mutex_);
  Json answer;
  answer["patch"] = values_of(config, names_in_profile(profile), document_.files());
  return answer;
}

void OpenJob::save_profile(const std::filesystem::path& folder, const std::string& name) const {
  const std::filesystem::path draft = home() / "profile.toml";
  {
    const std::lock_guard lock(mutex_);
    write_whole(draft, document_.profile_text());
  }
  ProfileEdit edit;
  edit.add.configs = {draft};
  hydrodip::save_profile(folder, name, edit);
}

std::filesystem::path OpenJob::pack() const {
  const std::lock_guard alone(packing_);
  JobConfig config;
  std::string name;
  std::vector<std::string> of_the_run;
  {
    const std::lock_guard lock(mutex_);
    config = document_.config();
    of_the_run = document_.machine_names();
    name = file_name_of(document_.name());
  }
  // Whoever fetches an earlier archive still has that.
  const std::filesystem::path made =
      pack_job(std::move(config), of_the_run, name, home() / "packed", work_);
  std::filesystem::path archive = home() / "job.zip";
  std::error_code error;
  std::filesystem::rename(made, archive, error);
  if (error) throw ApiError(500, "failed", "The archive cannot be kept; free some space.");
  return archive;
}

void OpenJob::reload() {
  const std::lock_guard lock(mutex_);
  document_.read_again();
  ++reloads_;
  ask(false);
}

std::string OpenJob::name() const {
  const std::lock_guard lock(mutex_);
  return document_.name();
}

// ---- files ----

// With the lock.
Json OpenJob::files_json() const {
  const JobFiles& files = document_.files();
  Json list = Json::array();
  for (const std::string& name : files.names()) {
    std::error_code none;
    const std::uintmax_t bytes = std::filesystem::file_size(files.find(name), none);
    list.push_back({{"file", name}, {"kind", kind_of_file(name)}, {"bytes", none ? 0 : bytes}});
  }
  return list;
}

// With the lock.
void OpenJob::tell_files() const {
  Json event;
  event["files"] = files_json();
  tabs_.tell("files", event);
}

OpenJob::Upload OpenJob::begin_upload(const std::string& wanted) {
  const std::lock_guard lock(mutex_);
  return {wanted, home() / fmt::format("upload-{}.part", ids_.number()), dropped_.room_for(wanted)};
}

Json OpenJob::end_upload(const Upload& upload) {
  const std::lock_guard lock(mutex_);
  const std::string name = dropped_.keep(upload.file, upload.name);
  tell_files();
  return {{"file", name}, {"kind", kind_of_file(name)}};
}

std::filesystem::path OpenJob::file(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  return document_.files().find(name);
}

// ---- tabs ----

std::shared_ptr<EventStream> OpenJob::connect(const std::string& client) {
  const Json tasks = tasks_->list();
  const std::lock_guard lock(mutex_);
  if (let_go_) throw no_such_job();
  auto stream = tabs_.connect(client);
  stream->push("hello", {{"run", run_},
                         {"client", client},
                         {"pen", tabs_.has_pen(client)},
                         {"revision", document_.revision()},
                         {"saved_revision", document_.saved_revision()}});
  for (const auto& [event, data] : shown_.results().events()) stream->push(event, data);
  for (const Json& task : tasks) stream->push("task", task);
  if (at_rest_) ask(false);
  return stream;
}

void OpenJob::disconnect(const std::string& client, const std::shared_ptr<EventStream>& stream) {
  const std::lock_guard lock(mutex_);
  if (!tabs_.disconnect(client, stream) || !tabs_.none()) return;
  keep_as_left();  // nobody has it open: what comes later recovers nothing
  at_rest_ = true;
  live_->rest();
}

void OpenJob::take_pen(const std::string& client) {
  const std::lock_guard lock(mutex_);
  tabs_.take_pen(client);
}

bool OpenJob::has_tabs() const {
  const std::lock_guard lock(mutex_);
  return !tabs_.none();
}

bool OpenJob::has_tab_but(const std::string& client) const {
  const std::lock_guard lock(mutex_);
  return tabs_.any_but(client);
}

std::optional<std::chrono::steady_clock::time_point> OpenJob::idle_since() const {
  if (tasks_->any_running()) return std::nullopt;
  const std::lock_guard lock(mutex_);
  return tabs_.none_since();
}

void OpenJob::say_goodbye(const std::string& text) {
  work_.cancel();  // before the lock, which may be held for it
  const std::lock_guard lock(mutex_);
  tabs_.close(text);
  keep_as_left();
}

bool OpenJob::let_go() {
  const std::lock_guard lock(mutex_);
  if (!tabs_.none() || tasks_->any_running()) return false;
  let_go_ = true;
  work_.cancel();
  return true;
}

// ---- what was computed ----

Json OpenJob::counts() const {
  const Live::Counts counts = live_->counts();
  return {{"sketches", counts.sketches},
          {"drafts", counts.drafts},
          {"normals", counts.normals},
          {"cancelled", counts.cancelled},
          {"memory_bytes", live_->memory_bytes()}};
}

// ---- long work ----

std::string OpenJob::start_task(const Json& request) {
  TaskRequest task;
  task.kind = kind_of_task(request);
  task.name = ids_.task();
  task.address = address() + "/tasks";
  const std::lock_guard lock(mutex_);
  if (let_go_) throw no_such_job();
  tasks_->require_free(task.kind);  // before the job file is written that a running print reads
  prepare_task(task, request, document_);
  if (task.folder.empty())
    task.folder = home() / "found" / fmt::format("{}-{}", task.kind, ids_.number());
  std::error_code ignored;
  std::filesystem::create_directories(task.folder.parent_path(), ignored);
  std::string name = task.name;
  tasks_->start(std::move(task));
  return name;
}

void OpenJob::cancel_task(const std::string& task) {
  if (!tasks_->cancel(task)) throw ApiError(404, "not-found", "There is no such task.");
}

std::filesystem::path OpenJob::task_folder(const std::string& task) const {
  return tasks_->folder(task);
}

}  // namespace hydrodip
