// A job over HTTP: its document, what is computed of it, what is printed, and what outlives a run.
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <set>
#include <thread>

#include "base/file.h"
#include "base/folder_lock.h"
#include "hydrodip/workspace.h"
#include "image/files.h"
#include "job/jobs.h"
#include "settings/job_file.h"
#include "settings/settings.h"
#include "studio/models.h"
#include "studio/served.h"

namespace hydrodip {
namespace {

using nlohmann::json;

// A job of the pyramid that is quick to compute, by default.
class JobTest : public testing::Test {
 protected:
  JobTest() { begin(); }

  void begin() {
    studio.reset();
    studio = std::make_unique<Served>(folder.path(), "run-" + std::to_string(++runs));
    client = std::make_unique<Client>(studio->client());
  }
  std::string sample(const std::string& name) {
    const Reply reply = client->post("/api/jobs", json{{"sample", name}}.dump());
    EXPECT_EQ(reply.status, 201) << reply.body;
    return reply.json()["job"];
  }
  std::string at(const std::string& job, const std::string& rest = "") const {
    return "/api/jobs/" + job + rest;
  }
  json describe(const std::string& job) const { return client->get(at(job)).json(); }
  Reply put(const std::string& job, const json& document, bool live = false,
            const std::string& who = "c1", long base = -1) const {
    json body = {{"client", who}, {"document", document}, {"live", live}};
    if (base >= 0) body["base"] = base;
    return client->put(at(job, "/document"), body.dump());
  }
  static json quick(const json& document) {
    json quick = document;
    quick["film"] = {{"width_mm", 150}, {"height_mm", 150}, {"elements", 2000}};
    quick["dip"]["step_mm"] = 1;
    quick["dip"]["air_cells"] = 20000;
    quick["print"]["dpi"] = 72;
    quick["ink"]["rounds_max"] = 2;
    quick["preview"] = {{"pictures", "off"}};
    return quick;
  }

