// The only place that knows libharu.
#include "sheet/pdf_document.h"

#include <fmt/format.h>
#include <hpdf.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <limits>
#include <map>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/unicode.h"
#include "image/deflate_rows.h"
#include "sheet/page_text.h"
#include "sheet/winansi.h"

namespace hydrodip {

namespace {

constexpr double kPtPerMm = 72 / kMmPerInch;
constexpr double kLongestPageMm = 14400 / kPtPerMm;  // the PDF format's limit

HPDF_REAL pt(double mm) { return static_cast<HPDF_REAL>(mm * kPtPerMm); }

struct FreeDocument {
  void operator()(HPDF_Doc document) const { HPDF_Free(document); }
};
using Document = std::unique_ptr<std::remove_pointer_t<HPDF_Doc>, FreeDocument>;

// What libharu makes is null after any earlier failure, and it does not check for that itself.
[[noreturn]] void refuse_to_compose(HPDF_Doc document) {
  throw std::runtime_error(
      fmt::format("the PDF could not be composed (libharu error {:#x}).", HPDF_GetError(document)));
}

template <typename Handle>
Handle made(HPDF_Doc document, Handle handle) {
  if (handle == nullptr) refuse_to_compose(document);
  return handle;
}

using Bytes = std::vector<std::uint8_t>;

// The picture as 8-bit RGB over white, or inks, compressed. Each row begins with a PNG filter
// number and holds differences to the left neighbour, which compress several times better.
std::vector<Bytes> compressed(const Picture& picture, const PixelBox& box, bool mirror) {
  constexpr std::uint8_t kSubFilter = 1;
  const auto channels = std::size_t(picture.channels);
  return deflate_rows(std::size_t(box.height()), 1 + channels * std::size_t(box.width()),
                      [&](std::size_t row, std::uint8_t* out) {
                        *out++ = kSubFilter;
                        std::array<std::uint8_t, 4> left{};
                        for (int i = 0; i < box.width(); ++i) {
                          const auto color = picture.read(
                              mirror ? box.x_end - 1 - i : box.x_begin + i, box.y_begin + int(row));
                          for (std::size_t k = 0; k < channels; ++k)
                            *out++ = static_cast<std::uint8_t>(color[k] - left[k]);
                          left = color;
                        }
                      });
}

// Hands them to libharu while it writes the file.
class PixelStream {
 public:
  explicit PixelStream(std::vector<Bytes> pieces) : pieces_(std::move(pieces)) {}

  void rewind() { piece_ = at_ = 0; }

  // Fills as much of the buffer as there are bytes left; returns how much.
  std::size_t read(std::uint8_t* buffer, std::size_t size) {
    std::size_t done = 0;
    while (done < size && piece_ < pieces_.size()) {
      const Bytes& piece = pieces_[piece_];
      const std::size_t count = std::min(size - done, piece.size() - at_);
      if (count > 0) std::memcpy(buffer + done, piece.data() + at_, count);
      done += count;
      at_ += count;
      if (at_ < piece.size()) continue;
      ++piece_;
      at_ = 0;
    }
    return done;
  }

