#include "overlay/chains.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace routebench::overlay {
namespace {

/// Counter-clockwise from straight left on.
bool turns_before(GridPoint a, GridPoint b) {
  const auto half = [](GridPoint d) { return d.y < 0 || (d.y == 0 && d.x < 0) ? 0 : 1; };
  if (half(a) != half(b)) return half(a) < half(b);
  return std::int64_t{a.x} * b.y - std::int64_t{a.y} * b.x > 0;
}

}  // namespace

ChainGraph::ChainGraph(const PlanarEdges& planar) : planar_(planar), memory_(planar.memory()) {
  if (planar.any_meets()) make_nodes();
  make_chains();
  if (node_count_ > 0) {
    merge_copies();
    sort_ends();
  }
  find_windings();
}

void ChainGraph::make_nodes() {
  struct Meeting {
    GridPoint at;
    std::uint32_t point;
  };
  std::pmr::vector<Meeting> meetings(memory_);
  for (std::uint32_t i = 0; i < planar_.size(); ++i)
    if (planar_.meets(i)) meetings.push_back({planar_.point(i), i});
  std::sort(meetings.begin(), meetings.end(),
            [](const Meeting& a, const Meeting& b) { return a.at < b.at; });
  node_of_.assign(planar_.size(), kNone);
  for (std::size_t i = 0; i < meetings.size(); ++i) {
    if (i == 0 || meetings[i].at != meetings[i - 1].at) ++node_count_;
    node_of_[meetings[i].point] = node_count_ - 1;
  }
  chains_.reserve(meetings.size() + planar_.rings());
}

void ChainGraph::make_chains() {
  chain_of_.resize(planar_.size());
  const auto is_node = [&](std::uint32_t point) {
    return node_count_ > 0 && node_of_[point] != kNone;
  };
  for (std::uint32_t ring = 0; ring < planar_.rings(); ++ring) {
    const std::uint32_t begin = planar_.first_point(ring);
    std::uint32_t start = begin;
    while (!is_node(start)) {
      start = planar_.next(start);
      if (start == begin) break;
    }
    std::uint32_t point = start;
    do {
      Chain chain;
      chain.ring = ring;
      chain.first = point;
      chain.step = planar_.winding(ring);
      do {
        chain.last = point;
        chain_of_[point] = static_cast<std::uint32_t>(chains_.size());
        point = planar_.next(point);
      } while (!is_node(point) && point != start);
      if (is_node(start)) {
        chain.from = node_of_[chain.first];
        chain.to = node_of_[point];
      }
      chains_.push_back(chain);
    } while (point != start);
  }
}

void ChainGraph::merge_copies() {
  // Edges that lie on each other meet in both ends, so each of them is a chain by itself.
  struct Single {
    std::uint32_t low, high, chain;
  };
  std::pmr::vector<Single> singles(memory_);
  singles.reserve(chains_.size());
  for (std::uint32_t c = 0; c < chains_.size(); ++c)
    if (const Chain& chain = chains_[c]; chain.first == chain.last) {
      const auto [low, high] = std::minmax(chain.from, chain.to);
      singles.push_back({low, high, c});
    }
  std::sort(singles.begin(), singles.end(), [](const Single& a, const Single& b) {
    return std::tie(a.low, a.high, a.chain) < std::tie(b.low, b.high, b.chain);
  });
  runs_back_.assign(planar_.size(), 0);
  for (std::size_t i = 1, first = 0; i < singles.size(); ++i) {
    if (std::tie(singles[i].low, singles[i].high) !=
        std::tie(singles[first].low, singles[first].high)) {
      first = i;
      continue;
    }
    Chain &original = chains_[singles[first].chain], &copy = chains_[singles[i].chain];
    const bool back = copy.from != original.from;
    original.step = back ? original.step - copy.step : original.step + copy.step;
    copy.is_copy = true;
    chain_of_[copy.first] = singles[first].chain;
    runs_back_[copy.first] = back ? 1 : 0;
  }
}

GridPoint ChainGraph::heading(ChainEnd end) const {
  const Chain& chain = chains_[end.chain];
  Edge edge = planar_.edge(end.starts ? chain.first : chain.last);
  if (!end.starts) std::swap(edge.from, edge.to);
  return {edge.to.x - edge.from.x, edge.to.y - edge.from.y};
}

void ChainGraph::sort_ends() {
  end_begin_.assign(node_count_ + 1, 0);
  const auto for_each_end = [&](auto&& visit) {
    for (std::uint32_t c = 0; c < chains_.size(); ++c) {
      if (chains_[c].is_closed() || chains_[c].is_copy) continue;
      visit(chains_[c].from, ChainEnd{c, true});
      visit(chains_[c].to, ChainEnd{c, false});
    }
  };
  for_each_end([&](std::uint32_t node, ChainEnd) { ++end_begin_[node + 1]; });
  std::partial_sum(end_begin_.begin(), end_begin_.end(), end_begin_.begin());
  ends_.resize(end_begin_.back());
  std::pmr::vector<std::uint32_t> cursor(end_begin_.begin(), end_begin_.end() - 1, memory_);
  for_each_end([&](std::uint32_t node, ChainEnd end) { ends_[cursor[node]++] = end; });
  start_place_.resize(chains_.size());
  stop_place_.resize(chains_.size());
  std::pmr::vector<std::pair<GridPoint, ChainEnd>> around(memory_);
  for (std::uint32_t node = 0; node < node_count_; ++node) {
    around.clear();
    for (std::uint32_t i = end_begin_[node]; i < end_begin_[node + 1]; ++i)
      around.emplace_back(heading(ends_[i]), ends_[i]);
    std::sort(around.begin(), around.end(),
              [](const auto& a, const auto& b) { return turns_before(a.first, b.first); });
    for (std::uint32_t i = 0; i < around.size(); ++i) {
      const ChainEnd end = around[i].second;
      ends_[end_begin_[node] + i] = end;
      (end.starts ? start_place_ : stop_place_)[end.chain] = i;
    }
  }
}

