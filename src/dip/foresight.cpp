#include "dip/foresight.h"

#include "base/parallel.h"

namespace hydrodip {

namespace {

// Of all steps together; the ones after that are not kept. Taken at once, as an array so large that
// it goes back to the system afterwards; what is not written to takes no memory.
constexpr std::size_t kMostValues = (std::size_t{64} << 20) / sizeof(float);

template <typename Body>
void for_entries(std::size_t entries, const Body& body) {
  parallel_for(entries, FilmGrid::kVertexGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) body(n);
  });
}

}  // namespace

Foresight::Foresight(const GridLayout& layout, const GridField& flat, RelaxedSteps* steps)
    : flat_(flat), steps_(steps), entries_(flat.entries()), per_step_(2 * entries_) {
  if (!steps_) return;
  further_ = GridField(layout);
  steps_->ways.reserve(kMostValues);
  if (steps_->ways.size() != steps_->ends_mm.size() * per_step_) forget_from_now_on();
}

void Foresight::foresee(double end_mm, GridField& film) {
  end_mm_ = end_mm;
  if (is_known() && steps_->ends_mm[now_] != end_mm) forget_from_now_on();
  if (!is_known()) return;
  const float *const x = way(), *const y = x + entries_;
  for_entries(entries_, [&](std::size_t n) {
    film.x[n] = flat_.x[n] + double(x[n]) + further_.x[n];
    film.y[n] = flat_.y[n] + double(y[n]) + further_.y[n];
  });
}

void Foresight::keep(const GridField& film) {
  if (!steps_) return;
  const bool foreseen = is_known();
  if (!foreseen) {
    if (steps_->ways.size() + per_step_ > kMostValues) return;
    steps_->ends_mm.push_back(end_mm_);
    steps_->ways.resize(steps_->ways.size() + per_step_);
  }
  float *const x = way(), *const y = x + entries_;
  for_entries(entries_, [&](std::size_t n) {
    const double way_x = film.x[n] - flat_.x[n], way_y = film.y[n] - flat_.y[n];
    further_.set(n, foreseen ? Vec2(way_x - double(x[n]), way_y - double(y[n])) : Vec2(0, 0));
    x[n] = float(way_x);
    y[n] = float(way_y);
  });
  ++now_;
}

void Foresight::forget_from_now_on() {
  steps_->ends_mm.resize(now_);
  steps_->ways.resize(now_ * per_step_);
}

}  // namespace hydrodip
