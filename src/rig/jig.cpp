#include "rig/jig.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "export/stl.h"
#include "image/files.h"
#include "job/output.h"
#include "job/prepare.h"
#include "rig/pictures.h"
#include "rig/solids.h"

namespace hydrodip {
namespace {

// ---- the mount ----

constexpr double kAboveWater_mm = 4;  // nothing of the mount comes nearer to the water
constexpr double kDeepestSocket_mm = 25;
constexpr double kLeastSocket_mm = 6;  // less gives no hold
constexpr double kLeastWidth_mm = 8;   // of what is held
constexpr double kWall_mm = 3.2, kRoof_mm = 4;
constexpr double kEar_mm = 16, kEarHeight_mm = 8;
constexpr double kFinest_mm = 0.2, kCoarsest_mm = 0.6;
constexpr double kMostLines = 340;
// Film and posts: pins of two sizes fit one way only.
constexpr double kPegLeft_mm = 6, kPegRight_mm = 8, kPegLength_mm = 7;

// ---- bar and frame ----

constexpr double kBarWidth_mm = 20, kBarHeight_mm = 12;
constexpr double kMostOverFilm_mm = 3;  // of the sheet's edge is taped below the frame
constexpr double kRing_mm = 16, kRingHeight_mm = 5;
constexpr double kPostLeft_mm = 8, kPostRight_mm = 10;
constexpr double kLifted_mm = 12;  // above the water while the film is laid
constexpr double kArm_mm = 12, kToWall_mm = 0.5;
constexpr double kNeck_mm = 4, kHead_mm = 9, kTongue_mm = 4;
constexpr double kJointBelow_mm = 30;  // the posts stand on the upper pieces

[[noreturn]] void refuse(const RigJob& job, const std::string& why) {
  throw InputError(fmt::format("{}: {}", job.folder.string(), why));
}

// Heights of the object as seen from above, over the lines of a grid.
class UpperSide {
 public:
  UpperSide(const Surface& surface, const Box3& box, double clearance_mm)
      : surface_(surface), from_mm_(box.max.z() + 1), clearance_mm_(clearance_mm) {}

  // Of the object, or far below where there is none.
  double height(const Vec2& at) const {
    const auto hit =
        surface_.first_hit(Vec3(at.x(), at.y(), from_mm_), -Vec3::UnitZ(), 0, from_mm_ + 1e4);
    return hit ? from_mm_ - hit->t : -1e9;
  }
  // With room for the clearance on all sides, and for what lies between the grid's lines.
  double roomy_height(const Vec2& at, double pitch_mm) const {
    const double reach = clearance_mm_ + 0.75 * pitch_mm;
    double most = height(at);
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * k / kAround;
      for (const double part : {0.5, 1.0})
        most = std::max(most, height(at + part * reach * Vec2(std::cos(angle), std::sin(angle))));
    }
    return most + clearance_mm_;
  }

