#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "image/files.h"
#include "register/register.h"
#include "register/tank_file.h"

namespace hydrodip {
namespace {

// Photos are large: one at a time.
std::vector<SeenPhoto> read_photos(const std::vector<std::filesystem::path>& files, int& width_px,
                                   int& height_px, const RunContext& context) {
  std::vector<SeenPhoto> photos;
  for (std::size_t i = 0; i < files.size(); ++i) {
    context.progress("looking for marks", double(i) / double(files.size()));
    const GrayImage gray = gray_of(load_image(files[i]));
    if (i == 0) {
      width_px = gray.width_px;
      height_px = gray.height_px;
    }
    if (gray.width_px != width_px || gray.height_px != height_px)
      throw InputError(fmt::format(
          "{}: has {} x {} px and the first photo {} x {}; take all of them with one camera, held "
          "the same way up",
          files[i].string(), gray.width_px, gray.height_px, width_px, height_px));
    photos.push_back({files[i].string(), find_marks(gray, context)});
  }
  return photos;
}

// That the file holds which is to be replaced, if there is one.
std::optional<Tank> earlier_tank(const std::filesystem::path& file) try {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  return read_tank(file);
} catch (const InputError&) {
  throw InputError(fmt::format(
      "{}: would be replaced, and is no camera's calibration that this program can read; name "
      "another file with -o, or remove it",
      file.string()));
}

// What it says beside the lens holds on.
void keep_earlier(const Tank& earlier, Tank& tank, const RunContext& context) {
  if (!keep_what_was_said(earlier, tank))
    context.warn(
        "the strips lie otherwise than before: the film's place is their middle again; set it anew "
        "with 'hydrodip register PHOTO JOB_DIR --set-place'.");
}

}  // namespace

JobResult calibrate_camera_job(const CameraRequest& request, const RunContext& context) {
  const RunScope scope(context);
  const std::filesystem::path file = std::filesystem::absolute(request.file);
  OutputFolder output(file.parent_path());
  output.announce({file.filename().string()}, request.photos);
  const std::optional<Tank> earlier = earlier_tank(file);
  int width_px = 0, height_px = 0;
  const std::vector<SeenPhoto> photos = read_photos(request.photos, width_px, height_px, context);
  Tank tank = calibrate_tank(photos, width_px, height_px, context);
  if (earlier) keep_earlier(*earlier, tank, context);
  if (request.water_below_mm) tank.water_below_mm = *request.water_below_mm;
  write_file(output.path(file.filename().string()), tank_as_json(tank));
  context.check_cancelled();
  output.commit();

  JobResult result;
  result.folder = file.parent_path();
  result.files = {file.filename().string()};
  const double focal_sigma = std::sqrt(tank.lens_covariance(0, 0));
  result.text = fmt::format(
      "{} photos, {} marks of the rim; corners fit to {:.3f} px\n"
      "focal length {:.1f} +- {:.1f} px, distortion k1 {:+.4f}, k2 {:+.4f}\n"
      "the water stands {:g} mm below the strips{}\nwrote {}\n",
      photos.size(), tank.corner_mm.size(), tank.rms_px, tank.lens.focal_px, focal_sigma,
      tank.lens.k1, tank.lens.k2, tank.water_below_mm,
      request.water_below_mm     ? ""
      : tank.water_below_mm != 0 ? ", as the earlier file says"
                                 : " (--water-below says how far)",
      request.file.string());
  result.text += output.told_replaced();
  for (const std::string& warning : context.warnings()) result.text += "warning: " + warning + "\n";
  result.json = json_answer("register --calibrate-camera", {{"file", request.file.string()},
                                                            {"photos", photos.size()},
                                                            {"board_marks", tank.corner_mm.size()},
                                                            {"rms_px", tank.rms_px},
                                                            {"focal_px", tank.lens.focal_px},
                                                            {"focal_sigma_px", focal_sigma},
                                                            {"water_below_mm", tank.water_below_mm},
                                                            {"warnings", context.warnings()}});
  return result;
}

}  // namespace hydrodip
