// Who has a job open: a line of events to each tab, and which of them may change the job (the pen).
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "studio/event_stream.h"
#include "studio/json.h"

namespace hydrodip {

// With its owner's lock.
class Tabs {
 public:
  // The same tab anew ends its earlier line. Who comes first gets the pen. Throws ApiError busy.
  std::shared_ptr<EventStream> connect(const std::string& client);
  // False: that line had ended before. The pen goes to the tab that came next.
  bool disconnect(const std::string& client, const std::shared_ptr<EventStream>& stream);
  // Says why, and ends every line.
  void close(const std::string& text);
  bool none() const { return tabs_.empty(); }
  bool any_but(const std::string& client) const;
  // Since when there is none.
  std::optional<std::chrono::steady_clock::time_point> none_since() const { return none_since_; }

  bool has_pen(const std::string& client) const { return pen_ == client; }
  // Throws ApiError not-found for a tab that is not connected.
  void take_pen(const std::string& client);
  // Throws ApiError no-pen if another tab has it.
  void require_pen(const std::string& client) const;

  void tell(const std::string& event, const Json& data, bool newest_only = false,
            const std::string& about = "") const;
  // All but that one; the newest only.
  void tell_others(const std::string& client, const std::string& event, const Json& data) const;

 private:
  struct Tab {
    std::string client;
    std::shared_ptr<EventStream> stream;
  };
  void give_pen(const std::string& client);

  std::vector<Tab> tabs_;
  std::string pen_;  // client
  std::optional<std::chrono::steady_clock::time_point> none_since_ =
      std::chrono::steady_clock::now();
};

}  // namespace hydrodip
