#include "studio/api.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/json_nesting.h"
#include "report/plain_words.h"
#include "samples/samples.h"
#include "settings/artwork_tables.h"
#include "settings/dip_tables.h"
#include "settings/params.h"
#include "settings/profiles.h"
#include "settings/settings.h"
#include "studio/document.h"
#include "studio/json_answers.h"
#include "studio/page_assets.h"
#include "studio/zip.h"

namespace hydrodip {
namespace {

constexpr std::uintmax_t kMostJson = std::uintmax_t(2) << 20U, kMostThumbnail = 256 << 10U;
constexpr std::size_t kMostRecent = 20;
constexpr auto kHeartbeat = std::chrono::seconds(2);
constexpr auto kUnwatched = std::chrono::minutes(2);
constexpr auto kWrongPassword = std::chrono::milliseconds(700);

// ---- answers ----

ApiError not_found() { return {404, "not-found", "There is nothing of that name here."}; }

// What never changes under its address.
HttpAnswer bytes_answer(std::shared_ptr<const std::vector<std::uint8_t>> bytes,
                        const std::string& type = "application/octet-stream") {
  if (!bytes) throw not_found();
  HttpAnswer answer;
  answer.type = type;
  answer.headers = {{"Cache-Control", "private, max-age=86400, immutable"}};
  answer.bytes = std::move(bytes);
  return answer;
}

// Of what was shown and has been replaced meanwhile, nothing is left. That is no error: whoever
// asks a moment too late, as a busy page does, is told of the successor anyway.
HttpAnswer bundle_answer(const OpenJob& job, const std::string& id,
                         std::shared_ptr<const std::vector<std::uint8_t>> bytes) {
  if (bytes || !job.has_given(id)) return bytes_answer(std::move(bytes));
  HttpAnswer answer;
  answer.status = 204;
  answer.headers = {{"Cache-Control", "no-store"}};
  return answer;
}

std::string type_of(const std::filesystem::path& file) {
  static const std::map<std::string, std::string> types = {{".pdf", "application/pdf"},
                                                           {".png", "image/png"},
                                                           {".jpg", "image/jpeg"},
                                                           {".jpeg", "image/jpeg"},
                                                           {".webp", "image/webp"},
                                                           {".gif", "image/gif"},
                                                           {".svg", "image/svg+xml"},
                                                           {".html", "text/html; charset=utf-8"},
                                                           {".json", "application/json"},
                                                           {".zip", "application/zip"},
                                                           {".glb", "model/gltf-binary"},
                                                           {".tif", "image/tiff"},
                                                           {".toml", "text/plain; charset=utf-8"}};
  const auto known = types.find(file.extension().string());
  return known == types.end() ? "application/octet-stream" : known->second;
}

// Pages and drawings of a job may hold scripts: they get no hold of this address.
HttpAnswer file_answer(const std::filesystem::path& file, const std::string& save_as = "") {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) throw not_found();
  HttpAnswer answer;
  answer.type = type_of(file);
  answer.headers = {{"Cache-Control", "no-store"},
                    {"Content-Security-Policy",
                     "sandbox allow-scripts allow-popups; default-src 'none'; img-src data: blob:; "
                     "style-src 'unsafe-inline'; script-src 'unsafe-inline' 'wasm-unsafe-eval'"}};
  if (answer.type == "application/pdf") answer.headers.pop_back();  // viewers are no page's
  if (!save_as.empty()) {
    std::string plain;
    for (const char c : save_as)
      plain +=
          std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == ' ' ? c : '_';
    answer.headers.emplace_back("Content-Disposition", "attachment; filename=\"" + plain + "\"");
  }
  answer.file = file;
  return answer;
}

HttpAnswer page_answer(const std::string& type, const std::string& name,
                       const std::string& built_in) {
  HttpAnswer answer;
  answer.type = type + "; charset=utf-8";
  answer.headers = {
      {"Cache-Control", "no-store"},
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' "
       "blob: data:; connect-src 'self'; worker-src 'self' blob:; font-src 'self' data:; "
       "frame-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"}};
  answer.body = built_in;
  // For work on the page: see docs/studio-api.md.
  if (const char* folder = std::getenv("HYDRODIP_STUDIO_PAGE"); folder && *folder) {
    const std::vector<std::uint8_t> bytes = read_file(std::filesystem::path(folder) / name);
    answer.body.assign(bytes.begin(), bytes.end());
  }
  return answer;
}

// ---- requests ----

