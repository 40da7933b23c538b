#include "studio/entrance.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

#include "studio/api_error.h"
#include "studio/file_answers.h"
#include "studio/page_assets.h"
#include "studio/request_values.h"

namespace hydrodip {
namespace {

constexpr std::uintmax_t kMostForm = 4096;
constexpr auto kWrongPassword = std::chrono::milliseconds(700);

// For a password: nothing of the page is shown before.
constexpr const char* kLogin = R"(<!doctype html><html lang="en"><meta charset="utf-8">
<title>hydrodip studio</title><meta name="viewport" content="width=device-width, initial-scale=1">
<style>body{font-family:sans-serif;max-width:22em;margin:20vh auto;padding:0 1em}
input,button{font:inherit;padding:.5em;width:100%;box-sizing:border-box;margin:.5em 0}</style>
<h1>hydrodip studio</h1><form method="post" action="/login"><label>Password
<input type="password" name="password" autofocus required></label><button>Open</button></form>
</html>)";

constexpr const char* kNoToken = R"(<!doctype html><html lang="en"><meta charset="utf-8">
<title>hydrodip studio</title><style>body{font-family:sans-serif;max-width:32em;margin:20vh auto;
padding:0 1em}</style><h1>This studio does not know your browser</h1>
<p>Open the address that <code>hydrodip studio</code> printed: it lets this browser in.</p></html>)";

}  // namespace

HttpAnswer enter(const Guard& guard, const HttpRequest& request) {
  const auto token = request.query.find("token");
  if (guard.password.empty() && token != request.query.end() &&
      same_secret(token->second, guard.token)) {
    HttpAnswer answer;
    answer.status = 303;
    answer.type = "text/plain";
    answer.headers = {
        {"Location", "/"}, {"Set-Cookie", guard.set_cookie()}, {"Cache-Control", "no-store"}};
    return answer;
  }
  if (!guard.knows(request)) {
    HttpAnswer answer;
    answer.status = guard.password.empty() ? 403 : 200;
    answer.type = "text/html; charset=utf-8";
    answer.headers = {{"Cache-Control", "no-store"},
                      {"Content-Security-Policy",
                       "default-src 'none'; style-src 'unsafe-inline'; form-action 'self'; "
                       "frame-ancestors 'none'"}};
    answer.body = guard.password.empty() ? kNoToken : kLogin;
    return answer;
  }
  return page_answer("text/html", "index.html", studio_page());
}

HttpAnswer log_in(const Guard& guard, HttpRequest& request) {
  const std::string form = read_text(request, kMostForm);
  if (guard.password.empty()) throw not_found();
  if (!same_secret(form_value(form, "password"), guard.password)) {
    std::this_thread::sleep_for(kWrongPassword);
    throw ApiError(403, "no-token", "That is not the password.");
  }
  HttpAnswer answer;
  answer.status = 303;
  answer.type = "text/plain";
  answer.headers = {{"Location", "/"}, {"Set-Cookie", guard.set_cookie()}};
  return answer;
}

}  // namespace hydrodip
