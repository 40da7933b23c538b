// A new ZIP archive. Its bytes depend on what is put in alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hydrodip {

// Nothing of the archive is on disk before close(). Whatever fails throws InputError, naming the
// archive as `name`.
class ArchiveWriter {
 public:
  ArchiveWriter(const std::filesystem::path& file, const std::string& name,
                const std::string& comment = "");
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  // Names are UTF-8. Bytes and files have to outlive close().
  void add(const std::string& name, const std::vector<std::uint8_t>& bytes);
  void add(const std::string& name, const std::filesystem::path& file);
  void close();

 private:
  void add_source(const std::string& name, void* source);
  [[noreturn]] void fail(const char* why) const;

  std::string name_;
  void* archive_ = nullptr;
};

}  // namespace hydrodip
