#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parse_double.h"
#include "base/shell_word.h"
#include "rig/finish_run.h"
#include "rig/registration_file.h"
#include "rig/rig.h"
#include "rig/stage_session.h"

namespace hydrodip {
namespace {

constexpr double kTick_s = 0.2;
constexpr double kHottest_c = 100, kHeaviest_g = 100000;

class Guide {
 public:
  Guide(const RigJob& job, Bench& bench, RunRecord& record, const RunContext& context)
      : job_(job),
        process_(job.config.process),
        bench_(bench),
        person_(bench.person),
        record_(record),
        context_(context) {}

  void run(const BrokenRun& broken) {
    take_up(broken);
    introduce();
    step("film prepared", [&] { prepare_film(); });
    step("object mounted", [&] { mount_object(); });
    if (!job_.config.stage.port.empty()) step("stage ready", [&] { ready_stage(); });
    step("water warm", [&] { check_water("before"); });
    step("film laid", [&] { lay_film(); });
    if (!find_camera(job_.folder).empty()) step("registered", [&] { locate_film(); });
    if (activator_for(job_.config).mass_g > 0) step("activated", [&] { spray(); });
    step("dipped", [&] { dip(); });
    step("lifted", [&] { lift(); });
    step("water still warm", [&] { check_water("after"); });
    step("drying", [&] { dry(); });
  }

  const std::string& at_step() const { return step_; }
  Trace trace() const { return stage_ ? stage_->trace() : Trace{}; }
  std::optional<Rest> rest() const { return stage_ ? stage_->last_rest() : std::optional<Rest>(); }

 private:
  // Film and object of a broken run are still there; everything later is under way or spoilt.
  void take_up(const BrokenRun& broken) {
    std::vector<std::string> kept;
    for (const std::string& step : broken.steps)
      if (step == "film prepared" || step == "object mounted") kept.push_back(step);
    if (kept.empty()) return;
    const std::string done = fmt::format("{}", fmt::join(kept, ", "));
    const std::string answer = person_.ask(fmt::format(
        "{} was broken off with this done: {}. Keep that? yes or no: ", broken.name, done));
    if (answer != "yes") return record_.note("not taken up", {{"from", broken.name}});
    done_ = kept;
    record_.note("taken up", {{"from", broken.name}, {"done", done}});
    for (const std::string& step : kept) record_.note("step kept", {{"step", step}});
  }

  void introduce() {
    person_.say(
        fmt::format("{}: {:.2f} mm deep at {:g} mm/min. Ctrl-C ends at any time; the log "
                    "goes to {}.",
                    job_.title, job_.depth_mm, process_.speed_mm_per_min,
                    (record_.folder() / "log.jsonl").string()));
    if (!job_.alarm.empty()) person_.say(job_.alarm);
    for (const std::string& warning : job_.warnings) person_.say("Mind: " + warning);
  }

  void step(const std::string& name, const std::function<void()>& body) {
    if (std::find(done_.begin(), done_.end(), name) != done_.end()) return;
    step_ = name;
    const double start_s = bench_.clock.now_s();
    body();
    record_.note("step done", {{"step", name}, {"seconds", bench_.clock.now_s() - start_s}});
  }

  void prepare_film() {
    const double ruler = ruler_mm(job_.config);
    person_.say(fmt::format("\nFILM. Print print.pdf at 100 %{}. {}. Peel the backing off.",
                            ruler > 0 ? fmt::format(" (check its {:g} mm ruler)", ruler) : "",
                            taping(job_.config)));
    person_.ask("Enter when the film is ready: ");
  }

  void mount_object() {
    const std::string otherwise = hung_otherwise(job_);
    person_.say(
        "\nOBJECT. Clean, dry, free of grease; mounted as the run sheet shows, over the middle of "
        "the film's place." +
        (otherwise.empty() ? "" : " It hangs " + otherwise + "."));
    person_.ask("Enter when it hangs: ");
  }

  void ready_stage() {
    person_.say("\nSTAGE.");
    require_lowering_only(job_);
    stage_.emplace(job_.config.stage, bench_, &record_, context_);
    person_.say(stage_->describe());
    stage_->ensure_home(true);
    water_mm_ = stage_->find_water_level();
    save_water_level(job_, *water_mm_);
    require_room();
    stage_->lift_clear(*water_mm_);
    person_.say(describe_plan(job_, water_mm_));
  }

  // Better known before the film swims.
  void require_room() {
    for (const PlannedMove& move : plan_dip(job_)) stage_->require_reach(*water_mm_, move);
  }

  void check_water(const std::string& when) {
    person_.say(fmt::format("\nWATER. {} C, {:.1f} l.",
                            span_in_words(process_.water_min_c, process_.water_max_c),
                            bath_litres(job_.config.bath)));
    for (;;) {
      const double water_c = ask_number("Temperature in C: ", kHottest_c);
      const bool right = water_c >= process_.water_min_c && water_c <= process_.water_max_c;
      record_.note("water", {{"when", when}, {"celsius", water_c}, {"within", right}});
      if (right || when == "after") return;
      const bool cold = water_c < process_.water_min_c;
      if (person_.ask(fmt::format("That is too {}. Enter to measure again, or keep: ",
                                  cold ? "cold" : "warm")) == "keep")
        return;
    }
  }

