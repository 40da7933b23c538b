#include "studio/tabs.h"

#include <algorithm>

#include "studio/api_error.h"

namespace hydrodip {
namespace {

constexpr std::size_t kMostTabs = 12;

}  // namespace

std::shared_ptr<EventStream> Tabs::connect(const std::string& client) {
  for (const Tab& tab : tabs_)
    if (tab.client == client) tab.stream->close();
  std::erase_if(tabs_, [&](const Tab& tab) { return tab.client == client; });
  if (tabs_.size() >= kMostTabs)
    throw ApiError(503, "busy", "The job is open in too many tabs; close some.");
  auto stream = std::make_shared<EventStream>();
  tabs_.push_back({client, stream});
  none_since_.reset();
  if (pen_.empty()) pen_ = client;
  return stream;
}

bool Tabs::disconnect(const std::string& client, const std::shared_ptr<EventStream>& stream) {
  if (std::erase_if(tabs_, [&](const Tab& tab) { return tab.stream == stream; }) == 0) return false;
  if (tabs_.empty()) none_since_ = std::chrono::steady_clock::now();
  if (pen_ == client) give_pen(tabs_.empty() ? "" : tabs_.front().client);
  return true;
}

bool Tabs::any_but(const std::string& client) const {
  return std::any_of(tabs_.begin(), tabs_.end(), [&](const Tab& t) { return t.client != client; });
}

void Tabs::close(const std::string& text) {
  Json event;
  event["text"] = text;
  tell("bye", event);
  for (const Tab& tab : tabs_) tab.stream->close();
  tabs_.clear();
  none_since_ = std::chrono::steady_clock::now();
}

void Tabs::give_pen(const std::string& client) {
  pen_ = client;
  for (const Tab& tab : tabs_) {
    Json event;
    event["mine"] = tab.client == pen_;
    tab.stream->push("pen", event);
  }
}

void Tabs::take_pen(const std::string& client) {
  const bool known =
      std::any_of(tabs_.begin(), tabs_.end(), [&](const Tab& t) { return t.client == client; });
  if (!known) throw ApiError(404, "not-found", "This tab gets no events yet; connect first.");
  give_pen(client);
}

void Tabs::require_pen(const std::string& client) const {
  if (pen_.empty() || pen_ == client) return;
  throw ApiError(409, "no-pen", "The job is open in another tab; take over there or here.");
}

void Tabs::tell(const std::string& event, const Json& data, bool newest_only,
                const std::string& about) const {
  for (const Tab& tab : tabs_) tab.stream->push(event, data, newest_only, about);
}

void Tabs::tell_others(const std::string& client, const std::string& event,
                       const Json& data) const {
  for (const Tab& tab : tabs_)
    if (tab.client != client) tab.stream->push(event, data, true);
}

}  // namespace hydrodip
