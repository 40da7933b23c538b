#include "studio/job_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "model_io/load.h"
#include "settings/job_file.h"
#include "settings/params.h"
#include "settings/settings.h"
#include "studio/api_error.h"
#include "studio/document.h"
#include "studio/job_copies.h"
#include "studio/job_store.h"

namespace hydrodip {
namespace {

constexpr std::array<const char*, 7> kOfProfiles = {"film.", "material.", "ink.",   "print.",
                                                    "bath.", "process.",  "report."};

bool is_of_profiles(const Parameter& p, const JobConfig& config) {
  if (p.name == "film.width_mm" || p.name == "film.height_mm") return true;
  const bool reusable = std::any_of(kOfProfiles.begin(), kOfProfiles.end(),
                                    [&](const char* group) { return p.name.starts_with(group); });
  return reusable && p.name != "print.job_name" && p.get(config) != p.default_value();
}

}  // namespace

bool is_job_file(const std::filesystem::path& file) { return file.extension() == ".toml"; }

JobConfig config_of_file(const std::filesystem::path& file) {
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
  if (!std::filesystem::exists(config.model, error))
    throw InputError(
        fmt::format("{}: there is no such file; check its name", config.model.string()));
  require_model_file(config.model);
  if (!std::filesystem::is_regular_file(config.model, error))
    throw InputError(fmt::format("{}: it is no file; name the model's own", config.model.string()));
  return config;
}

JobDocument::JobDocument(std::filesystem::path home, const Json& kept)
    : home_(std::move(home)), files_(home_ / "files") {
  std::error_code ignored;
  std::filesystem::create_directories(files_.uploads(), ignored);
  if (!kept.is_object()) return;
  files_.set_granted(kept.value("granted", Json::object()));
  document_ = kept.value("document", Json::object());
  machine_ = kept.value("machine", Json::object());
  revision_ = kept.value("revision", 1L);
  saved_revision_ = kept.value("saved_revision", 1L);
  where_ = kept.value("where", "");
  origin_ = kept.value("origin", "");
  try {
    config_ = checked(document_);
  } catch (const ApiError&) {
    // A file of it has gone: the page says so when it asks for a result.
  }
}

std::string JobDocument::name() const { return name_of_job(document_); }

std::string JobDocument::shown_where() const { return where_.empty() ? "" : shown_path(where_); }

std::vector<std::string> JobDocument::machine_names() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : machine_.items()) names.push_back(name);
  return names;
}

Json JobDocument::state(bool open) const {
  return {{"version", 1},
          {"name", name()},
          {"where", where_.string()},
          {"origin", origin_.string()},
          {"revision", revision_},
          {"saved_revision", saved_revision_},
          {"open", open},
          {"granted", files_.granted()},
          {"machine", machine_},
          {"document", document_}};
}

JobConfig JobDocument::checked(const Json& document, const Json& machine) const {
  if (text_of(document).size() > kLargestDocument)
    throw ApiError(413, "too-large", "The job's document is too large.");
  JobConfig config = config_of(document, files_);
  apply_machine_values(machine, config);
  // What was uploaded may come from anybody, and names no other file of this machine.
  if (lies_in(config.model, files_.uploads())) config.object.load.confined_to = files_.uploads();
  return config;
}

bool JobDocument::accept(const Json& document, const JobConfig& config) {
  const bool stays_saved = saved_revision_ == revision_ && document == document_;
  document_ = document;
  config_ = config;
  ++revision_;
  if (stays_saved) set_saved();
  return stays_saved;
}

void JobDocument::read_again() { config_ = checked(document_); }

bool JobDocument::rename(const std::string& name) {
  if (name.empty() || name == document_.value("name", "")) return false;
  document_["name"] = name;
  ++revision_;
  return true;
}

OtherJob JobDocument::by_file(const std::filesystem::path& file, const JobConfig& config) {
  OtherJob other{document_of(config, files_), machine_values_of(config), where_, origin_};
  // What a job file does not say.
  for (const char* own : {"name", "page"})
    if (document_.contains(own)) other.document[own] = document_[own];
  const auto whole = std::filesystem::absolute(file).lexically_normal();
  if (whole != where_) other.origin = whole;
  if (is_job_file(file)) other.where = whole;
  return other;
}

OtherJob JobDocument::by_uploaded(const std::string& job_file) const {
  JobConfig config;
  SettingSources sources;
  sources.configs = {files_.find(job_file)};
  apply_sources(config, sources);
  // Such a file may name anything on this machine: only what came with it is taken.
  JobFiles uploaded(files_.uploads());
  Json document = document_of(config, uploaded);
  if (!uploaded.granted().empty()) {
    const std::string missing = uploaded.granted().begin().key();
    throw ApiError(
        422, "bad-file",
        fmt::format("The job needs {}: drop it here together with {}.", missing, job_file));
  }
  return {std::move(document), machine_values_of(config), where_, origin_};
}

void JobDocument::replace_by(OtherJob other) {
  machine_ = std::move(other.machine);
  where_ = std::move(other.where);
  origin_ = std::move(other.origin);
}

std::string JobDocument::job_file_text(const std::filesystem::path& folder) const {
  return job_file(config_, folder, machine_names());
}

std::filesystem::path JobDocument::save(const RunContext& context) {
  const std::string stem = file_name_of(name());
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
      bring_along(config, files_.uploads(), file.parent_path(), context);
    write_whole(file, job_file(config, file.parent_path(), machine_names()));
  } catch (const InputError& error) {
    throw ApiError(422, "bad-file", error.what());
  }
  where_ = file;
  set_saved();
  return moves && before != where_ ? before : std::filesystem::path();
}

std::string JobDocument::profile_text() const {
  std::vector<std::string> names;
  for (const Parameter& p : parameters())
    if (is_of_profiles(p, config_)) names.push_back(p.name);
  return settings_file(config_, names);
}

}  // namespace hydrodip
