#include "stock/octree/tree_cut.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "stock/octree/blank_contact.h"
#include "stock/octree/brick_cut.h"

namespace kerf::octree {
namespace {

/// See brick_cut.cpp: rounding must not decide.
constexpr double kSlack_mm = 1e-6;

/// A sweep that reaches a tile.
struct TileSweep {
  const Sweep* sweep;
  std::uint64_t whole;  ///< bricks that lie inside of it
  std::uint64_t some;   ///< bricks that it may cut
};

std::uint64_t bit(int brick) { return std::uint64_t{1} << brick; }

/// Tiles that a box reaches: first and last along each axis.
struct TileRange {
  int low[3], high[3];
};

TileRange tiles_of(const Lattice& lattice, const Box& box) {
  TileRange range{};
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = lattice.cell_mm[axis] * kTileNodes;
    const int last = lattice.tiles[static_cast<std::size_t>(axis)] - 1;
    // A tile holds a layer of nodes of the next one, and so do its bricks.
    const double low = (box.min[axis] - lattice.origin_mm[axis] - lattice.cell_mm[axis]) / edge;
    const double high = (box.max[axis] - lattice.origin_mm[axis] + lattice.cell_mm[axis]) / edge;
    range.low[axis] = std::clamp(static_cast<int>(std::floor(low)), 0, last);
    range.high[axis] = std::clamp(static_cast<int>(std::floor(high)), 0, last);
  }
  return range;
}

/// Finds for one column of tiles which sweeps reach which bricks. Buffers; one for each thread.
class ColumnPlan {
 public:
  ColumnPlan(const BrickTree& tree, const SweepKernel& kernel) : tree_(tree), kernel_(kernel) {
    const Lattice& lattice = tree.lattice();
    lists_.resize(static_cast<std::size_t>(lattice.tiles[2]));
    const std::size_t room =
        std::max(static_cast<std::size_t>(lattice.tiles[2]), std::size_t{kBricksInTile}) + kLanes;
    for (std::vector<double>* v : {&x_, &y_, &z_, &f_}) v->assign(room, 0.0);
    tile_half_diagonal_ = glm::length(lattice.cell_mm) * kTileNodes / 2;
    brick_half_diagonal_ = glm::length(lattice.cell_mm) * kBrick / 2;
  }

  /// Before the first add().
  void begin(int column) {
    column_ = column;
    const int tiles_x = tree_.lattice().tiles[0];
    tile_x_ = column % tiles_x;
    tile_y_ = column / tiles_x;
    for (std::vector<TileSweep>& list : lists_) list.clear();
    gone_.assign(lists_.size(), false);
    any_ = false;
  }

  /// `alike_above_mm`: of the sweep.
  void add(const Sweep& sweep, double alike_above_mm) {
    const TileRange range = tiles_of(tree_.lattice(), sweep.box_mm);
    int points = 0;
    levels_.clear();
    for (int level = range.low[2]; level <= range.high[2]; ++level) {
      const TileRef& tile = tree_.tile(column_, level);
      if (tile.is_empty() || gone_[static_cast<std::size_t>(level)]) continue;
      levels_.push_back(level);
      set_point(points++, middle(0, tile_x_, kTileNodes), middle(1, tile_y_, kTileNodes),
                middle(2, level, kTileNodes));
    }
    if (points == 0) return;
    kernel_.distance(sweep, points, x_.data(), y_.data(), z_.data(), f_.data());
    reached_.clear();
    const double clear = tile_half_diagonal_ + kSlack_mm;
    for (std::size_t n = 0; n < levels_.size(); ++n) {
      if (f_[n] > clear + kReachMargin_mm) continue;
      const std::size_t level = static_cast<std::size_t>(levels_[n]);
      any_ = true;
      if (f_[n] < -clear) {
        lists_[level].push_back({&sweep, ~std::uint64_t{0}, 0});
        gone_[level] = true;
      } else {
        reached_.push_back(levels_[n]);
      }
    }
    alike_.reset();
    for (const int level : reached_) {
      if (alike_above_mm < tree_.lattice().place_mm(2, level * kTileNodes))
        add_alike_bricks(sweep, level);
      else
        add_bricks(sweep, level);
    }
  }

