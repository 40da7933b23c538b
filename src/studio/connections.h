// Who is connected to the studio's port. Strangers may connect, and say nothing or half of
// something: they get little time and few connections, so that the own page never waits for them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

namespace hydrodip {

// Who is on the other side.
struct Peer {
  std::string address;
  int port = 0;
  bool operator==(const Peer&) const = default;
  bool operator<(const Peer& other) const {
    return std::tie(address, port) < std::tie(other.address, other.port);
  }
};

// Looks after the connections of a port while it lives, whenever there are some of which nobody
// knows yet whose they are. For any number of threads.
class Connections {
 public:
  // What strangers get: each so long, an address so many at a time, and all together so many. Of
  // more the oldest are ended, after a moment in which they may show that they are none.
  struct Bounds {
    std::chrono::milliseconds longest{5000};
    std::size_t most_of_address = 16, most = 32;
  };

  explicit Connections(int port) : Connections(port, Bounds()) {}
  Connections(int port, const Bounds& bounds);
  ~Connections();
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  // One more has come.
  void opened();
  // That one has shown that it is no stranger's.
  void know(const Peer& peer);

 private:
  using Clock = std::chrono::steady_clock;
  struct Open {
    Clock::time_point since;
    bool known = false;
    int missed = 0;  // how often it was not there, one after another
  };

  struct Stranger {
    Peer peer;
    Clock::time_point since;
    bool is_new = false;
  };

  void watch();
  // Ends strangers beyond the bounds. Whether any are left.
  bool look();
  std::vector<Stranger> strangers_among(const std::vector<Peer>& open);

  const int port_;
  const Bounds bounds_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ends_ = false, has_new_ = false;
  std::map<Peer, Open> open_;
  std::thread thread_;
};

// One of them, by which its other side is watched.
class WatchedConnection {
 public:
  WatchedConnection(int port, const Peer& peer);
  ~WatchedConnection();
  WatchedConnection(const WatchedConnection&) = delete;
  WatchedConnection& operator=(const WatchedConnection&) = delete;

  // Whether the other side has closed it: cpp-httplib notices that when it writes the second time
  // after that.
  bool is_left() const;

 private:
  int descriptor_ = -1;  // our own
};

// Shuts all of them, as ::shutdown does.
void shut_connections(int port, int how);

}  // namespace hydrodip
