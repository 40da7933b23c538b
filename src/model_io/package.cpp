#include "model_io/package.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <charconv>

#include "base/error.h"
#include "base/unicode.h"
#include "model_io/text.h"

namespace hydrodip {

namespace {

constexpr double kFreelyUnpacked = 64e6;  // bytes, however small the archive is
constexpr double kMostRatio =
    100;  // a model's XML packs to a tenth, a very regular one's to a fortieth
constexpr std::size_t kPiece = 1 << 16;
constexpr std::size_t kLongestTag = 1 << 22;
constexpr std::size_t kLongestEntity = 11;  // "&#x10ffff;", and one zero
constexpr int kMaxDepth = 64;

std::string decoded(std::string_view raw) {
  static constexpr std::pair<std::string_view, char> kNamed[] = {
      {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
  std::string out;
  while (!raw.empty()) {
    // Never further than an entity is long: there may be millions of "&".
    const std::size_t end =
        raw.front() == '&' ? raw.substr(0, kLongestEntity).find(';') : std::string_view::npos;
    if (end == std::string_view::npos) {
      out += raw.front();
      raw.remove_prefix(1);
      continue;
    }
    std::string_view entity = raw.substr(1, end - 1);
    raw.remove_prefix(end + 1);
    if (entity.starts_with("#")) {
      const bool hex = entity.starts_with("#x");
      entity.remove_prefix(hex ? 2 : 1);
      std::uint32_t code = 0;
      std::from_chars(entity.data(), entity.data() + entity.size(), code, hex ? 16 : 10);
      if (code < 0x110000) append_utf8(code, out);
    } else {
      for (const auto& [name, character] : kNamed)
        if (entity == name) out += character;
    }
  }
  return out;
}

// In any letter case, with a leading slash or without.
std::string comparable(std::string_view name) {
  if (name.starts_with("/")) name.remove_prefix(1);
  return lower(name);
}

}  // namespace

// ---- ZIP ----------------------------------------------------------------------------------------

Package::Package(const std::string& path, const FileBytes& bytes)
    : path_(path), unpacked_left_(kFreelyUnpacked + kMostRatio * double(bytes.size())) {
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, nullptr);
  zip_t* archive = source ? zip_open_from_source(source, ZIP_RDONLY, nullptr) : nullptr;
  if (!archive) {
    if (source) zip_source_free(source);
    damaged();
  }
  archive_ = archive;
  const zip_int64_t count = zip_get_num_entries(archive, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(archive, zip_uint64_t(i), ZIP_FL_ENC_GUESS);
    names_.emplace_back(name ? name : "");
    stored_.try_emplace(names_.back(), names_.size() - 1);
    wanted_.try_emplace(comparable(names_.back()), names_.size() - 1);
  }
}

Package::~Package() { zip_discard(static_cast<zip_t*>(archive_)); }

void Package::damaged() const {
  refuse_model(path_, "not a 3MF file, or a damaged or cut-off one");
}

std::string Package::find(const std::string& name) const {
  const auto known = wanted_.find(comparable(name));
  return known == wanted_.end() ? "" : names_[known->second];
}

FileBytes Package::read(const std::string& name) {
  Stream stream(*this, name);
  FileBytes bytes;
  char piece[kPiece];
  while (const std::size_t count = stream.read(piece, sizeof piece))
    bytes.insert(bytes.end(), piece, piece + count);
  return bytes;
}

Package::Stream::Stream(Package& package, const std::string& name) : package_(package) {
  auto* archive = static_cast<zip_t*>(package.archive_);
  const auto known = package.stored_.find(name);
  if (known == package.stored_.end()) package.damaged();
  const zip_uint64_t number = known->second;
  zip_stat_t about;
  if (zip_stat_index(archive, number, 0, &about) == 0 && (about.valid & ZIP_STAT_SIZE) &&
      double(about.size) > package.unpacked_left_)
    throw InputError(fmt::format(
        "{}: its part {} unpacks to {:.0f} MB, far more than any model of this size; export it "
        "again.",
        package.path_, shown(name), double(about.size) / 1e6));
  file_ = zip_fopen_index(archive, number, 0);
  if (!file_) package.damaged();
}

Package::Stream::~Stream() { zip_fclose(static_cast<zip_file_t*>(file_)); }

std::size_t Package::Stream::read(char* out, std::size_t size) {
  const zip_int64_t count = zip_fread(static_cast<zip_file_t*>(file_), out, size);
  if (count < 0) package_.damaged();
  package_.unpacked_left_ -= double(count);
  if (package_.unpacked_left_ < 0)
    refuse_model(package_.path_, "it unpacks to far more than any model of this size");
  return std::size_t(count);
}

// ---- XML ----------------------------------------------------------------------------------------

const std::string_view* Tag::find(std::string_view wanted) const {
  for (const auto& [key, value] : attributes)
    if (key == wanted || (key.size() > wanted.size() && key.ends_with(wanted) &&
                          key[key.size() - wanted.size() - 1] == ':'))
      return &value;
  return nullptr;
}

std::string Tag::text(std::string_view wanted) const {
  const std::string_view* raw = find(wanted);
  return raw ? decoded(*raw) : "";
}

XmlTags::XmlTags(const std::string& path, Package::Stream& stream, const RunContext& context)
    : path_(path), stream_(stream), cancel_(context) {}

void XmlTags::damaged() const { refuse_model(path_, "its XML is damaged"); }

// Reads on, and forgets what is behind; false at the end.
bool XmlTags::more() {
  window_.erase(0, at_);
  at_ = 0;
  if (window_.size() > kLongestTag) damaged();
  const std::size_t had = window_.size();
  window_.resize(had + kPiece);
  const std::size_t count = stream_.read(window_.data() + had, kPiece);
  window_.resize(had + count);
  if (begins_ && (window_.starts_with("\xff\xfe") || window_.starts_with("\xfe\xff")))
    refuse_model(path_, "its XML is written in UTF-16, which is not read");
  begins_ = false;
  return count > 0;
}

void XmlTags::skip_past(std::string_view mark) {
  for (;;) {
    const std::size_t found = window_.find(mark, at_);
    if (found != std::string::npos) {
      at_ = found + mark.size();
      return;
    }
    at_ = std::max(at_, window_.size() - std::min(window_.size(), mark.size() - 1));
    cancel_();
    if (!more()) damaged();
  }
}

// Where the tag that begins at at_ has its '>', which may stand in quotes before that.
std::size_t XmlTags::tag_end() {
  char quote = 0;
  for (std::size_t i = at_;; ++i) {
    if (i >= window_.size()) {
      const std::size_t ahead = i - at_;
      if (!more()) damaged();
      i = at_ + ahead;
    }
    const char c = window_[i];
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return i;
    }
  }
}

bool XmlTags::next(Tag& tag) {
  for (;;) {
    cancel_();
    const std::size_t open = window_.find('<', at_);
    if (open == std::string::npos) {
      at_ = window_.size();
      if (more()) continue;
      if (depth_ != 0) refuse_model(path_, "its XML ends too early");
      return false;
    }
    at_ = open;
    while (window_.size() - at_ < 9 && more()) {
    }
    const std::string_view ahead = std::string_view(window_).substr(at_);
    if (ahead.starts_with("<!--")) {
      skip_past("-->");
    } else if (ahead.starts_with("<?")) {
      skip_past("?>");
    } else if (ahead.starts_with("<![CDATA[")) {
      skip_past("]]>");
    } else if (ahead.starts_with("<!")) {
      refuse_model(path_, "its XML has declarations that 3MF does not allow");
    } else {
      const std::size_t end = tag_end();
      parse(std::string_view(window_).substr(at_ + 1, end - at_ - 1), tag);
      at_ = end + 1;
      if (!tag.empty) depth_ += tag.closing ? -1 : 1;
      if (depth_ > kMaxDepth || depth_ < 0) damaged();
      return true;
    }
  }
}

void XmlTags::skip_element(const Tag& start) {
  if (start.empty || start.closing) return;
  const int outside = depth_ - 1;
  Tag inner;
  while (depth_ > outside)
    if (!next(inner)) damaged();
}

void XmlTags::parse(std::string_view text, Tag& tag) const {
  tag.attributes.clear();
  tag.closing = text.starts_with("/");
  if (tag.closing) text.remove_prefix(1);
  tag.empty = text.ends_with("/");
  if (tag.empty) text.remove_suffix(1);
  const auto name_end = [](std::string_view rest) {
    std::size_t end = 0;
    while (end < rest.size() && !is_blank(rest[end]) && rest[end] != '=') ++end;
    return end;
  };
  tag.name = text.substr(0, name_end(text));
  if (tag.name.empty()) damaged();
  text.remove_prefix(tag.name.size());
  const std::size_t colon = tag.name.find(':');
  tag.prefix = colon == std::string_view::npos ? std::string_view() : tag.name.substr(0, colon);
  if (colon != std::string_view::npos) tag.name.remove_prefix(colon + 1);
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::string_view key = text.substr(0, name_end(text));
    text = trimmed(text.substr(key.size()));
    if (key.empty() || text.empty() || text.front() != '=') damaged();
    text = trimmed(text.substr(1));
    if (text.empty() || (text.front() != '"' && text.front() != '\'')) damaged();
    const std::size_t end = text.find(text.front(), 1);
    if (end == std::string_view::npos) damaged();
    tag.attributes.emplace_back(key, text.substr(1, end - 1));
    text.remove_prefix(end + 1);
  }
}

}  // namespace hydrodip
