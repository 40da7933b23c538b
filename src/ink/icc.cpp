// The only place that knows Little CMS.
#include <fmt/format.h>
#include <lcms2.h>

#include <algorithm>
#include <array>
#include <memory>

#include "base/error.h"
#include "base/run_scope.h"
#include "image/lcms_handles.h"
#include "image/shown_columns.h"
#include "ink/color_model.h"
#include "ink/profiles.h"
#include "ink/rgb_profile.h"

namespace hydrodip {

namespace {

using Context = lcms::Context;
using Profile = lcms::Profile;
using Transform = lcms::Transform;
struct FreePipeline {
  void operator()(cmsPipeline* pipeline) const { cmsPipelineFree(pipeline); }
};
using Pipeline = std::unique_ptr<cmsPipeline, FreePipeline>;

Context quiet_context() { return Context(cmsCreateContext(nullptr, nullptr)); }

// Bytes of a profile, without the time at which they were made.
std::vector<std::uint8_t> profile_bytes(cmsHPROFILE profile) {
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::vector<std::uint8_t> bytes(size);
  if (size < 128 || !cmsSaveProfileToMem(profile, bytes.data(), &size))
    throw std::runtime_error("an ICC profile could not be composed");
  constexpr std::array<std::uint8_t, 12> kDate = {0x07, 0xE8, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0};
  std::copy(kDate.begin(), kDate.end(), bytes.begin() + 24);
  return bytes;
}

void describe(cmsContext context, cmsHPROFILE profile, const char* description) {
  cmsMLU* text = cmsMLUalloc(context, 1);
  cmsMLUsetASCII(text, "en", "US", description);
  cmsWriteTag(profile, cmsSigProfileDescriptionTag, text);
  cmsMLUsetASCII(text, "en", "US", "No copyright, use freely");
  cmsWriteTag(profile, cmsSigCopyrightTag, text);
  cmsMLUfree(text);
}

cmsUInt32Number intent_code(RenderingIntent intent) {
  switch (intent) {
    case RenderingIntent::kPerceptual:
      return INTENT_PERCEPTUAL;
    case RenderingIntent::kSaturation:
      return INTENT_SATURATION;
    case RenderingIntent::kAbsolute:
      return INTENT_ABSOLUTE_COLORIMETRIC;
    case RenderingIntent::kRelative:
      break;
  }
  return INTENT_RELATIVE_COLORIMETRIC;
}

Profile open_profile(cmsContext context, const std::vector<std::uint8_t>& bytes) {
  return Profile(
      cmsOpenProfileFromMemTHR(context, bytes.data(), static_cast<cmsUInt32Number>(bytes.size())));
}

// Of the way from colours to a printer.
cmsUInt32Number flags_for(cmsUInt32Number intent) {
  return cmsFLAGS_NOCACHE |
         (intent == INTENT_RELATIVE_COLORIMETRIC ? cmsFLAGS_BLACKPOINTCOMPENSATION : 0U);
}

std::string description_of(cmsHPROFILE profile) {
  std::array<char, 256> text{};
  cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text.data(), text.size());
  text.back() = 0;
  return text.data();
}

class ProfileModel : public ColorModel {
 public:
  ProfileModel(std::vector<std::uint8_t> bytes, const std::string& name, RenderingIntent intent)
      : bytes_(std::move(bytes)), context_(quiet_context()) {
    const auto refuse = [&](const std::string& why) {
      throw InputError(fmt::format(
          "{}: {}; give the ICC profile of a CMYK or RGB printer, or leave --printer-profile out",
          name, why));
    };
    const Profile printer = open_profile(context_.get(), bytes_);
    if (!printer) refuse("is not an ICC profile");
    if (cmsGetColorSpace(printer.get()) != cmsSigCmykData)
      refuse("is a profile of neither CMYK inks nor RGB");
    const Profile srgb(cmsCreate_sRGBProfileTHR(context_.get()));
    const cmsUInt32Number code = intent_code(intent);
    separate_.reset(cmsCreateTransformTHR(context_.get(), srgb.get(), TYPE_RGB_FLT, printer.get(),
                                          TYPE_CMYK_FLT, code, flags_for(code)));
    // What it looks like does not depend on how the inks were chosen.
    const cmsUInt32Number seen = code == INTENT_ABSOLUTE_COLORIMETRIC
                                     ? INTENT_ABSOLUTE_COLORIMETRIC
                                     : INTENT_RELATIVE_COLORIMETRIC;
    look_.reset(cmsCreateTransformTHR(context_.get(), printer.get(), TYPE_CMYK_FLT, srgb.get(),
                                      TYPE_RGB_FLT, seen,
                                      cmsFLAGS_NOCACHE | cmsFLAGS_BLACKPOINTCOMPENSATION));
    if (!separate_ || !look_) refuse("cannot be used in both directions");
    name_ = description_of(printer.get());
    if (name_.empty()) name_ = name;
  }

