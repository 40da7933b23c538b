#include "studio/job_copies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/unicode.h"
#include "hydrodip/hydrodip.h"
#include "settings/job_file.h"
#include "studio/document.h"
#include "studio/job_files.h"
#include "studio/zip.h"

namespace hydrodip {
namespace {

constexpr std::size_t kLongestFileName = 120;

// The files that the model itself names, as they are now; none of one that cannot be read.
std::vector<std::filesystem::path> parts_of_model(const JobConfig& config,
                                                  const RunContext& context) {
  if (config.model.empty()) return {};
  LoadOptions own = config.object.load;
  own.texture.clear();
  try {
    std::vector<std::filesystem::path> files = load(config.model, own, context.quiet()).files;
    std::erase(files, config.model);
    return files;
  } catch (const InputError&) {
    return {};
  }
}

std::vector<std::filesystem::path> with_parts(const JobConfig& config, const RunContext& context) {
  std::vector<std::filesystem::path> files = parts_of_model(config, context);
  files.insert(files.begin(), config.model);
  return files;
}

// Whether nothing is there yet, or the same.
bool may_become(const std::filesystem::path& to, const std::filesystem::path& file) {
  std::error_code ignored;
  return !std::filesystem::exists(to, ignored) || read_file(to) == read_file(file);
}

void copy_to(const std::filesystem::path& file, const std::filesystem::path& to) {
  std::error_code ignored;
  if (std::filesystem::exists(to, ignored)) return;
  std::filesystem::create_directories(to.parent_path(), ignored);
  const std::vector<std::uint8_t> bytes = read_file(file);
  write_whole(to, bytes.data(), bytes.size(), ExistingFile::kKept);
}

// Files that name each other, as they lie to each other; into the folder, or if other ones of their
// names are there into one inside it. Where the first of them is then.
std::filesystem::path copy_together(const std::vector<std::filesystem::path>& files,
                                    const std::filesystem::path& folder) {
  std::filesystem::path root = files.front().parent_path();
  const auto is_outside = [&](const std::filesystem::path& file) { return !lies_in(file, root); };
  while (std::any_of(files.begin(), files.end(), is_outside)) root = root.parent_path();
  const auto inside = [&](const std::filesystem::path& file) {
    return std::filesystem::weakly_canonical(file).lexically_relative(
        std::filesystem::weakly_canonical(root));
  };
  std::filesystem::path into = folder;
  const auto fits = [&](const std::filesystem::path& file) {
    return may_become(into / inside(file), file);
  };
  const std::string stem = files.front().stem().string();
  for (int number = 1; !std::all_of(files.begin(), files.end(), fits); ++number)
    into = folder / (number == 1 ? stem : fmt::format("{}-{}", stem, number));
  for (const std::filesystem::path& file : files) copy_to(file, into / inside(file));
  return into / inside(files.front());
}

}  // namespace

std::string file_name_of(const std::string& job_name) {
  std::string safe;
  for (const char c : job_name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool fine = byte >= 0x80 || std::isalnum(byte) || c == '-' || c == '_' || c == ' ' ||
                      c == ',' || c == '+';
    safe += fine ? c : '-';
  }
  while (!safe.empty() && (safe.front() == ' ' || safe.front() == '-')) safe.erase(0, 1);
  return safe.empty() ? "job" : cut_utf8(safe, kLongestFileName);
}

void bring_along(JobConfig& config, const std::filesystem::path& uploads,
                 const std::filesystem::path& folder, const RunContext& context) {
  const auto is_uploaded = [&](const std::filesystem::path& file) {
    return lies_in(file, uploads);
  };
  if (is_uploaded(config.model)) config.model = copy_together(with_parts(config, context), folder);
  each_side_file(config, [&](std::filesystem::path& file) {
    if (!is_uploaded(file)) return;
    std::filesystem::path to = folder / file.filename();
    for (int number = 2; !may_become(to, file); ++number)
      to = folder / fmt::format("{}-{}{}", file.stem().string(), number, file.extension().string());
    copy_to(file, to);
    file = to;
  });
}

std::filesystem::path pack_job(JobConfig config, const std::vector<std::string>& parameters,
                               const std::string& name, const std::filesystem::path& folder,
                               const RunContext& context) {
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  std::filesystem::create_directories(folder, ignored);
  std::vector<std::pair<std::string, std::filesystem::path>> files;
  // Every file gets the place beside the job file from which the job names it.
  std::set<std::string> used;
  const auto put = [&](std::filesystem::path& file) {
    std::string inner = file.filename().string();
    for (int number = 2; used.contains(inner); ++number)
      inner = fmt::format("{}-{}{}", file.stem().string(), number, file.extension().string());
    used.insert(inner);
    files.emplace_back(inner, file);
    file = folder / inner;
  };
  for (const std::filesystem::path& file : parts_of_model(config, context)) {
    // A model may name any file: only what can be a part of one goes along.
    if (file == config.object.load.texture || kind_of_file(file.string()) == "unknown") continue;
    std::string inner = file.lexically_relative(config.model.parent_path()).string();
    if (inner.empty() || inner.starts_with("..")) inner = file.filename().string();
    if (used.insert(inner).second) files.emplace_back(inner, file);
  }
  if (!config.model.empty()) put(config.model);
  each_side_file(config, put);
  const std::filesystem::path toml = folder / (name + ".toml");
  write_whole(toml, job_file(config, folder, parameters));
  files.insert(files.begin(), {name + ".toml", toml});
  std::filesystem::path archive = folder / (name + ".zip");
  pack_zip(archive, files);
  return archive;
}

}  // namespace hydrodip
