#include "stock/zmap/wall_rims.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "stock/zmap/cutter_components.h"

namespace kerf {
namespace {

/// What is nearer to a middle lies on it: more than kernels and marks round, less than a mark
/// shows.
constexpr double kOnMiddle_cells = 1e-6;
/// Of sums of lengths and angles of a path.
constexpr double kRounding_mm = 1e-6;
constexpr double kTurn_rad = 6.28318530717958647693;

/// Of (x, y), 0 .. 2 pi, from correctly rounded operations only (libm differs between hosts).
double angle_of(double x, double y) {
  const double ax = std::abs(x), ay = std::abs(y);
  double r = std::min(ax, ay) / std::max(std::max(ax, ay), 1e-300);
  for (int halving = 0; halving < 2; ++halving) r = r / (1 + std::sqrt(1 + r * r));
  const double r2 = r * r;
  double series = 1.0 / 21;
  for (int n = 19; n >= 1; n -= 2) series = 1.0 / n - r2 * series;
  double angle = 4 * r * series;
  if (ay > ax) angle = kTurn_rad / 4 - angle;
  if (x < 0) angle = kTurn_rad / 2 - angle;
  return y < 0 ? kTurn_rad - angle : angle;
}

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// Lines of cells that may be crossed between two places.
struct Lines {
  int first, last;
  Lines(double from, double to, double low, double per_cell, int cells)
      : first(static_cast<int>(std::max(0.0, std::ceil((from - low) * per_cell - 0.5)))),
        last(static_cast<int>(std::min(cells - 1.0, std::floor((to - low) * per_cell - 0.5)))) {}
};

/// Marks that were written lately: of a pocket that is cut in layers all but the last layer's say
/// nothing, where that one comes first.
class RecentMarks {
 public:
  /// Whether one of the same way reaches as far from as deep; else this one is kept.
  bool has_deeper(const PlacedMark& placed) {
    const std::size_t number = std::size_t{placed.tile} << 16 | placed.mark.cell;
    PlacedMark& known = marks_[(number * kSpread >> 32) % kCount];
    const bool is_same = known.tile == placed.tile && known.mark.cell == placed.mark.cell;
    if (is_same && known.mark.reach >= placed.mark.reach &&
        known.mark.foot_mm <= placed.mark.foot_mm)
      return true;
    known = placed;
    return false;
  }

 private:
  static constexpr std::size_t kCount = 4096;
  static constexpr std::size_t kSpread = 0x9e37'79b9'7f4a'7c15;
  std::vector<PlacedMark> marks_ = std::vector<PlacedMark>(kCount, {~std::uint32_t{0}, {}});
};

/// The highest of kSide x kSide cells, found once for many who ask.
class GroupTops {
 public:
  static constexpr int kSide = 8;
  explicit GroupTops(const TileGrid& grid)
      : grid_(grid),
        row_(static_cast<std::size_t>(grid.tiles_x()) * (kTileCells / kSide)),
        known_(kCount) {}

  float top(int gx, int gy) {
    const std::size_t number = static_cast<std::size_t>(gy) * row_ + static_cast<std::size_t>(gx);
    Known& known = known_[number % kCount];
    if (known.number != number) known = {number, highest(gx, gy)};
    return known.top;
  }

 private:
  struct Known {
    std::size_t number = ~std::size_t{0};
    float top = 0;
  };
  /// 50 mm by 50 of cells of 0.1 mm, or 3 m along a row.
  static constexpr std::size_t kCount = 4096;
  static_assert(kSide % kBlockX == 0 && kSide % kBlockY == 0 && kTileCells % kSide == 0);

  float highest(int gx, int gy) const {
    const int i = gx * kSide, j = gy * kSide;
    const float* const first = grid_.tile(i / kTileCells, j / kTileCells) + TileGrid::offset(i, j);
    // As many at once as a block has, which do not wait for each other.
    std::array<float, kBlockFloats> tops;
    std::copy_n(first, kBlockFloats, tops.begin());
    for (int row = 0; row < kSide / kBlockY; ++row) {
      const float* heights = first + row * kTileBlocksX * kBlockFloats;
      for (int block = 0; block < kSide / kBlockX; ++block, heights += kBlockFloats)
        for (std::size_t n = 0; n < kBlockFloats; ++n) tops[n] = std::max(tops[n], heights[n]);
    }
    return *std::max_element(tops.begin(), tops.end());
  }

