#include "studio/open_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "job/profile_jobs.h"
#include "model_io/text.h"
#include "report/plain_words.h"
#include "settings/dip_tables.h"
#include "settings/job_file.h"
#include "settings/settings.h"
#include "studio/api_error.h"
#include "studio/document.h"
#include "studio/zip.h"

namespace hydrodip {
namespace {

constexpr std::array<const char*, 5> kTextureWords = {"texture", "albedo", "diffuse", "basecolor",
                                                      "color"};
constexpr std::array<const char*, 7> kOfProfiles = {"film.", "material.", "ink.",   "print.",
                                                    "bath.", "process.",  "report."};
constexpr std::size_t kMeshesKept = 8, kResultsKept = 6, kMostTabs = 12;

ApiError input_error(const std::string& sentence, const JobFiles& files) {
  return {422, "bad-file", in_plain_words(without_folder(sentence, files.uploads()))};
}

ApiError gone() { return {404, "not-found", "There is no such job any more; begin a new one."}; }

// A name for a file from what a person calls a job.
std::string file_name_of(const std::string& name) {
  std::string safe;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool fine = byte >= 0x80 || std::isalnum(byte) || c == '-' || c == '_' || c == ' ' ||
                      c == ',' || c == '+';
    safe += fine ? c : '-';
  }
  while (!safe.empty() && (safe.front() == ' ' || safe.front() == '-')) safe.erase(0, 1);
  return safe.empty() ? "job" : safe.substr(0, 120);
}

// The picture that a model with texture coordinates and without colours must mean: the only one,
// and named like the model or like a texture.
std::string texture_for(const Model& model, const std::string& name,
                        const std::vector<std::string>& names) {
  if (model.object->uvs.empty() || model.object->has_appearance()) return "";
  std::vector<std::string> pictures;
  for (const std::string& other : names)
    if (kind_of_file(other) == "picture") pictures.push_back(other);
  if (pictures.size() != 1) return "";
  const auto stem_of = [](const std::string& file) {
    return lower(std::filesystem::path(file).stem().string());
  };
  const std::string stem = stem_of(pictures[0]);
  const bool meant = stem.starts_with(stem_of(name)) ||
                     std::any_of(kTextureWords.begin(), kTextureWords.end(), [&](const char* word) {
                       return stem.find(word) != std::string::npos;
                     });
  return meant ? pictures[0] : "";
}

// The files that the model itself names, as they are now; none of one that cannot be read.
std::vector<std::filesystem::path> parts_of_model(const JobConfig& config) {
  if (config.model.empty()) return {};
  LoadOptions own = config.object.load;
  own.texture.clear();
  try {
    std::vector<std::filesystem::path> files = load(config.model, own, RunContext()).files;
    std::erase(files, config.model);
    return files;
  } catch (const InputError&) {
    return {};
  }
}

std::vector<std::filesystem::path> with_parts(const JobConfig& config) {
  std::vector<std::filesystem::path> files = parts_of_model(config);
  files.insert(files.begin(), config.model);
  return files;
}

// Whether nothing is there yet, or the same.
bool may_become(const std::filesystem::path& to, const std::filesystem::path& file) {
  std::error_code ignored;
  return !std::filesystem::exists(to, ignored) || read_file(to) == read_file(file);
}

void copy_to(const std::filesystem::path& file, const std::filesystem::path& to) {
  std::error_code ignored;
  if (std::filesystem::exists(to, ignored)) return;
  std::filesystem::create_directories(to.parent_path(), ignored);
  const std::vector<std::uint8_t> bytes = read_file(file);
  write_file(to, bytes.data(), bytes.size());
}

// Files that name each other, as they lie to each other; into the folder, or if other ones of their
// names are there into one inside it. Where the first of them is then.
std::filesystem::path copy_together(const std::vector<std::filesystem::path>& files,
                                    const std::filesystem::path& folder) {
  std::filesystem::path root = files.front().parent_path();
  const auto is_outside = [&](const std::filesystem::path& file) { return !lies_in(file, root); };
  while (std::any_of(files.begin(), files.end(), is_outside)) root = root.parent_path();
  const auto inside = [&](const std::filesystem::path& file) {
    return std::filesystem::weakly_canonical(file).lexically_relative(
        std::filesystem::weakly_canonical(root));
  };
  std::filesystem::path into = folder;
  const auto fits = [&](const std::filesystem::path& file) {
    return may_become(into / inside(file), file);
  };
  const std::string stem = files.front().stem().string();
  for (int number = 1; !std::all_of(files.begin(), files.end(), fits); ++number)
    into = folder / (number == 1 ? stem : fmt::format("{}-{}", stem, number));
  for (const std::filesystem::path& file : files) copy_to(file, into / inside(file));
  return into / inside(files.front());
}

bool is_job_file(const std::filesystem::path& file) { return file.extension() == ".toml"; }

}  // namespace

