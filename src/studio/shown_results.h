// What was computed of a job and can be fetched, by ID, and what a tab that comes later is told of
// it.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "studio/json.h"
#include "studio/live.h"
#include "studio/shown_mesh.h"

namespace hydrodip {

// IDs of one run of the studio: none comes to mean something else. For any number of threads.
class ShownIds {
 public:
  // `numbers`: how many the run has given, in whatever job.
  ShownIds(const std::string& run, std::shared_ptr<std::atomic<long>> numbers)
      : prefix_(run.substr(0, 8) + "-"), numbers_(std::move(numbers)) {}

  std::string mesh() { return next('m'); }
  std::string result() { return next('r'); }
  std::string finish() { return next('f'); }
  std::string task() { return next('t'); }
  // For what has no address but must be unlike all others.
  long number() { return ++*numbers_; }
  // Whether it is one of this run's.
  bool has_given(const std::string& id) const;

 private:
  std::string next(char kind);

  std::string prefix_;
  std::shared_ptr<std::atomic<long>> numbers_;
};

// With its owner's lock.
class ShownResults {
 public:
  using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;
  struct Result {
    std::string id;
    std::size_t dip = 0;
    Bytes bundle;
    std::shared_ptr<const Designed> made;
    Json event;  // "result", as it was told
  };

  void add_mesh(const std::string& id, std::shared_ptr<const ShownMesh> made);
  // The model in its own colours; stays while it is that.
  void set_model_mesh(const std::string& id) { model_mesh_ = id; }
  const std::string& model_mesh() const { return model_mesh_; }
  // The newest of each dip stay, and besides them the last few.
  void add_result(Result result);
  // The ID of the newest, or "".
  std::string newest_result() const { return results_.empty() ? "" : results_.front().id; }
  void set_finish(const std::string& id, Bytes bundle, const std::array<std::string, 2>& meshes);
  const std::string& finish_id() const { return finish_.first; }
  // What holds of mesh, finish or problem until it is told anew; null: nothing does.
  const Json& hold(const std::string& event, const Json& data) { return held_[event] = data; }
  // Events for a tab that comes now, in order.
  std::vector<std::pair<std::string, Json>> events() const;

  // Null: gone, or never was.
  Bytes mesh(const std::string& id) const;
  std::shared_ptr<const ShownTexture> texture(const std::string& id, std::size_t number) const;
  Bytes result(const std::string& id) const;
  Bytes finish(const std::string& id) const;
  std::shared_ptr<const Designed> made(const std::string& id) const;

 private:
  std::list<std::pair<std::string, std::shared_ptr<const ShownMesh>>> meshes_;  // newest first
  std::string model_mesh_;
  std::array<std::string, 2> finish_meshes_;
  std::pair<std::string, Bytes> finish_;
  std::list<Result> results_;  // newest first
  std::map<std::string, Json> held_;
};

}  // namespace hydrodip
