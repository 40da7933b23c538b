#include "render/maps.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/plain_number.h"
#include "base/run_scope.h"
#include "render/canvas.h"
#include "render/color_ramp.h"
#include "render/lit_view.h"

namespace hydrodip {
namespace {

// Surface that the water just reaches counts as wet.
constexpr double kWetSlack_mm = 1e-6;

constexpr double kCrease_deg = 30;
constexpr double kFlatness = 0.6;
constexpr double kHatch = 17;  // from stripe to stripe, in lengths of the layout

constexpr LinearColor kNeutral{0.36f, 0.36f, 0.36f, 1};
constexpr LinearColor kAir{0.32f, 0.13f, 0.52f, 1};
constexpr LinearColor kTornDark{0.50f, 0.0f, 0.025f, 1};
constexpr LinearColor kTornLight{1, 1, 1, 1};

const ColorRamp& gentle_ramp() {
  static const ColorRamp ramp({0.34, 0.13, 268}, {0.64, 0.12, 235}, {0.93, 0.05, 195});
  return ramp;
}

const ColorRamp& steep_ramp() {
  static const ColorRamp ramp({0.74, 0.16, 60}, {0.54, 0.17, 36}, {0.32, 0.11, 22});
  return ramp;
}

const ColorRamp& stretch_ramp() {
  static const ColorRamp ramp({0.30, 0.13, 288}, {0.61, 0.10, 195}, {0.93, 0.17, 104});
  return ramp;
}

// --- Page ---

struct MapLayout : ViewLayout {
  int header = 0, legend = 0, footer = 0;

  int cell_x(int column) const { return margin + column * (cell_width + gap); }
};

MapLayout make_layout(const ViewLayout& views, const MapOptions& options) {
  MapLayout layout{views};
  layout.header = layout.px(86);
  layout.legend = layout.px(205);
  layout.footer = options.caption.empty() ? layout.margin : layout.px(72);
  return layout;
}

TextStyle style(const MapLayout& layout, double size, const LinearColor& color) {
  return text_style(size * layout.unit, color);
}

void draw_title(Image& page, const MapLayout& layout, const std::string& text, double center_px) {
  draw_centered(page, text, center_px, layout.header - 31 * layout.unit,
                style(layout, 25, kTitleInk));
}

void draw_caption(Image& page, const MapLayout& layout, const std::string& caption) {
  const TextStyle line = style(layout, 17, kLabelInk);
  const std::string shown = fit_text(caption, line, layout.width - 2.0 * layout.margin);
  draw_centered(page, shown, 0.5 * layout.width, page.height_px - 30 * layout.unit, line);
}

// --- Legends ---

bool on_dark_stripe(double along, double period) {
  return along - period * std::floor(along / period) < 0.5 * period;
}

LinearColor mixed(const LinearColor& a, const LinearColor& b, float share) {
  const auto mix = [share](float x, float y) { return (1 - share) * x + share * y; };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b), 1};
}

// A legend in the making: a bar, ticks below it, patches beside it. Starts at (x, y), in pixels;
// lengths in those of the layout.
class Legend {
 public:
  Legend(Image& page, const MapLayout& layout, double x, double y)
      : page_(page), layout_(layout), x_(x), y_(y) {}

  static constexpr double kBarTop = 84, kBarHeight = 30;

  void label(const std::string& text, double center) {
    draw_centered(page_, text, at(center), y_ + 36 * layout_.unit, style(layout_, 17, kLabelInk));
  }

  template <typename ColorAt>
  void bar(double from, double to, ColorAt color_at) {
    const int x0 = column(from), x1 = column(to);
    for (int x = x0; x < x1; ++x) {
      fill(page_, x, row(kBarTop), x + 1, row(kBarTop + kBarHeight),
           color_at((x + 0.5 - x0) / (x1 - x0)));
    }
    outline(from, to);
  }

  // A bar that is more and more hatched: share_at(t) in [0, 1], color_at(t) below.
  template <typename ShareAt, typename ColorAt>
  void hatched(double from, double to, ShareAt share_at, ColorAt color_at) {
    const int x0 = column(from), x1 = column(to);
    for (int y = row(kBarTop); y < row(kBarTop + kBarHeight); ++y) {
      for (int x = x0; x < x1; ++x) {
        const bool dark = on_dark_stripe((x + y) * std::sqrt(0.5), kHatch * layout_.unit);
        const double t = (x + 0.5 - x0) / (x1 - x0);
        fill(page_, x, y, x + 1, y + 1,
             mixed(color_at(t), dark ? kTornDark : kTornLight, float(share_at(t))));
      }
    }
    outline(from, to);
  }