 private:
  std::vector<Bytes> pieces_;
  std::size_t piece_ = 0, at_ = 0;
};

PixelStream& pixels_of(HPDF_Stream stream) { return *static_cast<PixelStream*>(stream->attr); }

HPDF_STATUS read_pixels(HPDF_Stream stream, HPDF_BYTE* buffer, HPDF_UINT* size) {
  PixelStream& pixels = pixels_of(stream);
  const HPDF_UINT wanted = *size;
  *size = static_cast<HPDF_UINT>(pixels.read(buffer, wanted));
  return *size < wanted ? HPDF_STREAM_EOF : HPDF_OK;
}

HPDF_STATUS rewind_pixels(HPDF_Stream stream, HPDF_INT, HPDF_WhenceMode) {
  pixels_of(stream).rewind();
  return HPDF_OK;
}

HPDF_INT32 tell_pixels(HPDF_Stream) { return 0; }

// libharu only asks whether there is anything.
HPDF_UINT32 size_of_pixels(HPDF_Stream) { return std::numeric_limits<HPDF_UINT32>::max(); }

// What libharu would write, had it compressed the stream itself.
HPDF_STATUS write_filter(HPDF_Dict, HPDF_Stream stream) {
  return HPDF_Stream_WriteStr(stream, "/Filter [ /FlateDecode ]\012");
}

// One entry for the one filter, that is deflate. (image->filterParams would do the same, but is
// leaked when the file cannot be opened.)
void announce_row_filters(HPDF_Doc document, HPDF_Image image, int channels, int width) {
  const HPDF_Array filters = made(document, HPDF_Array_New(image->mmgr));
  HPDF_Dict_Add(image, "DecodeParms", filters);
  const HPDF_Dict deflate = made(document, HPDF_Dict_New(image->mmgr));
  HPDF_Array_Add(filters, deflate);
  HPDF_Dict_AddNumber(deflate, "Predictor", 15);  // PNG filters
  HPDF_Dict_AddNumber(deflate, "Colors", channels);
  HPDF_Dict_AddNumber(deflate, "Columns", width);
}

// The profile as a stream of the file.
HPDF_Dict add_profile(HPDF_Doc document, const std::vector<std::uint8_t>& profile, int channels) {
  const HPDF_Dict stream = made(document, HPDF_DictStream_New(document->mmgr, document->xref));
  stream->filter = HPDF_STREAM_FILTER_FLATE_DECODE;
  HPDF_Dict_AddNumber(stream, "N", channels);
  HPDF_Stream_Write(stream->stream, profile.data(), static_cast<HPDF_UINT>(profile.size()));
  return stream;
}

HPDF_Array based_on(HPDF_Doc document, HPDF_Dict profile) {
  const HPDF_Array space = made(document, HPDF_Array_New(document->mmgr));
  HPDF_Array_AddName(space, "ICCBased");
  HPDF_Array_Add(space, profile);
  return space;
}

// What the page's inks were made for.
void add_output_intent(HPDF_Doc document, HPDF_Dict profile) {
  const HPDF_Array intents = made(document, HPDF_Array_New(document->mmgr));
  HPDF_Dict_Add(document->catalog, "OutputIntents", intents);
  const HPDF_Dict intent = made(document, HPDF_Dict_New(document->mmgr));
  HPDF_Xref_Add(document->xref, intent);
  HPDF_Array_Add(intents, intent);
  HPDF_Dict_AddName(intent, "Type", "OutputIntent");
  HPDF_Dict_AddName(intent, "S", "GTS_PDFX");
  HPDF_Dict_Add(intent, "OutputConditionIdentifier",
                made(document, HPDF_String_New(document->mmgr, "Custom", nullptr)));
  HPDF_Dict_Add(intent, "Info",
                made(document, HPDF_String_New(document->mmgr, "the printer's profile", nullptr)));
  HPDF_Dict_Add(intent, "DestOutputProfile", profile);
}

// A one-pixel image whose size and source are then exchanged: libharu's own loaders all copy.
HPDF_Image add_image(HPDF_Doc document, const PixelBox& box, const Picture& picture,
                     PixelStream& pixels) {
  const std::array<HPDF_BYTE, 4> blank{};
  HPDF_Image image =
      HPDF_LoadRawImageFromMem(document, blank.data(), 1, 1,
                               picture.channels == 3 ? HPDF_CS_DEVICE_RGB : HPDF_CS_DEVICE_CMYK, 8);
  if (image == nullptr) return nullptr;
  HPDF_Dict_AddNumber(image, "Width", box.width());
  HPDF_Dict_AddNumber(image, "Height", box.height());
  announce_row_filters(document, image, picture.channels, box.width());
  image->filter = HPDF_STREAM_FILTER_NONE;
  image->write_fn = write_filter;
  HPDF_Stream_Free(image->stream);
  image->stream = nullptr;
  image->stream = made(document, HPDF_CallbackReader_New(image->mmgr, read_pixels, rewind_pixels,
                                                         tell_pixels, size_of_pixels, &pixels));
  return image;
}

// What is to be printed of a drawing in black, as a PDF's stencil: a bit for each pixel, 0 where
// there is ink, rows in whole bytes. Fine enough for any printer.
struct Stencil {
  int width_px, height_px;
  std::vector<HPDF_BYTE> bits;
};

Stencil stencil_of(const Drawing& letters, const Vec2& size_mm) {
  constexpr double kDpi = 1200, kLongestSide_px = 16000;
  const double dpi = std::min(kDpi, kMmPerInch * kLongestSide_px / size_mm.maxCoeff());
  const auto pixels = [&](double mm) {
    return std::max(1, int(std::lround(mm * dpi / kMmPerInch)));
  };
  const Image image = letters.pixels(pixels(size_mm.x()), pixels(size_mm.y()));
  Stencil stencil{(image.width_px + 7) / 8 * 8, image.height_px, {}};
  stencil.bits.assign(std::size_t(stencil.width_px / 8) * std::size_t(stencil.height_px), 0xff);
  for (int y = 0; y < image.height_px; ++y) {
    HPDF_BYTE* row = &stencil.bits[std::size_t(stencil.width_px / 8) * std::size_t(y)];
    for (int x = 0; x < image.width_px; ++x) {
      // Over white: some fonts have coloured letters.
      const std::uint8_t* pixel = image.pixel(x, y);
      const int dark = pixel[3] * (3 * 255 - pixel[0] - pixel[1] - pixel[2]);
      if (2 * dark >= 3 * 255 * 255) row[x / 8] = HPDF_BYTE(row[x / 8] & ~(0x80 >> (x % 8)));
    }
  }
  return stencil;
}

HPDF_Image add_stencil(HPDF_Doc document, const Stencil& stencil) {
  const HPDF_Image image = made(
      document, HPDF_LoadRawImageFromMem(document, stencil.bits.data(), HPDF_UINT(stencil.width_px),
                                         HPDF_UINT(stencil.height_px), HPDF_CS_DEVICE_GRAY, 1));
  HPDF_Image_SetMask(image, HPDF_TRUE);
  HPDF_Dict_RemoveElement(image, "ColorSpace");  // a stencil has none
  return image;
}

// Into a page's drawing commands, as libharu has no function for it.
void write_raw(HPDF_Page page, const std::string& commands) {
  HPDF_Stream_WriteStr(static_cast<HPDF_PageAttr>(page->attr)->stream, commands.c_str());
}

std::string in_hex(std::string_view bytes) {
  std::string hex;
  for (const char byte : bytes) hex += fmt::format("{:02X}", static_cast<unsigned char>(byte));
  return hex;
}

[[noreturn]] void refuse_date(const std::string& iso) {
  throw InputError(fmt::format("'{}' is not a date; write it as 2026-01-31.", iso));
}

HPDF_Date parse_date(const std::string& iso) {
  std::tm time{};
  const char* rest = strptime(iso.c_str(), "%Y-%m-%d", &time);
  if (rest && *rest != '\0') rest = strptime(rest, "T%H:%M:%S", &time);
  if (rest && *rest == 'Z') ++rest;
  if (!rest || *rest != '\0') refuse_date(iso);
  HPDF_Date date{};
  date.ind = 'Z';
  date.year = time.tm_year + 1900;
  date.month = time.tm_mon + 1;
  date.day = time.tm_mday;
  date.hour = time.tm_hour;
  date.minutes = time.tm_min;
  date.seconds = time.tm_sec;
  return date;
}

// libharu does not notice when the very last bytes do not reach the disk.
bool is_whole(const std::filesystem::path& path) {
  constexpr std::streamoff kTailSize = 16;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file || file.tellg() < kTailSize) return false;
  std::string tail(kTailSize, ' ');
  file.seekg(-kTailSize, std::ios::end);
  file.read(tail.data(), kTailSize);
  return file && tail.find("%%EOF") != std::string::npos;
}

}  // namespace

