#include "rig/pictures.h"

#include "base/error.h"
#include "job/prepare.h"
#include "model_io/load.h"
#include "object/append.h"
#include "object/bake.h"
#include "object/surface.h"
#include "render/lit_view.h"
#include "report/report.h"

namespace hydrodip {
namespace {

// Of a painted object whose pictures are a few hundred pixels wide.
constexpr int kTexture_px = 1024;

// How the camera's frame (+y up) sees the posed-object frame (z up): as it is, or lying on its back
// so that up is up.
enum class Turn { kNone, kUpright };

struct View {
  std::string caption;
  Turn turn;
  Vec3 direction;  // towards the eye, after the turn
};

// preview.glb shows the object with its front towards glTF's +z, and the loader turns glTF's y up.
Vec3 posed(const Vec3& loaded) { return {-loaded.x(), loaded.z(), loaded.y()}; }

Vec3 turned(const Vec3& p, Turn turn) {
  return turn == Turn::kNone ? p : Vec3(p.x(), p.z(), -p.y());
}

bool is_as_printed(const RigJob& job) {
  try {
    return !job.model_sha256.empty() &&
           describe_input("model", job.config.model).sha256 == job.model_sha256;
  } catch (const InputError&) {
    return false;  // moved or deleted
  }
}

// In the posed-object frame: from the model, sharp and with all its sides, unless there was artwork
// on it, which the folder's own picture of it has as well.
Object hanging_object(const RigJob& job, const RunContext& context) {
  // What there is to say about the model was said when it was printed.
  const RunContext unheard = context.quiet();
  std::error_code ignored;
  const bool is_shown = std::filesystem::exists(job.folder / "preview.glb", ignored);
  if (is_as_printed(job) && !(job.has_artwork && is_shown)) {
    const PreparedObject prepared = prepare_object(job.config.model, job.config.object, unheard);
    return painted_object(prepared.posed.mesh(), *prepared.paint,
                          {.most_px = kTexture_px, .finest = kFinestTexels_per_mm});
  }
  Object object = load_object(job.folder / "preview.glb", {}, unheard).object;
  for (Vec3& p : object.positions) p = posed(p);
  return object;
}

Image render(const Object& object, const View& view, int width_px, int height_px,
             const RunContext& context) {
  const Surface surface(object.positions, object.triangles);
  const std::vector<CornerNormals> normals = corner_normals(object.positions, object.triangles);
  Appearance appearance;
  appearance.wanted = [&](const SurfacePoint& point, const Vec3&, const Vec3&) {
    return color_at(object, point, {1, 1, 1, 1});
  };
  appearance.predicted = appearance.wanted;
  const LitObject lit{object, surface, normals};
  const Camera camera = frame_object(object, view.direction, double(width_px) / height_px, 0.85);
  return LitView(lit, camera, width_px, height_px, context).show(appearance).wanted;
}

}  // namespace

std::vector<PosePicture> pose_pictures(const RigJob& job, int width_px, int height_px,
                                       const RunContext& context) {
  Object hanging = hanging_object(job, context);
  const Eigen::Isometry3d in_bath = hanging_pose(job);
  for (Vec3& p : hanging.positions) p = in_bath * p;
  const std::vector<View> views = {
      {"from the front", Turn::kUpright, Vec3::UnitZ()},
      {"from the right", Turn::kUpright, Vec3::UnitX()},
      {"from below (what meets the film)", Turn::kNone, -Vec3::UnitZ()}};
  std::vector<PosePicture> pictures;
  for (const View& view : views) {
    context.progress("drawing the object", double(pictures.size()) / double(views.size()));
    Object object = hanging;
    for (Vec3& p : object.positions) p = turned(p, view.turn);
    pictures.push_back({view.caption, render(object, view, width_px, height_px, context)});
  }
  return pictures;
}

Image draw_parts(const std::vector<ShownPart>& parts, int width_px, int height_px,
                 const RunContext& context) {
  Object all;
  all.materials.resize(1);
  for (const ShownPart& part : parts) {
    append(all, part.mesh);
    all.colors.resize(all.triangles.size(), {part.color, part.color, part.color});
  }
  all.material_of.assign(all.triangles.size(), 0);
  for (Vec3& p : all.positions) p = turned(p, Turn::kUpright);
  return render(all, {"", Turn::kUpright, Vec3(0.5, 0.42, 1).normalized()}, width_px, height_px,
                context);
}

}  // namespace hydrodip
