#include "base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "base/error.h"
#include "base/run_scope.h"

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
                               path.string(), why));
}

[[noreturn]] void refuse_write(const std::filesystem::path& path, int error) {
  throw InputError(fmt::format("{}: cannot be written ({}); choose another folder or free space.",
                               path.string(), reason(error)));
}

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
  if (!file) refuse_write(path, errno);
  for (std::size_t begin = 0; begin < size; begin += kPiece) {
    check_cancelled();
    const std::size_t count = std::min(kPiece, size - begin);
    if (std::fwrite(static_cast<const char*>(data) + begin, 1, count, file.get()) != count)
      refuse_write(path, errno);
  }
  // A full disk may only show when the last buffer goes out.
  if (std::fclose(file.release()) != 0) refuse_write(path, errno);
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  write_file(path, text.data(), text.size());
}

bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code error;
  const auto whole = std::filesystem::weakly_canonical(file, error);
  if (error) return false;
  const auto root = std::filesystem::weakly_canonical(folder, error);
  return !error &&
         std::mismatch(root.begin(), root.end(), whole.begin(), whole.end()).first == root.end();
}

std::string sha256_hex(const std::vector<std::uint8_t>& bytes) {
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

}  // namespace hydrodip
