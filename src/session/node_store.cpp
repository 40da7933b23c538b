#include "session/node_store.h"

#include <chrono>
#include <utility>

namespace hydrodip {

std::size_t NodeStore::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::size_t NodeStore::computed() const {
  const std::lock_guard lock(mutex_);
  return computed_;
}

std::shared_ptr<const void> NodeStore::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  return found(key);
}

// Under the lock.
std::shared_ptr<const void> NodeStore::found(const std::string& key) {
  const auto place = by_key_.find(key);
  if (place == by_key_.end()) return nullptr;
  nodes_.splice(nodes_.begin(), nodes_, place->second);
  return place->second->value;
}

std::shared_ptr<const void> NodeStore::begin(const std::string& key, const RunContext& context) {
  constexpr auto kLook = std::chrono::milliseconds(5);
  std::unique_lock lock(mutex_);
  while (true) {
    if (const auto known = found(key)) return known;
    if (computing_.insert(key).second) return nullptr;
    context.check_cancelled();
    ended_.wait_for(lock, kLook);
  }
}

void NodeStore::keep(const std::string& key, std::shared_ptr<const void> value, std::size_t bytes) {
  // Values are let go without the lock: that can take time.
  std::list<Node> gone;
  const std::lock_guard lock(mutex_);
  ++computed_;
  nodes_.push_front({key, std::move(value), bytes});
  by_key_[key] = nodes_.begin();
  bytes_ += bytes;
  while (bytes_ > most_bytes_ && nodes_.size() > 1) {
    bytes_ -= nodes_.back().bytes;
    by_key_.erase(nodes_.back().key);
    gone.splice(gone.begin(), nodes_, std::prev(nodes_.end()));
  }
}

void NodeStore::end(const std::string& key) {
  {
    const std::lock_guard lock(mutex_);
    computing_.erase(key);
  }
  ended_.notify_all();
}

}  // namespace hydrodip
