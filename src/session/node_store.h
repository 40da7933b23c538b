// Computed values by the content that they were computed from.
#pragma once

#include <condition_variable>
#include <list>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>

#include "base/context.h"
#include "session/content_key.h"

namespace hydrodip {

// Keeps values up to so many bytes in all; those asked for longest ago go first. A value that is
// still held by somebody lives on for them. For any number of threads: who asks for what another
// thread is just computing waits for it.
class NodeStore {
 public:
  explicit NodeStore(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  // The value of the key: computed by make() if it is not known. bytes(value) says how much memory
  // it takes, nearly. If make() throws, nothing is kept. Throws Cancelled while waiting for another
  // thread.
  template <class Value, class Make, class Bytes>
  std::shared_ptr<const Value> get(const ContentKey& key, const RunContext& context,
                                   const Make& make, const Bytes& bytes) {
    if (const auto known = begin(key.text(), context))
      return std::static_pointer_cast<const Value>(known);
    const Computing computing(*this, key.text());
    auto value = std::make_shared<const Value>(make());
    keep(key.text(), value, bytes(*value));
    return value;
  }

  // The value of the key; null if it is not known or is only being computed.
  template <class Value>
  std::shared_ptr<const Value> known(const ContentKey& key) {
    return std::static_pointer_cast<const Value>(find(key.text()));
  }

  std::size_t bytes() const;
  // How many values have been computed since the start.
  std::size_t computed() const;

 private:
  struct Node {
    std::string key;
    std::shared_ptr<const void> value;
    std::size_t bytes;
  };
  // Ends the computation of a key, however it ends.
  class Computing {
   public:
    Computing(NodeStore& store, std::string key) : store_(store), key_(std::move(key)) {}
    ~Computing() { store_.end(key_); }
    Computing(const Computing&) = delete;
    Computing& operator=(const Computing&) = delete;

   private:
    NodeStore& store_;
    const std::string key_;
  };

  std::shared_ptr<const void> find(const std::string& key);
  std::shared_ptr<const void> found(const std::string& key);
  // The known value; or null, and the caller is to compute it.
  std::shared_ptr<const void> begin(const std::string& key, const RunContext& context);
  void keep(const std::string& key, std::shared_ptr<const void> value, std::size_t bytes);
  void end(const std::string& key);

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable ended_;
  std::set<std::string> computing_;
  std::list<Node> nodes_;  // asked for last: first
  std::unordered_map<std::string, std::list<Node>::iterator> by_key_;
  std::size_t bytes_ = 0;
  std::size_t computed_ = 0;
};

}  // namespace hydrodip
