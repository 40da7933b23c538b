// What holds film and object at the bench, to be 3D-printed: 'hydrodip rig jig'.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "job/jobs.h"
#include "object/surface.h"
#include "rig/rig_job.h"

namespace hydrodip {

struct JigOptions {
  Vec3 bed_mm = Vec3(220, 220, 250);  // of the 3D printer
  double clearance_mm = 0.3;          // between parts, and between object and socket
};

// One part as it is to be printed: standing on z = 0, without overhangs, and turned so that it fits
// the bed as it lies (a long bar from corner to corner).
struct JigPart {
  std::string name;  // "mount"
  TriangleMesh mesh;
  int turned_deg = 0;  // about the vertical, so that it fits the bed
  // From the printed part to where it is at full depth, posed-object frame.
  Eigen::Isometry3d in_use = Eigen::Isometry3d::Identity();
};

struct Jig {
  std::vector<JigPart> parts;  // mount, bar, frame or frame-1 to frame-4
  double socket_depth_mm = 0;
  // Turns (degrees) about the vertical in which the object fits its socket as well.
  std::vector<double> also_fits_deg;
};

// The mount takes the object from above: its socket is the object's upper side with the clearance
// around it, down to just above the water, so that the object goes in from below and hangs in its
// pose. Two pins of different size hold the mount under the bar; two posts of different size on the
// frame guide the bar, and their shoulders end the dip at the job's depth. The frame lies on the
// water, centred by arms that reach the bath's walls; the film's outermost 3 mm (less where
// marks begin nearer to the edge) are taped to its underside. Throws InputError where the dry side
// gives no hold, film or bath leave no room, or a part exceeds the bed.
Jig make_jig(const RigJob& job, const TriangleMesh& object, const Surface& surface,
             const JigOptions& options);

// The parts as STL files, and jig.png, which shows them taken apart, in the folder.
JobResult jig_job(const RigJob& job, const JigOptions& options, const std::filesystem::path& folder,
                  const RunContext& context);

}  // namespace hydrodip