  bool any() const { return any_; }
  const std::vector<TileSweep>& at(int level) const {
    return lists_[static_cast<std::size_t>(level)];
  }
  int brick_x(int brick) const { return tile_x_ * kTileBricks + brick % kTileBricks; }
  int brick_y(int brick) const { return tile_y_ * kTileBricks + brick / kTileBricks % kTileBricks; }

 private:
  double middle(int axis, int number, int nodes) const {
    return tree_.lattice().origin_mm[axis] + (number + 0.5) * nodes * tree_.lattice().cell_mm[axis];
  }
  void set_point(int n, double x, double y, double z) {
    x_[static_cast<std::size_t>(n)] = x;
    y_[static_cast<std::size_t>(n)] = y;
    z_[static_cast<std::size_t>(n)] = z;
  }

  /// Where nothing depends on Z: of the lowest of these levels all bricks are looked at, and those
  /// above are reached as they are.
  void add_alike_bricks(const Sweep& sweep, int level) {
    if (!alike_) alike_ = reach_of(sweep, level, [](int) { return true; });
    const TileRef& tile = tree_.tile(column_, level);
    std::uint64_t there = ~std::uint64_t{0};
    for (int b = 0; tile.get() && b < kBricksInTile; ++b)
      if (tile->bricks[b].is_empty()) there &= ~bit(b);
    const TileSweep reach{&sweep, alike_->whole & there, alike_->some & there};
    if ((reach.whole | reach.some) != 0) lists_[static_cast<std::size_t>(level)].push_back(reach);
  }

  void add_bricks(const Sweep& sweep, int level) {
    const TileRef& tile = tree_.tile(column_, level);
    const TileSweep reach =
        reach_of(sweep, level, [&](int b) { return !tile.get() || !tile->bricks[b].is_empty(); });
    if ((reach.whole | reach.some) != 0) lists_[static_cast<std::size_t>(level)].push_back(reach);
  }

  template <class Wanted>
  TileSweep reach_of(const Sweep& sweep, int level, const Wanted& wanted) {
    int bricks[kBricksInTile], points = 0;
    for (int b = 0; b < kBricksInTile; ++b) {
      if (!wanted(b)) continue;
      bricks[points] = b;
      const int bz = level * kTileBricks + b / (kTileBricks * kTileBricks);
      set_point(points++, middle(0, brick_x(b), kBrick), middle(1, brick_y(b), kBrick),
                middle(2, bz, kBrick));
    }
    kernel_.distance(sweep, points, x_.data(), y_.data(), z_.data(), f_.data());
    TileSweep reach{&sweep, 0, 0};
    const double clear = brick_half_diagonal_ + kSlack_mm;
    for (int n = 0; n < points; ++n) {
      const double f = f_[static_cast<std::size_t>(n)];
      if (f < -clear)
        reach.whole |= bit(bricks[n]);
      else if (f <= clear + kReachMargin_mm)
        reach.some |= bit(bricks[n]);
    }
    return reach;
  }

  const BrickTree& tree_;
  const SweepKernel& kernel_;
  int column_ = 0, tile_x_ = 0, tile_y_ = 0;
  bool any_ = false;
  double tile_half_diagonal_, brick_half_diagonal_;
  std::vector<std::vector<TileSweep>> lists_;
  std::vector<bool> gone_;
  std::vector<int> levels_, reached_;
  std::optional<TileSweep> alike_;
  std::vector<double> x_, y_, z_, f_;
};

/// Above this nothing of what an upright sweep takes depends on Z: there is only the wall of an
/// endless tool. Infinity: there is no such height. Bits do not depend on Z either, as all that is
/// multiplied with it is 0.
double alike_above_mm(const Sweep& sweep) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const ToolBody& body = *sweep.body;
  const bool upright = sweep.w == Vec3(0, 0, 1) && sweep.u.z == 0 && sweep.v.z == 0;
  if (!body.endless || !upright || sweep.kind == Sweep::Kind::kSphere ||
      sweep.kind == Sweep::Kind::kTurn)
    return kNever;
  double wall = kNever;  // its radius
  for (int i = 0; i < body.count; ++i) {
    const ToolElement& e = body.elements[i];
    const bool vertical = e.arc ? e.n1r == 1 && e.n1z == 0 : e.nr == 1 && e.nz == 0;
    if (vertical) wall = std::min(wall, e.arc ? e.center_r + e.radius : e.offset);
  }
  double height = 0;
  for (int i = 0; i < body.count; ++i) {
    const ToolElement& e = body.elements[i];
    if (e.arc) {
      if (e.n1r != 1 || e.n1z != 0 || !(e.n0z < 0)) return kNever;
      height = std::max(height, e.center_z - e.center_r * (1 - e.n0r) / e.n0z);
    } else if (e.nz > 0 || (e.nz == 0 && e.nr != 1)) {
      return kNever;
    } else if (e.nz < 0) {
      height = std::max(height, (e.offset - wall) / e.nz);
    }
  }
  constexpr double kMargin_mm = 0.1;
  return sweep.origin_mm.z - sweep.origin_above_mm + std::max(0.0, sweep.length_w) + height +
         kMargin_mm;
}

