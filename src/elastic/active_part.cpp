#include "elastic/active_part.h"

#include <algorithm>

#include "base/parallel.h"
#include "elastic/kernel_variants.h"

namespace hydrodip {

namespace {

// Moves below this share of the longest are left to coarser grids. Up to 0.1, dips take as many
// iterations as if everything was smoothed, those of torn film too.
constexpr float kNegligible = 0.03F;
// Smaller grids cost little anyway.
constexpr std::size_t kFewestNodes = 3000;
// What is worth a thread's while.
constexpr std::size_t kBandsPerTask = 4;

}  // namespace

ActivePart::ActivePart(const GridOperator& A)
    : rows_(A.ny()),
      groups_(A.layout().groups),
      bands_((rows_ + kRowsPerBand - 1) / kRowsPerBand),
      row_begin_(0),
      row_end_(rows_),
      smoothed_(std::size_t(bands_), Span{0, groups_}),
      reached_(smoothed_),
      squares_(std::size_t(bands_ * groups_)) {}

void ActivePart::choose(const GridOperator& A, const GridVector& b) {
  if (A.nodes() < kFewestNodes) return;
  const kernels::Stencil stencil = A.stencil();
  parallel_for(std::size_t(bands_), kBandsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) {
      const std::ptrdiff_t first = std::ptrdiff_t(band) * kRowsPerBand;
      kernels::best().largest_squares(stencil, A.rows(first, std::min(first + kRowsPerBand, rows_)),
                                      b, &squares_[band * std::size_t(groups_)]);
    }
  });
  const float largest = *std::max_element(squares_.begin(), squares_.end());
  const auto matters = [&](float square) { return square >= kNegligible * kNegligible * largest; };
  for (std::size_t band = 0; band < smoothed_.size(); ++band) {
    const auto first = squares_.begin() + std::ptrdiff_t(band) * groups_, last = first + groups_;
    const auto begin = std::find_if(first, last, matters);
    const auto end =
        std::find_if(std::make_reverse_iterator(last), std::make_reverse_iterator(begin), matters);
    smoothed_[band] = {begin - first, end.base() - first};
  }
  smoothed_ = widened(smoothed_);
  reached_ = widened(smoothed_);
  const auto any = [](const Span& span) { return span.begin < span.end; };
  row_begin_ =
      kRowsPerBand * (std::find_if(smoothed_.begin(), smoothed_.end(), any) - smoothed_.begin());
  row_end_ = std::min(
      rows_, kRowsPerBand * (std::find_if(smoothed_.rbegin(), smoothed_.rend(), any).base() -
                             smoothed_.begin()));
}

// By one group on both sides, and over the bands next to each.
std::vector<ActivePart::Span> ActivePart::widened(const std::vector<Span>& spans) const {
  std::vector<Span> wide(spans.size(), Span{groups_, 0});
  for (std::size_t band = 0; band < spans.size(); ++band) {
    const Span& span = spans[band];
    if (span.begin >= span.end) continue;
    for (std::size_t n = band > 0 ? band - 1 : 0; n < std::min(band + 2, spans.size()); ++n) {
      wide[n].begin = std::min(wide[n].begin, std::max<std::ptrdiff_t>(span.begin - 1, 0));
      wide[n].end = std::max(wide[n].end, std::min(span.end + 1, groups_));
    }
  }
  for (Span& span : wide)
    if (span.begin >= span.end) span = {};
  return wide;
}

}  // namespace hydrodip
