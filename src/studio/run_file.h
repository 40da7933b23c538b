// What a run of the studio leaves for the next one if it is killed: its port and its token, so that
// pages that are still open find their way back.
#pragma once

#include <filesystem>
#include <string>

#include "base/file_lock.h"

namespace hydrodip {

// Held by one run at a time; others have none. Where the file system has no locks each has it.
class RunFile {
 public:
  explicit RunFile(const std::filesystem::path& folder);
  // Ended in good order: nothing is left.
  ~RunFile();
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;

  struct Run {
    int port = 0;  // 0: there is none
    std::string token;
  };
  // One that was killed.
  const Run& earlier() const { return earlier_; }
  // One that goes on.
  const Run& another() const { return another_; }

  void keep(int port, const std::string& token);

 private:
  bool is_ours() const;

  FileLock lock_;
  Run earlier_, another_;
};

}  // namespace hydrodip
