// stock/octree/part_contact.h - shank, holder, spindle against the material of a tree. Reads only.
#pragma once

#include <optional>
#include <span>

#include "stock/blank.h"
#include "stock/octree/brick_tree.h"
#include "stock/octree/sweep_kernel.h"
#include "stock/octree/tool_bodies.h"
#include "stock/stock_model.h"

namespace kerf::octree {

/// What is searched.
struct PartField {
  const BrickTree& tree;
  const SweepKernel& kernel;
  std::span<const BlankBody> blank;  ///< what the tree was made of; empty: nobody knows
};

/// StockModel::part_contact() of any move, at any tilt. `flutes`: the cutter's bodies up to the end
/// of its flutes.
///
/// Material is its nodes and crossings, and where nothing has come yet the blank itself
/// (BlankContact): there the part is told from the tolerance on, whatever the cells, except within
/// four cells of what this move cuts. Elsewhere a corner of material may be missed by less than a
/// cell; nothing is told that is no material. Each point counts from the time when the part comes
/// there, if it is not within what the flutes have swept until then (and the tolerance around
/// that): found by halving the move wherever both come to a point.
///
/// The first t is that of points, or of the exact blank, by halving; the depth as well, by making
/// the part shorter from below. Cost: bricks that the part does not come near cost some ns each;
/// where it is in material, about a microsecond for each node there.
std::optional<PartContact> find_part_contact(const PartField& field,
                                             std::span<const ToolBody> flutes,
                                             const CarriedPart& part, const CutMove& move,
                                             double tolerance_mm);

/// StockModel::part_spare_mm(): by bricks, and closer than `enough_mm` by crossings less the
/// diagonal of a cell.
double part_spare_mm(const PartField& field, const CarriedPart& part, const CutMove& move,
                     double enough_mm, double most_mm);

/// StockModel::part_gap(): the nearest crossing of those that `cutter` does not take on this move,
/// too great by less than a cell; and the nearest point of the blank where nothing has come yet.
std::optional<PartGap> find_part_gap(const PartField& field, std::span<const ToolBody> cutter,
                                     const CarriedPart& part, const CutMove& move, double below_mm);

}  // namespace kerf::octree