  const TileGrid& grid_;
  std::size_t row_;
  std::vector<Known> known_;
};

/// Writes a mark for each crossing that it is given, where it says something.
class CrossingWriter {
 public:
  CrossingWriter(const TileGrid& grid, std::vector<PlacedMark>& out)
      : low_(grid.bounds_mm().min),
        cell_(grid.cell_x_mm(), grid.cell_y_mm()),
        per_cell_(1 / cell_.x, 1 / cell_.y),
        floor_mm_(static_cast<double>(grid.floor_mm())),
        grid_(grid),
        tiles_(grid.tile_count()),
        tops_(grid),
        out_(out) {
    for (std::size_t n = 0; n < tiles_.size(); ++n) tiles_[n] = grid.tile(n);
  }

  /// A row of cells (axis 0) or a column (axis 1), which sides cross.
  struct Line {
    int axis = 0, number = 0;
    int count = 0;              ///< cells on it
    const float* const* tiles;  ///< the first of its tiles
    std::size_t tile_step = 0;  ///< from one to the next
    std::size_t offset = 0;     ///< of its first cell in a tile
    float height(int at) const {
      const auto n = static_cast<unsigned>(at);
      const float* const tile = tiles[n / kTileCells * tile_step];
      const unsigned within = n % kTileCells;
      return tile[offset + (axis == 0 ? within / kBlockX * kBlockFloats + within % kBlockX
                                      : within / kBlockY * kTileBlocksX * kBlockFloats +
                                            within % kBlockY * kBlockX)];
    }
  };
  /// Rows (axis 0) or columns whose middles lie between two places.
  Lines lines(int axis, double from, double to) const {
    const int across = 1 - axis;
    return {from, to, low_[across], per_cell_[across], axis == 0 ? grid_.ny() : grid_.nx()};
  }
  double middle_mm(int axis, int n) const { return low_[axis] + (n + 0.5) * cell_[axis]; }
  Line line(int axis, int n) const { return axis == 0 ? row(n) : column(n); }

  Line row(int j) const {
    const auto tiles_x = static_cast<std::size_t>(grid_.tiles_x());
    return {0,          j,
            grid_.nx(), tiles_.data() + static_cast<std::size_t>(j / kTileCells) * tiles_x,
            1,          TileGrid::offset(0, j)};
  }
  Line column(int i) const {
    return {1,
            i,
            grid_.ny(),
            tiles_.data() + i / kTileCells,
            static_cast<std::size_t>(grid_.tiles_x()),
            TileGrid::offset(i, 0)};
  }
  /// Along a line in cells, 0 in its first middle.
  double place(int axis, double at_mm) const {
    return (at_mm - low_[axis]) * per_cell_[axis] - 0.5;
  }

  /// Lines `first` to `last`, kGroup at most and of one group, are crossed between two places along
  /// them: whether it is certain that no mark is left, of a foot that is at `foot_mm` or above.
  bool is_idle(int axis, int first, double from, double to, bool is_ahead, double foot_mm) {
    // One cell more to either side, for crossings in a middle.
    const int low = static_cast<int>(std::max(from, 0.0)) - 1 + is_ahead,
              high = static_cast<int>(std::max(to, 0.0)) + 1 + is_ahead;
    const int most = (axis == 0 ? grid_.nx() : grid_.ny()) - 1;
    const auto foot = static_cast<float>(foot_mm);
    const int along = first / kGroup;
    for (int across = std::clamp(low, 0, most) / kGroup;
         across <= std::clamp(high, 0, most) / kGroup; ++across)
      if ((axis == 0 ? tops_.top(across, along) : tops_.top(along, across)) > foot) return false;
    return true;
  }
  /// The same of whatever crosses lines within a box.
  bool is_idle(const Vec2& low_mm, const Vec2& high_mm, double foot_mm) {
    const auto foot = static_cast<float>(foot_mm);
    const auto group = [&](int axis, double at_mm, int more) {
      const int most = (axis == 0 ? grid_.nx() : grid_.ny()) - 1;
      const double at = std::clamp(place(axis, at_mm) + more, 0.0, static_cast<double>(most));
      return static_cast<int>(at) / kGroup;
    };
    const int first_x = group(0, low_mm.x, -2), last_x = group(0, high_mm.x, 2),
              first_y = group(1, low_mm.y, -2), last_y = group(1, high_mm.y, 2);
    for (int gy = first_y; gy <= last_y; ++gy)
      for (int gx = first_x; gx <= last_x; ++gx)
        if (tops_.top(gx, gy) > foot) return false;
    return true;
  }
  static constexpr int kGroup = GroupTops::kSide;
  /// Of fewer lines each is looked at by itself.
  static constexpr int kFewLines = 4;

