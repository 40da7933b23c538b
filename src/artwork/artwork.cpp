#include "artwork/artwork.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "artwork/placement.h"
#include "artwork/projector.h"
#include "base/error.h"
#include "base/run_scope.h"

namespace hydrodip {
namespace {

// A layer may show nothing where this little of it would be seen.
constexpr float kNothing = 1.0F / 1024;

struct Layer {
  Pixels pixels;
  PictureFrame frame;
  std::unique_ptr<const Placement> placement;  // none: on the film
  Vec2 film_centre_mm{0, 0};
  float opacity;
  Blend blend;
};

// Premultiplied.
LinearColor shown_by(const Layer& layer, const Vec2& place_mm, float share) {
  LinearColor color = sample(layer.pixels, layer.frame, place_mm);
  const float part = layer.opacity * share;
  return {part * color.r, part * color.g, part * color.b, part * color.a};
}

LinearColor over(const LinearColor& top, Blend blend, const LinearColor& under) {
  const float rest = 1 - top.a;
  if (blend == Blend::kNormal)
    return {top.r + rest * under.r, top.g + rest * under.g, top.b + rest * under.b, 1};
  return {(top.r + rest) * under.r, (top.g + rest) * under.g, (top.b + rest) * under.b, 1};
}

class LayeredPaint : public Paint {
 public:
  LayeredPaint(PosedObject posed, std::shared_ptr<const Paint> under)
      : Paint(under->base()), posed_(std::move(posed)), under_(std::move(under)) {}

  void add(Layer layer) { layers_.push_back(std::move(layer)); }
  const PosedObject& posed() const { return posed_; }

  LinearColor color_at(const SurfacePoint& point) const override { return color(point, nullptr); }
  LinearColor color_on_film(const SurfacePoint& point, const Vec2& film_mm) const override {
    return color(point, &film_mm);
  }
  bool depends_on_film() const override {
    return std::any_of(layers_.begin(), layers_.end(),
                       [](const Layer& layer) { return !layer.placement; });
  }
  bool says_anything() const override { return true; }
  bool shows(std::size_t layer, const SurfacePoint& point) const {
    return shown(layers_[layer], point, nullptr).a >= kNothing;
  }

 private:
  // From the top down to the first layer that hides all below, and back up again.
  LinearColor color(const SurfacePoint& point, const Vec2* film_mm) const {
    constexpr std::size_t kAtOnce = 8;
    std::array<LinearColor, kAtOnce> seen;
    std::array<std::size_t, kAtOnce> from;
    std::size_t count = 0, next = layers_.size();
    bool hidden = false;
    while (next > 0 && count < kAtOnce && !hidden) {
      --next;
      const LinearColor color = shown(layers_[next], point, film_mm);
      if (color.a < kNothing) continue;
      hidden = color.a >= 1 && layers_[next].blend == Blend::kNormal;
      seen[count] = color;
      from[count++] = next;
    }
    LinearColor result = hidden ? LinearColor{0, 0, 0, 1} : under_at(next, point, film_mm);
    while (count > 0) {
      --count;
      result = over(seen[count], layers_[from[count]].blend, result);
    }
    return result;
  }

  // What lies below the topmost layers: those that did not fit at once, and the object's colours.
  LinearColor under_at(std::size_t layers, const SurfacePoint& point, const Vec2* film_mm) const {
    LinearColor result = under_->color_at(point);
    for (std::size_t n = 0; n < layers; ++n)
      result = over(shown(layers_[n], point, film_mm), layers_[n].blend, result);
    return result;
  }

  static LinearColor shown(const Layer& layer, const SurfacePoint& point, const Vec2* film_mm) {
    constexpr LinearColor kClear{0, 0, 0, 0};
    if (!layer.placement)
      return film_mm ? shown_by(layer, *film_mm - layer.film_centre_mm, 1) : kClear;
    Spot spot;
    if (!layer.placement->find(point, spot)) return kClear;
    const LinearColor color = shown_by(layer, spot.place_mm, spot.share);
    return color.a >= kNothing && layer.placement->is_lit(point) ? color : kClear;
  }