  void tick(double place, const std::string& text) {
    line_down(place, kBarTop + kBarHeight, kBarTop + kBarHeight + 8);
    note(text, place, 0);
  }

  // A limit: a line through the bar, named above it.
  void limit(double place, const std::string& text) {
    line_down(place, kBarTop - 8, kBarTop + kBarHeight + 8);
    draw_centered(page_, text, at(place), y_ + (kBarTop - 13) * layout_.unit,
                  style(layout_, 15, kTitleInk));
  }

  // Text under the bar, in line 0 or 1.
  void note(const std::string& text, double center, int line) {
    draw_centered(page_, text, at(center),
                  y_ + (kBarTop + kBarHeight + 28 + 23 * line) * layout_.unit,
                  style(layout_, 15, kLabelInk));
  }

 private:
  double at(double x) const { return x_ + x * layout_.unit; }
  int column(double x) const { return int(std::lround(at(x))); }
  int row(double y) const { return int(std::lround(y_ + y * layout_.unit)); }

  void line_down(double x, double top, double bottom) {
    const int thick = std::max(1, layout_.px(2));
    const int left = column(x) - thick / 2;
    fill(page_, left, row(top), left + thick, row(bottom), kTitleInk);
  }

  void outline(double from, double to) {
    const int x0 = column(from), x1 = column(to), y0 = row(kBarTop), y1 = row(kBarTop + kBarHeight);
    fill(page_, x0, y0, x1, y0 + 1, kLabelInk);
    fill(page_, x0, y1 - 1, x1, y1, kLabelInk);
    fill(page_, x0, y0, x0 + 1, y1, kLabelInk);
    fill(page_, x1 - 1, y0, x1, y1, kLabelInk);
  }

  Image& page_;
  const MapLayout& layout_;
  double x_, y_;
};

LinearColor neutral(double) { return kNeutral; }

// 700 wide.
void draw_angle_legend(Legend legend, bool some_stays_dry, bool some_is_in_air) {
  constexpr double kFrom = 20;
  const double to = some_is_in_air ? 460 : 540, patch = some_is_in_air ? 520 : 600;
  const auto place = [&](double angle_deg) { return kFrom + (to - kFrom) * angle_deg / 90; };
  legend.label("angle between surface normal and dipping direction", 350);
  legend.bar(kFrom, to, [](double t) { return angle_color(std::min(90 * t, 89.8)); });
  for (int angle = 0; angle <= 90; angle += 15) {
    legend.tick(place(angle), fmt::format("{}\u00b0", angle));
  }
  legend.limit(place(kDipAngleLimit_deg), fmt::format("limit {:.0f}\u00b0", kDipAngleLimit_deg));
  legend.note("flat to the water", place(0) + 52, 1);
  legend.note("steeper: film may tear", place(67.5), 1);
  legend.bar(patch, patch + 70, neutral);
  legend.note("upright or", patch + 35, 0);
  legend.note(some_stays_dry ? "up, or dry" : "facing up", patch + 35, 1);
  if (!some_is_in_air) return;
  legend.bar(630, 700, [](double) { return kAir; });
  legend.note("trapped", 665, 0);
  legend.note("air", 665, 1);
}

double tick_spacing(double range) {
  for (const double step : {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0}) {
    if (range / step <= 5.5) return step;
  }
  return range / 4;
}

// 700 wide.
void draw_stretch_legend(Legend legend, double largest, const MapOptions& options) {
  constexpr double kFrom = 20;
  const bool tears = options.tear_stretch > 0;
  const double to = tears ? 380 : 540;
  const auto place = [&](double stretch) {
    return kFrom + (to - kFrom) * (stretch - 1) / (largest - 1);
  };
  legend.label("largest stretch of the film, times its flat length", 350);
  const DoubtfulStretch& doubtful = options.doubtful;
  // As far beyond the limit as is doubtful.
  const double end = std::max(largest, doubtful.to), reach = std::min(540.0, place(end));
  const auto stretch_at = [&](double t) {
    return 1 + t * (reach - kFrom) / (to - kFrom) * (largest - 1);
  };
  legend.hatched(
      kFrom, reach, [&](double t) { return doubtful.of(stretch_at(t), 0); },
      [&](double t) { return stretch_color(stretch_at(t), largest); });
  const double spacing = tick_spacing(largest - 1);
  for (int i = 0; 1 + i * spacing <= largest + 1e-9; ++i) {
    legend.tick(place(1 + i * spacing),
                fmt::format("{:.{}f}", 1 + i * spacing, spacing < 0.1 ? 2 : 1));
  }
  legend.note("unstretched", place(1) + 45, 1);
  if (tears) {
    if (reach < 540)
      legend.hatched(
          reach, 540, [](double) { return 1.0; }, [](double) { return kNeutral; });
    legend.limit(to, fmt::format("printed up to {:.2f}", largest));
    if (doubtful.to > 0) legend.note("may tear", place(std::min(doubtful.from + 0.06, largest)), 1);
    legend.note("lost", 0.5 * (std::max(reach, 0.5 * (to + 540)) + 540), 0);
  }
  legend.bar(600, 670, neutral);
  legend.note("no film", 635, 0);
}

