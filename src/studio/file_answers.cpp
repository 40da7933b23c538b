#include "studio/file_answers.h"

#include <cctype>
#include <cstdlib>
#include <map>
#include <utility>

#include "base/file.h"
#include "studio/api_error.h"
#include "studio/job_files.h"

namespace hydrodip {
namespace {

std::string type_of(const std::filesystem::path& file) {
  static const std::map<std::string, std::string> types = {{".pdf", "application/pdf"},
                                                           {".png", "image/png"},
                                                           {".jpg", "image/jpeg"},
                                                           {".jpeg", "image/jpeg"},
                                                           {".webp", "image/webp"},
                                                           {".gif", "image/gif"},
                                                           {".svg", "image/svg+xml"},
                                                           {".html", "text/html; charset=utf-8"},
                                                           {".json", "application/json"},
                                                           {".zip", "application/zip"},
                                                           {".glb", "model/gltf-binary"},
                                                           {".tif", "image/tiff"},
                                                           {".toml", "text/plain; charset=utf-8"}};
  const auto known = types.find(file.extension().string());
  return known == types.end() ? "application/octet-stream" : known->second;
}

}  // namespace

HttpAnswer bytes_answer(std::shared_ptr<const std::vector<std::uint8_t>> bytes,
                        const std::string& type) {
  if (!bytes) throw not_found();
  HttpAnswer answer;
  answer.type = type;
  answer.headers = {{"Cache-Control", "private, max-age=86400, immutable"}};
  answer.bytes = std::move(bytes);
  return answer;
}

// Pages and drawings of a job may hold scripts.
HttpAnswer file_answer(const std::filesystem::path& file, const std::string& save_as) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) throw not_found();
  HttpAnswer answer;
  answer.type = type_of(file);
  answer.headers = {{"Cache-Control", "no-store"},
                    {"Content-Security-Policy",
                     "sandbox allow-scripts allow-popups; default-src 'none'; img-src data: blob:; "
                     "style-src 'unsafe-inline'; script-src 'unsafe-inline' 'wasm-unsafe-eval'"}};
  if (answer.type == "application/pdf") answer.headers.pop_back();  // viewers are no page's
  if (!save_as.empty()) {
    std::string plain;
    for (const char c : save_as)
      plain +=
          std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == ' ' ? c : '_';
    answer.headers.emplace_back("Content-Disposition", "attachment; filename=\"" + plain + "\"");
  }
  answer.file = file;
  return answer;
}

std::filesystem::path file_in(const std::filesystem::path& folder, const std::string& name) {
  require_plain_name(name);
  std::error_code error;
  auto file = folder / name;
  if (folder.empty() || !std::filesystem::exists(file, error) || !lies_in(file, folder))
    throw not_found();
  return file;
}

HttpAnswer page_answer(const std::string& type, const std::string& name,
                       const std::string& built_in) {
  HttpAnswer answer;
  answer.type = type + "; charset=utf-8";
  answer.headers = {
      {"Cache-Control", "no-store"},
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' "
       "blob: data:; connect-src 'self'; worker-src 'self' blob:; font-src 'self' data:; "
       "frame-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"}};
  answer.body = built_in;
  // For work on the page: see docs/studio-api.md.
  if (const char* folder = std::getenv("HYDRODIP_STUDIO_PAGE"); folder && *folder) {
    const std::vector<std::uint8_t> bytes = read_file(std::filesystem::path(folder) / name);
    answer.body.assign(bytes.begin(), bytes.end());
  }
  return answer;
}

}  // namespace hydrodip
