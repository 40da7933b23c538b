#include "job/record.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace hydrodip {
namespace {

using json = nlohmann::ordered_json;

struct OutputFile {
  const char* name;
  const char* what;
};

constexpr OutputFile kPrintFiles[] = {
    {"print.pdf", "the sheet: print it at 100 % (no scaling), ink side up"},
    {"print.png", "the film image, sRGB"},
    {"print.tif", "the film image, CMYK"},
};
constexpr OutputFile kCommonFiles[] = {
    {"preview.png", "what was asked for beside what will come out"},
    {"preview.glb", "the dipped object in 3D"},
    {"film.ply", "the film after the dip"},
    {"report.html", "everything about this job, for people"},
    {"report.json", "the same for programs"},
};

std::vector<OutputFile> output_files(const std::string& command) {
  std::vector<OutputFile> files;
  if (command == "print") files.assign(std::begin(kPrintFiles), std::end(kPrintFiles));
  files.insert(files.end(), std::begin(kCommonFiles), std::end(kCommonFiles));
  return files;
}

std::string percent(double share) {
  const double value = 100 * share;
  if (value > 0 && value < 0.1) return "under 0.1 %";
  return value < 10 ? fmt::format("{:.1f} %", value) : fmt::format("{:.0f} %", value);
}

json figures_json(const DipFigures& f) {
  return {{"object_mm2", f.object_mm2},
          {"covered_mm2", f.covered_mm2},
          {"covered_share", f.covered_share()},
          {"downward_mm2", f.downward_mm2},
          {"covered_downward_share", f.covered_downward_share()},
          {"film_on_object_mm2", f.film_on_object_mm2},
          {"torn_mm2", f.torn_mm2},
          {"torn_share", f.torn_share()},
          {"largest_stretch", f.largest_stretch},
          {"mean_area_ratio", f.mean_area_ratio}};
}

}  // namespace

std::string verdict(const DipFigures& f) {
  std::string sentence = fmt::format(
      "Covers {} of the surface that faces down ({} of all); the film stretches up to {:.2f} times",
      percent(f.covered_downward_share()), percent(f.covered_share()), f.largest_stretch);
  if (f.torn_mm2 > 0)
    return sentence +
           fmt::format(" and tears: {} of what meets the object is lost.", percent(f.torn_share()));
  return sentence + " and does not tear.";
}

JobResult describe_result(const JobRecord& record, const OutputFolder& folder) {
  JobResult result;
  result.folder = folder.folder();
  const std::vector<std::string> warnings = record.context.warnings();

  result.text = fmt::format("wrote to {}:\n", folder.folder().string());
  for (const OutputFile& file : output_files(record.command)) {
    result.files.emplace_back(file.name);
    result.text += fmt::format("  {:<12} {}\n", file.name, file.what);
  }
  for (const std::string& warning : warnings) result.text += "warning: " + warning + "\n";
  result.text += verdict(record.dipped.figures) + "\n";

  json machine = {{"command", record.command},
                  {"folder", folder.folder().string()},
                  {"files", result.files},
                  {"verdict", verdict(record.dipped.figures)},
                  {"depth_mm", record.dipped.film().depth_mm},
                  {"figures", figures_json(record.dipped.figures)},
                  {"warnings", warnings},
                  {"seconds", record.times.total_s()},
                  {"peak_memory_bytes", peak_memory_bytes()}};
  result.json = machine.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
  return result;
}

}  // namespace hydrodip
