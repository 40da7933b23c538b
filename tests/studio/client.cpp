#include "studio/client.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <sstream>
#include <thread>
#include <utility>

namespace hydrodip {
namespace {

constexpr int kAnswer_ms = 60000;

int connected(int port) {
  const int handle = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(port));
  ::inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  const int yes = 1;
  ::setsockopt(handle, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  if (::connect(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
    return handle;
  ::close(handle);
  return -1;
}

void write_all(int handle, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t count = ::send(handle, text.data() + at, text.size() - at, MSG_NOSIGNAL);
    if (count <= 0) return;
    at += std::size_t(count);
  }
}

bool read_some(int handle, std::string& to, int timeout_ms) {
  pollfd waiting{handle, POLLIN, 0};
  if (::poll(&waiting, 1, timeout_ms) <= 0) return false;
  char piece[1 << 16];
  const ssize_t count = ::recv(handle, piece, sizeof piece, 0);
  if (count <= 0) return false;
  to.append(piece, std::size_t(count));
  return true;
}

std::string lower(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Status and headers of what begins with them.
void read_head(const std::string& head, Reply& reply) {
  std::istringstream lines(head);
  std::string line;
  std::getline(lines, line);
  if (line.size() > 12) reply.status = std::atoi(line.c_str() + 9);
  while (std::getline(lines, line)) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos)
      reply.headers[lower(line.substr(0, colon))] = line.substr(colon + 2);
  }
}

// Of a request, to the blank line.
std::string head_of(const Client& client, const std::string& method, const std::string& path,
                    std::map<std::string, std::string> headers) {
  headers.emplace("Host", "127.0.0.1:" + std::to_string(client.port()));
  std::string text = method + " " + path + " HTTP/1.1\r\n";
  for (const auto& [name, value] : headers) text += name + ": " + value + "\r\n";
  return text + "\r\n";
}

}  // namespace

std::string Reply::code() const {
  const nlohmann::json all = json();
  return all.is_object() && all.contains("error") ? all["error"].value("code", "") : "";
}

std::map<std::string, std::string> Client::own_headers() const {
  return {{"Cookie", cookie_}, {"X-Hydrodip", "1"}};
}

Reply Client::send(const std::string& method, const std::string& path, const std::string& body,
                   std::map<std::string, std::string> headers, int pause_ms) const {
  Reply reply;
  const int handle = connected(port_);
  if (handle < 0) return reply;
  headers.try_emplace("Connection", "close");
  if (!body.empty()) headers.try_emplace("Content-Length", std::to_string(body.size()));
  std::string text = head_of(*this, method, path, std::move(headers));
  if (pause_ms > 0) {
    write_all(handle, std::exchange(text, ""));
    std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms));
  }
  write_all(handle, text + body);
  std::string answer;
  while (true) {
    const std::size_t end = answer.find("\r\n\r\n");
    if (end != std::string::npos) {
      read_head(answer.substr(0, end), reply);
      const auto length = reply.headers.find("content-length");
      if (length != reply.headers.end() && answer.size() >= end + 4 + std::stoull(length->second))
        break;
    }
    if (!read_some(handle, answer, 60000)) break;
  }
  ::close(handle);
  const std::size_t end = answer.find("\r\n\r\n");
  if (end != std::string::npos) reply.body = answer.substr(end + 4);
  return reply;
}

int Client::say(const std::string& text) const {
  const int handle = connected(port_);
  write_all(handle, text);
  return handle;
}

EndlessUpload::EndlessUpload(const Client& client, const std::string& path)
    : socket_(connected(client.port())) {
  auto headers = client.own_headers();
  headers["Content-Length"] = "100000000";
  write_all(socket_, head_of(client, "PUT", path, std::move(headers)));
  thread_ = std::thread([this] {
    while (!ends_ && ::send(socket_, "x", 1, MSG_NOSIGNAL) == 1)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  });
}

EndlessUpload::~EndlessUpload() {
  ends_ = true;
  thread_.join();
  ::close(socket_);
}

Events::Events(const Client& client, const std::string& path) : socket_(connected(client.port())) {
  write_all(socket_, head_of(client, "GET", path, client.own_headers()));
  // From here on the tab is one that the job knows.
  while (buffer_.find("\r\n\r\n") == std::string::npos && read_some(socket_, buffer_, kAnswer_ms)) {
  }
}

Events::~Events() { ::close(socket_); }

// Events never break over chunks here, and chunk sizes are on lines of their own.
std::unique_ptr<Event> Events::read(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    const std::size_t from = buffer_.find("event: ");
    const std::size_t to = from == std::string::npos ? from : buffer_.find("\n\n", from);
    if (to != std::string::npos) {
      const std::string text = buffer_.substr(from, to - from);
      buffer_.erase(0, to + 2);
      const std::size_t line = text.find("\ndata: ");
      auto event = std::make_unique<Event>();
      event->name = text.substr(7, line - 7);
      event->data = nlohmann::json::parse(text.substr(line + 7), nullptr, false);
      return event;
    }
    const double left =
        std::chrono::duration<double>(end - std::chrono::steady_clock::now()).count();
    if (left <= 0) return nullptr;
    if (!read_some(socket_, buffer_, int(1000 * left) + 1)) return nullptr;
  }
}

std::unique_ptr<Event> Events::next(const std::string& name,
                                    const std::function<bool(const nlohmann::json&)>& is,
                                    double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    const double left =
        std::chrono::duration<double>(end - std::chrono::steady_clock::now()).count();
    auto event = left > 0 ? read(left) : nullptr;
    if (!event) return nullptr;
    if (event->name == name && (!is || is(event->data))) return event;
  }
}

ReadBundle::ReadBundle(const std::string& body) {
  if (body.size() < 8 || body.compare(0, 4, "HDB1") != 0) return;
  std::uint32_t length = 0;
  std::memcpy(&length, body.data() + 4, 4);
  head = nlohmann::json::parse(body.substr(8, length), nullptr, false);
  data = body.substr(8 + length);
}

}  // namespace hydrodip
