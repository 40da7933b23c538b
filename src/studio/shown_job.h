// What is shown of a job: all that Live computes of it is packed, kept for whoever fetches it, and
// told to the tabs.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "base/context.h"
#include "studio/json.h"
#include "studio/live.h"
#include "studio/shown_results.h"
#include "studio/tabs.h"

namespace hydrodip {

class ShownJob {
 public:
  using Bytes = ShownResults::Bytes;

  // `mutex`: of the job, guards its tabs and what is kept here; all these outlive it. `address`: of
  // the job for the page; files in `uploads` are called by their names alone; `work` ends what is
  // being packed.
  ShownJob(std::mutex& mutex, const Tabs& tabs, ShownIds ids, std::string address,
           std::filesystem::path uploads, const RunContext& work);

  // For Live's thread, without the lock: it is taken to keep and to tell, not while anything is
  // packed.
  LiveSinks sinks();

  // What can be fetched, for any number of threads, without the lock. Null: gone, or never was.
  Bytes mesh(const std::string& id) const;
  std::shared_ptr<const ShownTexture> texture(const std::string& id, std::size_t number) const;
  Bytes result(const std::string& id) const;
  Bytes finish(const std::string& id) const;
  Bytes dip(const std::string& result) const;
  // Whether an ID is one of this run's, kept or not.
  bool has_given(const std::string& id) const { return ids_.has_given(id); }

  // With the lock.
  const ShownResults& results() const { return results_; }

 private:
  std::string keep_mesh(const Model& model, const Object& object);
  void show_model(long revision, const std::shared_ptr<const Model>& model);
  void show_painted(long revision, const Model& model, const Object& painted);
  void show_look(long revision, const Look& look, double took_s);
  void show_finish(long revision, const Model& model, const DipsTogether* look);
  void keep_finish(const Model& model, const DipsTogether& look);
  void show_problem(long revision, const Problem& problem);
  void show_no_finish(long revision, const std::string& text);
  void show_work(long revision, const std::string& quality, const std::string& activity,
                 double fraction) const;
  void tell_mesh(long revision, const std::string& wanted);
  void tell_held(const std::string& event, const Json& data);

  std::mutex& mutex_;
  const Tabs& tabs_;
  ShownIds ids_;
  const std::string address_;
  const std::filesystem::path uploads_;
  const RunContext work_;
  ShownResults results_;
};

}  // namespace hydrodip
