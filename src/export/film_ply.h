// film.ply: the film after the dip.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "film/film.h"

namespace hydrodip {

// Binary little-endian; x y z u v state area_ratio stretch. Throws DipError for a film that has no
// finite place.
std::vector<std::uint8_t> film_ply(const DippedFilm& film);
void write_film_ply(const std::filesystem::path& path, const DippedFilm& film);

}  // namespace hydrodip
