// A folder for the files of one test or benchmark, gone with everything in it afterwards.
#pragma once

#include <stdlib.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace hydrodip {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "hydrodip-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw std::system_error(errno, std::generic_category(), name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    keep_described_files();
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  // Into the folder that HYDRODIP_TEST_FILES names, if it names one: what JSON Schemas describe,
  // for tests/schemas/validate.py.
  void keep_described_files() const {
    namespace fs = std::filesystem;
    const char* const kept = std::getenv("HYDRODIP_TEST_FILES");
    if (kept == nullptr) return;
    std::error_code error;
    for (fs::recursive_directory_iterator at(path_, error), end; !error && at != end;
         at.increment(error)) {
      const std::string name = at->path().filename().string();
      if (name != "report.json" && name != "plan.json" && name != "orient.json" &&
          name != "nest.json" && name != "plan.toml" && name != "profile.toml")
        continue;
      const fs::path to = fs::path(kept) / path_.filename() / at->path().lexically_relative(path_);
      std::error_code ignored;
      fs::create_directories(to.parent_path(), ignored);
      fs::copy_file(at->path(), to, fs::copy_options::overwrite_existing, ignored);
    }
  }

  std::filesystem::path path_;
};

}  // namespace hydrodip
