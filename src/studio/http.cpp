#include "studio/http.h"

#include <httplib.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "studio/connections.h"
#include "studio/json_answers.h"

namespace hydrodip {
namespace {

// A connection is held by its thread as long as it is open: a page's few requests at a time, its
// events, and whoever else connects, for a moment.
constexpr std::size_t kMostThreads = 512;
// How many may come at once; cpp-httplib's own five make the sixth try again after a second.
constexpr int kBacklog = 512;
// After that long without a request its thread is free again; opening another is cheap here.
constexpr int kKeepAlive_s = 2;
constexpr int kTimeout_s = 20;
constexpr auto kLastAnswers = std::chrono::milliseconds(300);
constexpr std::size_t kKeepAliveRequests = 1000;
constexpr std::size_t kLongestPath = 1024;
constexpr int kTriesToStop = 200;
constexpr std::size_t kPiece = std::size_t(1) << 16;
// A body up to that size is read even if nobody wants it: where a connection is closed over what
// has not been read, the answer may be lost.
constexpr std::uint64_t kReadAnyhow = std::uint64_t(64) << 10U;

HttpRequest request_of(const httplib::Request& from) {
  HttpRequest request;
  request.method = from.method == "HEAD" ? "GET" : from.method;
  request.path = from.path;
  for (const auto& [key, value] : from.params) request.query.emplace(key, value);
  request.header = [&from](const std::string& name) { return from.get_header_value(name); };
  const bool chunked = from.has_header("Transfer-Encoding");
  if (from.has_header("Content-Length"))
    request.body_bytes = from.get_header_value<std::uint64_t>("Content-Length");
  request.has_body = chunked || request.body_bytes.value_or(0) > 0;
  return request;
}

Peer peer_of(const httplib::Request& from) { return {from.remote_addr, from.remote_port}; }

// Never packed: cpp-httplib packs what it is given whole, the page's script in a second and more.
template <class Bytes>
void send_bytes(httplib::Response& to, const std::string& type,
                std::shared_ptr<const Bytes> bytes) {
  const std::size_t size = bytes->size();
  to.set_content_provider(
      size, type,
      [bytes = std::move(bytes)](std::size_t at, std::size_t left, httplib::DataSink& sink) {
        return sink.write(reinterpret_cast<const char*>(bytes->data()) + at, left);
      });
}

// A provider that ends in failure is the one way to make cpp-httplib close the connection.
void send_and_close(httplib::Response& to, const std::string& type, const std::string& body) {
  to.set_header("Connection", "close");
  to.set_content_provider(body.size(), type,
                          [body](std::size_t at, std::size_t, httplib::DataSink& sink) {
                            sink.write(body.data() + at, body.size() - at);
                            return false;
                          });
}

void send_file(httplib::Response& to, const HttpAnswer& answer) {
  std::shared_ptr<std::FILE> file(std::fopen(answer.file.c_str(), "rb"), [](std::FILE* opened) {
    if (opened) std::fclose(opened);
  });
  // Of what was opened: another may have its name by now.
  struct stat opened = {};
  if (!file || ::fstat(::fileno(file.get()), &opened) != 0) {
    to.status = 404;
    return;
  }
  if (opened.st_size == 0) {
    to.set_content("", answer.type.c_str());
    return;
  }
  to.set_content_provider(std::size_t(opened.st_size), answer.type,
                          [file](std::size_t at, std::size_t left, httplib::DataSink& sink) {
                            std::vector<char> piece(std::min(left, kPiece));
                            if (std::fseek(file.get(), long(at), SEEK_SET) != 0) return false;
                            const std::size_t count =
                                std::fread(piece.data(), 1, piece.size(), file.get());
                            return count > 0 && sink.write(piece.data(), count);
                          });
}

// Of what no handler sees.
HttpAnswer plain_refusal(int status, const std::string& sentence) {
  return error_answer({status, "bad-request", sentence});
}

// After send().
void send_stream(httplib::Response& to, const HttpAnswer& answer,
                 std::shared_ptr<const WatchedConnection> connection) {
  to.set_chunked_content_provider(
      answer.type, [next = answer.stream, connection = std::move(connection)](
                       std::size_t, httplib::DataSink& sink) {
        std::string piece;
        if (next(piece))
          return piece.empty() ? !connection->is_left() : sink.write(piece.data(), piece.size());
        sink.done();
        return true;
      });
}

void send(httplib::Response& to, const HttpAnswer& answer, bool and_close) {
  to.status = answer.status;
  for (const auto& [name, value] : answer.headers) to.set_header(name, value);
  if (and_close) return send_and_close(to, answer.type, answer.body);
  if (answer.bytes && !answer.bytes->empty()) {
    send_bytes(to, answer.type, answer.bytes);
  } else if (!answer.file.empty()) {
    send_file(to, answer);
  } else if (!answer.body.empty()) {
    send_bytes(to, answer.type, std::make_shared<const std::string>(answer.body));
  } else if (!answer.stream) {
    to.set_content("", answer.type.c_str());
  }
}

// As many as are needed at once, so that nobody waits for others. Tells of every connection.
class ThreadsForConnections : public httplib::TaskQueue {
 public:
  explicit ThreadsForConnections(Connections& connections) : connections_(connections) {}

