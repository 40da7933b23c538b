#include "ink/discoloration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/blank_array.h"
#include "base/parallel.h"
#include "image/shown_columns.h"
#include "image/to_byte.h"
#include "ink/difference.h"
#include "transfer/area_ratio.h"

namespace hydrodip {

namespace {

constexpr std::size_t kRowGrain = 16;  // rows
constexpr float kKnee = 0.8F;          // of kSoft: up to here nothing is held back

// Identity up to the knee, then ever flatter towards 1, without a kink.
float soft(float amount) {
  if (amount <= kKnee) return amount;
  const float beyond = (amount - kKnee) / (1 - kKnee);
  return kKnee + (1 - kKnee) * beyond / (1 + beyond);
}

float largest(const Inks& inks) { return std::max({inks.c, inks.m, inks.y, inks.k}); }

// Black beyond the black ink, printed with the three colours.
Inks with_full_black(Inks inks) {
  const float beyond = inks.k - 1;
  if (beyond <= 0) return inks;
  return {inks.c + beyond, inks.m + beyond, inks.y + beyond, 1};
}

Inks clipped(const Inks& inks) {
  return {std::min(inks.c, 1.0F), std::min(inks.m, 1.0F), std::min(inks.y, 1.0F),
          std::min(inks.k, 1.0F)};
}

Inks limited(const Inks& inks, double limit) {
  const float sum = inks.density();
  return sum > limit ? inks.times(static_cast<float>(limit) / sum) : inks;
}

// Rounding took their sum beyond the limit: the heaviest gives it back.
std::array<std::uint8_t, 4> within(double limit, std::array<std::uint8_t, 4> inks) {
  const int most = int(std::floor(255 * limit + 1e-6));
  for (int over = inks[0] + inks[1] + inks[2] + inks[3] - most; over > 0; --over)
    --*std::max_element(inks.begin(), inks.end());
  return inks;
}

SrgbColor srgb(const std::uint8_t* pixel) {
  return {static_cast<float>(pixel[0]) / 255.0F, static_cast<float>(pixel[1]) / 255.0F,
          static_cast<float>(pixel[2]) / 255.0F};
}

// What white film must show so that `color` comes out over the base.
SrgbColor on_white(const SrgbColor& color, const LinearColor& base) {
  const auto channel = [](float encoded, float under) {
    const float light = srgb_to_linear(encoded);
    return under > light ? linear_to_srgb(light / under) : 1.0F;
  };
  return {channel(color.r, base.r), channel(color.g, base.g), channel(color.b, base.b)};
}

SrgbColor over_base(const SrgbColor& color, const LinearColor& base) {
  const auto channel = [](float encoded, float under) {
    return linear_to_srgb(srgb_to_linear(encoded) * under);
  };
  return {channel(color.r, base.r), channel(color.g, base.g), channel(color.b, base.b)};
}

void store(const SrgbColor& color, std::uint8_t* pixel) {
  pixel[0] = to_byte(color.r);
  pixel[1] = to_byte(color.g);
  pixel[2] = to_byte(color.b);
  pixel[3] = 255;
}

// Whether what comes out of a pixel is compared with what was wanted.
bool is_compared(const Image& wanted, const FilmStretch& stretch, std::size_t pixel) {
  return stretch.on_object[pixel] != 0 && wanted.rgba[4 * pixel + 3] == 255;
}

// work(row) for every row, on any thread.
template <class Work>
void for_each_row(const RowBand& rows, const Work& work) {
  const auto count = static_cast<std::size_t>(rows.end - rows.begin);
  parallel_for(count, kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) work(rows.begin + static_cast<int>(n));
  });
}

template <class Picture>
RowBand all_rows(const Picture& picture) {
  return {0, picture.height_px};
}