  TemporaryFolder folder;
  int runs = 0;
  std::unique_ptr<Served> studio;
  std::unique_ptr<Client> client;
};

TEST_F(JobTest, ASampleIsShownAndItsResultIsWhole) {
  const std::string job = sample("pyramid");
  Events events(*client, at(job, "/events?client=c1"));
  const auto hello = events.next("hello");
  ASSERT_TRUE(hello);
  EXPECT_TRUE(hello->data["pen"]);
  const long revision = put(job, quick(describe(job)["document"])).json()["revision"];
  const auto told = events.next("result", [&](const json& e) { return e["revision"] == revision; });
  ASSERT_TRUE(told);
  EXPECT_NE(told->data["quality"], "normal");

  const ReadBundle result(
      client->get(at(job, "/results/" + told->data["result"].get<std::string>())).body);
  ASSERT_TRUE(result.head.is_object());
  const auto u = result.array<float>("film.u"), position = result.array<float>("film.position");
  const auto state = result.array<std::uint8_t>("film.state");
  const auto torn = result.array<std::uint8_t>("film.torn");
  const auto index = result.array<std::uint32_t>("film.index");
  ASSERT_EQ(u.size(), 2 * state.size());
  ASSERT_EQ(position.size(), 3 * state.size());
  ASSERT_EQ(index.size(), 3 * torn.size());
  for (const std::uint32_t v : index) ASSERT_LT(v, state.size());
  const std::size_t pixels = result.head["sheet"]["width_px"].get<std::size_t>() *
                             result.head["sheet"]["height_px"].get<std::size_t>();
  EXPECT_EQ(result.array<std::uint8_t>("sheet.printed").size(), 4 * pixels);
  EXPECT_EQ(result.array<std::uint8_t>("sheet.predicted").size(), 4 * pixels);

  // The rim is where the sheet's margin says, and film on the object lies inside its box.
  const double free_mm = 0.5 * 150 - result.head["film"]["margin_mm"].get<double>();
  double covered = 0;
  const ReadBundle mesh(
      client->get(at(job, "/meshes/" + describe(job)["mesh"].get<std::string>())).body);
  const json low = mesh.head["low_mm"], high = mesh.head["high_mm"];
  for (std::size_t v = 0; v < state.size(); ++v) {
    if (state[v] == 2) {
      EXPECT_NEAR(std::max(std::abs(u[2 * v]), std::abs(u[2 * v + 1])), free_mm, 1e-3);
    }
    if (state[v] != 1) continue;
    EXPECT_GE(position[3 * v + 2], -0.1);
    EXPECT_LE(position[3 * v + 2], high[2].get<double>() - low[2].get<double>() + 0.1);
  }
  for (std::size_t t = 0; t < torn.size(); ++t) {
    const auto corner = [&](std::size_t k) {
      const float* p = position.data() + 3 * index[3 * t + k];
      return Vec3(double(p[0]), double(p[1]), double(p[2]));
    };
    bool lies = !torn[t];
    for (std::size_t k = 0; k < 3; ++k) lies = lies && state[index[3 * t + k]] == 1;
    if (lies) covered += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  EXPECT_NEAR(covered, result.head["figures"]["covered_mm2"].get<double>(), 1e-3 * covered);

  // Somewhere on the sheet there is ink, and its margin is free of it.
  const auto printed = result.array<std::uint8_t>("sheet.printed");
  std::size_t inked = 0;
  for (std::size_t i = 3; i < printed.size(); i += 4) inked += printed[i] > 0;
  EXPECT_GT(inked, pixels / 50);
  EXPECT_EQ(printed[3], 0);
}

TEST_F(JobTest, TheMeshIsTheModelInItsOwnFrame) {
  const std::string job = sample("box");
  Events events(*client, at(job, "/events?client=c1"));
  const auto told = events.next("mesh");
  ASSERT_TRUE(told);
  const ReadBundle mesh(
      client->get(at(job, "/meshes/" + told->data["mesh"].get<std::string>())).body);
  const auto position = mesh.array<float>("position");
  const auto index = mesh.array<std::uint32_t>("index");
  EXPECT_EQ(index.size(), 3 * mesh.head["triangles"].get<std::size_t>());
  for (std::size_t k = 0; k < 3; ++k) {
    float low = 1e9F, high = -1e9F;
    for (std::size_t v = k; v < position.size(); v += 3) {
      low = std::min(low, position[v]);
      high = std::max(high, position[v]);
    }
    EXPECT_FLOAT_EQ(low, mesh.head["low_mm"][k].get<float>());
    EXPECT_FLOAT_EQ(high, mesh.head["high_mm"][k].get<float>());
  }
  const Reply texture = client->get(mesh.head["textures"][0].get<std::string>());
  EXPECT_EQ(texture.status, 200);
  EXPECT_TRUE(texture.headers.at("content-type").starts_with("image/"));
}

// What follows a hand is coarser than what is shown when it stops.
TEST_F(JobTest, ASketchComesFirstAndAloneInADrag) {
  const std::string job = sample("pyramid");
  json document = quick(describe(job)["document"]);
  document["film"]["elements"] = 12000;
  Events events(*client, at(job, "/events?client=c1"));
  const auto vertices_of_next = [&](long revision, const std::string& quality) -> std::size_t {
    const auto told = events.next(
        "result", [&](const json& e) { return e["revision"] == revision; }, 20);
    if (!told || told->data["quality"] != quality) return 0;
    const std::string id = told->data["result"];
    return ReadBundle(client->get(at(job, "/results/" + id)).body)
        .array<std::uint8_t>("film.state")
        .size();
  };
  document["object"]["rotate_deg"] = {0, 0, 10};
  const long dragged = put(job, document, true).json()["revision"];
  const std::size_t sketch = vertices_of_next(dragged, "sketch");
  EXPECT_GT(sketch, 0u);
  EXPECT_FALSE(events.next(
      "result", [&](const json& e) { return e["revision"] == dragged; }, 0.7));
  const long ended = put(job, document, false).json()["revision"];
  EXPECT_GT(vertices_of_next(ended, "draft"), sketch);
  EXPECT_TRUE(events.next("result", [&](const json& e) { return e["quality"] == "normal"; }));
}

// A closed lid burns nothing; and who opens the page again gets what was left out.
TEST_F(JobTest, NothingIsComputedWhileNobodyLooks) {
  const std::string job = sample("pyramid");
  json document = describe(job)["document"];
  document["film"]["elements"] = 640000;
  document["dip"]["step_mm"] = 0.02;
  auto tab = std::make_unique<Events>(*client, at(job, "/events?client=c1"));
  const long revision = put(job, document).json()["revision"];
  const auto is_normal = [&](const json& e) {
    return e["revision"] == revision && e["quality"] == "normal";
  };
  ASSERT_TRUE(tab->next("working", is_normal));
  const auto cancelled = [&] { return client->get(at(job, "/counts")).json()["cancelled"]; };
  const json before = cancelled();
  tab.reset();
  for (int tries = 0; tries < 500 && cancelled() == before; ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(cancelled(), before.get<int>() + 1);
  Events again(*client, at(job, "/events?client=c2"));
  EXPECT_TRUE(again.next("working", is_normal));
}

// A job is recovered whose tab the program did not see close.
TEST_F(JobTest, WhatIsOpenOrWasClosedIsNotRecovered) {
  const std::string job = sample("pyramid");
  const auto listed = [&](const std::string& who = "") {
    const json entry = client->get("/api/recent" + who).json()[0];
    return json{entry["open"], entry["recovered"]};
  };
  auto tab = std::make_unique<Events>(*client, at(job, "/events?client=c1"));
  put(job, quick(describe(job)["document"]));
  EXPECT_EQ(listed(), json({true, false}));
  EXPECT_EQ(listed("?client=c1"), json({false, false}));  // it asks as it has left it
  const std::vector<std::uint8_t> kept = read_file(folder / ("jobs/" + job + "/state.json"));
  tab.reset();
  for (int tries = 0; tries < 500 && listed() != json({false, false}); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(listed(), json({false, false}));
  // As a program leaves it that is killed.
  studio.reset();
  write_whole(folder / ("jobs/" + job + "/state.json"), std::string(kept.begin(), kept.end()));
  begin();
  EXPECT_EQ(listed(), json({false, true}));
  const FolderLock another(folder / ("jobs/" + job));  // the studio that has it
  EXPECT_EQ(listed(), json({true, false}));
}

// Requests in a drag come faster than drafts: what is shown in the end is the newest, and the first
// is not waited for.
TEST_F(JobTest, ANewerRequestIsTheOneThatIsShown) {
  const std::string job = sample("pyramid");
  json document = quick(describe(job)["document"]);
  Events events(*client, at(job, "/events?client=c1"));
  long revision = 0;
  for (int n = 0; n < 25; ++n) {
    document["object"]["rotate_deg"] = {0, 0, 3 * n};
    revision = put(job, document, n < 24).json()["revision"];
  }
  std::vector<long> shown;
  const auto last = events.next("result", [&](const json& e) {
    shown.push_back(e["revision"]);
    return e["revision"] == revision && e["quality"] == "normal";
  });
  ASSERT_TRUE(last);
  EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end()));
  EXPECT_LT(shown.size(), 20u);
  EXPECT_FALSE(events.next("result", {}, 0.5));  // nothing older comes after it
}

// Whoever fetches a moment too late is not told that something is wrong.
TEST_F(JobTest, OfAResultThatWasReplacedNothingIsLeft) {
  const std::string job = sample("pyramid");
  json document = quick(describe(job)["document"]);
  Events events(*client, at(job, "/events?client=c1"));
  std::vector<std::string> results;
  for (int n = 0; n < 8; ++n) {
    document["object"]["rotate_deg"] = {0, 0, 3 * n};
    const long revision = put(job, document, true).json()["revision"];
    const auto told =
        events.next("result", [&](const json& e) { return e["revision"] == revision; });
    ASSERT_TRUE(told);
    results.push_back(told->data["result"]);
  }
  const auto got = [&](const std::string& id) { return client->get(at(job, "/results/" + id)); };
  EXPECT_EQ(got(results.back()).status, 200);
  const Reply old = got(results.front());
  EXPECT_EQ(old.status, 204);
  EXPECT_EQ(old.body, "");
  EXPECT_EQ(client->get(at(job, "/results/" + results.front() + "/dip")).status, 204);
  const std::string run = results.front().substr(0, results.front().find("-r"));
  for (const std::string& never : {run + "-r999", run + "-r", run + "-r0", run + "-r1x",
                                   run + "-x1", std::string("other-r1"), std::string("r1")})
    EXPECT_EQ(got(never).status, 404) << never;
}

TEST_F(JobTest, AnAddressThatGoesOnWhereNoneDoesIsNotFound) {
  const std::string job = sample("pyramid");
  for (const char* here : {"", "/counts", "/job.toml"}) {
    EXPECT_EQ(client->get(at(job, here)).status, 200) << here;
    EXPECT_EQ(client->get(at(job, std::string(here) + "/x")).status, 404) << here;
  }
  const long revision = describe(job)["revision"];
  for (const char* command : {"/save/x", "/reload/x", "/pen/x", "/adopt/x", "/nothing"})
    EXPECT_EQ(client->post(at(job, command), R"({"name": "x"})").status, 404) << command;
  EXPECT_EQ(client->post(at(job, "/document"), "{}").status, 404);
  EXPECT_EQ(client->put(at(job, "/thumbnail/x"), "\x89PNG").status, 404);
  EXPECT_EQ(describe(job)["revision"], revision);
}

// A normal result of a fine film would take many seconds: a newer request does not wait for it.
TEST_F(JobTest, ANewerRequestCancelsTheOlder) {
  const std::string job = sample("pyramid");
  json document = describe(job)["document"];
  document["film"]["elements"] = 640000;
  document["dip"]["step_mm"] = 0.02;
  Events events(*client, at(job, "/events?client=c1"));
  const long first = put(job, document).json()["revision"];
  ASSERT_TRUE(events.next("working", [&](const json& e) {
    return e["revision"] == first && e["quality"] == "normal";
  }));
  const long cancelled = client->get(at(job, "/counts")).json()["cancelled"];
  const long second = put(job, quick(document)).json()["revision"];
  ASSERT_TRUE(events.next("result", [&](const json& e) { return e["revision"] == second; }));
  EXPECT_EQ(client->get(at(job, "/counts")).json()["cancelled"], cancelled + 1);
}

TEST_F(JobTest, WhatDoesNotFitIsSaidAndTheMendMendsIt) {
  const std::string job = sample("box");
  json document = quick(describe(job)["document"]);
  document["object"]["size_mm"] = 200;
  document["film"] = {{"width_mm", 210}, {"height_mm", 297}, {"elements", 2000}};
  Events events(*client, at(job, "/events?client=c1"));
  const long revision = put(job, document).json()["revision"];
  const auto problem =
      events.next("problem", [&](const json& e) { return e["revision"] == revision; });
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->data["text"].get<std::string>().find("--"), std::string::npos);
  ASSERT_FALSE(problem->data["mends"].empty());
  for (const json& mend : problem->data["mends"]) {
    json mended = document;
    mended.merge_patch(mend["patch"]);
    const long next = put(job, mended).json()["revision"];
    EXPECT_TRUE(events.next("result", [&](const json& e) { return e["revision"] == next; }))
        << mend;
  }
}

TEST_F(JobTest, ADocumentSaysWhatItsJobFileSays) {
  const std::string job = sample("pyramid");
  json document = quick(describe(job)["document"]);
  document["object"]["rotate_deg"] = {12.3456789012345, -7, 0.1};
  document["dip"]["depth_mm"] = 17.123456789;
  document["artwork"] = json::array({{{"text", "Hi \"you\""},
                                      {"size_mm", {20, 10.5}},
                                      {"at_mm", {0, 0.1, 3}},
                                      {"through", true},
                                      {"text_color", "#ff0080"}}});
  document["dips"] =
      json::array({{{"rotate_deg", {0, 33.333333333, 0}}, {"locked", true}}, json::object()});
  ASSERT_EQ(put(job, document).status, 200);
  const Reply saved = client->post(at(job, "/save"), R"({"name": "two dips"})");
  ASSERT_EQ(saved.status, 200) << saved.body;

  // Read by the command line's way, written again: the same text.
  const std::filesystem::path file = folder.path() / "jobs" / job / "files" / "two dips.toml";
  JobConfig config;
  SettingSources sources;
  sources.configs = {file};
  apply_sources(config, sources);
  const auto bytes = read_file(file);
  EXPECT_EQ(job_file(config, file.parent_path()), std::string(bytes.begin(), bytes.end()));
  EXPECT_EQ(config.object.pose.rotate_deg.x(), 12.3456789012345);
  EXPECT_EQ(config.object.artwork.front().text, "Hi \"you\"");
  ASSERT_EQ(config.dips.size(), 2u);
  EXPECT_EQ(config.dips[0].rotate_deg->y(), 33.333333333);

  // Opened elsewhere, by somebody else: the same document, but for its name.
  EXPECT_EQ(client->get(at(job, "/job.zip")).status, 200);
  std::filesystem::copy(file.parent_path(), folder / "elsewhere");
  studio->api().open_file(folder / "elsewhere/two dips.toml");
  const std::string again = client->get("/api/hello").json()["opened"];
  json reopened = describe(again)["document"];
  document.erase("name");
  EXPECT_EQ(reopened, document);
}

TEST_F(JobTest, WrongValuesAreRefusedWithTheirName) {
  const std::string job = sample("pyramid");
  const json before = describe(job)["document"];
  const std::vector<std::pair<json, std::string>> cases = {
      {{{"object", {{"size_mm", -3}}}}, "object.size_mm"},
      {{{"object", {{"size_mn", 3}}}}, "object.size_mn"},
      {{{"film", {{"shape", "star"}}}}, "film.shape"},
      {{{"artwork", json::array({{{"image", "nothing.png"}}})}}, "artwork[1].image"},
      {{{"dips", json::array({{{"depth_mm", "deep"}}})}}, "dip[1].depth_mm"},
      {{{"path", json::array({{0, 0}})}}, "path"}};
  for (const auto& [document, field] : cases) {
    const Reply reply = put(job, document);
    EXPECT_EQ(reply.status, 422) << reply.body;
    EXPECT_EQ(reply.json()["error"].value("field", ""), field);
  }
  EXPECT_EQ(describe(job)["document"], before);
}

TEST_F(JobTest, TheSecondTabIsToldAndMayTakeOver) {
  const std::string job = sample("pyramid");
  const json document = quick(describe(job)["document"]);
  Events first(*client, at(job, "/events?client=one"));
  ASSERT_TRUE(first.next("hello")->data["pen"]);
  Events second(*client, at(job, "/events?client=two"));
  EXPECT_FALSE(second.next("hello")->data["pen"]);
  EXPECT_EQ(put(job, document, false, "two").code(), "no-pen");
  const long revision = put(job, document, false, "one").json()["revision"];
  EXPECT_EQ(second.next("document")->data["revision"], revision);
  EXPECT_EQ(client->post(at(job, "/pen"), R"({"client": "two"})").status, 200);
  EXPECT_FALSE(first.next("pen")->data["mine"]);
  EXPECT_TRUE(second.next("pen")->data["mine"]);
  EXPECT_EQ(put(job, document, false, "two").status, 200);
  EXPECT_EQ(put(job, document, false, "one").code(), "no-pen");
}

TEST_F(JobTest, WhoseTabIsGoneLeavesItToTheOther) {
  const std::string job = client->post("/api/jobs").json()["job"];
  auto first = std::make_unique<Events>(*client, at(job, "/events?client=one"));
  ASSERT_TRUE(first->next("problem"));  // there is no model, and no news after that
  Events second(*client, at(job, "/events?client=two"));
  ASSERT_TRUE(second.next("problem"));
  first.reset();
  const auto pen = second.next("pen");
  ASSERT_TRUE(pen);
  EXPECT_TRUE(pen->data["mine"]);
}

TEST_F(JobTest, AnOldBaseIsRefusedWithTheNewest) {
  const std::string job = sample("pyramid");
  const json document = describe(job)["document"];
  const long base = describe(job)["revision"];
  const long newest = put(job, document, true, "c1", base).json()["revision"];
  const Reply stale = put(job, document, true, "c1", base);
  EXPECT_EQ(stale.code(), "stale");
  EXPECT_EQ(stale.json()["revision"], newest);
  EXPECT_EQ(stale.json()["document"], document);
}

// Nothing is said to the run before: it might have been killed.
TEST_F(JobTest, AnotherRunGoesOnWhereTheLastStood) {
  const std::string job = sample("pyramid");
  json document = quick(describe(job)["document"]);
  document["name"] = "kept";
  document["page"] = {{"camera", {1, 2, 3}}};
  const long revision = put(job, document).json()["revision"];
  const TemporaryFolder as_it_stood;
  std::filesystem::copy(folder.path(), as_it_stood.path(),
                        std::filesystem::copy_options::recursive);
  const Served second(as_it_stood.path(), "another");
  const Client again = second.client();
  const json found = again.get(at(job)).json();
  EXPECT_EQ(found["document"], document);
  EXPECT_EQ(found["revision"], revision);
  const json recent = again.get("/api/recent").json();
  ASSERT_EQ(recent.size(), 1u);
  EXPECT_EQ(recent[0]["name"], "kept");
  EXPECT_TRUE(recent[0]["unsaved"]);
  Events events(again, at(job, "/events?client=c1"));
  EXPECT_EQ(events.next("hello")->data["run"], "another");
  EXPECT_TRUE(events.next("result"));
}

json finished(Events& events, const std::string& kind) {
  const auto event = events.next(
      "task", [&](const json& t) { return t["kind"] == kind && t["state"] != "running"; }, 300);
  return event ? event->data : json();
}

TEST_F(JobTest, ThePrintHasTheBytesOfTheCommandLine) {
  const std::string job = sample("pyramid");
  json document = quick(describe(job)["document"]);
  document["artwork"] =
      json::array({{{"text", "A"}, {"size_mm", 12}, {"at_mm", {3, 2, 5}}, {"toward", {0, 0, 1}}}});
  put(job, document);
  Events events(*client, at(job, "/events?client=c1"));
  ASSERT_EQ(client->post(at(job, "/tasks"), R"({"kind": "print"})").status, 202);
  EXPECT_EQ(client->post(at(job, "/tasks"), R"({"kind": "print"})").code(), "busy");
  const json task = finished(events, "print");
  ASSERT_EQ(task["state"], "done") << task;
  std::map<std::string, std::string> urls;
  for (const json& file : task["result"]["files"]) urls[file["file"]] = file["url"];
  ASSERT_TRUE(urls.contains("run-sheet.pdf"));

  client->post(at(job, "/save"), R"({"name": "job"})");
  JobConfig config;
  SettingSources sources;
  sources.configs = {folder.path() / "jobs" / job / "files/job.toml"};
  apply_sources(config, sources);
  config.output = folder / "by-command";
  print_job(config, RunContext());
  for (const char* name : {"print.png", "print.tif", "print.pdf", "film.ply"}) {
    const auto bytes = read_file(folder.path() / "by-command" / name);
    const std::string served = client->get(urls[name]).body;
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), served.begin(), served.end(),
                           [](std::uint8_t a, char b) { return char(a) == b; }))
        << name;
  }
}