std::string read_text(HttpRequest& request, std::uintmax_t most) {
  std::string text;
  const auto too_large = [] {
    return ApiError(413, "too-large", "That is more than the studio takes.");
  };
  if (request.body_bytes.value_or(0) > most) throw too_large();
  bool fits = true;
  const bool whole = request.read_body([&](const char* data, std::size_t size) {
    fits = text.size() + size <= most;
    if (fits) text.append(data, size);
    return fits;
  });
  if (!fits) throw too_large();
  if (!whole) throw ApiError(400, "bad-request", "The request did not come whole.");
  return text;
}

Json read_json(HttpRequest& request) {
  const std::string text = read_text(request, kMostJson);
  if (nests_too_deeply(text))
    throw ApiError(400, "bad-request", "The request is nested too deeply.");
  Json json = text.empty() ? Json::object() : Json::parse(text, nullptr, false);
  if (!json.is_object()) throw ApiError(400, "bad-request", "The request is no JSON object.");
  return json;
}

template <class Value>
Value value_in(const Json& json, const char* key, const Value& otherwise) {
  try {
    return json.value(key, otherwise);
  } catch (const Json::exception&) {
    throw ApiError(400, "bad-request", fmt::format("The request's {} is of the wrong kind.", key));
  }
}

// None: not given. Fractions and what no revision or place can be are refused.
std::optional<long> count_in(const Json& json, const char* key) {
  if (!json.contains(key)) return std::nullopt;
  const Json& value = json[key];
  constexpr std::int64_t kMost = std::int64_t(1) << 52U;
  const bool fine = value.is_number_integer() &&
                    (!value.is_number_unsigned() || value.get<std::uint64_t>() <= kMost) &&
                    value.get<std::int64_t>() >= 0;
  if (!fine)
    throw ApiError(400, "bad-request",
                   fmt::format("The request's {} is no whole number from 0.", key));
  return long(value.get<std::int64_t>());
}

std::string client_in(const std::string& name) {
  const bool fine =
      !name.empty() && name.size() <= 40 && std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '-';
      });
  if (!fine) throw ApiError(400, "bad-request", "A tab's name is letters and digits, at most 40.");
  return name;
}

// "/api/jobs/x" -> api, jobs, x
std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t begin = 1; begin < path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    parts.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string joined(const std::vector<std::string>& parts, std::size_t from) {
  std::string text;
  for (std::size_t k = from; k < parts.size(); ++k) text += (k > from ? "/" : "") + parts[k];
  return text;
}

// A folder's file of that name, which may be "dip-1/print.pdf" and never lies elsewhere.
std::filesystem::path file_in(const std::filesystem::path& folder, const std::string& name) {
  require_plain_name(name);
  std::error_code error;
  auto file = folder / name;
  if (folder.empty() || !std::filesystem::exists(file, error) || !lies_in(file, folder))
    throw not_found();
  return file;
}

std::filesystem::path known_profile(const std::filesystem::path& folder, const std::string& name) {
  std::filesystem::path file = profile_path(folder, name);
  std::error_code ignored;
  if (folder.empty() || !std::filesystem::is_regular_file(file, ignored))
    throw ApiError(404, "not-found", "There is no such profile any more.");
  return file;
}

// ---- hello ----

Json parameters_list() {
  Json list = Json::parse(parameters_json())["parameters"];
  Json own = Json::array();
  for (Json& p : list) {
    if (is_of_the_machine(p["name"])) continue;
    if (p.contains("zero_means")) p["zero"] = p["zero_means"];
    own.push_back(p);
  }
  return own;
}

// For a password: nothing of the page is shown before.
constexpr const char* kLogin = R"(<!doctype html><html lang="en"><meta charset="utf-8">
<title>hydrodip studio</title><meta name="viewport" content="width=device-width, initial-scale=1">
<style>body{font-family:sans-serif;max-width:22em;margin:20vh auto;padding:0 1em}
input,button{font:inherit;padding:.5em;width:100%;box-sizing:border-box;margin:.5em 0}</style>
<h1>hydrodip studio</h1><form method="post" action="/login"><label>Password
<input type="password" name="password" autofocus required></label><button>Open</button></form>
</html>)";

constexpr const char* kNoToken = R"(<!doctype html><html lang="en"><meta charset="utf-8">
<title>hydrodip studio</title><style>body{font-family:sans-serif;max-width:32em;margin:20vh auto;
padding:0 1em}</style><h1>This studio does not know your browser</h1>
<p>Open the address that <code>hydrodip studio</code> printed: it lets this browser in.</p></html>)";