std::vector<double> alike_above_mm(std::span<const Sweep> sweeps) {
  std::vector<double> heights;
  heights.reserve(sweeps.size());
  for (const Sweep& sweep : sweeps) heights.push_back(alike_above_mm(sweep));
  return heights;
}

/// Cuts one column of tiles after the other. One for each thread.
class ColumnCutter {
 public:
  ColumnCutter(BrickTree& tree, const SweepKernel& kernel, std::span<const Sweep> all,
               const std::vector<double>& alike_above_mm, bool additive, std::uint64_t version,
               std::size_t reports, bool seek_films)
      : tree_(tree),
        all_(all),
        alike_above_mm_(alike_above_mm),
        additive_(additive),
        version_(version),
        plan_(tree, kernel),
        cutter_(tree.lattice(), kernel, additive),
        totals_(reports),
        heights_(reports * kBrick * kBrick, 0),
        is_touched_(reports, false) {
    cutter_.seek_films(seek_films && !additive);
  }

  void cut(int column, std::span<const Sweep> sweeps, std::span<const std::uint32_t> mine) {
    plan_.begin(column);
    for (const std::uint32_t s : mine) plan_.add(sweeps[s], alike_above_mm_[s]);
    if (!plan_.any()) return;
    const int levels = tree_.lattice().tiles[2];
    changed_.assign(static_cast<std::size_t>(levels), false);
    for (int stack = 0; stack < kTileBricks * kTileBricks; ++stack) {
      below_.is_known = false;
      for (int level = 0; level < levels; ++level) {
        if (plan_.at(level).empty()) continue;
        for (int layer = 0; layer < kTileBricks; ++layer)
          cut_brick(column, level, layer * kTileBricks * kTileBricks + stack);
      }
      collect_heights();
    }
    for (int level = 0; level < levels; ++level)
      if (changed_[static_cast<std::size_t>(level)]) tree_.settle_tile(column, level);
  }

  const std::vector<MoveTotals>& totals() const { return totals_; }
  const std::vector<FilmSpot>& films() const { return films_; }

 private:
  BrickRef state(int column, int level, int brick) const {
    const TileRef& tile = tree_.tile(column, level);
    if (tile.get()) return tile->bricks[brick];
    return tile.is_solid() ? BrickRef::solid() : BrickRef();
  }

  void cut_brick(int column, int level, int number) {
    const std::vector<TileSweep>& sweeps = plan_.at(level);
    const auto reaches = [&](const TileSweep& t) {
      return ((t.whole | t.some) & bit(number)) != 0;
    };
    std::size_t n = 0;
    while (n < sweeps.size() && !reaches(sweeps[n])) ++n;
    if (n == sweeps.size()) return;
    const BrickRef brick = state(column, level, number);
    if (brick.is_empty()) return;
    const int bz = level * kTileBricks + number / (kTileBricks * kTileBricks);
    find_reaching(sweeps, number);
    if (is_as_below(brick, bz)) {
      for (const Added& a : below_.added) add(a.report, a.volume, a.heights);
      below_.bz = bz;
      leave(column, level, number, below_.changed, below_.after, below_.reached);
      return;
    }
    below_.is_known = false;
    below_.added.clear();
    open_.open(brick);
    cutter_.set_place(plan_.brick_x(number), plan_.brick_y(number), bz);
    bool changed = false;
    bool films = false;
    is_gone_ = false;
    while (n < sweeps.size() && !is_gone_) {
      std::size_t end = n;
      while (end < sweeps.size() && sweeps[end].sweep->report == sweeps[n].sweep->report) ++end;
      const std::span<const TileSweep> move(sweeps.data() + n, end - n);
      n = end;
      if (!cut_move(move, number)) continue;
      changed = true;
      // A piece of the move may have entered and left an edge between two solid nodes, which leaves
      // no crossing, before another piece cleared one of them. Now that there is a crossing, it is
      // seen that it lies within the former.
      if (move.size() > 1 && !is_gone_) cut_move(move, number);
      films = films || !cutter_.films().empty();
      if (!cutter_.films().empty()) note_films(move, number, level);
    }
    const BrickRef after = !changed   ? brick
                           : is_gone_ ? BrickRef()
                                      : open_.close(tree_.keeps_ids());
    leave(column, level, number, changed, after, cutter_.reached());
    if (films || !is_alike_from(bz)) return;
    below_.is_known = true;
    below_.bz = bz;
    below_.sweeps = reaching_;
    below_.before = brick;
    below_.after = after;
    below_.changed = changed;
    below_.reached = cutter_.reached();
  }

