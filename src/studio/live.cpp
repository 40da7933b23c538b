#include "studio/live.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/error.h"
#include "base/run_scope.h"
#include "object/bake.h"

namespace hydrodip {
namespace {

using Steady = std::chrono::steady_clock;

constexpr std::size_t kWorkspaceBytes = std::size_t(768) << 20U;
// The hand rests when nothing was asked for so long.
constexpr auto kRest = std::chrono::milliseconds(400);
constexpr auto kBetweenProgress = std::chrono::milliseconds(100);
constexpr int kBaked_px = 1536, kBakedSketch_px = 512, kFinish_px = 1024;

double seconds_since(Steady::time_point start) {
  return std::chrono::duration<double>(Steady::now() - start).count();
}

}  // namespace

Live::Live(LiveSinks sinks)
    : sinks_(std::move(sinks)), workspace_(kWorkspaceBytes), thread_([this] { run(); }) {}

Live::~Live() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    if (current_) current_->cancel();
    changed_.notify_all();
  }
  thread_.join();
}

void Live::ask(LiveRequest request) {
  const std::lock_guard lock(mutex_);
  const bool goes_on =
      asked_ && asked_->dragging && (request.dragging || request.comes_to_the_same(*asked_));
  if (current_ && !goes_on) current_->cancel();
  waiting_ = std::move(request);
  changed_.notify_all();
}

void Live::rest() {
  const std::lock_guard lock(mutex_);
  waiting_.reset();
  if (current_) current_->cancel();
}

std::shared_ptr<const Model> Live::model(const std::filesystem::path& file,
                                         const LoadOptions& options, const RunContext& context) {
  Project project;
  project.model = file;
  project.load = options;
  return read(project, context);
}

std::shared_ptr<const Model> Live::read(const Project& project, const RunContext& context) {
  context.check_cancelled();  // one that is known takes no time in which it could be
  const RunContext reading = context.quiet();
  auto model = workspace_.model(project, reading);
  const std::lock_guard lock(mutex_);
  std::erase_if(warnings_, [](const auto& known) { return known.first.expired(); });
  // One that was known is not read again, and nothing is said of it.
  if (const auto said = reading.warnings(); !said.empty()) warnings_[model] = said;
  return model;
}

std::vector<std::string> Live::warnings_of(const std::shared_ptr<const Model>& model) const {
  const std::lock_guard lock(mutex_);
  const auto known = warnings_.find(model);
  return known == warnings_.end() ? std::vector<std::string>() : known->second;
}

Live::Counts Live::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

void Live::run() {
  while (true) {
    std::optional<Turn> turn;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return ending_ || waiting_; });
      if (ending_) return;
      turn.emplace(Turn{std::move(*waiting_), workspace_.newest()});
      waiting_.reset();
      current_ = turn->context;
      asked_ = turn->request;
    }
    compute(*turn);
    {
      const std::lock_guard lock(mutex_);
      current_.reset();
      asked_.reset();
      if (waiting_ || ending_) continue;
    }
    sinks_.working(turn->request.revision, "", "", 1);
  }
}

bool Live::rests() {
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, kRest, [&] { return ending_ || waiting_; });
}

void Live::compute(const Turn& turn) {
  const auto count = [&](long Counts::*which) {
    const std::lock_guard lock(mutex_);
    ++(counts_.*which);
  };
  try {
    if (!turn.request.config.model.empty()) show_model(turn);
    // Only the name has changed, say.
    const bool known = normal_of_ && turn.request.comes_to_the_same(*normal_of_);
    normal_of_.reset();
    if (turn.request.dragging || !known) {
      // The end of a drag is where its last move was.
      if (!sketch_of_ || !turn.request.comes_to_the_same(*sketch_of_)) {
        sketch_of_.reset();
        show_look(turn, LookQuality::kSketch);
        count(&Counts::sketches);
        sketch_of_ = turn.request;
      }
      if (turn.request.dragging) return;
      show_look(turn, LookQuality::kDraft);
      count(&Counts::drafts);
      if (!rests()) return;
    }
    show_look(turn, LookQuality::kNormal);
    count(&Counts::normals);
    normal_of_ = turn.request;
    if (turn.request.config.dips.size() > 1) {
      show_others(turn);
      show_finish(turn);
    }
  } catch (const Cancelled&) {
    count(&Counts::cancelled);
  } catch (const ProblemFound& found) {
    sinks_.problem(turn.request.revision, found.problem);
  } catch (const std::bad_alloc&) {
    sinks_.problem(turn.request.revision, {"memory", "There is not enough memory for this."});
  } catch (const std::exception& error) {
    sinks_.problem(turn.request.revision, {"input", error.what()});
  }
}

