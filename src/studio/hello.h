// What never changes while the studio runs, and what its page begins with: docs/studio-api.md,
// "GET /api/hello".
#pragma once

#include <string>
#include <vector>

#include "studio/json.h"

namespace hydrodip {

// `opened`: the job that the command line named, or ""; `recent`: RECENT.
Json hello_json(const std::string& run, const std::string& opened,
                const std::vector<std::string>& profiles, const Json& recent);

}  // namespace hydrodip
