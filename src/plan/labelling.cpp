#include "plan/labelling.h"

#include <algorithm>
#include <limits>

#include "base/run_scope.h"

namespace hydrodip {
namespace {

// Minimum cut between two terminals by Dinic's algorithm (E. A. Dinic, "Algorithm for solution of a
// problem of maximum flow in networks with power estimation", 1970).
class Cut {
 public:
  explicit Cut(std::size_t nodes)
      : first_(nodes + 2, -1), source_(int(nodes)), sink_(int(nodes) + 1) {}

  void to_source(int node, std::int64_t capacity) { join(source_, node, capacity, 0); }
  void to_sink(int node, std::int64_t capacity) { join(node, sink_, capacity, 0); }
  void join(int a, int b, std::int64_t forth, std::int64_t back) {
    if (forth == 0 && back == 0) return;
    add(a, b, forth);
    add(b, a, back);
  }

  // Per node: whether it stays with the source.
  std::vector<std::uint8_t> run() {
    while (find_levels()) {
      check_cancelled();
      next_ = first_;
      push_paths();
    }
    std::vector<std::uint8_t> with_source;
    for (std::size_t v = 0; v + 2 < first_.size(); ++v) with_source.push_back(level_[v] >= 0);
    return with_source;
  }

 private:
  struct Arc {
    int to, next;
    std::int64_t left;
  };

  void add(int from, int to, std::int64_t capacity) {
    arcs_.push_back({to, first_[std::size_t(from)], capacity});
    first_[std::size_t(from)] = int(arcs_.size()) - 1;
  }

  // Breadth first, by arcs that are not full.
  bool find_levels() {
    level_.assign(first_.size(), -1);
    level_[std::size_t(source_)] = 0;
    queue_.assign(1, source_);
    for (std::size_t i = 0; i < queue_.size(); ++i)
      for (int a = first_[std::size_t(queue_[i])]; a >= 0; a = arcs_[std::size_t(a)].next) {
        const Arc& arc = arcs_[std::size_t(a)];
        if (arc.left == 0 || level_[std::size_t(arc.to)] >= 0) continue;
        level_[std::size_t(arc.to)] = level_[std::size_t(queue_[i])] + 1;
        queue_.push_back(arc.to);
      }
    return level_[std::size_t(sink_)] >= 0;
  }

  // As much flow as goes, path by path and level by level.
  void push_paths() {
    path_.clear();
    for (int at = source_;;) {
      int& a = next_[std::size_t(at)];
      while (a >= 0 && !leads_on(at, a)) a = arcs_[std::size_t(a)].next;
      if (a >= 0) {
        path_.push_back(a);
        at = arcs_[std::size_t(a)].to;
        if (at == sink_) at = fill();
        continue;
      }
      if (path_.empty()) return;
      // A dead end: back, and never this way again.
      const int back = path_.back();
      path_.pop_back();
      at = arcs_[std::size_t(back ^ 1)].to;
      next_[std::size_t(at)] = arcs_[std::size_t(back)].next;
    }
  }

  // As much flow on the path as it takes; back to where its first full arc begins.
  int fill() {
    std::int64_t flow = std::numeric_limits<std::int64_t>::max();
    for (const int a : path_) flow = std::min(flow, arcs_[std::size_t(a)].left);
    for (const int a : path_) {
      arcs_[std::size_t(a)].left -= flow;
      arcs_[std::size_t(a ^ 1)].left += flow;
    }
    const auto full = std::find_if(path_.begin(), path_.end(),
                                   [&](int a) { return arcs_[std::size_t(a)].left == 0; });
    const int at = arcs_[std::size_t(*full ^ 1)].to;
    path_.erase(full, path_.end());
    return at;
  }

  bool leads_on(int from, int a) const {
    const Arc& arc = arcs_[std::size_t(a)];
    return arc.left > 0 && level_[std::size_t(arc.to)] == level_[std::size_t(from)] + 1;
  }

