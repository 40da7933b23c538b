// Files on their way into a job: uploaded one by one, then taken in together, as they were dropped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "hydrodip/hydrodip.h"
#include "studio/api_error.h"
#include "studio/job_files.h"

namespace hydrodip {

inline constexpr std::uintmax_t kMostFileBytes = std::uintmax_t(512) << 20U;
inline constexpr std::uintmax_t kMostJobBytes = std::uintmax_t(2) << 30U;

// A model and pictures as they were dropped.
struct UnreadFiles {
  std::filesystem::path model;  // may be empty
  std::vector<std::filesystem::path> pictures;

  bool empty() const { return model.empty() && pictures.empty(); }
  // The model, by `load_model`; pictures that are not its own are looked at only. Null: there is no
  // model. Throws InputError for the first file that is broken. Without any lock.
  using LoadModel = std::function<std::shared_ptr<const Model>(const std::filesystem::path&)>;
  std::shared_ptr<const Model> read(const LoadModel& load_model) const;
};

// With its owner's lock. Throws ApiError.
class DroppedFiles {
 public:
  // `files`: the job's, which outlive this.
  explicit DroppedFiles(const JobFiles& files) : files_(files) {}

  // How many bytes an upload of that name may have. Refuses what the studio does not know.
  std::uintmax_t room_for(const std::string& wanted) const;
  // `whole` becomes a file of the job. Its name there.
  std::string keep(const std::filesystem::path& whole, const std::string& wanted);
  // The names of what was dropped at once; archives are unpacked. What meets files of the same
  // names gets a folder of its own, in which every file has the name by which the others know it.
  std::vector<std::string> take_in(const std::vector<std::string>& kept);
  // Those of the names that were never in the document before are deleted, or are from now on.
  void refuse(const std::vector<std::string>& names);
  void accept(const std::vector<std::string>& names);
  // What nobody has read yet of what take_in() gave.
  UnreadFiles unread(const std::vector<std::string>& names) const;

 private:
  std::uintmax_t room_left() const;
  void unpack(const std::string& archive, std::vector<std::string>& names);

  const JobFiles& files_;
  std::map<std::string, std::string> wanted_;  // of files that got another name than they had
  std::set<std::string> fresh_;                // dropped, and not in the document yet
};

// The picture that a model with texture coordinates and without colours must mean: the only one of
// these files, and named like the model or like a texture. "": none.
std::string texture_for(const Model& model, const std::string& name,
                        const std::vector<std::string>& names);

// A sentence about a file of the job that could not be read.
ApiError bad_file(const std::string& sentence, const JobFiles& files);

}  // namespace hydrodip
