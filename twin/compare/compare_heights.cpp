#include "twin/compare/compare_heights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "mesh/column_lines.h"
#include "twin/compare/design_columns.h"
#include "twin/compare/wall_finder.h"

namespace kerf {
namespace {

/// Faces of the blank that nobody has cut are looked at in every third cell, walls as often from
/// their foot to their top: so what hangs together does in DeviationSums.
constexpr int kFaceStep = 3;
constexpr double kWallStep_cells = 2.5;
/// A vertical distance of this part of the tolerance need not be looked at more closely: the true
/// one is no greater.
constexpr double kSurelyWithin = 0.5;
/// Points that are looked at in a column for what no surface shows.
constexpr int kHiddenPoints = 64;
constexpr double kFinestHidden_mm = 0.005;

class HeightComparer {
 public:
  HeightComparer(const StockModel& stock, const HeightGrid& grid, const DesignPart& design,
                 const KeptMoves* kept, DeviationSums& sums)
      : stock_(stock),
        sums_(sums),
        tolerance_mm_(sums.tolerance_mm()),
        grid_{grid.bounds_mm(), grid.nx(), grid.ny()},
        cell_(grid_.cell_mm()),
        cell_mm2_(cell_.x * cell_.y),
        floor_(grid.floor_mm()),
        heights_(flat(grid)),
        columns_(design, grid_, heights_),
        probe_(design),
        walls_(kept, grid_) {}

  bool run() {
    kinds_.assign(grid_.size(), Kind::kWithin);
    for (int j = 0; j < grid_.ny; ++j)
      for (int i = 0; i < grid_.nx; ++i) add_cell(i, j);
    add_floor();
    for (int j = 0; j < grid_.ny; ++j) {
      for (int i = 0; i < grid_.nx; ++i) {
        if (i + 1 < grid_.nx) add_step(i, j, 0);
        if (j + 1 < grid_.ny) add_step(i, j, 1);
      }
    }
    add_sides();
    return walls_.all_found();
  }

 private:
  enum class Kind : std::uint8_t { kWithin, kExcess, kGouge };

