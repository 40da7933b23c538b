// A sweep's file: its tables, with words for what is wrong in them. What it may say stands at
// read_sweep().
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace hydrodip {

// A sweep has so many runs at most.
inline constexpr std::size_t kMostRuns = 1000000;

// Throws InputError, with the file and the place in it.
class SweepFile {
 public:
  using Json = nlohmann::ordered_json;
  // Names and what they are set to.
  using Entries = std::vector<std::pair<std::string, Json>>;

  explicit SweepFile(const std::filesystem::path& file);

  // Throws InputError, which says that of the file.
  [[noreturn]] void refuse(const std::string& what) const;
  // Throws InputError for more than a sweep may have.
  void require_few_enough(double runs) const;

  bool has(const std::string& table) const { return json_.contains(table); }
  // Whether [sweep] says something of it.
  bool says(const char* key) const { return table("sweep").contains(key); }

  const Json& table(const std::string& name) const;
  // A table's values, those of tables in it with their names in front: TOML's [vary.material]
  // z_stretch = ... and "material.z_stretch" = ... are the same. Ranges stay as they are.
  Entries entries(const Json& table) const;
  // The [[run]] tables.
  const Json& runs() const;

  // What [sweep] says: one of these, the first where it says nothing; a whole number.
  std::string choice(const char* key, const std::vector<std::string>& choices) const;
  std::uint64_t whole(const char* key, std::uint64_t otherwise, std::uint64_t least,
                      std::uint64_t most) const;

  // Files that the table names, as they are to be found from `folder`.
  std::string file_at(const Json& value, const std::string& where,
                      const std::filesystem::path& folder) const;
  // A parameter's value as --set takes it, but for files, which are named as file_at() does.
  std::string text(const Json& value, const std::string& name,
                   const std::filesystem::path& folder) const;

 private:
  void require_known(const Json& object, const std::string& prefix,
                     const std::vector<std::string>& names) const;
  void flatten(const Json& table, const std::string& prefix, Entries& entries) const;

  std::filesystem::path file_;
  Json json_;
};

// Whether they set that.
bool has_entry(const SweepFile::Entries& entries, const std::string& name);

}  // namespace hydrodip