OpenJob::OpenJob(JobStore store, std::string job, std::string run,
                 std::shared_ptr<std::atomic<long>> numbers)
    : store_(std::move(store)),
      job_(std::move(job)),
      run_(std::move(run)),
      home_(store_.home(job_)),
      numbers_(std::move(numbers)),
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
  unwatched_since_ = std::chrono::steady_clock::now();
  tasks_ = std::make_unique<Tasks>([this](const Json& task) {
    const std::lock_guard lock(mutex_);
    tell("task", task);
  });
  live_ = std::make_unique<Live>(sinks());
  at_rest_ = true;  // until somebody looks, or changes it
}

OpenJob::~OpenJob() {
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
          {"mesh", mesh_.empty() ? Json() : Json(mesh_)},
          {"tasks", tasks},
          {"result", results_.empty() ? Json() : Json(results_.front().id)}};
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
  require_pen(change.client);
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
  for (const Tab& tab : tabs_)
    if (tell_client || tab.client != client) tab.stream->push("document", event, true);
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
  if (let_go_) throw gone();
  store_.write(job_, {{"version", 1},
                      {"name", name_of_job(document_)},
                      {"where", where_.string()},
                      {"origin", origin_.string()},
                      {"revision", revision_},
                      {"saved_revision", saved_revision_},
                      {"open", !tabs_.empty()},
                      {"granted", files_.granted()},
                      {"machine", machine_},
                      {"document", document_}});
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
  tell("saved", {{"saved_revision", saved_revision_}, {"where", shown_path(where_)}});
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

// With the lock. What was dropped at once and meets files of the same names gets a folder of its
// own, in which every file has the name by which the others know it.
std::vector<std::string> OpenJob::take_in(const std::vector<std::string>& given) {
  const auto had_other_name = [&](const std::string& name) { return uploaded_as_.contains(name); };
  std::string folder;
  if (given.size() > 1 && std::any_of(given.begin(), given.end(), had_other_name))
    folder = files_.new_folder(had_other_name(given.front()) ? uploaded_as_[given.front()]
                                                             : given.front());
  std::vector<std::string> names;
  for (const std::string& name : given) {
    const std::filesystem::path file = files_.find(name);
    if (kind_of_file(name) == "archive") {
      unpack(name, names);
    } else if (folder.empty()) {
      names.push_back(name);
    } else {
      names.push_back(folder + "/" + (had_other_name(name) ? uploaded_as_[name] : name));
      require_plain_name(names.back());
      const std::filesystem::path to = files_.uploads() / names.back();
      std::error_code error;
      std::filesystem::create_directories(to.parent_path(), error);
      std::filesystem::rename(file, to, error);
      if (error) throw ApiError(500, "failed", "The files cannot be kept; free some space.");
    }
    uploaded_as_.erase(name);
  }
  return names;
}

