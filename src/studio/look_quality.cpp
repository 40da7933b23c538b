#include "studio/look_quality.h"

#include <algorithm>
#include <cmath>

#include "job/wanted.h"

namespace hydrodip {
namespace {

// A picture has so many pixels at most; the screen shows no more.
constexpr double kSketchPixels = 3.5e5, kDraftPixels = 7e5, kNormalPixels = 4e6;
constexpr double kSketchDpi = 60, kDraftDpi = 100, kNormalDpi = 150;
constexpr int kSketchElements = 5000, kSketchAirCells = 10000;
constexpr std::size_t kSketchTriangles = 20000;
constexpr int kSketchPoints = 4000;  // at which the report asks what is covered
constexpr double kSketchStep_mm = 2;

double shown_dpi(const JobConfig& config, LookQuality quality) {
  struct Picture {
    double pixels, dpi;
  };
  const auto most = [&]() -> Picture {
    switch (quality) {
      case LookQuality::kSketch:
        return {kSketchPixels, kSketchDpi};
      case LookQuality::kDraft:
        return {kDraftPixels, kDraftDpi};
      case LookQuality::kNormal:
        break;
    }
    return {kNormalPixels, kNormalDpi};
  }();
  const double area_in2 =
      config.design.film.width_mm * config.design.film.height_mm / (kMmPerInch * kMmPerInch);
  return std::min({config.design.dpi, most.dpi, std::floor(std::sqrt(most.pixels / area_in2))});
}

void make_sketch(Project& project) {
  project.most_triangles = kSketchTriangles;
  DesignOptions& design = project.design;
  design.film.elements = std::min(design.film.elements, kSketchElements);
  design.dip.step_mm = std::max(design.dip.step_mm, kSketchStep_mm);
  design.dip.quick_look = design.inverse.quick_look = true;
  design.air.cells = std::min(design.air.cells, kSketchAirCells);
}

}  // namespace

std::string quality_name(LookQuality quality) {
  if (quality == LookQuality::kNormal) return "normal";
  return quality == LookQuality::kDraft ? "draft" : "sketch";
}

Quality quality_of(LookQuality quality) {
  return quality == LookQuality::kNormal ? Quality::kNormal : Quality::kDraft;
}

Project project_of(const JobConfig& config, LookQuality quality) {
  Project project;
  project.model = config.model;
  project.load = config.object.load;
  project.pose = config.object.pose;
  project.base = config.object.base;
  project.artwork = config.object.artwork;
  project.design = config.design;
  project.design.dpi = shown_dpi(config, quality);
  if (quality != LookQuality::kNormal) project.design.inverse.samples_per_axis = 1;
  if (quality == LookQuality::kSketch) make_sketch(project);
  project.printer = config.printer;
  return project;
}

int points_of(LookQuality quality) {
  return quality == LookQuality::kSketch ? kSketchPoints : kWantedPoints;
}

}  // namespace hydrodip
