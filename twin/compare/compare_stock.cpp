#include "twin/compare/compare_stock.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "mesh/column_lines.h"
#include "stock/turning/turned_surface.h"
#include "twin/compare/compare_heights.h"
#include "twin/compare/compare_patches.h"
#include "twin/compare/deviation_sums.h"
#include "twin/process/kept_moves.h"

namespace kerf {
namespace {

/// Heights are kept in single precision, within this of the envelopes; mm.
constexpr double kHeights_mm = 2e-4;
/// What sharpen() stops at, on the steepest slope that is no wall.
constexpr double kSharpened_cells = 1.0 / 20;
/// Octrees hold faces and edges where they are, to this; measured by tests/twin/compare/planted.
constexpr double kOctree_cells = 0.08;
/// A cutter whose end rises by more than this part of the tolerance within half a cell is pointed.
constexpr double kPointed = 0.25;

bool has_contours(const StockModel& stock) {
  return stock.sheet() != nullptr || is_turned_alone(stock);
}

SurfaceDoubt doubt_of(const StockModel& stock) {
  const double cell = stock.cell_mm();
  if (has_contours(stock)) return {};
  // A wall is anywhere between the middles of two cells, a corner of walls of three.
  if (stock.name() == "mmap") return {0, std::numbers::sqrt2 / 2 * cell};
  return {kOctree_cells * cell, 0};
}

CutBy named(std::uint32_t label, std::span<const CutLabel> labels) {
  if (label >= labels.size()) return {};
  return {labels[label].source, labels[label].tool};
}

/// The points of pointed cutters, which leave grooves narrower than a cell.
void add_tips(const DesignPart& design, const KeptMoves& kept, double cell_mm,
              DeviationSums& sums) {
  const double tolerance = sums.tolerance_mm();
  const Box box = design.box_mm();
  const auto is_beside = [&](const Vec3& p) {
    return p.x < box.min.x || p.y < box.min.y || p.z < box.min.z || p.x > box.max.x ||
           p.y > box.max.y || p.z > box.max.z;
  };
  DesignProbe probe(design);
  std::vector<Vec3> tips;
  const Cutter* last = nullptr;
  bool is_pointed = false;
  for (std::size_t move = 0; move < kept.size(); ++move) {
    const Cutter& cutter = kept.cutter_of(move);
    if (&cutter != last) {
      last = &cutter;
      const double r = std::min(0.5 * cell_mm, cutter.radius_mm());
      is_pointed = cutter.height_mm(r) > kPointed * tolerance;
    }
    if (!is_pointed) continue;
    kept.tips_of(move, 0.5 * cell_mm, tips);
    for (const Vec3& tip : tips) {
      if (is_beside(tip) || probe.distance_mm(tip, 2 * tolerance) > -tolerance) continue;
      SurfaceSample sample{tip, probe.distance_mm(tip, std::numeric_limits<double>::infinity())};
      sample.cut_by = kept.label_of(move);
      sample.is_extra = true;
      sums.add(sample);
    }
  }
}

DeviationRegion told(FoundRegion& found, const DesignPart& design, double cell_mm,
                     const CutHistory& history, const KeptMoves* exact) {
  if (exact != nullptr) sharpen(design, *exact, cell_mm, found);
  DeviationRegion region;
  region.is_gouge = found.is_gouge;
  region.worst = {found.worst_mm, found.at_mm, named(found.cut_by, history.labels), 0};
  if (!found.is_gouge && region.worst.by.source.line == 0 && history.kept != nullptr) {
    if (const std::optional<KeptMoves::Pass> pass = history.kept->nearest_pass(found.at_mm)) {
      region.worst.by = named(pass->label, history.labels);
      region.worst.pass_distance_mm = pass->distance_mm;
    }
  }
  region.box_mm = found.box_mm;
  region.area_mm2 = found.area_mm2;
  region.volume_mm3 = found.volume_mm3;
  for (const auto& [label, volume] : found.cut_by_mm3) {
    const CutBy by = named(label, history.labels);
    if (by.source.line == 0 || region.by.size() == DeviationRegion::kMostLines) continue;
    region.by.push_back(by);
  }
  return region;
}

double outside_of(const DesignPart& design, const Box& blank) {
  // What is cut off by each side of the box, by lines through the design along Z.
  const Box box = design.box_mm();
  const bool is_within = box.min.x >= blank.min.x && box.min.y >= blank.min.y &&
                         box.min.z >= blank.min.z && box.max.x <= blank.max.x &&
                         box.max.y <= blank.max.y && box.max.z <= blank.max.z;
  if (is_within) return 0;
  constexpr int kLines = 400;
  const ColumnGrid grid{box, kLines, kLines};
  std::vector<float> inside(grid.size(), 0.0f);
  const float outward = design.is_inside_out() ? -1.0f : 1.0f;
  const auto low = static_cast<float>(blank.min.z), high = static_cast<float>(blank.max.z);
  for (std::uint32_t t = 0; t < design.size(); ++t) {
    each_column_line(design.corners(t), grid, [&](std::size_t at, float z, int up) {
      inside[at] += static_cast<float>(up) * outward * std::clamp(z, low, high);
    });
  }
  const Vec2 cell = grid.cell_mm();
  double sum = 0;
  for (int j = 0; j < kLines; ++j) {
    for (int i = 0; i < kLines; ++i) {
      const Vec2 xy = grid.center(i, j);
      if (xy.x < blank.min.x || xy.y < blank.min.y || xy.x > blank.max.x || xy.y > blank.max.y)
        continue;
      sum += static_cast<double>(
          inside[static_cast<std::size_t>(j) * kLines + static_cast<std::size_t>(i)]);
    }
  }
  return std::max(0.0, std::abs(design.facts().volume_mm3) - sum * cell.x * cell.y);
}

}  // namespace

Comparison compare_stock(const StockModel& shown, const DesignPart& design,
                         const CompareSettings& settings, const CutHistory& history) {
  const auto begin = std::chrono::steady_clock::now();
  const StockModel& stock = shown.bare();
  const double cell = detail_cell_mm(stock);
  const KeptMoves* const exact =
      history.kept != nullptr && history.kept->is_exact() ? history.kept : nullptr;
  Comparison out;
  out.triangles = design.size();
  out.tolerance_mm = settings.tolerance_mm;
  DeviationSums sums(settings.tolerance_mm, cell);
  const std::shared_ptr<const HeightGrid> heights = stock.height_grid();
  if (heights) {
    const HeightComparison found = compare_heights(stock, *heights, design, exact, sums);
    if (!found.has_exact_walls) out.walls_mm = 0.5 * cell;
    if (exact != nullptr) add_tips(design, *exact, cell, sums);
  } else {
    const SurfaceDoubt doubt = doubt_of(stock);
    compare_patches(stock, cell, design, doubt, sums);
    out.walls_mm = doubt.most_mm();
  }
  out.bound_mm = kHeights_mm + (heights ? kSharpened_cells * cell : 0.25 * settings.tolerance_mm);
  std::vector<FoundRegion> regions = sums.regions();
  std::size_t told_of_kind = 0;
  bool was_gouge = true;
  for (FoundRegion& found : regions) {
    if (found.is_gouge != was_gouge) told_of_kind = 0;
    was_gouge = found.is_gouge;
    ++(found.is_gouge ? out.gouges : out.excesses);
    if (told_of_kind++ >= Comparison::kMostRegions) continue;
    out.regions.push_back(told(found, design, cell, history, heights ? exact : nullptr));
    DeviationPlace& worst = found.is_gouge ? out.gouge : out.excess;
    if (out.regions.back().worst.mm > worst.mm) worst = out.regions.back().worst;
  }
  std::ranges::stable_sort(out.regions, [](const DeviationRegion& a, const DeviationRegion& b) {
    return a.is_gouge != b.is_gouge ? a.is_gouge : a.worst.mm > b.worst.mm;
  });
  out.gouge_mm3 = sums.volume_mm3(true);
  out.excess_mm3 = sums.volume_mm3(false);
  out.area_mm2 = sums.area_mm2();
  out.within_mm2 = sums.within_mm2();
  out.histogram = sums.histogram();
  out.outside_mm3 = outside_of(design, stock.bounds_mm());
  if (out.gouges > 0) {
    out.verdict = CompareVerdict::kGouged;
  } else if (out.excesses > 0) {
    out.verdict = CompareVerdict::kExcessLeft;
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace kerf
