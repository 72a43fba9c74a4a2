#include "stock/turning/convex_cut.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/portable_math.h"

namespace kerf::turning {
namespace {

Rect box_of(const Point& a, const Point& b) {
  return {std::min(a.X, b.X), std::min(a.Y, b.Y), std::max(a.X, b.X), std::max(a.Y, b.Y)};
}

Unit between(Unit from, Unit to, double share) {
  return from + std::llround(static_cast<double>(to - from) * share);
}

/// Sign of a/b - c/d, where b and d are positive.
int compare_quotients(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
  const Wide left = static_cast<Wide>(a) * d, right = static_cast<Wide>(c) * b;
  return left < right ? -1 : left > right ? 1 : 0;
}

/// Whether the tool's top is in material. It lies on nothing: where it seems to, it is higher.
bool holds_top(std::span<const Contour> region, const ConvexRegion& tool) {
  const Point p = tool.corner(tool.top());
  bool inside = false;
  const auto pass = [&](const Point& a, const Point& b) {
    if ((a.Y > p.Y) == (b.Y > p.Y)) return;
    if (tool.is_left(a, b, turn(a, b, p)) == (b.Y > a.Y)) inside = !inside;
  };
  for (const Contour& contour : region) {
    if (!contour.box().holds(p)) continue;
    for (std::size_t r = 0; r < contour.runs().size(); ++r) {
      const Run& run = *contour.runs()[r];
      if (run.box.min_y <= p.Y && run.box.max_y >= p.Y) {
        for (std::size_t i = 1; i < run.points.size(); ++i) pass(run.points[i - 1], run.points[i]);
      }
      const std::size_t next = r + 1 == contour.runs().size() ? 0 : r + 1;
      pass(run.points.back(), contour.runs()[next]->points.front());
    }
  }
  return inside;
}

struct PointSink {
  std::vector<Point>& points;
  void append(const Run& run, std::size_t i) { points.push_back(run.points[i]); }
  void append(const RunPointer& run) {
    points.insert(points.end(), run->points.begin(), run->points.end());
  }
};

}  // namespace

/// Of what is left: corners of the region, of its contours whole runs, and of the tool, from where
/// the region goes in to where it comes out.
class ConvexCut::PlainSink {
 public:
  explicit PlainSink(ConvexCut& cut) : builder_(cut.builder_) {}
  void append(const Run& run, std::size_t i) { builder_.append(run.points[i]); }
  void append(const RunPointer& run) { builder_.append(run); }
  void leave_tool(const Crossing& at, const Contour&) { builder_.append(at.at); }
  void enter_tool(const Point& p) { builder_.append(p); }
  void follow_tool(const Point& p) { builder_.append(p); }
  void close(const Point&) {}
  void append_ring(std::span<const Point> ring) {
    for (const Point& p : ring) builder_.append(p);
  }

 private:
  ContourBuilder& builder_;
};

class ConvexCut::MarkedSink {
 public:
  MarkedSink(ConvexCut& cut, std::uint32_t mark) : cut_(cut), mark_(mark) {}
  void append(const Run& run, std::size_t i) { cut_.builder_.append(run.points[i], run.marks[i]); }
  void append(const RunPointer& run) { cut_.builder_.append(run); }
  void leave_tool(const Crossing& at, const Contour& contour) {
    if (on_tool_) follow_tool(at.at);
    on_tool_ = false;
    cut_.builder_.append(at.at, contour.runs()[at.run]->marks[at.index]);
  }
  void enter_tool(const Point& p) {
    last_ = p;
    on_tool_ = true;
  }
  void follow_tool(const Point& p) {
    cut_.append_marked(last_, p, mark_);
    last_ = p;
  }
  /// Behind the last edge of a contour, which ends where it began.
  void close(const Point& begin) {
    if (on_tool_) follow_tool(begin);
    on_tool_ = false;
  }
  void append_ring(std::span<const Point> ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      cut_.append_marked(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1], mark_);
  }

 private:
  ConvexCut& cut_;
  std::uint32_t mark_;
  Point last_;
  bool on_tool_ = false;
};

