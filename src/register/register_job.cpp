#include <fmt/format.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "camera/film_picture.h"
#include "camera/film_pose.h"
#include "image/files.h"
#include "image/picture_file.h"
#include "register/arrow_map.h"
#include "register/register.h"
#include "register/tank_file.h"
#include "rig/registration_file.h"
#include "sheet/film_marks.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMapFile = "registration.png";

// A sheet that is laid ink side down is printed mirrored, so that from above it is as it should be.
std::vector<MarkPlace> marks_of(const RigJob& job) {
  const FilmOptions& film = job.config.design.film;
  std::vector<MarkPlace> marks = film_marks(film.width_mm, film.height_mm, film.margin_mm);
  if (marks.empty() || !job.config.print.camera_marks)
    throw InputError(fmt::format(
        "{}: this job's sheet has no marks for the camera: {}", job.folder.string(),
        marks.empty() ? "they need a margin of 6 mm and sides of 120 mm; choose a larger film"
                      : "print it with print.marks=on"));
  return marks;
}

std::filesystem::path camera_file(const RigJob& job, const RegisterRequest& request) {
  std::filesystem::path file = request.camera.empty() ? find_camera(job.folder) : request.camera;
  if (file.empty())
    throw InputError(
        "there is no camera.json, neither here nor in the job's folder: photograph the board on "
        "the tank's rim and run 'hydrodip register --calibrate-camera PHOTOS'");
  return file;
}

Json with_sigma(double value, double sigma) { return {{"value", value}, {"sigma", sigma}}; }

Json json_of(const FilmPose& pose, const RegisterRequest& request,
             const std::vector<std::uint8_t>& photo, const std::filesystem::path& camera) {
  Json marks = Json::array();
  for (const FilmPose::Mark& mark : pose.marks)
    marks.push_back({{"tag", mark.id},
                     {"on_sheet_mm", {mark.on_sheet_mm.x(), mark.on_sheet_mm.y()}},
                     {"unexplained_mm", {mark.unexplained_mm.x(), mark.unexplained_mm.y()}}});
  return {{"schema_version", kRegistrationSchemaVersion},
          {"generator", "hydrodip register"},
          {"photo", {{"path", request.photo.string()}, {"sha256", sha256_hex(photo)}}},
          {"camera", camera.string()},
          {"shift_mm",
           {{"x", pose.shift_mm.x()},
            {"y", pose.shift_mm.y()},
            {"sigma_x", pose.shift_sigma_mm.x()},
            {"sigma_y", pose.shift_sigma_mm.y()}}},
          {"turn_deg", with_sigma(pose.turn_deg, pose.turn_sigma_deg)},
          {"swelling",
           {{"x", pose.swelling.x()},
            {"y", pose.swelling.y()},
            {"sigma_x", pose.swelling_sigma.x()},
            {"sigma_y", pose.swelling_sigma.y()}}},
          {"unexplained_rms_mm", pose.unexplained_rms_mm},
          {"foreign_marks", pose.foreign},
          {"board_marks", pose.board_marks},
          {"board_rms_px", pose.board_rms_px},
          {"marks", marks}};
}

std::string sentence(const FilmPose& pose) {
  return fmt::format(
      "the film lies {:+.2f} +- {:.2f} mm to the right and {:+.2f} +- {:.2f} mm to the top of its "
      "place, turned by {:+.3f} +- {:.3f} degrees counter-clockwise\n"
      "it has swollen by {:+.2f} +- {:.2f} % across (x) and {:+.2f} +- {:.2f} % along (y); {:.3f} "
      "mm are not explained by that ({} marks)\n",
      pose.shift_mm.x(), pose.shift_sigma_mm.x(), pose.shift_mm.y(), pose.shift_sigma_mm.y(),
      pose.turn_deg, pose.turn_sigma_deg, 100 * (pose.swelling.x() - 1),
      100 * pose.swelling_sigma.x(), 100 * (pose.swelling.y() - 1), 100 * pose.swelling_sigma.y(),
      pose.unexplained_rms_mm, pose.marks.size());
}

