// How well film tears: tear lines against exact circles, coarse film against fine, what tears cost,
// and whether every step and round ends on a list of models. Prints the tables of docs/accuracy.md.
//
//   bench_tears [MODELS_FOLDER] [--log FILE] [PART | MODEL]...
//
// Parts: circles, meshes, doubt, times, list, rounds; all unless named. Models: of torn_models.h;
// all unless named. With --log rows are kept in the file, and those that it has are not computed
// again: what was stopped goes on there.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "coat/design.h"
#include "coat/dipped_object.h"
#include "dip/measure.h"
#include "dip/tear_doubt.h"
#include "dip/torn_models.h"
#include "exact/dipping.h"
#include "exact/tear_lines.h"
#include "transfer/film_map.h"

namespace hydrodip {
namespace {

using shapes::Named;
using shapes::Shape;

FilmOptions letter(int elements) {
  return {.width_mm = 215.9, .height_mm = 279.4, .elements = elements};
}

// Rows that a log has are shown as they are there.
class Tables {
 public:
  explicit Tables(const std::filesystem::path& log) : log_(log) {
    std::ifstream file(log);
    for (std::string line; std::getline(file, line);) {
      const std::size_t tab = line.find('\t');
      if (tab != std::string::npos) known_[line.substr(0, tab)] = line.substr(tab + 1);
    }
  }

  void begin(const std::string& columns) {
    fmt::print("\n{}\n|", columns);
    for (auto n = std::count(columns.begin(), columns.end(), '|'); n > 1; --n) fmt::print("---|");
    fmt::print("\n");
    std::fflush(stdout);
  }

  template <class Compute>
  void row(const std::string& key, const Compute& compute) {
    if (!known_.count(key)) {
      std::fprintf(stderr, "%s ...\n", key.c_str());
      known_[key] = compute();
      if (!log_.empty()) std::ofstream(log_, std::ios::app) << key << '\t' << known_[key] << '\n';
    }
    fmt::print("{}\n", known_[key]);
    std::fflush(stdout);
  }

 private:
  std::filesystem::path log_;
  std::map<std::string, std::string> known_;
};

std::shared_ptr<const Object> object_of(const Shape& shape) {
  const auto object = std::make_shared<Object>();
  object->positions = shape.positions;
  object->triangles = shape.triangles;
  object->material_of.assign(object->triangles.size(), 0);
  object->materials.emplace_back();
  return object;
}

struct Dipped {
  DippedObject object;
  double cpu_s = 0;
  std::vector<double> attached_at;  // per vertex: travelled
};

// As jobs dip, all of it.
Dipped dip_whole(const PosedObject& posed, const SharedFilmMesh& mesh, const DipOptions& options,
                 const RunContext& context = {}) {
  Dipped dipped{.object = {.posed = posed}, .attached_at = {}};
  dipped.attached_at.assign(mesh->u.size(), 1e300);
  const DipObserver observer = [&](int, int, const Moment& moment, const std::vector<Vec3>&,
                                   const std::vector<VertexState>& state) {
    for (std::size_t v = 0; v < state.size(); ++v)
      if (state[v] == VertexState::kAttached)
        dipped.attached_at[v] = std::min(dipped.attached_at[v], moment.travelled_mm);
  };
  Timings unheard;
  const std::clock_t start = std::clock();
  dipped.object = dip_object(posed, mesh, make_trajectory({}, posed.mesh().positions), options,
                             unheard, context, observer);
  dipped.cpu_s = double(std::clock() - start) / CLOCKS_PER_SEC;
  return dipped;
}

SharedFilmMesh film_of(int elements) {
  return std::make_shared<const FilmMesh>(make_film_mesh(letter(elements)));
}

void show_circles(Tables& tables) {
  tables.begin(
      "| body | limit | triangles | exact (mm) | tear line: mean - exact (mm) | standard deviation "
      "over 72 directions (mm) | lowest, highest - exact (mm) |");
  for (const exact::TearingBody& body : exact::tearing_bodies())
    for (const double limit : {1.3, 1.4})
      for (const int elements : {10000, 40000, 160000})
        tables.row(fmt::format("circles {} {} {}", body.name, limit, elements), [&] {
          const exact::TearLine line = exact::tear_line(body, limit, elements);
          return fmt::format("| {} | {:g} | {} | {:.3f} | {:.4f} | {:.4f} | {:.4f}, {:.4f} |",
                             body.name, limit, elements, line.exact_mm,
                             line.mean_mm - line.exact_mm, line.deviation_mm,
                             line.lowest_mm - line.exact_mm, line.highest_mm - line.exact_mm);
        });
}

// Lengths, told by their largest, 99th of 100 and middle one, and how many are above what is to be.
struct Lengths {
  std::vector<double> list;

