#include "studio/sample_shelf.h"

#include <fmt/format.h>

#include <system_error>

#include "base/error.h"
#include "base/run_scope.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

// Tells builds of the program apart: another one may paint otherwise.
std::string this_build() {
  std::error_code error;
  const std::filesystem::path program = "/proc/self/exe";
  const auto bytes = std::filesystem::file_size(program, error);
  const auto written = std::filesystem::last_write_time(program, error);
  return fmt::format("{:x}-{:x}", bytes, written.time_since_epoch().count());
}

void copy_files(const std::filesystem::path& from, const std::filesystem::path& to) {
  for (const auto& entry : std::filesystem::directory_iterator(from))
    std::filesystem::copy_file(entry.path(), to / entry.path().filename());
}

}  // namespace

SampleShelf::SampleShelf(const std::filesystem::path& folder) : folder_(folder / this_build()) {}

std::filesystem::path SampleShelf::ready(const std::string& name) {
  const std::lock_guard lock(mutex_);
  std::filesystem::path whole = folder_ / name;
  if (std::filesystem::exists(whole)) return whole;
  const Object sample = make_sample(name);
  if (!std::filesystem::exists(folder_)) std::filesystem::remove_all(folder_.parent_path());
  std::filesystem::path part = whole;
  part += ".part";
  std::filesystem::remove_all(part);
  std::filesystem::create_directories(part);
  write_sample(name, sample, part);
  std::filesystem::rename(part, whole);
  return whole;
}

std::string SampleShelf::place(const std::string& name, const std::filesystem::path& to) {
  try {
    copy_files(ready(name), to);
  } catch (const std::filesystem::filesystem_error&) {
    // The shelf is no place to write to, or another program has just cleared it.
    write_sample(name, make_sample(name), to);
  }
  return name + ".obj";
}

void SampleShelf::fill(const RunContext& context) {
  const RunScope scope(context);
  try {
    for (const SampleInfo& sample : samples()) ready(sample.name);
  } catch (const Cancelled&) {
  } catch (const InputError&) {
  } catch (const std::filesystem::filesystem_error&) {
  }
}

}  // namespace hydrodip
