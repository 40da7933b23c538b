// The pipelines behind the commands. Each reads as the list of its steps.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/math.h"
#include "settings/config.h"

namespace hydrodip {

struct JobResult {
  std::filesystem::path folder;        // empty: nothing was written
  std::vector<std::string> files;      // in folder
  std::string text;                    // the result in words, several lines
  std::string json;                    // the same for machines, one object
  bool do_not_dip = false;             // the verdict
  std::vector<std::string> dips = {};  // of several: the folders of their sheets, in folder
};

// The main job: simulates the dip and writes the film image that puts every colour in its place:
// print.pdf, print.png, print.tif, film.ply, preview.png, maps.png, gamut.png, preview.glb,
// report.json, report.html in config.output. All of them appear, or none. Of several dips
// (config.dips or config.plan.dips) each has its folder, and one report is on the whole. `command`:
// whose job it is, as the report says. Throws InputError, DipError, Cancelled.
JobResult print_job(const JobConfig& config, const RunContext& context,
                    const std::string& command = "print");

// Forward only: film.ply, preview.png, maps.png, preview.glb, report.json, report.html; with
// config.film_image (the whole sheet, as print.png) also what the object will look like.
JobResult simulate_job(const JobConfig& config, const RunContext& context);

// A finished film image (config.film_image, the whole sheet) as it is: the sheet with its marks,
// and all that simulate_job says of it.
JobResult print_film_image_job(const JobConfig& config, const RunContext& context);

// No simulation: size, mesh health, what fits the film, dip angles. Writes angles.png and
// report.json only if config.output is given.
JobResult inspect_job(const JobConfig& config, const RunContext& context);

// A part in pattern film: a picture that is repeated over the whole film.
struct PatternRequest {
  std::filesystem::path tile;
  double tile_mm = 0;  // its width; the height keeps its shape
  // The pattern is drawn so that it looks unstretched on the part.
  bool compensate = false;
  struct Spot {
    Vec3 at_mm;  // in the model's frame after scaling
    double radius_mm = 10;
  };
  std::vector<Spot> spots;         // to be kept free of detail, seams and stretch
  std::optional<Vec2> shift_mm;    // of the tile's centre from the film's; none: searched
  std::optional<double> turn_deg;  // counter-clockwise as seen from above; none: searched
};

// Finds where the pattern does least harm, and prints it as print_job does, below the job's other
// artwork. Throws as print_job.
JobResult pattern_job(const JobConfig& config, const PatternRequest& request,
                      const RunContext& context);

// Several parts on one sheet of film, which is cut into pieces: one for each part, with the film
// that it needs around it.
struct NestRequest {
  struct Part {
    JobConfig config;  // its film is the sheet's; its piece's size follows from the object
    int count = 1;
    std::filesystem::path file;  // of its job or model, by whose name people know it
  };
  std::vector<Part> parts;
  std::optional<double> clearance_mm;  // free film; none: as much as the sheet has room for
};

// print.pdf, print.png, print.tif of the whole sheet; nest.html, the run sheet; nest.json; a
// picture of each part. `sheet` says film, printer and output. Throws as print_job, and InputError
// saying how many parts fit if not all do.
JobResult nest_job(const JobConfig& sheet, const NestRequest& request, const RunContext& context);

// The best ways to hold the object and how deep to dip it: writes orient.json, and orient.png
// unless pictures are off. The configuration's rotation is replaced, its depth is kept if it gives
// one, and else looked for.
JobResult orient_job(const JobConfig& config, const RunContext& context);

// Several dips, chosen together: writes plan.toml, a job to print, plan.json and plan.png. Dips
// that the configuration locks stay as they are. `to_print`: what plan.toml says besides, where
// sheets are to be made otherwise than the plan was (null: as it was).
JobResult plan_job(const JobConfig& config, const RunContext& context,
                   const JobConfig* to_print = nullptr);

// Opens a job's report.html (`where`: it, or its folder) in the default browser; where there is
// none, the result says its path. Throws InputError if there is no report.
JobResult view_job(const std::filesystem::path& where);

// Writes a built-in sample model with its texture.
JobResult sample_job(const std::string& name, const std::filesystem::path& folder,
                     const RunContext& context, EarlierResult earlier = EarlierResult::kReplaced);
// The built-in samples' names and what they are; for `hydrodip sample` without a name.
JobResult list_samples();

}  // namespace hydrodip