// --- Views ---

double mm_per_px(const TriangleMesh& object, const Camera& camera, int width_px) {
  const double distance = (camera.eye - object.bounds().center()).dot(camera.back);
  return 2 * camera.half_width * distance / width_px;
}

Appearance appearance_in(const MapScene& scene, const Camera& camera, const ViewLayout& layout) {
  return map_appearance(scene, camera,
                        kHatch * layout.unit * mm_per_px(scene.object, camera, layout.cell_width));
}

bool some_stays_dry(const TriangleMesh& object, const DippingDirection& direction_at) {
  return std::ranges::any_of(object.positions,
                             [&](const Vec3& p) { return !direction_at(p, kWetSlack_mm); });
}

}  // namespace

std::vector<CornerNormals> map_normals(const TriangleMesh& object) {
  return corner_normals(object.positions, object.triangles, kCrease_deg);
}

double angle_at(const TriangleMesh& object, const std::vector<CornerNormals>& normals,
                const SurfacePoint& point, const Vec3& direction) {
  const Vec3 smooth = normal_between(normals[std::size_t(point.triangle)], point.u, point.v);
  return dip_angle_deg(smooth.isZero() ? face_normal(object, point.triangle) : smooth, direction);
}

LinearColor angle_color(double angle_deg) {
  if (!faces_down(angle_deg)) return kNeutral;
  if (!beyond_dip_limit(angle_deg)) return gentle_ramp().at(angle_deg / kDipAngleLimit_deg);
  return steep_ramp().at((angle_deg - kDipAngleLimit_deg) / (90 - kDipAngleLimit_deg));
}

LinearColor stretch_color(double stretch, double largest) {
  return stretch_ramp().at((stretch - 1) / (largest - 1));
}

double stretch_scale_end(const DippedFilm& film, double tear_stretch) {
  if (tear_stretch > 0) return std::max(tear_stretch, 1.01);
  double most = 1.1;
  for (std::size_t v = 0; v < film.stretch.size(); ++v) {
    if (film.state[v] == VertexState::kAttached) most = std::max(most, film.stretch[v]);
  }
  return std::ceil(10 * most - 1e-9) / 10;
}

// How plain stripes are at least where nothing is printed.
constexpr double kLeastOfUnprinted = 0.5;

Appearance map_appearance(const MapScene& scene, const Camera& camera, double hatch_mm) {
  const Vec3 diagonal = (camera.right - camera.up) * std::sqrt(0.5);
  Appearance appearance;
  appearance.wanted = [&scene](const SurfacePoint& point, const Vec3& position, const Vec3&) {
    const auto direction = scene.direction_at(position, kWetSlack_mm);
    if (!direction) return kNeutral;
    if (scene.in_air && scene.in_air(point.triangle, position)) return kAir;
    return angle_color(angle_at(scene.object, scene.normals, point, *direction));
  };
  appearance.predicted = [&scene, diagonal, hatch_mm](const SurfacePoint& point,
                                                      const Vec3& position, const Vec3&) {
    const auto hold = scene.map ? scene.map->lying_at(point).hold : std::nullopt;
    if (!hold) return kNeutral;
    const LinearColor& stripe =
        on_dark_stripe(position.dot(diagonal), hatch_mm) ? kTornDark : kTornLight;
    const bool known = scene.doubtful.to > 0 && !hold->let_go;
    double lost = known ? scene.doubtful.of(hold->stretch, hold->moved_mm) : !hold->whole;
    if (!hold->whole) lost = std::max(lost, kLeastOfUnprinted);
    return mixed(stretch_color(hold->stretch, scene.largest_stretch), stripe, float(lost));
  };
  return appearance;
}

