#include "job/dips_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "export/scene.h"
#include "image/files.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "object/bake.h"
#include "render/preview.h"
#include "session/appearance_of.h"

namespace hydrodip {
namespace {

constexpr LinearColor kBareSurface{0.35F, 0.35F, 0.35F, 1};

// Okabe and Ito's, as people call them, and paler ones after them.
struct DipColor {
  std::array<int, 3> srgb;
  const char* name;
};
constexpr std::array<DipColor, 7> kDipColors = {{{{0, 114, 178}, "blue"},
                                                 {{230, 159, 0}, "orange"},
                                                 {{0, 158, 115}, "green"},
                                                 {{204, 121, 167}, "pink"},
                                                 {{86, 180, 233}, "sky blue"},
                                                 {{213, 94, 0}, "red"},
                                                 {{240, 228, 66}, "yellow"}}};

// "Dip 1 blue, 2 orange. "; more dips than colours have no names.
std::string legend(std::size_t dips) {
  if (dips > kDipColors.size()) return "";
  std::string text = "Dip";
  for (std::size_t k = 0; k < dips; ++k)
    text += fmt::format("{} {} {}", k > 0 ? "," : "", k + 1, kDipColors[k].name);
  return text + ". ";
}

LinearColor error_color(double difference) {
  const auto t = float(std::clamp(difference / 10, 0.0, 1.0));
  return {0.6F + 0.1F * t, 0.6F * (1 - t), 0.6F * (1 - t) * (1 - t), 1};
}

using Look = std::function<LinearColor(const SurfacePoint&)>;

// A look as a paint, to be baked.
class LookPaint : public Paint {
 public:
  LookPaint(const LinearColor& base, Look look) : Paint(base), look_(std::move(look)) {}
  LinearColor color_at(const SurfacePoint& point) const override { return look_(point); }
  bool says_anything() const override { return true; }

 private:
  Look look_;
};

LinearColor part_at(const SurfacePoint& point, const MadeDips& all, const SharedSurface& shared,
                    const Finish& finish) {
  if (!finish.has_film_at(point)) return kBareSurface;
  const TriangleMesh& model = all.prepared.posed.object();
  const std::vector<float> shares =
      shared.shares_at(position_at(model, point), face_normal(model, point.triangle));
  LinearColor color{0, 0, 0, 1};
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const LinearColor own = dip_color(k);
    color = {color.r + shares[k] * own.r, color.g + shares[k] * own.g, color.b + shares[k] * own.b,
             1};
  }
  return color;
}

// Draws what the report shows of a finish.
class FinishPictures {
 public:
  FinishPictures(const MadeDips& all, const SharedSurface& shared, const Finish& finish,
                 const FinishCheck& check)
      : all_(all),
        shared_(shared),
        finish_(finish),
        check_(check),
        posed_(all.prepared.posed.shared_object(), all.config.object.pose),
        standing_(standing_of(posed_, way_up(all.config))) {}

  DipsPictures draw(const std::string& caption, const RunContext& context) const {
    PreviewOptions options;
    options.width_px = all_.config.preview_width_px;
    options.base = finish_.paint().base();
    const std::vector<SurfacePatch> told = told_patches();
    options.told = told;
    options.standing = standing_;
    std::vector<PreviewPair> pairs(2);
    pairs[0].shown = appearance_of(finish_);
    pairs[0].caption = caption;
    pairs[1].shown.wanted = [&](const SurfacePoint& p, const Vec3&, const Vec3&) {
      return part_at(p, all_, shared_, finish_);
    };
    pairs[1].shown.predicted = [&](const SurfacePoint& p, const Vec3&, const Vec3&) {
      return error_at(p);
    };
    pairs[1].titles = {"which dip does what; grey: none",
                       "colour error: light 0, red 10; dark: no film"};
    pairs[1].caption = legend(all_.dips.size()) + about_seams();
    const std::vector<Image> pages =
        render_previews(posed_.mesh(), posed_.surface(), *all_.dips.front().made.dipped.film, pairs,
                        options, context);
    return {encode_png(pages[0]), encode_png(pages[1]), scene(told, context)};
  }

