#include "stock/pieces/through_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "base/portable_math.h"
#include "stock/zmap/part_pieces.h"

namespace kerf {
namespace {

/// Arcs as chords that are nowhere farther from them, in cells: where each cell is asked for its
/// distance from the arc, and where (a cone on a helix) it is not.
constexpr double kAskedChord = 0.5, kChord = 0.02;
/// The same of arcs that are not level.
constexpr double kFlat = 0.0005;
/// Of the part of a way that comes near a cell, until its lowest place there is known.
constexpr int kThirds = 60;
/// A search begins with so many words of 64 cells, and goes on with so many times as many.
constexpr std::size_t kFirstWords = 64, kWordsGrowth = 8;

/// Calls take(row, word, bits) for these cells and all that share a side or a corner with one.
template <class Take>
void each_beside(const CellWord& cells, const Take& take) {
  const std::uint64_t around = cells.bits | cells.bits << 1 | cells.bits >> 1;
  for (int row = cells.row - 1; row <= cells.row + 1; ++row) {
    take(row, cells.word, around);
    if (cells.bits & 1) take(row, cells.word - 1, std::uint64_t{1} << 63);
    if (cells.bits >> 63) take(row, cells.word + 1, std::uint64_t{1});
  }
}

}  // namespace

ThroughMap::ThroughMap(const HeightGrid& heights)
    : bounds_mm_(heights.bounds_mm()),
      cell_mm_(heights.cell_x_mm(), heights.cell_y_mm()),
      level_mm_(bounds_mm_.min.z + kThinnest_mm),
      solid_(heights.nx(), heights.ny()),
      scratch_(heights.nx(), heights.ny()),
      ring_(heights.nx(), heights.ny()),
      near_(heights.nx(), heights.ny()) {
  for (int j = 0; j < heights.ny(); ++j) {
    for (int i = 0; i < heights.nx(); ++i) {
      if (static_cast<double>(heights.height(i, j)) > level_mm_) solid_.set(i, j);
    }
  }
}

bool ThroughMap::reaches(const CutMove& move, double floor_mm) {
  double lowest = std::min(move.from_mm.z, move.to_mm.z);
  if (move.arc && move.arc->axis.z * move.arc->axis.z < 1)
    lowest -= 2 * glm::length(move.from_mm - move.arc->center_mm);
  return lowest <= floor_mm + kThinnest_mm;
}

double ThroughMap::radius_at(const Cutter& cutter, double above_tip_mm) {
  if (above_tip_mm == cached_above_mm_ && cutter.spec() == cached_spec_) return cached_radius_mm_;
  double low = 0, high = cutter.radius_mm();
  if (cutter.height_mm(high) <= above_tip_mm) {
    low = high;
  } else {
    constexpr int kHalvings = 40;
    for (int n = 0; n < kHalvings; ++n) {
      const double middle = (low + high) / 2;
      (cutter.height_mm(middle) <= above_tip_mm ? low : high) = middle;
    }
  }
  cached_spec_ = cutter.spec();
  cached_above_mm_ = above_tip_mm;
  return cached_radius_mm_ = low;
}

/// From and to in cells: 0 is the middle of the first.
void ThroughMap::take_row(int row, double low_cell, double high_cell) {
  low_cell = std::max(0.0, low_cell);
  high_cell = std::min(solid_.nx() - 1.0, high_cell);
  if (!(high_cell >= 0) || low_cell > high_cell) return;
  int first = static_cast<int>(low_cell);  // rounded up
  first += static_cast<double>(first) < low_cell ? 1 : 0;
  const int last = static_cast<int>(high_cell);
  if (first > last) return;
  for (int word = first / 64; word <= last / 64; ++word) {
    std::uint64_t& solid = solid_.at(row, word);
    if (solid == 0) continue;
    std::uint64_t bits = solid;
    if (word == first / 64) bits &= ~std::uint64_t{0} << (first % 64);
    if (word == last / 64) bits &= ~std::uint64_t{0} >> (63 - last % 64);
    for (std::uint64_t left = slope_ || arc_ ? bits : 0; left != 0; left &= left - 1) {
      const int i = 64 * word + std::countr_zero(left);
      if (slope_ ? !is_under_slope(i, row) : !is_under_arc(i, row)) bits &= ~(left & (~left + 1));
    }
    if (bits == 0) continue;
    solid &= ~bits;
    removed_.push_back({row, word, bits});
  }
}

/// Whether the cutter's surface comes down to the floor over the cell's middle. Of convex cutters
/// its height there first falls along a straight way and then rises.
bool ThroughMap::is_under_slope(int i, int j) const {
  const Vec2 cell = Vec2(bounds_mm_.min) + Vec2(i + 0.5, j + 0.5) * cell_mm_;
  const Vec2 way(step_to_ - step_from_), arm = cell - Vec2(step_from_);
  const double length2 = glm::dot(way, way), radius = slope_->radius_mm();
  double low = 0, high = 1;
  if (length2 > 0) {
    const double nearest = glm::dot(arm, way) / length2;
    const double away2 = glm::dot(arm, arm) - nearest * nearest * length2;
    const double half = std::sqrt(std::max(0.0, (radius * radius - away2) / length2));
    low = std::max(0.0, nearest - half);
    high = std::min(1.0, nearest + half);
  }
  if (low > high) return false;
  const auto height = [&](double t) {
    const double lift = slope_->height_mm(std::min(radius, glm::length(arm - t * way)));
    return step_from_.z + t * (step_to_.z - step_from_.z) + lift;
  };
  for (int n = 0; n < kThirds && high - low > 0; ++n) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    const double at_a = height(a), at_b = height(b);
    if (std::min(at_a, at_b) <= level_mm_) return true;
    (at_a < at_b ? high : low) = at_a < at_b ? b : a;
  }
  return std::min(height(low), height(high)) <= level_mm_;
}

