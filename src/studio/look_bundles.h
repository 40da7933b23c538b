// A look as the page fetches it: packed. docs/studio-api.md, "A result".
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/context.h"
#include "job/dips_together.h"
#include "studio/json.h"
#include "studio/look.h"

namespace hydrodip {

// `head`: what only the job knows; files in `uploads` are called by their names alone.
std::vector<std::uint8_t> finish_bundle(const DipsTogether& look, Json head,
                                        const std::filesystem::path& uploads);
std::vector<std::uint8_t> result_bundle(const Look& look, Json head,
                                        const std::filesystem::path& uploads,
                                        const RunContext& context);
// Its way into the water.
std::vector<std::uint8_t> dip_bundle(const DippedObject& dipped);

}  // namespace hydrodip