  /// A side crosses a line; `is_ahead`: what is covered lies toward its low end. Whether the middle
  /// there is under this sweep is not asked: it may be under the next one of the same path, and
  /// only just not under this one.
  void cross(const Line& line, double at, bool is_ahead, double foot_mm) {
    if (!(at > -0.5) || !(at < line.count - 0.5)) return;
    const int low = static_cast<int>(at + 1) - 1;
    const double part = at - low;
    // From which middle the way began that ends on one is for the kernel's rounding to tell: then
    // both ways, of which the heights let one count.
    if (part < kOnMiddle_cells) [[unlikely]]
      put(line, low - 1, 1, is_ahead, foot_mm);
    if (part > 1 - kOnMiddle_cells) [[unlikely]]
      put(line, low + 1, 0, is_ahead, foot_mm);
    put(line, low, part, is_ahead, foot_mm);
  }

 private:
  void put(const Line& line, int low, double part, bool is_ahead, double foot_mm) {
    if (static_cast<unsigned>(low) >= static_cast<unsigned>(line.count - 1)) return;
    const float top = line.height(low + is_ahead);
    if (!(static_cast<float>(foot_mm) < top)) [[likely]]
      return;
    write(line, low, part, is_ahead, foot_mm, top);
  }
  [[gnu::noinline]] void write(const Line& line, int low, double part, bool is_ahead,
                               double foot_mm, float top) {
    if (!(grid_.floor_mm() < top)) return;
    const int covered = low + !is_ahead;
    const int i = line.axis == 0 ? covered : line.number,
              j = line.axis == 0 ? line.number : covered;
    const CellWay way = line.axis == 0 ? (is_ahead ? CellWay::kRight : CellWay::kLeft)
                                       : (is_ahead ? CellWay::kUp : CellWay::kDown);
    const int tile = j / kTileCells * grid_.tiles_x() + i / kTileCells;
    const PlacedMark placed{static_cast<std::uint32_t>(tile),
                            WallMark::of(TileGrid::offset(i, j), way, is_ahead ? part : 1 - part,
                                         std::max(foot_mm, floor_mm_))};
    if (lately_.has_deeper(placed)) return;
    out_.push_back(placed);
  }

  Vec2 low_, cell_, per_cell_;
  double floor_mm_;
  const TileGrid& grid_;
  std::vector<const float*> tiles_;
  GroupTops tops_;
  RecentMarks lately_;
  std::vector<PlacedMark>& out_;
};

/// A side that is straight seen from above.
struct StraightSide {
  Vec2 from{0}, along{1, 0}, outward{0};
  double length = 0;
  double foot_mm = 0, slope = 0;
};

/// Calls take(first, last) for the lines that lie in one group.
template <class Take>
void each_group(const Lines& lines, const Take& take) {
  constexpr int kGroup = CrossingWriter::kGroup;
  for (int first = lines.first; first <= lines.last;) {
    const int last = std::min(lines.last, first / kGroup * kGroup + kGroup - 1);
    take(first, last);
    first = last + 1;
  }
}

class StraightCrossings {
 public:
  StraightCrossings(const StraightSide& side, int axis, CrossingWriter& writer)
      : side_(side),
        axis_(axis),
        across_(1 - axis),
        per_mm_(1 / side.along[across_]),
        is_ahead_(side.outward[axis] > 0),
        writer_(writer) {}

  void add() {
    const double from = side_.from[across_], to = from + side_.length * side_.along[across_];
    const Lines lines = writer_.lines(axis_, std::min(from, to), std::max(from, to));
    each_group(lines, [&](int first, int last) {
      if (!is_idle(first, last)) cross(first, last);
    });
  }

 private:
  double way(int n) const {
    return (writer_.middle_mm(across_, n) - side_.from[across_]) * per_mm_;
  }
  double place(double t) const {
    return writer_.place(axis_, side_.from[axis_] + t * side_.along[axis_]);
  }
  double foot_mm(double t) const { return side_.foot_mm + t * side_.slope; }

