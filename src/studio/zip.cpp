#include "studio/zip.h"

#include <fmt/format.h>
#include <zip.h>

#include <cstdio>
#include <memory>

#include "base/error.h"
#include "model_io/archive_writer.h"
#include "studio/api_error.h"
#include "studio/job_files.h"

namespace hydrodip {
namespace {

constexpr std::size_t kPiece = std::size_t(1) << 16;
constexpr zip_int64_t kMostFiles = 2000;
constexpr double kMostRatio = 200, kFreely = 64e6;  // of bombs, and of what is small anyway

[[noreturn]] void refuse(const std::filesystem::path& archive, const std::string& why) {
  throw InputError(fmt::format("{}: {}", archive.filename().string(), why));
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

bool is_plain(const std::string& name) {
  try {
    require_plain_name(name);
    return !name.starts_with("__MACOSX/");
  } catch (const ApiError&) {
    return false;
  }
}

// What is being unpacked: all of it goes again unless all of it is there.
class Unpacked {
 public:
  Unpacked() = default;
  ~Unpacked() {
    std::error_code ignored;
    // Folders only if nobody has put anything else there.
    for (; !made_.empty(); made_.pop_back()) std::filesystem::remove(made_.back(), ignored);
  }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;

  void make_folder(const std::filesystem::path& folder) {
    std::error_code ignored;
    if (folder.empty() || std::filesystem::exists(folder, ignored)) return;
    make_folder(folder.parent_path());
    if (std::filesystem::create_directory(folder, ignored)) made_.push_back(folder);
  }
  void add(const std::filesystem::path& file) { made_.push_back(file); }
  void keep() { made_.clear(); }

 private:
  std::vector<std::filesystem::path> made_;
};

void unpack_file(zip_t* zip, zip_uint64_t index, const std::filesystem::path& archive,
                 const std::filesystem::path& to, Unpacked& unpacked, double& left) {
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> from(zip_fopen_index(zip, index, 0),
                                                               zip_fclose);
  if (!from) refuse(archive, "this archive is damaged, or locked by a password");
  unpacked.make_folder(to.parent_path());
  std::unique_ptr<std::FILE, CloseFile> out(std::fopen(to.c_str(), "wbx"));
  if (!out) refuse(archive, "it cannot be unpacked; free some space");
  unpacked.add(to);
  std::vector<char> piece(kPiece);
  while (true) {
    const zip_int64_t count = zip_fread(from.get(), piece.data(), piece.size());
    if (count < 0) refuse(archive, "this archive is damaged");
    if (count == 0) break;
    left -= double(count);
    if (left < 0) refuse(archive, "it unpacks to far more than a job may have");
    if (std::fwrite(piece.data(), 1, std::size_t(count), out.get()) != std::size_t(count))
      refuse(archive, "it cannot be unpacked; free some space");
  }
  // A full disk may only show now.
  if (std::fclose(out.release()) != 0) refuse(archive, "it cannot be unpacked; free some space");
}

}  // namespace

void unpack_zip(const std::filesystem::path& archive, std::uintmax_t most_bytes,
                const std::function<std::filesystem::path(const std::string& name)>& place) {
  int code = 0;
  zip_t* const opened = zip_open(archive.c_str(), ZIP_RDONLY, &code);
  if (!opened) refuse(archive, "this is no ZIP archive, or a damaged one");
  const std::unique_ptr<zip_t, void (*)(zip_t*)> zip(opened, zip_discard);
  const zip_int64_t count = zip_get_num_entries(opened, 0);
  if (count > kMostFiles) refuse(archive, "there are too many files in it");
  std::error_code none;
  double left = std::min(double(most_bytes),
                         kFreely + kMostRatio * double(std::filesystem::file_size(archive, none)));
  Unpacked unpacked;
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* raw = zip_get_name(opened, zip_uint64_t(i), ZIP_FL_ENC_GUESS);
    const std::string name = raw ? raw : "";
    if (!is_plain(name)) continue;
    const std::filesystem::path to = place(name);
    if (!to.empty()) unpack_file(opened, zip_uint64_t(i), archive, to, unpacked, left);
  }
  unpacked.keep();
}

void pack_zip(const std::filesystem::path& archive,
              const std::vector<std::pair<std::string, std::filesystem::path>>& files) {
  ArchiveWriter writer(archive, archive.filename().string());
  for (const auto& [name, path] : files) writer.add(name, path);
  writer.close();
}

}  // namespace hydrodip
