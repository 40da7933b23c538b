// Who is let in, and what nobody gets.
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>
#include <zip.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "base/error.h"
#include "base/file.h"
#include "full_disk.h"
#include "refusal.h"
#include "studio/served.h"
#include "studio/zip.h"

namespace hydrodip {
namespace {

using Headers = std::map<std::string, std::string>;

class SecurityTest : public testing::Test {
 protected:
  Headers with(const std::string& name, const std::string& value) const {
    Headers headers = client.own_headers();
    headers[name] = value;
    return headers;
  }
  std::string own() const { return "127.0.0.1:" + std::to_string(studio.port()); }
  std::string new_job() const { return client.post("/api/jobs").json()["job"]; }

  TemporaryFolder folder;
  Served studio{folder.path()};
  Client client = studio.client();
};

TEST_F(SecurityTest, ThePageGetsIn) {
  EXPECT_EQ(client.get("/api/hello").status, 200);
  EXPECT_EQ(client.get("/").status, 200);
  EXPECT_NE(client.get("/").headers["content-security-policy"].find("script-src 'self'"),
            std::string::npos);
}

TEST_F(SecurityTest, TheTokenInTheAddressGivesACookieThatNoScriptSees) {
  const Reply reply = client.send("GET", std::string("/?token=") + kToken, "", {});
  EXPECT_EQ(reply.status, 303);
  EXPECT_EQ(reply.headers.at("location"), "/");
  const std::string cookie = reply.headers.at("set-cookie");
  for (const char* part : {kToken, "HttpOnly", "SameSite=Strict"})
    EXPECT_NE(cookie.find(part), std::string::npos) << part;
}

TEST_F(SecurityTest, NoTokenNoAnswer) {
  for (const char* cookie : {"", "hydrodip=x", "hydrodip-1=0123456789abcdef0123456789abcdef"})
    for (const char* path : {"/api/hello", "/api/recent", "/app.js", "/api/jobs/0123456789abcdef"})
      EXPECT_EQ(client.send("GET", path, "", {{"Cookie", cookie}}).code(), "no-token") << path;
  EXPECT_EQ(client.send("POST", "/api/jobs", "{}", {{"X-Hydrodip", "1"}}).code(), "no-token");
  EXPECT_EQ(client.send("GET", "/?token=wrong", "", {}).status, 403);
  EXPECT_FALSE(client.send("GET", "/?token=wrong", "", {}).headers.contains("set-cookie"));
}

// A name that somebody else points to this machine (DNS rebinding) still says itself in Host.
TEST_F(SecurityTest, OnlyTheOwnHostIsAnswered) {
  for (const std::string& host :
       {std::string("evil.example"), "evil.example:" + std::to_string(studio.port()),
        std::string("127.0.0.1"), std::string("127.0.0.1:1"), std::string("")}) {
    EXPECT_EQ(client.send("GET", "/api/hello", "", with("Host", host)).code(), "wrong-host");
    EXPECT_EQ(client.send("GET", "/", "", with("Host", host)).code(), "wrong-host");
    EXPECT_EQ(client.send("POST", "/api/jobs", "{}", with("Host", host)).code(), "wrong-host");
  }
}

TEST_F(SecurityTest, OnlyTheOwnOriginCommands) {
  for (const std::string& origin : {std::string("http://evil.example"), std::string("null"),
                                    "https://" + own(), std::string("http://127.0.0.1:1")}) {
    EXPECT_EQ(client.send("POST", "/api/jobs", "{}", with("Origin", origin)).code(),
              "wrong-origin");
    EXPECT_EQ(client.send("GET", "/api/hello", "", with("Origin", origin)).code(), "wrong-origin");
  }
  EXPECT_EQ(client.send("POST", "/api/jobs", "{}", with("Origin", "http://" + own())).status, 201);
  EXPECT_EQ(client.send("GET", "/api/hello", "", with("Sec-Fetch-Site", "cross-site")).code(),
            "wrong-origin");
  // A form of another page has neither.
  Headers bare = client.own_headers();
  bare.erase("X-Hydrodip");
  EXPECT_EQ(client.send("POST", "/api/jobs", "{}", bare).code(), "wrong-origin");
  bare["Origin"] = "http://" + own();
  EXPECT_EQ(client.send("POST", "/api/jobs", "{}", bare).status, 201);
}

TEST_F(SecurityTest, NothingBeyondTheJobsFolderIsRead) {
  const std::string job = new_job();
  std::ofstream(folder / "secret.png") << "secret";
  for (const char* name :
       {"../../../secret.png", "..%2f..%2f..%2fsecret.png", "%2e%2e/%2e%2e/secret.png",
        "/etc/passwd", "%2Fetc%2Fpasswd", "..\\..\\secret.png", "a/../../secret.png", "./x.png",
        ".hidden.png", "state.json", "../state.json", "x%00.png", ""}) {
    const Reply read = client.get("/api/jobs/" + job + "/files/" + name);
    EXPECT_GE(read.status, 400) << name;
    EXPECT_EQ(read.body.find("secret\n"), std::string::npos);
    const Reply task = client.get("/api/jobs/" + job + "/tasks/t1/files/" + name);
    EXPECT_GE(task.status, 400) << name;
  }
  for (const char* other : {"..", "../..", "%2e%2e", "0123456789abcdeg", "0123456789abcdef"})
    EXPECT_EQ(client.get(std::string("/api/jobs/") + other).status, 404) << other;
}

TEST_F(SecurityTest, NothingBeyondTheJobsFolderIsWritten) {
  const std::string job = new_job();
  for (const char* name : {"../escaped.png", "..%2fescaped.png", "%2fetc%2fescaped.png",
                           "a/../../escaped.png", ".hidden.png"}) {
    EXPECT_GE(client.put("/api/jobs/" + job + "/files/" + name, "x").status, 400) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "jobs" / job / "escaped.png"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "jobs" / job / "files"));
}

TEST_F(SecurityTest, ADocumentNamesNoFileOfTheMachine) {
  const std::string job = new_job();
  std::ofstream(folder / "model.stl") << "x";
  const std::string outside = (folder / "model.stl").string();
  for (const std::string& file : {outside, std::string("../../../model.stl")})
    for (const std::string& document : {R"({"object": {"file": ")" + file + R"("}})",
                                        R"({"artwork": [{"image": ")" + file + R"("}]})",
                                        R"({"ink": {"profile": ")" + file + R"("}})"}) {
      const Reply reply = client.put("/api/jobs/" + job + "/document",
                                     R"({"client": "c1", "document": )" + document + "}");
      EXPECT_GE(reply.status, 400) << document;
      EXPECT_TRUE(reply.code() == "bad-name" || reply.code() == "bad-value") << reply.body;
    }
}

// A job's file may name any file, but not when it was dropped on a page.
TEST_F(SecurityTest, ADroppedJobReadsOnlyWhatWasDroppedWithIt) {
  const std::string job = new_job();
  std::ofstream(folder / "secret.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string toml = "[object]\nfile = \"" + (folder / "secret.obj").string() + "\"\n";
  ASSERT_EQ(client.put("/api/jobs/" + job + "/files/job.toml", toml).status, 201);
  const Reply reply = client.post("/api/jobs/" + job + "/adopt", R"({"files": ["job.toml"]})");
  EXPECT_EQ(reply.code(), "bad-file");
  EXPECT_FALSE(client.get("/api/jobs/" + job).json()["document"].contains("object"));
}

// Nor does a model that was dropped, whatever it names.
TEST_F(SecurityTest, ADroppedModelReadsOnlyWhatWasDroppedWithIt) {
  const std::string job = new_job(), at = "/api/jobs/" + job;
  std::ofstream(folder / "secret.mtl") << "newmtl secret\nKd 1 0 0\n";
  const std::string obj = "mtllib " + (folder / "secret.mtl").string() +
                          "\nmtllib ../../../secret.mtl\nv 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\n"
                          "usemtl secret\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  ASSERT_EQ(client.put(at + "/files/toy.obj", obj).status, 201);
  ASSERT_EQ(client.put(at + "/files/toy.mtl", "newmtl toy\n").status, 201);
  ASSERT_EQ(client.post(at + "/adopt", R"({"files": ["toy.obj", "toy.mtl"]})").status, 200);
  EXPECT_GE(client.get(at + "/files/secret.mtl").status, 400);
  Events events(client, at + "/events?client=c1");
  ASSERT_TRUE(events.next("mesh"));
  const Reply packed = client.get(at + "/job.zip");
  ASSERT_EQ(packed.status, 200);
  EXPECT_NE(packed.body.find("toy.obj"), std::string::npos);
  EXPECT_EQ(packed.body.find("secret.mtl"), std::string::npos);
}

TEST_F(SecurityTest, TooLargeIsRefusedBeforeItIsSent) {
  const std::string job = new_job();
  const std::string path = "/api/jobs/" + job + "/files/huge.stl";
  // Two gigabytes are announced, and not one byte is sent: the answer does not wait for them.
  EXPECT_EQ(client.send("PUT", path, "", with("Content-Length", "2147483648")).code(), "too-large");
  EXPECT_EQ(
      client.send("PUT", "/api/jobs/" + job + "/document", "", with("Content-Length", "2147483648"))
          .code(),
      "too-large");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "jobs" / job / "files"));
  // What comes without a length is counted: a picture for the list of jobs has 256 kB.
  Headers chunked = with("Transfer-Encoding", "chunked");
  std::string body;
  for (int n = 0; n < 300; ++n) body += "400\r\n" + std::string(1024, 'x') + "\r\n";
  chunked["Content-Length"];  // none
  chunked.erase("Content-Length");
  const Reply reply =
      client.send("PUT", "/api/jobs/" + job + "/thumbnail", body + "0\r\n\r\n", chunked);
  EXPECT_TRUE(reply.status == 413 || reply.status == 0) << reply.status;
}

