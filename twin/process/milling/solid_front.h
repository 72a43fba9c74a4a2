// twin/process/milling/solid_front.h - how a tool at any angle is engaged at one place of its way,
// in a workpiece that can be asked about points.
#pragma once

#include <vector>

#include "base/geometry.h"
#include "stock/solid_points.h"
#include "stock/stock_model.h"
#include "twin/process/engagement.h"
#include "twin/process/milling/front_rays.h"

namespace kerf {

/// Looks at points of the tool's front, square to its spindle: in directions from one side to the
/// other (FrontRays), from the outside of its bottom in, and up its side. Ahead is where the way
/// goes, square to the spindle; depth is along the spindle. Of a spindle that turns on the way its
/// direction at the place counts. Reads only; about 20 us; one thread.
class SolidFront {
 public:
  /// Straight ways, and arcs about Z of upright tools; no undercuts.
  static bool takes(const Cutter& cutter, const CutMove& move);

  struct Asked {
    double at = 0;  ///< part of the way
    bool anticlockwise = false;
  };
  /// `box`: of the blank, `cell_mm`: of the model, before the move is cut.
  EngagementLook look(const SolidPoints& solid, const Box& box, double cell_mm,
                      const Cutter& cutter, const CutMove& move, const Asked& asked);

 private:
  void set_place(const CutMove& move, double at, double ahead_mm);
  bool is_solid(double radius, const Vec3& out, double height) const;
  FrontContact contact_at(double angle) const;
  double wall_mm(const Vec3& out) const;
  double edge_between(const Vec3& out, double in, double free) const;
  double high_over(const Vec3& out, double radius) const;
  double profile_mm(double radius) const;
  EngagementLook plunge() const;
  bool cuts_centre(const CutMove& move) const;

  const SolidPoints* solid_ = nullptr;
  const Cutter* cutter_ = nullptr;
  Box box_;
  double cell_ = 0, within_ = 0, radius_ = 0, flat_radius_ = 0, top_ = 0;
  Vec3 tip_{0}, axis_{0, 0, 1}, ahead_{1, 0, 0}, left_{0, 1, 0};
  bool goes_sideways_ = true;
};

}  // namespace kerf