std::span<const Point> ConvexCut::removed(std::size_t i) const {
  const std::size_t begin = i == 0 ? 0 : removed_ends_[i - 1];
  return std::span(removed_).subspan(begin, removed_ends_[i] - begin);
}

void ConvexCut::add_removed(std::span<const Point> ring) {
  removed_.insert(removed_.end(), ring.begin(), ring.end());
  removed_ends_.push_back(removed_.size());
}

bool ConvexCut::look(std::span<const Contour> region, const ConvexRegion& tool) {
  crossings_.clear();
  first_.clear();
  removed_.clear();
  removed_ends_.clear();
  drowned_ = by_library_ = false;
  changed_ = {};
  if (tool.empty()) return false;
  for (std::uint32_t i = 0; i < region.size(); ++i) {
    first_.push_back(static_cast<std::uint32_t>(crossings_.size()));
    if (region[i].box().meets(tool.box())) look_at(region[i], i, tool);
  }
  first_.push_back(static_cast<std::uint32_t>(crossings_.size()));
  tool_.assign(tool.corners().begin(), tool.corners().end());
  const bool swallows = swallow(region, tool);
  if (crossings_.empty()) {
    drowned_ = holds_top(region, tool);
    if (drowned_) add_removed(tool.corners());
    if (!drowned_ && !swallows) return false;
  } else if (sort_along_tool()) {
    trace_removed(region, tool);
  } else {
    look_by_library(region, tool);
  }
  for (const Point& p : removed_) changed_.extend(p);
  return removes_area();
}

bool ConvexCut::removes_area() const {
  for (std::size_t i = 0; i < removed_count(); ++i) {
    if (twice_area(removed(i)) != 0) return true;
  }
  return false;
}

bool ConvexCut::swallow(std::span<const Contour> region, const ConvexRegion& tool) {
  bool any = false;
  swallowed_.assign(region.size(), 0);
  for (std::size_t i = 0; i < region.size(); ++i) {
    if (first_[i] != first_[i + 1] || !tool.holds(region[i].runs()[0]->points[0])) continue;
    swallowed_[i] = 1;
    any = true;
    if (region[i].is_outer()) add_removed(region[i].ring());
  }
  return any;
}

void ConvexCut::look_at(const Contour& contour, std::uint32_t number, const ConvexRegion& tool) {
  Crossing place;
  place.contour = number;
  const std::vector<RunPointer>& runs = contour.runs();
  for (std::uint32_t r = 0; r < runs.size(); ++r) {
    const std::vector<Point>& points = runs[r]->points;
    const auto n = static_cast<std::uint32_t>(points.size());
    place.run = r;
    if (runs[r]->box.meets(tool.box())) {
      for (place.index = 0; place.index + 1 < n; ++place.index)
        cross(points[place.index], points[place.index + 1], tool, place);
    }
    place.index = n - 1;
    cross(points.back(), runs[r + 1 == runs.size() ? 0 : r + 1]->points.front(), tool, place);
  }
}

