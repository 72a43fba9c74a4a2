#include "twin/job/placed_stock.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/translate.h"
#include "stock/millturn/mill_turn.h"
#include "stock/octree/octree.h"
#include "stock/turning/turning_stock.h"
#include "stock/zmap/mmap/placed_columns.h"

namespace kerf {
namespace {

/// A place in an octree is a whole number of so many parts of a cell.
constexpr double kEdgeParts = 65536;
/// Surfaces of octrees are whole up to less than that; boxes are rounded to it.
constexpr double kBoxStep_mm = 1e-4;

/// A lathe takes it as it was, or turned about, or farther along its axis.
Result<std::unique_ptr<StockModel>> placed_part(const StockModel& stock, const Placement& placement,
                                                const StockSettings& settings) {
  const std::optional<AxisTurn> turn = placement.by_axes();
  const bool is_about = turn && *turn == AxisTurn{{0, 1, 2}, {1, -1, -1}};
  if (!turn || (!is_about && *turn != AxisTurn{}) || placement.at_mm.x != 0 ||
      placement.at_mm.y != 0) {
    return Error{tr(
        "a part that is turned stays at X0 Y0 for a lathe: flip=x turns it about, at=0,0,z moves "
        "it")};
  }
  if (const auto* const both = dynamic_cast<const MillTurn*>(&stock); both && both->is_milled())
    return Error{
        tr("it has been milled as well; a lathe goes on with it as it lies, a mill in any way")};
  const double z_mm = placement.at_mm.z;
  const TurnedPart& part = stock.turned()->part();
  std::optional<TurnedPart> lies = is_about ? part.turned_about(z_mm) : part.moved(z_mm);
  if (!lies) {
    return Error{trf("at Z{:g} it would lie beyond {} mm from Z0", z_mm, kMaxTurnedZ_mm)};
  }
  return with_milling(std::make_unique<TurningStock>(std::move(*lies)), settings);
}

/// In cells of `cell_mm`, by the finest surface that the model has.
Result<PlacedStock> by_surface(const StockModel& stock, const Placement& placement, double cell_mm,
                               const StockSettings& settings) {
  const TriangleMesh mesh = stock.mesh(0);
  if (mesh.triangles.empty()) return Error{tr("nothing of the workpiece is left")};
  auto tree = Octree::of_surface(mesh, placement, cell_mm, settings.threads, stock.blank_mm3());
  if (!tree) return Error{tree.error()};
  PlacedStock out;
  out.carried.bound_mm = Octree::surface_bound_mm(cell_mm);
  out.stock = std::move(tree.value());
  return out;
}

double cell_for(const StockModel& stock, const StockSettings& settings) {
  if (settings.cell_mm > 0) return settings.cell_mm;
  const double suited_mm = octree_cell_mm(stock.bounds_mm());
  return stock.turned() ? suited_mm : std::max(stock.cell_mm(), suited_mm);
}

/// By its exact profile where it stands, then as an octree is laid elsewhere.
Result<PlacedStock> placed_profile(const StockModel& stock, const Placement& placement,
                                   const StockSettings& settings) {
  const auto* const both = dynamic_cast<const MillTurn*>(&stock);
  std::unique_ptr<MillTurn> fresh;
  if (both == nullptr || (!both->is_milled() && settings.cell_mm > 0)) {
    auto made = MillTurn::create(TurningStock(stock.turned()->part()),
                                 {cell_for(stock, settings), settings.threads});
    if (!made) return Error{made.error()};
    fresh = std::move(made.value());
  }
  std::unique_ptr<Octree> tree = (fresh ? *fresh : *both).as_octree();
  const double cell_mm = tree->cell_mm();
  PlacedStock out;
  if (const std::optional<AxisTurn> turn = placement.by_axes()) {
    out.stock = tree->placed(*turn, placement.at_mm);
    out.carried.bound_mm = Octree::surface_bound_mm(cell_mm);  // nodes are exact here, too
  } else {
    Result<PlacedStock> anew = by_surface(*tree, placement, cell_mm, settings);
    if (!anew) return anew;
    out = std::move(anew.value());
  }
  if (!stock.turned()->part().threads().empty())
    out.carried.note = tr("its threads are plain cylinders and cones from here on");
  return out;
}

Result<PlacedStock> placed_solid(const StockModel& stock, const Placement& placement,
                                 bool needs_octree, const StockSettings& settings) {
  const std::optional<AxisTurn> turn = placement.by_axes();
  const auto* const tree = dynamic_cast<const Octree*>(&stock);
  if (turn && tree) {
    PlacedStock out;
    out.stock = tree->placed(*turn, placement.at_mm);
    out.carried.bound_mm = stock.cell_mm() / kEdgeParts;
    return out;
  }
  if (turn && turn->keeps_z() && !needs_octree) {
    auto columns = placed_columns(stock, *turn, placement.at_mm, settings.threads, settings.kernel);
    if (!columns) return Error{columns.error()};
    PlacedStock out;
    out.stock = std::move(columns->stock);
    out.carried.bound_mm = columns->bound_mm;
    return out;
  }
  return by_surface(stock, placement, cell_for(stock, settings), settings);
}

}  // namespace

Box solid_bounds(const StockModel& stock) {
  Box box;
  for (const glm::vec3& p : stock.mesh(0).positions_mm) box.extend(Vec3(p));
  if (box.empty()) return box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::round(box.min[axis] / kBoxStep_mm) * kBoxStep_mm;
    box.max[axis] = std::round(box.max[axis] / kBoxStep_mm) * kBoxStep_mm;
  }
  return box;
}

Result<PlacedStock> place_stock(std::unique_ptr<StockModel> stock, const Placement& placement,
                                bool needs_octree, bool lathe, const StockSettings& settings) {
  const StockKind kind = row_of(*stock).kind;
  const std::string from = stock->name();
  PlacedStock out;
  if (kind == StockKind::kSheet && !placement.is_as_is()) {
    return Error{tr("a sheet is cut as it lies; it is not turned or moved")};
  }
  const auto* const tree = dynamic_cast<const Octree*>(stock.get());
  if (tree != nullptr && tree->is_additive() && !placement.is_as_is()) {
    return Error{tr("material was added to it; such a workpiece stays as it lies")};
  }
  const bool is_held = !needs_octree || kind == StockKind::kOctree;
  const bool goes_on = kind != StockKind::kTurning || lathe;
  if (placement.is_as_is() && is_held && goes_on) {
    out.stock = std::move(stock);
  } else if (kind == StockKind::kSheet) {
    return Error{tr("a sheet has no octree: it is cut by torches and punches alone")};
  } else if (kind == StockKind::kTurning && lathe) {
    auto part = placed_part(*stock, placement, settings);
    if (!part) return Error{part.error()};
    out.stock = std::move(part.value());
  } else {
    auto placed = kind == StockKind::kTurning
                      ? placed_profile(*stock, placement, settings)
                      : placed_solid(*stock, placement, needs_octree, settings);
    if (!placed) return Error{placed.error()};
    out = std::move(placed.value());
  }
  out.carried.from = from;
  out.carried.to = out.stock->name();
  return out;
}

}  // namespace kerf
