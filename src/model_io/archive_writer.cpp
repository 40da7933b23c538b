#include "model_io/archive_writer.h"

#include <fmt/format.h>
#include <zip.h>

#include "base/error.h"

namespace hydrodip {
namespace {

constexpr const char* kNotWritten = "the archive cannot be written; free some space";

zip_t* zip_of(void* archive) { return static_cast<zip_t*>(archive); }

}  // namespace

ArchiveWriter::ArchiveWriter(const std::filesystem::path& file, const std::string& name,
                             const std::string& comment)
    : name_(name) {
  int code = 0;
  archive_ = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (archive_ == nullptr) fail(kNotWritten);
  if (!comment.empty())
    zip_set_archive_comment(zip_of(archive_), comment.c_str(), zip_uint16_t(comment.size()));
}

ArchiveWriter::~ArchiveWriter() {
  if (archive_ != nullptr) zip_discard(zip_of(archive_));
}

void ArchiveWriter::add(const std::string& name, const std::vector<std::uint8_t>& bytes) {
  add_source(name, zip_source_buffer(zip_of(archive_), bytes.data(), bytes.size(), 0));
}

void ArchiveWriter::add(const std::string& name, const std::filesystem::path& file) {
  add_source(name, zip_source_file(zip_of(archive_), file.c_str(), 0, -1));
}

void ArchiveWriter::add_source(const std::string& name, void* source) {
  constexpr zip_uint16_t kFirstDate = (1 << 5) | 1;  // 1980-01-01: bytes depend on no clock
  zip_t* const zip = zip_of(archive_);
  auto* const from = static_cast<zip_source_t*>(source);
  const zip_int64_t index =
      from != nullptr ? zip_file_add(zip, name.c_str(), from, ZIP_FL_ENC_UTF_8) : -1;
  if (index < 0) {
    if (from != nullptr) zip_source_free(from);
    fail("the archive cannot be made");
  }
  zip_file_set_dostime(zip, zip_uint64_t(index), 0, kFirstDate, 0);
}

void ArchiveWriter::close() {
  if (zip_close(zip_of(archive_)) != 0) fail(kNotWritten);
  archive_ = nullptr;
}

void ArchiveWriter::fail(const char* why) const {
  throw InputError(fmt::format("{}: {}", name_, why));
}

}  // namespace hydrodip
