#include "studio/shown_job.h"

#include <array>
#include <utility>

#include "studio/job_files.h"
#include "studio/look_bundles.h"
#include "studio/shown_mesh.h"

namespace hydrodip {
namespace {

ShownJob::Bytes shared(std::vector<std::uint8_t> bytes) {
  return std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
}

}  // namespace

ShownJob::ShownJob(std::mutex& mutex, const Tabs& tabs, ShownIds ids, std::string address,
                   std::filesystem::path uploads, const RunContext& work)
    : mutex_(mutex),
      tabs_(tabs),
      ids_(std::move(ids)),
      address_(std::move(address)),
      uploads_(std::move(uploads)),
      work_(work) {}

LiveSinks ShownJob::sinks() {
  LiveSinks sinks;
  sinks.model = [this](long revision, const std::shared_ptr<const Model>& model) {
    show_model(revision, model);
  };
  sinks.painted = [this](long revision, const Model& model, const Object& painted) {
    show_painted(revision, model, painted);
  };
  sinks.look = [this](long revision, const Look& look, double took_s) {
    show_look(revision, look, took_s);
  };
  sinks.finish = [this](long revision, const Model& model, const DipsTogether* look) {
    show_finish(revision, model, look);
  };
  sinks.no_finish = [this](long revision, const std::string& text) {
    show_no_finish(revision, text);
  };
  sinks.problem = [this](long revision, const Problem& problem) {
    show_problem(revision, problem);
  };
  sinks.working = [this](long revision, const std::string& quality, const std::string& activity,
                         double fraction) { show_work(revision, quality, activity, fraction); };
  return sinks;
}

// ---- meshes ----

std::string ShownJob::keep_mesh(const Model& model, const Object& object) {
  std::string id = ids_.mesh();
  auto made = std::make_shared<const ShownMesh>(
      shown_mesh(model, object, id, address_ + "/meshes/" + id, work_.quiet()));
  const std::lock_guard lock(mutex_);
  results_.add_mesh(id, std::move(made));
  return id;
}

void ShownJob::show_model(long revision, const std::shared_ptr<const Model>& model) {
  const std::string id = keep_mesh(*model, *model->object);
  const std::lock_guard lock(mutex_);
  results_.set_model_mesh(id);
  tell_mesh(revision, id);
}

void ShownJob::show_painted(long revision, const Model& model, const Object& painted) {
  const bool own = &painted == model.object.get();
  const std::string id = own ? "" : keep_mesh(model, painted);
  const std::lock_guard lock(mutex_);
  tell_mesh(revision, own ? results_.model_mesh() : id);
}

// With the lock.
void ShownJob::tell_mesh(long revision, const std::string& wanted) {
  tell_held("mesh", {{"revision", revision}, {"mesh", results_.model_mesh()}, {"wanted", wanted}});
}

// With the lock.
void ShownJob::tell_held(const std::string& event, const Json& data) {
  tabs_.tell(event, results_.hold(event, data), true);
}

// ---- results ----

void ShownJob::show_look(long revision, const Look& look, double took_s) {
  ShownResults::Result result;
  result.id = ids_.result();
  result.dip = look.dip;
  result.made = look.made;
  result.bundle = shared(result_bundle(look, {{"result", result.id}, {"revision", revision}},
                                       uploads_, work_.quiet()));
  result.event = {{"revision", revision},
                  {"quality", quality_name(look.quality)},
                  {"dip", look.dip},
                  {"result", result.id},
                  {"took_s", took_s}};
  const std::lock_guard lock(mutex_);
  results_.hold("problem", nullptr);
  tabs_.tell("result", result.event, true, std::to_string(look.dip));
  results_.add_result(std::move(result));
}

void ShownJob::show_finish(long revision, const Model& model, const DipsTogether* look) {
  if (look) keep_finish(model, *look);
  const std::lock_guard lock(mutex_);
  tell_held("finish", {{"revision", revision}, {"finish", results_.finish_id()}});
}

void ShownJob::keep_finish(const Model& model, const DipsTogether& look) {
  const std::array<std::string, 2> meshes = {keep_mesh(model, look.colors),
                                             keep_mesh(model, look.parts)};
  const std::string id = ids_.finish();
  Bytes bundle = shared(
      finish_bundle(look, {{"finish", id}, {"mesh", meshes[0]}, {"parts", meshes[1]}}, uploads_));
  const std::lock_guard lock(mutex_);
  results_.set_finish(id, std::move(bundle), meshes);
}

void ShownJob::show_no_finish(long revision, const std::string& text) {
  const std::lock_guard lock(mutex_);
  tell_held("finish", {{"revision", revision}, {"problem", without_folder(text, uploads_)}});
}

void ShownJob::show_problem(long revision, const Problem& problem) {
  const std::lock_guard lock(mutex_);
  tell_held("problem", {{"revision", revision},
                        {"code", problem.code},
                        {"text", without_folder(problem.text, uploads_)},
                        {"mends", problem.mends}});
}

void ShownJob::show_work(long revision, const std::string& quality, const std::string& activity,
                         double fraction) const {
  Json event = {{"revision", revision}, {"quality", quality.empty() ? Json() : Json(quality)}};
  if (!quality.empty()) {
    event["activity"] = activity;
    event["fraction"] = fraction;
  }
  const std::lock_guard lock(mutex_);
  tabs_.tell("working", event, true);
}

// ---- what can be fetched ----

ShownJob::Bytes ShownJob::mesh(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return results_.mesh(id);
}

std::shared_ptr<const ShownTexture> ShownJob::texture(const std::string& id,
                                                      std::size_t number) const {
  const std::lock_guard lock(mutex_);
  return results_.texture(id, number);
}

ShownJob::Bytes ShownJob::result(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return results_.result(id);
}

ShownJob::Bytes ShownJob::finish(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return results_.finish(id);
}

ShownJob::Bytes ShownJob::dip(const std::string& result) const {
  std::shared_ptr<const Designed> made;
  {
    const std::lock_guard lock(mutex_);
    made = results_.made(result);
  }
  return made ? shared(dip_bundle(made->dipped)) : nullptr;
}

}  // namespace hydrodip
