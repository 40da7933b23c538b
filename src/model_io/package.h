// The ZIP archive that a 3MF file is, and the XML in it, read piece by piece: nothing is unpacked
// as a whole but pictures.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "model_io/model_file.h"

namespace hydrodip {

class Package {
 public:
  // Throws InputError naming `path` if the bytes, which must outlive this, are no ZIP archive.
  Package(const std::string& path, const FileBytes& bytes);
  ~Package();
  Package(const Package&) = delete;
  Package& operator=(const Package&) = delete;

  const std::vector<std::string>& names() const { return names_; }
  // A part's name as stored, found in any letter case and with or without a leading slash, or "".
  std::string find(const std::string& name) const;
  FileBytes read(const std::string& name);

  // One part as a stream. All parts together may unpack to some hundred times the archive: more is
  // a bomb, and refused.
  class Stream {
   public:
    Stream(Package& package, const std::string& name);
    ~Stream();
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
    // The next bytes, 0 at the end.
    std::size_t read(char* out, std::size_t size);

   private:
    Package& package_;
    void* file_ = nullptr;
  };

 private:
  [[noreturn]] void damaged() const;

  const std::string& path_;
  void* archive_ = nullptr;
  std::vector<std::string> names_;
  // The first of each name, as stored and as find() compares them.
  std::unordered_map<std::string, std::size_t> stored_, wanted_;
  double unpacked_left_ = 0;
};

// One start or end tag.
struct Tag {
  std::string_view prefix;  // of the namespace, or ""
  std::string_view name;
  bool closing = false;  // </name>
  bool empty = false;    // <name/>
  // Raw: numbers and ids hold no entities. With their prefixes.
  std::vector<std::pair<std::string_view, std::string_view>> attributes;

  // By the name without its prefix; null if there is none.
  const std::string_view* find(std::string_view name) const;
  // With entities decoded; "" if there is none.
  std::string text(std::string_view name) const;
};

// Tags one after another; their views are valid until the next. Throws InputError for damaged XML
// and declarations, which 3MF does not allow.
class XmlTags {
 public:
  XmlTags(const std::string& path, Package::Stream& stream, const RunContext& context);
  bool next(Tag& tag);
  // Skips what is inside of an element whose start tag was read last.
  void skip_element(const Tag& start);

 private:
  [[noreturn]] void damaged() const;
  bool more();
  void skip_past(std::string_view mark);
  std::size_t tag_end();
  void parse(std::string_view text, Tag& tag) const;

  const std::string& path_;
  Package::Stream& stream_;
  CancelCheck cancel_;
  std::string window_;
  std::size_t at_ = 0;  // in it
  bool begins_ = true;  // nothing was read yet
  int depth_ = 0;
};

}  // namespace hydrodip