bool ThroughMap::is_under_arc(int i, int j) const {
  const Vec2 cell = Vec2(bounds_mm_.min) + Vec2(i + 0.5, j + 0.5) * cell_mm_;
  const Vec2 arm = cell - arc_->center;
  const double far = glm::length(arm);
  if (glm::dot(arm, arc_middle_) >= far * arc_cosine_)
    return std::abs(far - arc_->arm) <= radius_mm_;
  return glm::length(cell - Vec2(step_from_)) <= radius_mm_ ||
         glm::length(cell - Vec2(step_to_)) <= radius_mm_;
}

void ThroughMap::widen_by_disk(const Vec2& middle, int first_row, double radius) {
  double* const low = low_x_.data();
  double* const high = high_x_.data();
  const int rows = static_cast<int>(low_x_.size());
  const double begin = bounds_mm_.min.y, step = cell_mm_.y;
  for (int k = 0; k < rows; ++k) {  // without a way out of the loop: several rows at a time
    const double away = begin + (first_row + k + 0.5) * step - middle.y;
    const double square = radius * radius - away * away;
    const double half = std::sqrt(std::max(0.0, square));
    const double at_low = square >= 0 ? middle.x - half : low[k];
    const double at_high = square >= 0 ? middle.x + half : high[k];
    low[k] = std::min(low[k], at_low);
    high[k] = std::max(high[k], at_high);
  }
}

void ThroughMap::widen_by_side(const Vec2& from, const Vec2& to, int first_row) {
  if (from.y == to.y) return;
  const double begin = bounds_mm_.min.y, step = cell_mm_.y;
  const auto row_of = [&](double y) {
    return std::clamp((y - begin) / step - 0.5 - first_row, -1.0,
                      static_cast<double>(low_x_.size()));
  };
  const double low_y = std::min(from.y, to.y), high_y = std::max(from.y, to.y);
  const int k0 = std::max(0, static_cast<int>(row_of(low_y)));
  const int k1 =
      std::min(static_cast<int>(low_x_.size()) - 1, static_cast<int>(row_of(high_y)) + 1);
  for (int k = k0; k <= k1; ++k) {
    const double y = begin + (first_row + k + 0.5) * step;
    if (y < low_y || y > high_y) continue;
    const double x = from.x + (y - from.y) / (to.y - from.y) * (to.x - from.x);
    const auto at = static_cast<std::size_t>(k);
    low_x_[at] = std::min(low_x_[at], x);
    high_x_[at] = std::max(high_x_[at], x);
  }
}

void ThroughMap::sweep(const Vec2& from, const Vec2& to, double radius) {
  const auto row_of = [&](double y) { return (y - bounds_mm_.min.y) / cell_mm_.y - 0.5; };
  const double low_y = std::min(from.y, to.y) - radius, high_y = std::max(from.y, to.y) + radius;
  const int first = static_cast<int>(std::ceil(std::max(0.0, row_of(low_y))));
  const int last = static_cast<int>(std::floor(std::min(solid_.ny() - 1.0, row_of(high_y))));
  if (first > last) return;
  const auto rows = static_cast<std::size_t>(last - first + 1);
  low_x_.assign(rows, std::numeric_limits<double>::infinity());
  high_x_.assign(rows, -std::numeric_limits<double>::infinity());
  widen_by_disk(from, first, radius);
  widen_by_disk(to, first, radius);
  if (const double length = glm::length(to - from); length > 0) {
    const Vec2 side = Vec2(from.y - to.y, to.x - from.x) * (radius / length);
    widen_by_side(from + side, to + side, first);
    widen_by_side(from - side, to - side, first);
  }
  for (std::size_t k = 0; k < rows; ++k) {
    take_row(first + static_cast<int>(k), (low_x_[k] - bounds_mm_.min.x) / cell_mm_.x - 0.5,
             (high_x_[k] - bounds_mm_.min.x) / cell_mm_.x - 0.5);
  }
}

