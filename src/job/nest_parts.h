// Parts that share a sheet, and the dip of each on its own piece of film.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "ink/printer.h"
#include "job/computed.h"
#include "job/jobs.h"
#include "plan/fit.h"
#include "report/findings.h"
#include "report/report.h"
#include "settings/config.h"

namespace hydrodip {

struct NestPart {
  ReadyJob job;  // its film is the sheet's until it gets a piece of its own
  Room room;     // that its wet part takes
  int count = 1;
  std::filesystem::path file;  // its job's, or the model's

  std::string name() const { return file.filename().string(); }
  const FilmOptions& film() const { return job.config.design.film; }
};

// Loads and poses the part, and looks for what its job leaves to be found. Throws InputError for a
// job that cannot share a sheet: of several dips, with a correction, or that says what only the
// whole sheet can.
NestPart prepare_part(const NestRequest::Part& wanted, const JobConfig& sheet,
                      const Printer& printer, const RunContext& context);

// What is printed for a part, and what is to be said of its dip.
struct MadePart {
  DesignedJob made;
  Report report;

  const Coverage& coverage() const { return *report.coverage; }
  Concern concern() const { return concern_of(findings(report)); }
  bool is_not_to_be_dipped() const { return concern() == Concern::kStop; }
  std::string verdict() const { return headline(concern()) + ". " + verdict_of(report); }
};

// One after the other; warns of those that are not to be dipped like this. Throws as designed().
std::vector<MadePart> make_parts(const std::vector<NestPart>& parts, const RunContext& context);

}  // namespace hydrodip