  void leave(int column, int level, int number, bool changed, const BrickRef& after,
             unsigned reached) {
    tree_.note_reach(plan_.brick_x(number), plan_.brick_y(number),
                     level * kTileBricks + number / (kTileBricks * kTileBricks), reached);
    if (!changed) return;
    tree_.own_tile(column, level, version_).bricks[number] = after;
    changed_[static_cast<std::size_t>(level)] = true;
  }

  /// Numbers of the sweeps that reach a brick, each twice, and one more if it takes it whole.
  void find_reaching(const std::vector<TileSweep>& sweeps, int number) {
    reaching_.clear();
    for (const TileSweep& t : sweeps) {
      const bool whole = (t.whole & bit(number)) != 0;
      if (!whole && (t.some & bit(number)) == 0) continue;
      reaching_.push_back(2 * static_cast<std::size_t>(t.sweep - all_.data()) + (whole ? 1 : 0));
    }
  }
  /// Nothing that any of them takes from this layer of bricks on depends on Z.
  bool is_alike_from(int bz) const {
    if (additive_) return false;
    const double low_mm = tree_.lattice().place_mm(2, bz * kBrick);
    return std::all_of(reaching_.begin(), reaching_.end(),
                       [&](std::size_t n) { return alike_above_mm_[n / 2] < low_mm; });
  }
  /// It will be what the one below it has become: the walls of a deep slot, layer by layer.
  bool is_as_below(const BrickRef& brick, int bz) const {
    return below_.is_known && below_.bz + 1 == bz && below_.before == brick &&
           below_.sweeps == reaching_;
  }

  /// All pieces of one move, from the open brick. True if it has changed; is_gone_ if it is empty.
  bool cut_move(std::span<const TileSweep> move, int number) {
    bool changed = false;
    for (const TileSweep& t : move) {
      // Nodes outside of the blank have to be told apart where material is added.
      if ((t.whole & bit(number)) != 0 && !additive_) {
        add_own(t.sweep->report, open_.volume, open_.height_of);
        return is_gone_ = true;
      }
      if (((t.whole | t.some) & bit(number)) == 0) continue;
      if (!cutter_.apply(*t.sweep, open_)) continue;
      changed = true;
      add_own(t.sweep->report, cutter_.removed(), cutter_.removed_heights());
      if (open_.top_node < 0) return is_gone_ = true;
    }
    return changed;
  }

  /// Of a move all of whose pieces are cut: what one piece has left another may have taken.
  void note_films(std::span<const TileSweep> move, int number, int level) {
    if (move.size() > 1)
      for (const TileSweep& t : move) cutter_.drop_films(*t.sweep);
    FilmSpot spot;
    spot.report = move[0].sweep->report;
    const auto place = [](int n) { return static_cast<std::uint64_t>(n); };
    const int bz = level * kTileBricks + number / (kTileBricks * kTileBricks);
    spot.brick =
        place(bz) << 42 | place(plan_.brick_y(number)) << 21 | place(plan_.brick_x(number));
    for (const BrickCutter::Film& film : cutter_.films()) {
      spot.faces += film.faces;
      spot.thickness_mm += film.faces * film.thickness_mm;
      spot.at_mm += film.faces * film.at_mm;
    }
    cutter_.forget_films();
    if (spot.faces == 0) return;
    spot.thickness_mm /= spot.faces;
    spot.at_mm /= spot.faces;
    films_.push_back(spot);
  }