void ConvexCut::cross(const Point& a, const Point& b, const ConvexRegion& tool,
                      const Crossing& place) {
  const Rect box = box_of(a, b);
  if (!box.meets(tool.box())) return;
  const std::size_t before = crossings_.size();
  const auto cross_edge = [&](std::size_t e) {
    const Point &p = tool.corner(e), &q = tool.after(e);
    if (!box.meets(box_of(p, q))) return;
    const std::int64_t from = turn(p, q, a), to = turn(p, q, b);
    if ((from >= 0) == (to >= 0)) return;
    const std::int64_t low = turn(a, b, p), high = turn(a, b, q);
    if (tool.is_left(a, b, low) == tool.is_left(a, b, high)) return;
    Crossing& crossing = crossings_.emplace_back(place);
    crossing.edge = static_cast<std::uint32_t>(e);
    crossing.enters = to >= 0;
    const double along =
        static_cast<double>(from) / (static_cast<double>(from) - static_cast<double>(to));
    crossing.at = {between(a.X, b.X, along), between(a.Y, b.Y, along)};
    // With a positive denominator.
    const int sign = low - high > 0 ? 1 : -1;
    crossing.share = sign * low;
    crossing.whole = sign * (low - high);
    // Outward along S, as the tool would become larger.
    const int out = crossing.enters ? -1 : 1;
    const Unit x = (b.X - a.X) * out, y = (b.Y - a.Y) * out;
    crossing.sideways = x * (q.X - p.X) + y * (q.Y - p.Y);
    crossing.across = x * (q.Y - p.Y) - y * (q.X - p.X);
    if (a.X != b.X && a.Y != b.Y) changed_.extend(box);
  };
  lower_hint_ = tool.first_lower(box.min_x, lower_hint_);
  for (std::size_t e = lower_hint_; e < tool.rightmost() && tool.corner(e).X <= box.max_x; ++e)
    cross_edge(e);
  upper_hint_ = tool.first_upper(box.max_x, upper_hint_);
  for (std::size_t e = upper_hint_; e < tool.corners().size() && tool.corner(e).X >= box.min_x; ++e)
    cross_edge(e);
  // A line goes into something convex once, and then out.
  if (crossings_.size() == before + 2 && !crossings_[before].enters)
    std::swap(crossings_[before], crossings_[before + 1]);
}

bool ConvexCut::sort_along_tool() {
  order_.resize(crossings_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  const auto compare = [&](std::uint32_t l, std::uint32_t r) {
    const Crossing &x = crossings_[l], &y = crossings_[r];
    if (x.edge != y.edge) return x.edge < y.edge ? -1 : 1;
    if (const int c = compare_quotients(x.share, x.whole, y.share, y.whole); c != 0) return c;
    return compare_quotients(x.sideways, x.across, y.sideways, y.across);
  };
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t l, std::uint32_t r) { return compare(l, r) < 0; });
  // In and out take turns unless the region crosses itself.
  for (std::size_t i = 0; i < order_.size(); ++i) {
    crossings_[order_[i]].rank = static_cast<std::uint32_t>(i);
    const std::uint32_t before = order_[i == 0 ? order_.size() - 1 : i - 1];
    if (crossings_[before].enters == crossings_[order_[i]].enters) return false;
    if (i > 0 && compare(before, order_[i]) == 0) return false;
  }
  return true;
}

std::uint32_t ConvexCut::next_on_region(std::uint32_t crossing) const {
  const std::uint32_t contour = crossings_[crossing].contour;
  return crossing + 1 == first_[contour + 1] ? first_[contour] : crossing + 1;
}
std::uint32_t ConvexCut::next_on_tool(std::uint32_t crossing) const {
  const std::size_t rank = crossings_[crossing].rank + 1;
  return order_[rank == order_.size() ? 0 : rank];
}
std::uint32_t ConvexCut::previous_on_tool(std::uint32_t crossing) const {
  const std::size_t rank = crossings_[crossing].rank;
  return order_[rank == 0 ? order_.size() - 1 : rank - 1];
}

/// Corners behind the crossing `from`, up to `to`, which comes after it on the contour.
template <class Sink>
void ConvexCut::follow(const Contour& contour, const Crossing& from, const Crossing& to,
                       Sink& sink) const {
  const bool same_edge = from.run == to.run && from.index == to.index;
  if (same_edge && &to == &from + 1) return;
  const std::vector<RunPointer>& runs = contour.runs();
  std::size_t run = from.run, index = from.index + 1u;
  const auto append = [&](const RunPointer& part, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sink.append(*part, i);
  };
  const bool stays = to.run == from.run && to.index > from.index;
  if (!stays) {
    append(runs[run], index, runs[run]->points.size());
    index = 0;
    for (run = run + 1 == runs.size() ? 0 : run + 1; run != to.run;
         run = run + 1 == runs.size() ? 0 : run + 1)
      sink.append(runs[run]);
  }
  append(runs[run], index, to.index + 1u);
}