// With the lock.
void OpenJob::unpack(const std::string& archive, std::vector<std::string>& names) {
  const std::filesystem::path file = files_.find(archive);
  const std::uintmax_t used = files_.uploaded_bytes();
  const std::uintmax_t most_bytes = used < kMostJobBytes ? kMostJobBytes - used : 0;
  const auto is_wanted = [](const std::string& inner) {
    return kind_of_file(inner) != "unknown" && kind_of_file(inner) != "archive";
  };
  try {
    bool meets_others = false;
    unpack_zip(file, most_bytes, [&](const std::string& inner) -> std::filesystem::path {
      meets_others = meets_others || (is_wanted(inner) && files_.has(inner));
      return {};
    });
    const std::string folder = meets_others ? files_.new_folder(archive) + "/" : "";
    unpack_zip(file, most_bytes, [&](const std::string& inner) -> std::filesystem::path {
      if (!is_wanted(inner) || files_.has(folder + inner)) return {};
      names.push_back(folder + inner);
      return files_.uploads() / names.back();
    });
  } catch (const InputError& error) {
    throw input_error(error.what(), files_);
  }
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
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
  require_pen(client);
  Json adopted = Json::array();
  const auto note = [&](const std::string& name, const std::string& as, const std::string& text) {
    adopted.push_back({{"file", name}, {"as", as}, {"text", text}});
  };
  const std::vector<std::string> names = take_in(given);
  Json document = document_;
  const auto first = [&](const std::string& kind) {
    const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
      return kind_of_file(name) == kind;
    });
    return found == names.end() ? std::string() : *found;
  };
  std::set<std::string> taken;
  try {
    if (const std::string job = first("job"); !job.empty()) {
      document = adopt_job_file(job);
      note(job, "job", "");
      taken.insert(names.begin(), names.end());
    } else if (const std::string model = first("model"); !model.empty()) {
      std::string texture;
      // Reading it tells which pictures are its own.
      if (names.size() > 1) {
        const std::filesystem::path path = files_.find(model);
        LoadOptions own;
        own.confined_to = files_.uploads();
        lock.unlock();
        const Model read = load(path, own, RunContext());
        lock.lock();
        // Meanwhile the job was anybody's.
        require_pen(client);
        document = document_;
        for (const auto& file : read.files) taken.insert(files_.grant(file));
        texture = texture_for(read, model, names);
      }
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
    throw input_error(error.what(), files_);
  }
  accept(document, checked(document), client, false, 0, true);
  tell("files", files_event());
  return {{"revision", revision_}, {"document", document_}, {"adopted", adopted}};
}

std::string OpenJob::job_toml(const std::filesystem::path& folder) const {
  const std::lock_guard lock(mutex_);
  return job_file(config_, folder, machine_names());
}

// With the lock. What was dropped on a job whose file lies elsewhere is copied beside that: nobody
// would look for it here, and it goes when the job is forgotten.
void OpenJob::bring_along(JobConfig& config) const {
  const std::filesystem::path folder = where_.parent_path();
  const auto is_ours = [&](const std::filesystem::path& file) {
    return lies_in(file, files_.uploads());
  };
  if (is_ours(where_)) return;
  if (is_ours(config.model)) config.model = copy_together(with_parts(config), folder);
  each_side_file(config, [&](std::filesystem::path& file) {
    if (!is_ours(file)) return;
    std::filesystem::path to = folder / file.filename();
    for (int number = 2; !may_become(to, file); ++number)
      to = folder / fmt::format("{}-{}{}", file.stem().string(), number, file.extension().string());
    copy_to(file, to);
    file = to;
  });
}

Json OpenJob::save(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (const std::string own = name.substr(0, 200);
      !own.empty() && own != document_.value("name", "")) {
    document_["name"] = own;
    ++revision_;
    tell("document", {{"revision", revision_}, {"document", document_}, {"client", ""}}, true);
  }
  const std::string stem = file_name_of(name_of_job(document_));
  // The studio's own files follow the job's name.
  if (where_.parent_path() == files_.uploads() && where_.stem() != stem) {
    std::error_code ignored;
    std::filesystem::remove(where_, ignored);
    where_.clear();
  }
  if (where_.empty()) {
    // Beside the model that was named on the command line; what was dropped here stays here.
    const std::filesystem::path folder = origin_.empty() ? files_.uploads() : origin_.parent_path();
    where_ = folder / (stem + ".toml");
    std::error_code ignored;
    for (int number = 2; std::filesystem::exists(where_, ignored); ++number)
      where_ = folder / fmt::format("{}-{}.toml", stem, number);
  }
  try {
    JobConfig config = config_;
    bring_along(config);
    write_whole(where_, job_file(config, where_.parent_path(), machine_names()));
  } catch (const InputError& error) {
    throw ApiError(422, "bad-file", error.what());
  }
  tell_saved();
  autosave();
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
  std::vector<std::pair<std::string, std::filesystem::path>> files;
  const std::filesystem::path folder = home_ / "packed";
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  std::filesystem::create_directories(folder, ignored);
  JobConfig config;
  std::string name;
  std::vector<std::string> of_the_run;
  {
    const std::lock_guard lock(mutex_);
    config = config_;
    of_the_run = machine_names();
    name = file_name_of(name_of_job(document_));
  }
  // Every file gets the place beside the job file from which the job names it.
  std::set<std::string> used;
  const auto put = [&](std::filesystem::path& file) {
    std::string inner = file.filename().string();
    for (int number = 2; used.contains(inner); ++number)
      inner = fmt::format("{}-{}{}", file.stem().string(), number, file.extension().string());
    used.insert(inner);
    files.emplace_back(inner, file);
    file = folder / inner;
  };
  for (const std::filesystem::path& file : parts_of_model(config)) {
    // A model may name any file: only what can be a part of one goes along.
    if (file == config.object.load.texture || kind_of_file(file.string()) == "unknown") continue;
    std::string inner = file.lexically_relative(config.model.parent_path()).string();
    if (inner.empty() || inner.starts_with("..")) inner = file.filename().string();
    if (used.insert(inner).second) files.emplace_back(inner, file);
  }
  if (!config.model.empty()) put(config.model);
  each_side_file(config, put);
  const std::filesystem::path toml = folder / (name + ".toml");
  write_whole(toml, job_file(config, folder, of_the_run));
  files.insert(files.begin(), {name + ".toml", toml});
  std::filesystem::path archive = folder / (name + ".zip");
  pack_zip(archive, files);
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
  const std::uintmax_t used = files_.uploaded_bytes();
  require_plain_name(wanted);
  if (kind_of_file(wanted) == "unknown")
    throw ApiError(422, "bad-file",
                   "This is no model, picture, job file or ZIP archive that the studio knows.");
  return {wanted, home_ / fmt::format("upload-{}.part", ++*numbers_),
          std::min(kMostFileBytes, used < kMostJobBytes ? kMostJobBytes - used : 0)};
}

