// film.ply: the film after the dip.
#pragma once

#include <filesystem>

#include "film/film.h"

namespace hydrodip {

// Binary little-endian; x y z u v state area_ratio stretch.
void write_film_ply(const std::filesystem::path& path, const DippedFilm& film);

}  // namespace hydrodip
