#include "studio/open_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/unicode.h"
#include "job/profile_jobs.h"
#include "settings/dip_tables.h"
#include "settings/job_file.h"
#include "settings/settings.h"
#include "studio/api_error.h"
#include "studio/bundle.h"
#include "studio/document.h"
#include "studio/job_copies.h"
#include "studio/look_bundles.h"

namespace hydrodip {
namespace {

constexpr std::array<const char*, 7> kOfProfiles = {"film.", "material.", "ink.",   "print.",
                                                    "bath.", "process.",  "report."};

Json or_null(const std::string& id) { return id.empty() ? Json() : Json(id); }

FolderLock held(const JobStore& store, const std::string& job) {
  FolderLock lock = store.hold(job);
  if (lock.state() == FolderLock::State::kTaken)
    throw ApiError(409, "busy", "The job is open in another studio; go on there, or end that one.");
  return lock;
}

bool is_job_file(const std::filesystem::path& file) { return file.extension() == ".toml"; }

}  // namespace

OpenJob::OpenJob(JobStore store, std::string job, std::string run,
                 std::shared_ptr<std::atomic<long>> numbers)
    : store_(std::move(store)),
      job_(std::move(job)),
      run_(std::move(run)),
      home_(store_.home(job_)),
      held_(held(store_, job_)),
      ids_(run_, std::move(numbers)),
      files_(home_ / "files") {
  std::error_code ignored;
  std::filesystem::create_directories(files_.uploads(), ignored);
  const Json state = store_.read(job_);
  if (state.is_object()) {
    files_.set_granted(state.value("granted", Json::object()));
    document_ = state.value("document", Json::object());
    machine_ = state.value("machine", Json::object());
    revision_ = state.value("revision", 1L);
    saved_revision_ = state.value("saved_revision", 1L);
    where_ = state.value("where", "");
    origin_ = state.value("origin", "");
    try {
      config_ = checked(document_);
    } catch (const ApiError&) {
      // A file of it has gone: the page says so when it asks for a result.
    }
  }
  tasks_ = std::make_unique<Tasks>([this](const Json& task) {
    const std::lock_guard lock(mutex_);
    tabs_.tell("task", task);
  });
  live_ = std::make_unique<Live>(sinks());
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
          {"name", name_of_job(document_)},
          {"where", where_.empty() ? "" : shown_path(where_)},
          {"revision", revision_},
          {"saved_revision", saved_revision_},
          {"document", document_},
          {"dip", dip_},
          {"files", files_json()},
          {"mesh", or_null(shown_.model_mesh())},
          {"tasks", tasks},
          {"result", or_null(shown_.newest_result())}};
}

JobConfig OpenJob::checked(const Json& document) const {
  if (text_of(document).size() > kLargestDocument)
    throw ApiError(413, "too-large", "The job's document is too large.");
  JobConfig config = config_of(document, files_);
  apply_machine_values(machine_, config);
  // What was uploaded may come from anybody, and names no other file of this machine.
  if (lies_in(config.model, files_.uploads())) config.object.load.confined_to = files_.uploads();
  return config;
}

Json OpenJob::put(const Change& change) {
  const std::lock_guard lock(mutex_);
  tabs_.require_pen(change.client);
  if (change.base && *change.base != revision_)
    throw ApiError(409, "stale", "The job was changed meanwhile.");
  const JobConfig config = checked(change.document);
  accept(change.document, config, change.client, change.live, change.dip, false);
  Json answer;
  answer["revision"] = revision_;
  return answer;
}

// With the lock.
void OpenJob::accept(const Json& document, const JobConfig& config, const std::string& client,
                     bool live, std::size_t dip, bool tell_client) {
  const bool stays_saved = saved_revision_ == revision_ && document == document_;
  document_ = document;
  config_ = config;
  dip_ = dip;
  ++revision_;
  if (stays_saved) tell_saved();
  ask(live);
  const Json event = {{"revision", revision_}, {"document", document_}, {"client", client}};
  tabs_.tell_others(tell_client ? "" : client, "document", event);
  if (!live) autosave();  // last: what the disk has no room for holds all the same
}

// With the lock.
void OpenJob::ask(bool live) {
  at_rest_ = false;
  Json content = document_;
  if (content.is_object()) {
    content.erase("name");
    content.erase("page");
  }
  live_->ask({config_, revision_, dip_, fmt::format("{} {}", reloads_, text_of(content)), live});
}

