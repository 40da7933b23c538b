#include "studio/api.h"

#include <chrono>
#include <exception>
#include <iterator>
#include <new>
#include <utility>

#include "base/error.h"
#include "report/plain_words.h"
#include "settings/profiles.h"
#include "studio/entrance.h"
#include "studio/file_answers.h"
#include "studio/hello.h"
#include "studio/job_requests.h"
#include "studio/json_answers.h"
#include "studio/page_assets.h"
#include "studio/request_values.h"

namespace hydrodip {
namespace {

constexpr std::size_t kMostRecent = 20;
constexpr auto kUnwatched = std::chrono::minutes(2);

}  // namespace

Api::Api(JobStore store, Guard guard, std::string run, std::function<void()> quit,
         std::filesystem::path profiles)
    : store_(std::move(store)),
      shelf_(store_.samples()),
      guard_(std::move(guard)),
      run_(std::move(run)),
      quit_(std::move(quit)),
      profiles_(std::move(profiles)) {}

Admission Api::admit(const HttpRequest& request) const {
  if (const auto refusal = guard_.refuses_origin(request)) return {false, error_answer(*refusal)};
  const bool entering = request.path == "/" || request.path == "/login";
  const bool is_known = guard_.knows(request);
  if (entering || is_known) return {is_known, std::nullopt};
  return {false, error_answer({403, "no-token",
                               "The studio does not know this browser: open the address that it "
                               "printed."})};
}

HttpAnswer Api::answer(HttpRequest& request) {
  HttpAnswer answer;
  try {
    answer = route(request);
  } catch (const ApiError& error) {
    answer = error_answer(error);
  } catch (const InputError& error) {
    answer = error_answer({422, "bad-file", in_plain_words(error.what())});
  } catch (const Cancelled&) {
    answer = error_answer({500, "failed", "The job was closed before that was done."});
  } catch (const std::bad_alloc&) {
    answer = error_answer({500, "failed", "There is not enough memory for this."});
  } catch (const std::exception& error) {
    answer = error_answer({500, "failed", error.what()});
  }
  answer.headers.emplace_back("X-Content-Type-Options", "nosniff");
  answer.headers.emplace_back("Referrer-Policy", "no-referrer");
  answer.headers.emplace_back("Cross-Origin-Resource-Policy", "same-origin");
  answer.headers.emplace_back("Cross-Origin-Opener-Policy", "same-origin");
  return answer;
}

HttpAnswer Api::route(HttpRequest& request) {
  const std::string& path = request.path;
  const bool reads = request.method == "GET";
  if (path == "/" && reads) return enter(guard_, request);
  if (path == "/login" && request.method == "POST") return log_in(guard_, request);
  if (!guard_.knows(request)) throw not_found();
  if (path == "/app.js" && reads) return page_answer("text/javascript", "app.js", studio_script());
  if (path == "/styles.css" && reads) return page_answer("text/css", "styles.css", studio_style());

  const std::vector<std::string> parts = parts_of(path);
  if (parts.size() < 2 || parts[0] != "api") throw not_found();
  if (parts[1] == "hello" && reads) return json_answer(hello(request));
  if (parts[1] == "recent" && reads) return json_answer(recent(request));
  if (parts[1] == "recent" && parts.size() == 3 && request.method == "DELETE") {
    forget(parts[2]);
    return json_answer(Json::object());
  }
  if (parts[1] == "profiles" && reads && parts.size() == 2) {
    Json answer;
    answer["profiles"] = profile_names(profiles_);
    return json_answer(answer);
  }
  if (parts[1] == "quit" && request.method == "POST") {
    quit_();
    return json_answer(Json::object());
  }
  if (parts[1] == "jobs" && parts.size() == 2 && request.method == "POST") return new_job(request);
  if (parts[1] == "jobs" && parts.size() > 2) return job_route(request, parts);
  throw not_found();
}

// That a tab had a job when it was kept last tells of a crash only where none has it now. The tab
// that asks has left its own, which may not have been noticed yet.
Json Api::recent(const HttpRequest& request) {
  const std::string client = asking_client(request).value_or("");
  Json list = store_.recent(kMostRecent);
  const std::lock_guard lock(mutex_);
  for (Json& entry : list) {
    const std::string name = entry["job"];
    const bool was_open = entry["recovered"];
    const auto known = jobs_.find(name);
    const bool elsewhere =
        known == jobs_.end() && was_open && store_.hold(name).state() == FolderLock::State::kTaken;
    entry["open"] = elsewhere || (known != jobs_.end() && known->second->has_tab_but(client));
    entry["recovered"] =
        was_open && !elsewhere && (known == jobs_.end() || !known->second->has_tabs());
  }
  return list;
}

Json Api::hello(const HttpRequest& request) {
  return hello_json(run_, opened_, profile_names(profiles_), recent(request));
}

std::shared_ptr<OpenJob> Api::job(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto known = jobs_.find(name);
  if (known != jobs_.end()) return known->second;
  if (!store_.has(name)) throw no_such_job();
  return jobs_[name] = std::make_shared<OpenJob>(store_, name, run_, numbers_);
}

void Api::open_file(const std::filesystem::path& file) {
  // What was not saved, as after a crash, goes on.
  const std::string earlier = store_.opened_from(file);
  if (!earlier.empty()) {
    const Json state = store_.read(earlier);
    const bool unsaved = state.value("revision", 0L) != state.value("saved_revision", 0L);
    // What was saved is as its file says, which may have been edited since.
    const std::filesystem::path saved = state.value("where", "");
    std::error_code none;
    if (!unsaved && std::filesystem::exists(saved, none)) job(earlier)->open_file(saved);
    job(earlier);
    opened_ = earlier;
    return;
  }
  const std::string name = store_.create();
  try {
    job(name)->open_file(file);
  } catch (...) {
    forget(name);
    throw;
  }
  opened_ = name;
}

HttpAnswer Api::new_job(HttpRequest& request) {
  const Json body = read_json(request);
  std::string name = value_in(body, "job", std::string());
  if (name.empty()) {
    const std::string sample = value_in(body, "sample", std::string());
    name = store_.create();
    if (!sample.empty()) {
      try {
        const std::string file = shelf_.place(sample, store_.home(name) / "files");
        job(name)->adopt({file}, "");
      } catch (...) {
        forget(name);
        throw;
      }
    }
  }
  job(name);
  Json answer;
  answer["job"] = name;
  return json_answer(answer, 201);
}

void Api::forget(const std::string& job) {
  const std::lock_guard lock(mutex_);
  if (const auto open = jobs_.find(job); open != jobs_.end()) {
    if (!open->second->let_go())
      throw ApiError(409, "busy", "The job is open; close its tab first.");
    store_.forget(job);
    jobs_.erase(open);
    return;
  }
  if (store_.hold(job).state() == FolderLock::State::kTaken)
    throw ApiError(409, "busy", "The job is open in another studio; end that one first.");
  store_.forget(job);
}

HttpAnswer Api::job_route(HttpRequest& request, const std::vector<std::string>& parts) {
  // For the list of recent jobs, which opens none of them.
  if (request.method == "GET" && parts.size() == 4 && parts[3] == "thumbnail" &&
      store_.has(parts[2]))
    return file_answer(store_.home(parts[2]) / kThumbnail);
  const std::shared_ptr<OpenJob> open = job(parts[2]);
  return answer_job({request, {parts.begin() + 3, parts.end()}, open, profiles_});
}

void Api::tidy() {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  for (auto at = jobs_.begin(); at != jobs_.end();) {
    const auto since = at->second->idle_since();
    const bool unused = since && now - *since > kUnwatched && at->second.use_count() == 1;
    at = unused ? jobs_.erase(at) : std::next(at);
  }
}

void Api::end(const std::string& farewell) {
  std::map<std::string, std::shared_ptr<OpenJob>> all;
  {
    const std::lock_guard lock(mutex_);
    all.swap(jobs_);
  }
  for (const auto& [name, job] : all) job->say_goodbye(farewell);
}

}  // namespace hydrodip
