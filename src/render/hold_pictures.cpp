#include "render/hold_pictures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/run_scope.h"
#include "render/canvas.h"
#include "render/lit_view.h"
#include "render/normals.h"
#include "render/view.h"

namespace hydrodip {
namespace {

// The camera's up is +y: the object lies on its back so that its own up is up.
Vec3 upright(const Vec3& p) { return {p.x(), p.z(), -p.y()}; }

constexpr double kAspect = 4.0 / 3;

// Of a page of rows, each with two pictures side by side between a title and a caption.
struct Layout {
  double unit;  // px of this page for each of one that is 1600 px wide
  int width, margin, gap, header, footer, cell_width, cell_height, row;

  explicit Layout(int width_px) : width(std::clamp(width_px, 64, kWidestPicture_px)) {
    unit = width / 1600.0;
    const auto px = [&](double length) { return int(std::lround(length * unit)); };
    margin = px(28);
    gap = px(12);
    header = footer = px(64);
    cell_width = std::max(8, (width - 2 * margin - gap) / 2);
    cell_height = std::max(8, int(std::lround(0.5 * cell_width * kAspect)));
    row = header + cell_height + footer;
  }
  int below_left() const { return margin + cell_width + gap; }
};

constexpr float kDryPaleness = 0.55F;

LinearColor paler(const LinearColor& c) {
  const auto mix = [](float v) { return v + kDryPaleness * (0.75F - v); };
  return {mix(c.r), mix(c.g), mix(c.b), 1};
}

// One picture of it: upright, or as it is.
Image picture(const HoldPicture& hold, bool from_below, int width_px, int height_px,
              const RunContext& context) {
  const auto turned = [&](const Vec3& p) { return from_below ? p : upright(p); };
  std::vector<Vec3> positions;
  positions.reserve(hold.object.positions.size());
  for (const Vec3& p : hold.object.positions) positions.push_back(turned(p));
  const Surface surface(positions, hold.object.triangles);
  TriangleMesh mesh;
  mesh.positions = std::move(positions);
  mesh.triangles = hold.object.triangles;
  const std::vector<CornerNormals> normals = corner_normals(mesh.positions, mesh.triangles);
  Appearance appearance;
  appearance.wanted = [&](const SurfacePoint& point, const Vec3&, const Vec3&) {
    const Vec3 position = position_at(hold.object, point);
    const LinearColor color = hold.look(point, position, face_normal(hold.object, point.triangle));
    return position.z() > hold.depth_mm ? paler(color) : color;
  };
  appearance.predicted = appearance.wanted;
  const Vec3 direction = from_below ? Vec3(-Vec3::UnitZ()) : Vec3(0.25, -0.22, 1).normalized();
  const Camera camera = frame_object(mesh, direction, double(width_px) / height_px, 0.82);
  const LitObject lit{mesh, surface, normals};
  return LitView(lit, camera, width_px, height_px, context).show(appearance).wanted;
}

}  // namespace

Image render_holds(const std::vector<HoldPicture>& holds, int width_px, const RunContext& context) {
  const RunScope scope(context);
  const std::string stage = "drawing the ways to hold it";
  const Layout layout(width_px);
  const double unit = layout.unit;
  const int width = layout.width, margin = layout.margin, header = layout.header, row = layout.row,
            cell_width = layout.cell_width, cell_height = layout.cell_height;
  Image page = blank_page(width, std::max(8, int(holds.size()) * row));
  const TextStyle title = text_style(25 * unit, kTitleInk), line = text_style(19 * unit, kLabelInk);
  const double room = width - 2.0 * margin;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    context.progress(stage, double(i) / double(holds.size()));
    const int top = int(i) * row;
    draw_centered(page, fit_text(holds[i].title, title, room), 0.5 * width, top + 42 * unit, title);
    paste(page, picture(holds[i], false, cell_width, cell_height, context), margin, top + header);
    paste(page, picture(holds[i], true, cell_width, cell_height, context), layout.below_left(),
          top + header);
    draw_centered(page, fit_text(holds[i].caption, line, room), 0.5 * width,
                  top + header + cell_height + 34 * unit, line);
  }
  context.progress(stage, 1);
  return page;
}

HoldPlace hold_from_below(int page_width_px, int row) {
  const Layout layout(page_width_px);
  return {layout.below_left(), row * layout.row + layout.header, layout.cell_width,
          layout.cell_height};
}

}  // namespace hydrodip
