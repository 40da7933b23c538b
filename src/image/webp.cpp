// The only place that knows libwebp.
#include <webp/decode.h>
#include <webp/demux.h>

#include <memory>

#include "image/decoders.h"

namespace hydrodip {

namespace {

struct DeleteDemuxer {
  void operator()(WebPDemuxer* demuxer) const { WebPDemuxDelete(demuxer); }
};

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
  check_picture_size(name, "WebP", std::uint32_t(features.width), std::uint32_t(features.height), 0,
                     bytes.size());
  StoredPicture picture;
  picture.image = Image(features.width, features.height);
  if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), picture.image.rgba.data(),
                          picture.image.rgba.size(), 4 * features.width))
    refuse_picture(name, "WebP", "its pixels cannot be read");
  const WebPData data{bytes.data(), bytes.size()};
  const std::unique_ptr<WebPDemuxer, DeleteDemuxer> demuxer(WebPDemux(&data));
  if (!demuxer) return picture;
  picture.profile = chunk(demuxer.get(), "ICCP");
  const PictureBytes exif = chunk(demuxer.get(), "EXIF");
  const bool marked = exif.size() > 6 && exif[0] == 'E' && exif[1] == 'x';
  picture.orientation = exif_orientation(std::span(exif).subspan(marked ? 6 : 0));
  return picture;
}

}  // namespace hydrodip