void ConvexCut::trace_removed(std::span<const Contour> region, const ConvexRegion& tool) {
  const auto n = static_cast<std::uint32_t>(tool.corners().size());
  PointSink sink{removed_};
  for (Crossing& start : crossings_) {
    if (!start.enters || start.done) continue;
    for (Crossing* at = &start; !at->done;) {
      at->done = true;
      removed_.push_back(at->at);
      const auto number = static_cast<std::uint32_t>(at - crossings_.data());
      const std::uint32_t leaves = next_on_region(number);
      const Crossing& out = crossings_[leaves];
      follow(region[at->contour], *at, out, sink);
      removed_.push_back(out.at);
      at = &crossings_[next_on_tool(leaves)];
      if (out.edge == at->edge && out.rank < at->rank) continue;
      std::uint32_t corner = out.edge;
      do {
        corner = corner + 1 == n ? 0 : corner + 1;
        removed_.push_back(tool.corner(corner));
      } while (corner != at->edge);
    }
    removed_ends_.push_back(removed_.size());
  }
}

template <class Sink>
void ConvexCut::trace_rest(std::span<const Contour> region, Sink& sink,
                           std::vector<Contour>& fresh) {
  const auto n = static_cast<std::uint32_t>(tool_.size());
  for (Crossing& crossing : crossings_) crossing.done = false;
  for (Crossing& start : crossings_) {
    if (start.enters || start.done) continue;
    for (Crossing* at = &start; !at->done;) {
      at->done = true;
      sink.leave_tool(*at, region[at->contour]);
      const auto number = static_cast<std::uint32_t>(at - crossings_.data());
      const std::uint32_t enters = next_on_region(number);
      const Crossing& in = crossings_[enters];
      follow(region[at->contour], *at, in, sink);
      sink.enter_tool(in.at);
      at = &crossings_[previous_on_tool(enters)];
      if (in.edge == at->edge && at->rank < in.rank) continue;
      std::uint32_t corner = in.edge;
      do {
        sink.follow_tool(tool_[corner]);
        corner = corner == 0 ? n - 1 : corner - 1;
      } while (corner != at->edge);
    }
    sink.close(start.at);
    fresh.push_back(builder_.close());
  }
}