void ThroughMap::cut(const Cutter& cutter, const CutMove& move, std::vector<ThroughSplit>& splits) {
  removed_after_.clear();
  const double cell = std::min(cell_mm_.x, cell_mm_.y);
  const double step_mm = std::max(2 * cutter.radius_mm(), 4 * cell);
  const std::vector<PartPiece> pieces = pieces_of(move, kFlat * cell);
  const std::size_t before = splits.size();
  double way_mm = 0;
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const PartPiece& piece = pieces[n];
    const double length =
        piece.turns ? piece.arm * std::abs(piece.sweep_rad) : glm::length(Vec2(piece.step));
    double t0 = 0, t1 = 1;
    const double drop = piece.step.z;
    if (drop == 0) {
      if (piece.from.z > level_mm_) t1 = -1;
    } else {
      const double at = (level_mm_ - piece.from.z) / drop;
      (drop > 0 ? t1 : t0) = drop > 0 ? std::min(1.0, at) : std::max(0.0, at);
    }
    if (t0 <= t1) {
      const auto radius = [&](double t) { return radius_at(cutter, level_mm_ - piece.z(t)); };
      const double part_mm = length * (t1 - t0);
      double steps = std::max(1.0, std::ceil(part_mm / step_mm));
      if (piece.turns) {
        const double off_mm = cell * (radius(t0) == radius(t1) ? kAskedChord : kChord);
        const double chord =
            2 * portable::acos(std::max(0.0, 1 - off_mm / std::max(piece.arm, off_mm)));
        steps = std::max(steps, std::ceil(std::abs(piece.sweep_rad) * (t1 - t0) / chord));
      }
      for (int s = 0; s < static_cast<int>(steps); ++s) {
        const double a = t0 + (t1 - t0) * s / steps, b = t0 + (t1 - t0) * (s + 1) / steps;
        removed_.clear();
        const Vec3 tip = piece.tip(b);
        const double wide_a = radius(a), wide_b = radius(b);
        const Vec3 begin = piece.tip(a);
        // Of a cone that goes up or down each cell is asked.
        slope_ = wide_a == wide_b ? nullptr : &cutter;
        step_from_ = begin;
        step_to_ = tip;
        arc_ = piece.turns && slope_ == nullptr ? &piece : nullptr;
        if (arc_) {
          const double middle = piece.begin_rad + (a + b) / 2 * piece.sweep_rad;
          arc_middle_ = {portable::cos(middle), portable::sin(middle)};
          arc_cosine_ = portable::cos(std::min(kPi, (b - a) / 2 * std::abs(piece.sweep_rad)));
        }
        radius_mm_ = std::max(wide_a, wide_b);
        sweep(Vec2(begin), Vec2(tip), radius_mm_ + (arc_ ? kAskedChord * cell : 0));
        if (removed_.empty()) continue;
        const double at_mm = way_mm + length * b;
        if (splits.size() > before) removed_after_.push_back({at_mm, removed_});
        ThroughSplit step;
        step.tip_mm = tip;
        step.share = (static_cast<double>(n) + b) / static_cast<double>(pieces.size());
        step.way_mm = at_mm;
        find_splits(step, splits);
      }
    }
    way_mm += length;
  }
}

/// Material beside what has been removed, marked in ring_.
void ThroughMap::find_ring() {
  ring_cells_.clear();
  const auto take = [&](int row, int word, std::uint64_t bits) {
    if (!solid_.has(row, word)) return;
    std::uint64_t& mark = ring_.at(row, word);
    const std::uint64_t fresh = bits & solid_.at(row, word) & ~mark;
    if (fresh == 0) return;
    mark |= fresh;
    ring_cells_.push_back({row, word, fresh});
  };
  for (const CellWord& c : removed_) each_beside(c, take);
}

/// Most steps part nothing, and this tells it for the least.
bool ThroughMap::hangs_together(const CellSet& ring) {
  if (ring.empty()) return true;
  const CellWord& c = ring.front();
  found_.clear();
  flood(ring_, scratch_, {{c.row, c.word, c.bits & (~c.bits + 1)}}, ~std::size_t{0}, found_, open_);
  const bool all = std::ranges::all_of(
      ring, [this](const CellWord& at) { return (at.bits & ~scratch_.at(at.row, at.word)) == 0; });
  scratch_.remove(found_);
  return all;
}

