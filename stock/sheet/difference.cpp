#include "stock/sheet/difference.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kerf::sheet {
namespace {

/// Up to here turn() is exact.
constexpr Unit kMaxUnits = Unit{1} << 30;
/// Crossings of one edge closer than this part of it may be out of order. Quotients of exact whole
/// numbers are good to 2e-16.
constexpr double kMinStep = 1e-12;

bool in_range(const Point& p) {
  return p.X >= -kMaxUnits && p.X <= kMaxUnits && p.Y >= -kMaxUnits && p.Y <= kMaxUnits;
}

Rect box_of(const Point& a, const Point& b) {
  return {std::min(a.X, b.X), std::min(a.Y, b.Y), std::max(a.X, b.X), std::max(a.Y, b.Y)};
}

Unit between(Unit from, Unit to, double share) {
  return from + std::llround(static_cast<double>(to - from) * share);
}

std::uint32_t size_of(const Ring& ring) { return static_cast<std::uint32_t>(ring.size()); }

/// Winding round p, which lies on no edge.
int winding_of(std::span<const Ring* const> rings, const Point& p) {
  int winding = 0;
  for (const Ring* const ring : rings) {
    Point a = ring->back();
    for (const Point& b : *ring) {
      if (a.Y <= p.Y && b.Y > p.Y && turn(a, b, p) > 0) ++winding;
      if (a.Y > p.Y && b.Y <= p.Y && turn(a, b, p) < 0) --winding;
      a = b;
    }
  }
  return winding;
}

/// Appends p; takes back corners that are on the line of their neighbours then.
void append_corner(const Point& p, Ring& ring) {
  while (!ring.empty()) {
    if (ring.back() == p) return;
    if (ring.size() < 2 || turn(ring[ring.size() - 2], ring.back(), p) != 0) break;
    ring.pop_back();
  }
  ring.push_back(p);
}

/// The same where the chain closes.
void close_ring(Ring& ring) {
  std::size_t begin = 0;
  for (bool changed = true; changed && ring.size() - begin >= 3;) {
    const std::size_t n = ring.size();
    changed = true;
    if (ring[n - 1] == ring[begin] || turn(ring[n - 2], ring[n - 1], ring[begin]) == 0) {
      ring.pop_back();
    } else if (turn(ring[n - 1], ring[begin], ring[begin + 1]) == 0) {
      ++begin;
    } else {
      changed = false;
    }
  }
  ring.erase(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(begin));
}

}  // namespace

bool Difference::subtract(std::span<const Ring* const> subject, const Rings& kerf,
                          const Rect& window) {
  crossings_.clear();
  fresh_.clear();
  has_fresh_outer_ = false;
  crossed_subject_.assign(subject.size(), 0);
  crossed_kerf_.assign(kerf.size(), 0);
  untouched_.assign(subject.size(), 0);
  if (!gather_kerf(kerf, window)) return false;
  for (std::uint32_t i = 0; i < subject.size(); ++i) {
    if (!cross_ring(*subject[i], i)) return false;
  }
  if (!link()) return false;
  trace(subject, kerf);
  add_whole_rings(subject, kerf);
  return true;
}

bool Difference::gather_kerf(const Rings& kerf, const Rect& window) {
  edges_.clear();
  chunks_.clear();
  reach_ = {};
  for (std::uint32_t r = 0; r < kerf.size(); ++r) {
    const Ring& ring = kerf[r];
    for (std::uint32_t i = 0; i < ring.size(); ++i) {
      const Point &a = ring[i], &b = ring[i + 1 == ring.size() ? 0 : i + 1];
      const Rect box = box_of(a, b);
      if (!box.meets(window)) continue;
      if (!in_range(a) || !in_range(b)) return false;
      if (edges_.size() % kChunk == 0) chunks_.emplace_back();
      chunks_.back().extend(box);
      edges_.push_back({a, b, r, i});
    }
  }
  for (const Rect& chunk : chunks_) reach_.extend(chunk);
  return true;
}

bool Difference::cross_ring(const Ring& ring, std::uint32_t number) {
  for (std::uint32_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = ring[i + 1 == ring.size() ? 0 : i + 1];
    const Rect box = box_of(a, b);
    if (!box.meets(reach_)) continue;
    if (!in_range(a) || !in_range(b)) return false;
    for (std::size_t c = 0; c < chunks_.size(); ++c) {
      if (!box.meets(chunks_[c])) continue;
      const std::size_t end = std::min(edges_.size(), (c + 1) * kChunk);
      for (std::size_t e = c * kChunk; e < end; ++e) {
        if (box.meets(box_of(edges_[e].a, edges_[e].b)) && !cross_edge(a, b, edges_[e], number, i))
          return false;
      }
    }
  }
  return true;
}