TEST_F(JobTest, ATaskIsCancelledAndLeavesNothing) {
  const std::string job = sample("pyramid");
  json document = describe(job)["document"];
  document["film"]["elements"] = 640000;
  document["dip"]["step_mm"] = 0.02;
  put(job, document, true);
  Events events(*client, at(job, "/events?client=c1"));
  const std::string task = client->post(at(job, "/tasks"), R"({"kind": "print"})").json()["task"];
  ASSERT_TRUE(events.next("task", [](const json& t) { return t["fraction"] > 0; }));
  EXPECT_EQ(client->remove(at(job, "/tasks/" + task)).status, 200);
  EXPECT_EQ(finished(events, "print")["state"], "cancelled");
  std::error_code none;
  EXPECT_FALSE(
      std::filesystem::exists(folder.path() / "jobs" / job / "print/pyramid/print.png", none));
}

// Each way that is offered can be taken, and does what it says.
TEST_F(JobTest, AWayThatIsFoundCanBeTaken) {
  const std::string job = sample("box");
  const json document = quick(describe(job)["document"]);
  put(job, document, true);
  Events events(*client, at(job, "/events?client=c1"));
  client->post(at(job, "/tasks"), R"({"kind": "orient"})");
  const json task = finished(events, "orient");
  ASSERT_EQ(task["state"], "done") << task;
  const json ways = task["result"]["ways"];
  ASSERT_FALSE(ways.empty());
  // One picture of the object, not a page of them with words.
  const std::string picture = client->get(ways[0]["picture"]).body;
  ASSERT_TRUE(picture.starts_with("\x89PNG"));
  const auto size_at = [&](std::size_t at) {
    return 256 * int(std::uint8_t(picture.at(at + 2))) + int(std::uint8_t(picture.at(at + 3)));
  };
  EXPECT_NEAR(double(size_at(16)) / size_at(20), 1.5, 0.02);
  json taken = document;
  taken.merge_patch(ways[0]["patch"]);
  const long revision = put(job, taken).json()["revision"];
  const auto told = events.next("result", [&](const json& e) { return e["revision"] == revision; });
  ASSERT_TRUE(told);
  const ReadBundle result(
      client->get(at(job, "/results/" + told->data["result"].get<std::string>())).body);
  EXPECT_NEAR(result.head["figures"]["covered_share"], ways[0]["covered_share"], 0.08);
}

