// How long a person waits in the studio: from the end of a drag to the new colours, and how often a
// drag is followed. Over HTTP, as a page asks for it.
#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <thread>

#include "base/file.h"
#include "base/math.h"
#include "studio/served.h"

namespace hydrodip {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Of all threads of this process, the page's side included.
double cpu_s() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

double share(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[std::size_t(q * double(values.size() - 1) + 0.5)];
}

// What changes in a drag: the document after its n-th move.
using Drag = std::function<void(json& document, int n)>;

struct Measured {
  double first_picture_s = 0;
  std::vector<double> cpu;     // in that time, of all cores: what a busy machine does not change
  std::vector<double> ends;    // from the end of a drag to its new colours, whole on this side
  std::vector<double> drafts;  // and to the draft
  std::vector<double> updates_per_s, gaps;  // between what is shown
  std::size_t bytes = 0;
};

constexpr int kDrags = 25, kDragsOfScan = 4, kMoves = 30;
constexpr auto kFrame = std::chrono::milliseconds(16);

class Page {
 public:
  Page(const Client& client, const std::string& job)
      : client_(client), at_("/api/jobs/" + job), events_(client, at_ + "/events?client=c1") {
    document = client_.get(at_).json()["document"];
  }

  long put(bool live) {
    const json body = {{"client", "c1"}, {"document", document}, {"live", live}};
    return client_.put(at_ + "/document", body.dump()).json()["revision"];
  }

  // The next result's revision, fetched whole; at most so long. 0: none came.
  long result(double seconds, long least, std::size_t& bytes) {
    const auto event = events_.next(
        "result", [&](const json& e) { return e["revision"] >= least; }, seconds);
    if (!event) return 0;
    bytes = client_.get(at_ + "/results/" + event->data["result"].get<std::string>()).body.size();
    return event->data["revision"];
  }

  // Until a normal result of that revision is being computed.
  void wait_for_normal(long revision) {
    events_.next("working", [&](const json& e) {
      return e["revision"] == revision && e["quality"] == "normal";
    });
  }
  long cancelled() const { return client_.get(at_ + "/counts").json()["cancelled"]; }

  json document;