  void add_own(std::uint32_t report, std::int64_t volume, const std::int32_t* heights) {
    add(report, volume, heights);
    Added& added = below_.added.emplace_back();
    added.report = report;
    added.volume = volume;
    std::copy_n(heights, kBrick * kBrick, added.heights);
  }

  void add(std::uint32_t report, std::int64_t volume, const std::int32_t* heights) {
    totals_[report].volume += volume;
    std::int32_t* sums = heights_.data() + std::size_t{report} * kBrick * kBrick;
    for (int c = 0; c < kBrick * kBrick; ++c) sums[c] += heights[c];
    if (is_touched_[report]) return;
    is_touched_[report] = true;
    touched_.push_back(report);
  }

  /// After a stack of bricks from the floor to the top.
  void collect_heights() {
    for (const std::uint32_t report : touched_) {
      std::int32_t* sums = heights_.data() + std::size_t{report} * kBrick * kBrick;
      totals_[report].height =
          std::max(totals_[report].height, *std::max_element(sums, sums + kBrick * kBrick));
      std::fill_n(sums, kBrick * kBrick, 0);
      is_touched_[report] = false;
    }
    touched_.clear();
  }

  struct Added {
    std::uint32_t report;
    std::int64_t volume;
    std::int32_t heights[kBrick * kBrick];
  };
  /// The brick that was cut last, below the one at work.
  struct Below {
    bool is_known = false;
    int bz = 0;
    std::vector<std::size_t> sweeps;
    BrickRef before, after;
    bool changed = false;
    unsigned reached = 0;
    std::vector<Added> added;
  };

  BrickTree& tree_;
  std::span<const Sweep> all_;
  const std::vector<double>& alike_above_mm_;  ///< of all_
  std::vector<std::size_t> reaching_;
  Below below_;
  bool additive_;
  std::uint64_t version_;
  ColumnPlan plan_;
  BrickCutter cutter_;
  OpenBrick open_;
  bool is_gone_ = false;
  std::vector<MoveTotals> totals_;
  std::vector<FilmSpot> films_;
  std::vector<std::int32_t> heights_;  ///< of the stack at work, by report
  std::vector<bool> is_touched_;
  std::vector<std::uint32_t> touched_;
  std::vector<bool> changed_;
};

/// Numbers of the sweeps that reach each column.
std::vector<std::vector<std::uint32_t>> by_column(const Lattice& lattice,
                                                  std::span<const Sweep> sweeps) {
  std::vector<std::vector<std::uint32_t>> lists(static_cast<std::size_t>(lattice.column_count()));
  for (std::size_t s = 0; s < sweeps.size(); ++s) {
    const TileRange range = tiles_of(lattice, sweeps[s].box_mm);
    for (int ty = range.low[1]; ty <= range.high[1]; ++ty)
      for (int tx = range.low[0]; tx <= range.high[0]; ++tx)
        lists[static_cast<std::size_t>(ty * lattice.tiles[0] + tx)].push_back(
            static_cast<std::uint32_t>(s));
  }
  return lists;
}

}  // namespace

void cut_tree(BrickTree& tree, std::span<const Sweep> sweeps, const SweepKernel& kernel,
              bool additive, WorkerPool& pool, std::span<MoveTotals> totals,
              std::vector<FilmSpot>* films) {
  if (sweeps.empty()) return;
  const auto lists = by_column(tree.lattice(), sweeps);
  std::vector<int> columns;
  for (std::size_t c = 0; c < lists.size(); ++c)
    if (!lists[c].empty()) columns.push_back(static_cast<int>(c));
  const std::vector<double> alike = alike_above_mm(sweeps);
  tree.own_reach();
  const std::uint64_t version = next_version();
  std::atomic<std::size_t> next{0};
  std::vector<std::vector<MoveTotals>> parts(static_cast<std::size_t>(pool.threads()));
  std::vector<std::vector<FilmSpot>> spots(parts.size());
  pool.run([&](int thread) {
    ColumnCutter cutter(tree, kernel, sweeps, alike, additive, version, totals.size(),
                        films != nullptr);
    for (std::size_t n = next++; n < columns.size(); n = next++)
      cutter.cut(columns[n], sweeps, lists[static_cast<std::size_t>(columns[n])]);
    parts[static_cast<std::size_t>(thread)] = cutter.totals();
    spots[static_cast<std::size_t>(thread)] = cutter.films();
  });
  for (const std::vector<MoveTotals>& part : parts) {
    for (std::size_t i = 0; i < totals.size(); ++i) {
      totals[i].volume += part[i].volume;
      totals[i].height = std::max(totals[i].height, part[i].height);
    }
  }
  if (!films) return;
  for (const std::vector<FilmSpot>& part : spots)
    films->insert(films->end(), part.begin(), part.end());
  std::sort(films->begin(), films->end(), [](const FilmSpot& a, const FilmSpot& b) {
    return std::pair(a.report, a.brick) < std::pair(b.report, b.brick);
  });
}

