#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "calibrate/calibrate.h"
#include "calibrate/measured_dip.h"
#include "calibrate/subject.h"

namespace hydrodip {

JobResult pack_job(const JobConfig& config, const CalibrationRequest& request,
                   const RunContext& context) {
  const RunScope scope(context.with_threads(config.threads));
  if (request.scans.size() != 1 || is_measured_dip(request.scans.front()))
    throw InputError(
        "calibrate pack: an archive holds one dip; name its shape and its scan, as in "
        "'hydrodip calibrate pack sphere=scan.obj'");
  require_facts(request.facts);
  // Reads the scan as a calibration does, and refuses what none could be made of.
  const ScanSetup setup = scan_setup(config, request);
  const Subject subject =
      std::move(load_subjects(request.scans, setup.settings, setup.config, context).front());

  MeasuredDip dip;
  dip.object = subject.object.name;
  if (!subject.object.is_known_shape)
    throw InputError(fmt::format(
        "calibrate pack: {}: only dips of the shapes that calibrations know by name are packed, "
        "which everybody has; if it is one of them, name it without its file, as in "
        "sphere-90@17=SCAN",
        request.scans.front()));
  dip.depth_mm = subject.object.depth_mm;
  dip.board = setup.settings.board;
  dip.film = config.design.film;
  dip.facts = request.facts;
  dip.scan = subject.scan;
  dip.scan_file = "scan" + subject.file.extension().string();
  dip.source = read_file(subject.file);

  OutputFolder folder(config.output, config.earlier_result);
  const std::string name = dip.object + "-dip.zip";
  folder.announce({name}, {subject.file});
  write_measured_dip(folder.path(name), dip);
  read_measured_dip(folder.path(name));  // as everybody will
  context.check_cancelled();
  folder.commit();

  JobResult result;
  result.folder = config.output;
  result.files = {name};
  const std::size_t corners = dip.scan.grid.position.size();
  result.text = folder.told_replaced();
  result.text += fmt::format("wrote {}: a {} dipped {:g} mm, {} corners, {}\n",
                             (config.output / name).string(), dip.object, dip.depth_mm, corners,
                             dip.facts.licence);
  for (const std::string& warning : context.warnings())
    result.text += fmt::format("warning: {}\n", warning);
  result.json = json_answer("calibrate pack", {{"folder", config.output.string()},
                                               {"files", result.files},
                                               {"corners", corners},
                                               {"warnings", context.warnings()}});
  return result;
}

}  // namespace hydrodip
