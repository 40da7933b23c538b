#include "studio/job_requests.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <system_error>
#include <utility>

#include "base/file.h"
#include "settings/dip_tables.h"
#include "settings/profiles.h"
#include "studio/api_error.h"
#include "studio/file_answers.h"
#include "studio/json_answers.h"
#include "studio/receive_file.h"
#include "studio/request_values.h"
#include "studio/zip.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostThumbnail = 256 << 10U;
// How soon it is noticed that a tab was closed.
constexpr auto kBetweenLooks = std::chrono::milliseconds(200);

HttpAnswer done() { return json_answer(Json::object()); }

// ---- the job and its document ----

HttpAnswer describe(const JobRequest& asked) { return json_answer(asked.job->describe()); }

HttpAnswer put_document(const JobRequest& asked) {
  const Json body = read_json(asked.http);
  OpenJob::Change change;
  change.client = client_in(value_in(body, "client", std::string()));
  change.base = count_in(body, "base");
  change.document = value_in(body, "document", Json());
  change.live = value_in(body, "live", false);
  change.dip = std::size_t(std::min(count_in(body, "dip").value_or(0), kMostDips - 1L));
  try {
    return json_answer(asked.job->put(change));
  } catch (const ApiError& error) {
    if (error.code != "stale") throw;
    const Json now = asked.job->describe();
    Json answer = Json::parse(error_answer(error).body);
    answer["revision"] = now["revision"];
    answer["document"] = now["document"];
    return json_answer(answer, error.status);
  }
}

HttpAnswer save(const JobRequest& asked) {
  return json_answer(asked.job->save(value_in(read_json(asked.http), "name", std::string())));
}

HttpAnswer reload(const JobRequest& asked) {
  read_json(asked.http);
  asked.job->reload();
  return done();
}

HttpAnswer take_pen(const JobRequest& asked) {
  asked.job->take_pen(client_in(value_in(read_json(asked.http), "client", std::string())));
  return done();
}

HttpAnswer job_file_text(const JobRequest& asked) {
  HttpAnswer answer;
  answer.type = "text/plain; charset=utf-8";
  answer.headers = {{"Content-Disposition", "attachment; filename=\"job.toml\""},
                    {"Cache-Control", "no-store"}};
  answer.body = asked.job->job_toml(asked.job->home() / "files");
  return answer;
}

HttpAnswer packed_job(const JobRequest& asked) {
  return file_answer(asked.job->pack(), asked.job->name() + ".zip");
}

HttpAnswer events(const JobRequest& asked) {
  const std::string client = client_in(asking_client(asked.http).value_or(""));
  struct Line {
    std::shared_ptr<OpenJob> job;
    std::string client;
    std::shared_ptr<EventStream> stream;
    ~Line() { job->disconnect(client, stream); }
  };
  const std::shared_ptr<Line> line(new Line{asked.job, client, asked.job->connect(client)});
  HttpAnswer answer;
  answer.type = "text/event-stream";
  answer.headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}};
  answer.stream = [line](std::string& text) { return line->stream->next(text, kBetweenLooks); };
  return answer;
}

HttpAnswer counts(const JobRequest& asked) { return json_answer(asked.job->counts()); }

// ---- files ----

HttpAnswer file_of_job(const JobRequest& asked) {
  return file_answer(asked.job->file(asked.name_from(1)));
}

HttpAnswer upload(const JobRequest& asked) {
  const OpenJob::Upload upload = asked.job->begin_upload(asked.name_from(1));
  struct Unfinished {
    fs::path file;
    ~Unfinished() {
      std::error_code ignored;
      fs::remove(file, ignored);
    }
  } const unfinished{upload.file};
  receive_file(asked.http, upload.file, upload.most_bytes);
  return json_answer(asked.job->end_upload(upload), 201);
}

HttpAnswer adopt(const JobRequest& asked) {
  const Json body = read_json(asked.http);
  return json_answer(asked.job->adopt(value_in(body, "files", std::vector<std::string>()),
                                      value_in(body, "client", std::string())));
}

HttpAnswer put_thumbnail(const JobRequest& asked) {
  const std::string png = read_text(asked.http, kMostThumbnail);
  if (!png.starts_with("\x89PNG")) throw ApiError(422, "bad-file", "A thumbnail is a PNG picture.");
  write_whole(asked.job->thumbnail(), png);
  return done();
}

// ---- profiles ----

HttpAnswer profile_patch(const JobRequest& asked) {
  const fs::path file = profile_path(asked.profiles, asked.parts[1]);
  std::error_code ignored;
  if (asked.profiles.empty() || !fs::is_regular_file(file, ignored))
    throw ApiError(404, "not-found", "There is no such profile any more.");
  return json_answer(asked.job->patch_of_profile(file));
}

HttpAnswer put_profile(const JobRequest& asked) {
  if (asked.profiles.empty()) throw not_found();
  asked.job->save_profile(asked.profiles, asked.parts[1]);
  Json answer;
  answer["profiles"] = profile_names(asked.profiles);
  return json_answer(answer);
}

// ---- what was computed ----

