// What is said of a sheet that several parts share: which part on which piece, and how to dip it.
#pragma once

#include <string>

#include "base/context.h"
#include "image/image.h"
#include "job/nest.h"
#include "settings/config.h"

namespace hydrodip {

// nest.html, for the wet bench. It shows print.png, and part-1.png and so on of the parts.
std::string nest_run_sheet(const Nest& nest, const JobConfig& sheet);

// nest.json: the same for programs.
std::string nest_json(const Nest& nest, const JobConfig& sheet, const RunContext& context);

// A part wanted and predicted, upright as people know it, whatever side it is dipped with.
Image as_it_stands(const NestPart& part, const MadePart& made, int width_px,
                   const RunContext& context);

}  // namespace hydrodip