// A correction of which no more is read than that it is one.
constexpr const char* kNoMove = R"({"schema_version": 1, "samples": [],
  "grid": {"first_mm": [-80, -80], "pitch_mm": 160, "nx": 2, "ny": 2, "move_mm": [[0,0],[0,0],[0,0],[0,0]]},
  "of": {"model": {"path": "", "sha256": "", "shape_sha256": ""},
    "to_posed": [[1,0,0],[0,1,0],[0,0,1]], "size_mm": [60,60,24], "depth_mm": 10,
    "film": {"width_mm": 150, "height_mm": 150, "margin_mm": 10, "swelling_x": 1, "swelling_y": 1},
    "material": {"z_stretch": 1, "poisson": 0.5, "ink_stiffness_ratio": 1}}})";

// Also of a dip of which no turn is said, for it hangs as the object does.
TEST_F(JobTest, APlanKeepsTheLockAndTheCorrectionOfWhatItKeeps) {
  const std::string job = sample("pyramid");
  std::ofstream(folder.path() / "jobs" / job / "files/c.json") << kNoMove;
  json document = quick(describe(job)["document"]);
  document["object"]["rotate_deg"] = {0, 0, 15};
  document["dips"] = {{{"locked", true}, {"depth_mm", 10}, {"correction", "c.json"}},
                      {{"rotate_deg", {90, 0, 0}}}};
  ASSERT_EQ(put(job, document, true).status, 200);
  Events events(*client, at(job, "/events?client=c1"));
  client->post(at(job, "/tasks"), R"({"kind": "plan", "dips": 2})");
  const json task = finished(events, "plan");
  ASSERT_EQ(task["state"], "done") << task;
  const json dips = task["result"]["patch"]["dips"];
  ASSERT_EQ(dips.size(), 2u);
  EXPECT_EQ(dips[0]["rotate_deg"], json({0, 0, 15}));
  EXPECT_EQ(dips[0].value("locked", false), true);
  EXPECT_EQ(dips[0].value("correction", ""), "c.json");
  EXPECT_FALSE(dips[1].contains("locked"));
  EXPECT_FALSE(dips[1].contains("correction"));
  document["dips"] = dips;
  EXPECT_EQ(put(job, document).status, 200);
}

TEST_F(JobTest, APlanOfFilmThatTearsSaysThatItsPrintWillAdviseAgainstIt) {
  const std::string job = sample("box");
  json document = quick(describe(job)["document"]);
  document["object"]["size_mm"] = 40;
  document["material"]["tear_stretch"] = 1.3;
  document["dips"] = {{{"rotate_deg", {35, 10, 0}}, {"depth_mm", 25}, {"locked", true}},
                      {{"rotate_deg", {-140, 20, 0}}, {"depth_mm", 25}, {"locked", true}}};
  ASSERT_EQ(put(job, document, true).status, 200);
  Events events(*client, at(job, "/events?client=c1"));
  client->post(at(job, "/tasks"), R"({"kind": "plan", "dips": 2})");
  const json task = finished(events, "plan");
  ASSERT_EQ(task["state"], "done") << task;
  const std::string told = task["result"]["warnings"].dump();
  EXPECT_NE(told.find("advise against them"), std::string::npos) << told;
  EXPECT_EQ(told.find("--"), std::string::npos) << told;
}

// A model and a picture dropped together: the picture is on it.
TEST_F(JobTest, AModelAndAPictureBecomeAJob) {
  const std::string job = client->post("/api/jobs").json()["job"];
  const std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg' width='20' height='10'>"
      "<rect width='20' height='10' fill='red'/></svg>";
  ASSERT_EQ(client->put(at(job, "/files/part.stl"), kTetrahedron).status, 201);
  ASSERT_EQ(client->put(at(job, "/files/logo.svg"), svg).status, 201);
  const Reply adopted = client->post(at(job, "/adopt"), R"({"files": ["logo.svg", "part.stl"]})");
  ASSERT_EQ(adopted.status, 200) << adopted.body;
  const json document = adopted.json()["document"];
  EXPECT_EQ(document["object"]["file"], "part.stl");
  EXPECT_EQ(document["artwork"][0]["image"], "logo.svg");
  Events events(*client, at(job, "/events?client=c1"));
  const auto told = events.next("result");
  ASSERT_TRUE(told);
  const ReadBundle result(
      client->get(at(job, "/results/" + told->data["result"].get<std::string>())).body);
  const auto printed = result.array<std::uint8_t>("sheet.printed");
  bool red = false;
  for (std::size_t i = 0; i < printed.size(); i += 4)
    red = red || (printed[i + 3] > 200 && printed[i] > 150 && printed[i + 1] < 90);
  EXPECT_TRUE(red);
  EXPECT_EQ(client->put(at(job, "/files/part.stl"), kTetrahedron).json()["file"], "part-2.stl");
}