 private:
  // What shall be printed, or if that is everywhere the whole surface.
  std::vector<SurfacePatch> told_patches() const {
    const Targets& targets = all_.nodes->targets();
    const std::vector<std::uint8_t> is_wanted = wanted_at(targets, finish_.paint());
    std::vector<SurfacePatch> patches;
    for (std::size_t i = 0; i < targets.list.size(); ++i) {
      if (!is_wanted.empty() && !is_wanted[i]) continue;
      const Target node = in_pose(targets.list[i], posed_);
      patches.push_back({node.position, node.normal, node.area});
    }
    return patches;
  }

  std::string about_seams() const {
    if (!check_.films_meet())
      return fmt::format("No two films meet; colour error {:.1f}", check_.other_error());
    return fmt::format("{:.0f} mm of seams; colour error {:.1f} there, {:.1f} elsewhere",
                       shared_.seam_mm(), check_.seam_error(), check_.other_error());
  }

  LinearColor error_at(const SurfacePoint& point) const {
    if (!finish_.has_film_at(point)) return kBareSurface;
    const TriangleMesh& model = all_.prepared.posed.object();
    return error_color(
        check_.error_near(position_at(model, point), face_normal(model, point.triangle)));
  }

  std::string scene(const std::vector<SurfacePatch>& told, const RunContext& context) const {
    const TriangleMesh& mesh = posed_.mesh();
    constexpr int kWanted_px = 2048, kColors_px = 1024, kOthers_px = 512;
    const auto baked = [&](const Look& look, int most_px) {
      return painted_object(mesh, LookPaint(finish_.paint().base(), look),
                            {.most_px = most_px, .finest = kFinestTexels_per_mm});
    };
    const Object wanted = painted_object(mesh, finish_.paint(),
                                         {.most_px = kWanted_px, .finest = kFinestTexels_per_mm});
    const DippedFilm no_film;
    const DipHistory no_history;
    SceneSource source{wanted, no_film, no_history, Image()};
    source.base = finish_.paint().base();
    source.dips = int(all_.dips.size());
    source.standing = standing_;
    source.first_look = telling_directions(mesh, posed_.surface(), told, standing_)[0];
    source.looks = {
        {"none", baked([&](const auto& p) { return finish_.color_at(p); }, kColors_px)},
        {"parts",
         baked([&](const auto& p) { return part_at(p, all_, shared_, finish_); }, kOthers_px)},
        {"finish_error", baked([&](const auto& p) { return error_at(p); }, kOthers_px)}};
    return scene_json(source, context);
  }

  const MadeDips& all_;
  const SharedSurface& shared_;
  const Finish& finish_;
  const FinishCheck& check_;
  const PosedObject posed_;
  const Standing standing_;
};

}  // namespace

LinearColor dip_color(std::size_t dip) {
  const auto& c = kDipColors[dip % kDipColors.size()].srgb;
  const float pale = dip < kDipColors.size() ? 0.0F : 0.5F;
  const auto channel = [&](int v) {
    const float linear = srgb8_to_linear(std::uint8_t(v));
    return linear + pale * (1 - linear);
  };
  return {channel(c[0]), channel(c[1]), channel(c[2]), 1};
}

PaintedFinish paint_finish(const MadeDips& all, const SharedSurface& shared, const Finish& finish,
                           int texture_px) {
  const TriangleMesh& model = all.prepared.posed.object();
  const LinearColor base = finish.paint().base();
  const TextureSize size{.most_px = texture_px,
                         .finest = kFinestTexels_per_mm * all.prepared.posed.scale()};
  return {
      painted_object(model, LookPaint(base, [&](const auto& p) { return finish.color_at(p); }),
                     size),
      painted_object(
          model, LookPaint(base, [&](const auto& p) { return part_at(p, all, shared, finish); }),
          size)};
}

DipsPictures draw_dips(const MadeDips& all, const SharedSurface& shared, const Finish& finish,
                       const FinishCheck& check, const std::string& caption,
                       const RunContext& context) {
  return FinishPictures(all, shared, finish, check).draw(caption, context);
}

}  // namespace hydrodip
