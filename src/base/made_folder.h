// A folder that is there for what is about to be written into it.
#pragma once

#include <filesystem>
#include <system_error>
#include <vector>

namespace hydrodip {

// Makes the folder, if needed; what was made of it goes again at the end if it stayed empty.
class MadeFolder {
 public:
  explicit MadeFolder(const std::filesystem::path& folder);
  ~MadeFolder();
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

  // Why it could not be made; none if it is there.
  const std::error_code& error() const { return error_; }

 private:
  std::vector<std::filesystem::path> made_;  // innermost first
  std::error_code error_;
};

}  // namespace hydrodip