void ThroughMap::part(const BitPlane& within, const CellSet& cells, std::vector<CellSet>& parts) {
  const std::size_t before = parts.size();
  for (const CellWord& c : cells) {
    while (const std::uint64_t bits = c.bits & ~scratch_.at(c.row, c.word)) {
      const std::uint64_t one = bits & (~bits + 1);
      flood(within, scratch_, {{c.row, c.word, one}}, ~std::size_t{0}, parts.emplace_back());
    }
  }
  for (std::size_t n = before; n < parts.size(); ++n) scratch_.remove(parts[n]);
}

std::vector<std::size_t> ThroughMap::former_bodies(const std::vector<CellSet>& parts) {
  std::vector<std::size_t> former(parts.size());
  std::iota(former.begin(), former.end(), std::size_t{0});
  std::vector<CellSet> gone;
  ring_.add(removed_);
  part(ring_, removed_, gone);
  ring_.remove(removed_);
  for (const CellSet& cells : gone) {
    const auto mark = [&](int row, int word, std::uint64_t bits) {
      if (near_.has(row, word)) near_.at(row, word) |= bits;
    };
    const auto clear = [&](int row, int word, std::uint64_t) {
      if (near_.has(row, word)) near_.at(row, word) = 0;
    };
    for (const CellWord& c : cells) each_beside(c, mark);
    std::size_t first = parts.size();
    for (std::size_t n = 0; n < parts.size(); ++n) {
      if (!near_.meets(parts[n])) continue;
      if (first == parts.size()) {
        first = former[n];
      } else {
        std::ranges::replace(former, former[n], first);
      }
    }
    for (const CellWord& c : cells) each_beside(c, clear);
  }
  return former;
}

void ThroughMap::find_splits(const ThroughSplit& step, std::vector<ThroughSplit>& splits) {
  find_ring();
  std::vector<CellSet> parts;
  if (!hangs_together(ring_cells_)) part(ring_, ring_cells_, parts);
  ring_.remove(ring_cells_);
  if (parts.size() < 2) return;
  std::vector<std::size_t> former = former_bodies(parts);
  const auto is_alone = [&](std::size_t n) { return std::ranges::count(former, former[n]) < 2; };
  // Which of them hang together by ways farther round: all are searched from, in rounds of greater
  // reach, until one at most has not come to its end.
  constexpr std::size_t kEverything = ~std::size_t{0};
  std::vector<std::size_t> group(parts.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  std::vector<CellSet> whole(parts.size());
  std::vector<char> ended(parts.size(), 0);
  for (std::size_t most = kFirstWords;; most *= kWordsGrowth) {
    std::size_t open = 0;
    for (std::size_t n = 0; n < parts.size(); ++n) {
      if (group[n] != n || ended[n] || is_alone(n)) continue;
      CellSet found;
      ended[n] = flood(solid_, scratch_, parts[n], most, found) ? 1 : 0;
      for (std::size_t other = 0; other < parts.size(); ++other) {
        if (group[other] == other && other != n && scratch_.meets(parts[other]))
          std::ranges::replace(group, other, n);
      }
      scratch_.remove(found);
      if (ended[n]) {
        whole[n] = std::move(found);
      } else {
        ++open;
      }
    }
    if (open <= 1) break;
  }
  // What hangs together now did so before.
  for (std::size_t n = 0; n < parts.size(); ++n) {
    if (group[n] != n) std::ranges::replace(former, former[n], former[group[n]]);
  }
  for (std::size_t body = 0; body < parts.size(); ++body) {
    ThroughSplit split = step;
    std::size_t open = parts.size();
    for (std::size_t n = 0; n < parts.size(); ++n) {
      if (former[n] != body || group[n] != n || is_alone(n)) continue;
      if (!ended[n]) open = n;
      if (ended[n] && has_square(whole[n], scratch_)) split.bodies.push_back(std::move(whole[n]));
    }
    if (split.bodies.empty()) continue;
    if (open < parts.size()) {
      CellSet rest;
      flood(solid_, scratch_, parts[open], kEverything, rest);
      scratch_.remove(rest);
      split.bodies.push_back(std::move(rest));
    }
    if (split.bodies.size() > 1) splits.push_back(std::move(split));
  }
}

std::vector<CellSet> ThroughMap::bodies() {
  std::vector<CellSet> out;
  const CellSet all = solid_.all();
  BitPlane seen(solid_.nx(), solid_.ny());
  for (const CellWord& c : all) {
    for (std::uint64_t bits = c.bits; bits != 0; bits &= bits - 1) {
      const std::uint64_t one = bits & (~bits + 1);
      if (seen.at(c.row, c.word) & one) continue;
      CellSet body;
      flood(solid_, seen, {{c.row, c.word, one}}, ~std::size_t{0}, body);
      if (has_square(body, scratch_)) out.push_back(std::move(body));
    }
  }
  return out;
}

}  // namespace kerf