struct PdfDocument::Impl {
  Document document{HPDF_New(nullptr, nullptr)};
  HPDF_Page page = nullptr;
  HPDF_Font regular = nullptr, bold = nullptr;
  // libharu reads pictures while it saves.
  std::vector<std::unique_ptr<PixelStream>> pictures;

  // Texts with letters that these fonts lack.
  struct Lettering {
    std::string shown;
    std::optional<DrawnLine> line;  // nothing: the fonts have what is shown
    double width = 0;               // at font size 1
  };
  std::map<std::pair<PdfFont, std::string>, Lettering> lettering;

  HPDF_Font font(PdfFont which) const { return which == PdfFont::kBold ? bold : regular; }

  double width_of(const std::string& winansi, PdfFont which) const {
    const auto* bytes = reinterpret_cast<const HPDF_BYTE*>(winansi.data());
    return HPDF_Font_TextWidth(font(which), bytes, static_cast<HPDF_UINT>(winansi.size())).width /
           1000.0;
  }

  const Lettering& lettering_of(const std::string& text, PdfFont which) {
    const auto [at, is_new] = lettering.try_emplace({which, text});
    Lettering& letters = at->second;
    if (!is_new) return letters;
    letters.shown = page_text(text).shown;
    if (!is_winansi(letters.shown)) letters.line = set_line(letters.shown, which == PdfFont::kBold);
    letters.width = letters.line ? std::max(0.0, letters.line->place.max.x())
                                 : width_of(to_winansi(letters.shown), which);
    return letters;
  }

