// Server-sent events on their way to one tab.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>

#include "studio/json.h"

namespace hydrodip {

// For any number of threads.
class EventStream {
 public:
  // Of events that have not been sent yet, those of this name that are about the same are replaced
  // if `newest_only`.
  void push(const std::string& event, const Json& data, bool newest_only = false,
            const std::string& about = "");
  // No more events; those that wait are still sent.
  void close();

  // What goes over the wire next, or nothing if nothing comes for so long; a comment after a while
  // without events, so that a side that has gone without a word is noticed. False at the end.
  bool next(std::string& text, std::chrono::milliseconds at_most);

 private:
  struct Event {
    std::string name, about, text;
  };

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Event> waiting_;
  bool closed_ = false;
  std::chrono::steady_clock::time_point sent_ = std::chrono::steady_clock::now();
};

}  // namespace hydrodip
