// The files that a model names, found beside it, and remembered for the report.
#pragma once

#include <filesystem>
#include <map>
#include <unordered_map>

#include "model_io/model_file.h"

namespace hydrodip {

class ModelFolder : public SideFiles {
 public:
  // `confined_to`: where all of them have to be; empty: anywhere.
  explicit ModelFolder(const std::filesystem::path& model,
                       const std::filesystem::path& confined_to = {});

  // Empty if there is no such file there. Tries the name as it stands, with a Windows exporter's
  // backslashes turned, percent escapes decoded, the bare file name beside the model, and last all
  // of these in any letter case.
  std::filesystem::path find(const std::string& name);

  std::string identity(const std::string& name) override;
  std::optional<FileBytes> read(const std::string& name) override;
  // Throws InputError if it cannot be read.
  FileBytes read_path(const std::filesystem::path& path);
  // Counts it among the files read.
  void note(const std::filesystem::path& path);

  // In the order in which they were read first.
  const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  bool is_file(const std::filesystem::path& path) const;
  std::filesystem::path in_any_case(const std::filesystem::path& relative);
  const std::unordered_map<std::string, std::string>& listing(const std::filesystem::path& folder);

  std::filesystem::path folder_, confined_to_;
  std::vector<std::filesystem::path> files_;
  std::unordered_map<std::string, std::filesystem::path> found_;
  // Per folder: names in lower case to names as they are.
  std::map<std::filesystem::path, std::unordered_map<std::string, std::string>> listings_;
};

}  // namespace hydrodip
