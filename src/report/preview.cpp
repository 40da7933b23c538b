#include "report/preview.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "report/canvas.h"
#include "report/studio.h"
#include "report/text.h"
#include "report/view.h"

namespace hydrodip {
namespace {

// Where everything goes, in pixels; lengths are given for a picture 1600 wide.
struct PageLayout {
  int width = 0, height = 0;
  int margin = 0, gap = 0, header = 0, footer = 0;
  int cell_width = 0;
  std::array<int, 2> cell_height{};
  double unit = 1;
};

PageLayout make_layout(const Object& object, const std::array<Vec3, 2>& directions,
                       const PreviewOptions& options) {
  PageLayout layout;
  layout.width = std::clamp(options.width_px, 64, kWidestPicture_px);
  layout.unit = layout.width / 1600.0;
  const auto px = [&](double length) { return int(std::lround(length * layout.unit)); };
  layout.margin = px(28);
  layout.gap = px(12);
  layout.header = px(86);
  layout.footer = options.caption.empty() ? layout.margin : px(84);
  layout.cell_width = (layout.width - 2 * layout.margin - layout.gap) / 2;
  layout.height = layout.header + layout.gap + layout.footer;
  for (std::size_t i = 0; i < 2; ++i) {
    const double share = std::clamp(1 / projected_aspect(object, directions[i]), 0.55, 0.95);
    layout.cell_height[i] = std::max(8, int(std::lround(share * layout.cell_width)));
    layout.height += layout.cell_height[i];
  }
  return layout;
}

void write_labels(Image& page, const PageLayout& layout, const PreviewOptions& options) {
  TextStyle title;
  title.size_px = 25 * layout.unit;
  title.color = kTitleInk;
  for (std::size_t i = 0; i < 2; ++i) {
    const double center =
        layout.margin + 0.5 * layout.cell_width + double(i) * (layout.cell_width + layout.gap);
    draw_centered(page, options.titles[i], center, layout.header - 31 * layout.unit, title);
  }
  TextStyle line;
  line.size_px = 19 * layout.unit;
  line.color = kLabelInk;
  const double room = layout.width - 2.0 * layout.margin;
  const std::string shown = fit_text(options.caption, line, room);
  draw_centered(page, shown, 0.5 * layout.width, layout.height - 35 * layout.unit, line);
}

// Fills in whatever appearance is absent.
Appearance completed(const Appearance& appearance, const LinearColor& base) {
  const auto bare = [base](const SurfacePoint&, const Vec3&, const Vec3&) { return base; };
  Appearance full = appearance;
  if (!full.wanted) full.wanted = bare;
  if (!full.predicted) full.predicted = bare;
  return full;
}

}  // namespace

Image render_preview(const Object& object, const Surface& surface, const DippedFilm& film,
                     const Appearance& appearance, const PreviewOptions& options,
                     RunContext& context) {
  const std::string stage = "drawing the preview";
  context.progress(stage, 0);
  const Appearance shown = completed(appearance, options.base);
  const std::vector<CornerNormals> normals = corner_normals(object.positions, object.triangles);
  const Studio studio{object, surface, normals, shown, std::clamp(options.samples_per_axis, 1, 8)};
  const std::array<Vec3, 2> directions = telling_directions(object, surface, film);
  const PageLayout layout = make_layout(object, directions, options);

  Image page = blank_page(layout.width, layout.height);
  int y = layout.header;
  for (std::size_t i = 0; i < 2; ++i) {
    context.progress(stage, 0.1 + 0.45 * double(i));
    const int height = layout.cell_height[i];
    const double aspect = double(layout.cell_width) / height;
    const Camera camera = frame_object(object, directions[i], aspect, 0.80);
    const ViewPair pair = render_view(studio, camera, layout.cell_width, height, context);
    paste(page, pair.wanted, layout.margin, y);
    paste(page, pair.predicted, layout.margin + layout.cell_width + layout.gap, y);
    y += height + layout.gap;
  }
  write_labels(page, layout, options);
  context.progress(stage, 1);
  return page;
}

}  // namespace hydrodip
