// What the report says of several dips.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "coat/design.h"
#include "coat/dipped_object.h"
#include "job/finish_check.h"
#include "job/job_record.h"
#include "job/made_dips.h"
#include "plan/seams.h"
#include "report/report.h"

namespace hydrodip {

// On all dips together; `record` is of the first.
Report report_on(const MadeDips& all, const SharedSurface& shared, const FinishCheck& check,
                 const JobRecord& record);

// Why a dip, the `number`th `of` several, is not to be made, whatever the others bring, or else
// what air it traps. `ink`: null without.
std::optional<ReportObstacle> obstacle_of(const DippedObject& dipped, const InkResult* ink,
                                          double tear_stretch, std::size_t number, std::size_t of);

// Of the films of all together: what meets the object of them, tears, wrinkles, was lifted and how
// far it stretches; nothing of the surface that they cover.
Coverage films_together(const std::vector<const DippedObject*>& dips);

// Every file, dip by dip: "dip-1/print.pdf".
std::vector<std::string> file_names(const MadeDips& all);

}  // namespace hydrodip
