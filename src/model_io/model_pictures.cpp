#include "model_io/model_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "base/parallel.h"
#include "image/files.h"

namespace hydrodip {

namespace {

// Copies for other thresholds of alpha or other ranges count too.
constexpr double kMostPixels = 1U << 30U;
// Decoded before their size is added up.
constexpr std::size_t kAtOnce = 8;

void apply_range(Image& image, float base, float gain) {
  if (base == 0 && gain == 1) return;
  std::array<std::uint8_t, 256> table{};
  for (std::size_t i = 0; i < 256; ++i)
    table[i] =
        std::uint8_t(std::lround(255 * std::clamp(base + gain * float(i) / 255, 0.0F, 1.0F)));
  CheckEvery check(1 << 20);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    check();
    if (i % 4 != 3) image.rgba[i] = table[image.rgba[i]];
  }
}

void apply_alpha(Image& image, Alpha alpha, float cutoff) {
  if (alpha == Alpha::kBlend) return;
  CheckEvery check(1 << 20);
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    check();
    const bool shows = alpha == Alpha::kOpaque || float(image.rgba[i]) >= cutoff * 255;
    image.rgba[i] = shows ? 255 : 0;
  }
}

Image decode(const FilePicture& picture, const std::filesystem::path& file, bool& was_read) {
  if (picture.embedded) {
    if (!picture.problem.empty()) throw InputError(picture.problem);
    return decode_image(picture.bytes, picture.name);
  }
  if (file.empty())
    throw InputError(
        fmt::format("The texture {} that {} refers to is missing; put it beside the model.",
                    picture.name.substr(0, 300), picture.asked_by));
  const FileBytes bytes = read_file(file);
  was_read = true;
  return decode_image(bytes, file.string());
}

}  // namespace

ModelPictures::ModelPictures(std::string model, ModelFolder& folder, const RunContext& context)
    : model_(std::move(model)), folder_(folder), context_(context) {}

void ModelPictures::expect(const FilePicture& picture, const FileMaterial& material) {
  begun(picture, material);
}

int ModelPictures::show(const FileMaterial& material) {
  Shown& shown = begun(of_model_[std::size_t(material.picture)], material);
  if (shown.number < 0) {
    shown.number = int(shown_.size());
    shown_.push_back(&shown);
  }
  return shown.number;
}

bool ModelPictures::can_be_had(int number) {
  Begun<Image>& decoded = *shown_[std::size_t(number)]->decoded;
  decoded.wait();
  return !decoded.has_failed();
}

std::vector<int> ModelPictures::take(std::vector<std::shared_ptr<const Image>>& textures,
                                     std::vector<std::string>& problems) {
  std::vector<int> places(shown_.size(), -1);
  double pixels = 0;
  for (std::size_t n = 0; n < shown_.size(); ++n) {
    if (n % kAtOnce == 0) wait_for(n, std::min(shown_.size(), n + kAtOnce));
    try {
      Image image = take(*shown_[n]);
      pixels += double(image.width_px) * image.height_px;
      places[n] = int(textures.size());
      textures.push_back(std::make_shared<const Image>(std::move(image)));
    } catch (const InputError& error) {
      tell(error.what(), problems);
    }
    if (pixels > kMostPixels)
      throw InputError(
          fmt::format("{}: its pictures would take more than {:.0f} GB of memory; scale them down.",
                      model_, 4 * kMostPixels / 1e9));
  }
  return places;
}

// One file's names are often written in several ways.
ModelPictures::Key ModelPictures::key_of(const FilePicture& picture, const FileMaterial& material) {
  std::string place = fmt::format("\n{}", material.picture);
  if (!picture.embedded) {
    place = folder_.identity(picture.name);
    if (place.empty()) place = picture.name;
  }
  return {place, material.alpha, material.alpha == Alpha::kMask ? material.alpha_cutoff : 0.0F,
          material.picture_base, material.picture_gain};
}

ModelPictures::Shown& ModelPictures::begun(const FilePicture& picture,
                                           const FileMaterial& material) {
  const auto [known, is_new] = pictures_.try_emplace(key_of(picture, material));
  Shown& shown = known->second;
  if (!is_new) return shown;
  if (!picture.embedded) shown.file = folder_.find(picture.name);
  // The list of those that are not embedded may still grow.
  const FilePicture* const embedded = picture.embedded ? &picture : nullptr;
  const FilePicture named = embedded ? FilePicture() : picture;
  shown.decoded.emplace([&shown, embedded, named, as = material] {
    Image image = decode(embedded ? *embedded : named, shown.file, shown.was_read);
    apply_range(image, as.picture_base, as.picture_gain);
    apply_alpha(image, as.alpha, as.alpha_cutoff);
    return image;
  });
  return shown;
}

void ModelPictures::wait_for(std::size_t first, std::size_t end) {
  parallel_for(end - first, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t n = from; n < to; ++n) shown_[first + n]->decoded->wait();
  });
}

Image ModelPictures::take(Shown& shown) {
  shown.decoded->wait();
  if (shown.was_read) folder_.note(shown.file);
  return shown.decoded->take();
}

void ModelPictures::tell(const std::string& problem, std::vector<std::string>& problems) const {
  constexpr std::size_t kMost = 20;
  problems.push_back(problem);
  if (problems.size() < kMost) {
    context_.warn(problem + " The material's base colour is used instead.");
  } else if (problems.size() == kMost) {
    context_.warn("More textures are missing or damaged than are named here.");
  }
}

}  // namespace hydrodip
