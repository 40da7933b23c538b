#include "base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <regex>
#include <system_error>

#include "base/error.h"
#include "base/file_lock.h"
#include "base/run_scope.h"
#include "base/staging_name.h"

namespace hydrodip {

namespace {

// Between two looks whether the job was cancelled: a millisecond.
constexpr std::size_t kPiece = std::size_t(1) << 20;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

// Plain words for the usual reasons, the system's for the others.
std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void refuse_read(const std::filesystem::path& path, const std::string& why) {
  throw InputError(fmt::format("{}: cannot be read ({}); check the path and its permissions.",
                               final_path(path).string(), why));
}

[[noreturn]] void refuse_write_for(const std::filesystem::path& path, int error) {
  refuse_write(path, reason(error));
}

void put(std::FILE* file, const std::filesystem::path& path, const void* data, std::size_t size) {
  for (std::size_t begin = 0; begin < size; begin += kPiece) {
    check_cancelled();
    const std::size_t count = std::min(kPiece, size - begin);
    if (std::fwrite(static_cast<const char*>(data) + begin, 1, count, file) != count)
      refuse_write_for(path, errno);
  }
}

// Where links lead, whether or not there is anything.
std::filesystem::path behind_links(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // as many as the system follows
  std::error_code error;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(path, error); ++i) {
    const std::filesystem::path to = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / to;
  }
  return path;
}

// Short, as the target's own name may be as long as names can be.
std::string part_name(int process, int number) {
  return fmt::format("{}{}-{}.part", kStagingPrefix, process, number);
}

bool is_part_name(const std::string& name) {
  if (!name.starts_with(kStagingPrefix)) return false;  // as nearly all
  static const std::regex kPattern(R"(\.hydrodip-[0-9]+-[0-9]+\.part)");
  return std::regex_match(name, kPattern);
}

// Parts that nobody has locked were left by processes that were killed.
void clear_abandoned_parts(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> found;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error))
    if (is_part_name(it->path().filename().string())) found.push_back(it->path());
  for (const std::filesystem::path& part : found) {
    const FileLock lock(::open(part.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC), part);
    if (lock.state() == FileLock::State::kHeld) ::unlink(part.c_str());
  }
}

// A file beside the one that it is to become; it goes again unless it does. Locked as long as it is
// written.
class Part {
 public:
  // `path`: as the user calls the target.
  Part(const std::filesystem::path& target, const std::filesystem::path& path) : path_(path) {
    std::filesystem::path folder = target.parent_path();
    if (folder.empty()) folder = ".";
    clear_abandoned_parts(folder);
    for (int number = 0; !file_; ++number) {
      part_ = folder / part_name(::getpid(), number);
      const int descriptor = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor < 0 && errno == EEXIST) continue;
      if (descriptor < 0) refuse_write_for(path_, errno);
      lock_ = FileLock(descriptor, part_);
      // Another who cleared up may have come between.
      if (lock_.state() == FileLock::State::kTaken || lock_.state() == FileLock::State::kGone)
        continue;
      const int own = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
      if (own < 0) {
        const int error = errno;
        ::unlink(part_.c_str());
        refuse_write_for(path_, error);
      }
      file_.reset(::fdopen(own, "wb"));
    }
  }
  ~Part() {
    if (!part_.empty()) ::unlink(part_.c_str());
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  std::FILE* file() const { return file_.get(); }

  void become(const std::filesystem::path& target, ExistingFile existing) {
    if (std::fflush(file_.get()) != 0) refuse_write_for(path_, errno);
    // EINVAL: of a file system that has nothing to wait for.
    if (::fsync(::fileno(file_.get())) != 0 && errno != EINVAL) refuse_write_for(path_, errno);
    if (std::fclose(file_.release()) != 0) refuse_write_for(path_, errno);
    if (move(target, existing) != 0) refuse_write_for(path_, errno);
    part_.clear();
  }

 private:
  int move(const std::filesystem::path& target, ExistingFile existing) const {
    if (existing == ExistingFile::kReplaced) return std::rename(part_.c_str(), target.c_str());
    const int result =
        ::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE);
    if (result == 0 || (errno != EINVAL && errno != ENOSYS)) return result;
    // The file system cannot look and move at once.
    std::error_code ignored;
    if (!std::filesystem::exists(target, ignored))
      return std::rename(part_.c_str(), target.c_str());
    errno = EEXIST;
    return -1;
  }

  std::filesystem::path path_, part_;
  FileLock lock_;
  File file_;
};

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

