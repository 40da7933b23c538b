#include "base/made_folder.h"

namespace hydrodip {

MadeFolder::MadeFolder(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (auto path = folder; !path.empty() && !std::filesystem::exists(path, ignored);
       path = path.parent_path())
    made_.push_back(path);
  std::filesystem::create_directories(folder, error_);
}

MadeFolder::~MadeFolder() {
  std::error_code ignored;
  for (const std::filesystem::path& path : made_) std::filesystem::remove(path, ignored);
}

}  // namespace hydrodip
