#include "dip/foresight.h"

#include "base/parallel.h"

namespace hydrodip {

namespace {

// Of all steps together; the ones after that are not kept.
constexpr std::size_t kMostBytes = std::size_t{64} << 20;

template <typename Body>
void for_entries(const GridField& field, const Body& body) {
  parallel_for(field.entries(), FilmGrid::kVertexGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) body(n);
  });
}

}  // namespace

Foresight::Foresight(const GridLayout& layout, const GridField& flat, RelaxedSteps* steps)
    : layout_(layout), flat_(flat), steps_(steps) {
  if (steps_) further_ = GridField(layout);
}

void Foresight::foresee(double end_mm, GridField& film) {
  end_mm_ = end_mm;
  if (!steps_ || now_ >= steps_->size()) return;
  const GridVector& way = (*steps_)[now_].way;
  if ((*steps_)[now_].end_mm != end_mm || way.entries() != film.x.entries()) {
    steps_->resize(now_);
    return;
  }
  const float *const x = way.x(), *const y = way.y();
  for_entries(film, [&](std::size_t n) {
    film.x[n] = flat_.x[n] + double(x[n]) + further_.x[n];
    film.y[n] = flat_.y[n] + double(y[n]) + further_.y[n];
  });
}

void Foresight::keep(const GridField& film) {
  if (!steps_ || now_ > steps_->size()) return;
  const bool foreseen = now_ < steps_->size();
  if (!foreseen) {
    if ((now_ + 1) * 2 * sizeof(float) * film.entries() > kMostBytes) return;
    steps_->push_back({end_mm_, GridVector(layout_)});
  }
  float *const x = (*steps_)[now_].way.x(), *const y = (*steps_)[now_].way.y();
  for_entries(film, [&](std::size_t n) {
    const double way_x = film.x[n] - flat_.x[n], way_y = film.y[n] - flat_.y[n];
    further_.set(n, foreseen ? Vec2(way_x - double(x[n]), way_y - double(y[n])) : Vec2(0, 0));
    x[n] = float(way_x);
    y[n] = float(way_y);
  });
  ++now_;
}

}  // namespace hydrodip