  PosedObject posed_;
  std::shared_ptr<const Paint> under_;
  std::vector<Layer> layers_;
};

// ---- whether a picture lies on the object at all ----

bool lies_within(const PictureFrame& frame, const Vec2& place_mm) {
  const Vec2 t = frame.to_picture(place_mm);
  return frame.repeat() != Repeat::kOnce || (t.x() >= 0 && t.x() <= 1 && t.y() >= 0 && t.y() <= 1);
}

// Looks for a place where a picture shows: triangles are cut into four wherever the picture may lie
// on them, so that none is too small to be found on large ones.
class Search {
 public:
  Search(const Layer& layer, const TriangleMesh& mesh)
      : layer_(layer),
        mesh_(mesh),
        finest_mm_(std::max(layer.frame.size_mm().minCoeff() / kPerPicture,
                            layer.frame.size_mm().maxCoeff() / kPerLength)) {}

  bool finds(std::size_t triangle) const {
    const Triangle& v = mesh_.triangles[triangle];
    const Vec3& a = mesh_.positions[std::size_t(v[0])];
    const Vec3& b = mesh_.positions[std::size_t(v[1])];
    const Vec3& c = mesh_.positions[std::size_t(v[2])];
    const double edge_mm = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    // Where nothing is known of a part, or the picture goes on for ever, it is cut no finer.
    const double coarse_mm = std::max(finest_mm_, edge_mm / kPerTriangle);
    return finds_in(int(triangle), {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}, edge_mm, coarse_mm);
  }

 private:
  static constexpr double kPerPicture = 48, kPerLength = 4000, kPerTriangle = 256;

  bool finds_in(int triangle, const std::array<Vec2, 3>& part, double edge_mm,
                double coarse_mm) const {
    check_cancelled();
    const Vec2 middle = (part[0] + part[1] + part[2]) / 3;
    Spot spot;
    const SurfacePoint point{triangle, middle.x(), middle.y()};
    if (layer_.placement->find(point, spot) && lies_within(layer_.frame, spot.place_mm) &&
        layer_.placement->is_lit(point))
      return true;
    bool known = layer_.frame.repeat() == Repeat::kOnce;
    Box2 box;
    for (const Vec2& corner : part) {
      known &= layer_.placement->find({triangle, corner.x(), corner.y()}, spot);
      if (known) box.add(spot.place_mm);
    }
    if (known) {
      const Vec2 bulge = box.max - box.min;  // if the picture's plane is a curved one
      box.min -= bulge;
      box.max += bulge;
      if (layer_.frame.misses(box)) return false;
    }
    if (edge_mm <= (known ? finest_mm_ : coarse_mm)) return false;
    const Vec2 ab = 0.5 * (part[0] + part[1]), bc = 0.5 * (part[1] + part[2]),
               ca = 0.5 * (part[2] + part[0]);
    const std::array<std::array<Vec2, 3>, 4> quarters = {
        {{ab, bc, ca}, {part[0], ab, ca}, {ab, part[1], bc}, {ca, bc, part[2]}}};
    return std::any_of(quarters.begin(), quarters.end(), [&](const auto& quarter) {
      return finds_in(triangle, quarter, 0.5 * edge_mm, coarse_mm);
    });
  }

