#include "studio/run_file.h"

#include <fcntl.h>
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

RunFile::RunFile(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "run.json";
  lock_ = FileLock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600), file);
  if (is_ours())
    earlier_ = run_in(lock_.descriptor());
  else if (lock_.state() == FileLock::State::kTaken)
    another_ = run_in(lock_.descriptor());
}

RunFile::~RunFile() {
  if (!is_ours()) return;
  // Emptied and not removed: another run may just be waiting for this very file.
  if (::ftruncate(lock_.descriptor(), 0) != 0) {
    // It will be taken for that of a killed run; the next one then has the same token.
  }
}

bool RunFile::is_ours() const {
  return lock_.state() == FileLock::State::kHeld || lock_.state() == FileLock::State::kNone;
}

void RunFile::keep(int port, const std::string& token) {
  if (!is_ours()) return;
  const std::string text = text_of(Json{{"port", port}, {"token", token}});
  const int file = lock_.descriptor();
  if (::ftruncate(file, 0) != 0 ||
      ::pwrite(file, text.data(), text.size(), 0) != ssize_t(text.size()))
    static_cast<void>(::ftruncate(file, 0) == 0);
}

}  // namespace hydrodip
