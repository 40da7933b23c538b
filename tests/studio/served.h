// A studio that serves, for one test.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "studio/api.h"
#include "studio/client.h"
#include "studio/http.h"
#include "temporary_folder.h"

namespace hydrodip {

inline constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

class Served {
 public:
  explicit Served(const std::filesystem::path& folder, const std::string& run = "run-1") {
    server_ = std::make_unique<HttpServer>(
        [this](HttpRequest& request) { return api_->answer(request); },
        [this](const HttpRequest& request) { return api_->admit(request); });
    server_->bind("127.0.0.1", 0);
    Guard guard;
    guard.token = kToken;
    guard.cookie = "hydrodip-" + std::to_string(server_->port());
    guard.hosts = {"127.0.0.1:" + std::to_string(server_->port())};
    api_.emplace(
        JobStore(folder), guard, run, [this] { quits_ = true; }, folder / "profiles");
    thread_ = std::thread([this] { server_->run(); });
  }
  ~Served() {
    api_->end("over");
    server_->stop();
    thread_.join();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  Api& api() { return *api_; }
  int port() const { return server_->port(); }
  Client client() const {
    return Client(port(), "hydrodip-" + std::to_string(port()) + "=" + kToken);
  }
  bool quits() const { return quits_; }

 private:
  std::optional<Api> api_;
  std::unique_ptr<HttpServer> server_;
  std::thread thread_;
  bool quits_ = false;
};

}  // namespace hydrodip