Image draw_map(const FilmPose& pose, const FilmOptions& film) {
  std::vector<Arrow> arrows;
  for (const FilmPose::Mark& mark : pose.marks)
    arrows.push_back({mark.on_sheet_mm, mark.unexplained_mm});
  return draw_arrow_map(film.width_mm, film.height_mm, film.margin_mm, arrows,
                        "What shift, turn and swelling leave",
                        {fmt::format("off its place by x {:+.2f} mm, y {:+.2f} mm, {:+.2f} degrees",
                                     pose.shift_mm.x(), pose.shift_mm.y(), pose.turn_deg),
                         fmt::format("swollen by x {:+.2f} %, y {:+.2f} %; left {:.3f} mm rms",
                                     100 * (pose.swelling.x() - 1), 100 * (pose.swelling.y() - 1),
                                     pose.unexplained_rms_mm)});
}

// Marks tell a sheet's size only: another job's film of the same size is found as well.
void warn_of_another_film(const RigJob& job, const GrayImage& photo, const std::string& name,
                          const FilmPose& pose, const Tank& tank, const RunContext& context) {
  constexpr double kAlike = 0.3, kSameShape = 0.01;
  const std::filesystem::path file = job.folder / "print.png";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return;
  const FilmOptions& film = job.config.design.film;
  GrayImage gray = gray_of(load_image(file));
  const double shape = film.width_mm / film.height_mm;
  if (std::abs(gray.width_px / (shape * gray.height_px) - 1) > kSameShape) return;
  // It is as it is printed; seen from above, the film shows its back then.
  if (job.config.print.ink_side == InkSide::kDown) gray = mirrored(gray);
  const auto alike = film_likeness(
      photo, pose, tank, {std::move(gray), film.width_mm, film.height_mm, film.margin_mm});
  if (!alike || *alike >= kAlike) return;
  context.warn(fmt::format(
      "{}: the film in it does not look like {}: is it another job's of the same size, or of an "
      "earlier print? Its place holds all the same; do not dip this job's object into another's "
      "film.",
      name, file.string()));
}

// Where this film lies is where film is to lie.
void set_place(Tank tank, const FilmPose& pose, const std::filesystem::path& camera) {
  const double turn = tank.place.turn_deg * std::numbers::pi / 180;
  tank.place.middle_mm += Eigen::Rotation2Dd(turn) * pose.shift_mm;
  tank.place.turn_deg += pose.turn_deg;
  const std::filesystem::path file = std::filesystem::absolute(camera);
  OutputFolder output(file.parent_path());
  output.announce({file.filename().string()}, {});
  write_file(output.path(file.filename().string()), tank_as_json(tank));
  output.commit();
}

}  // namespace

JobResult register_job(const RigJob& job, const RegisterRequest& request,
                       const RunContext& context) {
  const RunScope scope(context.with_threads(job.config.threads));
  FilmSearch search{marks_of(job), request.water_sigma_mm, request.tolerance_mm};
  const std::vector<std::uint8_t> bytes = read_picture(request.photo);
  const std::filesystem::path camera = camera_file(job, request);
  Tank tank = read_tank(camera);
  const double kept_below_mm = tank.water_below_mm;
  if (request.water_below_mm) tank.water_below_mm = *request.water_below_mm;
  search.any_turn = request.set_place;
  OutputFolder output(job.folder, job.config.earlier_result);
  output.announce({kRegistrationFile, kMapFile}, {request.photo, camera});
  context.progress("looking for the film", 0);
  const GrayImage photo = gray_of(decode_image(bytes, request.photo.string()));
  const FilmPose pose = find_film(photo, request.photo.string(), tank, search, context);

  if (!request.set_place)
    warn_of_another_film(job, photo, request.photo.string(), pose, tank, context);

  JobResult result;
  const Json json = json_of(pose, request, bytes, camera);
  result.json = json_text(json);
  result.text = sentence(pose);
  for (const std::string& warning : context.warnings())
    result.text += fmt::format("warning: {}\n", warning);
  if (request.set_place) {
    tank.water_below_mm = kept_below_mm;  // what was said is of this photo
    set_place(tank, pose, camera);
    result.text += fmt::format("{}: this is where film is to lie from now on\n", camera.string());
    return result;
  }
  write_file(output.path(kRegistrationFile), result.json);
  save_png(output.path(kMapFile), draw_map(pose, job.config.design.film));
  context.progress("looking for the film", 1);
  output.commit();
  result.folder = job.folder;
  result.files = {kRegistrationFile, kMapFile};
  result.text += advice({pose.shift_mm, pose.turn_deg, pose.swelling, ""}) + "\n";
  result.text += output.told_replaced();
  result.text +=
      fmt::format("wrote {0}/{1} and {0}/{2}\n", job.folder.string(), kRegistrationFile, kMapFile);
  return result;
}

}  // namespace hydrodip
