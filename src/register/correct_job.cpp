#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "base/shell_word.h"
#include "image/files.h"
#include "job/correction_fit.h"
#include "register/correction_output.h"
#include "register/displacement_fit.h"
#include "register/printed_film.h"
#include "register/register.h"
#include "register/seen_dip.h"
#include "register/seen_places.h"
#include "settings/settings.h"

namespace hydrodip {
namespace {

constexpr const char* kStem = "correction";

// Beyond its places a correction goes on as it was.
void require_moderate(const DisplacementFit& fit) {
  if (fit.field.farthest_mm() > kFarthestCorrection_mm)
    throw InputError(fmt::format(
        "the places that were seen ask for the print to be moved by {:.0f} mm somewhere, which is "
        "no correction: check that they are of this print and its object, in mm",
        fit.field.farthest_mm()));
}

// What its files are called: a correction that this print was made with stays, as the film is
// where that one put it.
std::string free_stem(const RigJob& job) {
  std::error_code ignored;
  const auto is_used = [&](const std::string& stem) {
    return std::filesystem::equivalent(job.folder / (stem + ".json"), job.config.correction,
                                       ignored);
  };
  std::string stem = kStem;
  for (int number = 2; is_used(stem); ++number) stem = fmt::format("{}-{}", kStem, number);
  return stem;
}

// The file with a table for each of several dips, where paths are relative to it. Empty: there is
// none any more.
std::filesystem::path job_file_of(const RigJob& job) {
  std::filesystem::path found;
  for (const std::filesystem::path& file : job.settings_files) try {
      const std::vector<Setting> settings = read_settings(file);
      if (std::ranges::any_of(settings,
                              [](const Setting& s) { return s.name.starts_with("dip["); }))
        found = file;
    } catch (const InputError&) {
      // Gone, or something else by now.
    }
  return found;
}

std::string how_to_print(const RigJob& job, const std::string& file) {
  const std::filesystem::path path = job.folder / file;
  if (job.earlier_dips == 0 && job.next_dip == 0)
    return "--correction " + shell_word(path.string());
  const std::filesystem::path job_file = job_file_of(job);
  if (job_file.empty())
    return fmt::format("correction = \"{}\" in this dip's [[dip]] table of the job file",
                       std::filesystem::absolute(path).lexically_normal().string());
  const std::filesystem::path folder = std::filesystem::absolute(job_file).parent_path();
  return fmt::format("correction = \"{}\" in the [[dip]] table {} of {}",
                     std::filesystem::proximate(path, folder).string(), job.earlier_dips + 1,
                     job_file.string());
}

// Places are looked up on the model as it is now.
void warn_of_change(const RigJob& job, const CorrectedDip& of, const RunContext& context) {
  if (of.model_sha256.empty() || job.model_sha256.empty() || of.model_sha256 == job.model_sha256)
    return;
  context.warn(fmt::format(
      "{} has changed since it was printed: if its shape has, print it again first.", of.model));
}

// What the dips said, and earlier ones, which counts as much.
std::vector<CorrectionSample> samples_of(const std::vector<SeenDip>& dips, const PrintedFilm& film,
                                         const RigJob& job) {
  std::vector<CorrectionSample> samples;
  for (const SeenDip& dip : dips)
    samples.insert(samples.end(), dip.samples.begin(), dip.samples.end());
  if (film.correction)
    for (const CorrectionSample& s : read_correction(job.config.correction).samples)
      samples.push_back(s);
  return samples;
}

std::string told(const std::vector<SeenDip>& dips, const SeenMisfit& misfit,
                 const DisplacementFit& fit, const CorrectRequest& request) {
  std::string text = fmt::format(
      "{}, {:.0f} places: off by {:.3f} mm rms on the sheet, {:.3f} mm on the object\n"
      "corrected, places that were left out are foretold to {:.3f} mm, of which {:.3f} mm are "
      "noise; it changes over {:g} mm\n",
      dips.size() == 1 ? "1 dip" : fmt::format("{} dips", dips.size()), misfit.places,
      misfit.on_sheet_mm, misfit.on_object_mm, fit.left_out_rms_mm,
      // Both are estimates; of what is left, no more than all of it.
      std::min(fit.left_out_rms_mm, std::sqrt(2.0) * fit.noise_mm), fit.smooth_mm);
  if (dips.size() > 1)
    text += fmt::format(
        "from dip to dip the film lay {:.3f} mm elsewhere: no correction takes that out\n",
        between_dips_mm(dips));
  for (const SeenDip& dip : dips)
    if (!dip.board.empty() && request.board.empty())
      text += fmt::format("{}: taken for the {} board\n", dip.file.string(), dip.board);
  return text;
}

}  // namespace

JobResult correct_job(const RigJob& job, const CorrectRequest& request, const RunContext& context) {
  const RunScope scope(context.with_threads(job.config.threads));
  const std::string stem = free_stem(job), file = stem + ".json", picture = stem + ".png";
  OutputFolder output(job.folder, job.config.earlier_result);
  std::vector<std::filesystem::path> inputs = request.scans;
  if (!job.config.correction.empty()) inputs.push_back(job.config.correction);
  output.announce({file, picture}, inputs);
  context.progress("reading the dips", 0);
  const PrintedFilm film = read_printed_film(job, context);
  require_correction_fits(job.config, film.posed, job.depth_mm);
  const CorrectedDip of = corrected_dip(job.config, film.posed, job.depth_mm);
  warn_of_change(job, of, context);
  const FilmOptions& sheet = job.config.design.film;
  std::vector<SeenDip> dips;
  for (const std::filesystem::path& scan : request.scans)
    dips.push_back(
        seen_dip(scan, read_seen_places(scan, film, sheet, request, context), film, context));
  require_different(dips);
  const SeenMisfit misfit = misfit_of(dips);
  const std::vector<CorrectionSample> samples = samples_of(dips, film, job);

  context.progress("fitting the correction", 0.3);
  const Vec2 half = 0.5 * Vec2(sheet.width_mm, sheet.height_mm);
  const DisplacementFit fit = fit_displacements(samples, {-half, half});
  require_moderate(fit);

  JobResult result;
  result.json = correction_json(of, dips, samples, fit);
  write_file(output.path(file), result.json);
  save_png(output.path(picture), draw_field(fit, sheet, misfit.on_sheet_mm));
  context.progress("fitting the correction", 1);
  output.commit();
  result.folder = job.folder;
  result.files = {file, picture};
  result.text = told(dips, misfit, fit, request);
  for (const std::string& warning : context.warnings())
    result.text += fmt::format("warning: {}\n", warning);
  result.text += output.told_replaced();
  result.text += fmt::format("wrote {0}/{1} and {0}/{2}\nprint again with {3}\n",
                             job.folder.string(), file, picture, how_to_print(job, file));
  return result;
}

}  // namespace hydrodip
