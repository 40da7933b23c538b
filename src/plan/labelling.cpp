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
      while (push_path()) {
      }
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

  // One path level by level, and as much flow on it as it takes.
  bool push_path() {
    path_.clear();
    int at = source_;
    while (at != sink_) {
      int& a = next_[std::size_t(at)];
      while (a >= 0 && !leads_on(at, a)) a = arcs_[std::size_t(a)].next;
      if (a >= 0) {
        path_.push_back(a);
        at = arcs_[std::size_t(a)].to;
        continue;
      }
      if (path_.empty()) return false;
      // A dead end: back, and never this way again.
      const int back = path_.back();
      path_.pop_back();
      at = arcs_[std::size_t(back ^ 1)].to;
      next_[std::size_t(at)] = arcs_[std::size_t(back)].next;
    }
    std::int64_t flow = std::numeric_limits<std::int64_t>::max();
    for (const int a : path_) flow = std::min(flow, arcs_[std::size_t(a)].left);
    for (const int a : path_) {
      arcs_[std::size_t(a)].left -= flow;
      arcs_[std::size_t(a ^ 1)].left += flow;
    }
    return true;
  }

  bool leads_on(int from, int a) const {
    const Arc& arc = arcs_[std::size_t(a)];
    return arc.left > 0 && level_[std::size_t(arc.to)] == level_[std::size_t(from)] + 1;
  }

  std::vector<Arc> arcs_;  // each beside its reverse
  std::vector<int> first_, next_, level_, queue_, path_;
  int source_, sink_;
};

// Where `alpha` should take over from what is there now.
std::vector<std::uint8_t> expansion(int labels, const std::vector<std::int32_t>& costs,
                                    const std::vector<LabelEdge>& edges,
                                    const std::vector<std::uint8_t>& label, int alpha) {
  const std::size_t nodes = label.size();
  const auto cost = [&](std::size_t node, int of) {
    return std::int64_t(costs[node * std::size_t(labels) + std::size_t(of)]);
  };
  // A node with the source keeps its label, one with the sink takes alpha.
  std::vector<std::int64_t> keeps(nodes), takes(nodes);
  for (std::size_t v = 0; v < nodes; ++v) {
    keeps[v] = cost(v, label[v]);
    takes[v] = cost(v, alpha);
  }
  Cut cut(nodes);
  for (const LabelEdge& edge : edges) {
    const auto a = std::size_t(edge.a), b = std::size_t(edge.b);
    // What the pair costs if both keep, if only a takes, if only b takes; nothing if both do.
    const std::int64_t none = label[a] != label[b] ? edge.cost : 0;
    const std::int64_t only_a = label[b] != alpha ? edge.cost : 0;
    const std::int64_t only_b = label[a] != alpha ? edge.cost : 0;
    // As costs of the nodes alone, and a cut between them (V. Kolmogorov, R. Zabih, "What energy
    // functions can be minimized via graph cuts?", 2004).
    keeps[a] += none;
    takes[a] += only_a;
    takes[b] -= only_a;
    cut.join(edge.a, edge.b, only_a + only_b - none, 0);
  }
  for (std::size_t v = 0; v < nodes; ++v) {
    const std::int64_t least = std::min(keeps[v], takes[v]);
    cut.to_source(int(v), takes[v] - least);
    cut.to_sink(int(v), keeps[v] - least);
  }
  std::vector<std::uint8_t> changed = label;
  const std::vector<std::uint8_t> keep = cut.run();
  for (std::size_t v = 0; v < nodes; ++v)
    if (!keep[v]) changed[v] = std::uint8_t(alpha);
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
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    const std::int64_t before = cost;
    for (int alpha = 0; alpha < labels; ++alpha) {
      std::vector<std::uint8_t> changed = expansion(labels, costs, edges, label, alpha);
      const std::int64_t now = cost_of_labels(labels, costs, edges, changed);
      if (now >= cost) continue;
      cost = now;
      label = std::move(changed);
    }
    if (cost == before) break;
  }
  return label;
}

}  // namespace hydrodip