void ConvexCut::look_by_library(std::span<const Contour> region, const ConvexRegion& tool) {
  ++library_calls_;
  by_library_ = true;
  // All of them: a contour that crosses another may do so anywhere.
  ClipperLib::Clipper clipper;
  for (const Contour& contour : region)
    clipper.AddPath(contour.ring(), ClipperLib::ptSubject, true);
  clipper.AddPath(tool.corners(), ClipperLib::ptClip, true);
  clipper.Execute(ClipperLib::ctDifference, rest_, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  Rings common;
  clipper.Execute(ClipperLib::ctIntersection, common, ClipperLib::pftNonZero,
                  ClipperLib::pftNonZero);
  removed_.clear();
  removed_ends_.clear();
  for (const Contour& contour : region) changed_.extend(contour.box());
  for (const Ring& ring : common) {
    if (twice_area(ring) > 0) add_removed(ring);
  }
}

/// Edges of the region that the tool's new ones may be: those that it takes away, and of a region
/// that the library has cut all.
void ConvexCut::gather_edges(std::span<const Contour> region) {
  edges_before_.clear();
  struct EdgeSink {
    std::vector<MarkedEdge>& edges;
    void append(const Run& run, std::size_t i) {
      edges.back().to = run.points[i];
      edges.push_back({run.points[i], run.points[i], run.marks[i]});
    }
    void append(const RunPointer& run) {
      for (std::size_t i = 0; i < run->points.size(); ++i) append(*run, i);
    }
  };
  EdgeSink sink{edges_before_};
  for (std::size_t i = 0; i < region.size(); ++i) {
    if (!by_library_ && swallowed_[i] == 0) continue;
    const Contour& contour = region[i];
    edges_before_.push_back({});
    const std::size_t first = edges_before_.size();
    for (const RunPointer& run : contour.runs()) sink.append(run);
    edges_before_.back().to = edges_before_[first].from;
    edges_before_[first - 1].to = edges_before_[first - 1].from;  // none
  }
  if (by_library_) return;
  for (std::uint32_t i = 0; i < crossings_.size(); ++i) {
    const Crossing& in = crossings_[i];
    if (!in.enters) continue;
    const Contour& contour = region[in.contour];
    const Crossing& out = crossings_[next_on_region(i)];
    edges_before_.push_back({in.at, in.at, contour.runs()[in.run]->marks[in.index]});
    follow(contour, in, out, sink);
    edges_before_.back().to = out.at;
  }
}

/// An edge, without its end, in pieces where some of it was there before.
void ConvexCut::append_marked(const Point& from, const Point& to, std::uint32_t mark) {
  const auto vector = [](const Point& a, const Point& b) {
    return Vec2(static_cast<double>(b.X - a.X), static_cast<double>(b.Y - a.Y));
  };
  if (from == to) return;
  const Vec2 way = vector(from, to);
  const double length = portable::hypot(way.x, way.y);
  kept_.clear();
  for (const MarkedEdge& edge : edges_before_) {
    constexpr auto kNear = static_cast<Unit>(kSame);
    Rect near = box_of(edge.from, edge.to);
    near = {near.min_x - kNear, near.min_y - kNear, near.max_x + kNear, near.max_y + kNear};
    if (!near.meets(box_of(from, to))) continue;
    const Vec2 p = vector(from, edge.from), other = vector(edge.from, edge.to);
    const double other_length = portable::hypot(other.x, other.y);
    const double begin = (p.x * way.x + p.y * way.y) / length;
    const double end = begin + (other.x * way.x + other.y * way.y) / length;
    KeptPiece piece{std::max(begin, 0.0), std::min(end, length), edge.mark};
    if (piece.high - piece.low <= 2 * kSame) continue;
    const auto off = [&](double along) {
      const Vec2 q = along / length * way - p;
      return std::abs(other.x * q.y - other.y * q.x) / other_length;
    };
    if (off(piece.low) <= kSame && off(piece.high) <= kSame) kept_.push_back(piece);
  }
  std::sort(kept_.begin(), kept_.end(),
            [](const KeptPiece& a, const KeptPiece& b) { return a.low < b.low; });
  const auto place = [&](double along) {
    return Point{between(from.X, to.X, along / length), between(from.Y, to.Y, along / length)};
  };
  double done = 0;
  const auto append = [&](double until, std::uint32_t with) {
    if (until - done <= 2 * kSame) return;
    builder_.append(place(done), with);
    done = until;
  };
  for (const KeptPiece& piece : kept_) {
    append(piece.low, mark);
    append(piece.high, piece.mark);
  }
  if (done == 0 || length - done > 2 * kSame) builder_.append(place(done), mark);
}

template <class Sink>
void ConvexCut::apply_by(std::vector<Contour>& region, Sink& sink) {
  std::vector<Contour> fresh;
  if (by_library_) {
    region.clear();
    for (const Ring& ring : rest_) {
      sink.append_ring(ring);
      fresh.push_back(builder_.close());
    }
  } else {
    trace_rest(region, sink, fresh);
    if (drowned_) {
      std::reverse(tool_.begin(), tool_.end());
      sink.append_ring(tool_);
      fresh.push_back(builder_.close());
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < region.size(); ++i) {
      if (swallowed_[i] != 0 || first_[i] != first_[i + 1]) continue;
      if (kept != i) region[kept] = std::move(region[i]);
      ++kept;
    }
    region.resize(kept);
  }
  for (Contour& contour : fresh) {
    if (contour.runs().empty() || (contour.is_outer() && contour.is_thinner(kFilm))) continue;
    region.push_back(std::move(contour));
  }
}

void ConvexCut::apply(std::vector<Contour>& region) {
  PlainSink sink(*this);
  apply_by(region, sink);
}

void ConvexCut::apply(std::vector<Contour>& region, std::uint32_t mark) {
  gather_edges(region);
  MarkedSink sink(*this, mark);
  apply_by(region, sink);
}

}  // namespace kerf::turning