  const Layer& layer_;
  const TriangleMesh& mesh_;
  double finest_mm_;
};

bool hits(const Layer& layer, const TriangleMesh& mesh) {
  const Search search(layer, mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (search.finds(t)) return true;
  return false;
}

// print.dpi goes no higher.
constexpr double kFinestPrint_dpi = 1200;

// No size may be given so; a row of pixels has it by itself.
bool is_line(const PictureFrame& frame) {
  return frame.size_mm().maxCoeff() > 1000 * frame.size_mm().minCoeff();
}

// That a picture which is there once is thinner than a pixel, and how to mend it. Empty: it is not.
std::string told_thin(const std::string& name, const Vec2& size_mm, Repeat repeat, double dpi) {
  const double pixel_mm = kMmPerInch / dpi;
  if (repeat != Repeat::kOnce || size_mm.minCoeff() >= pixel_mm) return "";
  return fmt::format(
      "{}: it is laid {:.3g} x {:.3g} mm, thinner than a printed pixel ({:.2g} mm); give it width "
      "and height with --art-size W,H",
      name, size_mm.x(), size_mm.y(), pixel_mm);
}

void refuse_thin(const ArtworkLayer& layer, const PictureFrame& frame, double dpi) {
  const std::string thin = told_thin(name_of(layer), frame.size_mm(), frame.repeat(), dpi);
  if (!thin.empty()) throw InputError(thin);
}

[[noreturn]] void refuse_miss(const ArtworkLayer& layer, const PosedObject& posed) {
  const ModelFrame frame(posed);
  std::string where = "the model has no surface there";
  if (layer.at_mm) {
    if (const auto hit = posed.surface().closest_point(frame.point(*layer.at_mm), 1e9))
      where = fmt::format(
          "from {} the surface is nearest at {} (mm, in the model's frame after --size)",
          as_given(*layer.at_mm), as_given(frame.back(posed.surface().position(*hit))));
  }
  throw InputError(
      fmt::format("{}: the artwork hits nothing of the model, or only what is hidden from its "
                  "side: {}; move it with --art-at, or turn it with --art-toward",
                  name_of(layer), where));
}

// ---- laying ----

bool is_black(const LinearColor& c) { return c.r == 0 && c.g == 0 && c.b == 0 && c.a == 1; }

void warn_of_words_for_text(const ArtworkLayer& layer, const RunContext& context) {
  if (layer.text.empty() && (layer.font != ArtworkLayer().font || !is_black(layer.text_color)))
    context.warn(
        fmt::format("{}: font and colour mean nothing to a picture, only to text", name_of(layer)));
}

void warn_of_up_across_axis(const ArtworkLayer& layer, const RunContext& context) {
  constexpr double kAcross = 0.2;  // cosine: nearly at right angles
  const bool round =
      layer.projection == Projection::kCylinder || layer.projection == Projection::kSphere;
  if (round && layer.up && layer.toward &&
      std::abs(layer.up->normalized().dot(layer.toward->normalized())) < kAcross)
    context.warn(fmt::format(
        "{}: its up lies across the axis, along which a picture around it stands: it says nothing; "
        "turn it with --art-turn",
        name_of(layer)));
}

// What is said of a layer though its projection has no use for it.
void warn_of_idle_words(const ArtworkLayer& layer, const RunContext& context) {
  const bool uv = layer.projection == Projection::kUv, film = layer.projection == Projection::kFilm;
  if (!uv && !film && layer.projection != Projection::kWrap) return;
  std::string idle;
  const auto add = [&](bool said, const char* what) {
    if (said) idle += (idle.empty() ? "" : ", ") + std::string(what);
  };
  add(uv && layer.at_mm.has_value(), "its place");
  add(layer.toward.has_value(), "its direction");
  add((uv || film) && layer.up.has_value(), "its up");
  add(uv && (layer.width_mm > 0 || layer.height_mm > 0), "its size");
  add(layer.through, "through");
  add(layer.fade_deg < 90, "fading");
  if (!idle.empty())
    context.warn(fmt::format("{}: {} means nothing to artwork that is {}", name_of(layer), idle,
                             uv     ? "laid by UVs"
                             : film ? "left on the film"
                                    : "wrapped"));
}

// Film is read from above on the water, and from its other side on the object.
void warn_of_mirrored_text(const ArtworkLayer& layer, const RunContext& context) {
  if (layer.projection == Projection::kFilm && !layer.text.empty())
    context.warn(fmt::format(
        "{}: on the film it reads as it stands, on the object in mirror writing; lay it on the "
        "object by another --projection",
        name_of(layer)));
}

void warn_of_coarse(const ArtworkLayer& layer, double share, double dpi,
                    const RunContext& context) {
  if (share < 1)
    context.warn(
        fmt::format("{}: so large a drawing takes too much memory; it is drawn as for {:.0f} dpi "
                    "instead of {:.0f}: edges are softer",
                    name_of(layer), std::floor(share * dpi), dpi));
}

// "'a.png', 'b.png' and 3 more are".
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 5;
  std::string text;
  for (std::size_t n = 0; n < std::min(names.size(), kNamed); ++n) {
    const bool last = n + 1 == names.size();
    text += (n == 0 ? "'" : last ? " and '" : ", '") + names[n] + "'";
  }
  if (names.size() > kNamed) text += fmt::format(" and {} more", names.size() - kNamed);
  return text + (names.size() == 1 ? " is" : " are");
}

void warn_of_what_lies_outside(const ArtworkLayer& layer, const PictureSource& picture,
                               const RunContext& context) {
  const SvgContents contents = picture.contents();
  if (!contents.outside.empty())
    context.warn(fmt::format("{}: {} not in the drawing's file and not shown; embed {}",
                             name_of(layer), listed(contents.outside),
                             contents.outside.size() == 1 ? "it" : "them"));
  if (contents.unreadable_pictures > 0)
    context.warn(fmt::format(
        "{}: {} in the drawing is damaged or of a kind that is not read, and not shown; embed it "
        "again as PNG or JPEG",
        name_of(layer),
        contents.unreadable_pictures == 1
            ? "a picture"
            : fmt::format("each of {} pictures", contents.unreadable_pictures)));
  if (contents.has_text)
    context.warn(fmt::format(
        "{}: its text is set in the fonts of this machine; convert it to paths in the drawing "
        "program if it must look the same everywhere",
        name_of(layer)));
  const std::vector<FontUse> fonts = picture.fonts();
  if (!fonts.empty() && !fonts.front().is_wanted)
    context.warn(fmt::format("{}: the font '{}' is not installed; {} is taken instead",
                             name_of(layer), layer.font, fonts.front().name));
}

void warn_of_wrap(const ArtworkLayer& layer, const WrapReport& report, const RunContext& context) {
  // A repeated picture goes on to where the surface comes round to itself.
  if (layer.repeat != Repeat::kOnce) return;
  constexpr double kMuch = 1.5;
  if (report.folded_mm2 > 0)
    context.warn(fmt::format(
        "{}: wrapped, the picture folds over itself on {:.1f} mm2 of the surface; make it smaller "
        "or move its centre",
        name_of(layer), report.folded_mm2));
  else if (report.stretch_most > kMuch || report.stretch_least < 1 / kMuch)
    context.warn(fmt::format(
        "{}: wrapped, the picture is stretched {:.2f} to {:.2f} times where the surface is curved; "
        "make it smaller or move its centre",
        name_of(layer), report.stretch_least, report.stretch_most));
}

Placed place(const PlacementTask& task, LaidLayer& laid, const RunContext& context) {
  switch (task.layer.projection) {
    case Projection::kUv:
      return place_by_uv(task);
    case Projection::kWrap: {
      WrapReport report;
      Placed placed = place_wrapped(task, report);
      warn_of_wrap(task.layer, report, context);
      laid.stretch_least = report.stretch_least;
      laid.stretch_most = report.stretch_most;
      return placed;
    }
    default:
      return place_pushed(task);
  }
}

// On the film a picture has its own size, or a hand's width.
Vec2 size_on_film(const ArtworkLayer& layer, const PictureSource& picture,
                  const RunContext& context) {
  constexpr double kUsual_mm = 100;
  if (layer.width_mm > 0 && layer.height_mm > 0) return {layer.width_mm, layer.height_mm};
  double width = layer.width_mm;
  if (!(width > 0) && layer.height_mm > 0) width = layer.height_mm * picture.aspect();
  if (!(width > 0)) width = picture.natural_width_mm();
  if (!(width > 0)) {
    width = kUsual_mm;
    context.warn(fmt::format(
        "{}: nothing says how large it is on the film; it is laid {:g} mm wide (--art-size)",
        name_of(layer), width));
  }
  return {width, width / picture.aspect()};
}

Layer lay(const ArtworkLayer& wanted, PictureSource& picture, const ArtworkTask& task,
          const PosedObject& posed, LaidLayer& laid, const RunContext& context) {
  warn_of_words_for_text(wanted, context);
  warn_of_up_across_axis(wanted, context);
  warn_of_idle_words(wanted, context);
  warn_of_mirrored_text(wanted, context);
  warn_of_what_lies_outside(wanted, picture, context);
  Placed placed;
  if (wanted.projection == Projection::kFilm)
    placed = {nullptr, size_on_film(wanted, picture, context), wanted};
  else
    placed = place({wanted, picture.aspect(), posed, task.closed}, laid, context);
  laid.layer = std::move(placed.layer);
  laid.has_chosen_place =
      !wanted.toward && !wanted.at_mm && (laid.layer.toward || laid.layer.at_mm);
  const double pixels_per_mm = task.dpi / kMmPerInch * task.samples_per_axis;
  PictureSource::Shown shown = picture.pixels(placed.size_mm, pixels_per_mm);
  warn_of_coarse(wanted, shown.share, task.dpi, context);
  Layer layer{std::move(shown.pixels),
              PictureFrame(placed.size_mm, wanted.turn_deg, wanted.repeat),
              std::move(placed.placement),
              wanted.at_mm ? Vec2(wanted.at_mm->head<2>()) : Vec2(Vec2::Zero()),
              float(wanted.opacity),
              wanted.blend};
  if (!layer.pixels.shows_anything())
    throw InputError(name_of(wanted) +
                     ": the picture is transparent everywhere; nothing would show");
  if (is_line(layer.frame)) refuse_thin(wanted, layer.frame, kFinestPrint_dpi);
  if (layer.placement && !hits(layer, posed.mesh())) {
    refuse_thin(wanted, layer.frame, task.dpi);
    refuse_miss(wanted, posed);
  }
  return layer;
}

}  // namespace

std::string describe(const LaidLayer& layer) {
  std::string text = fmt::format("{:.1f} x {:.1f} mm", layer.size_mm.x(), layer.size_mm.y());
  if (layer.stretch_least < layer.stretch_most)
    text +=
        fmt::format(", stretched {:.2f} to {:.2f} times", layer.stretch_least, layer.stretch_most);
  for (std::size_t n = 0; n < layer.fonts.size(); ++n)
    text += (n == 0 ? ", set in " : ", ") + layer.fonts[n].name;
  return text;
}

std::string told_thin(const std::vector<LaidLayer>& layers, double dpi) {
  std::string first;
  for (const LaidLayer& laid : layers) {
    const std::string thin = told_thin(laid.name, laid.size_mm, laid.layer.repeat, dpi);
    if (thin.empty()) return "";
    if (first.empty()) first = thin;
  }
  return first;
}

std::vector<PictureSource> read_pictures(const std::vector<ArtworkLayer>& layers) {
  std::vector<PictureSource> pictures;
  pictures.reserve(layers.size());
  for (const ArtworkLayer& layer : layers) pictures.emplace_back(layer);
  return pictures;
}

Artwork lay_artwork(ArtworkTask task, const PosedObject& posed, const RunContext& context) {
  const RunScope scope(context);
  auto paint = std::make_shared<LayeredPaint>(posed, task.under);
  Artwork artwork;
  for (std::size_t n = 0; n < task.layers.size(); ++n) {
    context.progress("laying artwork", double(n) / double(task.layers.size()));
    LaidLayer laid{.name = name_of(task.layers[n]),
                   .layer = {},
                   .fonts = task.pictures[n].fonts(),
                   .shows = {}};
    Layer layer = lay(task.layers[n], task.pictures[n], task, paint->posed(), laid, context);
    laid.size_mm = layer.frame.size_mm();
    context.log(laid.name + ": " + describe(laid));
    if (layer.placement)
      laid.shows = [paint = std::shared_ptr<const LayeredPaint>(paint),
                    n](const SurfacePoint& point) { return paint->shows(n, point); };
    artwork.layers.push_back(std::move(laid));
    paint->add(std::move(layer));
  }
  context.progress("laying artwork", 1);
  artwork.paint = std::move(paint);
  return artwork;
}

}  // namespace hydrodip