  /// What is on lines between two is between what is on these: each operation rounds monotonously.
  bool is_idle(int first, int last) const {
    if (last - first < CrossingWriter::kFewLines) return false;
    const double t = way(first), t2 = way(last);
    const double at = place(t), at2 = place(t2);
    return writer_.is_idle(axis_, first, std::min(at, at2), std::max(at, at2), is_ahead_,
                           std::min(foot_mm(t), foot_mm(t2)));
  }

  void cross(int first, int last) {
    for (int n = first; n <= last; ++n) {
      const double t = way(n);
      writer_.cross(writer_.line(axis_, n), place(t), is_ahead_, foot_mm(t));
    }
  }

  const StraightSide& side_;
  int axis_, across_;
  double per_mm_;
  bool is_ahead_;
  CrossingWriter& writer_;
};

void cross_straight(const StraightSide& side, CrossingWriter& writer) {
  for (int axis = 0; axis < 2; ++axis)  // of the lines
    if (side.along[1 - axis] != 0) StraightCrossings(side, axis, writer).add();
}

/// A side that is round seen from above; what is covered is within it, or (is_bore) beyond.
struct RoundSide {
  Vec2 center{0};
  double radius = 0;
  bool is_bore = false;
  Vec2 low{0}, high{0};  ///< box of the part in question

  RoundSide(const Vec2& middle, double r, bool bore = false)
      : center(middle), radius(r), is_bore(bore), low(middle - r), high(middle + r) {}
};

class RoundCrossings {
 public:
  RoundCrossings(const RoundSide& side, int axis, CrossingWriter& writer)
      : side_(side),
        axis_(axis),
        across_(1 - axis),
        radius2_(side.radius * side.radius),
        writer_(writer) {}

  /// has(d): whether the place at center + d belongs to the side; foot_mm(d), nowhere below
  /// `deepest_mm`.
  template <class Has, class Foot>
  void add(const Has& has, const Foot& foot_mm, double deepest_mm) {
    each_group(writer_.lines(axis_, side_.low[across_], side_.high[across_]),
               [&](int first, int last) {
                 const bool right = !is_idle(first, last, 1, deepest_mm),
                            left = !is_idle(first, last, -1, deepest_mm);
                 if (!right && !left) return;
                 for (int n = first; n <= last; ++n) cross(n, right, left, has, foot_mm);
               });
  }

 private:
  double off(int n) const { return writer_.middle_mm(across_, n) - side_.center[across_]; }
  bool is_ahead(double sign) const { return (sign > 0) != side_.is_bore; }

  bool is_idle(int first, int last, double sign, double deepest_mm) const {
    if (last - first < CrossingWriter::kFewLines) return false;
    const double d = off(first), d2 = off(last);
    const double half = std::sqrt(std::max(0.0, radius2_ - d * d)),
                 half2 = std::sqrt(std::max(0.0, radius2_ - d2 * d2));
    const bool is_across = d < 0 && d2 > 0;
    const auto place = [&](double h) {
      return writer_.place(axis_, side_.center[axis_] + sign * h);
    };
    const double at = place(std::min(half, half2)),
                 at2 = place(is_across ? side_.radius : std::max(half, half2));
    return writer_.is_idle(axis_, first, std::min(at, at2), std::max(at, at2), is_ahead(sign),
                           deepest_mm);
  }

  template <class Has, class Foot>
  void cross(int n, bool right, bool left, const Has& has, const Foot& foot_mm) {
    Vec2 d;
    d[across_] = off(n);
    const double square = radius2_ - d[across_] * d[across_];
    if (!(square > 0)) return;
    const double half = std::sqrt(square);
    const CrossingWriter::Line line = writer_.line(axis_, n);
    for (const double sign : {1.0, -1.0}) {
      if (!(sign > 0 ? right : left)) continue;
      d[axis_] = sign * half;
      const double at_mm = side_.center[axis_] + d[axis_];
      if (at_mm < side_.low[axis_] || at_mm > side_.high[axis_] || !has(d)) continue;
      writer_.cross(line, writer_.place(axis_, at_mm), is_ahead(sign), foot_mm(d));
    }
  }

