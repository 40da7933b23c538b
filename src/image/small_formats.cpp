// BMP and TGA: plain enough to need no library.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/run_scope.h"
#include "image/decoders.h"

namespace hydrodip {

namespace {

using Color = std::array<std::uint8_t, 4>;

// Little-endian numbers of a file; 0 behind its end.
class Numbers {
 public:
  explicit Numbers(const PictureBytes& bytes) : bytes_(bytes) {}
  std::uint32_t at(std::size_t offset, std::size_t count) const {
    if (offset > bytes_.size() || bytes_.size() - offset < count) return 0;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value |= std::uint32_t(bytes_[offset + i]) << (8 * i);
    return value;
  }

 private:
  const PictureBytes& bytes_;
};

std::uint8_t widened(std::uint32_t value, std::uint32_t most) {
  return std::uint8_t((value * 255 + most / 2) / most);
}

// ---- BMP ----------------------------------------------------------------------------------------

// Which bits of a pixel are a channel.
struct Mask {
  std::uint32_t bits = 0;
  std::uint8_t of(std::uint32_t pixel) const {
    if (bits == 0) return 255;
    std::uint32_t value = pixel & bits, most = bits;
    while (!(most & 1)) value >>= 1, most >>= 1;
    if (most > 0xffff) value >>= 16, most >>= 16;
    return widened(value, most);
  }
};

class BmpReader {
 public:
  BmpReader(const PictureBytes& bytes, const std::string& name)
      : bytes_(bytes), name_(name), numbers_(bytes) {}

  Image run() {
    read_header();
    if (compression_ == kRle8 || compression_ == kRle4) {
      read_runs();
    } else {
      read_rows();
    }
    return std::move(image_);
  }

  // Of the fifth version's headers: in the file, or in one of its own, which is not looked for.
  void read_profile(StoredPicture& picture) const {
    constexpr std::uint32_t kEmbedded = 0x4d424544, kLinked = 0x4c494e4b;  // "MBED", "LINK"
    constexpr std::size_t kHeaderAt = 14, kV5 = 124;
    if (numbers_.at(kHeaderAt, 4) < kV5) return;
    const std::uint32_t space = numbers_.at(kHeaderAt + 56, 4);
    picture.profile_lost = space == kLinked;
    if (space != kEmbedded) return;
    const std::size_t at = kHeaderAt + std::size_t(numbers_.at(kHeaderAt + 112, 4));
    const std::size_t size = numbers_.at(kHeaderAt + 116, 4);
    picture.profile_lost = size == 0 || at > bytes_.size() || bytes_.size() - at < size;
    if (!picture.profile_lost)
      picture.profile.assign(bytes_.begin() + std::ptrdiff_t(at),
                             bytes_.begin() + std::ptrdiff_t(at + size));
  }

 private:
  enum { kPlain = 0, kRle8 = 1, kRle4 = 2, kMasks = 3, kMasksWithAlpha = 6 };

  [[noreturn]] void refuse(const char* why) const { refuse_picture(name_, "BMP", why); }

  void read_header() {
    const std::uint32_t header = numbers_.at(14, 4);
    const bool core = header == 12;
    if (!core && (header < 40 || header > 200)) refuse("its header is unknown");
    const auto width = core ? std::int32_t(numbers_.at(18, 2)) : std::int32_t(numbers_.at(18, 4));
    const auto height = core ? std::int32_t(numbers_.at(20, 2)) : std::int32_t(numbers_.at(22, 4));
    bits_ = numbers_.at(core ? 24 : 28, 2);
    compression_ = core ? 0 : int(numbers_.at(30, 4));
    top_down_ = height < 0;
    if (width < 1 || height == 0 || height < -(1 << 30)) refuse("it has no pixels");
    if (bits_ != 1 && bits_ != 4 && bits_ != 8 && bits_ != 16 && bits_ != 24 && bits_ != 32)
      refuse("its pixels have an odd size");
    const bool runs = compression_ == kRle8 || compression_ == kRle4;
    if (runs && bits_ != (compression_ == kRle8 ? 8u : 4u)) refuse("its pixels have an odd size");
    if (!runs && compression_ != kPlain && compression_ != kMasks &&
        compression_ != kMasksWithAlpha)
      refuse("its compression is unknown");
    const auto w = std::uint32_t(width), h = std::uint32_t(height < 0 ? -height : height);
    row_bytes_ = (std::size_t(w) * bits_ + 31) / 32 * 4;
    data_ = numbers_.at(10, 4);
    check_picture_size(name_, "BMP", w, h, runs ? 0 : double(row_bytes_) * h, bytes_.size());
    if (!runs && (data_ > bytes_.size() || bytes_.size() - data_ < row_bytes_ * h))
      refuse("it ends too early");
    read_masks(header);
    read_palette(core ? 26 : 14 + header, core ? 3 : 4, core ? 0 : numbers_.at(46, 4));
    image_ = Image(width, int(h));
  }