  void enqueue(std::function<void()> serve) override {
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(std::move(serve));
      if (idle_ < waiting_.size() && threads_.size() < kMostThreads) add_thread();
    }
    changed_.notify_one();
    connections_.opened();
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void add_thread() {
    try {
      threads_.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
      if (threads_.empty()) throw;  // else those that there are serve one after another
    }
  }

  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      ++idle_;
      changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
      --idle_;
      if (waiting_.empty()) return;
      const std::function<void()> serve = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      serve();
      lock.lock();
    }
  }

  Connections& connections_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  std::vector<std::thread> threads_;
  std::size_t idle_ = 0;
  bool ends_ = false;
};

}  // namespace

struct HttpServer::Impl {
  httplib::Server server;
  HttpHandler handler;
  HttpAdmission admit;
  int port = 0, listening = -1;
  std::optional<Connections> connections;  // while it serves

  std::mutex mutex;
  std::condition_variable changed;
  bool serves = false;

  void set_serving(bool now) {
    const std::lock_guard lock(mutex);
    serves = now;
    changed.notify_all();
  }

  // Requests without a body are answered before any routing, which would only look for patterns.
  httplib::Server::HandlerResponse before(const httplib::Request& from, httplib::Response& to) {
    using Handled = httplib::Server::HandlerResponse;
    HttpRequest request = request_of(from);
    if (from.path.size() > kLongestPath) {
      send(to, plain_refusal(414, "The address is too long."), true);
      return Handled::Handled;
    }
    const Admission admission = admit(request);
    if (admission.is_known) connections->know(peer_of(from));
    if (admission.refusal) {
      send(to, *admission.refusal, request.has_body);
      return Handled::Handled;
    }
    if (request.has_body && (from.method == "POST" || from.method == "PUT"))
      return Handled::Unhandled;
    if (request.has_body) {
      send(to, plain_refusal(400, "Such a request has no content."), true);
      return Handled::Handled;
    }
    request.read_body = [](const auto&) { return true; };
    const HttpAnswer answer = handler(request);
    send(to, answer, false);
    if (answer.stream)
      send_stream(to, answer, std::make_shared<const WatchedConnection>(port, peer_of(from)));
    return Handled::Handled;
  }

  void with_body(const httplib::Request& from, httplib::Response& to,
                 const httplib::ContentReader& reader) {
    HttpRequest request = request_of(from);
    bool wanted = false, whole = false;
    request.read_body = [&](const std::function<bool(const char*, std::size_t)>& take) {
      wanted = true;
      whole = reader([&](const char* data, std::size_t size) { return take(data, size); });
      return whole;
    };
    const HttpAnswer answer = handler(request);
    if (!wanted && request.body_bytes.value_or(kReadAnyhow + 1) <= kReadAnyhow)
      whole = reader([](const char*, std::size_t) { return true; });
    send(to, answer, !whole);
  }
};

HttpServer::HttpServer(HttpHandler handler, HttpAdmission admit) : impl_(std::make_unique<Impl>()) {
  impl_->handler = std::move(handler);
  impl_->admit = std::move(admit);
  httplib::Server& server = impl_->server;
  Impl* const impl = impl_.get();
  server.new_task_queue = [impl] { return new ThreadsForConnections(*impl->connections); };
  // Not SO_REUSEPORT, cpp-httplib's own choice: two studios would share a port.
  server.set_socket_options([impl](int socket) {
    impl->listening = socket;
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_tcp_nodelay(true);
  server.set_keep_alive_timeout(kKeepAlive_s);
  server.set_keep_alive_max_count(kKeepAliveRequests);
  server.set_read_timeout(kTimeout_s);
  server.set_write_timeout(kTimeout_s);
  server.set_pre_routing_handler([impl](const httplib::Request& from, httplib::Response& to) {
    return impl->before(from, to);
  });
  // What cpp-httplib refuses by itself has no content.
  server.set_error_handler(
      httplib::Server::Handler([](const httplib::Request&, httplib::Response& to) {
        if (to.body.empty() && !to.content_provider_)
          send(to, plain_refusal(to.status, "The request cannot be read."), false);
      }));
  const auto with_body = [impl](const httplib::Request& from, httplib::Response& to,
                                const httplib::ContentReader& reader) {
    impl->with_body(from, to, reader);
  };
  server.Post("/.*", with_body);
  server.Put("/.*", with_body);
}

HttpServer::~HttpServer() = default;

bool HttpServer::bind(const std::string& address, int port) {
  if (port == 0)
    port = impl_->server.bind_to_any_port(address);
  else if (!impl_->server.bind_to_port(address, port))
    port = -1;
  if (port <= 0) return false;
  impl_->port = port;
  ::listen(impl_->listening, kBacklog);
  return true;
}

int HttpServer::port() const { return impl_->port; }

void HttpServer::run() {
  impl_->connections.emplace(impl_->port);
  impl_->set_serving(true);
  impl_->server.listen_after_bind();
  impl_->set_serving(false);
  impl_->connections.reset();
}

void HttpServer::stop() {
  // A server that is about to begin would not hear of it.
  for (int tries = 0; tries < kTriesToStop && !impl_->server.is_running(); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  impl_->server.stop();
  // Whoever stalls in the middle of a request is not waited for; answers on their way are, a
  // little.
  shut_connections(impl_->port, SHUT_RD);
  std::unique_lock lock(impl_->mutex);
  if (!impl_->changed.wait_for(lock, kLastAnswers, [&] { return !impl_->serves; }))
    shut_connections(impl_->port, SHUT_RDWR);
}

}  // namespace hydrodip
