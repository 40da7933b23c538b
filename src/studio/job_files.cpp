#include "studio/job_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/file.h"
#include "studio/api_error.h"

namespace hydrodip {
namespace {

constexpr std::size_t kLongestPart = 200;
constexpr std::size_t kDeepest = 6;

std::string ending_of(const std::string& name) {
  std::string ending = std::filesystem::path(name).extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

bool is_one_of(const std::string& ending, const std::vector<std::string>& endings) {
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

bool is_plain_part(const std::string& part) {
  return !part.empty() && part.size() <= kLongestPart && part[0] != '.' &&
         std::none_of(part.begin(), part.end(), [](char c) {
           const auto byte = static_cast<unsigned char>(c);
           return byte < 0x20 || byte == 0x7f || c == '\\' || c == ':';
         });
}

bool is_plain_name(const std::string& name) {
  std::size_t parts = 0;
  for (std::size_t begin = 0; begin <= name.size(); ++parts) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    if (!is_plain_part(name.substr(begin, end - begin))) return false;
    begin = end + 1;
  }
  return parts <= kDeepest;
}

}  // namespace

const std::vector<std::string>& model_endings() {
  static const std::vector<std::string> list = {"obj", "ply", "stl", "off", "3mf", "gltf", "glb"};
  return list;
}

const std::vector<std::string>& picture_endings() {
  static const std::vector<std::string> list = {"png", "jpg",  "jpeg", "webp", "gif",
                                                "tif", "tiff", "bmp",  "svg",  "tga"};
  return list;
}

std::string kind_of_file(const std::string& name) {
  const std::string ending = ending_of(name);
  if (is_one_of(ending, model_endings())) return "model";
  if (is_one_of(ending, picture_endings())) return "picture";
  if (ending == "toml") return "job";
  if (ending == "zip") return "archive";
  if (is_one_of(ending, {"mtl", "bin", "icc", "icm", "csv"})) return "part";
  return "unknown";
}

std::string without_folder(std::string sentence, const std::filesystem::path& folder) {
  const std::string prefix = folder.string() + "/";
  for (std::size_t at = 0; (at = sentence.find(prefix, at)) != std::string::npos;)
    sentence.erase(at, prefix.size());
  return sentence;
}

void require_plain_name(const std::string& name) {
  if (is_plain_name(name)) return;
  throw ApiError(400, "bad-name",
                 "A file of a job has an ordinary name, in the job's own folder: rename it.");
}

std::filesystem::path JobFiles::find(const std::string& name) const {
  require_plain_name(name);
  std::error_code ignored;
  auto uploaded = uploads_ / name;
  if (lies_in(uploaded, uploads_) && std::filesystem::is_regular_file(uploaded, ignored))
    return uploaded;
  if (const auto known = granted_.find(name); known != granted_.end()) return known->second;
  throw ApiError(422, "bad-value", fmt::format("The job has no file '{}'.", name));
}

bool JobFiles::has(const std::string& name) const {
  std::error_code ignored;
  return granted_.contains(name) || std::filesystem::exists(uploads_ / name, ignored);
}

std::string JobFiles::name_for_upload(const std::string& wanted) const {
  require_plain_name(wanted);
  if (!has(wanted)) return wanted;
  const std::filesystem::path path(wanted);
  for (int number = 2;; ++number) {
    const std::filesystem::path next =
        path.parent_path() /
        fmt::format("{}-{}{}", path.stem().string(), number, path.extension().string());
    if (!has(next.string())) return next.string();
  }
}

std::string JobFiles::new_folder(const std::string& wanted) const {
  require_plain_name(wanted);
  for (int number = 2;; ++number) {
    std::string name = fmt::format("{}-{}", std::filesystem::path(wanted).stem().string(), number);
    if (!has(name)) return name;
  }
}

std::string JobFiles::grant(const std::filesystem::path& file) {
  const auto whole = std::filesystem::absolute(file).lexically_normal();
  const auto inside =
      whole.lexically_relative(std::filesystem::absolute(uploads_).lexically_normal());
  if (!inside.empty() && *inside.begin() != ".." && is_plain_name(inside.string()))
    return inside.string();
  for (const auto& [name, known] : granted_)
    if (known == whole) return name;
  std::string wanted = whole.filename().string();
  if (!is_plain_name(wanted)) wanted = "file" + whole.extension().string();
  std::string name = name_for_upload(wanted);
  granted_[name] = whole;
  return name;
}

std::vector<std::string> JobFiles::names() const {
  std::vector<std::string> list;
  std::error_code error;
  for (auto entry = std::filesystem::recursive_directory_iterator(uploads_, error);
       !error && entry != std::filesystem::recursive_directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().lexically_relative(uploads_).string();
    if (entry->is_regular_file(error) && is_plain_name(name) && lies_in(entry->path(), uploads_))
      list.push_back(name);
  }
  std::sort(list.begin(), list.end());
  for (const auto& [name, path] : granted_) list.push_back(name);
  return list;
}

std::uintmax_t JobFiles::uploaded_bytes() const {
  std::uintmax_t bytes = 0;
  std::error_code error;
  for (const std::string& name : names())
    if (!granted_.contains(name)) {
      const std::uintmax_t size = std::filesystem::file_size(uploads_ / name, error);
      if (!error) bytes += size;
    }
  return bytes;
}

Json JobFiles::granted() const {
  Json list = Json::object();
  for (const auto& [name, path] : granted_) list[name] = path.string();
  return list;
}

void JobFiles::set_granted(const Json& granted) {
  granted_.clear();
  for (const auto& [name, path] : granted.items()) granted_[name] = path.get<std::string>();
}

}  // namespace hydrodip
