#include "studio/connections.h"

#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <vector>

namespace hydrodip {
namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(100);

// Whether that descriptor is a connection to the port of this machine.
bool is_connection_to(int port, int descriptor) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0) return false;
  in_port_t own = 0;
  if (address.ss_family == AF_INET)
    own = reinterpret_cast<const sockaddr_in*>(&address)->sin_port;
  else if (address.ss_family == AF_INET6)
    own = reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port;
  return own != 0 && ntohs(own) == port;
}

// Calls visit(descriptor) for each. cpp-httplib keeps its connections to itself. Each is held while
// it is looked at: its number might be another's by then.
void for_each_connection(int port, const std::function<void(int)>& visit) {
  std::error_code error;
  for (auto entry = std::filesystem::directory_iterator("/proc/self/fd", error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    int descriptor = -1;
    std::from_chars(name.data(), name.data() + name.size(), descriptor);
    if (descriptor < 0 || !is_connection_to(port, descriptor)) continue;
    const int held = ::dup(descriptor);
    if (held < 0) continue;
    if (is_connection_to(port, held)) visit(held);
    ::close(held);
  }
}

std::optional<Peer> peer_of(int descriptor) {
  sockaddr_storage from{};
  socklen_t size = sizeof from;
  char address[NI_MAXHOST], service[NI_MAXSERV];
  if (::getpeername(descriptor, reinterpret_cast<sockaddr*>(&from), &size) != 0 ||
      ::getnameinfo(reinterpret_cast<const sockaddr*>(&from), size, address, sizeof address,
                    service, sizeof service, NI_NUMERICHOST | NI_NUMERICSERV) != 0)
    return std::nullopt;
  Peer peer{address, 0};
  std::from_chars(service, service + std::strlen(service), peer.port);
  return peer;
}

}  // namespace

void shut_connections(int port, int how) {
  for_each_connection(port, [how](int descriptor) { ::shutdown(descriptor, how); });
}

Connections::Connections(int port, const Bounds& bounds)
    : port_(port), bounds_(bounds), thread_([this] { watch(); }) {}

Connections::~Connections() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Connections::opened() {
  {
    const std::lock_guard lock(mutex_);
    has_new_ = true;
  }
  changed_.notify_all();
}

void Connections::know(const Peer& peer) {
  const std::lock_guard lock(mutex_);
  open_.try_emplace(peer, Open{Clock::now(), true, 0}).first->second.known = true;
}

WatchedConnection::WatchedConnection(int port, const Peer& peer) {
  for_each_connection(port, [&](int descriptor) {
    if (descriptor_ < 0 && peer_of(descriptor) == peer) descriptor_ = ::dup(descriptor);
  });
}

WatchedConnection::~WatchedConnection() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool WatchedConnection::is_left() const {
  pollfd line{descriptor_, POLLRDHUP, 0};
  return descriptor_ >= 0 && ::poll(&line, 1, 0) > 0;
}

void Connections::watch() {
  bool has_strangers = false;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (has_strangers)
        changed_.wait_for(lock, kBetweenLooks, [this] { return ends_; });
      else
        changed_.wait(lock, [this] { return ends_ || has_new_; });
      if (ends_) return;
      has_new_ = false;
    }
    has_strangers = look();
  }
}

bool Connections::look() {
  // Nobody waits for that: neither who connects nor who asks.
  std::vector<Peer> open;
  for_each_connection(port_, [&](int descriptor) {
    if (const auto peer = peer_of(descriptor)) open.push_back(*peer);
  });
  // Of those first seen together, whoever has the higher descriptor mostly came later.
  std::ranges::reverse(open);
  std::vector<Stranger> strangers = strangers_among(open);
  // The newest first: who comes now is not kept out by those who wait.
  std::ranges::stable_sort(strangers, std::greater(), &Stranger::since);
  std::map<std::string, std::size_t> of_address;
  std::set<Peer> ended;
  std::size_t kept = 0;
  const auto now = Clock::now();
  for (const Stranger& stranger : strangers) {
    std::size_t& of_this = of_address[stranger.peer.address];
    const bool is_within = now - stranger.since < bounds_.longest &&
                           of_this < bounds_.most_of_address && kept < bounds_.most;
    if (is_within || stranger.is_new) {
      ++of_this;
      ++kept;
    } else {
      ended.insert(stranger.peer);
    }
  }
  if (!ended.empty())
    for_each_connection(port_, [&](int descriptor) {
      const auto peer = peer_of(descriptor);
      if (peer && ended.contains(*peer)) ::shutdown(descriptor, SHUT_RDWR);
    });
  return kept > 0;
}

// Of all that are open. What is known of others is forgotten, when they have not been there twice:
// of one that came meanwhile it may be known already.
std::vector<Connections::Stranger> Connections::strangers_among(const std::vector<Peer>& open) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  std::vector<Stranger> strangers;
  for (auto& [peer, one] : open_) ++one.missed;
  for (const Peer& peer : open) {
    const auto [at, is_new] = open_.try_emplace(peer, Open{now, false, 0});
    at->second.missed = 0;
    if (!at->second.known) strangers.push_back({peer, at->second.since, is_new});
  }
  std::erase_if(open_, [](const auto& entry) { return entry.second.missed > 1; });
  return strangers;
}

}  // namespace hydrodip