TEST_F(SecurityTest, AWrongRequestLeavesTheServerWell) {
  for (const char* body :
       {"", "{", "[]", "null", "\"x\"", "{\"client\": 3}", R"({"client": "c1", "document": 3})",
        R"({"client": "c1", "document": {"object": 3}})",
        R"({"client": "c1", "document": {"object": {"size_mm": "x"}}})",
        R"({"client": "c1", "document": {"run": {"threads": 1}}})",
        R"({"client": "c1", "document": {"nonsense": {"x": 1}}})",
        R"({"client": "<script>", "document": {}})"}) {
    const std::string job = new_job();
    const Reply reply = client.put("/api/jobs/" + job + "/document", body);
    EXPECT_GE(reply.status, 400) << body;
    EXPECT_LT(reply.status, 500) << body;
  }
  EXPECT_EQ(client.get("/api/hello").status, 200);
}

// Connections that say half of something, or nothing, and wait.
class SilentStrangers {
 public:
  SilentStrangers(int port, std::size_t count, const std::string& says) {
    for (std::size_t i = 0; i < count; ++i) sockets_.push_back(Client(port, "").say(says));
  }
  ~SilentStrangers() {
    for (const int socket : sockets_) ::close(socket);
  }
  SilentStrangers(const SilentStrangers&) = delete;
  SilentStrangers& operator=(const SilentStrangers&) = delete;