// A logo that is twice as wide as high. On a flat face it has the size that was said; wrapped
// around a sphere, circles around its middle are shorter there than on paper, and no way is longer.
TEST_F(JobTest, HowArtworkWasLaidIsTold) {
  const std::string job = sample("sphere");
  const std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg' width='20' height='10'>"
      "<rect width='20' height='10' fill='red'/></svg>";
  ASSERT_EQ(client->put(at(job, "/files/logo.svg"), svg).status, 201);
  json document = quick(describe(job)["document"]);
  document["artwork"] = {{{"image", "logo.svg"}, {"size_mm", 12}},
                         {{"image", "logo.svg"}, {"projection", "wrap"}, {"size_mm", 20}}};
  const long revision = put(job, document).json()["revision"];
  Events events(*client, at(job, "/events?client=c1"));
  const auto told = events.next("result", [&](const json& e) { return e["revision"] == revision; });
  ASSERT_TRUE(told);
  const ReadBundle result(
      client->get(at(job, "/results/" + told->data["result"].get<std::string>())).body);
  const json laid = result.head["artwork"];
  ASSERT_EQ(laid.size(), 2U) << laid;
  EXPECT_EQ(laid[0]["size_mm"], json({12, 6}));
  EXPECT_EQ(laid[0]["stretch"], json({1, 1}));
  EXPECT_EQ(laid[1]["size_mm"], json({20, 10}));
  EXPECT_LT(laid[1]["stretch"][0], 0.995);
  EXPECT_NEAR(laid[1]["stretch"][1], 1, 0.02);
}

// Before the print says it, in the same words but for options.
TEST_F(JobTest, ArtworkThatGetsNoFilmIsNamed) {
  const std::string job = sample("box");
  const std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg' width='10' height='10'>"
      "<rect width='10' height='10' fill='red'/></svg>";
  ASSERT_EQ(client->put(at(job, "/files/logo.svg"), svg).status, 201);
  json document = quick(describe(job)["document"]);
  const json up = {{"image", "logo.svg"}, {"size_mm", 10}, {"toward", {0, 0, -1}}};
  const json down = {{"image", "logo.svg"}, {"size_mm", 10}, {"toward", {0, 0, 1}}};
  document["artwork"] = {down, up};
  document["dip"]["depth_mm"] = 4;
  document["dip"]["step_mm"] = 2;
  document["film"]["elements"] = 800;
  document["ink"]["rounds_max"] = 1;
  Events events(*client, at(job, "/events?client=c1"));
  const std::string told_as = "logo.svg: this artwork gets no film that holds; turn it down, ";
  const auto told = [&](const json& findings) {
    return std::count_if(findings.begin(), findings.end(), [&](const json& finding) {
      return finding["text"].get<std::string>().starts_with(told_as) &&
             finding["concern"] == "care";
    });
  };
  const auto head_of = [&](const std::string& event, const std::string& where, long revision) {
    const auto found = events.next(event, [&](const json& e) { return e["revision"] == revision; });
    if (!found || !found->data.contains(event)) return json();
    return ReadBundle(client->get(at(job, where + found->data[event].get<std::string>())).body)
        .head;
  };
  const json one = head_of("result", "/results/", put(job, document).json()["revision"]);
  ASSERT_TRUE(one.is_object());
  EXPECT_EQ(one["dry_layers"], json({1}));
  EXPECT_EQ(told(one["findings"]), 1) << one["findings"];
  // Of several dips another one may bring it: only what none brings is told of.
  const json below = {{"down", "-z"}, {"rotate_deg", {0, 0, 0}}, {"depth_mm", 4}};
  json above = below;
  above["down"] = "+z";
  document["dips"] = {below, above};
  const json both = head_of("finish", "/finish/", put(job, document).json()["revision"]);
  ASSERT_TRUE(both.is_object());
  EXPECT_EQ(both["dry_layers"], json::array());
  EXPECT_EQ(told(both["findings"]), 0) << both["findings"];
  document["dips"] = {below, below};
  const json same = head_of("finish", "/finish/", put(job, document).json()["revision"]);
  ASSERT_TRUE(same.is_object());
  EXPECT_EQ(same["dry_layers"], json({1}));
  EXPECT_EQ(told(same["findings"]), 1) << same["findings"];
}

// Its own picture is named like the model or like a texture, in whatever letters.
TEST_F(JobTest, APictureThatIsNamedLikeTheModelIsItsTexture) {
  const std::string job = client->post("/api/jobs").json()["job"];
  const std::string toy =
      "v 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\nvt 0 0\nvt 1 0\nvt 0 1\n"
      "f 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 2/1 3/2 4/3\nf 1/1 4/3 3/2\n";
  const std::vector<std::uint8_t> png = encode_png(Image(4, 4));
  ASSERT_EQ(client->put(at(job, "/files/MyToy.obj"), toy).status, 201);
  ASSERT_EQ(client->put(at(job, "/files/myTOY-1.png"), {png.begin(), png.end()}).status, 201);
  const Reply adopted =
      client->post(at(job, "/adopt"), R"({"files": ["MyToy.obj", "myTOY-1.png"]})");
  ASSERT_EQ(adopted.status, 200) << adopted.body;
  const json document = adopted.json()["document"];
  EXPECT_EQ(document["object"]["texture"], "myTOY-1.png") << document;
  EXPECT_FALSE(document.contains("artwork"));
}

// A large model takes a while to read; the job is anybody's meanwhile.
TEST_F(JobTest, WhatIsSaidWhileAModelIsReadStays) {
  constexpr int kSide = 300;
  std::string large;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      large += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
  for (int y = 1; y < kSide; ++y)
    for (int x = 1; x < kSide; ++x) {
      const int corner = y * kSide + x;
      large += "f " + std::to_string(corner - kSide) + " " + std::to_string(corner - kSide + 1) +
               " " + std::to_string(corner + 1) + " " + std::to_string(corner) + "\n";
    }
  const std::string job = client->post("/api/jobs").json()["job"];
  ASSERT_EQ(client->put(at(job, "/files/large.obj"), large).status, 201);
  ASSERT_EQ(client->put(at(job, "/files/toy.mtl"), kRed).status, 201);
  std::atomic<bool> done = false;
  std::thread other([&, own = studio->client()] {
    EXPECT_EQ(own.post(at(job, "/adopt"), R"({"files": ["large.obj", "toy.mtl"]})").status, 200);
    done = true;
  });
  int said = 0;
  const auto kept = [&](const json& document) { return document.value("/page/n"_json_pointer, 0); };
  while (!done) {
    const json now = describe(job);
    EXPECT_EQ(kept(now["document"]), said);
    json document = now["document"];
    document["page"]["n"] = said + 1;
    if (put(job, document, true, "c1", now["revision"]).status == 200) ++said;
  }
  other.join();
  const json document = describe(job)["document"];
  EXPECT_EQ(kept(document), said);
  EXPECT_EQ(document["object"]["file"], "large.obj");
}

// Reading a large one takes longer than all else.
TEST_F(JobTest, ADroppedModelIsReadOnce) {
  const auto opened_by = [](const std::filesystem::path& file, const auto& work) {
    const int watch = inotify_init1(IN_NONBLOCK);
    EXPECT_GE(inotify_add_watch(watch, file.c_str(), IN_OPEN), 0);
    work();
    alignas(inotify_event) std::array<char, 65536> events;
    const ssize_t bytes = ::read(watch, events.data(), events.size());
    close(watch);
    return bytes / ssize_t(sizeof(inotify_event));
  };
  Workspace workspace;
  Project project;
  project.model = folder / "toy.obj";
  write_file(project.model, kRedToy);
  const auto once = opened_by(project.model, [&] { workspace.model(project, RunContext()); });
  ASSERT_GE(once, 1);

  const std::string job = client->post("/api/jobs").json()["job"];
  ASSERT_EQ(client->put(at(job, "/files/toy.obj"), kRedToy).status, 201);
  ASSERT_EQ(client->put(at(job, "/files/toy.mtl"), kRed).status, 201);
  Events events(*client, at(job, "/events?client=c1"));
  const auto times = opened_by(folder / ("jobs/" + job + "/files/toy.obj"), [&] {
    client->post(at(job, "/adopt"), R"({"client": "c1", "files": ["toy.obj", "toy.mtl"]})");
    EXPECT_TRUE(events.next("mesh", [](const json& e) { return e["mesh"].is_string(); }));
    EXPECT_TRUE(events.next("result", [](const json&) { return true; }));
  });
  EXPECT_EQ(times, once);
}