  void read_masks(std::uint32_t header) {
    if (compression_ == kMasks || compression_ == kMasksWithAlpha) {
      for (std::size_t c = 0; c < 3; ++c) masks_[c].bits = numbers_.at(54 + 4 * c, 4);
      if (header >= 56 || compression_ == kMasksWithAlpha) masks_[3].bits = numbers_.at(66, 4);
      if (masks_[0].bits == 0 || masks_[1].bits == 0 || masks_[2].bits == 0)
        refuse("its channels are unknown");
    } else if (bits_ == 16) {
      masks_ = {Mask{0x7c00}, Mask{0x3e0}, Mask{0x1f}, Mask{0}};
    } else {
      masks_ = {Mask{0xff0000}, Mask{0xff00}, Mask{0xff}, Mask{0}};
    }
  }

  void read_palette(std::size_t offset, std::size_t entry_bytes, std::uint32_t used) {
    if (bits_ > 8) return;
    if (compression_ == kMasks) offset += 12;
    const std::uint32_t count = used > 0 && used < (1u << bits_) ? used : 1u << bits_;
    palette_.assign(std::size_t(1) << bits_, {0, 0, 0, 255});
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = offset + i * entry_bytes;
      for (std::size_t c = 0; c < 3; ++c) palette_[i][c] = std::uint8_t(numbers_.at(at + 2 - c, 1));
    }
  }

  std::uint8_t* pixel(int x, int row) {
    return image_.pixel(x, top_down_ ? row : image_.height_px - 1 - row);
  }

  void read_rows() {
    for (int row = 0; row < image_.height_px; ++row) {
      check_cancelled();
      const std::size_t begin = data_ + std::size_t(row) * row_bytes_;
      for (int x = 0; x < image_.width_px; ++x)
        std::copy_n(color(begin, std::size_t(x)).data(), 4, pixel(x, row));
    }
  }

  Color color(std::size_t row, std::size_t x) const {
    if (bits_ <= 8) {
      const std::size_t bit = x * bits_;
      const std::uint32_t byte = bytes_[row + bit / 8];
      return palette_[byte >> (8 - bits_ - bit % 8) & ((1u << bits_) - 1)];
    }
    const std::uint32_t value = numbers_.at(row + x * (bits_ / 8), bits_ / 8);
    return {masks_[0].of(value), masks_[1].of(value), masks_[2].of(value), masks_[3].of(value)};
  }