bool touches_tree(const BrickTree& tree, std::span<const BlankBody> blank,
                  std::span<const Sweep> sweeps, const SweepKernel& kernel) {
  const auto lists = by_column(tree.lattice(), sweeps);
  ColumnPlan plan(tree, kernel);
  BrickCutter cutter(tree.lattice(), kernel, false);
  BlankContact untouched(tree.lattice(), kernel, blank);
  const std::vector<double> alike = alike_above_mm(sweeps);
  OpenBrick open;
  for (int column = 0; column < tree.lattice().column_count(); ++column) {
    const auto& mine = lists[static_cast<std::size_t>(column)];
    if (mine.empty()) continue;
    plan.begin(column);
    for (const std::uint32_t s : mine) plan.add(sweeps[s], alike[s]);
    for (int level = 0; level < tree.lattice().tiles[2]; ++level) {
      for (const TileSweep& t : plan.at(level)) {
        for (std::uint64_t bits = t.whole | t.some; bits != 0; bits &= bits - 1) {
          const int number = std::countr_zero(bits);
          const int bz = level * kTileBricks + number / (kTileBricks * kTileBricks);
          const BrickRef& brick = tree.brick(plan.brick_x(number), plan.brick_y(number), bz);
          if (brick.is_empty()) continue;
          open.open(brick);
          cutter.set_place(plan.brick_x(number), plan.brick_y(number), bz);
          if (cutter.touches(*t.sweep, open)) return true;
          const int bx = plan.brick_x(number), by = plan.brick_y(number);
          if (untouched.touches(*t.sweep, bx, by, bz, tree.untouched(bx, by, bz))) return true;
        }
      }
    }
  }
  return false;
}

std::int32_t greatest_loss(const BrickTree& before, const BrickTree& after, const BrickTree* exact,
                           std::int32_t slack) {
  const Lattice& lattice = before.lattice();
  std::vector<bool> differs(static_cast<std::size_t>(lattice.column_count()), false);
  for (const std::uint32_t tile : before.differing(after))
    differs[tile % static_cast<std::size_t>(lattice.column_count())] = true;
  OpenBrick open;
  std::int32_t greatest = 0;
  // Of a stack of bricks, by column.
  std::int32_t lost[kBrick * kBrick], lost_exactly[kBrick * kBrick];
  const auto add = [&](const BrickRef& brick, std::int32_t sign, std::int32_t* sums) {
    if (brick.is_empty()) return;
    open.open(brick);
    for (int c = 0; c < kBrick * kBrick; ++c) sums[c] += sign * open.height_of[c];
  };
  for (int stack = 0; stack < lattice.column_count() * kTileBricks * kTileBricks; ++stack) {
    const int column = stack / (kTileBricks * kTileBricks), n = stack % (kTileBricks * kTileBricks);
    if (!differs[static_cast<std::size_t>(column)]) continue;
    const int bx = column % lattice.tiles[0] * kTileBricks + n % kTileBricks;
    const int by = column / lattice.tiles[0] * kTileBricks + n / kTileBricks;
    std::fill(std::begin(lost), std::end(lost), 0);
    std::fill(std::begin(lost_exactly), std::end(lost_exactly), 0);
    for (int bz = 0; bz < lattice.tiles[2] * kTileBricks; ++bz) {
      add(before.brick(bx, by, bz), 1, lost);
      add(after.brick(bx, by, bz), -1, lost);
      if (!exact) continue;
      add(before.brick(bx, by, bz), 1, lost_exactly);
      add(exact->brick(bx, by, bz), -1, lost_exactly);
    }
    for (int c = 0; c < kBrick * kBrick; ++c) {
      if (lost[c] <= 0) continue;
      const std::int32_t most = lost[c] + slack;
      greatest = std::max(greatest, exact ? std::clamp(lost_exactly[c], lost[c], most) : most);
    }
  }
  return greatest;
}

}  // namespace kerf::octree
