#include "studio/connections.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <vector>

namespace hydrodip {
namespace {

// A port that takes whoever comes, and both ends of each connection.
class Door {
 public:
  Door() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::bind(door_, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    ::listen(door_, 100);
    port_ = port_of(door_);
  }
  ~Door() {
    for (const int end : ends_) ::close(end);
    ::close(door_);
  }
  Door(const Door&) = delete;
  Door& operator=(const Door&) = delete;

  int port() const { return port_; }

  // The other side's end, at an address 127.0.0.1, 2, ...
  int connect(std::uint32_t from = 1) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    const int end = ::socket(AF_INET, SOCK_STREAM, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK + from - 1);
    EXPECT_EQ(::bind(end, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(in_port_t(port_));
    EXPECT_EQ(::connect(end, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ends_.push_back(::accept(door_, nullptr, nullptr));
    ends_.push_back(end);
    return end;
  }
  static Peer peer_with(int end) { return {"127.0.0.1", port_of(end)}; }
  void close(int end) {
    std::erase(ends_, end);
    ::close(end);
  }

 private:
  static int port_of(int socket) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
  }

  int door_ = ::socket(AF_INET, SOCK_STREAM, 0);
  int port_ = 0;
  std::vector<int> ends_;
};

bool is_ended(int end, int at_most_ms) {
  pollfd one{end, POLLRDHUP, 0};
  return ::poll(&one, 1, at_most_ms) > 0;
}

TEST(WatchedConnection, SaysWhenTheOtherSideHasGone) {
  Door door;
  const int first = door.connect(), second = door.connect();
  const WatchedConnection of_first(door.port(), Door::peer_with(first)),
      of_second(door.port(), Door::peer_with(second));
  EXPECT_FALSE(of_first.is_left());
  ASSERT_EQ(::send(first, "x", 1, 0), 1);
  EXPECT_FALSE(of_first.is_left()) << "what was sent and not read is no farewell";
  door.close(first);
  EXPECT_TRUE(of_first.is_left());
  EXPECT_FALSE(of_second.is_left());
}

TEST(Connections, EndThoseOfStrangersBeyondTheirBounds) {
  Door door;
  Connections connections(door.port(), {std::chrono::hours(1), 3, 5});
  const int known = door.connect();
  connections.opened();
  connections.know(Door::peer_with(known));
  std::vector<int> strangers;
  for (int i = 0; i < 10; ++i) {
    strangers.push_back(door.connect());
    connections.opened();
  }
  constexpr int kLong_ms = 60000;
  int ended = 0;
  while (ended < 7) {
    ended = 0;
    for (const int stranger : strangers) ended += is_ended(stranger, 1);
    // One of those that wait has to be the next.
    std::vector<pollfd> open;
    for (const int stranger : strangers)
      if (!is_ended(stranger, 0)) open.push_back({stranger, POLLRDHUP, 0});
    if (ended < 7) {
      ASSERT_GT(::poll(open.data(), open.size(), kLong_ms), 0) << ended << " were ended";
    }
  }
  EXPECT_EQ(ended, 7) << "an address has three";
  EXPECT_FALSE(is_ended(known, 0));
}

// Which of two is ended; -1: none for long.
int first_ended(int one, int other) {
  std::vector<pollfd> both = {{one, POLLRDHUP, 0}, {other, POLLRDHUP, 0}};
  if (::poll(both.data(), both.size(), 60000) <= 0) return -1;
  return both[0].revents != 0 ? one : other;
}

TEST(Connections, EndTheStrangerWhoHasWaitedLongest) {
  Door door;
  Connections connections(door.port(), {std::chrono::hours(1), 1, 10});
  const int one = door.connect(), other = door.connect();
  connections.opened();
  // Though both are seen at once.
  ASSERT_EQ(first_ended(one, other), one);
  const int later = door.connect();
  connections.opened();
  EXPECT_EQ(first_ended(other, later), other);
  EXPECT_FALSE(is_ended(later, 0));
}

TEST(Connections, StrangersOfManyAddressesHaveNoMoreTogether) {
  Door door;
  Connections connections(door.port(), {std::chrono::hours(1), 1, 1});
  const int one = door.connect(2), other = door.connect(3);
  connections.opened();
  EXPECT_NE(first_ended(one, other), -1);
}

TEST(Connections, EndStrangersWhoWaitTooLong) {
  Door door;
  Connections connections(door.port(), {std::chrono::milliseconds(1), 100, 100});
  const int known = door.connect(), stranger = door.connect();
  connections.know(Door::peer_with(known));
  connections.opened();
  EXPECT_TRUE(is_ended(stranger, 60000));
  EXPECT_FALSE(is_ended(known, 0));
}

}  // namespace
}  // namespace hydrodip