Json OpenJob::end_upload(const Upload& upload) {
  const std::lock_guard lock(mutex_);
  const std::string name = files_.name_for_upload(upload.name);
  const std::filesystem::path file = files_.uploads() / name;
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  std::filesystem::rename(upload.file, file, error);
  if (error) throw ApiError(500, "failed", "The file cannot be kept; free some space.");
  if (name != upload.name) uploaded_as_[name] = upload.name;
  tell("files", files_event());
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
  if (let_go_) throw gone();
  if (tabs_.size() >= kMostTabs)
    throw ApiError(503, "busy", "The job is open in too many tabs; close some.");
  auto stream = std::make_shared<EventStream>();
  // The same tab anew: its old line is dead.
  for (const Tab& tab : tabs_)
    if (tab.client == client) tab.stream->close();
  std::erase_if(tabs_, [&](const Tab& tab) { return tab.client == client; });
  tabs_.push_back({client, stream});
  unwatched_since_.reset();
  if (pen_.empty()) pen_ = client;
  const bool mine = pen_ == client;
  stream->push("hello", {{"run", run_},
                         {"client", client},
                         {"pen", mine},
                         {"revision", revision_},
                         {"saved_revision", saved_revision_}});
  if (!mesh_event_.is_null()) stream->push("mesh", mesh_event_);
  // The newest of each dip, the last one last.
  std::set<std::size_t> told;
  std::vector<Json> newest;
  for (const Shown& shown : results_)
    if (told.insert(shown.event["dip"].get<std::size_t>()).second) newest.push_back(shown.event);
  for (auto event = newest.rbegin(); event != newest.rend(); ++event)
    stream->push("result", *event);
  if (!finish_event_.is_null()) stream->push("finish", finish_event_);
  if (!problem_event_.is_null()) stream->push("problem", problem_event_);
  for (const Json& task : tasks) stream->push("task", task);
  if (at_rest_) ask(false);
  return stream;
}

void OpenJob::disconnect(const std::string& client, const std::shared_ptr<EventStream>& stream) {
  const std::lock_guard lock(mutex_);
  const auto gone = std::erase_if(tabs_, [&](const Tab& tab) { return tab.stream == stream; });
  if (gone == 0) return;
  if (tabs_.empty()) {
    autosave_if_possible();  // nobody has it open: what comes later recovers nothing
    unwatched_since_ = std::chrono::steady_clock::now();
    at_rest_ = true;
    live_->rest();
  }
  if (pen_ == client) hand_pen_on();
}

// With the lock: to the tab that came next.
void OpenJob::hand_pen_on() {
  pen_ = tabs_.empty() ? "" : tabs_.front().client;
  tell_pen();
}

// With the lock.
void OpenJob::tell_pen() {
  for (const Tab& tab : tabs_) {
    Json event;
    event["mine"] = tab.client == pen_;
    tab.stream->push("pen", event);
  }
}

void OpenJob::take_pen(const std::string& client) {
  const std::lock_guard lock(mutex_);
  const bool known =
      std::any_of(tabs_.begin(), tabs_.end(), [&](const Tab& t) { return t.client == client; });
  if (!known) throw ApiError(404, "not-found", "This tab gets no events yet; connect first.");
  pen_ = client;
  tell_pen();
}

