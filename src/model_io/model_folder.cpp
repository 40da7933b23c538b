#include "model_io/model_folder.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "model_io/text.h"

namespace hydrodip {

namespace {

namespace fs = std::filesystem;

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string percent_decoded(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 &&
                        hex_digit(text[i + 2]) >= 0;
    out += escape ? char(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2])) : text[i];
    if (escape) i += 2;
  }
  return out;
}

// A path of another computer, and what is left of it when its outer folders are taken away: of
// C:/me/textures/wood.png also textures/wood.png, which came along with the model, and wood.png.
void add_with_fewer_folders(const fs::path& path, std::vector<fs::path>& out) {
  constexpr std::ptrdiff_t kMostFolders = 16;
  const std::ptrdiff_t parts = std::distance(path.begin(), path.end());
  out.push_back(path);
  for (std::ptrdiff_t left = std::min(parts - 1, kMostFolders); left > 0; --left) {
    fs::path rest;
    for (auto part = std::next(path.begin(), parts - left); part != path.end(); ++part)
      rest /= *part;
    out.push_back(rest);
  }
}

}  // namespace

ModelFolder::ModelFolder(const fs::path& model, const fs::path& confined_to)
    : folder_(model.parent_path()), confined_to_(confined_to) {}

bool ModelFolder::is_file(const fs::path& path) const {
  std::error_code ignored;
  if (!path.has_filename() || !fs::is_regular_file(path, ignored)) return false;
  return confined_to_.empty() || lies_in(path, confined_to_);
}

fs::path ModelFolder::find(const std::string& name) {
  const auto [known, is_new] = found_.try_emplace(name);
  if (!is_new) return known->second;
  if (name.find('\0') != std::string::npos) return {};
  std::string forward = name;
  std::replace(forward.begin(), forward.end(), '\\', '/');
  const fs::path plain(forward), decoded(percent_decoded(forward).c_str());
  std::vector<fs::path> tried = {name};
  add_with_fewer_folders(plain, tried);
  if (decoded != plain) add_with_fewer_folders(decoded, tried);
  for (const fs::path& candidate : tried)
    if (is_file(folder_ / candidate)) return found_[name] = folder_ / candidate;
  for (const fs::path& candidate : tried) {
    const fs::path found = in_any_case(candidate);
    if (!found.empty()) return found_[name] = found;
  }
  return {};
}

std::string ModelFolder::identity(const std::string& name) {
  std::error_code ignored;
  return fs::canonical(find(name), ignored).string();
}

fs::path ModelFolder::in_any_case(const fs::path& relative) {
  if (relative.is_absolute() || !relative.has_filename()) return {};
  fs::path at = folder_;
  for (const fs::path& part : relative) {
    std::error_code ignored;
    if (part == "." || part == ".." || fs::exists(at / part, ignored)) {
      at /= part;
      continue;
    }
    const auto& names = listing(at);
    const auto known = names.find(lower(part.string()));
    if (known == names.end()) return {};
    at /= known->second;
  }
  return is_file(at) ? at : fs::path();
}

const std::unordered_map<std::string, std::string>& ModelFolder::listing(const fs::path& folder) {
  const auto [known, is_new] = listings_.try_emplace(folder);
  if (!is_new) return known->second;
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder.empty() ? "." : folder, error), end; !error && it != end;
       it.increment(error))
    names.push_back(it->path().filename().string());
  std::sort(names.begin(), names.end());  // of names that differ in case alone, always the same
  for (const std::string& name : names) known->second.try_emplace(lower(name), name);
  return known->second;
}

std::optional<FileBytes> ModelFolder::read(const std::string& name) {
  const fs::path found = find(name);
  if (found.empty()) return {};
  try {
    return read_path(found);
  } catch (const InputError&) {
    return {};
  }
}

FileBytes ModelFolder::read_path(const fs::path& path) {
  FileBytes bytes = read_file(path);
  note(path);
  return bytes;
}

void ModelFolder::note(const fs::path& path) {
  if (std::find(files_.begin(), files_.end(), path) == files_.end()) files_.push_back(path);
}

}  // namespace hydrodip