// Inks of a row before any compensation; blank where the image is transparent.
void separate_row(const Image& image, int y, const ColorModel& model, const LinearColor& base,
                  std::vector<Inks>& inks) {
  std::vector<SrgbColor> colors;
  std::vector<int> columns;
  const bool white = is_white(base);
  for (int x = 0; x < image.width_px; ++x) {
    const std::uint8_t* pixel = image.pixel(x, y);
    if (pixel[3] == 0) continue;
    colors.push_back(white ? srgb(pixel) : on_white(srgb(pixel), base));
    columns.push_back(x);
  }
  std::vector<Inks> found(colors.size());
  model.separate(colors.data(), found.data(), colors.size());
  inks.assign(std::size_t(image.width_px), Inks{});
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const float coverage = static_cast<float>(image.pixel(columns[i], y)[3]) / 255.0F;
    inks[std::size_t(columns[i])] = found[i].times(coverage);
  }
}

// Some of a row's pixels and the inks on them, which are looked at all at once.
class InkedPixels {
 public:
  void add(int x, const Inks& inks) {
    columns_.push_back(x);
    inks_.push_back(inks);
  }
  // see(x, color) for each, and none are left.
  template <class See>
  void look(const ColorModel& model, const See& see) {
    colors_.resize(inks_.size());
    model.look(inks_.data(), colors_.data(), inks_.size());
    for (std::size_t i = 0; i < columns_.size(); ++i) see(columns_[i], colors_[i]);
    columns_.clear();
    inks_.clear();
  }

 private:
  std::vector<int> columns_;
  std::vector<Inks> inks_;
  std::vector<SrgbColor> colors_;
};

// CIEDE2000 between pixels; many pairs come again nearby.
class Differences {
 public:
  float between(const std::uint8_t* a, const std::uint8_t* b) {
    std::uint64_t pair = 0;
    for (const std::uint8_t* pixel : {a, b})
      for (int k = 0; k < 3; ++k) pair = 256 * pair + pixel[k];
    Known& known = known_[(pair * 0x9E3779B97F4A7C15U) >> 52U];
    if (known.pair != pair) known = {pair, static_cast<float>(color_difference(srgb(a), srgb(b)))};
    return known.difference;
  }

 private:
  struct Known {
    std::uint64_t pair = 0;  // black and black
    float difference = 0;
  };
  std::vector<Known> known_ = std::vector<Known>(4096);
};

// By how much film stretches that its ink makes up for.
float compensated_ratio(float area_ratio, const InkingOptions& options) {
  return options.compensate ? ratio_or_one(area_ratio) : 1;
}

// How much too much the neediest point asks for: 1 if everything fits.
float overshoot(const Image& wanted, const BlankArray<float>& area_ratio, const ColorModel& model,
                const InkingOptions& options) {
  std::vector<float> of_row(std::size_t(wanted.height_px), 1.0F);
  for_each_row(all_rows(wanted), [&](int y) {
    std::vector<Inks> inks;
    separate_row(wanted, y, model, options.base, inks);
    float& most = of_row[std::size_t(y)];
    for (int x = 0; x < wanted.width_px; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(wanted.width_px) + std::size_t(x);
      const Inks needed = inks[std::size_t(x)].times(compensated_ratio(area_ratio[i], options));
      most = std::max({most, needed.c, needed.m, needed.y, needed.k,
                       needed.density() / static_cast<float>(options.limit)});
    }
  });
  return *std::max_element(of_row.begin(), of_row.end());
}

}  // namespace

Inks paled(const Inks& inks, double area_ratio) {
  return inks.times(static_cast<float>(1 / area_ratio));
}

Inks compensated(const Inks& wanted, double area_ratio, GamutPolicy policy, double limit) {
  Inks needed = with_full_black(wanted.times(static_cast<float>(area_ratio)));
  if (policy == GamutPolicy::kSoft) {
    const float most = largest(needed);
    if (most > kKnee) needed = needed.times(soft(most) / most);
  }
  return limited(clipped(needed), limit);
}