// With the lock.
void OpenJob::require_pen(const std::string& client) const {
  if (pen_.empty() || pen_ == client) return;
  throw ApiError(409, "no-pen", "The job is open in another tab; take over there or here.");
}

std::optional<std::chrono::steady_clock::time_point> OpenJob::idle_since() const {
  if (tasks_->any_running()) return std::nullopt;
  const std::lock_guard lock(mutex_);
  return unwatched_since_;
}

void OpenJob::say_goodbye(const std::string& text) {
  const std::lock_guard lock(mutex_);
  for (const Tab& tab : tabs_) {
    Json event;
    event["text"] = text;
    tab.stream->push("bye", event);
    tab.stream->close();
  }
  tabs_.clear();
  autosave_if_possible();
}

bool OpenJob::let_go() {
  const std::lock_guard lock(mutex_);
  if (!tabs_.empty() || tasks_->any_running()) return false;
  let_go_ = true;
  return true;
}

// With the lock.
void OpenJob::tell(const std::string& event, const Json& data, bool newest_only,
                   const std::string& about) {
  for (const Tab& tab : tabs_) tab.stream->push(event, data, newest_only, about);
}

// ---- what was computed ----

// With the lock.
std::string OpenJob::new_id(char kind) {
  return fmt::format("{}-{}{}", run_.substr(0, 8), kind, ++*numbers_);
}

bool OpenJob::has_given(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const std::string prefix = run_.substr(0, 8) + "-";
  if (!id.starts_with(prefix) || id.size() < prefix.size() + 2) return false;
  const char kind = id[prefix.size()];
  long number = 0;
  const char* const end = id.data() + id.size();
  const auto [rest, error] = std::from_chars(id.data() + prefix.size() + 1, end, number);
  return (kind == 'm' || kind == 'r' || kind == 'f') && error == std::errc() && rest == end &&
         number > 0 && number <= *numbers_;
}

std::string OpenJob::show_mesh(const Model& model, const Object& object) {
  std::string id;
  {
    const std::lock_guard lock(mutex_);
    id = new_id('m');
  }
  auto made = std::make_shared<const ShownMesh>(
      shown_mesh(model, object, id, address() + "/meshes/" + id, RunContext()));
  const std::lock_guard lock(mutex_);
  meshes_.emplace_front(id, std::move(made));
  // The model's own mesh and the finish stay.
  for (auto old = std::prev(meshes_.end()); meshes_.size() > kMeshesKept; --old)
    if (old->first != mesh_ && old->first != finish_meshes_[0] && old->first != finish_meshes_[1])
      old = meshes_.erase(old);
  return id;
}

// With the lock.
void OpenJob::tell_mesh(long revision, const std::string& wanted) {
  mesh_event_ = {{"revision", revision}, {"mesh", mesh_}, {"wanted", wanted}};
  tell("mesh", mesh_event_, true);
}