 private:
  const Client client_;
  const std::string at_;
  Events events_;
};

void drag(Page& page, const Drag& move, int n, Measured& measured) {
  const auto begun = Clock::now();
  auto shown = begun;
  int updates = 0;
  long newest = 0;
  std::size_t bytes = 0;
  for (int step = 0; step < kMoves; ++step) {
    const auto frame = Clock::now();
    move(page.document, n * kMoves + step);
    page.put(true);
    // A page does this beside its moves; here what has come is taken between them.
    const double left = std::chrono::duration<double>(kFrame).count() - seconds_since(frame);
    if (const long revision = page.result(std::max(0.001, left), 0, bytes); revision > 0) {
      newest = revision;
      ++updates;
      measured.gaps.push_back(seconds_since(shown));
      shown = Clock::now();
    }
    std::this_thread::sleep_until(frame + kFrame);
  }
  measured.updates_per_s.push_back(updates / seconds_since(begun));
  const auto end = Clock::now();
  const double cpu_before = cpu_s();
  const long last = page.put(false);
  // The last move had the same document already.
  if (newest < last - 1) page.result(60, last - 1, measured.bytes);
  measured.ends.push_back(seconds_since(end));
  measured.cpu.push_back(cpu_s() - cpu_before);
  page.result(60, last, measured.bytes);
  measured.drafts.push_back(seconds_since(end));
}

using Begin = std::function<std::string()>;  // a new job's name

Measured measure(const Client& client, const Begin& begin, const json& changes, const Drag& move,
                 int drags = kDrags) {
  Measured measured;
  const auto begun = Clock::now();
  const std::string job = begin();
  Page page(client, job);
  page.document.merge_patch(changes);
  const long first = page.put(false);
  page.result(60, first, measured.bytes);
  measured.first_picture_s = seconds_since(begun);
  for (int n = 0; n < drags; ++n) drag(page, move, n, measured);
  return measured;
}

// How long a normal result goes on after something newer was asked for.
void show_cancelling(const std::string& what, const Client& client, const Begin& begin,
                     const json& changes, const Drag& move) {
  constexpr int kTimes = 20;
  constexpr auto kLater = std::chrono::milliseconds(37);
  Page page(client, begin());
  page.document.merge_patch(changes);
  std::vector<double> took;
  for (int n = 0; n < kTimes; ++n) {
    move(page.document, 2 * n);
    page.wait_for_normal(page.put(false));
    std::this_thread::sleep_for(n * kLater);
    const long before = page.cancelled();
    move(page.document, 2 * n + 1);
    const auto asked = Clock::now();
    page.put(false);
    while (page.cancelled() == before && seconds_since(asked) < 5) continue;
    took.push_back(seconds_since(asked));
  }
  fmt::print("{:<34} a newer request cancels a normal result in {:.3f} s (p50), {:.3f} s (most)\n",
             what, share(took, 0.5), share(took, 1));
  std::fflush(stdout);
}

void show(const std::string& what, const Measured& m) {
  fmt::print(
      "{:<34} {:6.2f} s {:7.3f} s {:7.3f} s {:7.3f} s {:7.3f} s {:7.1f} /s {:7.3f} s {:7.1f} MB\n",
      what, m.first_picture_s, share(m.ends, 0.5), share(m.ends, 0.95), share(m.cpu, 0.95),
      share(m.drafts, 0.95), share(m.updates_per_s, 0.5), share(m.gaps, 0.95),
      double(m.bytes) / 1e6);
  std::fflush(stdout);
}

// A lumpy ball as a scanner gives it: two million triangles, no colours.
std::string scan_stl() {
  constexpr int kRings = 1000, kAround = 1000;
  const auto at = [](int ring, int k) -> Vec3 {
    const double tilt = std::numbers::pi * ring / kRings;
    const double turn = 2 * std::numbers::pi * (k % kAround) / kAround;
    const Vec3 out(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                   std::cos(tilt));
    const double lumps = std::sin(9 * out.x()) * std::sin(8 * out.y()) * std::sin(7 * out.z());
    return (1 + 0.05 * lumps) * Vec3(40 * out.x(), 30 * out.y(), 20 * out.z());
  };
  std::string stl(80, ' ');
  const auto append = [&](const auto value) {
    stl.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(std::uint32_t(2 * kAround * (kRings - 1)));
  const auto triangle = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    for (int k = 0; k < 3; ++k) append(0.0F);  // readers work out the normal
    for (const Vec3* p : {&a, &b, &c})
      for (int k = 0; k < 3; ++k) append(float((*p)[k]));
    append(std::uint16_t(0));
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int k = 0; k < kAround; ++k) {
      const Vec3 a = at(ring, k), b = at(ring + 1, k), c = at(ring + 1, k + 1), d = at(ring, k + 1);
      if (ring + 1 < kRings) triangle(a, b, c);
      if (ring > 0) triangle(a, c, d);
    }
  return stl;
}

int run(const std::vector<std::string>& models) {
  const TemporaryFolder folder;
  Served studio(folder.path());
  const Client client = studio.client();
  fmt::print("{} drags of {} moves each, at 60 moves a second; 80 mm on A4\n", kDrags, kMoves);
  fmt::print(
      "first: from opening to the first picture; end: from a drag's end to its new colours\n");
  fmt::print("{:<34} {:>8} {:>9} {:>9} {:>9} {:>9} {:>10} {:>9} {:>10}\n", "", "first", "end p50",
             "end p95", "CPU p95", "draft p95", "updates", "gap p95", "a draft");
  const json size = {{"object", {{"size_mm", 80}}}};
  const Drag turn = [](json& document, int n) {
    document["object"]["rotate_deg"] = {0.1 * (n % 300), 0, 0.5 * n};
  };
  const Drag deeper = [](json& document, int n) {
    document["dip"]["depth_mm"] = 12 + 0.05 * (n % 200);
  };
  const Drag picture = [](json& document, int n) {
    document["artwork"] = json::array(
        {{{"text", "hydrodip"}, {"size_mm", 30}, {"turn_deg", n}, {"toward", {0, 0, 1}}}});
  };
  const auto show_all = [&](const std::string& name, const Begin& begin) {
    show(name + ", turned", measure(client, begin, size, turn));
    show(name + ", depth", measure(client, begin, size, deeper));
    show(name + ", text turned", measure(client, begin, size, picture));
  };
  // As the start page does while somebody reads it.
  studio.api().warm_up(RunContext());
  const Begin open_mask = [&]() -> std::string {
    return client.post("/api/jobs", R"({"sample": "mask"})").json()["job"];
  };
  show_all("mask", open_mask);
  show_cancelling("mask", client, open_mask, size, turn);
  // As dropped on the page: with everything that lies beside it.
  for (const std::string& model : models)
    show_all(std::filesystem::path(model).filename().string(), [&]() -> std::string {
      const std::string job = client.post("/api/jobs").json()["job"];
      json files = json::array();
      for (const auto& entry :
           std::filesystem::directory_iterator(std::filesystem::path(model).parent_path())) {
        if (entry.path().extension() == std::filesystem::path(model).extension() &&
            entry.path() != model)
          continue;
        const auto bytes = read_file(entry.path());
        const std::string name = entry.path().filename().string();
        if (client
                .put("/api/jobs/" + job + "/files/" + name, std::string(bytes.begin(), bytes.end()))
                .status == 201)
          files.push_back(name);
      }
      client.post("/api/jobs/" + job + "/adopt", json{{"files", files}, {"client", ""}}.dump());
      return job;
    });
  const std::string scan = scan_stl();
  const Begin open_scan = [&]() -> std::string {
    const std::string job = client.post("/api/jobs").json()["job"];
    client.put("/api/jobs/" + job + "/files/scan.stl", scan);
    client.post("/api/jobs/" + job + "/adopt", R"({"files": ["scan.stl"], "client": ""})");
    return job;
  };
  show("scan of 2 M triangles, turned", measure(client, open_scan, size, turn, kDragsOfScan));
  show("scan of 2 M triangles, depth", measure(client, open_scan, size, deeper, kDragsOfScan));
  return 0;
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) { return hydrodip::run({argv + 1, argv + argc}); }
