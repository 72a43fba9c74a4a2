// Bands of surfaces of revolution, for views.
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/portable_math.h"
#include "stock/turning/around.h"
#include "stock/turning/revolve.h"

namespace kerf::turning {
namespace {

/// Surfaces look round where they turn by less.
constexpr double kCreaseCosine = 0.866;

BandChain divided_at_flats(const BandChain& chain, const BarFlats& flats, double tolerance_mm) {
  BandChain result{{chain.points[0]}, {}};
  for (std::size_t i = 0; i < chain.marks.size(); ++i) {
    const Vec2 &a = chain.points[i], &b = chain.points[i + 1];
    const int parts = parts_at_flats(a, b, flats, tolerance_mm);
    for (int k = 1; k <= parts; ++k) {
      result.points.push_back(k == parts ? b : a + static_cast<double>(k) / parts * (b - a));
      result.marks.push_back(chain.marks[i]);
    }
  }
  return result;
}

/// Chains of a contour between two lines across the axis, in its direction; a closed one where it
/// never leaves.
class BandChains {
 public:
  BandChains(Unit low, Unit high, bool has_high_face)
      : low_(low), high_(high), has_high_face_(has_high_face) {}

  std::vector<BandChain> of(const Contour& contour) {
    chains_.clear();
    open_ = false;
    each_edge(contour,
              [this](const Point& a, const Point& b, std::uint32_t mark) { add_edge(a, b, mark); });
    // The contour's beginning may be within the band: then the last chain goes on as the first.
    if (open_ && chains_.size() > 1 &&
        chains_.back().points.back() == chains_.front().points.front()) {
      BandChain &last = chains_.back(), &first = chains_.front();
      last.points.insert(last.points.end(), first.points.begin() + 1, first.points.end());
      last.marks.insert(last.marks.end(), first.marks.begin(), first.marks.end());
      std::swap(first, last);
      chains_.pop_back();
    }
    return std::move(chains_);
  }

 private:
  void add_edge(const Point& a, const Point& b, std::uint32_t mark) {
    bool inside = false;
    if (a.X == b.X) {
      inside = a.X >= low_ && (a.X < high_ || (a.X == high_ && has_high_face_));
      if (inside) return add(to_mm(a), to_mm(b), mark, true);
    } else if (std::max(a.X, b.X) > low_ && std::min(a.X, b.X) < high_) {
      const bool leaves = b.X < low_ || b.X > high_;
      return add(clipped(a, b), clipped(b, a), mark, !leaves);
    }
    open_ = false;
  }
  /// `a`, or where the edge enters the band on the way from it. The same for either direction.
  Vec2 clipped(const Point& a, const Point& b) const {
    if (a.X >= low_ && a.X <= high_) return to_mm(a);
    const Unit border = a.X < low_ ? low_ : high_;
    const Point &left = a.X < b.X ? a : b, &right = a.X < b.X ? b : a;
    const double share =
        static_cast<double>(border - left.X) / static_cast<double>(right.X - left.X);
    return {to_mm(border), to_mm(left.Y) + share * (to_mm(right.Y) - to_mm(left.Y))};
  }
  void add(const Vec2& from, const Vec2& to, std::uint32_t mark, bool stays) {
    if (!open_) chains_.push_back({{from}, {}});
    chains_.back().points.push_back(to);
    chains_.back().marks.push_back(mark);
    open_ = stays;
  }

  Unit low_, high_;
  bool has_high_face_;
  std::vector<BandChain> chains_;
  bool open_ = false;
};

/// Out of the material, which lies to the left of the edge: along z and r.
Vec2 outward(const Vec2& a, const Vec2& b) {
  const Vec2 way = glm::normalize(b - a);
  return {way.y, -way.x};
}

/// How far the middle of a side is from its circle that takes so many of the kPatchSegments.
double off_circle_mm(double radius_mm, std::size_t step) {
  return radius_mm * (1 - portable::cos(kPi * static_cast<double>(step) / kPatchSegments));
}

/// As many as keep within twice the tolerance.
std::size_t segments_a_side(double radius_mm, double tolerance_mm) {
  std::size_t best = 1;
  for (const std::size_t step : {2, 3, 4, 5}) {
    static_assert(kPatchSegments % (2 * 2 * 3 * 5) == 0);
    if (off_circle_mm(radius_mm, step) <= 2 * tolerance_mm) best = step;
  }
  return best;
}

/// How many segments a side takes, at the corners of a chain. The ends of an open one are corners
/// of the neighbours' chains; it is from the first edge on that is long beside what the sides
/// differ by that there are fewer sides, lest the strip between is steep.
class Sides {
 public:
  Sides(const BandChain& chain, double tolerance_mm) : end_(chain.points.size()) {
    double radius_mm = 0;
    for (const Vec2& p : chain.points) radius_mm = std::max(radius_mm, p.y);
    step_ = segments_a_side(radius_mm, tolerance_mm);
    if (step_ == 1 || chain.points.front() == chain.points.back()) return;
    const double long_mm = 2 * off_circle_mm(radius_mm, step_);
    const auto is_short = [&](std::size_t edge) {
      return glm::distance(chain.points[edge], chain.points[edge + 1]) < long_mm;
    };
    const std::size_t edges = chain.points.size() - 1;
    while (begin_ < edges && is_short(begin_)) ++begin_;
    ++begin_;
    end_ = edges;
    while (end_ > begin_ && is_short(end_ - 1)) --end_;
  }
  std::size_t at(std::size_t corner) const { return corner >= begin_ && corner < end_ ? step_ : 1; }

