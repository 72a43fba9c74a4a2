// twin/process/milling/front_section.h - how much an upright cutter removes at one instant of its
// way: the material that its front meets there.
#pragma once

#include <vector>

#include "base/geometry.h"
#include "stock/solid_points.h"
#include "stock/stock_model.h"

namespace kerf {

/// The front of a cutter is where it is foremost on lines that run beside each other as its way
/// does. What stands right before it there is removed with the next step; so the area of that, seen
/// along the way, times the speed is the rate. Worked out by looking at some hundreds of points,
/// closer together where material begins and ends: exact to some tenths of a percent of what can be
/// asked about. What is thinner than a fifth of its distance from the cutter's lower end, and than
/// a tenth of a cell, may be missed. Reads only; one thread.
class FrontSection {
 public:
  /// Straight ways and arcs about Z, at any slope, of upright cutters that do not undercut.
  static bool takes(const Cutter& cutter, const CutMove& move);

  /// `box`: of the blank; `cell_mm`: of the model. Keeps nothing of the cutter or the move.
  void set(const Box& box, double cell_mm, const Cutter& cutter, const CutMove& move);
  /// What is removed for each mm of the way, at that part (0 .. 1) of it. `solid`: before the move
  /// is cut; what is deeper in it than `within_mm`.
  double mm2_at(double part, const SolidPoints& solid, double within_mm);
  /// Points that were looked at since set().
  double looks() const { return looks_; }

 private:
  double lift(double radius_mm) const;
  double distance(double beside, double along) const;
  double lowest_along(double beside, double reach) const;
  bool reach_of(double beside, double& reach) const;
  double height_at(double beside) const;
  double disc_at(double angle) const;
  bool is_solid(double beside, double along, double y) const;
  template <class Length>
  double integrate(const Length& length) const;

  const SolidPoints* solid_ = nullptr;
  double within_mm_ = 0;
  mutable double looks_ = 0;
  Box box_;
  double cell_ = 0;
  static constexpr int kLifts = 1024;
  std::vector<double> lift_;  ///< of the cutter above its tip, over the radius
  double radius_ = 0;
  double engaged_ = 0;  ///< greatest radius that can be in material
  // The way. Along it is counted in mm of straight ones seen from above, in radians of arcs.
  Vec3 from_{0};
  bool arc_ = false;
  Vec2 direction_{1, 0}, center_{0};
  double arc_radius_ = 0, start_angle_ = 0, turn_ = 1;
  double length_ = 0;  ///< along
  double slope_ = 0;   ///< mm up for each along
  double way_mm_ = 0;  ///< all of it, in space
  double along_ = 0;   ///< the present place
  double tip_z_ = 0;
};

}  // namespace kerf
