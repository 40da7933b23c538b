// The only place that knows giflib.
#include <gif_lib.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>

#include "base/run_scope.h"
#include "image/decoders.h"

namespace hydrodip {

namespace {

struct GifSource {
  const PictureBytes& bytes;
  std::size_t at = 0;
};

int read_gif(GifFileType* file, GifByteType* out, int count) {
  auto* source = static_cast<GifSource*>(file->UserData);
  const std::size_t taken = std::min(std::size_t(count), source->bytes.size() - source->at);
  std::memcpy(out, source->bytes.data() + source->at, taken);
  source->at += taken;
  return int(taken);
}

struct CloseGif {
  void operator()(GifFileType* file) const { DGifCloseFile(file, nullptr); }
};

// What an extension says of the picture after it.
struct GifExtras {
  int transparent = -1;  // the palette's entry, or -1
  PictureBytes profile;
};

void read_extension(GifFileType* file, GifExtras& extras) {
  constexpr std::string_view kProfile = "ICCRGBG1012";
  int code = 0;
  GifByteType* data = nullptr;  // a length, and so many bytes
  if (DGifGetExtension(file, &code, &data) == GIF_ERROR || !data) return;
  if (code == GRAPHICS_EXT_FUNC_CODE && data[0] >= 4)
    extras.transparent = data[1] & 1 ? data[4] : -1;
  const bool is_profile = code == APPLICATION_EXT_FUNC_CODE && data[0] == kProfile.size() &&
                          std::memcmp(data + 1, kProfile.data(), kProfile.size()) == 0;
  while (DGifGetExtensionNext(file, &data) != GIF_ERROR && data)
    if (is_profile) extras.profile.insert(extras.profile.end(), data + 1, data + 1 + data[0]);
}

// Rows of an interlaced picture come in four passes.
int row_of(int number, int height) {
  constexpr int kFirst[] = {0, 4, 2, 1}, kStep[] = {8, 8, 4, 2};
  for (int pass = 0; pass < 4; ++pass) {
    const int rows = (height - kFirst[pass] + kStep[pass] - 1) / kStep[pass];
    if (number < rows) return kFirst[pass] + number * kStep[pass];
    number -= std::max(rows, 0);
  }
  return height - 1;
}

Image read_frame(GifFileType* file, int transparent, const PictureBytes& bytes,
                 const std::string& name) {
  if (DGifGetImageDesc(file) == GIF_ERROR) refuse_picture(name, "GIF", "it has no picture");
  const GifImageDesc& frame = file->Image;
  const ColorMapObject* colors = frame.ColorMap ? frame.ColorMap : file->SColorMap;
  const int width = std::max(file->SWidth, frame.Left + frame.Width);
  const int height = std::max(file->SHeight, frame.Top + frame.Height);
  if (!colors || frame.Left < 0 || frame.Top < 0 || frame.Width < 1 || frame.Height < 1)
    refuse_picture(name, "GIF", "its first picture is damaged");
  // A code has three bits at the least and stands for 4096 pixels at the most.
  const double least = double(frame.Width) * frame.Height / 4096 * 3 / 8;
  check_picture_size(name, "GIF", std::uint32_t(width), std::uint32_t(height), least, bytes.size());
  Image image(width, height);
  std::vector<GifPixelType> row(std::size_t(frame.Width));
  for (int y = 0; y < frame.Height; ++y) {
    check_cancelled();
    if (DGifGetLine(file, row.data(), frame.Width) == GIF_ERROR)
      refuse_picture(name, "GIF", "it ends too early");
    const int to = frame.Top + (frame.Interlace ? row_of(y, frame.Height) : y);
    for (int x = 0; x < frame.Width; ++x) {
      const int index = row[std::size_t(x)];
      if (index == transparent) continue;
      if (index >= colors->ColorCount) refuse_picture(name, "GIF", "a pixel is not in its palette");
      const GifColorType& color = colors->Colors[index];
      const std::uint8_t rgba[] = {color.Red, color.Green, color.Blue, 255};
      std::copy_n(rgba, 4, image.pixel(frame.Left + x, to));
    }
  }
  return image;
}

// Whether a frame follows.
bool goes_on(GifFileType* file) {
  GifExtras none;
  GifRecordType kind = UNDEFINED_RECORD_TYPE;
  while (DGifGetRecordType(file, &kind) != GIF_ERROR && kind == EXTENSION_RECORD_TYPE)
    read_extension(file, none);
  return kind == IMAGE_DESC_RECORD_TYPE;
}

}  // namespace

StoredPicture decode_gif(const PictureBytes& bytes, const std::string& name) {
  GifSource source{bytes};
  int error = 0;
  const std::unique_ptr<GifFileType, CloseGif> file(DGifOpen(&source, read_gif, &error));
  if (!file) refuse_picture(name, "GIF", "its header cannot be read");
  GifExtras extras;
  for (;;) {
    GifRecordType kind = UNDEFINED_RECORD_TYPE;
    if (DGifGetRecordType(file.get(), &kind) == GIF_ERROR || kind == TERMINATE_RECORD_TYPE)
      refuse_picture(name, "GIF", "it has no picture");
    if (kind == EXTENSION_RECORD_TYPE) {
      read_extension(file.get(), extras);
    } else if (kind == IMAGE_DESC_RECORD_TYPE) {
      StoredPicture picture;
      picture.image = read_frame(file.get(), extras.transparent, bytes, name);
      picture.profile = std::move(extras.profile);
      picture.has_more = goes_on(file.get());
      return picture;
    }
  }
}

}  // namespace hydrodip
