// stock/zmap/rim_traces.h - the upright round sides of a blank, and how deep tools have come there.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "stock/blank.h"
#include "stock/zmap/sweep_ops.h"

namespace kerf {

/// A straight way of a tool's tip.
struct TipWay {
  Vec3 from{0}, step{0};
};

/// Cells show a round side within half a cell. This remembers, by the angle about the body's axis,
/// how deep any tool has come that reached the outermost (of a bore: innermost) cells of the body:
/// where none has, the side is where the blank has it, and a tool that enters it by less than a
/// cell touches. No part of the workpiece, as TipTraces, which has the rest.
///
/// Cost: 4 bytes for each cell along the sides; nothing for moves that come near to no side, else
/// about 1 us and some ns for each cell of the side that is reached.
class RimTraces {
 public:
  RimTraces() = default;
  /// Cylinders and tubes along Z; other bodies have no such sides. `cell_mm`: the longer edge.
  RimTraces(std::span<const BlankBody> bodies, double cell_mm);

  bool empty() const { return rims_.empty(); }
  /// Something of the way from a to b may be within `radius_mm` of a side; of an arc: `beyond_mm`
  /// farther from `a`.
  bool is_near(const Vec3& a, const Vec3& b, double beyond_mm, double radius_mm) const;
  /// A tool, `low_mm` above its tip at the lowest, has gone from a to b.
  void add(const Vec3& a, const Vec3& b, double radius_mm, double low_mm);

  struct Touch {
    double t = std::numeric_limits<double>::infinity();  ///< part of the way; infinite: none
    double depth_mm = 0;
  };
  /// Where the tool goes more than the tolerance into a side and below what is left of it.
  Touch first_touch(const ConvexTool& tool, const TipWay& way, double tolerance_mm) const;

 private:
  struct Rim {
    Vec2 center{0};
    double radius = 0;
    bool bore = false;            ///< the material is outside
    double inner = 0, outer = 0;  ///< radii of what is remembered
    double top = 0, floor = 0;
    std::vector<float> lowest;  ///< by angle
    std::size_t at(double x, double y) const;
    void lower(double angle, double half_angle, double z);
    /// How far into the tool the material is, at t; <= 0: not at all.
    double depth(const ConvexTool& tool, const TipWay& way, double tolerance_mm, double t) const;
  };
  static void add_to(Rim& rim, const Vec3& a, const Vec3& b, double radius_mm, double low_mm,
                     double step_mm);

  double cell_mm_ = 1;
  std::vector<Rim> rims_;
};

}  // namespace kerf
