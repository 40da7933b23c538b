// What a computed value depends on, as text.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <type_traits>

#include "hydrodip/hydrodip.h"

namespace hydrodip {

// What a value depends on, as text that differs where anything in it does.
class ContentKey {
 public:
  explicit ContentKey(const std::string& kind) { add(kind); }

  ContentKey& add(double value);
  ContentKey& add(const std::string& text);
  template <class Enum>
  requires std::is_enum_v<Enum> || std::is_integral_v<Enum> ContentKey& add(Enum value) {
    return add(double(value));
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// A file as the file system tells it apart from a changed one.
struct FileState {
  std::filesystem::path path;
  std::uintmax_t bytes = 0;
  std::filesystem::file_time_type changed;
  bool operator==(const FileState&) const = default;
};
// Of a file that is not there, too.
FileState state_of(const std::filesystem::path& path);

// All that these say. Pictures and profiles that they name count by the state of their files.
void add(ContentKey& key, const LoadOptions& load);
void add(ContentKey& key, const PoseOptions& pose);
void add(ContentKey& key, const FilmOptions& film);
void add(ContentKey& key, const TrajectoryOptions& way);
// Throws InputError for what is not known by its content: a material law or a solver of one's own,
// steps that dips keep for one another.
void add(ContentKey& key, const DipOptions& dip);
void add(ContentKey& key, const LinearColor& color);
void add(ContentKey& key, const PrinterOptions& printer);
void add(ContentKey& key, const DesignOptions& design);
void add(ContentKey& key, const ArtworkLayer& layer);

}  // namespace hydrodip