 private:
  std::size_t step_ = 1, begin_ = 0, end_;
};

class PatchBuilder {
  static constexpr Vec2 kNowhere{-1, -1};  // r is never negative

 public:
  PatchBuilder(MeshPatch& patch, const std::optional<BarFlats>& flats, bool marked,
               double tolerance_mm)
      : patch_(patch),
        flats_(flats),
        is_marked_(marked),
        tolerance_mm_(tolerance_mm),
        around_(directions(kPatchSegments)) {
    if (flats) reach_ = reaches(kPatchSegments, *flats);
  }

  void add_chain(const BandChain& marked) {
    const std::vector<Vec2>& chain = marked.points;
    const std::size_t edges = marked.marks.size();
    const bool closed = chain.front() == chain.back();
    const Sides sides(marked, flats_ ? 0 : tolerance_mm_);
    const auto normal = [&](std::size_t i) { return outward(chain[i], chain[i + 1]); };
    const auto joint = [&](std::size_t edge, std::size_t other) {
      const Vec2 own = normal(edge), beside = normal(other);
      return glm::dot(own, beside) < kCreaseCosine ? own : glm::normalize(own + beside);
    };
    for (std::size_t i = 0; i < edges; ++i) {
      const bool has_before = i > 0 || closed, has_after = i + 1 < edges || closed;
      const Vec2 begin = has_before ? joint(i, i > 0 ? i - 1 : edges - 1) : normal(i);
      const Vec2 end = has_after ? joint(i, i + 1 < edges ? i + 1 : 0) : normal(i);
      if (chain[i].y == 0 && chain[i + 1].y == 0) continue;  // the axis
      if (marked.marks[i] != mark_) last_at_ = kNowhere;
      mark_ = marked.marks[i];
      if (flats_ && std::max(chain[i].y, chain[i + 1].y) > flats_->inner_radius_mm) {
        add_strip_with_flats(chain[i], begin, chain[i + 1], end);
        continue;
      }
      const Circle from = circle(chain[i], begin, sides.at(i)),
                   to = circle(chain[i + 1], end, sides.at(i + 1));
      add_strip_between(from, to);
    }
  }

