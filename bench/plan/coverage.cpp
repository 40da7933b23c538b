// How much of a surface several dips cover: each model is planned for six, and what one, two,
// three, four and six of them come to is shown, by film that is whole.
//
//   bench_coverage [draft|normal] [MODEL:SIZE_MM | SAMPLE | FOLDER]...
//
// FOLDER, of test shapes (or any folder, for those that are made by code): the 20 models of
// torn_models.h. "normal" dips the chosen ones as finely as a job; "draft" as trial dips are.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/context.h"
#include "coat/design.h"
#include "dip/torn_models.h"
#include "job/dip_plan.h"
#include "model_io/load.h"
#include "object/paint.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

constexpr int kDips = 6;

struct Named {
  std::string name;
  std::shared_ptr<const Object> object;
  double size_mm = 0;
};

Named of_file(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const double size_mm = colon == std::string::npos ? 0 : std::atof(text.c_str() + colon + 1);
  const std::filesystem::path file = text.substr(0, colon);
  RunContext context;
  return {file.stem().string(),
          std::make_shared<const Object>(load_object(file, {}, context).object), size_mm};
}

std::shared_ptr<const Object> of_shape(const shapes::Shape& shape) {
  auto object = std::make_shared<Object>();
  object->positions = shape.positions;
  object->triangles = shape.triangles;
  object->materials.emplace_back();
  object->material_of.assign(object->triangles.size(), 0);
  return object;
}

bool is_sample(const std::string& name) {
  const auto list = samples();
  return std::any_of(list.begin(), list.end(), [&](const auto& s) { return s.name == name; });
}

std::vector<Named> listed(const std::filesystem::path& folder) {
  std::vector<Named> list;
  for (const shapes::Named& model : shapes::torn_models(folder))
    list.push_back({model.name, of_shape(model.shape)});
  return list;
}

// Shares of the surface under any of the dips, of all of it and of what looks up and down in the
// model's own frame (a mask's front and back).
void show(const Targets& targets, const std::vector<Trial>& dips) {
  for (const int side : {0, 1, -1}) {
    double area = 0;
    std::vector<double> covered(dips.size(), 0);
    for (std::size_t i = 0; i < targets.list.size(); ++i) {
      const Target& target = targets.list[i];
      if (side * target.normal.z() < 0) continue;
      area += target.area;
      for (std::size_t k = 0; k < dips.size(); ++k) {
        if (!(dips[k].worth[i] > 0)) continue;
        for (std::size_t later = k; later < dips.size(); ++later) covered[later] += target.area;
        break;
      }
    }
    fmt::print("{}", side == 0 ? "" : (side > 0 ? "   +z " : "   -z "));
    for (std::size_t k = 0; k < dips.size(); ++k)
      if (k != 4) fmt::print("{:5.1f} ", 100 * covered[k] / area);
  }
}

void plan(const Named& model, bool normal) {
  JobConfig config;
  config.object.pose.size_mm = model.size_mm;
  config.plan.dips = kDips;
  if (!normal) {
    config.design = draft_of(config.design);
  }
  const RunContext context;
  const PreparedObject prepared{PosedObject(model.object, config.object.pose),
                                model_paint(model.object),
                                {},
                                "mm",
                                {},
                                {},
                                {}};
  const auto start = std::chrono::steady_clock::now();
  try {
    const Targets targets = job_targets(config, prepared, context);
    const DipPlan made = plan_dips(config, prepared, targets, true, context);
    std::vector<Trial> dips;
    for (const PlannedDip& dip : made.dips) dips.push_back(dip.trial);
    fmt::print("{:<20} ", model.name);
    show(targets, dips);
    double torn = 0;
    for (const Trial& dip : dips) torn = std::max(torn, dip.figures.torn_share);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("  torn up to {:.0f} %, {} trials, {:.1f} s\n", 100 * torn, made.trial_dips,
               seconds);
  } catch (const std::exception& problem) {
    fmt::print("{:<20} {}\n", model.name, problem.what());
  }
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  bool normal = false;
  fmt::print("covered after 1, 2, 3, 4, 6 dips, %: all, what looks to +z, to -z\n");
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "draft" || word == "normal") {
      normal = word == "normal";
    } else if (std::filesystem::is_directory(word)) {
      for (const Named& model : listed(word)) plan(model, normal);
    } else if (is_sample(word)) {
      plan({word, std::make_shared<const Object>(make_sample(word))}, normal);
    } else {
      plan(of_file(word), normal);
    }
  }
  return 0;
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) { return hydrodip::run(argc, argv); }
