#include "render/preview.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/run_scope.h"
#include "render/canvas.h"
#include "render/studio.h"
#include "render/text.h"
#include "render/view.h"

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

PageLayout make_layout(const TriangleMesh& object, const std::array<Vec3, 2>& directions,
                       const PreviewOptions& options, bool has_caption) {
  PageLayout layout;
  layout.width = std::clamp(options.width_px, 64, kWidestPicture_px);
  layout.unit = layout.width / 1600.0;
  const auto px = [&](double length) { return int(std::lround(length * layout.unit)); };
  layout.margin = px(28);
  layout.gap = px(12);
  layout.header = px(86);
  layout.footer = has_caption ? px(84) : layout.margin;
  layout.cell_width = (layout.width - 2 * layout.margin - layout.gap) / 2;
  layout.height = layout.header + layout.gap + layout.footer;
  for (std::size_t i = 0; i < 2; ++i) {
    const double share =
        std::clamp(1 / projected_aspect(object, directions[i], options.standing), 0.55, 0.95);
    layout.cell_height[i] = std::max(8, int(std::lround(share * layout.cell_width)));
    layout.height += layout.cell_height[i];
  }
  return layout;
}

void write_labels(Image& page, const PageLayout& layout, const PreviewPair& pair) {
  TextStyle title;
  title.size_px = 25 * layout.unit;
  title.color = kTitleInk;
  for (std::size_t i = 0; i < 2; ++i) {
    const double center =
        layout.margin + 0.5 * layout.cell_width + double(i) * (layout.cell_width + layout.gap);
    draw_centered(page, pair.titles[i], center, layout.header - 31 * layout.unit, title);
  }
  TextStyle line;
  line.size_px = 19 * layout.unit;
  line.color = kLabelInk;
  const double room = layout.width - 2.0 * layout.margin;
  const std::string shown = fit_text(pair.caption, line, room);
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

std::vector<Image> render_previews(const TriangleMesh& object, const Surface& surface,
                                   const DippedFilm& film, const std::vector<PreviewPair>& pairs,
                                   const PreviewOptions& options, const RunContext& context) {
  const RunScope scope(context);
  const std::string stage = "drawing the preview";
  context.progress(stage, 0);
  const std::vector<CornerNormals> normals = corner_normals(object.positions, object.triangles);
  const Studio studio{object, surface, normals};
  const std::array<Vec3, 2> directions =
      options.whole ? telling_directions_of_all(object, surface, options.standing)
                    : telling_directions(object, surface, film, options.standing);

  std::vector<PageLayout> layouts;
  std::vector<Image> pages;
  for (const PreviewPair& pair : pairs) {
    layouts.push_back(make_layout(object, directions, options, !pair.caption.empty()));
    pages.push_back(blank_page(layouts.back().width, layouts.back().height));
  }
  for (std::size_t i = 0; i < 2 && !pairs.empty(); ++i) {
    context.progress(stage, 0.1 + 0.45 * double(i));
    const int width = layouts[0].cell_width, height = layouts[0].cell_height[i];
    const Camera camera =
        frame_object(object, directions[i], double(width) / height, 0.80, options.standing);
    const LitView view(studio, camera, width, height, context);
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const PageLayout& layout = layouts[n];
      const int y = layout.header + (i == 0 ? 0 : layout.cell_height[0] + layout.gap);
      const ViewPair seen = view.show(completed(pairs[n].shown, options.base));
      paste(pages[n], seen.wanted, layout.margin, y);
      paste(pages[n], seen.predicted, layout.margin + width + layout.gap, y);
    }
  }
  for (std::size_t n = 0; n < pairs.size(); ++n) write_labels(pages[n], layouts[n], pairs[n]);
  context.progress(stage, 1);
  return pages;
}

}  // namespace hydrodip
