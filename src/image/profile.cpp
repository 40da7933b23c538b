// Pictures' own colour spaces: the only place in this folder that knows Little CMS.
#include <lcms2.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include "base/run_scope.h"
#include "image/decoders.h"
#include "image/lcms_handles.h"

namespace hydrodip {

namespace {

using Context = lcms::Context;
using Profile = lcms::Profile;
using Transform = lcms::Transform;
struct FreeCurve {
  void operator()(cmsToneCurve* curve) const { cmsFreeToneCurve(curve); }
};
using Curve = std::unique_ptr<cmsToneCurve, FreeCurve>;

// A byte or two of rounding: not worth touching every pixel for.
bool changes_nothing(cmsHTRANSFORM transform) {
  constexpr int kSteps = 9, kRounding = 2;
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const int level[] = {i % kSteps, i / kSteps % kSteps, i / kSteps / kSteps};
    std::array<std::uint8_t, 4> in{0, 0, 0, 255}, out{};
    for (std::size_t c = 0; c < 3; ++c) in[c] = std::uint8_t(level[c] * 255 / (kSteps - 1));
    cmsDoTransform(transform, in.data(), out.data(), 1);
    for (std::size_t c = 0; c < 3; ++c)
      if (std::abs(int(in[c]) - int(out[c])) > kRounding) return false;
  }
  return true;
}

bool is_grey(const Image& image) {
  CheckEvery check(1 << 16);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    check();
    if (image.rgba[i] != image.rgba[i + 1] || image.rgba[i] != image.rgba[i + 2]) return false;
  }
  return true;
}

// Red, green and blue are one value. False if there is no way from there.
bool transform_grey(Image& image, cmsContext context, cmsHPROFILE from) {
  const Profile srgb(cmsCreate_sRGBProfileTHR(context));
  const Transform transform(cmsCreateTransformTHR(context, from, TYPE_GRAY_8, srgb.get(),
                                                  TYPE_RGB_8, INTENT_RELATIVE_COLORIMETRIC, 0));
  if (!transform) return false;
  std::array<std::uint8_t, 256> levels{};
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = std::uint8_t(i);
  std::array<std::uint8_t, 3 * 256> shown{};
  cmsDoTransform(transform.get(), levels.data(), shown.data(), cmsUInt32Number(levels.size()));
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    std::copy_n(&shown[3U * image.rgba[i]], 3, &image.rgba[i]);
  return true;
}

void transform_rows(Image& image, cmsHTRANSFORM transform) {
  for (int y = 0; y < image.height_px; ++y) {
    check_cancelled();
    cmsDoTransform(transform, image.pixel(0, y), image.pixel(0, y),
                   cmsUInt32Number(image.width_px));
  }
}

// Stored::kLab's codings.
cmsCIELab lab_of_bytes(const std::uint8_t* in) {
  return {in[0] / 2.55, in[1] - 128.0, in[2] - 128.0};
}
cmsCIELab lab_of_words(const std::uint16_t* in) {
  return {in[0] * 100.0 / 0xff00, in[1] / 256.0 - 128, in[2] / 256.0 - 128};
}

bool transform_pixels(Image& image, cmsContext context, cmsHPROFILE from) {
  if (!from) return false;
  if (cmsGetColorSpace(from) == cmsSigGrayData)
    return is_grey(image) && transform_grey(image, context, from);
  if (cmsGetColorSpace(from) != cmsSigRgbData) return false;
  const Profile srgb(cmsCreate_sRGBProfileTHR(context));
  const Transform transform(cmsCreateTransformTHR(context, from, TYPE_RGBA_8, srgb.get(),
                                                  TYPE_RGBA_8, INTENT_RELATIVE_COLORIMETRIC,
                                                  cmsFLAGS_COPY_ALPHA));
  if (!transform) return false;
  if (!changes_nothing(transform.get())) transform_rows(image, transform.get());
  return true;
}

// None if colours cannot be told from it.
Transform ink_transform(cmsContext context, const PictureBytes& profile, cmsUInt32Number flags) {
  const Profile from(
      cmsOpenProfileFromMemTHR(context, profile.data(), cmsUInt32Number(profile.size())));
  if (!from || cmsGetColorSpace(from.get()) != cmsSigCmykData) return nullptr;
  const Profile srgb(cmsCreate_sRGBProfileTHR(context));
  return Transform(cmsCreateTransformTHR(context, from.get(), TYPE_CMYK_8, srgb.get(), TYPE_RGBA_8,
                                         INTENT_RELATIVE_COLORIMETRIC, flags));
}