 private:
  struct Circle {
    std::uint32_t first = 0;
    std::size_t step = 1;  ///< segments a side
  };
  /// Where one has more corners each side of the other has a fan, up to its middle from one end.
  void add_strip_between(const Circle& from, const Circle& to) {
    const auto emit = [&](std::size_t a, std::size_t b, std::size_t c) {
      triangle(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(c));
    };
    const std::size_t step = std::max(from.step, to.step), half = step / 2;
    for (std::size_t k = 0; k < kPatchSegments; k += step) {
      const std::size_t p = from.first + k / from.step, q = to.first + k / to.step;
      if (from.step == to.step) {
        emit(p, q, p + 1);
        emit(p + 1, q, q + 1);
      } else if (from.step < to.step) {
        for (std::size_t i = 0; i < step; ++i) emit(p + i, i < half ? q : q + 1, p + i + 1);
        emit(p + half, q, q + 1);
      } else {
        for (std::size_t i = 0; i < step; ++i) emit(i < half ? p : p + 1, q + i, q + i + 1);
        emit(p, q + half, p + 1);
      }
    }
  }
  /// Corners that a flat cuts off have the normal of what is there.
  void add_strip_with_flats(const Vec2& from, const Vec2& begin, const Vec2& to, const Vec2& end) {
    last_at_ = kNowhere;
    for (std::size_t k = 0; k < kPatchSegments; ++k) {
      const auto corner = [&](const Vec2& at, std::size_t i) {
        return place({at.x, std::min(at.y, reach_[i])}, around_[i]);
      };
      const std::array<glm::vec3, 4> corners{corner(from, k), corner(to, k), corner(from, k + 1),
                                             corner(to, k + 1)};
      glm::vec3 across = glm::cross(corners[3] - corners[0], corners[2] - corners[1]);
      if (glm::length(across) == 0) continue;
      across = glm::normalize(across);
      const auto first = static_cast<std::uint32_t>(patch_.vertices.size());
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t direction = k + i / 2;
        const Vec2 &at = i % 2 == 0 ? from : to, &normal = i % 2 == 0 ? begin : end;
        const bool is_cut = at.y >= reach_[direction];
        add_vertex(corners[i], is_cut ? across : place(normal, around_[direction]));
      }
      triangle(first, first + 1, first + 2);
      triangle(first + 2, first + 1, first + 3);
    }
  }
  /// The one before where it is the same.
  Circle circle(const Vec2& at, const Vec2& normal, std::size_t step) {
    if (at == last_at_ && normal == last_normal_ && step == last_circle_.step) return last_circle_;
    last_at_ = at;
    last_normal_ = normal;
    last_circle_ = {static_cast<std::uint32_t>(patch_.vertices.size()), step};
    for (std::size_t k = 0; k <= kPatchSegments; k += step)
      add_vertex(place(at, around_[k]), place(normal, around_[k]));
    return last_circle_;
  }
  void add_vertex(const glm::vec3& at, const glm::vec3& normal) {
    patch_.vertices.push_back({at, pack_normal(normal)});
    if (is_marked_) patch_.cut_by.push_back(mark_);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const glm::vec3 &p = patch_.vertices[a].position_mm, &q = patch_.vertices[b].position_mm,
                    &r = patch_.vertices[c].position_mm;
    if (p == q || q == r || r == p) return;  // at the axis
    patch_.indices.insert(patch_.indices.end(), {a, b, c});
  }

  MeshPatch& patch_;
  const std::optional<BarFlats>& flats_;
  bool is_marked_;
  double tolerance_mm_;
  std::vector<Vec2> around_;
  std::vector<double> reach_;  // along them, with flats
  Vec2 last_at_ = kNowhere, last_normal_{0};
  Circle last_circle_;
  std::uint32_t mark_ = MeshPatch::kNotCut;
};

}  // namespace

BandChain simplified_by_marks(const BandChain& chain, double tolerance_mm) {
  const double least_mm = kMarkTolerances * tolerance_mm;
  BandChain result;
  for (std::size_t begin = 0; begin < chain.marks.size();) {
    // Runs of a mark, until they are together as long as is told apart.
    double whole_mm = 0, longest_mm = -1;
    std::size_t end = begin;
    std::uint32_t mark = 0;
    do {
      const std::uint32_t next = chain.marks[end];
      double run_mm = 0;
      for (; end < chain.marks.size() && chain.marks[end] == next; ++end)
        run_mm += glm::distance(chain.points[end], chain.points[end + 1]);
      whole_mm += run_mm;
      if (run_mm > longest_mm) {
        longest_mm = run_mm;
        mark = next;
      }
    } while (end < chain.marks.size() && whole_mm < least_mm);
    const std::vector<Vec2> part =
        simplified(std::span(chain.points).subspan(begin, end - begin + 1), tolerance_mm);
    if (result.points.empty()) result.points.push_back(part.front());
    result.points.insert(result.points.end(), part.begin() + 1, part.end());
    result.marks.resize(result.points.size() - 1, mark);
    begin = end;
  }
  return result;
}

std::vector<BandChain> band_chains(const Contour& contour, Unit low_z, Unit high_z,
                                   bool has_high_face) {
  return BandChains(low_z, high_z, has_high_face).of(contour);
}

MeshPatch revolve_band(std::span<const Contour> contours, Unit low_z, Unit high_z,
                       bool has_high_face, double tolerance_mm,
                       const std::optional<BarFlats>& flats) {
  static_assert(kPatchSegments % 12 == 0 && kPatchSegments % 8 == 0, "bars of six and four flats");
  MeshPatch patch;
  const bool is_marked = !contours.empty() && !contours[0].runs()[0]->marks.empty();
  PatchBuilder builder(patch, flats, is_marked, tolerance_mm);
  BandChains chains(low_z, high_z, has_high_face);
  for (const Contour& contour : contours) {
    if (contour.box().max_x < low_z || contour.box().min_x > high_z) continue;
    for (const BandChain& whole : chains.of(contour)) {
      const BandChain chain = simplified_by_marks(whole, tolerance_mm);
      builder.add_chain(flats ? divided_at_flats(chain, *flats, tolerance_mm) : chain);
    }
  }
  patch.skirt_begin = static_cast<std::uint32_t>(patch.indices.size());
  return patch;
}

}  // namespace kerf::turning
