// The files of a job by the names that its document has for them: what was uploaded to it, and what
// the person named on the command line. Nothing else on this machine has a name here.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "studio/json.h"

namespace hydrodip {

// "model", "picture", "job", "archive", "part" (of a model), "unknown": by the name's ending.
std::string kind_of_file(const std::string& name);
const std::vector<std::string>& model_endings();
const std::vector<std::string>& picture_endings();

class JobFiles {
 public:
  // `uploads`: the folder for what is uploaded.
  explicit JobFiles(std::filesystem::path uploads) : uploads_(std::move(uploads)) {}

  const std::filesystem::path& uploads() const { return uploads_; }

  // Where the file of that name is. Throws ApiError: bad-name for what is no plain relative path,
  // bad-value if the job has no such file.
  std::filesystem::path find(const std::string& name) const;
  bool has(const std::string& name) const;

  // Where an upload of that name goes; made unlike all others ("mask-2.obj").
  std::string name_for_upload(const std::string& wanted) const;

  // The name of a folder that there is not yet, for files that came together ("mask-2").
  std::string new_folder(const std::string& wanted) const;

  // The name of a file anywhere, which from now on belongs to the job.
  std::string grant(const std::filesystem::path& file);

  // Uploaded files, then granted ones.
  std::vector<std::string> names() const;
  std::uintmax_t uploaded_bytes() const;

  // What of this has to be kept with the job.
  Json granted() const;
  void set_granted(const Json& granted);

 private:
  std::filesystem::path uploads_;
  std::map<std::string, std::filesystem::path> granted_;
};

// A sentence in which files of the folder go by their names alone: where the program keeps them is
// nobody's business.
std::string without_folder(std::string sentence, const std::filesystem::path& folder);

// Throws ApiError bad-name unless it is a relative path of ordinary names.
void require_plain_name(const std::string& name);

}  // namespace hydrodip
