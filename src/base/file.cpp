#include "base/file.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "base/error.h"

namespace hydrodip {

namespace {

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

}  // namespace

std::vector<std::uint8_t> read_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) refuse_read(path, "it is a folder");
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) refuse_read(path, reason(errno));
  std::vector<std::uint8_t> bytes;
  const auto size = std::filesystem::file_size(path, ignored);
  if (!ignored) bytes.reserve(size);
  // Reads to the end rather than trusting the size: pipes have none.
  std::uint8_t chunk[1 << 16];
  while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, file.get())) {
    bytes.insert(bytes.end(), chunk, chunk + count);
  }
  if (std::ferror(file.get())) refuse_read(path, reason(errno));
  return bytes;
}

void write_file(const std::filesystem::path& path, const void* data, std::size_t size) {
  File file(std::fopen(path.c_str(), "wb"));
  if (!file) refuse_write(path, errno);
  if (std::fwrite(data, 1, size, file.get()) != size) refuse_write(path, errno);
  // A full disk may only show when the last buffer goes out.
  if (std::fclose(file.release()) != 0) refuse_write(path, errno);
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  write_file(path, text.data(), text.size());
}

std::string sha256_hex(const std::vector<std::uint8_t>& bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest, &size, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available in this OpenSSL");
  }
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

}  // namespace hydrodip
