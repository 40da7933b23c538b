// The pipelines behind the commands. Each reads as the list of its steps.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "settings/config.h"

namespace hydrodip {

struct JobResult {
  std::filesystem::path folder;    // empty: nothing was written
  std::vector<std::string> files;  // in folder
  std::string text;                // the result in words, several lines
  std::string json;                // the same for machines, one object
};

// The main job: simulates the dip and writes the film image that puts every colour in its place:
// print.pdf, print.png, print.tif, film.ply, preview.png, maps.png, gamut.png, preview.glb,
// report.json, report.html in config.output. All of them appear, or none. Throws InputError,
// DipError, Cancelled.
JobResult print_job(const JobConfig& config, const RunContext& context);

// Forward only: film.ply, preview.png, maps.png, preview.glb, report.json, report.html; with
// config.film_image (the whole sheet, as print.png) also what the object will look like.
JobResult simulate_job(const JobConfig& config, const RunContext& context);

// No simulation: size, mesh health, what fits the film, dip angles. Writes angles.png and
// report.json only if config.output is given.
JobResult inspect_job(const JobConfig& config, const RunContext& context);

// Opens a job's report.html (`where`: it, or its folder) in the default browser; where there is
// none, the result says its path. Throws InputError if there is no report.
JobResult view_job(const std::filesystem::path& where);

// Writes a built-in sample model with its texture.
JobResult sample_job(const std::string& name, const std::filesystem::path& folder,
                     const RunContext& context);
// The built-in samples' names and what they are; for `hydrodip sample` without a name.
JobResult list_samples();

}  // namespace hydrodip
