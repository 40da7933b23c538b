// What an SVG drawing's file holds, and what it only points to.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hydrodip {

struct SvgContents {
  bool has_text = false;
  // What it would show or be styled by if that were in its file: pictures, parts of other drawings,
  // style sheets, fonts; as written there, each once, in the file's order.
  std::vector<std::string> outside;
  int unreadable_pictures = 0;  // of those in the file
};

// libxml2 and librsvg take 10 MB for a piece of text, which large pictures exceed, so that entities
// that stand for each other do not become gigabytes. A drawing that declares none needs no limits
// beside that of unpacked_svg().
bool declares_entities(std::string_view svg);

// Of a drawing that is well-formed. shows: whether a picture in the file ("data:...") can be shown.
SvgContents contents_of(std::string_view svg, const std::function<bool(const std::string&)>& shows);

// The drawing with other pictures in it: of each link to one in the file ("data:...", as `shows` of
// contents_of has it) what is to stand in its place. The drawing is well-formed.
std::string with_pictures(std::string_view svg, const std::map<std::string, std::string>& instead);

// Whether a file's first bytes are those of an SVG drawing, packed (.svgz) or not.
bool looks_like_svg(const std::vector<std::uint8_t>& bytes);

// An .svgz drawing unpacked, any other as it is. Throws InputError naming `name`: damaged, or more
// than a quarter of a gigabyte.
std::vector<std::uint8_t> unpacked_svg(const std::vector<std::uint8_t>& bytes,
                                       const std::string& name);

}  // namespace hydrodip
