// The verdict in parts: what is fine, what is not, and what to do about it.
#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace hydrodip {

enum class Concern { kNone, kCare, kStop };

struct Finding {
  std::string key;  // "tears"; in report.json
  Concern concern = Concern::kNone;
  std::string title;   // "Tears"
  std::string figure;  // "2.1 %"; may be empty
  std::string text;    // what it means, one sentence
  std::string advice;  // what to do; empty when nothing needs doing
};

// Coverage, tears, stretch, steep sides, registration, ink, colours, then the job's warnings, as
// far as the report knows about them.
std::vector<Finding> findings(const Report& report);

// Whether one dip more may help: a job may have it, and none of those that there are is for nothing
// or hardly worth its film.
bool more_dips_may_help(const Report& report);

// What helps where the best single dip that was found is not good enough; empty: whether it is the
// best one is not known.
std::string beyond_best_dip(const Report& report);

// Of findings, the first that is a reason not to dip besides what becomes of the film (tears,
// stretch, coverage); null: there is none.
const Finding* first_obstacle(const std::vector<Finding>& findings);

// The gravest of all; kStop when the dip should not be done like this.
Concern concern_of(const std::vector<Finding>& findings);

// "Good to dip", "Can be dipped; mind a few things", "Do not dip it like this".
std::string headline(Concern concern);

// What somebody who ordered the piece has to know of it: how much of the picture comes out, what
// stays bare, becomes paler or another colour, how far it may be off, and that it is a draft.
// Nothing of the workshop. `has_picture`: there is one beside it to point to.
std::vector<Finding> customer_points(const Report& report, bool has_picture);
// And in a sentence; of a report that has its coverage.
std::string customer_verdict(const Report& report);
// "This is how it will look", ...
std::string customer_headline(const Report& report, Concern concern, bool has_picture);

// "none", "care", "stop"
std::string concern_name(Concern concern);

}  // namespace hydrodip