// With the lock.
void OpenJob::autosave() const {
  if (let_go_) throw no_such_job();
  const Json state = {{"version", 1},
                      {"name", name_of_job(document_)},
                      {"where", where_.string()},
                      {"origin", origin_.string()},
                      {"revision", revision_},
                      {"saved_revision", saved_revision_},
                      {"open", !tabs_.none()},
                      {"granted", files_.granted()},
                      {"machine", machine_},
                      {"document", document_}};
  try {
    store_.write(job_, state);
  } catch (const InputError&) {
    throw ApiError(500, "failed",
                   "The job cannot be kept on this machine's disk; free some space, and change "
                   "something again.");
  }
}

// With the lock. Where nobody is left who could be told that it is not.
void OpenJob::autosave_if_possible() const {
  try {
    autosave();
  } catch (const std::exception&) {
    // The changes before were kept, or whoever made them was told.
  }
}

// With the lock.
std::vector<std::string> OpenJob::machine_names() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : machine_.items()) names.push_back(name);
  return names;
}

// With the lock.
void OpenJob::tell_saved() {
  saved_revision_ = revision_;
  tabs_.tell("saved", {{"saved_revision", saved_revision_}, {"where", shown_path(where_)}});
}

void OpenJob::open_file(const std::filesystem::path& file) {
  JobConfig config;
  const auto whole = std::filesystem::absolute(file).lexically_normal();
  if (is_job_file(file)) {
    SettingSources sources;
    sources.configs = {whole};
    apply_sources(config, sources);
    if (config.model.empty())
      throw InputError(
          fmt::format("{}: the job names no model: begin it with file = \"MODEL\" under [object]",
                      file.string()));
  } else {
    config.model = whole;
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(config.model, error))
    throw InputError(fmt::format("{}: there is no such file", config.model.string()));
  const std::lock_guard lock(mutex_);
  machine_ = machine_values_of(config);
  Json document = document_of(config, files_);
  // What a job file does not say.
  for (const char* own : {"name", "page"})
    if (document_.contains(own)) document[own] = document_[own];
  if (whole != where_) origin_ = whole;
  if (is_job_file(file)) where_ = whole;
  accept(document, checked(document), "", false, 0, true);
  if (is_job_file(file)) saved_revision_ = revision_;
  autosave();
}

// With the lock.
Json OpenJob::adopt_job_file(const std::string& job) {
  JobConfig config;
  SettingSources sources;
  sources.configs = {files_.find(job)};
  apply_sources(config, sources);
  // Such a file may name anything on this machine: only what came with it is taken.
  JobFiles uploaded(files_.uploads());
  Json document = document_of(config, uploaded);
  if (!uploaded.granted().empty()) {
    const std::string missing = uploaded.granted().begin().key();
    throw ApiError(422, "bad-file",
                   fmt::format("The job needs {}: drop it here together with {}.", missing, job));
  }
  machine_ = machine_values_of(config);
  return document;
}

Json OpenJob::adopt(const std::vector<std::string>& given, const std::string& client) {
  std::unique_lock lock(mutex_);
  tabs_.require_pen(client);
  Json adopted = Json::array();
  const auto note = [&](const std::string& name, const std::string& as, const std::string& text) {
    adopted.push_back({{"file", name}, {"as", as}, {"text", text}});
  };
  const std::vector<std::string> names = dropped_.take_in(given);
  Json document = document_;
  const auto first = [&](const std::string& kind) {
    const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
      return kind_of_file(name) == kind;
    });
    return found == names.end() ? std::string() : *found;
  };
  std::set<std::string> taken;
  std::string texture;
  try {
    if (const std::string job = first("job"); !job.empty()) {
      document = adopt_job_file(job);
      note(job, "job", "");
      taken.insert(names.begin(), names.end());
    } else if (const UnreadFiles unread = dropped_.unread(names); !unread.empty()) {
      // What is broken must not take the place of what was good.
      LoadOptions own = config_.object.load;
      own.texture.clear();
      own.confined_to = files_.uploads();
      lock.unlock();
      // By what shows it afterwards, so that a large one is read once.
      const std::shared_ptr<const Model> read = unread.read(
          [&](const std::filesystem::path& model) { return live_->model(model, own, work_); });
      lock.lock();
      // Meanwhile the job was anybody's.
      tabs_.require_pen(client);
      document = document_;
      if (read) {
        for (const auto& file : read->files) taken.insert(files_.grant(file));
        texture = texture_for(*read, first("model"), names);
      }
    }
    if (const std::string model = first("model"); !model.empty() && first("job").empty()) {
      document["object"]["file"] = model;
      document["object"].erase("texture");
      if (!texture.empty()) document["object"]["texture"] = texture;
      note(model, "model", "");
      taken.insert({model, texture});
    }
    for (const std::string& name : names) {
      const std::string kind = kind_of_file(name);
      if (kind == "job" || (kind == "model" && taken.contains(name))) continue;
      if (taken.contains(name)) {
        note(name, "part", "");
      } else if (kind == "picture") {
        Json layer;
        layer["image"] = name;
        document["artwork"].push_back(layer);
        note(name, "layer", "");
      } else {
        note(name, "unused", "The studio does not know what to do with this file.");
      }
    }
  } catch (const InputError& error) {
    if (!lock) lock.lock();
    dropped_.refuse(names);
    throw bad_file(error.what(), files_);
  }
  accept(document, checked(document), client, false, 0, true);
  dropped_.accept(names);
  tabs_.tell("files", files_event());
  return {{"revision", revision_}, {"document", document_}, {"adopted", adopted}};
}

