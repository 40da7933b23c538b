// How well film tears: tear lines against exact circles, coarse film against fine, what tears cost,
// and whether every step and round ends on a list of models. Prints the tables of docs/accuracy.md.
//
//   bench_tears [MODELS_FOLDER [PART...]]     parts: circles, meshes, times, list, rounds

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "coat/design.h"
#include "coat/dipped_object.h"
#include "dip/torn_models.h"
#include "exact/dipping.h"
#include "exact/tear_lines.h"
#include "film/locate.h"
#include "transfer/film_map.h"

namespace hydrodip {
namespace {

using shapes::Named;
using shapes::Shape;

FilmOptions letter(int elements) {
  return {.width_mm = 215.9, .height_mm = 279.4, .elements = elements};
}

// As jobs dip.
DipOptions defaults() {
  DipOptions options;
  options.asks_what_moves = true;
  return options;
}

struct Dipped {
  DipResult result;
  double seconds = 0;
  // Per vertex: travelled when it attached.
  std::vector<double> attached_at;
};

Dipped dip_whole(const Shape& shape, const FilmOptions& film, const DipOptions& options,
                 bool watch = false) {
  const Surface surface(shape.positions, shape.triangles);
  const auto mesh = std::make_shared<const FilmMesh>(make_film_mesh(film));
  RunContext context;
  Dipped dipped;
  if (watch) dipped.attached_at.assign(mesh->u.size(), 1e300);
  const DipObserver observer = [&](int, int, const Moment& moment, const std::vector<Vec3>&,
                                   const std::vector<VertexState>& state) {
    for (std::size_t v = 0; v < state.size(); ++v)
      if (state[v] == VertexState::kAttached)
        dipped.attached_at[v] = std::min(dipped.attached_at[v], moment.travelled_mm);
  };
  const auto start = std::chrono::steady_clock::now();
  dipped.result =
      dip(mesh, shape.positions, shape.triangles, surface, make_trajectory({}, shape.positions),
          options, context, watch ? observer : DipObserver());
  dipped.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return dipped;
}

void print_circles() {
  fmt::print(
      "\n| body | limit | triangles | exact (mm) | tear line: mean - exact (mm) | standard "
      "deviation over 72 directions (mm) | lowest, highest - exact (mm) |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const exact::TearingBody& body : exact::tearing_bodies())
    for (const double limit : {1.3, 1.4})
      for (const int elements : {10000, 40000, 160000}) {
        const exact::TearLine line = exact::tear_line(body, limit, elements);
        fmt::print("| {} | {:g} | {} | {:.3f} | {:.4f} | {:.4f} | {:.4f}, {:.4f} |\n", body.name,
                   limit, elements, line.exact_mm, line.mean_mm - line.exact_mm, line.deviation_mm,
                   line.lowest_mm - line.exact_mm, line.highest_mm - line.exact_mm);
        std::fflush(stdout);
      }
}

// Where both films are whole: how far apart they lie.
void print_meshes(const std::vector<Named>& models) {
  fmt::print(
      "\n| model | first tear (mm deep) | whole before it: largest, rms (mm) | whole later: "
      "largest, 99 %, rms (mm) | share later | covered, 40,000 (mm2) | 160,000 |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const Named& model : models) {
    const DipOptions options = defaults();
    const Dipped coarse = dip_whole(model.shape, letter(40000), options, true);
    const Dipped fine = dip_whole(model.shape, letter(160000), options);
    const DippedFilm &c = coarse.result.film, &f = fine.result.film;
    double first_tear = 1e300;
    for (std::size_t t = 0; t < c.torn.size(); ++t)
      first_tear = std::min(first_tear, c.torn_at_mm[t]);
    for (std::size_t v = 0; v < c.position.size(); ++v)
      if (c.excess_of(std::int32_t(v)) > 0)
        first_tear = std::min(first_tear, coarse.attached_at[v]);
    // The fine film at the coarse film's vertices, by film coordinate.
    std::vector<double> before, later;
    for (std::size_t v = 0; v < c.position.size(); ++v) {
      const auto whole = [&](const DippedFilm& film, const FilmLocation& at) {
        return at.inside && film.lies_on_object(std::size_t(at.triangle)) &&
               film.is_whole_at(std::size_t(at.triangle), at.weight);
      };
      const FilmLocation at = locate_flat(f.mesh(), c.mesh().u[v]);
      if (!whole(c, locate_flat(c.mesh(), c.mesh().u[v])) || !whole(f, at)) continue;
      Vec3 place = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        place += at.weight[Eigen::Index(k)] *
                 f.position[std::size_t(f.mesh().triangles[std::size_t(at.triangle)][k])];
      const double apart = (place - c.position[v]).norm();
      (coarse.attached_at[v] < first_tear ? before : later).push_back(apart);
    }
    const auto rms = [](const std::vector<double>& list) {
      double sum = 0;
      for (const double d : list) sum += d * d;
      return list.empty() ? 0 : std::sqrt(sum / double(list.size()));
    };
    std::sort(before.begin(), before.end());
    std::sort(later.begin(), later.end());
    const auto at_share = [](const std::vector<double>& list, double share) {
      return list.empty() ? 0 : list[std::size_t(share * double(list.size() - 1))];
    };
    const TriangleMesh mesh{model.shape.positions, model.shape.triangles};
    fmt::print(
        "| {} | {:.1f} | {:.4f}, {:.4f} | {:.3f}, {:.3f}, {:.3f} | {:.0f} % | {:.0f} | {:.0f} |\n",
        model.name, first_tear, at_share(before, 1), rms(before), at_share(later, 1),
        at_share(later, 0.99), rms(later),
        100.0 * double(later.size()) /
            double(std::max<std::size_t>(1, before.size() + later.size())),
        measure_coverage(mesh, c).covered_mm2, measure_coverage(mesh, f).covered_mm2);
    std::fflush(stdout);
  }
}

// A step of a torn dip against one of a dip in which nothing tears, interleaved.
void print_times() {
  fmt::print(
      "\n| triangles | a step, nothing tears (ms) | sphere, whole (ms) | ratio | steps, "
      "unconverged | iterations a step, untorn and torn |\n|---|---|---|---|---|---|\n");
  const Shape sphere = shapes::full_sphere(30), cone = shapes::cone(30, 0.7);
  for (const int elements : {10000, 40000, 160000, 1000000}) {
    const DipOptions options = defaults();
    const Dipped untorn = dip_whole(cone, letter(elements), options);
    const Dipped torn = dip_whole(sphere, letter(elements), options);
    const DipStatistics &a = untorn.result.statistics, &b = torn.result.statistics;
    const double plain = 1e3 * untorn.seconds / a.steps, tearing = 1e3 * torn.seconds / b.steps;
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {}, {} | {:.1f}, {:.1f} |\n", elements, plain,
               tearing, tearing / plain, b.steps, b.unconverged_steps,
               double(a.iterations) / a.steps, double(b.iterations) / b.steps);
    std::fflush(stdout);
  }
}

void print_list(const std::vector<Named>& models) {
  fmt::print(
      "\n| model, six holds | steps | unconverged | iterations a step | most in a hold | covered, "
      "doubtful (share of the surface) | s |\n|---|---|---|---|---|---|---|\n");
  long all_steps = 0, all_unconverged = 0;
  for (const Named& model : models) {
    long steps = 0, unconverged = 0, iterations = 0;
    double most = 0, covered = 0, doubtful = 0, seconds = 0;
    for (const Vec3& hold : shapes::holds_deg()) {
      const Shape shape = shapes::placed(model.shape, hold);
      const DipOptions options = defaults();
      const Dipped dipped = dip_whole(shape, letter(40000), options);
      const DipStatistics& s = dipped.result.statistics;
      steps += s.steps;
      unconverged += s.unconverged_steps;
      iterations += s.iterations;
      most = std::max(most, double(s.iterations) / s.steps);
      const TriangleMesh mesh{shape.positions, shape.triangles};
      const Coverage c =
          measure_coverage(mesh, dipped.result.film, straight_down_to(dipped.result.film.depth_mm),
                           doubtful_stretch(options.material));
      covered += c.covered_share() / 6;
      doubtful += c.doubtful_share() / 6;
      seconds += dipped.seconds;
    }
    fmt::print("| {} | {} | {} | {:.1f} | {:.1f} | {:.1f} %, {:.1f} % | {:.1f} |\n", model.name,
               steps, unconverged, double(iterations) / double(steps), most, 100 * covered,
               100 * doubtful, seconds);
    std::fflush(stdout);
    all_steps += steps;
    all_unconverged += unconverged;
  }
  fmt::print("| all | {} | {} | | | | |\n", all_steps, all_unconverged);
}

// 5 mm squares in space, dark and light.
class Squares : public Paint {
 public:
  explicit Squares(const TriangleMesh& mesh) : Paint({1, 1, 1, 1}), mesh_(mesh) {}
  LinearColor color_at(const SurfacePoint& point) const override {
    const Vec3 at = position_at(mesh_, point) / 5;
    const long sum = long(std::floor(at.x())) + long(std::floor(at.y())) + long(std::floor(at.z()));
    return sum % 2 == 0 ? LinearColor{0.05F, 0.1F, 0.3F, 1} : LinearColor{0.9F, 0.85F, 0.6F, 1};
  }
  bool says_anything() const override { return true; }