  static std::vector<float> flat(const HeightGrid& grid) {
    std::vector<float> out(static_cast<std::size_t>(grid.nx()) *
                           static_cast<std::size_t>(grid.ny()));
    std::size_t at = 0;
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) out[at++] = grid.height(i, j);
    return out;
  }

  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.nx) +
           static_cast<std::size_t>(i);
  }
  bool is_solid(std::size_t at) const { return heights_[at] > floor_; }
  double distance(const Vec3& p) {
    return probe_.distance_mm(p, std::numeric_limits<double>::infinity());
  }
  /// 0 inside the design, where a ball about the last such place is known to lie. Far inside all
  /// its triangles may be about as near, and finding the nearest takes long.
  double outer_distance(const Vec3& p) {
    if (glm::distance(p, inner_at_mm_) < inner_mm_) return 0;
    const double deviation = distance(p);
    if (deviation >= 0) return deviation;
    inner_mm_ = -deviation;
    inner_at_mm_ = p;
    return 0;
  }
  Kind kind_of(double deviation) const {
    if (deviation < -tolerance_mm_) return Kind::kGouge;
    return deviation > tolerance_mm_ ? Kind::kExcess : Kind::kWithin;
  }
  std::uint32_t cut_by(const Vec3& p) const {
    return stock_.cut_id_at(p).value_or(MeshPatch::kNotCut);
  }

  /// The step to the next cell along an axis, and whether it is part of a smooth surface. Beyond
  /// the grid, and where one of them has no material, there is none.
  struct Step {
    float rise = 0;
    bool is_smooth = false;
    bool is_wall = false;
  };
  float rise(int i, int j, int axis) const {
    const int i1 = i + (axis == 0 ? 1 : 0), j1 = j + (axis == 1 ? 1 : 0);
    if (i < 0 || j < 0 || i1 >= grid_.nx || j1 >= grid_.ny) return 0;
    const std::size_t a = index(i, j), b = index(i1, j1);
    return is_solid(a) && is_solid(b) ? heights_[b] - heights_[a] : 0;
  }
  Step step(int i, int j, int axis) const {
    const int i1 = i + (axis == 0 ? 1 : 0), j1 = j + (axis == 1 ? 1 : 0);
    if (i < 0 || j < 0 || i1 >= grid_.nx || j1 >= grid_.ny) return {};
    const std::size_t a = index(i, j), b = index(i1, j1);
    const float up = heights_[b] - heights_[a];
    const auto edge = static_cast<float>(std::max(cell_.x, cell_.y));
    if (is_solid(a) != is_solid(b)) return {up, false, true};
    if (!is_solid(a)) return {};
    if (std::abs(up) <= SurfaceSlopes::kSmooth * edge) return {up, true, false};
    const int di = axis == 0 ? 1 : 0, dj = axis == 1 ? 1 : 0;
    const bool smooth =
        SurfaceSlopes::is_smooth(up, rise(i - di, j - dj, axis), rise(i + di, j + dj, axis), edge);
    return {up, smooth, !smooth};
  }
  double slope(int i, int j, int axis) const {
    const Step before = step(i - (axis == 0 ? 1 : 0), j - (axis == 1 ? 1 : 0), axis);
    const Step after = step(i, j, axis);
    double sum = 0;
    int count = 0;
    for (const Step& s : {before, after}) {
      if (!s.is_smooth) continue;
      sum += static_cast<double>(s.rise);
      ++count;
    }
    return count > 0 ? sum / count / (axis == 0 ? cell_.x : cell_.y) : 0;
  }

  void add_cell(int i, int j) {
    const std::size_t at = index(i, j);
    const double height = static_cast<double>(heights_[at]);
    const double above = static_cast<double>(std::max(0.0f, columns_.above_mm(at)));
    const Vec3 p(grid_.center(i, j), height);
    if (!is_solid(at)) {
      if (above > tolerance_mm_) add_hidden(p, grid_.bounds_mm.max.z, above, true, at);
      return;
    }
    double deviation;
    const float top = columns_.top_mm(at);
    const double rise = height - static_cast<double>(top);
    if (std::abs(rise) <= kSurelyWithin * tolerance_mm_) {
      deviation = rise;
    } else {
      deviation = distance(p);
    }
    const double gx = slope(i, j, 0), gy = slope(i, j, 1);
    SurfaceSample sample{p, deviation, cell_mm2_ * std::sqrt(1 + gx * gx + gy * gy)};
    kinds_[at] = kind_of(deviation);
    const double left = std::max(0.0, height - static_cast<double>(floor_) - below(at));
    if (kinds_[at] != Kind::kWithin) {
      sample.cut_by = cut_by(p);
      sample.volume_mm3 = cell_mm2_ * (kinds_[at] == Kind::kGouge ? above : left);
    }
    sums_.add(sample);
    if (kinds_[at] != Kind::kGouge && above > 2 * tolerance_mm_ + std::abs(deviation))
      add_hidden(p, grid_.bounds_mm.max.z, above, true, at);
    // What the floor shows, or the top, is counted there.
    const double under = columns_.bottom_mm(at) == DesignColumns::kNone
                             ? left
                             : static_cast<double>(columns_.bottom_mm(at) - floor_);
    if (kinds_[at] != Kind::kExcess &&
        left - std::max(0.0, under) > 2 * tolerance_mm_ + std::abs(deviation))
      add_hidden(Vec3(Vec2(p), static_cast<double>(floor_)), height, left, false, at);
  }
  double below(std::size_t at) const {
    return static_cast<double>(std::max(0.0f, columns_.below_mm(at)));
  }

  /// Of a column that has `length_mm` of the design above the workpiece (gouge), or of the
  /// workpiece beside the design (excess), while its surface is where it should be: a roof that is
  /// gone, a hollow that is not.
  void add_hidden(const Vec3& from, double to_z, double length_mm, bool is_gouge, std::size_t at) {
    const double whole = to_z - from.z;
    if (!(whole > 0)) return;
    const int points =
        static_cast<int>(std::clamp(std::ceil(2 * whole / length_mm), 2.0, double{kHiddenPoints}));
    double worst = 0;
    Vec3 place(0);
    for (int n = 0; n < points; ++n) {
      const Vec3 p(Vec2(from), from.z + whole * (n + 0.5) / points);
      const double deviation = distance(p);
      if (is_gouge ? deviation < worst : deviation > worst) {
        worst = deviation;
        place = p;
      }
    }
    for (double step = 0.5 * whole / points; step > kFinestHidden_mm; step *= 0.5) {
      for (const double z : {place.z - step, place.z + step}) {
        const Vec3 p(Vec2(from), z);
        if (worst == 0 || z < from.z || z > to_z) continue;
        const double deviation = distance(p);
        if (!(is_gouge ? deviation < worst : deviation > worst)) continue;
        worst = deviation;
        place = p;
      }
    }
    const Kind kind = kind_of(worst);
    if (kind == Kind::kWithin) return;
    if (kinds_[at] == Kind::kWithin) kinds_[at] = kind;
    SurfaceSample sample{place, worst, 0, length_mm * cell_mm2_};
    sample.cut_by = cut_by(Vec3(Vec2(from), static_cast<double>(heights_[at])));
    sample.is_extra = true;
    sums_.add(sample);
  }

  /// The lower face of the blank.
  void add_floor() {
    for (int j = kFaceStep / 2; j < grid_.ny; j += kFaceStep) {
      for (int i = kFaceStep / 2; i < grid_.nx; i += kFaceStep) {
        const std::size_t at = index(i, j);
        if (!is_solid(at)) continue;
        const Vec3 p(grid_.center(i, j), static_cast<double>(floor_));
        const double rise = static_cast<double>(columns_.bottom_mm(at)) - p.z;
        // Nothing is gouged from below; the design goes on below the blank.
        const double deviation =
            std::abs(rise) <= kSurelyWithin * tolerance_mm_ ? rise : outer_distance(p);
        SurfaceSample sample{p, deviation, cell_mm2_ * kFaceStep * kFaceStep, 0,
                             MeshPatch::kNotCut};
        if (kind_of(deviation) == Kind::kExcess && kinds_[at] != Kind::kExcess) {
          const double height = static_cast<double>(heights_[at]);
          sample.volume_mm3 = sample.area_mm2 * std::max(0.0, height - p.z - below(at));
        }
        sums_.add(sample);
      }
    }
  }

  void add_step(int i, int j, int axis) {
    if (!step(i, j, axis).is_wall) return;
    const int i1 = i + (axis == 0 ? 1 : 0), j1 = j + (axis == 1 ? 1 : 0);
    const std::size_t a = index(i, j), b = index(i1, j1);
    const bool a_is_low = heights_[a] < heights_[b];
    const std::size_t low = a_is_low ? a : b, high = a_is_low ? b : a;
    const Vec2 from = a_is_low ? grid_.center(i, j) : grid_.center(i1, j1);
    const Vec2 to = a_is_low ? grid_.center(i1, j1) : grid_.center(i, j);
    const double across = axis == 0 ? cell_.x : cell_.y, along = axis == 0 ? cell_.y : cell_.x;
    const double foot = static_cast<double>(heights_[low]);
    const double rise = static_cast<double>(heights_[high]) - foot;
    const int points =
        static_cast<int>(std::max(1.0, std::ceil(rise / (kWallStep_cells * across))));
    const auto z_of = [&](int n) { return foot + rise * (n + 0.5) / points; };
    const auto place = [&](int n) { return walls_.find(from, to, z_of(n)); };
    const WallFinder::Place first = place(0), last = points > 1 ? place(points - 1) : first;
    // A tool cuts as far out above as it does below: in between the wall lies in between.
    const bool is_straight =
        std::abs(last.share - first.share) <= kStraight_cells && last.label == first.label;
    for (int n = 0; n < points; ++n) {
      const bool is_known = is_straight || n == 0 || n + 1 == points;
      const WallFinder::Place found = !is_known ? place(n) : (n + 1 == points ? last : first);
      const Vec3 p(from + found.share * (to - from), z_of(n));
      double deviation = distance(p);
      if (!found.is_exact) {
        const double sure = std::max(0.0, std::abs(deviation) - 0.5 * across);
        deviation = std::copysign(sure, deviation);
      }
      SurfaceSample sample{p, deviation, along * rise / points};
      const Kind kind = kind_of(deviation);
      if (kind != Kind::kWithin) {
        sample.cut_by = found.is_exact ? found.label : cut_by(p);
        sample.volume_mm3 =
            sample.area_mm2 * thickness(found.share, across, std::abs(deviation), kind,
                                        kind == Kind::kGouge ? kinds_[low] : kinds_[high]);
      }
      sums_.add(sample);
    }
  }
  static constexpr double kStraight_cells = 0.02;

  /// Of gouge or excess what the columns of the cells do not count: these end at the border of the
  /// two cells, the wall need not.
  double thickness(double share, double across, double deviation, Kind kind, Kind column) const {
    if (column != kind) return deviation;
    return (kind == Kind::kGouge ? share - 0.5 : 0.5 - share) * across;
  }

  /// The four sides of the blank's box.
  void add_sides() {
    for (int i = 0; i < grid_.nx; i += kFaceStep) {
      add_side(i, 0, 1, grid_.bounds_mm.min.y);
      add_side(i, grid_.ny - 1, 1, grid_.bounds_mm.max.y);
    }
    for (int j = 0; j < grid_.ny; j += kFaceStep) {
      add_side(0, j, 0, grid_.bounds_mm.min.x);
      add_side(grid_.nx - 1, j, 0, grid_.bounds_mm.max.x);
    }
  }
  void add_side(int i, int j, int axis, double border) {
    const std::size_t at = index(i, j);
    if (!is_solid(at)) return;
    const double across = kFaceStep * (axis == 0 ? cell_.y : cell_.x);
    const double rise = static_cast<double>(heights_[at]) - static_cast<double>(floor_);
    const int points = std::max(1, static_cast<int>(std::ceil(rise / across)));
    Vec3 p(grid_.center(i, j), 0);
    p[axis] = border;
    for (int n = 0; n < points; ++n) {
      p.z = static_cast<double>(floor_) + rise * (n + 0.5) / points;
      const double deviation = outer_distance(p);  // the design goes on beyond the blank
      sums_.add({p, deviation, across * rise / points, 0, MeshPatch::kNotCut});
    }
  }

  const StockModel& stock_;
  DeviationSums& sums_;
  double tolerance_mm_;
  ColumnGrid grid_;
  Vec2 cell_;
  double cell_mm2_;
  float floor_;
  std::vector<float> heights_;
  DesignColumns columns_;
  DesignProbe probe_;
  WallFinder walls_;
  std::vector<Kind> kinds_;
  double inner_mm_ = 0;
  Vec3 inner_at_mm_{0};
};

}  // namespace