  std::vector<Arc> arcs_;  // each beside its reverse
  std::vector<int> first_, next_, level_, queue_, path_;
  int source_, sink_;
};

// A node that may keep its label or take alpha has its number among those; of others it is known.
constexpr int kKeeps = -1, kTakes = -2;

// Whoever has alpha takes it. A node keeps its label, whatever others do, if alpha costs more by
// more than all its edges.
std::vector<int> undecided(int labels, const std::vector<std::int32_t>& costs,
                           const std::vector<LabelEdge>& edges,
                           const std::vector<std::uint8_t>& label, int alpha) {
  std::vector<std::int64_t> dearer(label.size());
  for (std::size_t v = 0; v < label.size(); ++v) {
    const std::int32_t* of = costs.data() + v * std::size_t(labels);
    dearer[v] = std::int64_t(of[alpha]) - of[label[v]];
  }
  for (const LabelEdge& edge : edges)
    for (const int v : {edge.a, edge.b}) dearer[std::size_t(v)] -= edge.cost;
  std::vector<int> number(label.size(), kKeeps);
  int count = 0;
  for (std::size_t v = 0; v < label.size(); ++v) {
    if (label[v] == alpha)
      number[v] = kTakes;
    else if (dearer[v] <= 0)
      number[v] = count++;
  }
  return number;
}

// Where `alpha` should take over from what is there now.
std::vector<std::uint8_t> expansion(int labels, const std::vector<std::int32_t>& costs,
                                    const std::vector<LabelEdge>& edges,
                                    const std::vector<std::uint8_t>& label, int alpha) {
  const std::vector<int> number = undecided(labels, costs, edges, label, alpha);
  // A node with the source keeps its label, one with the sink takes alpha.
  std::vector<std::int64_t> keeps, takes;
  for (std::size_t v = 0; v < label.size(); ++v) {
    if (number[v] < 0) continue;
    keeps.push_back(costs[v * std::size_t(labels) + label[v]]);
    takes.push_back(costs[v * std::size_t(labels) + std::size_t(alpha)]);
  }
  Cut cut(keeps.size());
  for (const LabelEdge& edge : edges) {
    const int a = number[std::size_t(edge.a)], b = number[std::size_t(edge.b)];
    if (a < 0 && b < 0) continue;
    // What the pair costs; nothing if both take.
    const auto cost = [&](bool a_takes, bool b_takes) -> std::int64_t {
      const int at_a = a_takes ? alpha : int(label[std::size_t(edge.a)]);
      const int at_b = b_takes ? alpha : int(label[std::size_t(edge.b)]);
      return at_a != at_b ? edge.cost : 0;
    };
    if (a < 0) {
      keeps[std::size_t(b)] += cost(a == kTakes, false);
      takes[std::size_t(b)] += cost(a == kTakes, true);
    } else if (b < 0) {
      keeps[std::size_t(a)] += cost(false, b == kTakes);
      takes[std::size_t(a)] += cost(true, b == kTakes);
    } else {
      // As costs of the nodes alone, and a cut between them (V. Kolmogorov, R. Zabih, "What energy
      // functions can be minimized via graph cuts?", 2004).
      keeps[std::size_t(a)] += cost(false, false);
      takes[std::size_t(a)] += cost(true, false);
      takes[std::size_t(b)] -= cost(true, false);
      cut.join(a, b, cost(true, false) + cost(false, true) - cost(false, false), 0);
    }
  }
  for (std::size_t v = 0; v < keeps.size(); ++v) {
    const std::int64_t least = std::min(keeps[v], takes[v]);
    cut.to_source(int(v), takes[v] - least);
    cut.to_sink(int(v), keeps[v] - least);
  }
  std::vector<std::uint8_t> changed = label;
  const std::vector<std::uint8_t> keep = cut.run();
  for (std::size_t v = 0; v < label.size(); ++v)
    if (number[v] >= 0 && !keep[std::size_t(number[v])]) changed[v] = std::uint8_t(alpha);
  return changed;
}

}  // namespace

std::int64_t cost_of_labels(int labels, const std::vector<std::int32_t>& costs,
                            const std::vector<LabelEdge>& edges,
                            const std::vector<std::uint8_t>& label) {
  std::int64_t sum = 0;
  for (std::size_t v = 0; v < label.size(); ++v) sum += costs[v * std::size_t(labels) + label[v]];
  for (const LabelEdge& edge : edges)
    if (label[std::size_t(edge.a)] != label[std::size_t(edge.b)]) sum += edge.cost;
  return sum;
}

std::vector<std::uint8_t> best_labels(int labels, const std::vector<std::int32_t>& costs,
                                      const std::vector<LabelEdge>& edges,
                                      std::vector<std::uint8_t> start) {
  constexpr int kMostSweeps = 4;
  std::vector<std::uint8_t> label = std::move(start);
  std::int64_t cost = cost_of_labels(labels, costs, edges, label);
  // Labels that nothing would gain by, one after another.
  int in_vain = 0;
  for (int turn = 0; turn < kMostSweeps * labels && in_vain < labels; ++turn) {
    const int alpha = turn % labels;
    std::vector<std::uint8_t> changed = expansion(labels, costs, edges, label, alpha);
    const std::int64_t now = cost_of_labels(labels, costs, edges, changed);
    ++in_vain;
    if (now >= cost) continue;
    in_vain = 1;  // itself has all that it can gain
    cost = now;
    label = std::move(changed);
  }
  return label;
}

}  // namespace hydrodip