Inking no_ink(int width_px, int height_px) {
  Inking result;
  result.inks.width_px = width_px;
  result.inks.height_px = height_px;
  result.inks.cmyk =
      BlankArray<std::uint8_t>(std::size_t(4) * std::size_t(width_px) * std::size_t(height_px));
  result.printed = PixelSet(width_px, height_px);
  return result;
}

Inking ink_film(const Image& wanted, const BlankArray<float>& area_ratio, const ColorModel& model,
                const InkingOptions& options, const RunContext& context) {
  const RunScope scope(context);
  Inking result = prepared_inking(wanted, area_ratio, model, options);
  ink_rows(all_rows(wanted), wanted, area_ratio, model, options, result);
  return result;
}

Inking prepared_inking(const Image& wanted, const BlankArray<float>& area_ratio,
                       const ColorModel& model, const InkingOptions& options) {
  Inking result = no_ink(wanted.width_px, wanted.height_px);
  if (options.policy == GamutPolicy::kScale)
    result.lightened =
        std::min(options.lightened_most, 1 / double(overshoot(wanted, area_ratio, model, options)));
  return result;
}

void ink_rows(const RowBand& rows, const Image& wanted, const BlankArray<float>& area_ratio,
              const ColorModel& model, const InkingOptions& options, Inking& result) {
  for_each_row(rows, [&](int y) {
    std::vector<Inks> inks;
    separate_row(wanted, y, model, options.base, inks);
    for (int x = 0; x < wanted.width_px; ++x) {
      if (wanted.pixel(x, y)[3] == 0) continue;
      result.printed.insert(x, y);
      const std::size_t i = std::size_t(y) * std::size_t(wanted.width_px) + std::size_t(x);
      const Inks laid = compensated(inks[std::size_t(x)].times(float(result.lightened)),
                                    double(compensated_ratio(area_ratio[i], options)),
                                    options.policy, options.limit);
      const auto bytes = within(options.limit, to_bytes(laid));
      std::copy(bytes.begin(), bytes.end(), result.inks.pixel(x, y));
    }
  });
}

Image look_on_film(InkImage inks, const PixelSet& printed, const ColorModel& model) {
  Image image;
  image.width_px = inks.width_px;
  image.height_px = inks.height_px;
  image.rgba = std::move(inks.cmyk);
  for_each_row(all_rows(image), [&](int y) {
    InkedPixels row;
    for (int x = 0; x < image.width_px; ++x) {
      std::uint8_t* pixel = image.pixel(x, y);
      if (printed.contains(x, y))
        row.add(x, from_bytes(pixel));
      else if (!is_blank(pixel))  // blank pages stay so
        std::fill_n(pixel, 4, std::uint8_t{0});
    }
    row.look(model, [&](int x, const SrgbColor& color) { store(color, image.pixel(x, y)); });
  });
  return image;
}

Image look_on_object(const InkImage& inks, const BlankArray<float>& area_ratio,
                     const ColorModel& model, const LinearColor& base) {
  Image image(inks.width_px, inks.height_px);
  look_at_rows(all_rows(inks), inks, area_ratio, model, base, image);
  return image;
}

void look_at_rows(const RowBand& rows, const InkImage& inks, const BlankArray<float>& area_ratio,
                  const ColorModel& model, const LinearColor& base, Image& image) {
  const bool white = is_white(base);
  const Inks none;
  SrgbColor bare;
  model.look(&none, &bare, 1);
  bare = over_base(bare, base);
  std::array<std::uint8_t, 4> blank{};
  store(bare, blank.data());
  for_each_row(rows, [&](int y) {
    InkedPixels row;
    for (int x = 0; x < inks.width_px; ++x) {
      const std::uint8_t* laid = inks.pixel(x, y);
      const std::size_t i = std::size_t(y) * std::size_t(inks.width_px) + std::size_t(x);
      if (is_blank(laid)) {
        if (area_ratio[i] != 0) std::copy(blank.begin(), blank.end(), image.pixel(x, y));
        continue;
      }
      row.add(x, paled(from_bytes(laid), double(ratio_or_one(area_ratio[i]))));
    }
    row.look(model, [&](int x, const SrgbColor& color) {
      store(white ? color : over_base(color, base), image.pixel(x, y));
    });
  });
}