// Before anything can be wrong with the dip, so that there is something to see.
void Live::show_model(const Turn& turn) {
  std::shared_ptr<const Model> model;
  try {
    model =
        read(project_of(config_of_dip(turn.request.config, turn.request.dip), LookQuality::kDraft),
             turn.context);
  } catch (const InputError&) {
    return;  // said by show_look()
  }
  if (model == shown_model_) return;
  shown_model_ = model;
  shown_paint_.reset();
  shows_artwork_ = false;
  model_warnings_ = warnings_of(model);
  sinks_.model(turn.request.revision, model);
}

void Live::show_look(const Turn& turn, LookQuality quality) {
  const std::string name = quality_name(quality);
  const auto begun = Steady::now();
  auto told = begun;
  turn.context.on_progress([&](const std::string& activity, double fraction) {
    if (Steady::now() - told < kBetweenProgress) return;
    told = Steady::now();
    sinks_.working(turn.request.revision, name, activity, fraction);
  });
  struct Silence {
    const RunContext& context;
    ~Silence() { context.on_progress({}); }
  } const silence{turn.context};
  const Look look = look_at_dip(workspace_, turn.request.config, turn.request.dip, quality,
                                model_warnings_, turn.context);
  sinks_.look(turn.request.revision, look, seconds_since(begun));
  told_[look.dip] = look.made;
  if (quality != LookQuality::kNormal) show_painted(turn, look);
}

void Live::show_others(const Turn& turn) {
  const JobConfig& config = turn.request.config;
  for (std::size_t dip = 0; dip < config.dips.size(); ++dip) {
    if (dip == turn.request.dip) continue;
    try {
      const Look look =
          look_at_dip(workspace_, config, dip, LookQuality::kDraft, model_warnings_, turn.context);
      if (told_[dip].lock() == look.made) continue;
      sinks_.look(turn.request.revision, look, 0);
      told_[dip] = look.made;
    } catch (const ProblemFound&) {
      continue;  // said when it is shown
    }
  }
}

void Live::show_finish(const Turn& turn) {
  const LiveRequest& request = turn.request;
  const Project project =
      project_of(config_of_dip(request.config, request.dip), LookQuality::kDraft);
  const auto model = workspace_.model(project, turn.context);
  if (finish_of_ == request.content) return sinks_.finish(request.revision, *model, nullptr);
  finish_of_.clear();
  try {
    if (!all_dips_are_given(request.config)) return;
    sinks_.working(request.revision, "finish", "putting the dips together", 0);
    const DipsTogether look = look_at_dips(workspace_, request.config, kFinish_px, turn.context);
    sinks_.finish(request.revision, *model, &look);
    finish_of_ = request.content;
  } catch (const ProblemFound& found) {
    sinks_.no_finish(request.revision, found.problem.text);
  }
}

void Live::show_painted(const Turn& turn, const Look& look) {
  const bool artwork = !turn.request.config.object.artwork.empty();
  if (!artwork) {
    if (shows_artwork_) sinks_.painted(turn.request.revision, *look.model, *look.model->object);
    shows_artwork_ = false;
    shown_paint_.reset();
    return;
  }
  if (look.paint == shown_paint_) return;
  shows_artwork_ = true;
  const RunScope scope(turn.context);
  const bool sketch = look.quality == LookQuality::kSketch;
  const int px = sketch ? kBakedSketch_px : kBaked_px;
  const Object painted = painted_object(*look.model->object, *look.paint, {px});
  // A sketch is baked again.
  shown_paint_ = sketch ? nullptr : look.paint;
  sinks_.painted(turn.request.revision, *look.model, painted);
}

}  // namespace hydrodip