  double at(double share) {
    if (list.empty()) return 0;
    const auto nth = list.begin() + std::ptrdiff_t(share * double(list.size() - 1));
    std::nth_element(list.begin(), nth, list.end());
    return *nth;
  }
  std::string text(double most) {
    const auto above = std::count_if(list.begin(), list.end(), [&](double d) { return d > most; });
    return fmt::format("{:.3f}, {:.3f}, {:.4f}; {} of {} above {:g}", at(1), at(0.99), at(0.5),
                       above, list.size(), most);
  }
};

// How far apart coarse and fine film lie, on the object.
std::string compare_meshes(const Named& model) {
  const PosedObject posed(object_of(model.shape), {});
  const auto dip_on = [&](int elements) {
    const SharedFilmMesh mesh = film_of(elements);
    DipOptions options;
    options.moved_mm.assign(mesh->u.size(), 0);  // asked below
    return dip_whole(posed, mesh, options);
  };
  const Dipped coarse = dip_on(40000), fine = dip_on(160000);
  const DippedFilm& film = *coarse.object.film;
  const TriangleMesh& mesh = posed.mesh();
  const std::vector<double> moved =
      moved_by_tears(film, mesh.positions, mesh.triangles, posed.surface(),
                     make_trajectory({}, mesh.positions), DipOptions(), RunContext());
  double first_tear = 1e300;
  for (const double at : film.torn_at_mm) first_tear = std::min(first_tear, at);
  for (std::size_t v = 0; v < film.position.size(); ++v)
    if (film.excess_of(std::int32_t(v)) > 0)
      first_tear = std::min(first_tear, coarse.attached_at[v]);
  std::vector<std::uint8_t> laid(film.position.size(), 0);
  for (std::size_t t = 0; t < film.torn.size(); ++t)
    if (film.lies_on_object(t))
      for (const std::int32_t v : film.mesh().triangles[t])
        laid[std::size_t(v)] = !(film.excess_of(v) > 0);
  Lengths before, later, doubtful;
  for (std::size_t v = 0; v < laid.size(); ++v) {
    if (!laid[v]) continue;
    const auto there = fine.object.map->to_object(film.mesh().u[v]);
    if (!there) continue;
    const double apart = (position_at(mesh, *there) - film.position[v]).norm();
    Lengths& list = moved[v] > kMoved_mm                 ? doubtful
                    : coarse.attached_at[v] < first_tear ? before
                                                         : later;
    list.list.push_back(apart);
  }
  const std::size_t common = before.list.size() + later.list.size() + doubtful.list.size();
  const double all = double(std::max<std::size_t>(1, common)) / 100;
  return fmt::format("| {} | {:.1f} | {} | {} | {} | {:.0f}, {:.0f}, {:.0f} | {:.0f}, {:.0f} |",
                     model.name, first_tear, before.text(0.02), later.text(kMoved_mm),
                     doubtful.text(kMoved_mm), double(before.list.size()) / all,
                     double(later.list.size()) / all, double(doubtful.list.size()) / all,
                     coarse.object.coverage.covered_mm2, fine.object.coverage.covered_mm2);
}

void show_meshes(Tables& tables, const std::vector<Named>& models) {
  tables.begin(
      "| 40,000 and 160,000 triangles, apart by: largest, 99 %, median (mm) | first tear (mm deep) "
      "| laid before it | promised, later | not promised | shares of the three (%) | stretched "
      "less than tears, 40,000, 160,000 (mm2) |");
  for (const Named& model : models)
    tables.row("meshes " + model.name, [&] { return compare_meshes(model); });
}

// What is promised, by when floating film lets go at the earliest and how far it may then move.
void show_doubt(Tables& tables, const std::vector<Named>& models) {
  constexpr double kEarliest[] = {1.3, 1.4, 1.5}, kMost_mm[] = {0.15, 0.3, 0.6, 1.2};
  tables.begin(
      "| covered (% of the surface) if moved by at most 0.15, 0.3, 0.6, 1.2 mm | nobody asks | "
      "film lets go at 1.3 or 1.6 | 1.4 or 1.6 | 1.5 or 1.6 |");
  for (const Named& model : models)
    tables.row("doubt " + model.name, [&] {
      const SharedFilmMesh mesh = film_of(40000);
      const PosedObject posed(object_of(model.shape), {});
      DipOptions options;
      options.moved_mm.assign(mesh->u.size(), 0);
      const Dipped dipped = dip_whole(posed, mesh, options);
      std::string row =
          fmt::format("| {} | {:.1f} |", model.name, 100 * dipped.object.coverage.covered_share());
      for (const double earliest : kEarliest) {
        DipOptions asking;
        asking.material.safe_stretch = earliest;
        asking.material.tear_stretch = 1.5;
        const std::vector<double> moved = moved_by_tears(
            *dipped.object.film, posed.mesh().positions, posed.mesh().triangles, posed.surface(),
            make_trajectory({}, posed.mesh().positions), asking, RunContext());
        for (const double most : kMost_mm) {
          std::vector<double> scaled = moved;
          for (double& way : scaled) way *= kMoved_mm / most;
          DippedFilm film = *dipped.object.film;
          add_moved(scaled, DipOptions(), film);
          row += fmt::format(" {:.1f}", 100 * measure_coverage(posed.mesh(), film).covered_share());
        }
        row += " |";
      }
      return row;
    });
}

// A step of a torn dip against one of a dip in which nothing tears, one after the other.
void show_times(Tables& tables) {
  tables.begin(
      "| triangles | a step, nothing tears (ms of one core) | sphere, whole | ratio | its steps, "
      "unconverged | iterations a step, untorn and torn |");
  const PosedObject sphere(object_of(shapes::full_sphere(30)), {});
  const PosedObject cone(object_of(shapes::cone(30, 0.7)), {});
  const RunContext alone = RunContext().with_threads(1);
  for (const int elements : {10000, 40000, 160000, 1000000})
    tables.row(fmt::format("times {}", elements), [&] {
      const SharedFilmMesh film = film_of(elements);
      const Dipped untorn = dip_whole(cone, film, {}, alone),
                   torn = dip_whole(sphere, film, {}, alone);
      const DipStatistics &a = untorn.object.statistics, &b = torn.object.statistics;
      const double plain = 1e3 * untorn.cpu_s / a.steps, tearing = 1e3 * torn.cpu_s / b.steps;
      return fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} | {}, {} | {:.1f}, {:.1f} |", elements,
                         plain, tearing, tearing / plain, b.steps, b.unconverged_steps,
                         double(a.iterations) / a.steps, double(b.iterations) / b.steps);
    });
}

