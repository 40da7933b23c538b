// HTTP on this machine. http.cpp is the only place that knows cpp-httplib.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hydrodip {

struct HttpRequest {
  std::string method;  // "GET"; HEAD comes as GET
  std::string path;    // decoded, without the query
  std::map<std::string, std::string> query;
  std::function<std::string(const std::string& name)> header;  // "" if there is none
  bool has_body = false;
  std::optional<std::uint64_t> body_bytes;  // as the request says
  // The body, piece by piece as it comes; `take` says whether it goes on. False if the body did not
  // come whole.
  std::function<bool(const std::function<bool(const char* data, std::size_t size)>& take)>
      read_body;
};

struct HttpAnswer {
  int status = 200;
  std::string type = "application/json";
  std::vector<std::pair<std::string, std::string>> headers = {};
  // One of these.
  std::string body = {};
  std::shared_ptr<const std::vector<std::uint8_t>> bytes = {};
  std::filesystem::path file = {};
  // Of a request without a body: asked for the next piece until it says false, or the other side
  // has gone; a stream without an end. A piece is empty where there is none yet.
  std::function<bool(std::string& piece)> stream = {};
};

using HttpHandler = std::function<HttpAnswer(HttpRequest&)>;

struct Admission {
  bool is_known = false;  // not a stranger's: its connection may stay
  std::optional<HttpAnswer> refusal = {};
};
using HttpAdmission = std::function<Admission(const HttpRequest&)>;

// One thread for each connection, up to a bound; requests beyond it wait. Strangers get few of them
// (connections.h).
class HttpServer {
 public:
  // `handler` is called by many threads, and answers whatever is asked. `admit` comes before it,
  // for every request, when its body has not been read: an answer refuses, and the connection is
  // closed if there is a body.
  HttpServer(HttpHandler handler, HttpAdmission admit);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  // Whether the address could be had; port 0: any free one.
  bool bind(const std::string& address, int port);
  int port() const;
  // Serves until stop() is called.
  void run();
  // Streams have to end by themselves. run() returns soon after: who stalls is cut off.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydrodip
