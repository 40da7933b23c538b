#include "export/film_ply.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "export/bytes.h"

namespace hydrodip {
namespace {

std::string ply_header(const DippedFilm& film) {
  return fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment hydrodip: the film after the dip, lengths in mm\n"
      "element vertex {}\n"
      "property float x\n"
      "property float y\n"
      "property float z\n"
      "property float u\n"
      "property float v\n"
      "property uchar state\n"
      "property float area_ratio\n"
      "property float stretch\n"
      "element face {}\n"
      "property list uchar int vertex_indices\n"
      "end_header\n",
      film.position.size(), film.mesh().triangles.size());
}

// A reader of the file should never have to ask whether a number is one.
float finite(double value, std::size_t vertex) {
  const auto single = static_cast<float>(value);
  if (!std::isfinite(single)) {
    throw DipError(fmt::format(
        "The dip left film vertex {} without a finite position or stretch; please report this, "
        "and try a smaller dip.step_mm meanwhile.",
        vertex));
  }
  return single;
}

void add_vertex(Bytes& out, const DippedFilm& film, std::size_t v) {
  for (int k = 0; k < 3; ++k) out.add_f32(finite(film.position[v][k], v));
  for (int k = 0; k < 2; ++k) out.add_f32(finite(film.mesh().u[v][k], v));
  out.add_u8(static_cast<std::uint8_t>(film.state[v]));
  out.add_f32(finite(film.area_ratio[v], v));
  out.add_f32(finite(film.stretch[v], v));
}

}  // namespace

std::vector<std::uint8_t> film_ply(const DippedFilm& film) {
  Bytes out;
  out.add(ply_header(film));
  for (std::size_t v = 0; v < film.position.size(); ++v) add_vertex(out, film, v);
  for (const Triangle& triangle : film.mesh().triangles) {
    out.add_u8(3);
    for (const std::int32_t v : triangle) out.add_u32(static_cast<std::uint32_t>(v));
  }
  return out.data();
}

void write_film_ply(const std::filesystem::path& path, const DippedFilm& film) {
  const std::vector<std::uint8_t> bytes = film_ply(film);
  write_file(path, bytes.data(), bytes.size());
}

}  // namespace hydrodip
