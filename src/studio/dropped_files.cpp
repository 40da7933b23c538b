#include "studio/dropped_files.h"

#include <algorithm>
#include <array>

#include "artwork/artwork.h"
#include "base/error.h"
#include "base/file.h"
#include "model_io/text.h"
#include "report/plain_words.h"
#include "studio/zip.h"

namespace hydrodip {
namespace {

constexpr std::array<const char*, 5> kTextureWords = {"texture", "albedo", "diffuse", "basecolor",
                                                      "color"};

}  // namespace

ApiError bad_file(const std::string& sentence, const JobFiles& files) {
  return {422, "bad-file", in_plain_words(without_folder(sentence, files.uploads()))};
}

std::uintmax_t DroppedFiles::room_left() const {
  const std::uintmax_t used = files_.uploaded_bytes();
  return used < kMostJobBytes ? kMostJobBytes - used : 0;
}

std::uintmax_t DroppedFiles::room_for(const std::string& wanted) const {
  require_plain_name(wanted);
  if (kind_of_file(wanted) == "unknown")
    throw ApiError(422, "bad-file",
                   "This is no model, picture, job file or ZIP archive that the studio knows.");
  return std::min(kMostFileBytes, room_left());
}

std::string DroppedFiles::keep(const std::filesystem::path& whole, const std::string& wanted) {
  std::string name = files_.name_for_upload(wanted);
  const std::filesystem::path file = files_.uploads() / name;
  std::error_code error;
  // A link that a person put there may lead anywhere.
  if (!lies_in(file.parent_path(), files_.uploads()))
    throw ApiError(400, "bad-name", "A file of a job lies in the job's own folder: rename it.");
  std::filesystem::create_directories(file.parent_path(), error);
  std::filesystem::rename(whole, file, error);
  if (error) throw ApiError(500, "failed", "The file cannot be kept; free some space.");
  if (name != wanted) wanted_[name] = wanted;
  fresh_.insert(name);
  return name;
}

std::vector<std::string> DroppedFiles::take_in(const std::vector<std::string>& kept) {
  const auto had_other_name = [&](const std::string& name) { return wanted_.contains(name); };
  std::string folder;
  if (kept.size() > 1 && std::any_of(kept.begin(), kept.end(), had_other_name))
    folder = files_.new_folder(had_other_name(kept.front()) ? wanted_[kept.front()] : kept.front());
  std::vector<std::string> names;
  for (const std::string& name : kept) {
    const std::filesystem::path file = files_.find(name);
    if (kind_of_file(name) == "archive") {
      unpack(name, names);
    } else if (folder.empty()) {
      names.push_back(name);
    } else {
      names.push_back(folder + "/" + (had_other_name(name) ? wanted_[name] : name));
      require_plain_name(names.back());
      const std::filesystem::path to = files_.uploads() / names.back();
      std::error_code error;
      std::filesystem::create_directories(to.parent_path(), error);
      std::filesystem::rename(file, to, error);
      if (error) throw ApiError(500, "failed", "The files cannot be kept; free some space.");
      if (fresh_.erase(name) > 0) fresh_.insert(names.back());
    }
    wanted_.erase(name);
  }
  return names;
}

void DroppedFiles::refuse(const std::vector<std::string>& names) {
  std::error_code ignored;
  for (const std::string& name : names)
    if (fresh_.erase(name) > 0) std::filesystem::remove(files_.uploads() / name, ignored);
}

void DroppedFiles::accept(const std::vector<std::string>& names) {
  for (const std::string& name : names) fresh_.erase(name);
}

void DroppedFiles::unpack(const std::string& archive, std::vector<std::string>& names) {
  const std::filesystem::path file = files_.find(archive);
  const std::uintmax_t most_bytes = room_left();
  const auto is_wanted = [](const std::string& inner) {
    return kind_of_file(inner) != "unknown" && kind_of_file(inner) != "archive";
  };
  try {
    bool meets_others = false;
    unpack_zip(file, most_bytes, [&](const std::string& inner) -> std::filesystem::path {
      meets_others = meets_others || (is_wanted(inner) && files_.has(inner));
      return {};
    });
    const std::string folder = meets_others ? files_.new_folder(archive) + "/" : "";
    unpack_zip(file, most_bytes, [&](const std::string& inner) -> std::filesystem::path {
      if (!is_wanted(inner) || files_.has(folder + inner)) return {};
      names.push_back(folder + inner);
      fresh_.insert(names.back());
      return files_.uploads() / names.back();
    });
  } catch (const InputError& error) {
    throw bad_file(error.what(), files_);
  }
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  fresh_.erase(archive);
}

UnreadFiles DroppedFiles::unread(const std::vector<std::string>& names) const {
  UnreadFiles files;
  for (const std::string& name : names) {
    const std::string kind = kind_of_file(name);
    // Whose pictures lie beside it is told by the model alone.
    if (kind == "model" && files.model.empty() && (names.size() > 1 || fresh_.contains(name)))
      files.model = files_.find(name);
    if (kind == "picture" && fresh_.contains(name)) files.pictures.push_back(files_.find(name));
  }
  return files;
}

std::shared_ptr<const Model> UnreadFiles::read(const LoadModel& load_model) const {
  const std::shared_ptr<const Model> read = model.empty() ? nullptr : load_model(model);
  for (const std::filesystem::path& picture : pictures) {
    const auto is_it = [&](const std::filesystem::path& file) {
      std::error_code ignored;
      return std::filesystem::equivalent(file, picture, ignored);
    };
    if (read && std::any_of(read->files.begin(), read->files.end(), is_it)) continue;
    ArtworkLayer layer;
    layer.image = picture;
    read_pictures({layer});
  }
  return read;
}

std::string texture_for(const Model& model, const std::string& name,
                        const std::vector<std::string>& names) {
  if (model.object->uvs.empty() || model.object->has_appearance()) return "";
  std::vector<std::string> pictures;
  for (const std::string& other : names)
    if (kind_of_file(other) == "picture") pictures.push_back(other);
  if (pictures.size() != 1) return "";
  const auto stem_of = [](const std::string& file) {
    return lower(std::filesystem::path(file).stem().string());
  };
  const std::string stem = stem_of(pictures[0]);
  const bool meant = stem.starts_with(stem_of(name)) ||
                     std::any_of(kTextureWords.begin(), kTextureWords.end(), [&](const char* word) {
                       return stem.find(word) != std::string::npos;
                     });
  return meant ? pictures[0] : "";
}

}  // namespace hydrodip