Image render_maps(const TriangleMesh& object, const Surface& surface, const DippedFilm& film,
                  const FilmMap& map, const MapOptions& options, const RunContext& context) {
  const RunScope scope(context);
  const TellingViews views(object, surface,
                           telling_directions(object, surface, film, options.standing),
                           options.width_px, options.standing, context);
  return render_maps(views, object, film, map, options, context);
}

Image render_maps(const TellingViews& views, const TriangleMesh& object, const DippedFilm& film,
                  const FilmMap& map, const MapOptions& options, const RunContext& context) {
  const RunScope scope(context);
  const std::string activity = "drawing the maps";
  context.progress(activity, 0);
  const std::vector<CornerNormals> normals = map_normals(object);
  const DippingDirection direction_at =
      options.direction_at ? options.direction_at : straight_down_to(film.depth_mm);
  const MapScene scene{object,          normals, direction_at,
                       options.in_air,  &map,    stretch_scale_end(film, options.tear_stretch),
                       options.doubtful};
  const MapLayout layout = make_layout(views.layout(), options);

  const int views_height = layout.cell_height[0] + layout.gap + layout.cell_height[1];
  Image page =
      blank_page(layout.width, layout.header + views_height + layout.legend + layout.footer);
  int y = layout.header;
  for (std::size_t i = 0; i < 2; ++i) {
    context.progress(activity, 0.1 + 0.45 * double(i));
    const ViewPair pair =
        views.view(i).show(appearance_in(scene, views.camera(i), layout), {normals, kFlatness});
    paste(page, pair.wanted, layout.cell_x(0), y);
    paste(page, pair.predicted, layout.cell_x(1), y);
    y += layout.cell_height[i] + layout.gap;
  }
  const auto center = [&](int column) { return layout.cell_x(column) + 0.5 * layout.cell_width; };
  draw_title(page, layout, "dipping angle", center(0));
  draw_title(page, layout, "film: stretch, doubt and tears", center(1));
  const auto legend = [&](int column) {
    return Legend(page, layout, center(column) - 350 * layout.unit, y);
  };
  draw_angle_legend(legend(0), some_stays_dry(object, direction_at), bool(options.in_air));
  draw_stretch_legend(legend(1), scene.largest_stretch, options);
  draw_caption(page, layout, options.caption);
  context.progress(activity, 1);
  return page;
}

Image render_angle_map(const TriangleMesh& object, const Surface& surface,
                       const DippingDirection& direction_at, const MapOptions& options,
                       const RunContext& context) {
  const RunScope scope(context);
  const std::string activity = "drawing the angle map";
  context.progress(activity, 0);
  const std::vector<CornerNormals> normals = map_normals(object);
  const MapScene scene{object, normals, direction_at, options.in_air};
  const std::array<Vec3, 2> directions =
      telling_directions(object, surface, DippedFilm{}, options.standing);
  const MapLayout layout =
      make_layout(ViewLayout(object, directions, options.width_px, options.standing), options);

  const int height = std::max(layout.cell_height[0], layout.cell_height[1]);
  Image page = blank_page(layout.width, layout.header + height + layout.legend + layout.footer);
  for (int i = 0; i < 2; ++i) {
    context.progress(activity, 0.1 + 0.45 * i);
    const Camera camera = frame_object(object, directions[std::size_t(i)],
                                       double(layout.cell_width) / height, 0.80, options.standing);
    const LitView view({object, surface, normals}, camera, layout.cell_width, height, context);
    const ViewPair pair = view.show(appearance_in(scene, camera, layout), {normals, kFlatness});
    paste(page, pair.wanted, layout.cell_x(i), layout.header);
  }
  draw_title(page, layout, "dipping angle, from two sides", 0.5 * layout.width);
  draw_angle_legend(
      Legend(page, layout, 0.5 * layout.width - 350 * layout.unit, layout.header + height),
      some_stays_dry(object, direction_at), bool(options.in_air));
  draw_caption(page, layout, options.caption);
  context.progress(activity, 1);
  return page;
}

std::string map_caption(const DipAngles& angles, const Coverage* coverage) {
  std::string text = fmt::format("{} of the surface that faces down is steeper than {:.0f}\u00b0",
                                 percent(angles.over_limit_share()), kDipAngleLimit_deg);
  if (coverage && coverage->torn_mm2 > 0)
    text += fmt::format("; {} of the film that meets the object is torn",
                        percent(coverage->torn_share()));
  else if (coverage)
    text += "; no film is torn";
  return text;
}

}  // namespace hydrodip