  void separate(const SrgbColor* colors, Inks* inks, std::size_t count) const override {
    static_assert(sizeof(SrgbColor) == 3 * sizeof(float) && sizeof(Inks) == 4 * sizeof(float));
    cmsDoTransform(separate_.get(), colors, inks, static_cast<cmsUInt32Number>(count));
    for (std::size_t i = 0; i < count; ++i) {
      const auto amount = [](float percent) { return std::clamp(percent / 100, 0.0f, 1.0f); };
      inks[i] = {amount(inks[i].c), amount(inks[i].m), amount(inks[i].y), amount(inks[i].k)};
    }
  }

  void look(const Inks* inks, SrgbColor* colors, std::size_t count) const override {
    const auto percent = [](float amount) { return 100 * std::clamp(amount, 0.0f, 1.0f); };
    std::vector<Inks> percents(count);
    for (std::size_t i = 0; i < count; ++i)
      percents[i] = {percent(inks[i].c), percent(inks[i].m), percent(inks[i].y),
                     percent(inks[i].k)};
    cmsDoTransform(look_.get(), percents.data(), colors, static_cast<cmsUInt32Number>(count));
    for (std::size_t i = 0; i < count; ++i) {
      SrgbColor& seen = colors[i];
      seen = {std::clamp(seen.r, 0.0f, 1.0f), std::clamp(seen.g, 0.0f, 1.0f),
              std::clamp(seen.b, 0.0f, 1.0f)};
    }
  }

