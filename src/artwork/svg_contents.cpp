// The only place that knows libxml2, which librsvg reads drawings with.
#include "artwork/svg_contents.h"

#include <fmt/format.h>
#include <libxml/tree.h>
#include <libxml/xmlreader.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <memory>
#include <new>
#include <set>

#include "base/error.h"
#include "base/run_scope.h"
#include "base/text.h"

namespace hydrodip {
namespace {

constexpr std::size_t kLargest = std::size_t(1) << 28;

constexpr std::string_view kXlink = "http://www.w3.org/1999/xlink";

struct Free {
  void operator()(xmlTextReader* reader) const { xmlFreeTextReader(reader); }
  void operator()(xmlDoc* document) const { xmlFreeDoc(document); }
  void operator()(xmlChar* text) const { xmlFree(text); }
};

int size_of(std::string_view svg) {
  return int(std::min<std::size_t>(svg.size(), std::numeric_limits<int>::max()));
}

int options_for(std::string_view svg) {
  return XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING |
         (declares_entities(svg) ? 0 : XML_PARSE_HUGE);
}

std::string_view text_of(const xmlChar* text) {
  return text ? std::string_view(reinterpret_cast<const char*>(text)) : std::string_view();
}

bool begins_with(std::string_view text, std::string_view lower_case) {
  return text.size() >= lower_case.size() &&
         std::equal(lower_case.begin(), lower_case.end(), text.begin(), [](char a, char b) {
           return a == std::tolower(static_cast<unsigned char>(b));
         });
}

bool is_picture(std::string_view element) { return element == "image" || element == "feImage"; }

// Elements of which librsvg follows the link, and that show something else without it.
bool shows_its_link(std::string_view element) {
  constexpr std::string_view kElements[] = {"image",          "feImage",        "use",
                                            "linearGradient", "radialGradient", "pattern",
                                            "filter",         "textPath",       "tref"};
  return std::find(std::begin(kElements), std::end(kElements), element) != std::end(kElements);
}

// Without what stands between /* and */.
std::string without_comments(std::string_view css) {
  std::string out;
  for (std::size_t at = 0; at < css.size();) {
    const std::size_t begin = std::min(css.find("/*", at), css.size());
    out += css.substr(at, begin - at);
    const std::size_t end = begin < css.size() ? css.find("*/", begin + 2) : css.npos;
    at = end == css.npos ? css.size() : end + 2;
  }
  return out;
}

class ContentsReader {
 public:
  ContentsReader(std::string_view svg, const std::function<bool(const std::string&)>& shows)
      : shows_(shows),
        document_(xmlReadMemory(svg.data(), size_of(svg), nullptr, nullptr, options_for(svg))),
        reader_(document_ ? xmlReaderWalker(document_.get()) : nullptr) {
    if (document_ && !reader_) throw std::bad_alloc();
  }

  SvgContents run() {
    CheckEvery check(1 << 10);
    while (reader_ && xmlTextReaderRead(reader_.get()) == 1) {
      check();
      take_node();
    }
    return std::move(contents_);
  }

 private:
  void take_node() {
    switch (xmlTextReaderNodeType(reader_.get())) {
      case XML_READER_TYPE_ELEMENT:
        take_element();
        break;
      case XML_READER_TYPE_END_ELEMENT:
        in_style_ = false;
        break;
      case XML_READER_TYPE_TEXT:
      case XML_READER_TYPE_CDATA:
        if (in_style_) take_style(text_of(xmlTextReaderConstValue(reader_.get())));
        break;
      case XML_READER_TYPE_PROCESSING_INSTRUCTION:
        take_instruction();
        break;
      default:
        break;
    }
  }

  void take_element() {
    const std::string name(text_of(xmlTextReaderConstLocalName(reader_.get())));
    in_style_ = name == "style" && xmlTextReaderIsEmptyElement(reader_.get()) == 0;
    contents_.has_text = contents_.has_text || name == "text";
    std::string link;
    bool has_plain_link = false;  // goes before XLink's
    while (xmlTextReaderMoveToNextAttribute(reader_.get()) == 1) {
      const std::string_view value = text_of(xmlTextReaderConstValue(reader_.get()));
      const std::string_view space = text_of(xmlTextReaderConstNamespaceUri(reader_.get()));
      const bool is_plain = space.empty();
      if (text_of(xmlTextReaderConstLocalName(reader_.get())) != "href") {
        take_urls(value);
      } else if (is_plain || (!has_plain_link && space == kXlink)) {
        link = trimmed(value);
        has_plain_link = is_plain;
      }
    }
    if (!shows_its_link(name)) return;
    if (!is_picture(name) || !begins_with(link, "data:"))
      take_link(link);
    else if (!shows_(link))
      ++contents_.unreadable_pictures;
  }