HeightComparison compare_heights(const StockModel& stock, const HeightGrid& heights,
                                 const DesignPart& design, const KeptMoves* kept,
                                 DeviationSums& sums) {
  HeightComparer comparer(stock, heights, design, kept, sums);
  return {comparer.run()};
}

bool sharpen(const DesignPart& design, const KeptMoves& kept, double cell_mm, FoundRegion& region) {
  constexpr int kHalvings = 6;
  const Vec3 reach(1.5 * cell_mm, 1.5 * cell_mm, 0);
  Box box{region.at_mm - reach, region.at_mm + reach};
  box.max.z = std::numeric_limits<double>::infinity();
  const KeptMoves::Near near(kept, box);
  DesignProbe probe(design);
  const double sign = region.is_gouge ? -1 : 1;
  Vec2 best(region.at_mm);
  bool is_better = false;
  double step = 0.5 * cell_mm;
  const Vec3 start = region.at_mm;
  for (int halving = 0; halving <= kHalvings;) {
    bool has_moved = false;
    const Vec2 middle = best;
    for (int n = 0; n < 9; ++n) {
      const Vec2 xy = middle + step * Vec2(n % 3 - 1, n / 3 - 1);
      if (std::abs(xy.x - start.x) > reach.x || std::abs(xy.y - start.y) > reach.y) continue;
      const KeptMoves::Lowest lowest = near.lowest(xy);
      if (!std::isfinite(lowest.z_mm)) continue;
      const Vec3 p(xy, lowest.z_mm);
      const double size = sign * probe.distance_mm(p, std::numeric_limits<double>::infinity());
      if (!(size > region.worst_mm)) continue;
      region.worst_mm = size;
      region.at_mm = p;
      region.cut_by = lowest.label;
      region.box_mm.extend(p);
      best = xy;
      has_moved = is_better = true;
    }
    if (has_moved) continue;
    step *= 0.5;
    ++halving;
  }
  return is_better;
}

}  // namespace kerf
