#include "studio/shown_results.h"

#include <fmt/format.h>

#include <charconv>
#include <iterator>
#include <set>

#include "settings/dip_tables.h"

namespace hydrodip {
namespace {

constexpr std::size_t kMeshesKept = 8, kResultsKept = 6;

}  // namespace

// ---- IDs ----

std::string ShownIds::next(char kind) { return fmt::format("{}{}{}", prefix_, kind, number()); }

bool ShownIds::has_given(const std::string& id) const {
  if (!id.starts_with(prefix_) || id.size() < prefix_.size() + 2) return false;
  const char kind = id[prefix_.size()];
  long number = 0;
  const char* const end = id.data() + id.size();
  const auto [rest, error] = std::from_chars(id.data() + prefix_.size() + 1, end, number);
  return (kind == 'm' || kind == 'r' || kind == 'f') && error == std::errc() && rest == end &&
         number > 0 && number <= *numbers_;
}

// ---- what is shown ----

void ShownResults::add_mesh(const std::string& id, std::shared_ptr<const ShownMesh> made) {
  meshes_.emplace_front(id, std::move(made));
  // The model's own mesh and the finish stay.
  for (auto old = std::prev(meshes_.end()); meshes_.size() > kMeshesKept; --old)
    if (old->first != model_mesh_ && old->first != finish_meshes_[0] &&
        old->first != finish_meshes_[1])
      old = meshes_.erase(old);
}

void ShownResults::add_result(Result result) {
  results_.push_front(std::move(result));
  std::set<std::size_t> seen;
  std::size_t kept = 0;
  for (auto shown = results_.begin(); shown != results_.end();) {
    const bool newest = seen.insert(shown->dip).second && seen.size() <= std::size_t(kMostDips);
    if (newest || kept < kResultsKept) {
      ++kept;
      ++shown;
    } else {
      shown = results_.erase(shown);
    }
  }
}

void ShownResults::set_finish(const std::string& id, Bytes bundle,
                              const std::array<std::string, 2>& meshes) {
  finish_ = {id, std::move(bundle)};
  finish_meshes_ = meshes;
}

std::vector<std::pair<std::string, Json>> ShownResults::events() const {
  std::vector<std::pair<std::string, Json>> list;
  const auto held = [&](const char* event) {
    const auto known = held_.find(event);
    if (known != held_.end() && !known->second.is_null()) list.emplace_back(*known);
  };
  held("mesh");
  // The newest of each dip, the last one last.
  std::set<std::size_t> told;
  std::vector<Json> newest;
  for (const Result& shown : results_)
    if (told.insert(shown.dip).second) newest.push_back(shown.event);
  for (auto event = newest.rbegin(); event != newest.rend(); ++event)
    list.emplace_back("result", *event);
  held("finish");
  held("problem");
  return list;
}

ShownResults::Bytes ShownResults::mesh(const std::string& id) const {
  for (const auto& [known, shown] : meshes_)
    if (known == id) return {shown, &shown->bundle};
  return nullptr;
}

std::shared_ptr<const ShownTexture> ShownResults::texture(const std::string& id,
                                                          std::size_t number) const {
  for (const auto& [known, shown] : meshes_)
    if (known == id && number < shown->textures.size()) return shown->textures[number];
  return nullptr;
}

ShownResults::Bytes ShownResults::result(const std::string& id) const {
  for (const Result& shown : results_)
    if (shown.id == id) return shown.bundle;
  return nullptr;
}

ShownResults::Bytes ShownResults::finish(const std::string& id) const {
  return id == finish_.first ? finish_.second : nullptr;
}

std::shared_ptr<const Designed> ShownResults::made(const std::string& id) const {
  for (const Result& shown : results_)
    if (shown.id == id) return shown.made;
  return nullptr;
}

}  // namespace hydrodip