  // Pairs of a count and a colour; 0 begins a command. What no run covers is black, and what leads
  // out of the picture stays at its edge, however far it leads.
  void read_runs() {
    for (std::size_t i = 3; i < image_.rgba.size(); i += 4) image_.rgba[i] = 255;
    const int per_byte = int(8 / bits_);
    int x = 0, row = 0;
    const auto put = [&](std::uint32_t byte, int which) {
      const std::size_t entry = per_byte == 1 ? byte : which % 2 == 0 ? byte >> 4 : byte & 15;
      if (x >= image_.width_px || row >= image_.height_px) return;
      std::copy_n(palette_[entry].data(), 4, pixel(x, row));
      ++x;
    };
    CheckEvery check(1 << 12);
    for (std::size_t at = data_; at + 1 < bytes_.size();) {
      check();
      const int count = bytes_[at], value = bytes_[at + 1];
      at += 2;
      if (count > 0) {
        for (int i = 0; i < count; ++i) put(std::uint32_t(value), i);
      } else if (value == 0) {
        x = 0;
        row = std::min(row + 1, image_.height_px);
      } else if (value == 1) {
        return;
      } else if (value == 2) {
        x = std::min(x + int(numbers_.at(at, 1)), image_.width_px);
        row = std::min(row + int(numbers_.at(at + 1, 1)), image_.height_px);
        at += 2;
      } else {
        const std::size_t packed =
            (std::size_t(value) + std::size_t(per_byte) - 1) / std::size_t(per_byte);
        if (bytes_.size() - at < packed) refuse("it ends too early");
        for (int i = 0; i < value; ++i) put(bytes_[at + std::size_t(i / per_byte)], i);
        at += (packed + 1) / 2 * 2;
      }
    }
    refuse("it ends too early");
  }

  const PictureBytes& bytes_;
  const std::string& name_;
  Numbers numbers_;
  std::uint32_t bits_ = 0;
  int compression_ = 0;
  bool top_down_ = false;
  std::size_t row_bytes_ = 0, data_ = 0;
  std::array<Mask, 4> masks_;
  std::vector<Color> palette_;
  Image image_;
};

// ---- TGA ----------------------------------------------------------------------------------------

constexpr std::size_t kTgaHeader = 18;

class TgaReader {
 public:
  TgaReader(const PictureBytes& bytes, const std::string& name)
      : bytes_(bytes), name_(name), numbers_(bytes) {}

  Image run() {
    const std::uint32_t width = numbers_.at(12, 2), height = numbers_.at(14, 2);
    const int type = bytes_[2];
    packed_ = type >= 9;
    grey_ = type % 8 == 3;
    mapped_ = type % 8 == 1;
    bits_ = bytes_[16];
    const std::uint8_t descriptor = bytes_[17];
    has_alpha_ = (descriptor & 15) > 0;
    pixel_bytes_ = (bits_ + 7) / 8;
    // A packet of runs is 128 pixels at the most.
    const double least = packed_ ? double(pixel_bytes_ + 1) / 128 : pixel_bytes_;
    check_picture_size(name_, "TGA", width, height, double(width) * height * least, bytes_.size());
    at_ = kTgaHeader + bytes_[0];
    read_map();
    Image image{int(width), int(height)};
    const bool from_top = (descriptor & 0x20) != 0, from_right = (descriptor & 0x10) != 0;
    for (int row = 0; row < image.height_px; ++row) {
      check_cancelled();
      for (int column = 0; column < image.width_px; ++column) {
        const int x = from_right ? image.width_px - 1 - column : column;
        const int y = from_top ? row : image.height_px - 1 - row;
        std::copy_n(next().data(), 4, image.pixel(x, y));
      }
    }
    take_alpha_as_meant(image);
    return image;
  }

 private:
  [[noreturn]] void refuse(const char* why) const { refuse_picture(name_, "TGA", why); }

  void read_map() {
    if (bytes_[1] != 1) {
      if (mapped_) refuse("it has no palette");
      return;
    }
    const std::uint32_t first = numbers_.at(3, 2), count = numbers_.at(5, 2), bits = bytes_[7];
    const std::size_t entry = (bits + 7) / 8;
    if (entry < 2 || entry > 4 || bytes_.size() - std::min(at_, bytes_.size()) < entry * count)
      refuse("its palette is damaged");
    map_.assign(first, {0, 0, 0, 255});
    for (std::uint32_t i = 0; i < count; ++i, at_ += entry)
      map_.push_back(color(at_, entry, bits == 32));
  }

  Color color(std::size_t at, std::size_t count, bool alpha) const {
    if (count == 2) {
      const std::uint32_t value = numbers_.at(at, 2);
      return {widened(value >> 10 & 31, 31), widened(value >> 5 & 31, 31), widened(value & 31, 31),
              255};
    }
    return {bytes_[at + 2], bytes_[at + 1], bytes_[at],
            alpha && count == 4 ? bytes_[at + 3] : std::uint8_t(255)};
  }