// ITU-T H.273's numbers.
std::optional<cmsCIExyYTRIPLE> primaries_of(int number) {
  switch (number) {
    case 1:
      return cmsCIExyYTRIPLE{{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};
    case 9:
      return cmsCIExyYTRIPLE{{0.708, 0.292, 1}, {0.170, 0.797, 1}, {0.131, 0.046, 1}};
    case 12:
      return cmsCIExyYTRIPLE{{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}};
    default:
      return {};
  }
}

Curve curve_of(cmsContext context, int number) {
  switch (number) {
    case 1:
    case 6:
    case 14:
    case 15: {
      const cmsFloat64Number bt709[] = {1 / 0.45, 1 / 1.099, 0.099 / 1.099, 1 / 4.5, 0.081};
      return Curve(cmsBuildParametricToneCurve(context, 4, bt709));
    }
    case 4:
      return Curve(cmsBuildGamma(context, 2.2));
    case 8:
      return Curve(cmsBuildGamma(context, 1));
    case 13: {
      const cmsFloat64Number srgb[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
      return Curve(cmsBuildParametricToneCurve(context, 4, srgb));
    }
    default:
      return nullptr;
  }
}

}  // namespace

bool bring_to_srgb(Image& image, const PictureBytes& profile) {
  const Context context(cmsCreateContext(nullptr, nullptr));
  const Profile from(
      cmsOpenProfileFromMemTHR(context.get(), profile.data(), cmsUInt32Number(profile.size())));
  return transform_pixels(image, context.get(), from.get());
}

void take_ink_profile(StoredPicture& picture, PictureBytes profile) {
  if (profile.empty()) return;
  const Context context(cmsCreateContext(nullptr, nullptr));
  picture.profile_lost = !ink_transform(context.get(), profile, cmsFLAGS_NOOPTIMIZE);
  if (!picture.profile_lost) picture.profile = std::move(profile);
}

void bring_inks_to_srgb(Image& image, const PictureBytes& profile) {
  const Context context(cmsCreateContext(nullptr, nullptr));
  const Transform transform = ink_transform(context.get(), profile, 0);
  if (!transform) throw std::bad_alloc();
  for (int y = 0; y < image.height_px; ++y) {
    check_cancelled();
    std::uint8_t* row = image.pixel(0, y);
    cmsDoTransform(transform.get(), row, row, cmsUInt32Number(image.width_px));
    for (int x = 0; x < image.width_px; ++x) row[4 * x + 3] = 255;
  }
}

// In floating point: lcms' integers are up to 20 levels off where colours are saturated.
void bring_lab_to_srgb(StoredPicture& picture) {
  const Context context(cmsCreateContext(nullptr, nullptr));
  const Profile lab(cmsCreateLab4ProfileTHR(context.get(), nullptr));
  const Profile srgb(cmsCreate_sRGBProfileTHR(context.get()));
  const Transform transform(
      cmsCreateTransformTHR(context.get(), lab.get(), TYPE_Lab_DBL, srgb.get(), TYPE_RGBA_8,
                            INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE));
  if (!transform) throw std::bad_alloc();
  Image& image = picture.image;
  std::vector<cmsCIELab> row(std::size_t(image.width_px));
  for (int y = 0; y < image.height_px; ++y) {
    check_cancelled();
    for (std::size_t x = 0; x < row.size(); ++x)
      row[x] = picture.wide_lab.empty()
                   ? lab_of_bytes(image.pixel(int(x), y))
                   : lab_of_words(&picture.wide_lab[3 * (std::size_t(y) * row.size() + x)]);
    cmsDoTransform(transform.get(), row.data(), image.pixel(0, y), cmsUInt32Number(row.size()));
  }
}

bool bring_to_srgb(Image& image, const std::array<std::uint8_t, 4>& cicp) {
  const auto primaries = primaries_of(cicp[0]);
  const Context context(cmsCreateContext(nullptr, nullptr));
  const Curve curve = curve_of(context.get(), cicp[1]);
  if (!primaries || !curve || cicp[2] != 0 || cicp[3] != 1) return false;
  const cmsCIExyY white{0.3127, 0.3290, 1};
  cmsToneCurve* curves[] = {curve.get(), curve.get(), curve.get()};
  const Profile from(cmsCreateRGBProfileTHR(context.get(), &white, &*primaries, curves));
  return transform_pixels(image, context.get(), from.get());
}

}  // namespace hydrodip
