#include "eulerian/loops.hpp"

namespace routebench::eulerian {

Loops::Loops(const Lattice& lattice)
    : lattice_(lattice), links_(lattice.size(), {kNone, kNone}), sets_(lattice.size()) {}

void Loops::replace(std::uint32_t at, std::uint32_t old_link, std::uint32_t new_link) {
  (links_[at][0] == old_link ? links_[at][0] : links_[at][1]) = new_link;
}

bool Loops::add_square(std::uint32_t node) {
  const std::uint32_t up = node + lattice_.stride();
  if (!lattice_.joined_right(node) || !lattice_.joined_right(up) || !lattice_.joined_up(node) ||
      !lattice_.joined_up(node + 1))
    return false;
  if (holds(node) || holds(node + 1) || holds(up) || holds(up + 1)) return false;
  links_[node] = {node + 1, up};
  links_[node + 1] = {up + 1, node};
  links_[up + 1] = {up, node + 1};
  links_[up] = {node, up + 1};
  for (const std::uint32_t corner : {node + 1, up, up + 1}) sets_.union_set(node, corner);
  return true;
}

bool Loops::join_across(std::uint32_t node, bool level) {
  const std::uint32_t up = node + lattice_.stride();
  // The links a-b and c-d make room for a-c and b-d.
  const std::uint32_t a = node, b = level ? up : node + 1, c = level ? node + 1 : up, d = up + 1;
  if (!linked(a, b) || !linked(c, d)) return false;
  const bool ways = level ? lattice_.joined_right(node) && lattice_.joined_right(up)
                          : lattice_.joined_up(node) && lattice_.joined_up(node + 1);
  if (!ways || same_loop(a, c)) return false;
  join(a, b, c, d);
  return true;
}

void Loops::join(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  replace(a, b, c);
  replace(b, a, d);
  replace(c, d, a);
  replace(d, c, b);
  sets_.union_set(a, c);
}

void Loops::insert(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  replace(a, b, c);
  replace(b, a, d);
  links_[c] = {a, d};
  links_[d] = {c, b};
  sets_.union_set(a, c);
  sets_.union_set(a, d);
}

void Loops::insert(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  replace(a, b, c);
  replace(b, a, c);
  links_[c] = {a, b};
  sets_.union_set(a, c);
}

std::vector<std::vector<std::uint32_t>> Loops::walks() const {
  std::vector<std::vector<std::uint32_t>> walks;
  std::vector<bool> walked(links_.size());
  for (std::uint32_t start = lattice_.first(); start < lattice_.last(); ++start) {
    if (!holds(start) || walked[start]) continue;
    std::vector<std::uint32_t>& walk = walks.emplace_back();
    std::uint32_t before = links_[start][1], here = start;
    do {
      walked[here] = true;
      walk.push_back(here);
      const std::uint32_t next = links_[here][0] == before ? links_[here][1] : links_[here][0];
      before = here;
      here = next;
    } while (here != start);
  }
  return walks;
}

}  // namespace routebench::eulerian