bool Difference::cross_edge(const Point& a, const Point& b, const Edge& edge, std::uint32_t ring,
                            std::uint32_t index) {
  const std::int64_t from = turn(edge.a, edge.b, a), to = turn(edge.a, edge.b, b);
  if ((from > 0 && to > 0) || (from < 0 && to < 0)) return true;
  const std::int64_t low = turn(a, b, edge.a), high = turn(a, b, edge.b);
  if ((low > 0 && high > 0) || (low < 0 && high < 0)) return true;
  if (from == 0 || to == 0 || low == 0 || high == 0) return false;
  Crossing crossing;
  // Differences of numbers of opposite sign: in doubles, as they may pass 2^63.
  crossing.along_subject =
      static_cast<double>(from) / (static_cast<double>(from) - static_cast<double>(to));
  crossing.along_kerf =
      static_cast<double>(low) / (static_cast<double>(low) - static_cast<double>(high));
  // Along a tile's border only the kerf's edge tells where: the same in the tile beyond.
  if (a.X == b.X) {
    const double share =
        static_cast<double>(a.X - edge.a.X) / static_cast<double>(edge.b.X - edge.a.X);
    crossing.at = {a.X, between(edge.a.Y, edge.b.Y, share)};
  } else if (a.Y == b.Y) {
    const double share =
        static_cast<double>(a.Y - edge.a.Y) / static_cast<double>(edge.b.Y - edge.a.Y);
    crossing.at = {between(edge.a.X, edge.b.X, share), a.Y};
  } else {
    crossing.at = {between(a.X, b.X, crossing.along_subject),
                   between(a.Y, b.Y, crossing.along_subject)};
  }
  crossing.subject_ring = ring;
  crossing.subject_edge = index;
  crossing.kerf_ring = edge.ring;
  crossing.kerf_edge = edge.index;
  crossing.subject_enters = to > 0;
  crossings_.push_back(crossing);
  return true;
}

bool Difference::link() {
  // Of either kind of ring: sorts, then joins each crossing to the one after it on its ring. In and
  // out take turns unless the region is not one.
  const auto join = [&](auto ring_of, auto edge_of, auto along, auto&& store) {
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t l, std::uint32_t r) {
      const Crossing &x = crossings_[l], &y = crossings_[r];
      if (ring_of(x) != ring_of(y)) return ring_of(x) < ring_of(y);
      if (edge_of(x) != edge_of(y)) return edge_of(x) < edge_of(y);
      return along(x) < along(y);
    });
    for (std::size_t begin = 0; begin < order_.size();) {
      std::size_t end = begin;
      const std::uint32_t ring = ring_of(crossings_[order_[begin]]);
      while (end < order_.size() && ring_of(crossings_[order_[end]]) == ring) ++end;
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t after = i + 1 == end ? begin : i + 1;
        const Crossing &x = crossings_[order_[i]], &y = crossings_[order_[after]];
        if (x.subject_enters == y.subject_enters) return false;
        if (after > i && edge_of(x) == edge_of(y) && along(y) - along(x) < kMinStep) return false;
        store(order_[i], order_[after]);
      }
      begin = end;
    }
    return true;
  };
  order_.resize(crossings_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  return join([](const Crossing& c) { return c.subject_ring; },
              [](const Crossing& c) { return c.subject_edge; },
              [](const Crossing& c) { return c.along_subject; },
              [&](std::uint32_t x, std::uint32_t y) { crossings_[x].next = y; }) &&
         join([](const Crossing& c) { return c.kerf_ring; },
              [](const Crossing& c) { return c.kerf_edge; },
              [](const Crossing& c) { return c.along_kerf; },
              [&](std::uint32_t x, std::uint32_t y) { crossings_[y].previous = x; });
}

void Difference::trace(std::span<const Ring* const> subject, const Rings& kerf) {
  for (Crossing& start : crossings_) {
    crossed_subject_[start.subject_ring] = 1;
    crossed_kerf_[start.kerf_ring] = 1;
    if (start.subject_enters || start.done) continue;
    ring_.clear();
    for (Crossing* at = &start; !at->done;) {
      at->done = true;
      append_corner(at->at, ring_);
      const Crossing& entry = crossings_[at->next];
      const Ring& outer = *subject[at->subject_ring];
      const bool same_edge =
          entry.subject_edge == at->subject_edge && entry.along_subject > at->along_subject;
      if (!same_edge) {
        std::uint32_t i = at->subject_edge;
        do {
          i = i + 1 == size_of(outer) ? 0 : i + 1;
          append_corner(outer[i], ring_);
        } while (i != entry.subject_edge);
      }
      append_corner(entry.at, ring_);
      Crossing& exit = crossings_[entry.previous];
      const Ring& back = kerf[entry.kerf_ring];
      if (exit.kerf_edge != entry.kerf_edge || exit.along_kerf > entry.along_kerf) {
        std::uint32_t i = entry.kerf_edge;
        do {
          append_corner(back[i], ring_);
          i = i == 0 ? size_of(back) - 1 : i - 1;
        } while (i != exit.kerf_edge);
      }
      at = &exit;
    }
    emit();
  }
}

void Difference::add_whole_rings(std::span<const Ring* const> subject, const Rings& kerf) {
  for (std::size_t i = 0; i < subject.size(); ++i)
    untouched_[i] = !crossed_subject_[i] && winding_number(kerf, subject[i]->front()) == 0;
  for (std::size_t i = 0; i < kerf.size(); ++i) {
    if (crossed_kerf_[i] || !in_range(kerf[i].front()) || winding_of(subject, kerf[i].front()) == 0)
      continue;
    ring_.clear();
    for (std::size_t k = kerf[i].size(); k-- > 0;) append_corner(kerf[i][k], ring_);
    emit();
  }
}

void Difference::emit() {
  close_ring(ring_);
  if (ring_.size() < 3) return;
  has_fresh_outer_ |= twice_area(ring_) > 0;
  fresh_.push_back(ring_);
}

}  // namespace kerf::sheet
