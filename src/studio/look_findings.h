// What is said of a look: the verdict, findings with what mends them, figures. docs/studio-api.md,
// "A result".
#pragma once

#include <filesystem>
#include <vector>

#include "base/context.h"
#include "report/findings.h"
#include "report/report.h"
#include "studio/json.h"
#include "studio/look.h"

namespace hydrodip {

// As print makes it. In its warnings files in `uploads` are called by their names alone.
Report report_of(const Look& look, const std::filesystem::path& uploads, const RunContext& context);
// The report's, and what it knows nothing of: a blank sheet, pattern film on several dips. Worst
// first.
std::vector<Finding> findings_of(const Look& look, const Report& report);

Json verdict_json(const Report& report, const std::vector<Finding>& list);
// `overlay`: what the page shows of it on the object; "": nothing.
Json finding_json(const Finding& finding, const std::string& overlay, Json mends);
// With overlay, place and mends.
Json findings_json(const Look& look, const std::vector<Finding>& list);
// The numbers of layers to which no film comes.
Json layers_json(const std::vector<DryLayer>& layers);
Json figures_json(const Look& look);

}  // namespace hydrodip
