// Who is let in: the page that this program opened, and nobody else on this machine or beyond it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studio/api_error.h"
#include "studio/http.h"

namespace hydrodip {

// So many random bytes, as hexadecimal digits. From the system's source of randomness.
std::string random_hex(std::size_t bytes);

// Compares without telling by its time where the first difference is.
bool same_secret(const std::string& a, const std::string& b);

struct Guard {
  std::string token;               // of this run
  std::string password;            // empty: the token is in the address
  std::vector<std::string> hosts;  // as a browser may name this server: "127.0.0.1:4714"
  bool numbers = false;            // or by any address in numbers: only names can be pointed here
  std::string cookie;              // its name; cookies know no ports

  // Why a request is refused, whatever it asks for. A page elsewhere can make a browser send
  // requests here, and can let its own name point here; the browser then tells by Host and Origin.
  std::optional<ApiError> refuses_origin(const HttpRequest& request) const;
  // Whether it carries the token.
  bool knows(const HttpRequest& request) const;
  // The header that gives the token to a browser.
  std::string set_cookie() const;
};

}  // namespace hydrodip