  // The page's x and y axes and origin become the text's for what is drawn until unturn().
  void turn(const PdfText& text) const {
    const auto cosine = static_cast<HPDF_REAL>(text.quarter_turns == 0 ? 1 : 0);
    const auto sine = static_cast<HPDF_REAL>(text.quarter_turns);
    HPDF_Page_GSave(page);
    HPDF_Page_Concat(page, cosine, sine, -sine, cosine, pt(text.start.x()), pt(text.start.y()));
  }
  void unturn() const { HPDF_Page_GRestore(page); }

  void draw_line(const DrawnLine& line, double size_pt) const {
    const double em_mm = size_pt * kMmPerPt;
    const Vec2 corner = em_mm * line.place.min, size = em_mm * (line.place.max - line.place.min);
    const Stencil stencil = stencil_of(line.drawing, size);
    const HPDF_Image image = add_stencil(document.get(), stencil);
    // The last byte of a row may reach beyond the letters.
    const double pixels = std::max(1.0, std::round(size.x() * stencil.height_px / size.y()));
    HPDF_Page_GSave(page);
    HPDF_Page_Concat(page, pt(size.x() * stencil.width_px / pixels), 0, 0, pt(size.y()),
                     pt(corner.x()), pt(corner.y()));
    HPDF_Page_ExecuteXObject(page, image);
    HPDF_Page_GRestore(page);
  }

  // What a reader finds and copies where letters are drawn; nothing of it is seen.
  void write_unseen(const Lettering& letters, const PdfText& text) const {
    constexpr double kLeastScale = 10, kLargestScale = 300;  // libharu's, in percent
    const std::string winansi = to_winansi(letters.shown);
    const double width = width_of(winansi, text.font);
    if (!(width > 0)) return;
    write_raw(page,
              fmt::format("/Span <</ActualText <{}>>> BDC\012", in_hex(to_utf16(letters.shown))));
    HPDF_Page_BeginText(page);
    HPDF_Page_SetFontAndSize(page, font(text.font), static_cast<HPDF_REAL>(text.size_pt));
    HPDF_Page_SetTextRenderingMode(page, HPDF_INVISIBLE);
    HPDF_Page_SetHorizontalScalling(
        page, HPDF_REAL(std::clamp(100 * letters.width / width, kLeastScale, kLargestScale)));
    HPDF_Page_ShowText(page, winansi.c_str());
    HPDF_Page_EndText(page);
    write_raw(page, "EMC\012");
  }
};

PdfDocument::PdfDocument() : impl_(std::make_unique<Impl>()) {
  HPDF_Doc document = impl_->document.get();
  if (document == nullptr) throw std::bad_alloc();
  HPDF_SetCompressionMode(document, HPDF_COMP_ALL);
  HPDF_SetInfoAttr(document, HPDF_INFO_CREATOR, "hydrodip");
  impl_->regular = made(document, HPDF_GetFont(document, "Helvetica", "WinAnsiEncoding"));
  impl_->bold = made(document, HPDF_GetFont(document, "Helvetica-Bold", "WinAnsiEncoding"));
}

PdfDocument::~PdfDocument() = default;

void PdfDocument::forbid_scaling() {
  HPDF_SetViewerPreference(impl_->document.get(), HPDF_PRINT_SCALING_NONE);
}

