#include "studio/run_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "studio/json.h"

namespace hydrodip {
namespace {

constexpr std::size_t kMostBytes = 1000;

RunFile::Run run_in(int file) {
  std::string text(kMostBytes, '\0');
  const ssize_t count = ::pread(file, text.data(), text.size(), 0);
  text.resize(count > 0 ? std::size_t(count) : 0);
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("port") || !json.contains("token") ||
      !json["port"].is_number_integer() || !json["token"].is_string())
    return {};
  return {json["port"], json["token"]};
}

}  // namespace

RunFile::RunFile(const std::filesystem::path& folder) : file_(folder / "run.json") {
  lock_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock_ < 0) return;
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) {
    earlier_ = run_in(lock_);
    return;
  }
  another_ = run_in(lock_);
  ::close(lock_);
  lock_ = -1;
}

RunFile::~RunFile() {
  if (lock_ < 0) return;
  // Emptied and not removed: another run may just be waiting for this very file.
  if (::ftruncate(lock_, 0) != 0) {
    // It will be taken for that of a killed run; the next one then has the same token.
  }
  ::close(lock_);
}

void RunFile::keep(int port, const std::string& token) {
  if (lock_ < 0) return;
  const std::string text = text_of(Json{{"port", port}, {"token", token}});
  if (::ftruncate(lock_, 0) != 0 ||
      ::pwrite(lock_, text.data(), text.size(), 0) != ssize_t(text.size()))
    static_cast<void>(::ftruncate(lock_, 0) == 0);
}

}  // namespace hydrodip
