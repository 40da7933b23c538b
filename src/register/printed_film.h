// A finished job's film, read back: what its print took every point of the object for.
#pragma once

#include <memory>

#include "base/context.h"
#include "object/posed_object.h"
#include "rig/rig_job.h"
#include "transfer/film_map.h"

namespace hydrodip {

struct PrintedFilm {
  PosedObject posed;
  std::shared_ptr<const DippedFilm> film;
  std::shared_ptr<const FilmMap> map;  // refers to both
  // That the job was printed with; null: none.
  std::shared_ptr<const FilmCorrection> correction;

  // Where the film model alone takes a place of the sheet for.
  Vec2 to_model(const Vec2& printed) const;
};

// From film.ply and the model. Throws InputError if either is missing or of another job.
PrintedFilm read_printed_film(const RigJob& job, const RunContext& context);

}  // namespace hydrodip