  std::string name() const override { return name_; }
  const std::vector<std::uint8_t>& profile() const override { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
  std::string name_;
  Context context_;  // outlives the transforms
  Transform separate_, look_;
};

// ---- the device formula as a profile ----

constexpr int kInkNodes = 11, kLabNodes = 21;

cmsCIELab lab_of(const SrgbColor& color) {
  const auto linear = [](float v) {
    return v <= 0.04045F ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const double r = linear(color.r), g = linear(color.g), b = linear(color.b);
  // sRGB to XYZ under D50 (Bradford adapted), as in every sRGB profile.
  const cmsCIEXYZ xyz = {0.4360747 * r + 0.3850649 * g + 0.1430804 * b,
                         0.2225045 * r + 0.7168786 * g + 0.0606169 * b,
                         0.0139322 * r + 0.0971045 * g + 0.7141733 * b};
  cmsCIELab lab;
  cmsXYZ2Lab(nullptr, &lab, &xyz);
  return lab;
}

SrgbColor srgb_of(const cmsCIELab& lab) {
  cmsCIEXYZ xyz;
  cmsLab2XYZ(nullptr, &xyz, &lab);
  const auto encoded = [](double v) {
    v = std::clamp(v, 0.0, 1.0);
    return static_cast<float>(v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
  };
  return {encoded(3.1338561 * xyz.X - 1.6168667 * xyz.Y - 0.4906146 * xyz.Z),
          encoded(-0.9787684 * xyz.X + 1.9161415 * xyz.Y + 0.0334540 * xyz.Z),
          encoded(0.0719453 * xyz.X - 0.2289914 * xyz.Y + 1.4052427 * xyz.Z)};
}

cmsInt32Number sample_look(const cmsUInt16Number in[], cmsUInt16Number out[], void*) {
  const auto amount = [](cmsUInt16Number v) { return static_cast<float>(v) / 65535.0F; };
  const cmsCIELab lab =
      lab_of(device_look({amount(in[0]), amount(in[1]), amount(in[2]), amount(in[3])}));
  cmsFloat2LabEncodedV2(out, &lab);
  return 1;
}

cmsInt32Number sample_inks(const cmsUInt16Number in[], cmsUInt16Number out[], void*) {
  cmsCIELab lab;
  cmsLabEncoded2FloatV2(&lab, in);
  const Inks inks = device_inks(srgb_of(lab));
  const std::array<float, 4> amounts = {inks.c, inks.m, inks.y, inks.k};
  for (std::size_t i = 0; i < 4; ++i)
    out[i] = static_cast<cmsUInt16Number>(std::lround(65535 * std::clamp(amounts[i], 0.F, 1.F)));
  return 1;
}

void write_table(cmsContext context, cmsHPROFILE profile, const std::vector<cmsTagSignature>& tags,
                 int nodes, int inputs, int outputs, cmsSAMPLER16 sampler) {
  const Pipeline pipeline(cmsPipelineAlloc(context, static_cast<cmsUInt32Number>(inputs),
                                           static_cast<cmsUInt32Number>(outputs)));
  cmsStage* table = cmsStageAllocCLut16bit(context, static_cast<cmsUInt32Number>(nodes),
                                           static_cast<cmsUInt32Number>(inputs),
                                           static_cast<cmsUInt32Number>(outputs), nullptr);
  cmsStageSampleCLut16bit(table, sampler, nullptr, 0);
  cmsPipelineInsertStage(pipeline.get(), cmsAT_END, table);
  cmsWriteTag(profile, tags.front(), pipeline.get());
  for (std::size_t i = 1; i < tags.size(); ++i) cmsLinkTag(profile, tags[i], tags.front());
}

}  // namespace

std::vector<std::uint8_t> make_device_profile() {
  const Context context = quiet_context();
  const Profile profile(cmsCreateProfilePlaceholder(context.get()));
  cmsSetProfileVersion(profile.get(), 2.1);
  cmsSetDeviceClass(profile.get(), cmsSigOutputClass);
  cmsSetColorSpace(profile.get(), cmsSigCmykData);
  cmsSetPCS(profile.get(), cmsSigLabData);
  describe(context.get(), profile.get(), "hydrodip device formula");
  cmsWriteTag(profile.get(), cmsSigMediaWhitePointTag, cmsD50_XYZ());
  write_table(context.get(), profile.get(), {cmsSigAToB0Tag, cmsSigAToB1Tag, cmsSigAToB2Tag},
              kInkNodes, 4, 3, sample_look);
  write_table(context.get(), profile.get(), {cmsSigBToA0Tag, cmsSigBToA1Tag, cmsSigBToA2Tag},
              kLabNodes, 3, 4, sample_inks);
  return profile_bytes(profile.get());
}

std::unique_ptr<ColorModel> make_profile_model(std::vector<std::uint8_t> profile,
                                               const std::string& name, RenderingIntent intent) {
  return std::make_unique<ProfileModel>(std::move(profile), name, intent);
}

bool is_rgb_profile(const std::vector<std::uint8_t>& bytes) {
  const Context context = quiet_context();
  const Profile profile = open_profile(context.get(), bytes);
  return profile && cmsGetColorSpace(profile.get()) == cmsSigRgbData;
}

Image in_printer_rgb(Image image, const std::vector<std::uint8_t>& profile, const std::string& name,
                     RenderingIntent intent) {
  const Context context = quiet_context();
  const Profile printer = open_profile(context.get(), profile);
  const Profile srgb(cmsCreate_sRGBProfileTHR(context.get()));
  const cmsUInt32Number code = intent_code(intent);
  const Transform transform(printer ? cmsCreateTransformTHR(context.get(), srgb.get(), TYPE_RGBA_8,
                                                            printer.get(), TYPE_RGBA_8, code,
                                                            flags_for(code) | cmsFLAGS_COPY_ALPHA)
                                    : nullptr);
  if (!transform)
    throw InputError(fmt::format(
        "{}: cannot be used to print; give the ICC profile of a CMYK or RGB printer, or leave "
        "--printer-profile out",
        name));
  for (int y = 0; y < image.height_px; ++y) {
    check_cancelled();
    const Columns shown = shown_columns(image, y);
    if (shown.empty()) continue;
    std::uint8_t* row = image.pixel(shown.begin, y);
    cmsDoTransform(transform.get(), row, row,
                   static_cast<cmsUInt32Number>(shown.end - shown.begin));
  }
  return image;
}

std::filesystem::path installed_cmyk_profile() {
  for (const char* file : {"/usr/share/color/icc/colord/FOGRA39L_coated.icc",
                           "/usr/share/color/icc/ghostscript/default_cmyk.icc"}) {
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) return file;
  }
  return {};
}

const std::vector<std::uint8_t>& srgb_profile() {
  static const std::vector<std::uint8_t> bytes = [] {
    const Context context = quiet_context();
    const Profile profile(cmsCreate_sRGBProfileTHR(context.get()));
    cmsSetProfileVersion(profile.get(), 2.1);  // read by everything
    return profile_bytes(profile.get());
  }();
  return bytes;
}

}  // namespace hydrodip
