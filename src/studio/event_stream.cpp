#include "studio/event_stream.h"

namespace hydrodip {
namespace {

// A tab that sleeps may miss what it can ask for again.
constexpr std::size_t kMostWaiting = 200;
constexpr auto kHeartbeat = std::chrono::seconds(2);

}  // namespace

void EventStream::push(const std::string& event, const Json& data, bool newest_only,
                       const std::string& about) {
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  if (newest_only)
    std::erase_if(waiting_, [&](const Event& waiting) {
      return waiting.name == event && waiting.about == about;
    });
  while (waiting_.size() >= kMostWaiting) waiting_.pop_front();
  waiting_.push_back({event, about, "event: " + event + "\ndata: " + text_of(data) + "\n\n"});
  changed_.notify_all();
}

void EventStream::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

bool EventStream::next(std::string& text, std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, at_most, [&] { return closed_ || !waiting_.empty(); });
  if (waiting_.empty() && closed_) return false;
  const auto now = std::chrono::steady_clock::now();
  text = waiting_.empty() && now - sent_ >= kHeartbeat ? ":\n\n" : "";
  for (const Event& event : waiting_) text += event.text;
  waiting_.clear();
  if (!text.empty()) sent_ = now;
  return true;
}

}  // namespace hydrodip