// Waits for what another program writes, and for a cancel.
std::vector<std::uint8_t> read_pipe(const std::filesystem::path& path) {
  constexpr std::size_t kMost = std::size_t(1) << 31;
  constexpr int kPatience_ms = 20;
  const Descriptor pipe(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (pipe.number() < 0) refuse_read(path, reason(errno));
  std::vector<std::uint8_t> bytes;
  std::uint8_t chunk[1 << 16];
  for (;;) {
    check_cancelled();
    pollfd ready{pipe.number(), POLLIN, 0};
    if (::poll(&ready, 1, kPatience_ms) < 0 && errno != EINTR) refuse_read(path, reason(errno));
    if (ready.revents == 0) continue;
    const ssize_t count = ::read(pipe.number(), chunk, sizeof chunk);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (count < 0) refuse_read(path, reason(errno));
    if (count == 0) return bytes;
    bytes.insert(bytes.end(), chunk, chunk + count);
    if (bytes.size() > kMost) refuse_read(path, "more than 2 GB come out of it");
  }
}

}  // namespace

void refuse_write(const std::filesystem::path& path, const std::string& why) {
  throw InputError(fmt::format("{}: cannot be written ({}); choose another folder or free space.",
                               final_path(path).string(), why));
}

std::vector<std::uint8_t> read_file(const std::filesystem::path& path) {
  std::error_code ignored;
  switch (std::filesystem::status(path, ignored).type()) {
    case std::filesystem::file_type::directory:
      refuse_read(path, "it is a folder");
    case std::filesystem::file_type::character:
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::socket:
      refuse_read(path, "it is a device, not a file");
    case std::filesystem::file_type::fifo:
      return read_pipe(path);
    default:
      break;
  }
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) refuse_read(path, reason(errno));
  std::vector<std::uint8_t> bytes;
  const auto size = std::filesystem::file_size(path, ignored);
  if (!ignored) bytes.reserve(size);
  // Reads to the end rather than trusting the size: files of the system have none.
  std::uint8_t chunk[1 << 16];
  while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, file.get())) {
    check_cancelled();
    bytes.insert(bytes.end(), chunk, chunk + count);
  }
  if (std::ferror(file.get())) refuse_read(path, reason(errno));
  return bytes;
}

void write_file(const std::filesystem::path& path, const void* data, std::size_t size) {
  File file(std::fopen(path.c_str(), "wb"));
  if (!file) refuse_write_for(path, errno);
  put(file.get(), path, data, size);
  // A full disk may only show when the last buffer goes out.
  if (std::fclose(file.release()) != 0) refuse_write_for(path, errno);
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  write_file(path, text.data(), text.size());
}

void write_whole(const std::filesystem::path& path, const void* data, std::size_t size,
                 ExistingFile existing) {
  const std::filesystem::path target = behind_links(path);
  struct stat there = {};
  const bool is_there = ::stat(target.c_str(), &there) == 0;
  if (is_there && existing == ExistingFile::kKept) refuse_write_for(path, EEXIST);
  if (is_there && S_ISDIR(there.st_mode)) refuse_write_for(path, EISDIR);
  if (is_there && !S_ISREG(there.st_mode)) return write_file(path, data, size);
  // A new file would take the place of one that is protected.
  if (is_there && ::access(target.c_str(), W_OK) != 0) refuse_write_for(path, errno);
  Part part(target, path);
  if (is_there) ::fchmod(::fileno(part.file()), there.st_mode & 07777);
  put(part.file(), path, data, size);
  part.become(target, existing);
}

void write_whole(const std::filesystem::path& path, const std::string& text) {
  write_whole(path, text.data(), text.size());
}

bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code error;
  const auto whole = std::filesystem::weakly_canonical(file, error);
  if (error) return false;
  const auto root = std::filesystem::weakly_canonical(folder, error);
  return !error &&
         std::mismatch(root.begin(), root.end(), whole.begin(), whole.end()).first == root.end();
}

std::string sha256_hex(std::span<const std::uint8_t> bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> hash(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  bool fine = hash && EVP_DigestInit_ex(hash.get(), EVP_sha256(), nullptr) == 1;
  for (std::size_t begin = 0; fine && begin < bytes.size(); begin += kPiece) {
    check_cancelled();
    const std::size_t count = std::min(kPiece, bytes.size() - begin);
    fine = EVP_DigestUpdate(hash.get(), bytes.data() + begin, count) == 1;
  }
  if (!fine || EVP_DigestFinal_ex(hash.get(), digest, &size) != 1)
    throw std::runtime_error("SHA-256 is not available in this OpenSSL");
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

std::string sha256_hex(std::string_view text) {
  return sha256_hex(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace hydrodip