void PdfDocument::set_title(const std::string& utf8) {
  constexpr std::size_t kLongest = 1000;  // bytes; libharu has a limit
  const std::string title = tidy_utf8(cut_utf8(utf8, kLongest));
  if (title.empty()) return;
  const HPDF_Doc document = impl_->document.get();
  const std::string winansi = to_winansi(title);
  // PDF's encoding of titles agrees with Windows-1252 except here.
  const bool is_plain =
      is_winansi(title) &&
      std::none_of(winansi.begin(), winansi.end(), [](char c) { return (c & 0xE0) == 0x80; });
  if (is_plain) {
    HPDF_SetInfoAttr(document, HPDF_INFO_TITLE, winansi.c_str());
    return;
  }
  std::string utf16 = to_utf16(title);
  HPDF_Dict_Add(
      document->info, "Title",
      made(document, HPDF_Binary_New(document->mmgr, reinterpret_cast<HPDF_BYTE*>(utf16.data()),
                                     static_cast<HPDF_UINT>(utf16.size()))));
}

void PdfDocument::set_date(const std::string& iso) {
  if (HPDF_SetInfoDateAttr(impl_->document.get(), HPDF_INFO_CREATION_DATE, parse_date(iso)) !=
      HPDF_OK)
    refuse_date(iso);
}

void PdfDocument::add_page(double width_mm, double height_mm) {
  if (std::max(width_mm, height_mm) > kLongestPageMm) {
    throw InputError(
        fmt::format("A sheet of {:g} x {:g} mm is more than a PDF page can be ({:g} "
                    "mm); choose a smaller film.",
                    width_mm, height_mm, std::floor(kLongestPageMm)));
  }
  impl_->page = made(impl_->document.get(), HPDF_AddPage(impl_->document.get()));
  HPDF_Page_SetWidth(impl_->page, pt(width_mm));
  HPDF_Page_SetHeight(impl_->page, pt(height_mm));
}

void PdfDocument::transform_about(const Vec2& center, const Mat2& matrix) {
  const Vec2 shift = center - matrix * center;
  HPDF_Page_Concat(impl_->page, HPDF_REAL(matrix(0, 0)), HPDF_REAL(matrix(1, 0)),
                   HPDF_REAL(matrix(0, 1)), HPDF_REAL(matrix(1, 1)), pt(shift.x()), pt(shift.y()));
}

void PdfDocument::draw_image(const Picture& picture, const std::vector<std::uint8_t>& profile,
                             const PixelBox& box, bool mirror, const Box2& place,
                             const RunContext& context) {
  const HPDF_Doc document = impl_->document.get();
  context.progress("writing the PDF", 0);
  impl_->pictures.push_back(std::make_unique<PixelStream>(compressed(picture, box, mirror)));
  const HPDF_Image image =
      made(document, add_image(document, box, picture, *impl_->pictures.back()));
  if (!profile.empty()) {
    const HPDF_Dict stream = add_profile(document, profile, picture.channels);
    if (picture.channels == 4)
      add_output_intent(document, stream);
    else
      HPDF_Dict_Add(image, "ColorSpace", based_on(document, stream));
  }
  HPDF_Page_DrawImage(impl_->page, image, pt(place.min.x()), pt(place.min.y()),
                      pt(place.max.x() - place.min.x()), pt(place.max.y() - place.min.y()));
}

void PdfDocument::set_stroke(double width_mm, double gray, bool square_ends) {
  HPDF_Page_SetGrayStroke(impl_->page, static_cast<HPDF_REAL>(gray));
  HPDF_Page_SetLineWidth(impl_->page, pt(width_mm));
  HPDF_Page_SetLineCap(impl_->page, square_ends ? HPDF_PROJECTING_SCUARE_END : HPDF_BUTT_END);
}

void PdfDocument::draw_lines(const std::vector<PdfLine>& lines) {
  for (const PdfLine& line : lines) {
    HPDF_Page_MoveTo(impl_->page, pt(line[0].x()), pt(line[0].y()));
    HPDF_Page_LineTo(impl_->page, pt(line[1].x()), pt(line[1].y()));
  }
  if (!lines.empty()) HPDF_Page_Stroke(impl_->page);
}