  // Waits until the server has ended so many of them; what ends a test that hangs ends this.
  void wait_for_end_of(std::size_t count) const {
    for (;;) {
      std::size_t ended = 0;
      for (const int socket : sockets_) {
        pollfd one{socket, POLLIN, 0};
        ended += ::poll(&one, 1, 0) > 0;
      }
      if (ended >= count) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

 private:
  std::vector<int> sockets_;
};

// A stranger's half request was kept for 20 s, and 64 of them kept everybody else out.
TEST_F(SecurityTest, StrangersWhoSayHalfOfSomethingKeepNobodyOut) {
  const std::string job = new_job();
  Events events(client, "/api/jobs/" + job + "/events?client=c1");
  EXPECT_TRUE(events.next("hello"));
  for (const char* half :
       {"GET / HTTP/1.1\r\nHost: ", "",
        "POST /login HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 9\r\n\r\n"}) {
    const SilentStrangers strangers(studio.port(), 100, half);
    EXPECT_EQ(client.get("/api/hello").status, 200) << half;
    // One address has few; that it is their number and not their age: connections_test.cpp.
    strangers.wait_for_end_of(100 - 16);
  }
  // Who is known stays, whatever strangers do.
  EXPECT_EQ(client.post("/api/jobs/" + job + "/pen", R"({"client": "c1"})").status, 200);
  EXPECT_TRUE(events.next("pen"));
}

// "name" in a ZIP archive, by libzip.
void make_zip(const std::filesystem::path& file,
              const std::vector<std::pair<std::string, std::string>>& files) {
  zip_t* const zip = zip_open(file.c_str(), ZIP_CREATE, nullptr);
  for (const auto& [name, text] : files)
    zip_file_add(zip, name.c_str(), zip_source_buffer(zip, text.data(), text.size(), 0), 0);
  zip_close(zip);
}

std::string bytes_of(const std::filesystem::path& file) {
  const auto bytes = read_file(file);
  return {bytes.begin(), bytes.end()};
}

// Whoever refuses: the server itself, or the library below it.
TEST_F(SecurityTest, EveryRefusalSaysWhat) {
  const auto said = [&](const Reply& reply) {
    const nlohmann::json json = reply.json();
    ASSERT_TRUE(json.is_object() && json.contains("error")) << reply.status << " " << reply.body;
    EXPECT_FALSE(json["error"]["code"].get<std::string>().empty());
    EXPECT_FALSE(json["error"]["text"].get<std::string>().empty());
  };
  const auto send = [&](const std::string& method, const std::string& path,
                        const std::string& body) {
    return client.send(method, path, body, client.own_headers());
  };
  for (const Reply& reply :
       {send("GET", "/api/hello?" + std::string(3000, 'x'), ""),
        send("GET", "/api/" + std::string(3000, 'x'), ""), send("GET", "/api/hello", "content"),
        send("GET", "/api/" + std::string(9000, 'x'), ""), send("NONSENSE", "/api/hello", ""),
        send("GET", "no path", "")}) {
    if (reply.status < 400) continue;
    said(reply);
  }
  said(send("GET", "/api/" + std::string(3000, 'x'), ""));
  said(send("GET", "/api/hello", "content"));
}

TEST_F(SecurityTest, AnArchiveUnpacksIntoTheJobAlone) {
  const std::string job = new_job(), at = "/api/jobs/" + job;
  make_zip(folder / "toy.zip", {{"../escaped.obj", "v 0 0 0\n"},
                                {"/escaped.obj", "v 0 0 0\n"},
                                {".hidden.obj", "v 0 0 0\n"},
                                {"run.sh", "rm"},
                                {"toy/toy.obj",
                                 "v 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\n"
                                 "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"}});
  ASSERT_EQ(client.put(at + "/files/toy.zip", bytes_of(folder / "toy.zip")).status, 201);
  const Reply reply = client.post(at + "/adopt", R"({"files": ["toy.zip"]})");
  ASSERT_EQ(reply.status, 200) << reply.body;
  EXPECT_EQ(reply.json()["document"]["object"]["file"], "toy/toy.obj");
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(folder / "jobs" / job / "files"))
    if (entry.is_regular_file()) files.push_back(entry.path().filename().string());
  EXPECT_EQ(files, std::vector<std::string>{"toy.obj"});
}

// The last bytes of a small file go out as it is closed.
TEST(Zip, OfAnArchiveThatDoesNotUnpackNothingStays) {
  const TemporaryFolder folder;
  make_zip(folder / "toy.zip", {{"kept/a.obj", "v 0 0 0\n"}, {"b.obj", std::string(3000, 'v')}});
  std::filesystem::create_directory(folder / "files");
  const auto unpack = [&] {
    unpack_zip(folder / "toy.zip", 1U << 20U,
               [&](const std::string& name) { return folder / "files" / name; });
  };
  {
    const FullDisk disk(1000);
    EXPECT_NE(refusal(unpack), "");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder / "files"));
  unpack();
  EXPECT_EQ(bytes_of(folder / "files/b.obj"), std::string(3000, 'v'));
  // What was there is not unpacked over, and stays.
  EXPECT_NE(refusal(unpack), "");
  EXPECT_EQ(bytes_of(folder / "files/kept/a.obj"), "v 0 0 0\n");
}