std::string form_value(const std::string& form, const std::string& key) {
  const std::size_t at = form.find(key + "=");
  if (at != 0) return "";
  std::string value;
  for (std::size_t i = key.size() + 1; i < form.size() && form[i] != '&'; ++i) {
    if (form[i] == '+') {
      value += ' ';
    } else if (form[i] == '%' && i + 2 < form.size()) {
      value += char(std::strtol(form.substr(i + 1, 2).c_str(), nullptr, 16));
      i += 2;
    } else {
      value += form[i];
    }
  }
  return value;
}

}  // namespace

Api::Api(JobStore store, Guard guard, std::string run, std::function<void()> quit,
         std::filesystem::path profiles)
    : store_(std::move(store)),
      shelf_(store_.samples()),
      guard_(std::move(guard)),
      run_(std::move(run)),
      quit_(std::move(quit)),
      profiles_(std::move(profiles)) {}

std::optional<HttpAnswer> Api::admit(const HttpRequest& request) const {
  if (const auto refusal = guard_.refuses_origin(request)) return error_answer(*refusal);
  const bool entering = request.path == "/" || request.path == "/login";
  if (entering || guard_.knows(request)) return std::nullopt;
  return error_answer({403, "no-token",
                       "The studio does not know this browser: open the address that it printed."});
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
  if (path == "/" && reads) {
    const auto token = request.query.find("token");
    if (guard_.password.empty() && token != request.query.end() &&
        same_secret(token->second, guard_.token)) {
      HttpAnswer answer;
      answer.status = 303;
      answer.type = "text/plain";
      answer.headers = {
          {"Location", "/"}, {"Set-Cookie", guard_.set_cookie()}, {"Cache-Control", "no-store"}};
      return answer;
    }
    if (!guard_.knows(request)) {
      HttpAnswer answer;
      answer.status = guard_.password.empty() ? 403 : 200;
      answer.type = "text/html; charset=utf-8";
      answer.headers = {{"Cache-Control", "no-store"},
                        {"Content-Security-Policy",
                         "default-src 'none'; style-src 'unsafe-inline'; form-action 'self'; "
                         "frame-ancestors 'none'"}};
      answer.body = guard_.password.empty() ? kNoToken : kLogin;
      return answer;
    }
    return page_answer("text/html", "index.html", studio_page());
  }
  if (path == "/login" && request.method == "POST") return login(request);
  if (!guard_.knows(request)) throw not_found();
  if (path == "/app.js" && reads) return page_answer("text/javascript", "app.js", studio_script());
  if (path == "/styles.css" && reads) return page_answer("text/css", "styles.css", studio_style());

  const Parts parts = parts_of(path);
  if (parts.size() < 2 || parts[0] != "api") throw not_found();
  if (parts[1] == "hello" && reads) return hello(request);
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

HttpAnswer Api::login(HttpRequest& request) {
  const std::string form = read_text(request, 4096);
  if (guard_.password.empty()) throw not_found();
  if (!same_secret(form_value(form, "password"), guard_.password)) {
    std::this_thread::sleep_for(kWrongPassword);
    throw ApiError(403, "no-token", "That is not the password.");
  }
  HttpAnswer answer;
  answer.status = 303;
  answer.type = "text/plain";
  answer.headers = {{"Location", "/"}, {"Set-Cookie", guard_.set_cookie()}};
  return answer;
}

// That a tab had a job when it was kept last tells of a crash only where none has it now. The tab
// that asks has left its own, which may not have been noticed yet.
Json Api::recent(const HttpRequest& request) {
  const auto given = request.query.find("client");
  const std::string client = given == request.query.end() ? "" : client_in(given->second);
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

HttpAnswer Api::hello(const HttpRequest& request) {
  Json films = Json::array(), sample_list = Json::array(), layers = Json::array();
  for (const FilmFormat& film : film_formats())
    films.push_back(
        {{"name", film.name}, {"width_mm", film.width_mm}, {"height_mm", film.height_mm}});
  for (const SampleInfo& sample : samples())
    sample_list.push_back({{"name", sample.name}, {"text", sample.description}});
  for (const LayerKey& key : layer_keys())
    layers.push_back(
        {{"name", key.name}, {"unit", key.unit}, {"range", key.range}, {"help", key.help}});
  return json_answer({{"version", HYDRODIP_VERSION},
                      {"run", run_},
                      {"opened", opened_.empty() ? Json() : Json(opened_)},
                      {"samples", sample_list},
                      {"films", films},
                      {"parameters", parameters_list()},
                      {"layer_keys", layers},
                      {"profiles", profile_names(profiles_)},
                      {"recent", recent(request)},
                      {"limits",
                       {{"file_bytes", kMostFileBytes},
                        {"job_bytes", kMostJobBytes},
                        {"document_bytes", kLargestDocument},
                        {"layers", kMostLayers},
                        {"dips", kMostDips}}},
                      {"model_types", model_endings()},
                      {"picture_types", picture_endings()}});
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

HttpAnswer Api::job_route(HttpRequest& request, const Parts& parts) {
  // For the list of recent jobs, which opens none of them.
  if (request.method == "GET" && parts.size() == 4 && parts[3] == "thumbnail" &&
      store_.has(parts[2]))
    return file_answer(store_.home(parts[2]) / kThumbnail);
  const std::shared_ptr<OpenJob> open = job(parts[2]);
  if (request.method == "GET" && parts.size() == 4 && parts[3] == "events")
    return events(request, open);
  if (request.method == "GET") return read_job(parts, *open);
  return command(request, parts, *open);
}

HttpAnswer Api::read_job(const Parts& parts, OpenJob& job) {
  if (parts.size() == 3) return json_answer(job.describe());
  const std::string& what = parts[3];
  if (what == "files" && parts.size() > 4) return file_answer(job.file(joined(parts, 4)));
  if (what == "counts") return json_answer(job.counts());
  if (what == "profiles" && parts.size() == 5)
    return json_answer(job.patch_of_profile(known_profile(profiles_, parts[4])));
  if (what == "job.toml") {
    HttpAnswer answer;
    answer.type = "text/plain; charset=utf-8";
    answer.headers = {{"Content-Disposition", "attachment; filename=\"job.toml\""},
                      {"Cache-Control", "no-store"}};
    answer.body = job.job_toml(job.thumbnail().parent_path() / "files");
    return answer;
  }
  if (what == "job.zip") return file_answer(job.pack(), job.name() + ".zip");
  if (what == "meshes" && parts.size() == 5)
    return bundle_answer(job, parts[4], job.mesh(parts[4]));
  if (what == "meshes" && parts.size() == 7 && parts[5] == "textures") {
    std::size_t k = 0;
    const char* const end = parts[6].data() + parts[6].size();
    const auto [rest, error] = std::from_chars(parts[6].data(), end, k);
    const auto texture = error == std::errc() && rest == end ? job.texture(parts[4], k) : nullptr;
    if (!texture) throw not_found();
    const ShownPicture& picture = texture->picture();
    return bytes_answer({texture, &picture.bytes}, picture.type);
  }
  if (what == "finish" && parts.size() == 5)
    return bundle_answer(job, parts[4], job.finish(parts[4]));
  if (what == "results" && parts.size() == 5)
    return bundle_answer(job, parts[4], job.result(parts[4]));
  if (what == "results" && parts.size() == 6 && parts[5] == "dip")
    return bundle_answer(job, parts[4], job.dip(parts[4]));
  if (what == "tasks" && parts.size() > 6 && parts[5] == "files")
    return file_answer(file_in(job.task_folder(parts[4]), joined(parts, 6)));
  if (what == "tasks" && parts.size() == 6 && parts[5] == "files.zip") {
    const std::filesystem::path folder = job.task_folder(parts[4]);
    std::vector<std::pair<std::string, std::filesystem::path>> files;
    std::error_code error;
    for (auto entry = std::filesystem::recursive_directory_iterator(folder, error);
         !error && entry != std::filesystem::recursive_directory_iterator(); entry.increment(error))
      if (entry->is_regular_file(error) && entry->path().extension() != ".zip")
        files.emplace_back(entry->path().lexically_relative(folder).string(), entry->path());
    if (files.empty()) throw not_found();
    std::sort(files.begin(), files.end());
    // A later print writes over the files of an earlier one: one archive is enough.
    const std::filesystem::path archive = job.thumbnail().parent_path() / "print.zip";
    pack_zip(archive, files);
    return file_answer(archive, job.name() + "-print.zip");
  }
  throw not_found();
}

HttpAnswer Api::command(HttpRequest& request, const Parts& parts, OpenJob& job) {
  const std::string what = parts.size() > 3 ? parts[3] : "";
  const bool puts = request.method == "PUT", posts = request.method == "POST";
  if (what == "files" && puts && parts.size() > 4) return upload(request, joined(parts, 4), job);
  if (what == "thumbnail" && puts) {
    const std::string png = read_text(request, kMostThumbnail);
    if (!png.starts_with("\x89PNG"))
      throw ApiError(422, "bad-file", "A thumbnail is a PNG picture.");
    write_whole(job.thumbnail(), png);
    return json_answer(Json::object());
  }
  if (what == "tasks" && request.method == "DELETE" && parts.size() == 5) {
    job.cancel_task(parts[4]);
    return json_answer(Json::object());
  }
  if (what == "profiles" && puts && parts.size() == 5) {
    if (profiles_.empty()) throw not_found();
    job.save_profile(profiles_, parts[4]);
    Json answer;
    answer["profiles"] = profile_names(profiles_);
    return json_answer(answer);
  }
  const Json body = read_json(request);
  if (what == "document" && puts) {
    OpenJob::Change change;
    change.client = client_in(value_in(body, "client", std::string()));
    change.base = count_in(body, "base");
    change.document = value_in(body, "document", Json());
    change.live = value_in(body, "live", false);
    change.dip = std::size_t(std::min(count_in(body, "dip").value_or(0), kMostDips - 1L));
    try {
      return json_answer(job.put(change));
    } catch (const ApiError& error) {
      if (error.code != "stale") throw;
      const Json now = job.describe();
      Json answer = Json::parse(error_answer(error).body);
      answer["revision"] = now["revision"];
      answer["document"] = now["document"];
      return json_answer(answer, error.status);
    }
  }
  if (what == "adopt" && posts)
    return json_answer(job.adopt(value_in(body, "files", std::vector<std::string>()),
                                 value_in(body, "client", std::string())));
  if (what == "save" && posts) return json_answer(job.save(value_in(body, "name", std::string())));
  if (what == "reload" && posts) {
    job.reload();
    return json_answer(Json::object());
  }
  if (what == "pen" && posts) {
    job.take_pen(client_in(value_in(body, "client", std::string())));
    return json_answer(Json::object());
  }
  if (what == "tasks" && posts && parts.size() == 4) {
    Json answer;
    answer["task"] = job.start_task(body);
    return json_answer(answer, 202);
  }
  throw not_found();
}

HttpAnswer Api::upload(HttpRequest& request, const std::string& name, OpenJob& job) {
  const OpenJob::Upload upload = job.begin_upload(name);
  const auto too_large = [] {
    return ApiError(413, "too-large",
                    fmt::format("A file may have {} MB, and all files of a job {} MB.",
                                kMostFileBytes >> 20U, kMostJobBytes >> 20U));
  };
  if (request.body_bytes.value_or(0) > upload.most_bytes) throw too_large();
  struct Unfinished {
    std::filesystem::path file;
    ~Unfinished() {
      std::error_code ignored;
      std::filesystem::remove(file, ignored);
    }
  } const unfinished{upload.file};
  std::uintmax_t bytes = 0;
  bool fits = true, kept = true;
  {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(upload.file.c_str(), "wb"),
                                                              std::fclose);
    if (!out) throw ApiError(500, "failed", "The file cannot be kept; free some space.");
    const bool whole = request.read_body([&](const char* data, std::size_t size) {
      bytes += size;
      fits = bytes <= upload.most_bytes;
      kept = fits && std::fwrite(data, 1, size, out.get()) == size;
      return kept;
    });
    if (!fits) throw too_large();
    kept = kept && std::fflush(out.get()) == 0;
    if (!kept) throw ApiError(500, "failed", "The file cannot be kept; free some space.");
    if (!whole) throw ApiError(400, "bad-request", "The file did not come whole.");
  }
  return json_answer(job.end_upload(upload), 201);
}

HttpAnswer Api::events(const HttpRequest& request, const std::shared_ptr<OpenJob>& job) {
  const auto given = request.query.find("client");
  const std::string client = client_in(given == request.query.end() ? "" : given->second);
  struct Line {
    std::shared_ptr<OpenJob> job;
    std::string client;
    std::shared_ptr<EventStream> stream;
    ~Line() { job->disconnect(client, stream); }
  };
  const std::shared_ptr<Line> line(new Line{job, client, job->connect(client)});
  HttpAnswer answer;
  answer.type = "text/event-stream";
  answer.headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}};
  answer.stream = [line](std::string& text) { return line->stream->next(text, kHeartbeat); };
  return answer;
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