std::uint32_t ChainGraph::leftmost(const Chain& chain) const {
  std::uint32_t best = chain.first, point = chain.first;
  do {
    point = planar_.next(point);
    if (planar_.point(point) < planar_.point(best)) best = point;
  } while (point != planar_.next(chain.last));
  return best;
}

Winding ChainGraph::winding_left_of(std::uint32_t point) const {
  const std::uint32_t edge =
      planar_.first_to_the_left(planar_.point(point), [](std::uint32_t) { return true; });
  if (edge == kNone) return {};
  const Chain& chain = chains_[chain_of_[edge]];
  const bool rises = planar_.edge(edge).to.y > planar_.edge(edge).from.y;
  const bool back = !runs_back_.empty() && runs_back_[edge] != 0;
  return rises != back ? chain.right : chain.left();
}

void ChainGraph::spread(std::uint32_t node, std::uint32_t place, Winding before,
                        std::pmr::vector<std::uint8_t>& known) {
  // `before` lies clockwise of the end at `place`.
  struct Visit {
    std::uint32_t node, place;
    Winding before;
  };
  std::pmr::vector<Visit> open({{node, place, before}}, memory_);
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    const std::span<const ChainEnd> around = ends(visit.node);
    Winding winding = visit.before;
    for (std::size_t i = 0; i < around.size(); ++i) {
      const ChainEnd end = around[(visit.place + i) % around.size()];
      Chain& chain = chains_[end.chain];
      // Outwards, what comes first counter-clockwise is the right side.
      const Winding after = end.starts ? winding + chain.step : winding - chain.step;
      if (known[end.chain] == 0) {
        known[end.chain] = 1;
        chain.right = end.starts ? winding : after;
        const ChainEnd other{end.chain, !end.starts};
        open.push_back({end.starts ? chain.to : chain.from, this->place(other), after});
      }
      winding = after;
    }
  }
}

void ChainGraph::find_windings() {
  const auto at = [&](std::uint32_t i) { return planar_.point(i); };
  // Of every connected part the leftmost point.
  std::pmr::vector<std::uint32_t> part(node_count_, memory_);
  std::iota(part.begin(), part.end(), 0U);
  const auto root = [&](std::uint32_t node) {
    while (part[node] != node) node = part[node] = part[part[node]];
    return node;
  };
  for (const Chain& chain : chains_)
    if (!chain.is_closed()) part[root(chain.from)] = root(chain.to);
  struct Seed {
    std::uint32_t point, chain;
  };
  std::pmr::vector<Seed> seeds(memory_), of_part(node_count_, {kNone, kNone}, memory_);
  for (std::uint32_t c = 0; c < chains_.size(); ++c) {
    const Chain& chain = chains_[c];
    if (chain.is_copy) continue;
    const Seed seed{leftmost(chain), c};
    if (chain.is_closed()) {
      seeds.push_back(seed);
      continue;
    }
    Seed& best = of_part[root(chain.from)];
    if (best.point == kNone || at(seed.point) < at(best.point)) best = seed;
  }
  for (const Seed& seed : of_part)
    if (seed.point != kNone) seeds.push_back(seed);
  // What lies to the left of a part is a part with a point further left.
  std::sort(seeds.begin(), seeds.end(), [&](const Seed& a, const Seed& b) {
    return std::tuple(at(a.point), a.point) < std::tuple(at(b.point), b.point);
  });
  std::pmr::vector<std::uint8_t> known(chains_.size(), 0, memory_);
  for (const Seed& seed : seeds) {
    const Winding outside = seeds.size() == 1 || seed.point == seeds.front().point
                                ? Winding{}
                                : winding_left_of(seed.point);
    Chain& chain = chains_[seed.chain];
    if (node_count_ > 0 && node_of_[seed.point] != kNone) {
      spread(node_of_[seed.point], 0, outside, known);
      continue;
    }
    std::uint32_t before = chain.first;  // a closed ring's last edge comes before its first
    if (seed.point == chain.first) before = chain.last;
    while (planar_.next(before) != seed.point) before = planar_.next(before);
    const bool turns_left = turn(at(before), at(seed.point), at(planar_.next(seed.point))) > 0;
    chain.right = turns_left ? outside : outside - chain.step;
    if (!chain.is_closed()) spread(chain.from, place({seed.chain, true}), chain.right, known);
  }
}

}  // namespace routebench::overlay