  const RoundSide& side_;
  int axis_, across_;
  double radius2_;
  CrossingWriter& writer_;
};

template <class Has, class Foot>
void cross_round(const RoundSide& side, const Has& has, const Foot& foot_mm, double deepest_mm,
                 CrossingWriter& writer) {
  for (int axis = 0; axis < 2; ++axis)  // of the lines
    RoundCrossings(side, axis, writer).add(has, foot_mm, deepest_mm);
}

/// The sides of one sweep after the other.
class SweepRims {
 public:
  SweepRims(const TileGrid& grid, const ConvexTool& tool, std::vector<PlacedMark>& out)
      : writer_(grid, out),
        radius_(tool.radius),
        rim_mm_(surface_height(tool, tool.radius)),
        top_mm_(grid.bounds_mm().max.z),
        together_mm_(2 * CrossingWriter::kGroup * std::min(grid.cell_x_mm(), grid.cell_y_mm())) {}

  void add(const SweepOp& op) {
    switch (op.kind) {
      case SweepOp::Kind::kStrip:
        return add_strip(op, true, true);
      case SweepOp::Kind::kCap:
        if (is_below_top(op.z)) add_cap(op);
        return;
      case SweepOp::Kind::kArc:
        if (is_below_top(op.z)) add_arc(op);
        return;
      case SweepOp::Kind::kHelix:
        if (is_below_top(op.z - op.slope * op.length)) add_helix(op);
        return;
    }
  }

  /// The last first.
  void add(std::span<const SweepOp> ops) {
    while (!ops.empty()) {
      const std::size_t count = strips_at_end(ops);
      if (count < 2) {
        add(ops.back());
        ops = ops.first(ops.size() - 1);
        continue;
      }
      const std::span<const SweepOp> strips = ops.last(count);
      const bool left = !is_idle(strips, 1.0), right = !is_idle(strips, -1.0);
      if (left || right)
        for (auto op = strips.rbegin(); op != strips.rend(); ++op) add_strip(*op, left, right);
      ops = ops.first(ops.size() - count);
    }
  }

 private:
  /// How many strips without corners end `ops`, as long together as is looked at together.
  std::size_t strips_at_end(std::span<const SweepOp> ops) const {
    std::size_t count = 0;
    for (double length = 0; count < ops.size(); ++count) {
      const SweepOp& op = ops[ops.size() - 1 - count];
      length += op.length;
      if (op.kind != SweepOp::Kind::kStrip || has_corner(op) || length > together_mm_) break;
    }
    return count;
  }
  bool is_below_top(double tip_z) const { return tip_z + rim_mm_ < top_mm_; }
  static bool always(const Vec2&) { return true; }

  static bool has_corner(const SweepOp& op) {
    return op.joined && !op.straight_on && op.cos * op.next_sin - op.sin * op.next_cos != 0;
  }
  static Vec2 left_of(const SweepOp& op) { return {-op.sin, op.cos}; }
  static double end_z(const SweepOp& op) { return op.z + op.slope * op.length; }

  /// Whether it is certain that no mark is left of one side of strips.
  bool is_idle(std::span<const SweepOp> strips, double sign) {
    Vec2 low(HUGE_VAL), high(-HUGE_VAL);
    double foot = HUGE_VAL;
    for (const SweepOp& op : strips) {
      const Vec2 from = Vec2(op.x, op.y) + sign * radius_ * left_of(op),
                 to = from + op.length * Vec2(op.cos, op.sin);
      low = glm::min(low, glm::min(from, to));
      high = glm::max(high, glm::max(from, to));
      foot = std::min(foot, std::min(op.z, end_z(op)) + rim_mm_);
    }
    return writer_.is_idle(low, high, foot);
  }

  void add_strip(const SweepOp& op, bool has_left, bool has_right) {
    const double end_z = SweepRims::end_z(op);
    if (!is_below_top(std::min(op.z, end_z))) return;
    const Vec2 from(op.x, op.y), along(op.cos, op.sin), left = left_of(op);
    for (const double sign : {1.0, -1.0}) {
      if (!(sign > 0 ? has_left : has_right)) continue;
      const Vec2 outward = sign * left;
      cross_straight(
          {from + radius_ * outward, along, outward, op.length, op.z + rim_mm_, op.slope}, writer_);
    }
    if (op.joined && is_below_top(end_z)) add_corner(op, from + op.length * along, end_z);
  }

