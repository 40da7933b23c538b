// Several dips together, to be looked at while somebody works: what `hydrodip print` makes of them,
// computed without writing anything.
#pragma once

#include <vector>

#include "base/context.h"
#include "image/image.h"
#include "job/prepare.h"
#include "job/wanted.h"
#include "object/object.h"
#include "report/report.h"
#include "settings/config.h"

namespace hydrodip {

struct DipsTogether {
  Report report;              // on all dips together, as print_dips() writes it
  Object colors, parts;       // the model as it looks in the end, and in a colour for each dip
  std::vector<Image> sheets;  // as they are printed, in the order of the dips
  std::vector<LinearColor> color_of;  // those colours, in the order of the dips
  std::vector<DryLayer> dry;          // layers of artwork to which none of the dips brings film
};

// Whether nothing has to be searched for it: every dip of `config` is given.
bool all_dips_are_given(const JobConfig& config);

// `config`: with its dips given. `texture_px`: of the painted models. Throws as print_dips().
DipsTogether put_together(const JobConfig& config, const PreparedObject& prepared, int texture_px,
                          const RunContext& context);

}  // namespace hydrodip