InkImage inks_of_film(const Image& image, const ColorModel& model) {
  InkImage result(image.width_px, image.height_px);
  for_each_row(all_rows(image), [&](int y) {
    std::vector<Inks> inks;
    separate_row(image, y, model, LinearColor{1, 1, 1, 1}, inks);
    for (int x = 0; x < image.width_px; ++x) {
      const auto bytes = to_bytes(inks[std::size_t(x)]);
      std::copy(bytes.begin(), bytes.end(), result.pixel(x, y));
    }
  });
  return result;
}

ReachMeter::ReachMeter(const SheetRaster& raster, const Box2& film)
    : pixel_mm2_((kMmPerInch / raster.dpi) * (kMmPerInch / raster.dpi)), means_(raster, film) {
  reach_.out_of_reach =
      BlankArray<float>(std::size_t(raster.width_px()) * std::size_t(raster.height_px()));
}

void ReachMeter::add(const RowBand& rows, const Image& wanted, const Image& on_object,
                     const FilmStretch& stretch) {
  const auto count = static_cast<std::size_t>(rows.end - rows.begin);
  const auto width = static_cast<std::size_t>(wanted.width_px);
  const std::size_t first = static_cast<std::size_t>(rows.begin) * width;
  if (differences_.size() < count * width) differences_ = BlankArray<float>(count * width);
  std::vector<Columns> printed(count);
  parallel_for(count, kRowGrain, [&](std::size_t begin, std::size_t end) {
    Differences known;
    for (std::size_t n = begin; n < end; ++n) {
      printed[n] = shown_columns(wanted, rows.begin + static_cast<int>(n));
      for (int x = printed[n].begin; x < printed[n].end; ++x) {
        const std::size_t at = n * width + static_cast<std::size_t>(x), i = first + at;
        const std::uint8_t *asked = &wanted.rgba[4 * i], *got = &on_object.rgba[4 * i];
        const bool same = !is_compared(wanted, stretch, i) || std::equal(asked, asked + 3, got);
        differences_[at] = same ? 0 : known.between(asked, got);
        if (differences_[at] > kVisible) reach_.out_of_reach[i] = differences_[at];
      }
    }
  });
  // In the pixels' order, so that the sums do not depend on the threads, nor on the bands.
  for (std::size_t n = 0; n < count; ++n) {
    check_cancelled();
    for (int x = printed[n].begin; x < printed[n].end; ++x) {
      const std::size_t at = n * width + static_cast<std::size_t>(x), i = first + at;
      if (wanted.rgba[4 * i + 3] == 0) continue;
      means_.add(x, rows.begin + static_cast<int>(n), differences_[at]);
      if (!is_compared(wanted, stretch, i)) continue;
      count_pixel(pixel_mm2_ * double(ratio_or_one(stretch.area_ratio[i])),
                  double(differences_[at]));
    }
  }
}

void ReachMeter::count_pixel(double area_mm2, double difference) {
  reach_.compared_mm2 += area_mm2;
  reach_.largest = std::max(reach_.largest, difference);
  if (difference > kVisible) {
    reach_.out_of_reach_mm2 += area_mm2;
    beyond_ += area_mm2 * difference;
  } else {
    within_ += area_mm2 * difference;
  }
}

Reach ReachMeter::result() {
  const auto mean = [](double sum, double area) { return area > 0 ? sum / area : 0; };
  reach_.mean = mean(within_ + beyond_, reach_.compared_mm2);
  reach_.mean_within = mean(within_, reach_.compared_mm2 - reach_.out_of_reach_mm2);
  reach_.mean_beyond = mean(beyond_, reach_.out_of_reach_mm2);
  reach_.difference = means_.cells();
  return std::move(reach_);
}

}  // namespace hydrodip