std::string OpenJob::job_toml(const std::filesystem::path& folder) const {
  const std::lock_guard lock(mutex_);
  return job_file(config_, folder, machine_names());
}

Json OpenJob::save(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (const std::string own = cut_utf8(name, kLongestName);
      !own.empty() && own != document_.value("name", "")) {
    document_["name"] = own;
    ++revision_;
    tabs_.tell("document", {{"revision", revision_}, {"document", document_}, {"client", ""}},
               true);
  }
  const std::string stem = file_name_of(name_of_job(document_));
  // The studio's own files follow the job's name.
  const bool moves = where_.parent_path() == files_.uploads() && where_.stem() != stem;
  const std::filesystem::path before = where_;
  std::filesystem::path file = before;
  std::error_code ignored;
  if (before.empty() || moves) {
    // Beside the model that was named on the command line; what was dropped here stays here.
    const std::filesystem::path folder = origin_.empty() ? files_.uploads() : origin_.parent_path();
    file = folder / (stem + ".toml");
    for (int number = 2; file != before && std::filesystem::exists(file, ignored); ++number)
      file = folder / fmt::format("{}-{}.toml", stem, number);
  }
  try {
    JobConfig config = config_;
    if (!lies_in(file, files_.uploads()))
      bring_along(config, files_.uploads(), file.parent_path(), work_);
    write_whole(file, job_file(config, file.parent_path(), machine_names()));
  } catch (const InputError& error) {
    throw ApiError(422, "bad-file", error.what());
  }
  where_ = file;
  tell_saved();
  autosave();
  // Last, so that whatever fails before leaves a file where the job says that it is.
  if (moves && before != where_) std::filesystem::remove(before, ignored);
  return {{"saved_revision", saved_revision_}, {"where", shown_path(where_)}};
}

Json OpenJob::patch_of_profile(const std::filesystem::path& profile) {
  JobConfig config;
  SettingSources sources;
  sources.profiles = {profile};
  apply_sources(config, sources);
  const std::lock_guard lock(mutex_);
  Json answer;
  answer["patch"] = values_of(config, names_in_profile(profile), files_);
  return answer;
}

void OpenJob::save_profile(const std::filesystem::path& folder, const std::string& name) const {
  const std::filesystem::path draft = home_ / "profile.toml";
  {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> names;
    for (const Parameter& p : parameters()) {
      const bool reusable =
          std::any_of(kOfProfiles.begin(), kOfProfiles.end(),
                      [&](const char* group) { return p.name.starts_with(group); });
      const bool sheet = p.name == "film.width_mm" || p.name == "film.height_mm";
      if (sheet || (reusable && p.name != "print.job_name" && p.get(config_) != p.default_value()))
        names.push_back(p.name);
    }
    write_whole(draft, settings_file(config_, names));
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
    config = config_;
    of_the_run = machine_names();
    name = file_name_of(name_of_job(document_));
  }
  // Whoever fetches an earlier archive still has that.
  const std::filesystem::path made =
      pack_job(std::move(config), of_the_run, name, home_ / "packed", work_);
  std::filesystem::path archive = home_ / "job.zip";
  std::error_code error;
  std::filesystem::rename(made, archive, error);
  if (error) throw ApiError(500, "failed", "The archive cannot be kept; free some space.");
  return archive;
}

void OpenJob::reload() {
  const std::lock_guard lock(mutex_);
  config_ = checked(document_);
  ++reloads_;
  ask(false);
}

std::string OpenJob::name() const {
  const std::lock_guard lock(mutex_);
  return name_of_job(document_);
}

// ---- files ----

