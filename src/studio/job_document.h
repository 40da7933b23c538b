// A job's document with all that belongs to it: its revisions, what it configures, the files that
// it names, and the job file that it was opened from or saved to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "settings/config.h"
#include "studio/job_files.h"
#include "studio/json.h"

namespace hydrodip {

bool is_job_file(const std::filesystem::path& file);

// What a model or a job's file of this machine asks for. Throws InputError, also if there is no
// model.
JobConfig config_of_file(const std::filesystem::path& file);

// What may take the place of a job's document, and of what belongs to it.
struct OtherJob {
  Json document;
  Json machine = Json::object();      // machine_values_of()
  std::filesystem::path where = {};   // the job file; empty: there is none yet
  std::filesystem::path origin = {};  // what the command line named
};

// With its owner's lock.
class JobDocument {
 public:
  // `home`: the job's folder; `kept`: what state() was, or nothing of that kind.
  JobDocument(std::filesystem::path home, const Json& kept);

  const Json& json() const { return document_; }
  // What it configures, as it could be read last.
  const JobConfig& config() const { return config_; }
  long revision() const { return revision_; }
  long saved_revision() const { return saved_revision_; }
  std::string name() const;
  const std::filesystem::path& home() const { return home_; }
  JobFiles& files() { return files_; }
  const JobFiles& files() const { return files_; }
  // The job file; empty: there is none yet.
  const std::filesystem::path& where() const { return where_; }
  // As people are told of it; "": there is none.
  std::string shown_where() const;
  // What a job file says beside what a document can, by parameter.
  std::vector<std::string> machine_names() const;

  // What is kept of it between runs; `open`: whether somebody looks at it.
  Json state(bool open) const;

  // What such a document would configure. Throws ApiError bad-value, too-large.
  JobConfig checked(const Json& document) const { return checked(document, machine_); }
  // Beside what another file says of the machine.
  JobConfig checked(const Json& document, const Json& machine) const;
  // The next revision. Whether that is as it was saved, and still counts as saved.
  bool accept(const Json& document, const JobConfig& config);
  // Reads anew what the document names. Throws ApiError bad-value.
  void read_again();
  // As the next revision. False: it is called that already, or the name says nothing.
  bool rename(const std::string& name);

  // What such a file of this machine stands for. Throws InputError for what the studio has no room
  // for.
  OtherJob by_file(const std::filesystem::path& file, const JobConfig& config);
  // The same of a job file that was uploaded, and names only what came with it. Throws InputError;
  // ApiError bad-file for one that names anything else.
  OtherJob by_uploaded(const std::string& job_file) const;
  // As it is, to be changed.
  OtherJob by_itself() const { return {document_, machine_, where_, origin_}; }
  // Takes all of it but the document, which is still to be accepted.
  void replace_by(OtherJob other);
  // Counts as saved from now on.
  void set_saved() { saved_revision_ = revision_; }

  // The job file's text, as it would be written into that folder.
  std::string job_file_text(const std::filesystem::path& folder) const;
  // Writes the job file: where it was, or else beside the model that was opened, or among the
  // uploads, where its name follows the job's. The file that it had under an earlier name, which
  // has to be removed when all else is kept; empty: none. Throws ApiError bad-file, Cancelled.
  std::filesystem::path save(const RunContext& context);
  // What of it is of use for other jobs (film, printer, bath), as settings.
  std::string profile_text() const;

 private:
  const std::filesystem::path home_;
  JobFiles files_;
  Json document_ = Json::object();
  Json machine_ = Json::object();  // machine_values_of() the file that it was opened from
  JobConfig config_;
  long revision_ = 1, saved_revision_ = 1;
  std::filesystem::path where_;   // the job file that it was opened from or saved to
  std::filesystem::path origin_;  // what the command line named
};

}  // namespace hydrodip
