// A plain HTTP client, and what a page reads: nothing of it is the studio's own code.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace hydrodip {

struct Reply {
  int status = 0;                              // 0: the connection broke
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;

  nlohmann::json json() const { return nlohmann::json::parse(body, nullptr, false); }
  std::string code() const;  // of an error
};

class Client {
 public:
  Client(int port, std::string cookie) : port_(port), cookie_(std::move(cookie)) {}

  Reply get(const std::string& path) const { return send("GET", path, "", own_headers()); }
  Reply put(const std::string& path, const std::string& body) const {
    return send("PUT", path, body, own_headers());
  }
  Reply post(const std::string& path, const std::string& body = "{}") const {
    return send("POST", path, body, own_headers());
  }
  Reply remove(const std::string& path) const { return send("DELETE", path, "", own_headers()); }

  // Any request. "Host" is that of the server unless given; a "Content-Length" that is given stands
  // instead of the body's. `pause_ms`: between head and body, as browsers may send them.
  Reply send(const std::string& method, const std::string& path, const std::string& body,
             std::map<std::string, std::string> headers, int pause_ms = 0) const;

  // A connection that has said so much and no more; the caller's to close.
  int say(const std::string& text) const;

  // As the page sends them.
  std::map<std::string, std::string> own_headers() const;
  int port() const { return port_; }

 private:
  int port_;
  std::string cookie_;
};

struct Event {
  std::string name;
  nlohmann::json data;
};

// The events of one tab, while it lives; the studio knows of it from the start.
class Events {
 public:
  Events(const Client& client, const std::string& path);
  ~Events();
  Events(const Events&) = delete;
  Events& operator=(const Events&) = delete;

  // The next event of that name, and for which that is true; nothing after so long. Others on the
  // way are passed over.
  std::unique_ptr<Event> next(const std::string& name,
                              const std::function<bool(const nlohmann::json&)>& is = {},
                              double seconds = 60);

 private:
  std::unique_ptr<Event> read(double seconds);

  int socket_ = -1;
  std::string buffer_;
};

// An upload that goes on and on, a byte at a time, until the other side ends it.
class EndlessUpload {
 public:
  EndlessUpload(const Client& client, const std::string& path);
  ~EndlessUpload();
  EndlessUpload(const EndlessUpload&) = delete;
  EndlessUpload& operator=(const EndlessUpload&) = delete;

 private:
  int socket_ = -1;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

// A binary answer as docs/studio-api.md says.
struct ReadBundle {
  nlohmann::json head;
  std::string data;

  explicit ReadBundle(const std::string& body);
  bool has(const std::string& name) const { return head["arrays"].contains(name); }
  template <class Value>
  std::vector<Value> array(const std::string& name) const {
    const nlohmann::json& at = head["arrays"][name];
    const std::size_t count = at["count"].get<std::size_t>() * at["width"].get<std::size_t>();
    std::vector<Value> values(count);
    if (count > 0)
      std::copy_n(data.data() + at["offset"].get<std::size_t>(), count * sizeof(Value),
                  reinterpret_cast<char*>(values.data()));
    return values;
  }
};

}  // namespace hydrodip
