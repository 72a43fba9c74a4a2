// twin/page/page_mesh.h - the surface of a workpiece, small enough to be handed on in a page.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/geometry.h"
#include "stock/stock_model.h"
#include "twin/compare/design_part.h"

namespace kerf {

/// Triangles counter-clockwise seen from outside; corners are shared.
struct PageMesh {
  Box box_mm;                            ///< in which `places` lie
  std::vector<std::uint16_t> places;     ///< three a corner: X, Y, Z in 65535ths of the box
  std::vector<std::uint32_t> triangles;  ///< three a triangle
  std::vector<std::uint8_t> groups;      ///< one a triangle, of who cut it; empty: not asked for
  std::vector<std::uint8_t> deviations;  ///< one a triangle, a DeviationClass; empty: not asked for
  std::size_t full_triangles = 0;        ///< of the surface that it was made from
  /// How far the full surface's corners are from this one at most, mm: by `measured` of them,
  /// spread evenly.
  double deviation_mm = 0;
  std::size_t measured = 0;
};

/// By the tolerance, and twice that.
enum class DeviationClass : std::uint8_t { kDeepGouge, kGouge, kWithin, kExcess, kHighExcess };
inline constexpr std::size_t kDeviationClasses = 5;
DeviationClass deviation_class(double deviation_mm, double tolerance_mm);

/// Not cut by any move.
inline constexpr std::uint8_t kNoGroup = 255;

struct PageMeshOptions {
  std::size_t most_triangles = 120'000;  ///< fewer where fewer are as good
  /// What is given up for certain: as good as exact for who looks at it.
  double free_deviation_mm = 0.002;
  /// 0 .. kNoGroup - 1, of the move with this number (CutMove::id); empty: nobody asks.
  std::function<std::uint8_t(std::uint32_t move)> group_of;
  const DesignPart* design = nullptr;  ///< to compare with; null: nobody asks
  double tolerance_mm = 0.05;
};

/// The finest surface that `stock` has (patches of level 0), simplified. Memory: some tiles of it
/// at a time, and what is left of all.
PageMesh page_mesh(const StockModel& stock, const PageMeshOptions& options = {});

}  // namespace kerf