LiveSinks OpenJob::sinks() {
  LiveSinks sinks;
  sinks.model = [this](long revision, const std::shared_ptr<const Model>& model,
                       const std::vector<std::string>&) {
    const std::string id = show_mesh(*model, *model->object);
    const std::lock_guard lock(mutex_);
    mesh_ = id;
    tell_mesh(revision, id);
  };
  sinks.painted = [this](long revision, const Model& model, const Object& painted) {
    const bool own = &painted == model.object.get();
    const std::string id = own ? "" : show_mesh(model, painted);
    const std::lock_guard lock(mutex_);
    tell_mesh(revision, own ? mesh_ : id);
  };
  sinks.look = [this](long revision, const Look& look, double took_s) {
    Shown shown;
    shown.revision = revision;
    {
      const std::lock_guard lock(mutex_);
      shown.id = new_id('r');
    }
    shown.made = look.made;
    shown.bundle = std::make_shared<const std::vector<std::uint8_t>>(
        result_bundle(look, {{"result", shown.id}, {"revision", revision}}, RunContext()));
    shown.event = {{"revision", revision},
                   {"quality", look.quality == LookQuality::kNormal ? "normal" : "draft"},
                   {"dip", look.dip},
                   {"result", shown.id},
                   {"took_s", took_s}};
    const std::lock_guard lock(mutex_);
    problem_event_ = nullptr;
    tell("result", shown.event, true, std::to_string(look.dip));
    results_.push_front(std::move(shown));
    keep_newest_results();
  };
  sinks.finish = [this](long revision, const Model& model, const DipsTogether* look) {
    if (look) {
      const std::array<std::string, 2> meshes = {show_mesh(model, look->colors),
                                                 show_mesh(model, look->parts)};
      std::string id;
      {
        const std::lock_guard lock(mutex_);
        finish_meshes_ = meshes;
        id = new_id('f');
      }
      auto bundle = std::make_shared<const std::vector<std::uint8_t>>(
          finish_bundle(*look, {{"finish", id}, {"mesh", meshes[0]}, {"parts", meshes[1]}}));
      const std::lock_guard lock(mutex_);
      finish_ = {id, std::move(bundle)};
    }
    const std::lock_guard lock(mutex_);
    finish_event_ = {{"revision", revision}, {"finish", finish_.first}};
    tell("finish", finish_event_, true);
  };
  sinks.no_finish = [this](long revision, const std::string& text) {
    const std::lock_guard lock(mutex_);
    finish_event_ = {{"revision", revision}, {"problem", without_folder(text, files_.uploads())}};
    tell("finish", finish_event_, true);
  };
  sinks.problem = [this](long revision, const Problem& problem) {
    const std::lock_guard lock(mutex_);
    problem_event_ = {{"revision", revision},
                      {"code", problem.code},
                      {"text", without_folder(problem.text, files_.uploads())},
                      {"mends", problem.mends}};
    tell("problem", problem_event_, true);
  };
  sinks.working = [this](long revision, const std::string& quality, const std::string& activity,
                         double fraction) {
    Json event = {{"revision", revision}, {"quality", quality.empty() ? Json() : Json(quality)}};
    if (!quality.empty()) {
      event["activity"] = activity;
      event["fraction"] = fraction;
    }
    const std::lock_guard lock(mutex_);
    tell("working", event, true);
  };
  return sinks;
}

// With the lock. The newest of each dip, and besides them the last few.
void OpenJob::keep_newest_results() {
  std::set<std::size_t> seen;
  std::size_t kept = 0;
  for (auto shown = results_.begin(); shown != results_.end();) {
    const bool newest = seen.insert(shown->event["dip"].get<std::size_t>()).second &&
                        seen.size() <= std::size_t(kMostDips);
    if (newest || kept < kResultsKept) {
      ++kept;
      ++shown;
    } else {
      shown = results_.erase(shown);
    }
  }
}

std::shared_ptr<const std::vector<std::uint8_t>> OpenJob::mesh(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  for (const auto& [known, shown] : meshes_)
    if (known == id) return {shown, &shown->bundle};
  return nullptr;
}

std::shared_ptr<const ShownTexture> OpenJob::texture(const std::string& id,
                                                     std::size_t number) const {
  const std::lock_guard lock(mutex_);
  for (const auto& [known, shown] : meshes_)
    if (known == id && number < shown->textures.size()) return shown->textures[number];
  return nullptr;
}

std::shared_ptr<const std::vector<std::uint8_t>> OpenJob::result(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  for (const Shown& shown : results_)
    if (shown.id == id) return shown.bundle;
  return nullptr;
}

std::shared_ptr<const std::vector<std::uint8_t>> OpenJob::finish(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return id == finish_.first ? finish_.second : nullptr;
}

std::shared_ptr<const std::vector<std::uint8_t>> OpenJob::dip(const std::string& id) const {
  std::shared_ptr<const Designed> made;
  {
    const std::lock_guard lock(mutex_);
    for (const Shown& shown : results_)
      if (shown.id == id) made = shown.made;
  }
  if (!made) return nullptr;
  return std::make_shared<const std::vector<std::uint8_t>>(dip_bundle(made->dipped));
}

Json OpenJob::counts() const {
  const Live::Counts counts = live_->counts();
  return {{"drafts", counts.drafts},
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
  task.address = address() + "/tasks";
  task.uploads = files_.uploads();
  const std::lock_guard lock(mutex_);
  if (let_go_) throw gone();
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
    task.folder = home_ / "found" / fmt::format("{}-{}", kind, ++*numbers_);
  }
  std::error_code ignored;
  std::filesystem::create_directories(task.folder.parent_path(), ignored);
  return tasks_->start(std::move(task));
}

void OpenJob::cancel_task(const std::string& task) {
  if (!tasks_->cancel(task)) throw ApiError(404, "not-found", "There is no such task.");
}

std::filesystem::path OpenJob::task_folder(const std::string& task) const {
  return tasks_->folder(task);
}

}  // namespace hydrodip