TEST(Zip, WhatIsNoPlainNameOrAMacsOwnIsNotUnpacked) {
  const TemporaryFolder folder;
  make_zip(
      folder / "toy.zip",
      {{"a.obj", "v 0 0 0\n"}, {"../escaped.obj", "v 0 0 0\n"}, {"__MACOSX/a.obj", "v 0 0 0\n"}});
  std::vector<std::string> asked;
  unpack_zip(folder / "toy.zip", 1U << 20U, [&](const std::string& name) {
    asked.push_back(name);
    return std::filesystem::path();
  });
  EXPECT_EQ(asked, std::vector<std::string>{"a.obj"});
}

TEST(Zip, MoreBytesOrFilesThanAJobMayHaveAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::vector<std::pair<std::string, std::string>>& files,
                           std::uintmax_t most_bytes) {
    std::filesystem::remove(folder / "toy.zip");
    make_zip(folder / "toy.zip", files);
    std::string said = refusal([&] {
      unpack_zip(folder / "toy.zip", most_bytes,
                 [&](const std::string& name) { return folder / "files" / name; });
    });
    EXPECT_EQ(std::filesystem::exists(folder / "files"), said.empty()) << said;
    std::filesystem::remove_all(folder / "files");
    return said;
  };
  const std::vector<std::pair<std::string, std::string>> two = {
      {"in/a.obj", std::string(600, 'v')}, {"in/b.obj", std::string(400, 'v')}};
  EXPECT_EQ(refused(two, 1000), "");
  EXPECT_NE(refused(two, 999), "");
  std::vector<std::pair<std::string, std::string>> many(2000, {"", "v"});
  for (std::size_t n = 0; n < many.size(); ++n) many[n].first = std::to_string(n) + ".obj";
  EXPECT_EQ(refused(many, 1U << 20U), "");
  many.emplace_back("one-more.obj", "v");
  EXPECT_NE(refused(many, 1U << 20U), "");
}

TEST_F(SecurityTest, AnArchiveThatBlowsUpIsRefused) {
  const std::string job = new_job(), at = "/api/jobs/" + job;
  const std::string zeros(std::size_t(200) << 20U, '\0');
  make_zip(folder / "bomb.zip", {{"a.stl", zeros}});
  ASSERT_LT(std::filesystem::file_size(folder / "bomb.zip"), 1u << 20U);
  ASSERT_EQ(client.put(at + "/files/bomb.zip", bytes_of(folder / "bomb.zip")).status, 201);
  EXPECT_EQ(client.post(at + "/adopt", R"({"files": ["bomb.zip"]})").code(), "bad-file");
}

}  // namespace
}  // namespace hydrodip