 private:
  static constexpr int kAround = 12;
  const Surface& surface_;
  double from_mm_, clearance_mm_;
};

struct Socket {
  double bottom_mm = 0, top_mm = 0;  // of the socket's walls; of the object
  Box2 outline;                      // of the object where it is held
};

Socket find_socket(const RigJob& job, const TriangleMesh& object, const UpperSide& upper) {
  const Box3 box = object.bounds();
  const double lowest = job.depth_mm + kAboveWater_mm;
  Socket socket;
  socket.top_mm = box.max.z();
  socket.bottom_mm = std::max(lowest, socket.top_mm - kDeepestSocket_mm);
  if (socket.top_mm - socket.bottom_mm < kLeastSocket_mm)
    refuse(job, fmt::format(
                    "the dry side gives no hold: {:.1f} mm of the object stay above the water and "
                    "{:g} are needed; dip less deep, or glue a block to its dry side",
                    std::max(0.0, box.max.z() - job.depth_mm), kAboveWater_mm + kLeastSocket_mm));
  constexpr double kProbe_mm = 0.5;
  for (double y = box.min.y(); y <= box.max.y(); y += kProbe_mm)
    for (double x = box.min.x(); x <= box.max.x(); x += kProbe_mm)
      if (upper.height({x, y}) > socket.bottom_mm) socket.outline.add({x, y});
  if (socket.outline.empty() ||
      (socket.outline.max - socket.outline.min).minCoeff() < kLeastWidth_mm)
    refuse(job, fmt::format(
                    "the dry side gives no hold: what stays above the water is less than {:g} mm "
                    "wide; dip less deep, or glue a block to it",
                    kLeastWidth_mm));
  return socket;
}

struct Hole {
  double x_mm = 0, side_mm = 0;
};

// Even lines with those of the holes among them.
std::vector<double> lines(double from, double to, double pitch, std::vector<double> also) {
  also.insert(also.end(), {from, to});
  const int count = std::max(1, int(std::ceil((to - from) / pitch)));
  std::vector<double> result = also;
  for (int i = 1; i < count; ++i) {
    const double at = from + (to - from) * i / count;
    const bool near = std::any_of(also.begin(), also.end(),
                                  [&](double a) { return std::abs(a - at) < 0.3 * pitch; });
    if (!near) result.push_back(at);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

struct Mount {
  TriangleMesh mesh;  // as it hangs
  double top_mm = 0;
  Hole left, right;  // for the bar's pegs, on y = 0
};

Mount make_mount(const Socket& socket, const UpperSide& upper, const JigOptions& options) {
  Mount mount;
  mount.top_mm = socket.top_mm + options.clearance_mm + kRoof_mm;
  const double rim = kWall_mm + options.clearance_mm;
  Box2 block = socket.outline;
  block.min -= Vec2(rim, rim);
  block.max += Vec2(rim, rim);
  // The ears lie on y = 0, under the bar.
  block.min.y() = std::min(block.min.y(), -0.5 * kEar_mm);
  block.max.y() = std::max(block.max.y(), 0.5 * kEar_mm);
  mount.left = {block.min.x() - 0.5 * kEar_mm, kPegLeft_mm + 2 * options.clearance_mm};
  mount.right = {block.max.x() + 0.5 * kEar_mm, kPegRight_mm + 2 * options.clearance_mm};
  const double ear = 0.5 * kEar_mm;
  std::vector<double> also_x = {block.min.x(), block.max.x()}, also_y = {-ear, ear};
  for (const Hole& hole : {mount.left, mount.right})
    for (const double side : {-0.5, 0.5}) {
      also_x.push_back(hole.x_mm + side * hole.side_mm);
      also_y.push_back(side * hole.side_mm);
    }
  const Vec2 size = block.max - block.min + Vec2(2 * kEar_mm, 0);
  const double pitch = std::clamp(size.maxCoeff() / kMostLines, kFinest_mm, kCoarsest_mm);
  HeightSolid solid;
  solid.x = lines(block.min.x() - kEar_mm, block.max.x() + kEar_mm, pitch, also_x);
  solid.y = lines(block.min.y(), block.max.y(), pitch, also_y);
  const double ear_bottom = std::max(socket.bottom_mm, mount.top_mm - kEarHeight_mm);
  solid.high = [&](std::size_t, std::size_t) { return mount.top_mm; };
  solid.low = [&](std::size_t i, std::size_t j) {
    const Vec2 at(solid.x[i], solid.y[j]);
    if (at.x() < block.min.x() || at.x() > block.max.x()) return ear_bottom;
    return std::max(socket.bottom_mm, upper.roomy_height(at, pitch));
  };
  solid.is_there = [&](const Vec2& at) {
    if (at.x() > block.min.x() && at.x() < block.max.x()) return true;
    if (std::abs(at.y()) > ear) return false;
    for (const Hole& hole : {mount.left, mount.right})
      if (std::abs(at.x() - hole.x_mm) < 0.5 * hole.side_mm &&
          std::abs(at.y()) < 0.5 * hole.side_mm)
        return false;
    return true;
  };
  mount.mesh = solid.mesh();
  return mount;
}

// Other turns in which the object goes into the socket: everything of it that is held stays below
// the socket's roof.
std::vector<double> other_fits(const TriangleMesh& object, const Socket& socket,
                               const UpperSide& upper, double clearance_mm) {
  std::vector<Vec3> held;
  for (const Vec3& p : object.positions)
    if (p.z() > socket.bottom_mm + 1) held.push_back(p);
  constexpr std::size_t kMost = 3000;
  const std::size_t every = std::max<std::size_t>(1, held.size() / kMost);
  const Vec2 middle = 0.5 * (socket.outline.min + socket.outline.max);
  std::vector<double> fits;
  constexpr int kStep_deg = 15;
  for (int turn = kStep_deg; turn < 360; turn += kStep_deg) {
    const Eigen::Rotation2Dd rotation(turn * std::numbers::pi / 180);
    bool fit = !held.empty();
    for (std::size_t i = 0; fit && i < held.size(); i += every) {
      const Vec2 at = middle + rotation * (held[i].head<2>() - middle);
      fit = upper.roomy_height(at, 4 * clearance_mm) + clearance_mm >= held[i].z();
    }
    if (fit) fits.push_back(turn);
  }
  return fits;
}

// Upside down on the bed: nothing then hangs over.
JigPart turned_over(const std::string& name, TriangleMesh mesh, double top_mm) {
  Eigen::Isometry3d to_bed = Eigen::Isometry3d::Identity();
  to_bed.linear() = Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()).toRotationMatrix();
  to_bed.translation() = Vec3(0, 0, top_mm);
  for (Vec3& p : mesh.positions) p = to_bed * p;
  return {name, std::move(mesh), 0, to_bed.inverse()};
}

// ---- bar and frame; their z from the film up: 0 is the water at full depth ----

struct Frame {
  Vec2 inner, outer;  // half extents of the ring's hole and of the ring
  double post_x_mm = 0;
  double shoulder_mm = 0;  // of the posts
  double post_top_mm = 0;
};

// It covers no mark.
double over_film_mm(const RigJob& job) { return std::min(kMostOverFilm_mm, tape_mm(job.config)); }

Frame frame_for(const RigJob& job, const Mount& mount) {
  const FilmOptions& film = job.config.design.film;
  const BathOptions& bath = job.config.bath;
  Frame frame;
  const double over_mm = over_film_mm(job);
  frame.inner = 0.5 * Vec2(film.width_mm, film.height_mm) - Vec2::Constant(over_mm);
  frame.outer = frame.inner + Vec2::Constant(kRing_mm);
  frame.post_x_mm = frame.outer.x() - 0.5 * kRing_mm;
  frame.shoulder_mm = mount.top_mm - job.depth_mm;
  frame.post_top_mm = frame.shoulder_mm + job.depth_mm + kLifted_mm + kBarHeight_mm + 4;
  Vec2 room(bath.width_mm, bath.height_mm);
  if ((film.width_mm > film.height_mm) != (room.x() > room.y())) std::swap(room.x(), room.y());
  const Vec2 left = 0.5 * room - frame.outer;
  if (left.minCoeff() < kToWall_mm + 0.5)
    refuse(job, fmt::format(
                    "the frame of {:.0f} x {:.0f} mm does not fit the bath of {:g} x {:g} mm; tell "
                    "the bath's size (bath.width_mm, bath.height_mm) or choose a smaller film",
                    2 * frame.outer.x(), 2 * frame.outer.y(), room.x(), room.y()));
  constexpr double kLeastOverFilm_mm = 2;
  if (over_mm < kLeastOverFilm_mm)
    refuse(job, fmt::format("the frame holds {:g} mm of the film's edge, and its margin is {:g} mm "
                            "wide; set film.margin_mm to {:g} or more",
                            kMostOverFilm_mm, film.margin_mm, kMostOverFilm_mm));
  return frame;
}

Vec2 half_bath(const RigJob& job) {
  const FilmOptions& film = job.config.design.film;
  Vec2 room(job.config.bath.width_mm, job.config.bath.height_mm);
  if ((film.width_mm > film.height_mm) != (room.x() > room.y())) std::swap(room.x(), room.y());
  return 0.5 * room;
}

BoxSolid ring_of(const RigJob& job, const Frame& frame) {
  BoxSolid solid;
  const Vec2 reach = half_bath(job) - Vec2::Constant(kToWall_mm);
  const double h = kRingHeight_mm;
  const auto plate = [&](double x0, double y0, double x1, double y1) {
    solid.add({x0, y0, 0}, {x1, y1, h});
  };
  plate(-frame.outer.x(), -frame.outer.y(), frame.outer.x(), frame.outer.y());
  solid.cut({-frame.inner.x(), -frame.inner.y(), -1}, {frame.inner.x(), frame.inner.y(), h + 1});
  for (const double side : {-1.0, 1.0}) {
    const double y = side * 0.6 * frame.outer.y(), x = side * 0.6 * frame.outer.x();
    plate(-reach.x(), y - 0.5 * kArm_mm, -frame.outer.x(), y + 0.5 * kArm_mm);
    plate(frame.outer.x(), y - 0.5 * kArm_mm, reach.x(), y + 0.5 * kArm_mm);
    plate(x - 0.5 * kArm_mm, -reach.y(), x + 0.5 * kArm_mm, -frame.outer.y());
    plate(x - 0.5 * kArm_mm, frame.outer.y(), x + 0.5 * kArm_mm, reach.y());
    const double post = side < 0 ? kPostLeft_mm : kPostRight_mm, at = side * frame.post_x_mm;
    const double base = 0.5 * kRing_mm;
    if (frame.shoulder_mm > h)
      solid.add({at - base, -base, h}, {at + base, base, frame.shoulder_mm});
    solid.add({at - 0.5 * post, -0.5 * post, std::max(h, frame.shoulder_mm)},
              {at + 0.5 * post, 0.5 * post, frame.post_top_mm});
  }
  return solid;
}

// Keyed across a joint: one piece has the T, the other its socket. `at`: the joint's middle on the
// ring; the T points along +axis.
void add_tongue(BoxSolid& solid, const Vec2& at, bool along_x, bool is_socket,
                double clearance_mm) {
  const double more = is_socket ? clearance_mm / 2 : 0;
  const auto box = [&](double from, double to, double half) {
    const Vec2 a = along_x ? Vec2(from, -half) : Vec2(-half, from),
               b = along_x ? Vec2(to, half) : Vec2(half, to);
    const double z0 = is_socket ? -1 : 0, z1 = kRingHeight_mm + (is_socket ? 1 : 0);
    const Vec3 min(at.x() + a.x(), at.y() + a.y(), z0), max(at.x() + b.x(), at.y() + b.y(), z1);
    if (is_socket)
      solid.cut(min, max);
    else
      solid.add(min, max);
  };
  box(is_socket ? -1 : 0, kTongue_mm, 0.5 * kNeck_mm + more);
  box(kTongue_mm - more, 2 * kTongue_mm + more, 0.5 * kHead_mm + more);
}

std::vector<JigPart> frame_parts(const RigJob& job, const Frame& frame, const JigOptions& options) {
  const BoxSolid ring = ring_of(job, frame);
  const Vec2 size = 2 * (half_bath(job) - Vec2::Constant(kToWall_mm));
  std::vector<JigPart> parts;
  if (size.x() <= options.bed_mm.x() && size.y() <= options.bed_mm.y()) {
    parts.push_back({"frame", ring.mesh()});
  } else {
    const double far = 1e4;
    const Vec2 middle_ring = 0.5 * (frame.inner + frame.outer);
    int number = 0;
    for (const bool upper : {true, false})
      for (const bool right : {false, true}) {
        BoxSolid piece = ring;
        piece.keep({right ? 0 : -far, upper ? -kJointBelow_mm : -far, -far},
                   {right ? far : 0, upper ? far : -kJointBelow_mm, far});
        // Across x = 0, the left pieces reach over; across the sides, the lower ones.
        const double y = (upper ? 1 : -1) * middle_ring.y(), x = (right ? 1 : -1) * middle_ring.x();
        add_tongue(piece, {0, y}, true, right, options.clearance_mm);
        add_tongue(piece, {x, -kJointBelow_mm}, false, upper, options.clearance_mm);
        parts.push_back({fmt::format("frame-{}", ++number), piece.mesh()});
      }
  }
  // Their own z counts from the water.
  for (JigPart& part : parts) part.in_use.translation() = Vec3(0, 0, job.depth_mm);
  return parts;
}

JigPart make_bar(const Frame& frame, const Mount& mount, const JigOptions& options) {
  BoxSolid bar;
  const double end = frame.post_x_mm + 0.5 * kBarWidth_mm;
  const double z0 = mount.top_mm, z1 = z0 + kBarHeight_mm;
  bar.add({-end, -0.5 * kBarWidth_mm, z0}, {end, 0.5 * kBarWidth_mm, z1});
  for (const bool right : {false, true}) {
    const double at = (right ? 1 : -1) * frame.post_x_mm;
    const double half = 0.5 * (right ? kPostRight_mm : kPostLeft_mm) + options.clearance_mm;
    bar.cut({at - half, -half, z0 - 1}, {at + half, half, z1 + 1});
    const Hole& hole = right ? mount.right : mount.left;
    const double peg = 0.5 * (right ? kPegRight_mm : kPegLeft_mm);
    bar.add({hole.x_mm - peg, -peg, z0 - kPegLength_mm}, {hole.x_mm + peg, peg, z0});
  }
  return turned_over("bar", bar.mesh(), z1);
}

bool fits_bed(const TriangleMesh& mesh, const Vec3& bed) {
  return (mesh.bounds().size().array() <= bed.array() + 1e-9).all();
}

// As it lies, turned by a quarter, or a long and narrow one from corner to corner.
JigPart laid_on_bed(const JigPart& part, const Vec3& bed) {
  constexpr int kTurns_deg[] = {0, 90, 45, 30, 60};
  for (const int turn_deg : kTurns_deg) {
    JigPart turned = part;
    const Eigen::Isometry3d turn(
        Eigen::AngleAxisd(turn_deg * std::numbers::pi / 180, Vec3::UnitZ()));
    if (turn_deg != 0)
      for (Vec3& p : turned.mesh.positions) p = turn * p;
    turned.in_use = part.in_use * turn.inverse();
    turned.turned_deg = turn_deg;
    if (fits_bed(turned.mesh, bed)) return turned;
  }
  return part;
}

}  // namespace

Jig make_jig(const RigJob& job, const TriangleMesh& object, const Surface& surface,
             const JigOptions& options) {
  require_lowering_only(job);
  const UpperSide upper(surface, object.bounds(), options.clearance_mm);
  const Socket socket = find_socket(job, object, upper);
  const Mount mount = make_mount(socket, upper, options);
  const Frame frame = frame_for(job, mount);
  if (mount.right.x_mm + kEar_mm > frame.inner.x() || mount.left.x_mm - kEar_mm < -frame.inner.x())
    refuse(job, "the object is too wide for a mount inside the frame; choose a larger film");
  Jig jig;
  jig.socket_depth_mm = socket.top_mm - socket.bottom_mm;
  jig.also_fits_deg = other_fits(object, socket, upper, options.clearance_mm);
  jig.parts.push_back(turned_over("mount", mount.mesh, mount.top_mm));
  jig.parts.push_back(make_bar(frame, mount, options));
  for (JigPart& part : frame_parts(job, frame, options)) jig.parts.push_back(std::move(part));
  for (JigPart& part : jig.parts) {
    part = laid_on_bed(part, options.bed_mm);
    const Vec3 size = part.mesh.bounds().size();
    if (!fits_bed(part.mesh, options.bed_mm))
      refuse(job, fmt::format(
                      "{}.stl would measure {:.0f} x {:.0f} x {:.0f} mm, more than the printer's "
                      "bed of {:g} x {:g} x {:g} mm (--bed)",
                      part.name, size.x(), size.y(), size.z(), options.bed_mm.x(),
                      options.bed_mm.y(), options.bed_mm.z()));
  }
  return jig;
}

JobResult jig_job(const RigJob& job, const JigOptions& options, const std::filesystem::path& folder,
                  const RunContext& context) {
  const RunScope scope(context.with_threads(job.config.threads));
  ObjectOptions bare = job.config.object;
  bare.artwork.clear();
  bare.load.texture.clear();
  context.progress("cutting the socket", 0);
  require_model(job);
  const PreparedObject prepared = prepare_object(job.config.model, bare, context.quiet());
  TriangleMesh object = prepared.posed.mesh();
  const Eigen::Isometry3d in_bath = hanging_pose(job);
  for (Vec3& p : object.positions) p = in_bath * p;
  const Surface surface(object.positions, object.triangles);
  const Jig jig = make_jig(job, object, surface, options);

  OutputFolder output(folder, job.config.earlier_result);
  JobResult result;
  for (const JigPart& part : jig.parts) result.files.push_back(part.name + ".stl");
  result.files.emplace_back("jig.png");
  output.announce(result.files, prepared.files);
  output.supersede(files_of_jig());  // a frame of four pieces beside one of one
  const double span_mm = object.bounds().size().head<2>().maxCoeff();
  std::vector<ShownPart> shown = {{object, LinearColor{0.75F, 0.3F, 0.12F, 1}}};
  for (const JigPart& part : jig.parts) {
    write_stl(output.path(part.name + ".stl"), part.mesh, "hydrodip " + part.name + ", mm");
    TriangleMesh in_use = part.mesh;
    // Taken apart, so that one sees what goes into what.
    const double lifted_mm = part.name == "mount" ? 0.45 * span_mm
                             : part.name == "bar" ? 0.75 * span_mm
                                                  : 0;
    for (Vec3& p : in_use.positions) p = part.in_use * p + Vec3(0, 0, lifted_mm);
    shown.push_back({std::move(in_use), part.name == "mount" ? LinearColor{0.3F, 0.42F, 0.5F, 1}
                                                             : LinearColor{0.6F, 0.6F, 0.58F, 1}});
  }
  save_png(output.path("jig.png"), draw_parts(shown, 1400, 1000, context));
  context.check_cancelled();
  output.commit();

  result.folder = folder;
  result.text = output.told_replaced();
  result.text += fmt::format(
      "the mount holds {:.1f} mm of the object, and the frame's shoulders end the dip at {:.2f} "
      "mm\n",
      jig.socket_depth_mm, job.depth_mm);
  constexpr std::size_t kAnyTurn = 23;  // every 15 degrees
  if (jig.also_fits_deg.size() == kAnyTurn)
    result.text +=
        "warning: the object fits its socket in any turn: mark its front, which is where the bar's "
        "thinner post stands on the left\n";
  else if (!jig.also_fits_deg.empty())
    result.text += fmt::format(
        "warning: the object fits its socket turned by {:g} degrees as well: mark its front, which "
        "is where the bar's thinner post stands on the left\n",
        fmt::join(jig.also_fits_deg, ", "));
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (const JigPart& part : jig.parts) {
    const Vec3 size = part.mesh.bounds().size();
    result.text +=
        fmt::format("wrote {} ({:.1f} x {:.1f} x {:.1f} mm{})\n",
                    (folder / (part.name + ".stl")).string(), size.x(), size.y(), size.z(),
                    part.turned_deg == 0
                        ? ""
                        : fmt::format(", turned by {} degrees to fit the bed", part.turned_deg));
    parts.push_back({{"file", part.name + ".stl"}, {"size_mm", {size.x(), size.y(), size.z()}}});
  }
  result.text += fmt::format("wrote {}\n", (folder / "jig.png").string());
  result.json = json_answer("rig jig", {{"folder", folder.string()},
                                        {"socket_mm", jig.socket_depth_mm},
                                        {"also_fits_deg", jig.also_fits_deg},
                                        {"parts", parts}});
  return result;
}

}  // namespace hydrodip
