#include "dip/measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "dip/principal_stretch.h"
#include "film/film_normals.h"
#include "film/over_edge.h"

namespace hydrodip {

namespace {

// Voronoi share of a triangle's area at each corner; for an obtuse triangle half of it goes to the
// obtuse corner (Meyer et al. 2003, section 3.3).
std::array<double, 3> voronoi_shares(const std::array<double, 3>& squared_edge, double area) {
  // squared_edge[k] is opposite corner k.
  const auto& e = squared_edge;
  for (std::size_t k = 0; k < 3; ++k)
    if (e[k] >= e[(k + 1) % 3] + e[(k + 2) % 3]) {
      std::array<double, 3> shares{area / 4, area / 4, area / 4};
      shares[k] = area / 2;
      return shares;
    }
  std::array<double, 3> shares{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    const auto cotangent = [&](std::size_t c) {
      return (e[(c + 1) % 3] + e[(c + 2) % 3] - e[c]) / (4 * area);
    };
    shares[k] = (e[l] * cotangent(l) + e[m] * cotangent(m)) / 8;
  }
  return shares;
}

struct TriangleMeasure {
  double flat_area, area;
  double stretch, least_stretch;     // principal
  std::array<double, 3> flat_share;  // of flat_area, Voronoi
};

// Over an edge of the object a triangle's area, and how far it is pressed together, are those of
// its parts on both faces, not of the chord between them, which is too short. How far it is
// stretched is left to the film beside it: what its parts are depends on where the edge runs
// through it, and tears would follow that.
void measure_parts(const std::array<Vec2, 3>& flat, const std::array<FacePart, 2>& parts,
                   TriangleMeasure& m) {
  m.area = m.least_stretch = 0;
  for (const FacePart& part : parts) {
    const auto& [a, b, c] = part.corner;
    m.area += part.share * 0.5 * (b - a).cross(c - a).norm();
    m.least_stretch += part.share * principal_stretches(flat, part.corner).least;
  }
}

TriangleMeasure measure_triangle(const FilmMesh& film, const DippedFilm& dipped,
                                 const Surface& surface, std::size_t t) {
  const Triangle& v = film.triangles[t];
  const std::array<Vec2, 3> flat = {film.u[std::size_t(v[0])], film.u[std::size_t(v[1])],
                                    film.u[std::size_t(v[2])]};
  const TriangleOnObject on = triangle_on_object(dipped, dipped.normal, t);
  const auto& [a, b, c] = on.position;
  std::array<double, 3> squared_edge;
  for (std::size_t k = 0; k < 3; ++k)
    squared_edge[k] = (flat[(k + 1) % 3] - flat[(k + 2) % 3]).squaredNorm();
  TriangleMeasure m{};
  m.flat_area = 0.5 * cross2(flat[1] - flat[0], flat[2] - flat[0]);
  m.flat_share = voronoi_shares(squared_edge, m.flat_area);
  m.area = 0.5 * (b - a).cross(c - a).norm();
  const PrincipalStretches stretches = principal_stretches(flat, on.position);
  m.stretch = stretches.largest;
  m.least_stretch = stretches.least;
  if (const auto direction = direction_over_edge(dipped, on, surface))
    if (const auto parts = parts_over_edge(on.position, on.normal, *direction))
      measure_parts(flat, *parts, m);
  return m;
}

// Whether film that lies on the object lies there with its underside: folded over itself, or
// spanned between two parts of the object.
bool folded(const FilmMesh& film, const DipState& state, const Surface& surface, std::size_t t) {
  const Triangle& v = film.triangles[t];
  const Vec3 &a = state.position[std::size_t(v[0])], &b = state.position[std::size_t(v[1])],
             &c = state.position[std::size_t(v[2])];
  const auto below = surface.closest_point((a + b + c) / 3, 10 * film.cell_mm);
  return below && (b - a).cross(c - a).dot(surface.normal(*below)) >= 0;
}

// The bath holds it at the water.
void hold_rim(const Moment& moment, DippedFilm& film) {
  for (std::size_t v = 0; v < film.state.size(); ++v)
    if (film.state[v] == VertexState::kClamped)
      film.position[v] = moment.afloat(film.position[v].head<2>());
}

// Film that was told when to let go bears so much more, so that nothing is decided by a hair.
constexpr double kToldMargin = 1.25;

// Vertices' stretches of which the means over triangles on the object are, all but a little, those
// triangles' own: means over the triangles around a vertex alone come out too large where stretch
// grows faster and faster, and so do means of corners.
std::vector<double> sharpened_stretch(const DippedFilm& film,
                                      const std::vector<TriangleMeasure>& measures) {
  std::vector<double> above(film.stretch.size(), 0), weight(film.stretch.size(), 0);
  for (std::size_t t = 0; t < measures.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    const Triangle& v = film.mesh().triangles[t];
    double mean = 0;
    for (std::int32_t corner : v) mean += film.stretch[std::size_t(corner)] / 3;
    for (std::int32_t corner : v) {
      above[std::size_t(corner)] += measures[t].flat_area * (mean - measures[t].stretch);
      weight[std::size_t(corner)] += measures[t].flat_area;
    }
  }
  std::vector<double> stretch = film.stretch;
  for (std::size_t v = 0; v < stretch.size(); ++v)
    if (weight[v] > 0) stretch[v] -= above[v] / weight[v];
  return stretch;
}

// Triangles of which nothing is whole are torn as such.
void tear_wholly(DippedFilm& film) {
  for (std::size_t t = 0; t < film.torn.size(); ++t)
    if (film.lies_on_object(t)) {
      const Triangle& v = film.mesh().triangles[t];
      film.torn[t] =
          film.excess_of(v[0]) > 0 && film.excess_of(v[1]) > 0 && film.excess_of(v[2]) > 0;
    }
}

// Where film on the object is stretched too far, if any triangle of it is.
void tear_overstretched(const DipOptions& options, const std::vector<TriangleMeasure>& measures,
                        DippedFilm& film) {
  const double limit = options.material.tear_stretch;
  bool any = false;
  for (std::size_t t = 0; t < measures.size() && limit > 0 && !any; ++t)
    any = measures[t].stretch > limit && film.lies_on_object(t);
  if (!any) return;
  film.excess = sharpened_stretch(film, measures);
  for (double& excess : film.excess) excess -= limit;
  tear_wholly(film);
  // Whatever is around it.
  const double most = std::max(limit, options.material.lost_stretch);
  for (std::size_t t = 0; t < measures.size(); ++t)
    if (film.lies_on_object(t) && measures[t].stretch > most) film.torn[t] = 1;
}

}  // namespace

double let_go_limit(const DipOptions& options) {
  const FilmMaterial& material = options.material;
  if (!(material.tear_stretch > 0)) return 0;
  const double middle = 0.5 * (material.safe_stretch + material.lost_stretch);
  return std::max(material.tear_stretch, middle) * (options.tears_at_mm.empty() ? 1 : kToldMargin);
}

void add_moved(std::vector<double> moved_mm, const DipOptions& options, DippedFilm& film) {
  film.moved_mm = std::move(moved_mm);
  if (film.excess.empty())
    for (const double stretch : film.stretch)
      film.excess.push_back(std::min(0.0, stretch - options.material.tear_stretch));
  for (std::size_t v = 0; v < film.excess.size(); ++v)
    film.excess[v] = std::max(film.excess[v], film.moved_mm[v] - kMoved_mm);
  tear_wholly(film);
}

DippedFilm measured(const SharedFilmMesh& mesh, const DipState& state, const DipOptions& options,
                    const Surface& surface) {
  const FilmMesh& film = *mesh;
  DippedFilm result;
  result.shared_mesh = mesh;
  result.position = state.position;
  result.state = state.state;
  result.torn = state.torn;
  result.torn_at_mm = state.torn_at_mm;
  result.lifted = state.lifted;
  result.wrinkled.assign(film.triangles.size(), 0);
  result.depth_mm = state.moment.level_mm;
  result.up = state.up;
  if (options.method == DipMethod::kFull) result.z_stretch = options.material.z_stretch;
  if (state.moment.moved) hold_rim(state.moment, result);
  result.normal = film_normals(result, surface);

  const std::size_t vertices = film.u.size();
  // Vertices on the object are measured on the film that lies there; others on all around them.
  std::vector<double> flat(vertices, 0), now(vertices, 0), stretch(vertices, 0),
      weight(vertices, 0);
  std::vector<TriangleMeasure> measures(film.triangles.size());
  const auto measure = [&](std::size_t t) {
    measures[t] = measure_triangle(film, result, surface, t);
    const Triangle& v = film.triangles[t];
    const bool on_object = std::all_of(v.begin(), v.end(), [&](std::int32_t i) {
      return state.state[std::size_t(i)] == VertexState::kAttached;
    });
    if (!on_object) return;
    result.wrinkled[t] = measures[t].least_stretch < options.material.wrinkle_stretch;
    const bool told = !options.tears_at_mm.empty();
    const bool tears = (told && state.moment.travelled_mm >= options.tears_at_mm[t]) ||
                       (!told && folded(film, state, surface, t));
    if (!tears || result.torn[t]) return;
    result.torn[t] = 1;
    result.torn_at_mm[t] = state.moment.travelled_mm;
  };
  parallel_for(measures.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) measure(t);
  });
  std::vector<std::uint8_t> done(vertices, 0);
  const auto gather = [&](auto counts) {
    for (std::size_t t = 0; t < film.triangles.size(); ++t) {
      if (!counts(t)) continue;
      const TriangleMeasure& m = measures[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = std::size_t(film.triangles[t][k]);
        if (done[v]) continue;
        flat[v] += m.flat_share[k];
        now[v] += m.flat_share[k] * m.area / m.flat_area;
        stretch[v] += m.flat_area * m.stretch;
        weight[v] += m.flat_area;
      }
    }
    for (std::size_t v = 0; v < vertices; ++v) done[v] = flat[v] > 0;
  };
  gather([&](std::size_t t) { return result.lies_on_object(t); });
  gather([](std::size_t) { return true; });
  result.area_ratio.resize(vertices);
  result.stretch.resize(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    result.area_ratio[v] = flat[v] > 0 ? now[v] / flat[v] : 1;
    result.stretch[v] = weight[v] > 0 ? stretch[v] / weight[v] : 1;
  }
  tear_overstretched(options, measures, result);
  return result;
}

}  // namespace hydrodip
