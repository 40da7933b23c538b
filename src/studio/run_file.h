// What a run of the studio leaves for the next one if it is killed: its port and its token, so that
// pages that are still open find their way back.
#pragma once

#include <filesystem>
#include <string>

namespace hydrodip {

// Held by one run at a time; others have none.
class RunFile {
 public:
  explicit RunFile(const std::filesystem::path& folder);
  // Ended in good order: nothing is left.
  ~RunFile();
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;

  // Of an earlier run that was killed; 0 and "" if there is none.
  int port() const { return port_; }
  const std::string& token() const { return token_; }

  void keep(int port, const std::string& token);

 private:
  std::filesystem::path file_;
  int lock_ = -1;
  int port_ = 0;
  std::string token_;
};

}  // namespace hydrodip
