// The only place that knows libwebp.
#include <webp/decode.h>
#include <webp/demux.h>

#include <algorithm>
#include <memory>

#include "base/run_scope.h"
#include "image/decoders.h"

namespace hydrodip {

namespace {

struct DeleteDemuxer {
  void operator()(WebPDemuxer* demuxer) const { WebPDemuxDelete(demuxer); }
};

struct DeleteDecoder {
  void operator()(WebPIDecoder* decoder) const { WebPIDelete(decoder); }
};

// Shows the decoder more and more of the file, so that a job can be cancelled in between.
bool read_pixels(const PictureBytes& bytes, Image& image) {
  constexpr std::size_t kPiece = std::size_t(1) << 16;
  const std::unique_ptr<WebPIDecoder, DeleteDecoder> decoder(
      WebPINewRGB(MODE_RGBA, image.rgba.data(), image.rgba.size(), 4 * image.width_px));
  if (!decoder) throw std::bad_alloc();
  for (std::size_t shown = 0; shown < bytes.size();) {
    check_cancelled();
    shown = std::min(shown + kPiece, bytes.size());
    const VP8StatusCode status = WebPIUpdate(decoder.get(), bytes.data(), shown);
    if (status == VP8_STATUS_OK) return true;
    if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
    if (status != VP8_STATUS_SUSPENDED) return false;
  }
  return false;
}

// Whether a part of the file is missing, by the lengths that it states. The last one's filling byte
// may be: some leave it out.
bool is_cut(const PictureBytes& bytes) {
  constexpr std::size_t kHeader = 8, kFirstChunk = 12;
  const auto length_at = [&](std::size_t at) {
    std::size_t length = 0;
    for (std::size_t i = at + 4; i-- > at;) length = length << 8 | bytes[i];
    return length;
  };
  const std::size_t end = kHeader + length_at(4);
  for (std::size_t at = kFirstChunk; at + kHeader <= end; at += at % 2) {
    if (at + kHeader > bytes.size()) return true;
    at += kHeader + length_at(at + 4);
    if (at > bytes.size()) return true;
  }
  return false;
}

// By its header, whether or not it is there.
bool says_profile(const PictureBytes& bytes) {
  constexpr std::size_t kFlags = 20;
  return bytes.size() > kFlags && std::equal(&bytes[12], &bytes[16], "VP8X") &&
         (bytes[kFlags] & ICCP_FLAG) != 0;
}

PictureBytes chunk(WebPDemuxer* demuxer, const char* kind) {
  WebPChunkIterator found;
  if (!WebPDemuxGetChunk(demuxer, kind, 1, &found)) return {};
  PictureBytes bytes(found.chunk.bytes, found.chunk.bytes + found.chunk.size);
  WebPDemuxReleaseChunkIterator(&found);
  return bytes;
}

}  // namespace

StoredPicture decode_webp(const PictureBytes& bytes, const std::string& name) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
    refuse_picture(name, "WebP", "its header cannot be read");
  if (features.has_animation) refuse_picture(name, "WebP", "it is animated");
  // The decoder asks for no more bytes than its pixels take.
  if (is_cut(bytes)) refuse_picture(name, "WebP", "it ends too early");
  check_picture_size(name, "WebP", std::uint32_t(features.width), std::uint32_t(features.height), 0,
                     bytes.size());
  StoredPicture picture;
  picture.image = Image(features.width, features.height);
  if (!read_pixels(bytes, picture.image)) refuse_picture(name, "WebP", "its pixels cannot be read");
  const WebPData data{bytes.data(), bytes.size()};
  // What follows the pixels may be cut off.
  const std::unique_ptr<WebPDemuxer, DeleteDemuxer> demuxer(WebPDemuxPartial(&data, nullptr));
  if (demuxer) picture.profile = chunk(demuxer.get(), "ICCP");
  picture.profile_lost = picture.profile.empty() && says_profile(bytes);
  if (!demuxer) return picture;
  const PictureBytes exif = chunk(demuxer.get(), "EXIF");
  const bool marked = exif.size() > 6 && exif[0] == 'E' && exif[1] == 'x';
  picture.orientation = exif_orientation(std::span(exif).subspan(marked ? 6 : 0));
  return picture;
}

}  // namespace hydrodip