TEST_F(JobTest, AJobThatCannotBeBegunLeavesNothing) {
  sample("box");
  const auto jobs = [&] {
    return std::distance(std::filesystem::directory_iterator(folder.path() / "jobs"), {});
  };
  const auto before = jobs();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path() / "samples"))
    if (entry.path().filename() == "box.obj") std::filesystem::remove(entry.path());
  EXPECT_GE(client->post("/api/jobs", R"({"sample": "box"})").status, 400);
  EXPECT_GE(client->post("/api/jobs", R"({"sample": "no such"})").status, 400);
  EXPECT_EQ(jobs(), before);
}

// Whoever chose "part.stl" knows it by that name, and not by where this program keeps it.
TEST_F(JobTest, ABadFileIsCalledByItsNameAlone) {
  const std::string job = client->post("/api/jobs").json()["job"];
  ASSERT_EQ(client->put(at(job, "/files/part.stl"), "no model").status, 201);
  const Reply refused = client->post(at(job, "/adopt"), R"({"files": ["part.stl"]})");
  ASSERT_EQ(refused.status, 422) << refused.body;
  const std::string text = refused.json()["error"]["text"];
  EXPECT_TRUE(text.starts_with("part.stl: ")) << text;
  EXPECT_EQ(text.find(folder.path().string()), std::string::npos) << text;
}

// What is no model or picture takes no good one's place, nor its name.
TEST_F(JobTest, ABrokenFileLeavesTheJobAsItWas) {
  const std::string job = client->post("/api/jobs").json()["job"];
  ASSERT_EQ(client->put(at(job, "/files/part.stl"), kTetrahedron).status, 201);
  ASSERT_EQ(client->post(at(job, "/adopt"), R"({"files": ["part.stl"]})").status, 200);
  const auto is_now = [&] {
    const json now = describe(job);
    return json{now["document"], now["revision"], now["files"]};
  };
  const json before = is_now();
  for (const std::string name : {"notes.stl", "broken.png", "broken.svg"}) {
    ASSERT_EQ(client->put(at(job, "/files/" + name), "Notes.").json()["file"], name);
    const Reply refused = client->post(at(job, "/adopt"), json{{"files", {name}}}.dump());
    EXPECT_EQ(refused.status, 422) << refused.body;
    EXPECT_EQ(refused.json()["error"]["code"], "bad-file");
    EXPECT_EQ(is_now(), before) << name;
  }
  // Nor does a known file go if somebody asks for it again.
  std::ofstream(folder.path() / "jobs" / job / "files/part.stl") << "Notes.";
  client->post(at(job, "/adopt"), R"({"files": ["part.stl"]})");
  EXPECT_EQ(client->get(at(job, "/files/part.stl")).status, 200);
}

// It looks well dip by dip: that it cannot be printed has to be said before the print says so.
TEST_F(JobTest, PatternFilmOfSeveralDipsIsSpokenOfBeforeThePrint) {
  const std::string job = sample("pyramid");
  json document = quick(describe(job)["document"]);
  document["artwork"] = json::array({{{"text", "A"}, {"size_mm", 40}, {"projection", "film"}}});
  Events events(*client, at(job, "/events?client=c1"));
  const auto stops = [&](const json& changed) {
    const long revision = put(job, changed).json()["revision"];
    const auto told =
        events.next("result", [&](const json& e) { return e["revision"] == revision; });
    if (!told) return -1;
    const ReadBundle result(
        client->get(at(job, "/results/" + told->data["result"].get<std::string>())).body);
    int found = 0;
    for (const json& finding : result.head["findings"])
      if (finding["key"] == "pattern-dips") found += finding["concern"] == "stop" ? 1 : 100;
    return found;
  };
  EXPECT_EQ(stops(document), 0);
  const json dip = {{"down", "-z"}, {"rotate_deg", {0, 0, 0}}, {"depth_mm", 0}};
  document["dips"] = {dip, dip};
  EXPECT_EQ(stops(document), 1);
}

// The studio has no room for the machine's own settings, and must not lose them: one of them is how
// deep a stage may go.
TEST_F(JobTest, WhatAJobFileSaysOfTheMachineStaysInIt) {
  const auto file = folder / "dips/job.toml";
  std::filesystem::create_directories(file.parent_path());
  write_file(folder / "dips/part.stl", kTetrahedron);
  write_file(file,
             "object.file = \"part.stl\"\nstage.lowest_mm = 120\nstage.port = \"COM3\"\n"
             "run.threads = 1\n");
  studio->api().open_file(file);
  const std::string job = client->get("/api/hello").json()["opened"];
  begin();  // it outlives the run
  ASSERT_EQ(put(job, quick(describe(job)["document"])).status, 200);
  ASSERT_EQ(client->post(at(job, "/save")).status, 200);
  SettingSources sources;
  sources.configs = {file};
  JobConfig config;
  apply_sources(config, sources);
  EXPECT_EQ(config.stage.lowest_mm, 120);
  EXPECT_EQ(config.stage.port, "COM3");
  EXPECT_EQ(config.threads, 1);
  EXPECT_EQ(config.design.film.elements, 2000);
}

TEST_F(JobTest, ItsModelsNameOpensASavedJobAsItsFileIs) {
  const auto model = folder / "part.stl", file = folder / "part.toml";
  write_file(model, kTetrahedron);
  const auto opened = [&] {
    studio->api().open_file(model);
    return client->get("/api/hello").json()["opened"].get<std::string>();
  };
  const std::string job = opened();
  json document = describe(job)["document"];
  document["object"]["size_mm"] = 33;
  document["artwork"] = json::array({{{"text", "A"}, {"size_mm", 12}}});
  put(job, document);
  ASSERT_EQ(client->post(at(job, "/save")).status, 200);
  begin();
  EXPECT_EQ(opened(), job);
  EXPECT_EQ(describe(job)["document"], document);
  // Edited by hand meanwhile.
  const auto bytes = read_file(file);
  std::string text(bytes.begin(), bytes.end());
  text.replace(text.find("33"), 2, "44");
  write_file(file, text);
  begin();
  EXPECT_EQ(opened(), job);
  EXPECT_EQ(describe(job)["document"]["object"]["size_mm"], 44);
}

TEST_F(JobTest, LookingAtAnotherDipChangesNothing) {
  const std::string job = sample("pyramid");
  json document = quick(describe(job)["document"]);
  const json dip = {{"down", "-z"}, {"rotate_deg", {0, 0, 0}}, {"depth_mm", 10}};
  document["dips"] = {dip, dip};
  put(job, document);
  client->post(at(job, "/save"));
  const auto unsaved = [&] { return client->get("/api/recent").json()[0]["unsaved"]; };
  ASSERT_EQ(unsaved(), false);
  const json look = {{"client", "c1"}, {"document", document}, {"live", false}, {"dip", 1}};
  ASSERT_EQ(client->put(at(job, "/document"), look.dump()).status, 200);
  EXPECT_EQ(unsaved(), false);
  document["object"]["size_mm"] = 20;
  put(job, document);
  EXPECT_EQ(unsaved(), true);
}

// A browser keeps what an ID has named.
TEST_F(JobTest, NoTwoJobsOfARunGiveTheSameID) {
  std::set<std::string> seen;
  for (const char* name : {"pyramid", "box"}) {
    const std::string job = sample(name);
    Events events(*client, at(job, "/events?client=c1"));
    put(job, quick(describe(job)["document"]));
    const auto told = events.next("result");
    ASSERT_TRUE(told);
    EXPECT_TRUE(seen.insert(told->data["result"]).second);
  }
}

