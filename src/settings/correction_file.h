// The field of displacements that 'hydrodip correct' wrote.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "film/correction.h"

namespace hydrodip {

// Rises when a reader of older files would be wrong about newer ones.
inline constexpr int kCorrectionSchemaVersion = 1;

// What one corner of a dip said: what the film model takes for `model_mm` on the sheet was printed
// `move_mm` from there.
struct CorrectionSample {
  Vec2 model_mm = Vec2::Zero(), move_mm = Vec2::Zero();
};

// No correction moves anything farther.
inline constexpr double kFarthestCorrection_mm = 50;

// Of which dip a correction is. It holds for no other: another shape, pose, depth or film goes
// wrong elsewhere.
struct CorrectedDip {
  std::string model;         // its path, for people
  std::string model_sha256;  // of that file
  std::string shape_sha256;  // of vertices and triangles, which new colours leave as they are
  Mat3 to_posed = Mat3::Identity();  // from the model's coordinates: turn and size
  Vec3 size_mm = Vec3::Zero();       // of the posed object, whatever unit its file was read in
  double depth_mm = 0;               // of the deepest point
  Vec2 film_mm = Vec2::Zero();
  double margin_mm = 0;
  Vec2 swelling = Vec2::Ones();
  // What the film was taken for: the correction is the rest.
  double z_stretch = 0, poisson = 0, ink_stiffness_ratio = 1;
  std::string way;  // into the water, and onto the object, in words; empty: not known
};

struct CorrectionFile {
  CorrectedDip of;
  FilmCorrection field;
  std::vector<CorrectionSample> samples;  // that it was fitted to
};

// Throws InputError, naming the file, for what is none, and if a newer hydrodip wrote it.
CorrectionFile read_correction(const std::filesystem::path& file);
// What film takes of it. Throws as read_correction() does.
std::shared_ptr<const FilmCorrection> read_correction_field(const std::filesystem::path& file);

}  // namespace hydrodip
