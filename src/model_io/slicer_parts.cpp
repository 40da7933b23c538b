#include "model_io/slicer_parts.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "model_io/text.h"

namespace hydrodip {

namespace {

struct Kind {
  const char* bambu;
  const char* prusa;
  const char* plain;
};

constexpr std::array<Kind, 4> kKinds = {{
    {"modifier_part", "ParameterModifier", "modifiers of a slicer"},
    {"negative_part", "NegativeVolume", "negative parts of a slicer, which would cut holes"},
    {"support_blocker", "SupportBlocker", "support blockers of a slicer"},
    {"support_enforcer", "SupportEnforcer", "support enforcers of a slicer"},
}};

// Nothing for parts of the shape.
const char* kind_of(const std::string& name) {
  for (const Kind& kind : kKinds)
    if (name == kind.bambu || name == kind.prusa) return kind.plain;
  return nullptr;
}

std::int64_t number(const Tag& tag, std::string_view name) {
  std::int64_t value = -1;
  const std::string_view* text = tag.find(name);
  return text && parse_integer(*text, value) ? value : -1;
}

// <object id><part id subtype>, or <object id><volume firstid lastid> with
// <metadata type="volume" key="volume_type" value> in it, before 2020 key="modifier" value="1".
void read_settings(XmlTags& tags, SlicerParts& parts) {
  Tag tag;
  std::int64_t object = -1;
  SlicerParts::Range volume{-1, -1};
  while (tags.next(tag)) {
    if (tag.closing) {
      if (tag.name == "volume") volume = {-1, -1};
    } else if (tag.name == "object") {
      object = number(tag, "id");
    } else if (tag.name == "part") {
      const char* kind = kind_of(tag.text("subtype"));
      if (!kind) continue;
      parts.components.insert({object, number(tag, "id")});
      parts.kinds.insert(kind);
    } else if (tag.name == "volume") {
      volume = {number(tag, "firstid"), number(tag, "lastid")};
    } else if (tag.name == "metadata" && volume.first >= 0) {
      const bool old = tag.text("key") == "modifier" && tag.text("value") == "1";
      const char* kind = old                                ? kKinds[0].plain
                         : tag.text("key") == "volume_type" ? kind_of(tag.text("value"))
                                                            : nullptr;
      if (!kind) continue;
      parts.triangles[object].push_back(volume);
      parts.kinds.insert(kind);
    }
  }
}

void sort_and_join(std::vector<SlicerParts::Range>& ranges) {
  std::sort(ranges.begin(), ranges.end());
  std::vector<SlicerParts::Range> apart;
  for (const SlicerParts::Range& range : ranges) {
    if (apart.empty() || range.first > apart.back().second) {
      apart.push_back(range);
    } else {
      apart.back().second = std::max(apart.back().second, range.second);
    }
  }
  ranges = std::move(apart);
}

}  // namespace

SlicerParts read_slicer_parts(const std::string& path, Package& package,
                              const RunContext& context) {
  SlicerParts parts;
  for (const char* name : {"Metadata/model_settings.config", "Metadata/Slic3r_PE_model.config"}) {
    const std::string stored = package.find(name);
    if (stored.empty()) continue;
    try {
      Package::Stream stream(package, stored);
      XmlTags tags(path, stream, context);
      read_settings(tags, parts);
    } catch (const InputError&) {
      // The shapes themselves may be well.
    }
  }
  for (auto& [object, ranges] : parts.triangles) sort_and_join(ranges);
  return parts;
}

}  // namespace hydrodip
