#include "job/finish_check.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "base/run_scope.h"
#include "image/color_difference.h"

namespace hydrodip {
namespace {

constexpr double kMostOf = 0.95;

struct MeanColor {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  void add(const LinearColor& c) {
    sum += Vec3(double(c.r), double(c.g), double(c.b));
    ++count;
  }
  Vec3 lab() const {
    const Vec3 mean = sum / std::max(1, count);
    return to_cielab({float(mean.x()), float(mean.y()), float(mean.z()), 1});
  }
};

// Each node and those that touch it, as far as they have film.
std::vector<std::vector<std::int32_t>> patches(const SurfaceNodes& nodes,
                                               const std::vector<std::uint8_t>& has_film) {
  std::vector<std::vector<std::int32_t>> list(nodes.nodes().size());
  for (std::size_t i = 0; i < list.size(); ++i) list[i].push_back(std::int32_t(i));
  for (const auto& [a, b] : nodes.neighbors()) {
    if (!has_film[std::size_t(a)] || !has_film[std::size_t(b)]) continue;
    list[std::size_t(a)].push_back(b);
    list[std::size_t(b)].push_back(a);
  }
  return list;
}

double mean_of(const std::vector<std::int32_t>& which, const std::vector<float>& error) {
  double sum = 0;
  int count = 0;
  for (const std::int32_t i : which) {
    if (error[std::size_t(i)] < 0) continue;
    sum += double(error[std::size_t(i)]);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

FinishCheck::FinishCheck(const Finish& finish, const SharedSurface& shared,
                         const RunContext& context)
    : nodes_(shared.nodes()) {
  const RunScope scope(context);
  const std::string stage = "comparing the finish";
  context.progress(stage, 0);
  const std::vector<Target>& nodes = nodes_.nodes();
  std::vector<std::uint8_t> has_film(nodes.size());
  parallel_for(nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) has_film[i] = finish.has_film_at(nodes[i].point);
  });
  const std::vector<std::vector<std::int32_t>> around = patches(nodes_, has_film);

  const auto errors = [&](const Vec2& off) {
    std::vector<LinearColor> wanted(nodes.size()), predicted(nodes.size());
    parallel_for(nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!has_film[i]) continue;
        wanted[i] = finish.paint().color_at(nodes[i].point);
        predicted[i] = finish.color_at(nodes[i].point, off);
      }
    });
    std::vector<float> error(nodes.size(), -1);
    parallel_for(nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!has_film[i]) continue;
        MeanColor a, b;
        for (const std::int32_t j : around[i]) {
          a.add(wanted[std::size_t(j)]);
          b.add(predicted[std::size_t(j)]);
        }
        error[i] = float(ciede2000(a.lab(), b.lab()));
      }
    });
    return error;
  };
  error_ = errors(Vec2::Zero());

  const std::vector<std::int32_t> seam = shared.seam_nodes();
  std::vector<std::int32_t> others;
  std::vector<float> all;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (error_[i] >= 0) all.push_back(error_[i]);
    if (!std::binary_search(seam.begin(), seam.end(), std::int32_t(i)))
      others.push_back(std::int32_t(i));
  }
  films_meet_ = std::any_of(seam.begin(), seam.end(),
                            [&](std::int32_t i) { return error_[std::size_t(i)] >= 0; });
  seam_ = mean_of(seam, error_);
  other_ = mean_of(others, error_);
  context.progress(stage, 0.4);
  const std::array<Vec2, 4> directions = {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)};
  for (const Vec2& direction : directions)
    seam_off_ += mean_of(seam, errors(kOff_mm * direction)) / double(directions.size());

  for (const float e : all) colors_.error_mean += double(e) / double(all.size());
  if (!all.empty()) {
    const auto at = all.begin() + std::ptrdiff_t(kMostOf * double(all.size() - 1));
    std::nth_element(all.begin(), at, all.end());
    colors_.error_most_of = double(*at);
  }
  context.progress(stage, 1);
}

double FinishCheck::error_near(const Vec3& position, const Vec3& normal) const {
  std::vector<std::int32_t> close;
  nodes_.near(position, normal, 1.5 * nodes_.spacing(), close);
  double least = 1e300, error = 0;
  for (const std::int32_t i : close) {
    const double distance = (nodes_.nodes()[std::size_t(i)].position - position).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    error = std::max(0.0, double(error_[std::size_t(i)]));
  }
  return error;
}

}  // namespace hydrodip
