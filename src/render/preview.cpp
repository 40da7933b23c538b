#include "render/preview.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/run_scope.h"
#include "render/canvas.h"
#include "render/lit_view.h"
#include "render/text.h"
#include "render/view.h"

namespace hydrodip {
namespace {

// Where everything goes, in pixels.
struct PageLayout {
  const ViewLayout& views;
  int height = 0;
  int header = 0, footer = 0;

  PageLayout(const ViewLayout& layout, bool has_caption)
      : views(layout), header(layout.px(86)), footer(has_caption ? layout.px(84) : layout.margin) {
    height = header + layout.cell_height[0] + layout.gap + layout.cell_height[1] + footer;
  }
};

void write_labels(Image& page, const PageLayout& layout, const PreviewPair& pair) {
  const TextStyle title = text_style(25 * layout.views.unit, kTitleInk);
  for (std::size_t i = 0; i < 2; ++i) {
    const double center = layout.views.margin + 0.5 * layout.views.cell_width +
                          double(i) * (layout.views.cell_width + layout.views.gap);
    draw_centered(page, pair.titles[i], center, layout.header - 31 * layout.views.unit, title);
  }
  const TextStyle line = text_style(19 * layout.views.unit, kLabelInk);
  const double room = layout.views.width - 2.0 * layout.views.margin;
  const std::vector<std::string> lines = fit_lines(pair.caption, line, room, 2);
  double above = lines.size() > 1 ? 50 : 35;
  for (const std::string& shown : lines) {
    draw_centered(page, shown, 0.5 * layout.views.width, layout.height - above * layout.views.unit,
                  line);
    above -= 32;
  }
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
  const auto directions = options.told.empty()
                              ? telling_directions(object, surface, film, options.standing)
                              : telling_directions(object, surface, options.told, options.standing);
  const TellingViews views(object, surface, directions, options.width_px, options.standing,
                           context);
  return render_previews(views, pairs, options.base, context);
}

std::vector<Image> render_previews(const TellingViews& views, const std::vector<PreviewPair>& pairs,
                                   const LinearColor& base, const RunContext& context) {
  const RunScope scope(context);
  const std::string stage = "drawing the preview";
  context.progress(stage, 0);
  const ViewLayout& cells = views.layout();
  std::vector<Image> pages;
  std::array<Image, 2> firsts_right;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const PageLayout layout(cells, !pairs[n].caption.empty());
    Image page = blank_page(cells.width, layout.height);
    for (std::size_t i = 0; i < 2; ++i) {
      context.progress(stage, (double(n) + 0.5 * double(i)) / double(pairs.size()));
      const int y = layout.header + (i == 0 ? 0 : cells.cell_height[0] + cells.gap);
      ViewPair seen = views.view(i).show(completed(pairs[n].shown, base));
      const Image& left = pairs[n].left_is_firsts_right ? firsts_right[i] : seen.wanted;
      paste(page, left, cells.margin, y);
      paste(page, seen.predicted, cells.margin + cells.cell_width + cells.gap, y);
      if (n == 0) firsts_right[i] = std::move(seen.predicted);
    }
    write_labels(page, layout, pairs[n]);
    pages.push_back(std::move(page));
  }
  context.progress(stage, 1);
  return pages;
}

}  // namespace hydrodip