  /// Where a path turns a little: the tool's side between those of the two strips.
  void add_corner(const SweepOp& op, const Vec2& tip, double tip_z) {
    if (!has_corner(op)) return;
    const double turn = op.cos * op.next_sin - op.sin * op.next_cos;
    // Counter-clockwise from `first` to `last`.
    Vec2 first(op.sin, -op.cos), last(op.next_sin, -op.next_cos);
    if (turn < 0) {
      const Vec2 before = first;
      first = -last;
      last = -before;
    }
    RoundSide side(tip, radius_);
    side.low = tip + radius_ * glm::min(first, last);
    side.high = tip + radius_ * glm::max(first, last);
    for (int axis = 0; axis < 2; ++axis) {
      if (first[1 - axis] * last[1 - axis] > 0) continue;
      if (first[axis] + last[axis] > 0)
        side.high[axis] = tip[axis] + radius_;
      else
        side.low[axis] = tip[axis] - radius_;
    }
    cross_round(
        side,
        [&](const Vec2& d) {
          return cross(first, d) >= 0 && cross(d, last) >= 0 && d.x * first.x + d.y * first.y > 0;
        },
        [&](const Vec2&) { return tip_z + rim_mm_; }, tip_z + rim_mm_, writer_);
  }

  void add_cap(const SweepOp& op) {
    const Vec2 tip(op.x, op.y);
    const double foot = op.z + rim_mm_;
    cross_round(
        RoundSide(tip, radius_), always, [&](const Vec2&) { return foot; }, foot, writer_);
  }

  /// Both sides of what a tool covers on its way about a centre. is_on(d): the tip comes by there.
  template <class IsOn, class Foot>
  void add_ring(const SweepOp& op, const IsOn& is_on, const Foot& foot_mm, double deepest_mm) {
    const Vec2 center(op.x, op.y);
    const double inner = op.radius - radius_, outer = op.radius + radius_;
    cross_round(RoundSide(center, outer), is_on, foot_mm, deepest_mm, writer_);
    if (inner > 0) cross_round(RoundSide(center, inner, true), is_on, foot_mm, deepest_mm, writer_);
  }

  void add_arc(const SweepOp& op) {
    const Vec2 start(op.cos, op.sin), end(op.end_cos, op.end_sin);
    add_ring(
        op,
        [&](const Vec2& d) {
          if (op.full_circle) return true;
          const bool after = cross(start, d) >= 0, before = cross(d, end) >= 0;
          return op.over_half ? after || before : after && before;
        },
        [&](const Vec2&) { return op.z + rim_mm_; }, op.z + rim_mm_);
  }

  /// It descends from `start`, several turns maybe: the last one is the deepest.
  void add_helix(const SweepOp& op) {
    const Vec2 start(op.cos, op.sin);
    const auto angle = [&](const Vec2& d) {
      const double ahead = start.x * d.x + start.y * d.y, aside = cross(start, d);
      return angle_of(ahead, op.over_half ? -aside : aside);
    };
    add_ring(
        op, [&](const Vec2& d) { return angle(d) <= op.length; },
        [&](const Vec2& d) {
          const double first = angle(d);
          const double turns = std::floor((op.length - first) / kTurn_rad);
          return op.z - op.slope * (first + turns * kTurn_rad) + rim_mm_;
        },
        op.z - op.slope * op.length + rim_mm_ - kRounding_mm);
  }

  CrossingWriter writer_;
  double radius_, rim_mm_, top_mm_;
  double together_mm_;  ///< length of strips whose sides are looked at together
};

}  // namespace

double highest_wall_tip_mm(const TileGrid& grid, const ConvexTool& tool) {
  return grid.bounds_mm().max.z - surface_height(tool, tool.radius) + kRounding_mm;
}

double lowest_tip_mm(const SweepOp& op) {
  if (op.kind == SweepOp::Kind::kStrip) return std::min(op.z, op.z + op.slope * op.length);
  return op.kind == SweepOp::Kind::kHelix ? op.z - op.slope * op.length : op.z;
}

void find_wall_marks(const TileGrid& grid, const ConvexTool& tool, std::span<const SweepOp> ops,
                     std::vector<PlacedMark>& out) {
  // Both sides may lie between the same two middles.
  if (2 * tool.radius < std::max(grid.cell_x_mm(), grid.cell_y_mm())) return;
  SweepRims(grid, tool, out).add(ops);
}

void find_side_marks(const TileGrid& grid, const Vec2& center, double radius_mm, bool is_bore,
                     std::vector<PlacedMark>& out) {
  CrossingWriter writer(grid, out);
  const double floor = static_cast<double>(grid.floor_mm());
  // What is covered here is air.
  cross_round(
      RoundSide(center, radius_mm, !is_bore), [](const Vec2&) { return true; },
      [&](const Vec2&) { return floor; }, floor, writer);
}

}  // namespace kerf
