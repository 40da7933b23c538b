// The film: a triangle mesh over its flat, printed state, and where it is now.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/math.h"
#include "film/correction.h"

namespace hydrodip {

enum class FilmShape { kRectangle, kDisc };

struct FilmOptions {
  double width_mm = 210;                    // whole sheet, x
  double height_mm = 297;                   // whole sheet, y
  FilmShape shape = FilmShape::kRectangle;  // disc: inscribed in the smaller extent
  double margin_mm = 10;  // taped; the free film ends this far inside the edge, clamped there
  int elements = 40000;   // triangles, met as nearly as the grid allows
  // Cell size at the rim over that at the centre, where the object comes down; 1: all alike.
  double grading = 4;
  // Lengths of the floating film over the printed sheet's, along x and y: film swells on the water.
  double swelling_x = 1, swelling_y = 1;
  // Null: none.
  std::shared_ptr<const FilmCorrection> correction = {};
};

// The mesh of the free film, made as the options say. Film coordinates u: mm, origin at the film's
// centre, seen from above. A regular grid whose lines draw together towards the centre (cell size
// along an axis: quadratic in the line's number), each cell cut along one diagonal in alternation,
// so that the pattern is symmetric under mirroring and (on a square) quarter turns. On a disc,
// vertices next to the rim are moved onto it.
struct FilmMesh {
  FilmOptions options;
  std::vector<Vec2> u;               // per vertex: on the printed sheet
  std::vector<Vec2> wet;             // per vertex: flat on the water; empty: as printed
  std::vector<Triangle> triangles;   // counter-clockwise in u
  std::vector<std::uint8_t> on_rim;  // per vertex: clamped
  double cell_mm = 0;                // mean distance of grid lines (larger of the two axes)

  // Row-major grid behind the mesh, for multigrid and look-up: vertex_at[j * nx + i] or -1.
  int nx = 0, ny = 0;                  // vertices along x, y
  std::vector<double> line_x, line_y;  // mm, coordinates of the grid's lines, ascending
  std::vector<std::int32_t> vertex_at;
  std::vector<std::int32_t> first_in_cell;  // [j * (nx - 1) + i]: lowest triangle there, or -1

  // neighbor[t][k]: triangle across the edge opposite corner k, or -1.
  std::vector<std::array<std::int32_t, 3>> neighbor;
  // Triangles around vertex v: incident[incident_begin[v] .. incident_begin[v + 1]).
  std::vector<std::int32_t> incident_begin;
  std::vector<std::int32_t> incident;
};

// Half its width and height; of a disc, its radius. Throws InputError if the margin leaves no film.
Vec2 half_of_free_film(const FilmOptions& options);

// Whether the point of the sheet is inside the taped margin's inner edge.
bool is_free(const FilmOptions& options, const Vec2& u);

// The grid is regular where the film model puts it: a correction moves u, and swelling makes `wet`.
// Throws InputError if the margin leaves no film, there are fewer than 8 triangles, or a correction
// folds the film.
FilmMesh make_film_mesh(const FilmOptions& options);

// Coordinates of a grid's lines, mm, ascending from rim to rim. An even number of cells each,
// mirror images of each other about 0, so that the alternating diagonals are symmetric.
struct GridLines {
  std::vector<double> x, y;
};

// The same on lines of one's own; the options' `elements` and `grading` do not matter.
FilmMesh make_film_mesh(const FilmOptions& options, const GridLines& lines);

// The same film as a mesh whose u is the mesh's `wet`: what floats, without a thought of what was
// printed. For a mesh that has `wet`.
FilmMesh floating_mesh(const FilmMesh& mesh);

// A mesh that its dips share; never null.
using SharedFilmMesh = std::shared_ptr<const FilmMesh>;

// Film state over a mesh after (or during) a dip.
enum class VertexState : std::uint8_t { kUnattached = 0, kAttached = 1, kClamped = 2 };

// Film that lies further elsewhere if torn film falls another way is not promised.
inline constexpr double kMoved_mm = 0.3;

// The result of a dip: where the film is. Posed-object frame (mm).
struct DippedFilm {
  SharedFilmMesh shared_mesh = std::make_shared<const FilmMesh>();
  std::vector<Vec3> position;      // per vertex
  std::vector<VertexState> state;  // per vertex
  std::vector<double> area_ratio;  // per vertex: deformed over printed area (Voronoi areas)
  std::vector<double> stretch;     // per vertex: largest principal stretch around it, from the
                                   // floating film's flat state on
  std::vector<std::uint8_t> torn;  // per triangle: all of it, or on the object upside down
  // Per triangle: how far the object had travelled (straight down: its depth) when it let go;
  // infinity: it did not.
  std::vector<double> torn_at_mm;
  // Per vertex: how far film here lies elsewhere if torn film falls another way, mm. Empty: nothing
  // tears, or nobody has asked.
  std::vector<double> moved_mm;
  // Per vertex, linear over triangles: how far beyond what is promised film is that lies here;
  // above 0 it is torn, or its place is not known. Empty: nowhere.
  std::vector<double> excess;
  // On the object, pressed together to less than material.wrinkle_stretch; per triangle.
  std::vector<std::uint8_t> wrinkled;
  // Attached, and lifted out of the water again while the object went on; per vertex.
  std::vector<std::uint8_t> lifted;
  double depth_mm = 0;  // of the object's deepest point, in the end
  // What a height of the object counted for as film was laid on it (FilmMaterial::z_stretch), and
  // per vertex which way was up then; empty: along z.
  double z_stretch = 1;
  std::vector<Vec3> up;
  // Per vertex: the object's outward unit normal where it is attached, else zero. Empty: nobody has
  // looked.
  std::vector<Vec3> normal;

  const FilmMesh& mesh() const { return *shared_mesh; }
  // A triangle whose corners are all attached and that is not torn, or not all of it: film that
  // lies on the object.
  bool lies_on_object(std::size_t triangle) const;
  // At a vertex; not above 0: whole.
  double excess_of(std::int32_t vertex) const {
    return excess.empty() ? 0 : excess[std::size_t(vertex)];
  }
  // Of such a triangle: how far a place of it is beyond what is promised; not above 0: it is whole.
  double excess_at(std::size_t triangle, const Vec3& weight) const;
  bool is_whole_at(std::size_t triangle, const Vec3& weight) const {
    return !(excess_at(triangle, weight) > 0);
  }
  // The whole part of a triangle that lies on the object: a convex polygon, as weights of corners;
  // no corners: nothing is.
  struct Part {
    std::array<Vec3, 4> corner;
    std::size_t corners = 0;
    // Of its side from this corner to the next: the triangle's side opposite this corner; 3: it is
    // the line along which the triangle is torn.
    std::array<std::uint8_t, 4> side{};
    double share = 0;  // of the triangle's area
  };
  Part whole_part(std::size_t triangle) const;
};

}  // namespace hydrodip