// With the lock.
Json OpenJob::files_json() const {
  Json list = Json::array();
  for (const std::string& name : files_.names()) {
    std::error_code none;
    const std::uintmax_t bytes = std::filesystem::file_size(files_.find(name), none);
    list.push_back({{"file", name}, {"kind", kind_of_file(name)}, {"bytes", none ? 0 : bytes}});
  }
  return list;
}

// With the lock.
Json OpenJob::files_event() const {
  Json event;
  event["files"] = files_json();
  return event;
}

OpenJob::Upload OpenJob::begin_upload(const std::string& wanted) {
  const std::lock_guard lock(mutex_);
  return {wanted, home_ / fmt::format("upload-{}.part", ids_.number()), dropped_.room_for(wanted)};
}

Json OpenJob::end_upload(const Upload& upload) {
  const std::lock_guard lock(mutex_);
  const std::string name = dropped_.keep(upload.file, upload.name);
  tabs_.tell("files", files_event());
  return {{"file", name}, {"kind", kind_of_file(name)}};
}

std::filesystem::path OpenJob::file(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  return files_.find(name);
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
                         {"revision", revision_},
                         {"saved_revision", saved_revision_}});
  for (const auto& [event, data] : shown_.events()) stream->push(event, data);
  for (const Json& task : tasks) stream->push("task", task);
  if (at_rest_) ask(false);
  return stream;
}

void OpenJob::disconnect(const std::string& client, const std::shared_ptr<EventStream>& stream) {
  const std::lock_guard lock(mutex_);
  if (!tabs_.disconnect(client, stream) || !tabs_.none()) return;
  autosave_if_possible();  // nobody has it open: what comes later recovers nothing
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
  autosave_if_possible();
}

bool OpenJob::let_go() {
  const std::lock_guard lock(mutex_);
  if (!tabs_.none() || tasks_->any_running()) return false;
  let_go_ = true;
  work_.cancel();
  return true;
}

// ---- what was computed ----

bool OpenJob::has_given(const std::string& id) const { return ids_.has_given(id); }

std::string OpenJob::show_mesh(const Model& model, const Object& object) {
  std::string id = ids_.mesh();
  auto made = std::make_shared<const ShownMesh>(
      shown_mesh(model, object, id, address() + "/meshes/" + id, work_.quiet()));
  const std::lock_guard lock(mutex_);
  shown_.add_mesh(id, std::move(made));
  return id;
}

// With the lock.
void OpenJob::tell_mesh(long revision, const std::string& wanted) {
  tell_held("mesh", {{"revision", revision}, {"mesh", shown_.model_mesh()}, {"wanted", wanted}});
}

// With the lock.
void OpenJob::tell_held(const std::string& event, const Json& data) {
  tabs_.tell(event, shown_.hold(event, data), true);
}

// Of the live results' thread.
LiveSinks OpenJob::sinks() {
  LiveSinks sinks;
  sinks.model = [this](long revision, const std::shared_ptr<const Model>& model) {
    const std::string id = show_mesh(*model, *model->object);
    const std::lock_guard lock(mutex_);
    shown_.set_model_mesh(id);
    tell_mesh(revision, id);
  };
  sinks.painted = [this](long revision, const Model& model, const Object& painted) {
    const bool own = &painted == model.object.get();
    const std::string id = own ? "" : show_mesh(model, painted);
    const std::lock_guard lock(mutex_);
    tell_mesh(revision, own ? shown_.model_mesh() : id);
  };
  sinks.look = [this](long revision, const Look& look, double took_s) {
    show_look(revision, look, took_s);
  };
  sinks.finish = [this](long revision, const Model& model, const DipsTogether* look) {
    if (look) show_finish(model, *look);
    const std::lock_guard lock(mutex_);
    tell_held("finish", {{"revision", revision}, {"finish", shown_.finish_id()}});
  };
  sinks.no_finish = [this](long revision, const std::string& text) {
    const std::lock_guard lock(mutex_);
    tell_held("finish",
              {{"revision", revision}, {"problem", without_folder(text, files_.uploads())}});
  };
  sinks.problem = [this](long revision, const Problem& problem) {
    const std::lock_guard lock(mutex_);
    tell_held("problem", {{"revision", revision},
                          {"code", problem.code},
                          {"text", without_folder(problem.text, files_.uploads())},
                          {"mends", problem.mends}});
  };
  sinks.working = [this](long revision, const std::string& quality, const std::string& activity,
                         double fraction) {
    Json event = {{"revision", revision}, {"quality", quality.empty() ? Json() : Json(quality)}};
    if (!quality.empty()) {
      event["activity"] = activity;
      event["fraction"] = fraction;
    }
    const std::lock_guard lock(mutex_);
    tabs_.tell("working", event, true);
  };
  return sinks;
}

