// Everything a job needs to know, one struct per stage. Filled from parameter records
// (job/params.h) or by hand.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dip/dip.h"
#include "film/film.h"
#include "object/load.h"
#include "object/pose.h"

namespace hydrodip {

struct ObjectOptions {
  LoadOptions load;                    // units, texture
  PoseOptions pose;                    // size, down, rotation
  std::string base_color = "#ffffff";  // of the bare object, sRGB
};

// The tank of the paper's appendix A.
struct BathOptions {
  double width_mm = 370;
  double height_mm = 270;
  double depth_mm = 150;
};

// Recorded for the ink model; the simulation does not read them yet.
struct InkOptions {
  double stiffness_ratio = 600;  // modulus of fully inked over blank film
  int rounds_max = 10;           // simulate, invert, stiffen, repeat: at most this often
};

enum class InkSide { kUp, kDown };

struct PrintOptions {
  double dpi = 300;
  double bleed_mm = 1;
  int samples = 3;  // per axis and pixel
  InkSide ink_side = InkSide::kUp;
  std::string job_name;  // in the sheet's margin; empty: the model's file name
};

struct JobConfig {
  std::filesystem::path model;
  std::filesystem::path film_image;  // simulate: the image that was printed; may be empty
  std::filesystem::path output;      // folder
  // For the report only.
  std::vector<std::filesystem::path> settings_files;  // profiles and configs that were read
  std::vector<std::string> command_line;

  ObjectOptions object;
  FilmOptions film;
  BathOptions bath;
  DipOptions dip;  // with the film's material
  InkOptions ink;
  PrintOptions print;
  int preview_width_px = 1600;
  int threads = 0;  // 0: all cores
};

}  // namespace hydrodip