void PdfDocument::draw_dashed_circle(const Vec2& center, double radius_mm) {
  const std::array<HPDF_UINT16, 2> dash = {4, 6};
  HPDF_Page_SetDash(impl_->page, dash.data(), dash.size(), 0);
  HPDF_Page_Circle(impl_->page, pt(center.x()), pt(center.y()), pt(radius_mm));
  HPDF_Page_Stroke(impl_->page);
  HPDF_Page_SetDash(impl_->page, nullptr, 0, 0);
}

void PdfDocument::draw_rectangle(const Box2& box) {
  HPDF_Page_Rectangle(impl_->page, pt(box.min.x()), pt(box.min.y()), pt(box.max.x() - box.min.x()),
                      pt(box.max.y() - box.min.y()));
  HPDF_Page_Stroke(impl_->page);
}

void PdfDocument::fill_rectangle(const Box2& box, double gray) {
  HPDF_Page_SetGrayFill(impl_->page, static_cast<HPDF_REAL>(gray));
  HPDF_Page_Rectangle(impl_->page, pt(box.min.x()), pt(box.min.y()), pt(box.max.x() - box.min.x()),
                      pt(box.max.y() - box.min.y()));
  HPDF_Page_Fill(impl_->page);
}

void PdfDocument::fill_red(const Box2& box) {
  HPDF_Page_SetRGBFill(impl_->page, HPDF_REAL(0.78), HPDF_REAL(0.06), HPDF_REAL(0.10));
  HPDF_Page_Rectangle(impl_->page, pt(box.min.x()), pt(box.min.y()), pt(box.max.x() - box.min.x()),
                      pt(box.max.y() - box.min.y()));
  HPDF_Page_Fill(impl_->page);
}

void PdfDocument::fill_triangle(const std::array<Vec2, 3>& corners, double gray) {
  HPDF_Page_SetGrayFill(impl_->page, static_cast<HPDF_REAL>(gray));
  HPDF_Page_MoveTo(impl_->page, pt(corners[0].x()), pt(corners[0].y()));
  HPDF_Page_LineTo(impl_->page, pt(corners[1].x()), pt(corners[1].y()));
  HPDF_Page_LineTo(impl_->page, pt(corners[2].x()), pt(corners[2].y()));
  HPDF_Page_Fill(impl_->page);
}

void PdfDocument::draw_text(const PdfText& text) {
  const Impl::Lettering& letters = impl_->lettering_of(text.text, text.font);
  const HPDF_Page page = impl_->page;
  HPDF_Page_SetGrayFill(page, static_cast<HPDF_REAL>(text.gray));
  if (letters.line) {
    impl_->turn(text);
    impl_->draw_line(*letters.line, text.size_pt);
    impl_->write_unseen(letters, text);
    impl_->unturn();
    return;
  }
  const auto cosine = static_cast<HPDF_REAL>(text.quarter_turns == 0 ? 1 : 0);
  const auto sine = static_cast<HPDF_REAL>(text.quarter_turns);
  HPDF_Page_BeginText(page);
  HPDF_Page_SetFontAndSize(page, impl_->font(text.font), static_cast<HPDF_REAL>(text.size_pt));
  HPDF_Page_SetTextMatrix(page, cosine, sine, -sine, cosine, pt(text.start.x()),
                          pt(text.start.y()));
  HPDF_Page_ShowText(page, to_winansi(letters.shown).c_str());
  HPDF_Page_EndText(page);
}

double PdfDocument::text_width(const std::string& text, PdfFont font) const {
  return impl_->lettering_of(text, font).width;
}

void PdfDocument::save(const std::filesystem::path& path) {
  HPDF_Doc document = impl_->document.get();
  if (HPDF_GetError(document) != HPDF_OK) refuse_to_compose(document);
  errno = 0;
  const HPDF_STATUS status = HPDF_SaveToFile(document, path.c_str());
  const int reason = errno;
  if (status == HPDF_OK && is_whole(path)) return;
  const bool known = status != HPDF_OK && reason != 0;
  refuse_write(path, known ? std::generic_category().message(reason) : "is it full?");
}

}  // namespace hydrodip