TEST_F(JobTest, TheListOfRecentJobsOpensNone) {
  const std::string job = sample("pyramid");
  put(job, quick(describe(job)["document"]));
  const std::string png = "\x89PNG...";
  ASSERT_EQ(client->put(at(job, "/thumbnail"), png).status, 200);
  begin();
  EXPECT_EQ(client->get(at(job, "/thumbnail")).body, png);
  EXPECT_EQ(client->get(at(job, "/counts")).json()["sketches"], 0);
  EXPECT_EQ(client->remove("/api/recent/" + job).status, 200);
  EXPECT_EQ(client->get("/api/recent").json().size(), 0U);
  // One that a tab has open stays.
  const std::string other = sample("box");
  const Events tab(*client, at(other, "/events?client=c1"));
  EXPECT_EQ(client->remove("/api/recent/" + other).code(), "busy");
}

// A job is open in one studio at a time: what the other writes would be lost.
TEST_F(JobTest, AnotherStudioHasTheJobMeanwhile) {
  const std::string job = sample("pyramid");
  auto tab = std::make_unique<Events>(*client, at(job, "/events?client=c1"));
  Served beside(folder.path(), "beside");
  const Client other = beside.client();
  EXPECT_EQ(other.get(at(job)).code(), "busy");
  EXPECT_EQ(other.remove("/api/recent/" + job).code(), "busy");
  EXPECT_EQ(put(job, quick(describe(job)["document"])).status, 200);
  tab.reset();
  const std::string is = describe(job)["document"].dump();
  studio.reset();
  EXPECT_EQ(other.get(at(job)).json()["document"].dump(), is);
}

// What a person made of a job's state hides that one and no other.
TEST_F(JobTest, AStateOfTheWrongKindIsNobodysJob) {
  const std::string good = sample("pyramid");
  const std::string bad = sample("box");
  studio.reset();
  const std::filesystem::path file = folder / "jobs" / bad / "state.json";
  const std::string whole(reinterpret_cast<const char*>(read_file(file).data()),
                          read_file(file).size());
  for (const json& wrong :
       {json{{"name", 5}}, json{{"open", 3}}, json{{"where", nullptr}}, json{{"revision", "x"}},
        json{{"granted", {{"a", 1}}}}, json{{"document", json::array()}}, json{{"machine", 7}}}) {
    json state = json::parse(whole);
    state.update(wrong);
    write_file(file, state.dump());
    begin();
    const Reply hello = client->get("/api/hello");
    ASSERT_EQ(hello.status, 200) << wrong << hello.body;
    ASSERT_EQ(hello.json()["recent"].size(), 1U) << wrong;
    EXPECT_EQ(hello.json()["recent"][0]["job"], good);
    EXPECT_EQ(client->get(at(bad)).status, 200) << wrong;
    studio.reset();
  }
}

// Packing is for long ways: it takes longer than all of the way to a browser beside the studio.
TEST_F(JobTest, NothingIsPackedOnItsWay) {
  const std::string job = sample("pyramid");
  std::map<std::string, std::string> eager = client->own_headers();
  eager["Accept-Encoding"] = "gzip, deflate, br";
  for (const std::string& path : {std::string("/"), std::string("/app.js"),
                                  std::string("/styles.css"), std::string("/api/hello"), at(job)}) {
    const Reply reply = client->send("GET", path, "", eager);
    EXPECT_EQ(reply.status, 200) << path;
    EXPECT_FALSE(reply.headers.contains("content-encoding")) << path;
    EXPECT_EQ(reply.headers.at("content-length"), std::to_string(reply.body.size())) << path;
    EXPECT_TRUE(reply.body == client->get(path).body) << path;
  }
}

TEST_F(JobTest, EverybodyGetsTheWholeArchive) {
  const std::string job = sample("pyramid");
  std::atomic<int> whole = 0;
  std::vector<std::thread> people;
  for (int n = 0; n < 4; ++n)
    people.emplace_back([&] {
      for (int times = 0; times < 10; ++times) {
        const Reply reply = client->get(at(job, "/job.zip"));
        // An archive ends with a record of 22 bytes.
        whole += reply.status == 200 && reply.body.size() > 22 &&
                 reply.body.compare(reply.body.size() - 22, 4, "PK\x05\x06") == 0;
      }
    });
  for (std::thread& person : people) person.join();
  EXPECT_EQ(whole, 40);
}

// "é" has two bytes, of which a limit may not keep one alone.
TEST_F(JobTest, ALongNameIsCutBetweenCharacters) {
  const std::string job = sample("pyramid");
  std::string name = "a";
  for (int n = 0; n < 300; ++n) name += "\u00e9";
  ASSERT_EQ(client->post(at(job, "/save"), json{{"name", name}}.dump()).status, 200);
  const json now = describe(job);
  const std::string kept = now["document"]["name"];
  EXPECT_EQ(kept, name.substr(0, 199));
  EXPECT_EQ(put(job, now["document"]).status, 200);
  EXPECT_TRUE(name.starts_with(
      std::filesystem::path(now["where"].get<std::string>()).stem().string().substr(0, 119)));
  EXPECT_EQ(client->get(at(job, "/job.zip")).status, 200);
}

// Ended while it reads what never ends.
TEST_F(JobTest, AnUploadWithoutEndDoesNotKeepTheStudio) {
  const std::string job = sample("pyramid");
  const std::filesystem::path home = folder / "jobs" / job;
  const auto parts = [&] {
    const std::filesystem::directory_iterator files(home);
    return std::count_if(std::filesystem::begin(files), std::filesystem::end(files),
                         [](const auto& file) { return file.path().extension() == ".part"; });
  };
  const EndlessUpload upload(*client, at(job, "/files/endless.stl"));
  while (parts() == 0) std::this_thread::yield();
  studio.reset();
  EXPECT_EQ(parts(), 0);
}

// Links that a person put into a job's folder lead nowhere.
TEST_F(JobTest, LinksOutOfAJobAreNotItsFiles) {
  const std::string job = sample("pyramid");
  const std::filesystem::path files = folder / "jobs" / job / "files";
  std::filesystem::create_directories(folder / "elsewhere");
  write_file(folder / "elsewhere/mine.png", "mine");
  std::filesystem::create_symlink(folder / "elsewhere/mine.png", files / "link.png");
  std::filesystem::create_symlink("loop.png", files / "loop.png");
  std::filesystem::create_directory_symlink(folder / "elsewhere", files / "out");
  const Reply all = client->get(at(job));
  ASSERT_EQ(all.status, 200) << all.body;
  for (const json& file : all.json()["files"]) EXPECT_NE(file["file"], "link.png");
  EXPECT_NE(client->put(at(job, "/files/out/new.png"), "new").status, 201);
  EXPECT_FALSE(std::filesystem::exists(folder / "elsewhere/new.png"));
}

