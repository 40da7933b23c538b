#include "studio/job_store.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "base/error.h"
#include "base/file.h"
#include "base/json_nesting.h"
#include "studio/guard.h"

namespace hydrodip {
namespace {

constexpr const char* kState = "state.json";

std::filesystem::path home_folder() {
  const char* home = std::getenv("HOME");
  return home && *home ? std::filesystem::path(home) : std::filesystem::path();
}

bool is_job_name(const std::string& name) {
  return name.size() == 16 && name.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// As JobStore::write() is given it; a person may have edited the file.
bool is_state(const Json& state) {
  static const std::vector<std::pair<const char*, Json::value_t>> members = {
      {"name", Json::value_t::string},    {"where", Json::value_t::string},
      {"origin", Json::value_t::string},  {"open", Json::value_t::boolean},
      {"granted", Json::value_t::object}, {"machine", Json::value_t::object},
      {"document", Json::value_t::object}};
  if (!state.is_object()) return false;
  for (const char* count : {"revision", "saved_revision"})
    if (state.contains(count) && !state[count].is_number_integer()) return false;
  const Json granted = state.value("granted", Json::object());
  return std::all_of(members.begin(), members.end(),
                     [&](const auto& member) {
                       return !state.contains(member.first) ||
                              state[member.first].type() == member.second;
                     }) &&
         std::all_of(granted.begin(), granted.end(),
                     [](const Json& path) { return path.is_string(); });
}

std::string time_text(std::filesystem::file_time_type time) {
  const auto system = std::chrono::file_clock::to_sys(time);
  return fmt::format(
      "{:%Y-%m-%dT%H:%M:%SZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(
          std::chrono::time_point_cast<std::chrono::system_clock::duration>(system))));
}

}  // namespace

std::string shown_path(const std::filesystem::path& path) {
  const std::filesystem::path home = home_folder();
  if (home.empty() || home == "/") return path.string();
  const std::filesystem::path inside = path.lexically_relative(home);
  if (inside.empty() || *inside.begin() == "..") return path.string();
  return (std::filesystem::path("~") / inside).string();
}

std::filesystem::path studio_folder() {
  const char* data = std::getenv("XDG_DATA_HOME");
  std::filesystem::path base =
      data && *data == '/' ? std::filesystem::path(data) : home_folder() / ".local/share";
  if (!base.is_absolute()) base = std::filesystem::temp_directory_path();
  std::filesystem::path folder = base / "hydrodip/studio";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError(fmt::format(
        "{}: the studio keeps its jobs here, and it cannot be made ({}); set XDG_DATA_HOME to a "
        "folder that can be written to",
        folder.string(), error.message()));
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all, error);
  return folder;
}

std::string JobStore::create() const {
  std::string job = random_hex(8);
  std::error_code error;
  std::filesystem::create_directories(home(job) / "files", error);
  if (error)
    throw InputError(fmt::format("{}: cannot be made ({}); free some space", home(job).string(),
                                 error.message()));
  return job;
}

bool JobStore::has(const std::string& job) const {
  std::error_code ignored;
  return is_job_name(job) && std::filesystem::is_directory(home(job), ignored);
}

std::filesystem::path JobStore::home(const std::string& job) const {
  return folder_ / "jobs" / job;
}

Json JobStore::read(const std::string& job) const {
  try {
    Json state = parsed_json<Json>(read_file(home(job) / kState));
    return is_state(state) ? state : Json(nullptr);
  } catch (const std::exception&) {
    return nullptr;
  }
}

void JobStore::write(const std::string& job, const Json& state) const {
  write_whole(home(job) / kState, text_of(state));
}

void JobStore::write_left(const std::string& job, const Json& state) const {
  const std::filesystem::path file = home(job) / kState;
  Json before = read(job);
  std::error_code none;
  const auto changed = std::filesystem::last_write_time(file, none);
  write(job, state);
  if (!before.is_object() || none) return;
  before["open"] = state.value("open", false);
  if (before == state) std::filesystem::last_write_time(file, changed, none);
}

std::vector<std::string> JobStore::jobs() const {
  std::vector<std::pair<std::filesystem::file_time_type, std::string>> found;
  std::error_code error;
  for (auto entry = std::filesystem::directory_iterator(folder_ / "jobs", error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code none;
    const auto changed = std::filesystem::last_write_time(entry->path() / kState, none);
    if (!none && is_job_name(name)) found.emplace_back(changed, name);
  }
  std::sort(found.rbegin(), found.rend());
  std::vector<std::string> names;
  names.reserve(found.size());
  for (auto& [changed, name] : found) names.push_back(std::move(name));
  return names;
}

Json JobStore::recent(std::size_t most) const {
  Json list = Json::array();
  for (const std::string& job : jobs()) {
    if (list.size() >= most) break;
    const Json state = read(job);
    if (!state.is_object() || !state.contains("document")) continue;
    const Json& document = state["document"];
    if (!document.contains("object") && !document.contains("artwork")) continue;  // empty
    std::error_code none;
    const bool pictured = std::filesystem::exists(home(job) / kThumbnail, none);
    list.push_back(
        {{"job", job},
         {"name", state.value("name", "")},
         {"where", state.value("where", "").empty() ? "" : shown_path(state.value("where", ""))},
         {"changed", time_text(std::filesystem::last_write_time(home(job) / kState, none))},
         {"unsaved", state.value("revision", 0) != state.value("saved_revision", 0)},
         {"recovered", state.value("open", false)},
         {"thumbnail", pictured ? "/api/jobs/" + job + "/thumbnail" : ""}});
  }
  return list;
}

void JobStore::forget(const std::string& job) const {
  if (!has(job)) return;
  std::error_code ignored;
  std::filesystem::remove_all(home(job), ignored);
}

std::string JobStore::opened_from(const std::filesystem::path& file) const {
  const std::string whole = std::filesystem::absolute(file).lexically_normal().string();
  for (const std::string& job : jobs()) {
    const Json state = read(job);
    if (!state.is_object()) continue;
    if (state.value("origin", "") == whole || state.value("where", "") == whole) return job;
  }
  return "";
}

}  // namespace hydrodip
