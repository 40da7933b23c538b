// The start of every job: the object, loaded and hung over the bath, and what is wanted on it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "artwork/artwork.h"
#include "base/context.h"
#include "object/paint.h"
#include "object/posed_object.h"
#include "settings/config.h"

namespace hydrodip {

struct PreparedObject {
  PosedObject posed;
  std::shared_ptr<const Paint> paint;
  MeshHealth health;                          // in posed size
  std::string units;                          // the unit that was applied
  std::vector<std::filesystem::path> files;   // every file that was read
  std::vector<LaidLayer> artwork;             // as it was laid, the bottom layer first
  std::vector<std::string> picture_problems;  // why some of the model's pictures are not shown
};

// Loads a model, or takes the one that is given, and poses it. Health findings become warnings.
// Pictures of artwork are read first. `dpi`, `samples_per_axis`: of what is printed, to which
// drawings are matched; as by DesignOptions and InverseOptions.
PreparedObject prepare_object(const std::filesystem::path& model, const ObjectOptions& options,
                              const RunContext& context, double dpi = 300,
                              int samples_per_axis = 3);

// To hold the object otherwise: in the configuration, whose artwork stays where it was laid.
void hold(ObjectOptions& options, const PreparedObject& prepared, const PoseOptions& pose);

// The largest extents of what people dip.
inline constexpr double kTiny_mm = 5, kHuge_mm = 1000;

// Throws InputError that asks for --units or --size if neither is given and the object is smaller
// or larger than anything that people dip.
void require_size(const PosedObject& posed, const ObjectOptions& options,
                  const std::filesystem::path& model);

// Throws InputError saying what is missing, and how to mend it, if the model does not say which
// colour goes where. picture_problems: as PreparedObject's.
void require_appearance(const Object& object, const std::vector<std::string>& picture_problems,
                        const std::filesystem::path& model);

// The same for an object that may have artwork, which is an appearance.
void require_appearance(const PreparedObject& prepared, const std::filesystem::path& model);

// Throws InputError for artwork that is laid on film and lies beside the sheet.
void require_on_film(const PreparedObject& prepared, const FilmOptions& film);

// At most so much of a sheet is inked: film on the object is no larger than what it lies on, and
// the bleed goes round it. Artwork that is laid on the film may go anywhere.
double inkable_mm2(const PreparedObject& prepared, const DesignOptions& options);
// A draft shows what becomes of the object; its sheet is not to be dipped through.
void warn_if_draft(const DesignOptions& options, const RunContext& context);
// What a sheet takes while it is designed and written, about: blank film takes none.
double sheet_memory_bytes(const DesignOptions& options, double inked_mm2);
// Throws InputError if the sheet's pictures cannot fit the memory that there is, or the whole
// sheet, blank or not, the process's own limits.
void require_memory(const DesignOptions& options, double inked_mm2);

}  // namespace hydrodip