  void take_link(std::string_view link) {
    constexpr std::size_t kLongest = 200;
    link = trimmed(link);
    if (link.empty() || link.front() == '#' || begins_with(link, "data:")) return;
    std::string shown(link.substr(0, kLongest));
    if (known_.insert(shown).second) contents_.outside.push_back(std::move(shown));
  }

  // Of attributes and styles: url(...), with or without quotation marks.
  void take_urls(std::string_view text) {
    for (std::size_t at = text.find('('); at != text.npos; at = text.find('(', at + 1)) {
      if (at < 3 || !begins_with(text.substr(at - 3), "url")) continue;
      std::string_view link = trimmed(text.substr(at + 1));
      const char quote = link.empty() ? ' ' : link.front();
      const bool quoted = quote == '"' || quote == '\'';
      if (quoted) link.remove_prefix(1);
      const std::size_t end = link.find(quoted ? quote : ')');
      if (end == link.npos) return;
      take_link(link.substr(0, end));
    }
  }

  void take_style(std::string_view text) {
    constexpr std::string_view kImport = "@import";
    const std::string css = without_comments(text);
    take_urls(css);
    for (std::size_t at = css.find(kImport); at != css.npos; at = css.find(kImport, at + 1)) {
      const std::string_view link = trimmed(std::string_view(css).substr(at + kImport.size()));
      if (link.empty() || (link.front() != '"' && link.front() != '\'')) continue;
      take_link(link.substr(1, std::min(link.find(link.front(), 1), link.size()) - 1));
    }
  }

  // <?xml-stylesheet type="text/css" href="style.css"?>
  void take_instruction() {
    constexpr std::string_view kLink = "href=";
    if (text_of(xmlTextReaderConstLocalName(reader_.get())) != "xml-stylesheet") return;
    std::string_view value = text_of(xmlTextReaderConstValue(reader_.get()));
    const std::size_t at = value.find(kLink);
    if (at == value.npos || at + kLink.size() >= value.size()) return;
    value.remove_prefix(at + kLink.size());
    take_link(value.substr(1, std::min(value.find(value.front(), 1), value.size()) - 1));
  }

