#include "studio/adoption.h"

#include <algorithm>
#include <utility>

#include "studio/job_files.h"

namespace hydrodip {

Adoption::Adoption(std::vector<std::string> names) : names_(std::move(names)) {
  job_ = first("job");
  if (job_.empty()) model_ = first("model");
}

std::string Adoption::first(const std::string& kind) const {
  const auto found = std::find_if(names_.begin(), names_.end(), [&](const std::string& name) {
    return kind_of_file(name) == kind;
  });
  return found == names_.end() ? std::string() : *found;
}

std::string Adoption::use_of(const std::string& name) const {
  const std::string kind = kind_of_file(name);
  const bool is_part = !job_.empty() || name == model_ || name == texture_ || parts_.contains(name);
  if (kind == "job" || (kind == "model" && is_part)) return "";
  if (is_part) return "part";
  return kind == "picture" ? "layer" : "unused";
}

void Adoption::put_into(Json& document) const {
  if (!model_.empty()) {
    document["object"]["file"] = model_;
    document["object"].erase("texture");
    if (!texture_.empty()) document["object"]["texture"] = texture_;
  }
  for (const std::string& name : names_) {
    if (use_of(name) != "layer") continue;
    Json layer;
    layer["image"] = name;
    document["artwork"].push_back(layer);
  }
}

Json Adoption::told() const {
  Json list = Json::array();
  const auto tell = [&](const std::string& name, const std::string& as, const std::string& text) {
    list.push_back({{"file", name}, {"as", as}, {"text", text}});
  };
  if (!job_.empty()) tell(job_, "job", "");
  if (!model_.empty()) tell(model_, "model", "");
  for (const std::string& name : names_) {
    const std::string use = use_of(name);
    if (use == "unused")
      tell(name, use, "The studio does not know what to do with this file.");
    else if (!use.empty())
      tell(name, use, "");
  }
  return list;
}

}  // namespace hydrodip