void show_list(Tables& tables, const std::vector<Named>& models) {
  tables.begin(
      "| model, in each of six holds | steps | unconverged | iterations a step | covered (% of the "
      "surface) | covered, mean | doubtful, mean | s of cpu |");
  for (const Named& model : models)
    tables.row("list " + model.name, [&] {
      const SharedFilmMesh film = film_of(40000);
      std::string steps, unconverged, iterations, covered_each;
      double covered = 0, doubtful = 0, seconds = 0;
      for (const Vec3& hold : shapes::holds_deg()) {
        const PosedObject posed(object_of(shapes::placed(model.shape, hold)), {});
        const Dipped dipped = dip_whole(posed, film, {});
        const DipStatistics& s = dipped.object.statistics;
        const Coverage& c = dipped.object.coverage;
        steps += fmt::format(" {}", s.steps);
        unconverged += fmt::format(" {}", s.unconverged_steps);
        iterations += fmt::format(" {:.1f}", double(s.iterations) / s.steps);
        covered_each += fmt::format(" {:.0f}", 100 * c.covered_share());
        covered += c.covered_share() / 6;
        doubtful += c.doubtful_share() / 6;
        seconds += dipped.cpu_s;
      }
      return fmt::format("| {} |{} |{} |{} |{} | {:.1f} | {:.1f} | {:.0f} |", model.name, steps,
                         unconverged, iterations, covered_each, 100 * covered, 100 * doubtful,
                         seconds);
    });
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

void show_rounds(Tables& tables, const std::vector<Named>& models) {
  tables.begin(
      "| model, printed with squares | rounds | settled | mean change of what is promised, round "
      "by round (mm) | s of cpu |");
  for (const Named& model : models)
    tables.row("rounds " + model.name, [&] {
      const auto object = object_of(model.shape);
      const PosedObject posed(object, {});
      DesignOptions options;
      options.film = letter(40000);
      RunContext context;
      Timings timings;
      const std::clock_t start = std::clock();
      const Squares squares(*object);
      const Designed designed =
          design({posed, squares, Allotment(), *make_device_model(), options}, timings, context);
      std::string changes;
      for (const InkRound& round : designed.ink.rounds)
        if (&round != &designed.ink.rounds.front())
          changes += fmt::format(" {:.2g}", round.change_mm);
      return fmt::format("| {} | {} | {} |{} | {:.0f} |", model.name, designed.ink.rounds.size(),
                         designed.ink.settled ? "yes" : "no", changes,
                         double(std::clock() - start) / CLOCKS_PER_SEC);
    });
}

int run(const std::vector<std::string>& words) {
  const std::set<std::string> all_parts = {"circles", "meshes", "doubt", "times", "list", "rounds"};
  std::string folder, log;
  std::set<std::string> parts, names;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--log" && i + 1 < words.size())
      log = words[++i];
    else if (all_parts.count(words[i]))
      parts.insert(words[i]);
    else if (std::filesystem::is_directory(words[i]))
      folder = words[i];
    else
      names.insert(words[i]);
  }
  std::vector<Named> models = shapes::torn_models(folder);
  if (!names.empty())
    std::erase_if(models, [&](const Named& model) { return !names.erase(model.name); });
  if (!names.empty()) {
    fmt::print(stderr, "no part or model is called '{}'\n", *names.begin());
    return 2;
  }
  fmt::print("{} models\n", models.size());
  const auto wanted = [&](const char* part) { return parts.empty() || parts.count(part) > 0; };
  Tables tables(log);
  if (wanted("circles")) show_circles(tables);
  if (wanted("meshes")) show_meshes(tables, models);
  if (wanted("doubt")) show_doubt(tables, models);
  if (wanted("times")) show_times(tables);
  if (wanted("list")) show_list(tables, models);
  if (wanted("rounds")) show_rounds(tables, models);
  return 0;
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) { return hydrodip::run({argv + 1, argv + argc}); }