  void lay_film() {
    person_.say(fmt::format(
        "\nLAY THE FILM. Ink side {}, from one side, no bubbles below, no water on top.",
        job_.config.print.ink_side == InkSide::kUp ? "up" : "down"));
    person_.ask("Enter the moment it lies on the water: ");
    record_.note("film on the water", {});
    const double soaked_s =
        wait("soak", process_.soak_min_s, process_.soak_max_s, "press Enter when it lies flat");
    const bool right = soaked_s >= process_.soak_min_s && soaked_s <= process_.soak_max_s;
    record_.note("soaked", {{"seconds", soaked_s}, {"within", right}});
    if (!right) person_.say(fmt::format("{:.0f} s: not as planned; it is in the log.", soaked_s));
  }

  // As often as the frame is moved.
  void locate_film() {
    person_.say(
        fmt::format("\nWHERE IT LIES. Photograph the film with the whole rim in the picture; in "
                    "another window: "
                    "hydrodip register PHOTO {}",
                    shell_word(job_.folder.string())));
    std::string seen = photo_seen();
    for (;;) {
      const std::string answer = person_.ask("Enter when that has said where it lies, or skip: ");
      if (answer == "skip") return;
      const auto found = read_registration(job_.folder / kRegistrationFile);
      if (!found || found->photo_sha256 == seen) {
        person_.say(fmt::format("{} is as it was.", kRegistrationFile));
        continue;
      }
      seen = found->photo_sha256;
      record_.note("registered", {{"x_mm", found->shift_mm.x()},
                                  {"y_mm", found->shift_mm.y()},
                                  {"turn_deg", found->turn_deg},
                                  {"swelling_x", found->swelling.x()},
                                  {"swelling_y", found->swelling.y()}});
      person_.say(advice(*found));
      if (person_.ask("Enter to go on, or again after another photo: ") != "again") return;
    }
  }

  std::string photo_seen() const {
    const auto before = read_registration(job_.folder / kRegistrationFile);
    return before ? before->photo_sha256 : "";
  }

  void spray() {
    const Activator wanted = activator_for(job_.config);
    person_.say(fmt::format("\nACTIVATOR. {:.1f} +- {:.1f} g, evenly. Mask on.", wanted.mass_g,
                            wanted.tolerance_g));
    double before_g = ask_number("Gun before, g: ", kHeaviest_g);
    double used_g = 0;
    for (;;) {
      person_.ask("Spray. Enter when done: ");
      sprayed_s_ = bench_.clock.now_s();
      double after_g = ask_number("Gun after, g: ", kHeaviest_g);
      while (after_g > before_g) {
        const std::string answer = person_.ask(fmt::format(
            "That is heavier than before, {:g} g. Enter to weigh again, or before to mend that: ",
            before_g));
        if (answer == "before") before_g = ask_number("Gun before, g: ", kHeaviest_g);
        after_g = ask_number("Gun after, g: ", kHeaviest_g);
      }
      used_g = before_g - after_g;
      const double off_g = used_g - wanted.mass_g;
      record_.note("activator", {{"before_g", before_g},
                                 {"after_g", after_g},
                                 {"used_g", used_g},
                                 {"within", std::abs(off_g) <= wanted.tolerance_g}});
      if (std::abs(off_g) <= wanted.tolerance_g) return;
      if (off_g > 0) {
        person_.say(fmt::format("{:.1f} g too much: the film may slide.", off_g));
        return;
      }
      if (person_.ask(fmt::format("{:.1f} g too little. Enter to spray more, or keep: ", -off_g)) ==
          "keep")
        return;
    }
  }

  void dip() {
    if (sprayed_s_) {
      const double left_s = *sprayed_s_ + process_.activator_wait_s - bench_.clock.now_s();
      if (left_s > 0) wait("activator works", left_s, left_s, "");
      record_.note("activator worked", {{"seconds", bench_.clock.now_s() - *sprayed_s_}});
    }
    person_.say("\nDIP.");
    if (stage_)
      dip_with_stage();
    else
      dip_by_hand();
  }

  void dip_with_stage() {
    stage_->require_yes("The stage will now dip the object. Hands off?");
    for (const char* phase : {"approach", "dip", "dwell"}) stage_->perform(job_, *water_mm_, phase);
    person_.say("The object is down and stands still.");
  }

  void dip_by_hand() {
    const double way_mm = in_water_mm(job_), seconds = 60 * way_mm / process_.speed_mm_per_min;
    person_.ask(
        fmt::format("By hand: {:.1f} mm in {:.1f} s, {}. Enter to start: ", way_mm, seconds,
                    moves_aside(job_) ? "along the way in of the run sheet" : "straight down"));
    const double start_s = bench_.clock.now_s();
    for (double past_s = 0; past_s < seconds; past_s = bench_.clock.now_s() - start_s) {
      person_.show(fmt::format("{:5.1f} of {:.1f} mm", past_s / seconds * way_mm, way_mm) +
                   where_now(past_s / seconds * way_mm));
      tick();
    }
    record_.note("dipped by hand", {{"planned_s", seconds}});
    if (process_.dwell_s > 0) wait("keep it down", process_.dwell_s, process_.dwell_s, "");
  }