// Of what was shown and has been replaced meanwhile, nothing is left. That is no error: whoever
// asks a moment too late, as a busy page does, is told of the successor anyway.
HttpAnswer bundle_answer(const JobRequest& asked,
                         std::shared_ptr<const std::vector<std::uint8_t>> bytes) {
  if (bytes || !asked.job->shown().has_given(asked.parts[1])) return bytes_answer(std::move(bytes));
  HttpAnswer answer;
  answer.status = 204;
  answer.headers = {{"Cache-Control", "no-store"}};
  return answer;
}

HttpAnswer mesh(const JobRequest& asked) {
  return bundle_answer(asked, asked.job->shown().mesh(asked.parts[1]));
}

HttpAnswer texture(const JobRequest& asked) {
  const std::string& number = asked.parts[3];
  std::size_t k = 0;
  const char* const end = number.data() + number.size();
  const auto [rest, error] = std::from_chars(number.data(), end, k);
  const auto texture =
      error == std::errc() && rest == end ? asked.job->shown().texture(asked.parts[1], k) : nullptr;
  if (!texture) throw not_found();
  const ShownPicture& picture = texture->picture();
  return bytes_answer({texture, &picture.bytes}, picture.type);
}

HttpAnswer result(const JobRequest& asked) {
  return bundle_answer(asked, asked.job->shown().result(asked.parts[1]));
}

HttpAnswer dip(const JobRequest& asked) {
  return bundle_answer(asked, asked.job->shown().dip(asked.parts[1]));
}

HttpAnswer finish(const JobRequest& asked) {
  return bundle_answer(asked, asked.job->shown().finish(asked.parts[1]));
}

// ---- tasks ----

HttpAnswer start_task(const JobRequest& asked) {
  Json answer;
  answer["task"] = asked.job->start_task(read_json(asked.http));
  return json_answer(answer, 202);
}

HttpAnswer cancel_task(const JobRequest& asked) {
  asked.job->cancel_task(asked.parts[1]);
  return done();
}

HttpAnswer file_of_task(const JobRequest& asked) {
  return file_answer(file_in(asked.job->task_folder(asked.parts[1]), asked.name_from(3)));
}

HttpAnswer all_files_of_task(const JobRequest& asked) {
  const fs::path folder = asked.job->task_folder(asked.parts[1]);
  std::vector<std::pair<std::string, fs::path>> files;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
    if (entry->is_regular_file(error) && entry->path().extension() != ".zip")
      files.emplace_back(entry->path().lexically_relative(folder).string(), entry->path());
  if (files.empty()) throw not_found();
  std::sort(files.begin(), files.end());
  // A later print writes over the files of an earlier one: one archive is enough.
  const fs::path archive = asked.job->home() / "print.zip";
  pack_zip(archive, files);
  return file_answer(archive, asked.job->name() + "-print.zip");
}

// ---- which of them ----

struct JobAddress {
  const char* method;
  std::vector<std::string> parts;  // "*": any; "**", the last: one or several
  HttpAnswer (*answer)(const JobRequest& asked);

  bool matches(const JobRequest& asked) const {
    if (asked.http.method != method) return false;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (k >= asked.parts.size()) return false;
      if (parts[k] == "**") return true;
      if (parts[k] != "*" && parts[k] != asked.parts[k]) return false;
    }
    return parts.size() == asked.parts.size();
  }
};

const std::vector<JobAddress>& addresses() {
  static const std::vector<JobAddress> list = {
      {"GET", {}, describe},
      {"GET", {"events"}, events},
      {"GET", {"counts"}, counts},
      {"PUT", {"document"}, put_document},
      {"POST", {"pen"}, take_pen},
      {"POST", {"reload"}, reload},
      {"POST", {"save"}, save},
      {"GET", {"job.toml"}, job_file_text},
      {"GET", {"job.zip"}, packed_job},
      {"PUT", {"thumbnail"}, put_thumbnail},
      {"GET", {"files", "**"}, file_of_job},
      {"PUT", {"files", "**"}, upload},
      {"POST", {"adopt"}, adopt},
      {"GET", {"profiles", "*"}, profile_patch},
      {"PUT", {"profiles", "*"}, put_profile},
      {"GET", {"meshes", "*"}, mesh},
      {"GET", {"meshes", "*", "textures", "*"}, texture},
      {"GET", {"results", "*"}, result},
      {"GET", {"results", "*", "dip"}, dip},
      {"GET", {"finish", "*"}, finish},
      {"POST", {"tasks"}, start_task},
      {"DELETE", {"tasks", "*"}, cancel_task},
      {"GET", {"tasks", "*", "files", "**"}, file_of_task},
      {"GET", {"tasks", "*", "files.zip"}, all_files_of_task},
  };
  return list;
}

}  // namespace

std::string JobRequest::name_from(std::size_t part) const {
  std::string text;
  for (std::size_t k = part; k < parts.size(); ++k) text += (k > part ? "/" : "") + parts[k];
  return text;
}

HttpAnswer answer_job(const JobRequest& asked) {
  for (const JobAddress& address : addresses())
    if (address.matches(asked)) return address.answer(asked);
  throw not_found();
}

}  // namespace hydrodip
