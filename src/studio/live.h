// What is computed while somebody works: a sketch after every change, then a draft, and the normal
// result when the hand rests. One thread, one workspace.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "job/dips_together.h"
#include "studio/look.h"

namespace hydrodip {

struct LiveRequest {
  JobConfig config;
  long revision = 0;
  std::size_t dip = 0;
  std::string content;  // the same for documents of which the same comes
  // In the middle of a drag: sketches are enough. The one that is being computed for an earlier
  // such request is finished, so that something moves, and so is one that the end of the drag asks
  // for again; any other computation is cancelled by a newer request.
  bool dragging = false;
  bool comes_to_the_same(const LiveRequest& other) const {
    return content == other.content && dip == other.dip;
  }
};

// Called on Live's own thread.
struct LiveSinks {
  std::function<void(long revision, std::shared_ptr<const Model>)> model;
  // What artwork makes of the model's colours.
  std::function<void(long revision, const Model&, const Object& painted)> painted;
  std::function<void(long revision, const Look&, double took_s)> look;
  // All dips together; null: what was told last holds for this revision too.
  std::function<void(long revision, const Model&, const DipsTogether*)> finish;
  // Why there is none.
  std::function<void(long revision, const std::string& text)> no_finish;
  std::function<void(long revision, const Problem&)> problem;
  // `quality` empty: it rests.
  std::function<void(long revision, const std::string& quality, const std::string& activity,
                     double fraction)>
      working;
};

class Live {
 public:
  explicit Live(LiveSinks sinks);
  // Cancels what is being computed.
  ~Live();
  Live(const Live&) = delete;
  Live& operator=(const Live&) = delete;

  void ask(LiveRequest request);
  // Cancels what is being computed, until something is asked for again.
  void rest();

  // A model as its file has it, read once for whoever asks and what is shown. For any thread.
  // Throws InputError, Cancelled.
  std::shared_ptr<const Model> model(const std::filesystem::path& file, const LoadOptions& options,
                                     const RunContext& context);

  std::size_t memory_bytes() const { return workspace_.memory_bytes(); }
  // How many results of each quality were finished, and how many were cancelled.
  struct Counts {
    long sketches = 0, drafts = 0, normals = 0, cancelled = 0;
  };
  Counts counts() const;

 private:
  struct Turn {
    LiveRequest request;
    RunContext context;
  };

  std::shared_ptr<const Model> read(const Project& project, const RunContext& context);
  // What reading that model warned of.
  std::vector<std::string> warnings_of(const std::shared_ptr<const Model>& model) const;
  void run();
  void compute(const Turn& turn);
  void show_model(const Turn& turn);
  void show_painted(const Turn& turn, const Look& look);
  void show_look(const Turn& turn, LookQuality quality);
  // Of several dips: those that are not shown, as drafts, and then all together.
  void show_others(const Turn& turn);
  void show_finish(const Turn& turn);
  // Whether nothing new was asked for so long.
  bool rests();

  const LiveSinks sinks_;
  Workspace workspace_;
  std::shared_ptr<const Model> shown_model_;
  std::vector<std::string> model_warnings_;
  std::shared_ptr<const Paint> shown_paint_;  // in full, and not only sketched
  bool shows_artwork_ = false;
  std::map<std::size_t, std::weak_ptr<const Designed>> told_;  // last, of each dip
  std::optional<LiveRequest> sketch_of_, normal_of_;  // of what such a result was told last
  std::string finish_of_;  // the content of which the finish was told; empty: none was

  mutable std::mutex mutex_;
  std::map<std::weak_ptr<const Model>, std::vector<std::string>, std::owner_less<>> warnings_;
  std::condition_variable changed_;
  std::optional<LiveRequest> waiting_;
  std::optional<RunContext> current_;
  std::optional<LiveRequest> asked_;  // for what that is computed
  bool ending_ = false;
  Counts counts_;
  std::thread thread_;
};

}  // namespace hydrodip
