// Files on their way into a job: uploaded one by one, then taken in together, as they were dropped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "hydrodip/hydrodip.h"
#include "studio/api_error.h"
#include "studio/job_files.h"

namespace hydrodip {

inline constexpr std::uintmax_t kMostFileBytes = std::uintmax_t(512) << 20U;
inline constexpr std::uintmax_t kMostJobBytes = std::uintmax_t(2) << 30U;

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

 private:
  std::uintmax_t room_left() const;
  void unpack(const std::string& archive, std::vector<std::string>& names) const;

  const JobFiles& files_;
  std::map<std::string, std::string> wanted_;  // of files that got another name than they had
};

// The picture that a model with texture coordinates and without colours must mean: the only one of
// these files, and named like the model or like a texture. "": none.
std::string texture_for(const Model& model, const std::string& name,
                        const std::vector<std::string>& names);

// A sentence about a file of the job that could not be read.
ApiError bad_file(const std::string& sentence, const JobFiles& files);

}  // namespace hydrodip
