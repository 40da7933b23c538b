#include "studio/guard.h"

#include <sys/random.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace hydrodip {
namespace {

// "a=1; b=2" -> the value of `name`.
std::string cookie_value(const std::string& cookies, const std::string& name) {
  for (std::size_t begin = 0; begin < cookies.size();) {
    const std::size_t end = std::min(cookies.find(';', begin), cookies.size());
    const std::size_t first = cookies.find_first_not_of(' ', begin);
    if (first < end && cookies.compare(first, name.size() + 1, name + "=") == 0)
      return cookies.substr(first + name.size() + 1, end - first - name.size() - 1);
    begin = end + 1;
  }
  return "";
}

// "192.168.1.5:4714", "[fd00::5]:4714"
bool is_number(const std::string& host) {
  return !host.empty() &&
         host.find_first_not_of(host[0] == '[' ? "[]0123456789abcdef:." : "0123456789.:") ==
             std::string::npos;
}

bool is_reading(const HttpRequest& request) { return request.method == "GET"; }

}  // namespace

std::string random_hex(std::size_t bytes) {
  std::string random(bytes, '\0');
  std::size_t have = 0;
  while (have < bytes) {
    const ssize_t count = ::getrandom(random.data() + have, bytes - have, 0);
    if (count < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category());
    if (count > 0) have += std::size_t(count);
  }
  std::string text;
  for (const char c : random) {
    constexpr const char* kDigits = "0123456789abcdef";
    text += kDigits[static_cast<unsigned char>(c) >> 4U];
    text += kDigits[static_cast<unsigned char>(c) & 15U];
  }
  return text;
}

bool same_secret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

std::optional<ApiError> Guard::refuses_origin(const HttpRequest& request) const {
  const std::string host = request.header("Host");
  if (std::find(hosts.begin(), hosts.end(), host) == hosts.end() && !(numbers && is_number(host)))
    return ApiError(403, "wrong-host",
                    "The studio answers only to its own address; open the one that it printed.");
  const std::string origin = request.header("Origin"), site = request.header("Sec-Fetch-Site");
  const bool foreign = (!origin.empty() && origin != "http://" + host) ||
                       (!site.empty() && site != "same-origin" && site != "none");
  if (foreign)
    return ApiError(403, "wrong-origin",
                    "Another page asked for this; only the studio's own page may.");
  if (!is_reading(request) && origin.empty() && request.header("X-Hydrodip") != "1")
    return ApiError(403, "wrong-origin",
                    "It does not say where it comes from: a command needs an Origin, or the header "
                    "X-Hydrodip: 1.");
  return std::nullopt;
}

bool Guard::knows(const HttpRequest& request) const {
  return same_secret(cookie_value(request.header("Cookie"), cookie), token);
}

std::string Guard::set_cookie() const {
  return cookie + "=" + token + "; Path=/; HttpOnly; SameSite=Strict";
}

}  // namespace hydrodip