  // How the object is to be held now, on a way that is not straight.
  std::string where_now(double travelled_mm) const {
    if (!moves_aside(job_)) return "";
    std::size_t next = 1;
    while (next + 1 < job_.way_in.size() && job_.way_in[next].travelled_mm < travelled_mm) ++next;
    const WayPoint &a = job_.way_in[next - 1], &b = job_.way_in[next];
    const double span = b.travelled_mm - a.travelled_mm;
    const double part = span > 0 ? std::clamp((travelled_mm - a.travelled_mm) / span, 0.0, 1.0) : 1;
    const auto at = [&](double Keyframe::*of) {
      return a.pose.*of + part * (b.pose.*of - a.pose.*of);
    };
    return fmt::format(
        "   lowered {:.1f} mm, shifted {:.1f}, {:.1f}, turned {:.0f}, {:.0f}, {:.0f}",
        at(&Keyframe::lower_mm), at(&Keyframe::shift_x_mm), at(&Keyframe::shift_y_mm),
        at(&Keyframe::turn_x_deg), at(&Keyframe::turn_y_deg), at(&Keyframe::turn_z_deg));
  }

  void lift() {
    person_.say("\nLIFT. Clear the rest of the film off the water first.");
    person_.ask("Enter when the surface is clear: ");
    if (!stage_) {
      person_.ask("Lift the object out slowly. Enter when it is out: ");
      return;
    }
    stage_->require_yes("The stage will now lift the object.");
    stage_->perform(job_, *water_mm_, "retract");
  }

  void dry() {
    person_.say(
        fmt::format("\nRINSE until nothing is slippery. DRY{}; a clear coat if you like.",
                    process_.dry_max_h > 0
                        ? " for " + span_in_words(process_.dry_min_h, process_.dry_max_h) + " h"
                        : ""));
    const std::string notes = person_.ask("Notes for the log, or Enter: ");
    if (!notes.empty()) record_.note("notes", {{"text", notes}});
  }

  // Counts down to the least and on to the most; how long it was. Without a hint it ends by itself,
  // else when Enter is pressed.
  double wait(const std::string& what, double least_s, double most_s, const std::string& hint) {
    const double start_s = bench_.clock.now_s();
    for (;;) {
      const double past_s = bench_.clock.now_s() - start_s;
      if (hint.empty() ? past_s >= least_s : person_.pressed_enter()) return past_s;
      person_.show(countdown(what, past_s, least_s, most_s, hint));
      tick();
    }
  }

  static std::string countdown(const std::string& what, double past_s, double least_s,
                               double most_s, const std::string& hint) {
    if (past_s < least_s) return fmt::format("{}: {:.0f} s to go", what, least_s - past_s);
    if (past_s <= most_s)
      return fmt::format("{}: {:.0f} s, {}; {:.0f} s left", what, past_s, hint, most_s - past_s);
    return fmt::format("{}: {:.0f} s, {}: LATE by {:.0f} s", what, past_s, hint, past_s - most_s);
  }

  void tick() {
    bench_.clock.sleep(kTick_s);
    context_.check_cancelled();
  }

  double ask_number(const std::string& question, double most) {
    for (;;) {
      std::string answer = person_.ask(question);
      std::replace(answer.begin(), answer.end(), ',', '.');
      double value = 0;
      const auto [end, error] = parse_double(answer.data(), answer.data() + answer.size(), value);
      if (error == std::errc() && end == answer.data() + answer.size() && value >= 0 &&
          value <= most)
        return value;
      person_.say("A number, please, as in 28.5.");
    }
  }

  const RigJob& job_;
  const ProcessOptions& process_;
  Bench& bench_;
  Operator& person_;
  RunRecord& record_;
  const RunContext& context_;
  std::optional<StageSession> stage_;
  std::optional<double> water_mm_;
  std::vector<std::string> done_;
  std::string step_ = "start";
  std::optional<double> sprayed_s_;
};

}  // namespace

JobResult rig_guide(const RigJob& job, Bench& bench, const RunContext& context) {
  const BrokenRun broken = last_broken_run(job);  // before this run has a folder
  RunRecord record(job, bench.clock);
  Guide guide(job, bench, record, context);
  record.note("start", {{"job", job.title},
                        {"depth_mm", job.depth_mm},
                        {"speed_mm_per_min", job.config.process.speed_mm_per_min},
                        {"stage", job.config.stage.port},
                        {"report_sha256", job.report_sha256},
                        {"batch", job.batch},
                        {"label", job.label}});
  return finish_run(
      record, "rig guide", [&] { guide.run(broken); },
      [&] {
        return RunEnd{guide.at_step(), guide.trace(), guide.rest(), true};
      });
}

}  // namespace hydrodip