// Whoever lets the studio forget a job still has what was saved elsewhere.
TEST_F(JobTest, WhatIsSavedElsewhereNeedsNothingOfTheStudio) {
  const auto file = folder / "dips/job.toml";
  std::filesystem::create_directories(file.parent_path());
  write_file(folder / "dips/part.stl", kTetrahedron);
  write_file(folder / "dips/toy.mtl", "newmtl other\n");
  write_file(file, "object.file = \"part.stl\"\n");
  studio->api().open_file(file);
  const std::string job = client->get("/api/hello").json()["opened"];
  client->put(at(job, "/files/toy.obj"), kRedToy);
  client->put(at(job, "/files/toy.mtl"), kRed);
  json document =
      client->post(at(job, "/adopt"), R"({"files": ["toy.obj", "toy.mtl"]})").json()["document"];
  client->put(at(job, "/files/shift.csv"), "0,0,0,0\n");
  document["dips"] = json::array({{{"down", "-z"}, {"correction", "shift.csv"}}});
  ASSERT_EQ(put(job, document).status, 200);
  ASSERT_EQ(client->post(at(job, "/save")).status, 200);
  const std::string packed = client->get(at(job, "/job.zip")).body;
  for (const char* name : {"toy.obj", "toy.mtl", "shift.csv"})
    EXPECT_NE(packed.find(name), std::string::npos) << name;
  ASSERT_EQ(client->remove("/api/recent/" + job).status, 200);
  SettingSources sources;
  sources.configs = {file};
  JobConfig config;
  apply_sources(config, sources);
  EXPECT_TRUE(std::filesystem::exists(config.dips.at(0).correction));
  const Model toy = load(config.model, {}, RunContext());
  EXPECT_EQ(toy.files.size(), 2U);
  const LinearColor red = toy.object->materials.at(0).base_color;
  EXPECT_GT(red.r, 0.9);
  EXPECT_LT(red.g, 0.1);
}

// Files of the same names, exported again, know each other and not those that were there before.
TEST_F(JobTest, AModelThatIsDroppedAgainHasItsOwnParts) {
  const std::string job = client->post("/api/jobs").json()["job"];
  const auto drop = [&](const std::string& mtl) {
    const json files = {client->put(at(job, "/files/toy.obj"), kRedToy).json()["file"],
                        client->put(at(job, "/files/toy.mtl"), mtl).json()["file"]};
    return client->post(at(job, "/adopt"), json{{"files", files}}.dump()).json();
  };
  EXPECT_EQ(drop("newmtl red\nKd 0 1 0\n")["document"]["object"]["file"], "toy.obj");
  const json again = drop(kRed);
  EXPECT_EQ(again["document"]["object"]["file"], "toy-2/toy.obj") << again;
  for (const json& file : again["adopted"]) EXPECT_NE(file["as"], "unused");
  const auto uploads = folder.path() / "jobs" / job / "files";
  const Model toy = load(uploads / "toy-2/toy.obj", {}, RunContext());
  EXPECT_GT(toy.object->materials.at(0).base_color.r, 0.9);
}

TEST_F(JobTest, AGoodJobIsGoodAgain) {
  const std::string job = sample("box");
  json document = quick(describe(job)["document"]);
  document["dip"]["depth_mm"] = 1;
  put(job, document);
  Events events(*client, at(job, "/events?client=c1"));
  json first;
  for (int time = 0; time < 2; ++time) {
    client->post(at(job, "/tasks"), R"({"kind": "print"})");
    const json task = finished(events, "print");
    ASSERT_EQ(task["state"], "done") << task;
    if (time == 0) first = task["result"]["verdict"];
    EXPECT_EQ(task["result"]["verdict"], first);
  }
  EXPECT_NE(first["headline"], "");
}

// The print would look for a way and show another one than the page does.
TEST_F(JobTest, AWayThatIsLeftOpenIsSaid) {
  const std::string job = sample("pyramid");
  json document = quick(describe(job)["document"]);
  document["object"]["rotate_deg"] = "auto";
  Events events(*client, at(job, "/events?client=c1"));
  const long revision = put(job, document).json()["revision"];
  const auto problem =
      events.next("problem", [&](const json& e) { return e["revision"] == revision; });
  ASSERT_TRUE(problem);
  ASSERT_EQ(problem->data["mends"].size(), 2U);
  document.merge_patch(problem->data["mends"][1]["patch"]);
  const long mended = put(job, document).json()["revision"];
  EXPECT_TRUE(events.next("result", [&](const json& e) { return e["revision"] == mended; }));
}

TEST_F(JobTest, QuittingIsForThePageAsWell) {
  EXPECT_EQ(client->post("/api/quit").status, 200);
  EXPECT_TRUE(studio->quits());
}

TEST_F(JobTest, DipsArePutTogetherWhenTheHandRests) {
  const std::string job = sample("pyramid");
  Events events(*client, at(job, "/events?client=c1"));
  json document = quick(describe(job)["document"]);
  const json dip = {{"down", "-z"}, {"rotate_deg", {0, 0, 0}}, {"depth_mm", 0}};
  document["dips"] = {dip, dip};
  const auto finish_of = [&](const json& changed) {
    const long revision = put(job, changed).json()["revision"];
    const auto told = events.next(
        "finish", [&](const json& e) { return e["revision"] >= revision; }, 120);
    return told ? told->data.value("finish", "") : "";
  };
  const std::string id = finish_of(document);
  ASSERT_FALSE(id.empty());
  const ReadBundle finish(client->get(at(job, "/finish/" + id)).body);
  const json& dips = finish.head["dips"];
  ASSERT_EQ(dips.size(), 2u);
  // The second reaches what the first does, and each point's ink is somebody's.
  const double covered = finish.head["covered_share"];
  EXPECT_GT(covered, 0.1);
  EXPECT_LT(dips[1]["gained_share"].get<double>(), 0.02);
  EXPECT_NEAR(dips[0]["part_share"].get<double>() + dips[1]["part_share"].get<double>(), covered,
              0.02);
  for (const char* mesh : {"mesh", "parts"})
    EXPECT_EQ(client->get(at(job, "/meshes/" + finish.head[mesh].get<std::string>())).status, 200);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_EQ(finish.array<std::uint8_t>("sheet." + std::to_string(k)).size(),
              4 * dips[k]["width_px"].get<std::size_t>() * dips[k]["height_px"].get<std::size_t>());
  // Another name is no other finish.
  document["name"] = "twice";
  EXPECT_EQ(finish_of(document), id);
  // Who comes later sees both dips.
  Events later(*client, at(job, "/events?client=c2"));
  std::set<int> seen;
  while (seen.size() < 2) {
    const auto result = later.next("result", {}, 5);
    ASSERT_TRUE(result);
    seen.insert(result->data["dip"].get<int>());
  }
}

TEST_F(JobTest, SettingsAreKeptAsAProfileOfThePersonsOwn) {
  const std::string job = sample("pyramid");
  json document = quick(describe(job)["document"]);
  document["film"]["margin_mm"] = 13;
  document["material"]["tear_stretch"] = 1.7;
  ASSERT_EQ(put(job, document).status, 200);
  EXPECT_EQ(client->get("/api/profiles").json()["profiles"], json::array());
  for (const char* name : {"..", "a%2Fb", "-%20x"})
    EXPECT_NE(client->put(at(job, "/profiles/") + name, "{}").status, 200) << name;
  // A browser sends a body after its head.
  ASSERT_EQ(
      client->send("PUT", at(job, "/profiles/our-film"), "{}", client->own_headers(), 30).status,
      200);
  EXPECT_EQ(client->get("/api/hello").json()["profiles"], json::array({"our-film"}));
  // The command line reads it, and another job takes it; what is the job's own is not in it.
  JobConfig config;
  SettingSources sources;
  sources.profiles = {folder / "profiles/our-film.toml"};
  apply_sources(config, sources);
  EXPECT_EQ(config.design.film.margin_mm, 13);
  EXPECT_TRUE(config.model.empty());
  const std::string other = sample("sphere");
  const json patch = client->get(at(other, "/profiles/our-film")).json()["patch"];
  EXPECT_EQ(patch["material"]["tear_stretch"], 1.7);
  EXPECT_EQ(patch["film"]["width_mm"], 150);
  json taken = describe(other)["document"];
  taken.merge_patch(patch);
  EXPECT_EQ(put(other, taken).status, 200);
  EXPECT_EQ(client->get(at(other, "/profiles/nobodys")).status, 404);
}

}  // namespace
}  // namespace hydrodip