  const std::function<bool(const std::string&)>& shows_;
  // A reader of its own goes over a large picture again for every 512 bytes of it.
  std::unique_ptr<xmlDoc, Free> document_;
  std::unique_ptr<xmlTextReader, Free> reader_;
  SvgContents contents_;
  std::set<std::string> known_;
  bool in_style_ = false;
};

// The attribute that librsvg goes by; null if there is none.
xmlAttr* link_of(const xmlNode* element) {
  xmlAttr* found = nullptr;
  for (xmlAttr* attribute = element->properties; attribute; attribute = attribute->next) {
    if (text_of(attribute->name) != "href") continue;
    if (!attribute->ns) return attribute;
    if (!found && text_of(attribute->ns->href) == kXlink) found = attribute;
  }
  return found;
}

// In the file's order, without going into what entities stand for.
xmlNode* next_node(xmlNode* node) {
  if (node->children && node->type == XML_ELEMENT_NODE) return node->children;
  while (node && !node->next) node = node->parent;
  return node ? node->next : nullptr;
}

bool is_packed(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() > 2 && bytes[0] == 0x1f && bytes[1] == 0x8b;
}

// The first so many bytes of what gzip packed, or all; nothing if it is damaged before that.
std::vector<std::uint8_t> unpacked(const std::vector<std::uint8_t>& bytes, std::size_t most) {
  constexpr std::size_t kPiece = std::size_t(1) << 16;
  constexpr int kGzip = 16 + MAX_WBITS;
  z_stream stream{};
  if (bytes.size() > kLargest || inflateInit2(&stream, kGzip) != Z_OK) return {};
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = uInt(bytes.size());
  std::vector<std::uint8_t> out;
  int status = Z_OK;
  while (status == Z_OK && out.size() < most) {
    const std::size_t had = out.size();
    out.resize(std::min(most, had + kPiece));
    stream.next_out = out.data() + had;
    stream.avail_out = uInt(out.size() - had);
    status = inflate(&stream, Z_NO_FLUSH);
    out.resize(out.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  const bool whole = status == Z_STREAM_END || out.size() == most;
  return whole ? out : std::vector<std::uint8_t>();
}

// "<svg", or with a prefix of its own: "<s:svg".
bool has_root(std::string_view text) {
  for (std::size_t at = text.find("svg"); at != text.npos; at = text.find("svg", at + 1)) {
    std::size_t begin = at;
    if (begin > 0 && text[begin - 1] == ':') --begin;
    while (begin > 0 && begin < at &&
           (std::isalnum(static_cast<unsigned char>(text[begin - 1])) != 0 ||
            std::string_view("_-.").find(text[begin - 1]) != std::string_view::npos))
      --begin;
    if (begin > 0 && text[begin - 1] == '<') return true;
  }
  return false;
}

}  // namespace

bool declares_entities(std::string_view svg) {
  // Two or four bytes a letter, too.
  constexpr std::string_view kWord = "<!ENTITY";
  std::size_t matched = 0;
  CheckEvery check(1 << 20);
  for (const char c : svg) {
    check();
    if (c == '\0') continue;
    matched = c == kWord[matched] ? matched + 1 : c == kWord[0] ? 1 : 0;
    if (matched == kWord.size()) return true;
  }
  return false;
}

SvgContents contents_of(std::string_view svg,
                        const std::function<bool(const std::string&)>& shows) {
  return ContentsReader(svg, shows).run();
}

std::string with_pictures(std::string_view svg, const std::map<std::string, std::string>& instead) {
  const std::unique_ptr<xmlDoc, Free> document(
      xmlReadMemory(svg.data(), size_of(svg), nullptr, nullptr, options_for(svg)));
  if (!document) throw std::bad_alloc();
  CheckEvery check(1 << 10);
  for (xmlNode* node = document->children; node; node = next_node(node)) {
    check();
    if (node->type != XML_ELEMENT_NODE || !is_picture(text_of(node->name))) continue;
    xmlAttr* link = link_of(node);
    if (!link) continue;
    const std::unique_ptr<xmlChar, Free> value(
        xmlNodeListGetString(document.get(), link->children, 1));
    const auto other = instead.find(std::string(trimmed(text_of(value.get()))));
    if (other != instead.end() &&
        !xmlSetNsProp(node, link->ns, link->name,
                      reinterpret_cast<const xmlChar*>(other->second.c_str())))
      throw std::bad_alloc();
  }
  xmlChar* text = nullptr;
  int size = 0;
  xmlDocDumpMemory(document.get(), &text, &size);
  const std::unique_ptr<xmlChar, Free> owned(text);
  if (!text) throw std::bad_alloc();
  return {reinterpret_cast<const char*>(text), std::size_t(size)};
}

bool looks_like_svg(const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kLooked = 4096;
  const std::vector<std::uint8_t> first =
      is_packed(bytes)
          ? unpacked(bytes, kLooked)
          : std::vector(bytes.begin(),
                        bytes.begin() + std::ptrdiff_t(std::min(bytes.size(), kLooked)));
  const std::string_view text(reinterpret_cast<const char*>(first.data()), first.size());
  const std::size_t start = text.find_first_not_of("\xef\xbb\xbf \t\r\n");
  return start != std::string_view::npos && text[start] == '<' && has_root(text);
}

std::vector<std::uint8_t> unpacked_svg(const std::vector<std::uint8_t>& bytes,
                                       const std::string& name) {
  if (!is_packed(bytes)) return bytes;
  std::vector<std::uint8_t> svg = unpacked(bytes, kLargest);
  if (svg.empty())
    throw InputError(fmt::format(
        "{}: damaged or truncated SVG drawing (it cannot be unpacked); save it again.", name));
  if (svg.size() >= kLargest)
    throw InputError(fmt::format(
        "{}: unpacked, the SVG drawing has more than {:.0f} MB; make it simpler, or give a PNG.",
        name, double(kLargest) / 1e6));
  return svg;
}

}  // namespace hydrodip