  Color read_pixel() {
    if (at_ > bytes_.size() || bytes_.size() - at_ < pixel_bytes_) refuse("it ends too early");
    const std::size_t at = at_;
    at_ += pixel_bytes_;
    if (grey_)
      return {bytes_[at], bytes_[at], bytes_[at],
              pixel_bytes_ == 2 && has_alpha_ ? bytes_[at + 1] : std::uint8_t(255)};
    if (!mapped_) return color(at, pixel_bytes_, has_alpha_);
    const std::uint32_t index = numbers_.at(at, pixel_bytes_);
    if (index >= map_.size()) refuse("a pixel is not in its palette");
    return map_[index];
  }

  Color next() {
    if (!packed_) return read_pixel();
    if (left_ == 0) {
      if (at_ >= bytes_.size()) refuse("it ends too early");
      const int packet = bytes_[at_++];
      left_ = (packet & 127) + 1;
      repeats_ = packet >= 128;
      if (repeats_) repeated_ = read_pixel();
    }
    --left_;
    return repeats_ ? repeated_ : read_pixel();
  }

  // What the second version's last part says the fourth channel is; 3, transparency, without one.
  std::uint32_t kind_of_alpha() const {
    constexpr std::string_view kMark = "TRUEVISION-XFILE.";
    constexpr std::size_t kFooter = 26, kKindAt = 494;
    if (bytes_.size() < kTgaHeader + kFooter) return 3;
    const std::size_t footer = bytes_.size() - kFooter;
    const std::size_t extension = numbers_.at(footer, 4);
    if (!std::equal(kMark.begin(), kMark.end(), bytes_.begin() + std::ptrdiff_t(footer + 8)) ||
        extension < kTgaHeader || extension + kKindAt >= footer)
      return 3;
    return numbers_.at(extension + kKindAt, 1);
  }

  // An alpha that is 0 everywhere was never meant.
  void take_alpha_as_meant(Image& image) const {
    const std::uint32_t kind = kind_of_alpha();
    const bool left_out = has_alpha_ && (kind == 1 || kind == 2), premultiplied = kind == 4;
    bool seen = false, says_something = false;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
      seen = seen || image.rgba[i] != 0;
      says_something = says_something || image.rgba[i] != 255;
    }
    if (left_out && seen && says_something) warn_of_left_out(1, name_);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      if (!seen || left_out)
        image.rgba[i + 3] = 255;
      else if (premultiplied)
        divide_by_alpha(&image.rgba[i], 3, image.rgba[i + 3]);
    }
  }

  const PictureBytes& bytes_;
  const std::string& name_;
  Numbers numbers_;
  bool packed_ = false, grey_ = false, mapped_ = false, has_alpha_ = false;
  std::uint32_t bits_ = 0;
  std::size_t pixel_bytes_ = 0, at_ = 0;
  std::vector<Color> map_;
  int left_ = 0;
  bool repeats_ = false;
  Color repeated_{};
};

}  // namespace

StoredPicture decode_bmp(const PictureBytes& bytes, const std::string& name) {
  StoredPicture picture;
  BmpReader reader(bytes, name);
  picture.image = reader.run();
  reader.read_profile(picture);
  return picture;
}

bool looks_like_tga(const PictureBytes& bytes) {
  if (bytes.size() <= kTgaHeader) return false;
  const int type = bytes[2], bits = bytes[16];
  const bool mapped = type % 8 == 1, grey = type % 8 == 3;
  const bool known = (type >= 1 && type <= 3) || (type >= 9 && type <= 11);
  const bool size = mapped ? bits == 8 || bits == 16
                    : grey ? bits == 8 || bits == 16
                           : bits == 15 || bits == 16 || bits == 24 || bits == 32;
  return bytes[1] <= 1 && known && size && (bytes[17] & 0xc0) == 0;
}

StoredPicture decode_tga(const PictureBytes& bytes, const std::string& name) {
  StoredPicture picture;
  picture.image = TgaReader(bytes, name).run();
  return picture;
}

}  // namespace hydrodip
