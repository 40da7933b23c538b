#include "studio/studio.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/run_scope.h"
#include "job/browser.h"
#include "studio/api.h"
#include "studio/api_error.h"
#include "studio/page_assets.h"
#include "studio/run_file.h"

namespace hydrodip {
namespace {

constexpr int kUsualPort = 4714, kPortsTried = 20;
constexpr auto kLook = std::chrono::milliseconds(20);
constexpr auto kBetweenTidying = std::chrono::seconds(5);
constexpr std::size_t kShortestPassword = 8;

bool is_here(const std::string& address) {
  return address == "127.0.0.1" || address == "localhost";
}

std::string password_of(const StudioOptions& options, const RunContext& context) {
  if (options.password_file.empty()) {
    if (is_here(options.address)) return "";
    throw InputError(fmt::format(
        "--listen {}: whoever reaches this address could work with your files; name a file that "
        "holds a password, with --password-file FILE",
        options.address));
  }
  const RunScope scope(context);
  const std::vector<std::uint8_t> bytes = read_file(options.password_file);
  std::string line(bytes.begin(), bytes.end());
  line = line.substr(0, line.find_first_of("\r\n"));
  if (line.size() < kShortestPassword)
    throw InputError(fmt::format("{}: the password in its first line needs {} characters or more",
                                 options.password_file.string(), kShortestPassword));
  return line;
}

void bind(HttpServer& server, const StudioOptions& options, int earlier) {
  if (options.port != 0) {
    if (server.bind(options.address, options.port)) return;
    throw InputError(
        fmt::format("--port {}: another program has it, or the address {} is not this machine's; "
                    "choose another",
                    options.port, options.address));
  }
  if (earlier != 0 && server.bind(options.address, earlier)) return;
  for (int port = kUsualPort; port < kUsualPort + kPortsTried; ++port)
    if (server.bind(options.address, port)) return;
  if (server.bind(options.address, 0)) return;
  throw InputError(
      fmt::format("the address {} cannot be served from; is it this machine's?", options.address));
}

Guard guard_of(const StudioOptions& options, const std::string& token, const std::string& password,
               int port) {
  Guard guard;
  guard.token = token;
  guard.password = password;
  guard.cookie = fmt::format("hydrodip-{}", port);
  for (const char* name : {"127.0.0.1", "localhost"})
    guard.hosts.push_back(fmt::format("{}:{}", name, port));
  if (!is_here(options.address)) {
    guard.hosts.push_back(fmt::format("{}:{}", options.address, port));
    guard.numbers = true;
  }
  return guard;
}

void open(Api& api, const std::filesystem::path& file, const RunFile::Run& another) {
  try {
    api.open_file(file);
  } catch (const ApiError& error) {
    if (error.code != "busy") throw;
    throw InputError(fmt::format(
        "{}: it is open in another studio; {}", file.string(),
        another.port > 0 ? fmt::format("go on at http://127.0.0.1:{}/?token={}, or end that one",
                                       another.port, another.token)
                         : "go on there, or end that one"));
  }
}

// The server's threads, however what goes on beside them ends.
class Serving {
 public:
  Serving(HttpServer& server, Api& api, RunContext warming, bool warms_up)
      : server_(server), api_(api), warming_(std::move(warming)) {
    serving_ = std::thread([this] { server_.run(); });
    // Who begins with a sample need not wait until it is painted.
    if (warms_up) warm_ = std::thread([this] { api_.warm_up(warming_); });
  }
  ~Serving() {
    api_.end("The studio was ended. Start it again with 'hydrodip studio' to go on.");
    server_.stop();
    warming_.cancel();
    if (warm_.joinable()) warm_.join();
    serving_.join();
  }
  Serving(const Serving&) = delete;
  Serving& operator=(const Serving&) = delete;

 private:
  HttpServer& server_;
  Api& api_;
  RunContext warming_;
  std::thread serving_, warm_;
};

}  // namespace

JobResult studio_job(const StudioOptions& options, const RunContext& context) {
  if (studio_script().empty())
    throw InputError(
        "this hydrodip was built without the studio's page: build it with -DHYDRODIP_VIEWER=ON");
  const std::string password = password_of(options, context);
  const std::filesystem::path folder = studio_folder();
  RunFile run_file(folder);
  const RunFile::Run& earlier = run_file.earlier();
  const std::string token = earlier.token.empty() ? random_hex(24) : earlier.token;

  // The port is part of what the guard knows: the interface is made when it is had.
  std::optional<Api> api;
  HttpServer server([&](HttpRequest& request) { return api->answer(request); },
                    [&](const HttpRequest& request) { return api->admit(request); });
  bind(server, options, earlier.port);
  RunContext ending = context;
  api.emplace(
      JobStore(folder), guard_of(options, token, password, server.port()), random_hex(8),
      [ending] { ending.cancel(); }, options.profiles);
  if (!options.file.empty()) open(*api, options.file, run_file.another());
  run_file.keep(server.port(), token);

  const Serving serving(server, *api, context.quiet(), options.file.empty());
  const std::string shown = is_here(options.address) ? "127.0.0.1" : options.address;
  const std::string address =
      password.empty() ? fmt::format("http://{}:{}/?token={}", shown, server.port(), token)
                       : fmt::format("http://{}:{}/", shown, server.port());
  if (options.announce) options.announce(address);
  if (options.browser && has_screen()) begin_in_browser(address);

  auto tidied = std::chrono::steady_clock::now();
  while (!context.cancelled()) {
    std::this_thread::sleep_for(kLook);
    if (std::chrono::steady_clock::now() - tidied < kBetweenTidying) continue;
    api->tidy();
    tidied = std::chrono::steady_clock::now();
  }
  JobResult result;
  result.text = "the studio has ended; what was not saved is kept, and found under recent jobs\n";
  result.json = json_answer("studio", nlohmann::ordered_json::object());
  return result;
}

}  // namespace hydrodip
