// A guided dip in its own time: a job's folder, an operator who follows a script, the real guide,
// and an emulated stage of either make.
#pragma once

#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/file.h"
#include "rig/rig.h"
#include "virtual_bench.h"

namespace hydrodip {

// Answers by the question's beginning; the time that an answer takes passes on the clock.
class ScriptedOperator : public Operator {
 public:
  ScriptedOperator(Clock& clock, const RunContext& context) : clock_(clock), context_(context) {}

  void say(const std::string& text) override { said += text + "\n"; }
  void show(const std::string& line) override {
    shown.emplace_back(clock_.now_s(), line);
    if (on_show) on_show(line);
  }
  bool pressed_enter() override { return clock_.now_s() - asked_s_ >= soak_s; }
  std::string ask(const std::string& question) override {
    asked.emplace_back(clock_.now_s(), question);
    clock_.sleep(1);
    if (context_.cancelled()) throw Cancelled();  // as at a terminal
    asked_s_ = clock_.now_s();
    if (on_ask) on_ask(question);
    if (question.find("where it lies") != std::string::npos) return next(locating, "");
    if (question.find("broken off") != std::string::npos) return take_up;
    if (question.find("Type yes") != std::string::npos) return yes;
    if (question.find("or here") != std::string::npos) return next(jogs, "here");
    if (question.find("Temperature") != std::string::npos) return next(temperatures, "28,5");
    if (question.find("measure again, or keep") != std::string::npos) return keep_water;
    if (question.find("Gun before") != std::string::npos) return "812.40";
    if (question.find("Gun after") != std::string::npos) return next(guns_after, "808.90");
    if (question.find("spray more, or keep") != std::string::npos) return keep_spray;
    if (question.find("Notes") != std::string::npos) return notes;
    return "";
  }

  // When the first question with that in it was asked; -1: never. A second passes to the answer.
  double asked_s(const std::string& part) const {
    for (const auto& [time_s, question] : asked)
      if (question.find(part) != std::string::npos) return time_s;
    return -1;
  }
  int times_asked(const std::string& part) const {
    int count = 0;
    for (const auto& [time_s, question] : asked)
      count += question.find(part) != std::string::npos ? 1 : 0;
    return count;
  }

  std::string said, yes = "yes", take_up = "no", keep_water, keep_spray, notes;
  std::deque<std::string> jogs = {"60", "-2.5"}, temperatures, guns_after;
  std::deque<std::string> locating;
  std::function<void(const std::string&)> on_show, on_ask;
  double soak_s = 70;
  std::vector<std::pair<double, std::string>> asked, shown;

 private:
  static std::string next(std::deque<std::string>& answers, const std::string& otherwise) {
    if (answers.empty()) return otherwise;
    std::string answer = answers.front();
    answers.pop_front();
    return answer;
  }

  Clock& clock_;
  const RunContext& context_;
  double asked_s_ = 0;
};

struct GuidedBench {
  explicit GuidedBench(Machine machine = Machine::kZaber, unsigned seed = 1)
      : emulator(machine == Machine::kZaber ? zaber_emulator(seed) : marlin_emulator(seed)),
        clock(*emulator),
        person(clock, context) {
    bench.open = [this](const StageOptions& options) -> std::unique_ptr<Link> {
      return std::make_unique<CountingLink>(open_serial(options.port, options.baud, clock), clock);
    };
  }
  std::unique_ptr<Emulator> emulator;
  VirtualClock clock;
  RunContext context;
  ScriptedOperator person;
  Bench bench{person, clock, {}};
};

// What 'hydrodip print' leaves for the rig; parameters as in its report.
inline void write_rig_report(const std::filesystem::path& folder,
                             const nlohmann::json& parameters) {
  const nlohmann::json report = {
      {"schema_version", 1},
      {"title", "mask"},
      {"parameters", parameters},
      {"figures", {{"depth_mm", 29.5}, {"object_size_mm", {100, 130, 29.5}}}}};
  write_file(folder / "report.json", report.dump());
}

inline std::vector<nlohmann::json> read_log(const std::filesystem::path& run) {
  std::ifstream file(run / "log.jsonl");
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

// A guided dip with faults drawn by the seed, in a folder that is made anew; what it did that it
// should not have, "" for nothing.
std::string random_guided_faults(Machine machine, unsigned seed,
                                 const std::filesystem::path& folder, std::string& story);

}  // namespace hydrodip
