#include "register/printed_film.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "base/small_file.h"
#include "dip/dip.h"
#include "job/prepare.h"
#include "settings/correction_file.h"

namespace hydrodip {
namespace {

constexpr int kInversions = 60;

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw InputError(fmt::format(
      "{}: does not belong to the report.json beside it; print the job again", file.string()));
}

// Little-endian values one after another.
class Cursor {
 public:
  Cursor(const std::vector<std::uint8_t>& bytes, std::size_t at, const std::filesystem::path& file)
      : bytes_(bytes), at_(at), file_(file) {}

  template <class Value>
  Value next() {
    Value value;
    if (bytes_.size() < at_ + sizeof value) refuse(file_);
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  double number() {
    const auto value = double(next<float>());
    if (!std::isfinite(value)) refuse(file_);
    return value;
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_;
  const std::filesystem::path& file_;
};

std::size_t behind_header(const std::vector<std::uint8_t>& bytes, const FilmMesh& mesh,
                          const std::filesystem::path& file) {
  const std::string start(
      bytes.begin(), bytes.begin() + std::ptrdiff_t(std::min<std::size_t>(bytes.size(), 1000)));
  const std::string end = "end_header\n";
  const std::size_t at = start.find(end);
  const bool ours =
      at != std::string::npos && start.find("comment hydrodip") != std::string::npos &&
      start.find(fmt::format("element vertex {}\n", mesh.u.size())) != std::string::npos;
  if (!ours) refuse(file);
  return at + end.size();
}

// What the file does not say follows from what it says.
void mark_torn(DippedFilm& film, double tear_stretch) {
  film.torn.assign(film.mesh().triangles.size(), 0);
  if (!(tear_stretch > 0)) return;
  for (std::size_t t = 0; t < film.torn.size(); ++t)
    for (const std::int32_t v : film.mesh().triangles[t])
      if (film.stretch[std::size_t(v)] > tear_stretch) film.torn[t] = 1;
}

DippedFilm read_film(const std::filesystem::path& file, const FilmOptions& options,
                     const FilmMaterial& material) {
  DippedFilm film;
  film.z_stretch = material.z_stretch;
  film.shared_mesh = std::make_shared<const FilmMesh>(make_film_mesh(options));
  const FilmMesh& mesh = film.mesh();
  constexpr std::size_t kHeader = 4096, kPerVertex = 64, kPerTriangle = 32;  // and more than that
  const std::vector<std::uint8_t> bytes = read_small_file(
      file, kHeader + kPerVertex * mesh.u.size() + kPerTriangle * mesh.triangles.size(),
      "this job's film");
  Cursor cursor(bytes, behind_header(bytes, mesh, file), file);
  constexpr double kSame_mm = 1e-3;
  for (const Vec2& u : mesh.u) {
    const double x = cursor.number(), y = cursor.number(), z = cursor.number();
    film.position.emplace_back(x, y, z);
    const double ux = cursor.number(), uy = cursor.number();
    if (!((Vec2(ux, uy) - u).norm() < kSame_mm)) refuse(file);
    const auto state = cursor.next<std::uint8_t>();
    if (state > 2) refuse(file);
    film.state.push_back(VertexState(state));
    film.area_ratio.push_back(cursor.number());
    film.stretch.push_back(cursor.number());
  }
  mark_torn(film, material.tear_stretch);
  return film;
}

}  // namespace

Vec2 PrintedFilm::to_model(const Vec2& printed) const {
  if (!correction) return printed;
  Vec2 model = printed;
  for (int i = 0; i < kInversions; ++i) {
    const Vec2 off = model + correction->at(model) - printed;
    model -= off;
    if (off.norm() < 1e-9) break;
  }
  return model;
}

namespace {

// The film is where that very file put it.
std::shared_ptr<const FilmCorrection> correction_of(const RigJob& job) {
  const std::filesystem::path& file = job.config.correction;
  if (file.empty()) return nullptr;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw InputError(fmt::format(
        "{}: this job was printed with this correction, and it is not there any more; put it back, "
        "or say where it is now with --set film.correction=FILE",
        file.string()));
  auto field = read_correction_field(file);
  if (!job.correction_sha256.empty() && sha256_hex(read_file(file)) != job.correction_sha256)
    throw InputError(
        fmt::format("{}: this correction has changed since the job in {} was printed with it; put "
                    "the earlier one back, or print the job again",
                    file.string(), job.folder.string()));
  return field;
}

}  // namespace

PrintedFilm read_printed_film(const RigJob& job, const RunContext& context) {
  FilmOptions film = job.config.design.film;
  film.correction = correction_of(job);
  // The object alone: what it looks like does not matter here.
  ObjectOptions object = job.config.object;
  object.artwork.clear();
  object.load.texture.clear();
  require_model(job);
  const PreparedObject prepared = prepare_object(job.config.model, object, context.quiet());
  auto dipped = std::make_shared<const DippedFilm>(
      read_film(job.folder / "film.ply", film, job.config.design.dip.material));
  auto map =
      std::make_shared<const FilmMap>(prepared.posed.mesh(), prepared.posed.surface(), *dipped);
  return {prepared.posed, std::move(dipped), std::move(map), film.correction};
}

}  // namespace hydrodip
