// What 'hydrodip register' found out about the film that lies on the water: JOB/registration.json.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/math.h"

namespace hydrodip {

struct Registration {
  Vec2 shift_mm = Vec2::Zero();  // of the film off its place: to its right, to its top
  double turn_deg = 0;           // counter-clockwise from above
  Vec2 swelling = Vec2::Ones();
  std::string photo_sha256;
};

inline constexpr const char* kRegistrationFile = "registration.json";

inline constexpr int kRegistrationSchemaVersion = 1;

// Nothing if the file is none. Throws InputError if a newer hydrodip wrote it.
std::optional<Registration> read_registration(const std::filesystem::path& file);

// "Move the frame by 1.40 mm to the left and 2.20 mm to the top, and turn it by 0.70 degrees
// clockwise."
std::string advice(const Registration& registration);

// Where a camera's calibration is looked for: in the job's folder, then in the current one. Empty:
// there is none.
std::filesystem::path find_camera(const std::filesystem::path& job_folder);

}  // namespace hydrodip