void OpenJob::show_look(long revision, const Look& look, double took_s) {
  ShownResults::Result result;
  result.id = ids_.result();
  result.dip = look.dip;
  result.made = look.made;
  result.bundle = std::make_shared<const std::vector<std::uint8_t>>(result_bundle(
      look, {{"result", result.id}, {"revision", revision}}, files_.uploads(), work_.quiet()));
  result.event = {{"revision", revision},
                  {"quality", quality_name(look.quality)},
                  {"dip", look.dip},
                  {"result", result.id},
                  {"took_s", took_s}};
  const std::lock_guard lock(mutex_);
  shown_.hold("problem", nullptr);
  tabs_.tell("result", result.event, true, std::to_string(look.dip));
  shown_.add_result(std::move(result));
}

void OpenJob::show_finish(const Model& model, const DipsTogether& look) {
  const std::array<std::string, 2> meshes = {show_mesh(model, look.colors),
                                             show_mesh(model, look.parts)};
  const std::string id = ids_.finish();
  auto bundle = std::make_shared<const std::vector<std::uint8_t>>(finish_bundle(
      look, {{"finish", id}, {"mesh", meshes[0]}, {"parts", meshes[1]}}, files_.uploads()));
  const std::lock_guard lock(mutex_);
  shown_.set_finish(id, std::move(bundle), meshes);
}

std::shared_ptr<const std::vector<std::uint8_t>> OpenJob::mesh(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return shown_.mesh(id);
}

std::shared_ptr<const ShownTexture> OpenJob::texture(const std::string& id,
                                                     std::size_t number) const {
  const std::lock_guard lock(mutex_);
  return shown_.texture(id, number);
}

std::shared_ptr<const std::vector<std::uint8_t>> OpenJob::result(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return shown_.result(id);
}

std::shared_ptr<const std::vector<std::uint8_t>> OpenJob::finish(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return shown_.finish(id);
}

std::shared_ptr<const std::vector<std::uint8_t>> OpenJob::dip(const std::string& id) const {
  std::shared_ptr<const Designed> made;
  {
    const std::lock_guard lock(mutex_);
    made = shown_.made(id);
  }
  if (!made) return nullptr;
  return std::make_shared<const std::vector<std::uint8_t>>(dip_bundle(made->dipped));
}

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
  const Json named = request.value("kind", Json());
  const std::string kind = named.is_string() ? named.get<std::string>() : "";
  if (kind != "print" && kind != "orient" && kind != "plan")
    throw ApiError(400, "bad-request", "A task is print, orient or plan.");
  TaskRequest task;
  task.kind = kind;
  task.name = ids_.task();
  task.address = address() + "/tasks";
  task.uploads = files_.uploads();
  const std::lock_guard lock(mutex_);
  if (let_go_) throw no_such_job();
  tasks_->require_free(kind);  // before the job file is written that a running print reads
  task.config = checked(document_);
  task.revision = revision_;
  if (task.config.model.empty())
    throw ApiError(422, "no-model", "There is no model yet: drop one here, or open a sample.");
  if (kind == "plan") {
    const Json dips = request.value("dips", Json(2));
    if (!dips.is_number_integer())
      throw ApiError(400, "bad-request", "The request's dips is no whole number.");
    task.config.plan.dips =
        int(std::clamp<std::int64_t>(dips.get<std::int64_t>(), 0, kMostDips + 1));
    if (task.config.plan.dips < 1 || task.config.plan.dips > kMostDips)
      throw ApiError(422, "bad-value", fmt::format("A job has 1 to {} dips.", kMostDips),
                     "plan.dips");
    task.dips = document_.value("dips", Json::array());
  }
  if (kind == "orient") {
    // Looked for anew, whatever is said now; the depth too.
    task.config.design.trajectory = TrajectoryOptions{};
    task.config.dips.clear();
  }
  if (kind == "print") {
    task.job = home_ / "job.toml";
    write_whole(task.job, job_file(task.config, home_, machine_names()));
    const std::string name =
        where_.empty() ? file_name_of(name_of_job(document_)) : where_.stem().string();
    const bool ours = where_.empty() || where_.parent_path() == files_.uploads();
    task.folder = ours ? home_ / "print" / name : where_.parent_path() / (name + "-print");
  } else {
    task.folder = home_ / "found" / fmt::format("{}-{}", kind, ids_.number());
  }
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