 private:
  const TriangleMesh& mesh_;
};

void print_rounds(const std::vector<Named>& models) {
  fmt::print(
      "\n| model | rounds | settled | mean change of what is whole, round by round (mm) | s "
      "|\n|---|---|---|---|---|\n");
  for (const Named& model : models) {
    const auto object = std::make_shared<Object>();
    object->positions = model.shape.positions;
    object->triangles = model.shape.triangles;
    object->material_of.assign(object->triangles.size(), 0);
    object->materials.emplace_back();
    const PosedObject posed(object, {});
    DesignOptions options;
    options.film = letter(40000);
    RunContext context;
    Timings timings;
    const auto start = std::chrono::steady_clock::now();
    const Squares squares(*object);
    const Designed designed =
        design({posed, squares, Allotment(), *make_device_model(), options}, timings, context);
    std::string changes;
    for (const InkRound& round : designed.ink.rounds)
      if (&round != &designed.ink.rounds.front())
        changes += fmt::format(" {:.2g}", round.change_mm);
    fmt::print("| {} | {} | {} |{} | {:.0f} |\n", model.name, designed.ink.rounds.size(),
               designed.ink.settled ? "yes" : "no", changes,
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  using namespace hydrodip;
  const std::vector<shapes::Named> models = shapes::torn_models(argc > 1 ? argv[1] : "");
  const std::set<std::string> parts(argv + std::min(argc, 2), argv + argc);
  const auto wanted = [&](const char* part) { return parts.empty() || parts.count(part) > 0; };
  fmt::print("{} models\n", models.size());
  if (wanted("circles")) print_circles();
  if (wanted("meshes")) print_meshes(models);
  if (wanted("times")) print_times();
  if (wanted("list")) print_list(models);
  if (wanted("rounds")) print_rounds(models);
}
