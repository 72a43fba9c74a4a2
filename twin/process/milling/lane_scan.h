// twin/process/milling/lane_scan.h - when on its way a straight move removes what, of a workpiece
// that can be asked about points: any tool, at any angle.
#pragma once

#include <span>
#include <vector>

#include "stock/solid_points.h"
#include "stock/stock_model.h"
#include "twin/process/milling/way_spans.h"

namespace kerf {

/// Looks at points along lanes: lines beside the way, each through one place of the cutter's front,
/// and works out where each of them is material. Reads only.
///
/// What is narrower than the lanes are apart (a twenty-fifth of what of the cutter can be in the
/// blank in the middle, less at its sides; a tenth of it along the spindle, less at its tip), or
/// shorter than a step, may be missed, and what is no thicker than a fortieth of a cell is. One
/// thread; keeps its memory.
class LaneScan {
 public:
  /// A stretch of the way on which material is removed: fractions of the way.
  struct Grain {
    double bin_mm = 0;   ///< as fine as volumes are to be told (no more than kMostBins of them)
    double gap_mm = 0;   ///< shorter air is not seen
    double step_mm = 0;  ///< along a lane
    int lanes = 25;      ///< side by side
    /// Lanes above each other: each stands for so much more than the one below it, up to this part
    /// of the cutter's diameter.
    double row_grows = 1.6, row_of_diameter = 0.1;
  };
  static constexpr int kMostBins = 256;

  /// One direction of the spindle (axis_from) is taken for the whole way. `box`: of the blank.
  /// `cell_mm`: of the model. Returns how many points were looked at.
  double run(const SolidPoints& solid, const Box& box, double cell_mm, const Cutter& cutter,
             const CutMove& move, const Grain& grain);

  std::span<const WaySpan> spans() const { return spans_; }
  /// What is removed on each of equal parts of the way, good to some percent; where layers are no
  /// thicker than lanes are apart to a half.
  std::span<const double> bins_mm3() const { return bins_; }

 private:
  /// A line along the way: a place of the cutter, seen along the way. It stands for what is about
  /// it, from `low` to `high` above the way.
  struct Lane {
    double x = 0, y = 0, low = 0, high = 0;
    double inner = 0;  ///< x of the next lane towards the middle
    double area_mm2 = 0;
    double back = 0, front = 0;  ///< what of the line the cutter fills, mm from its tip
    double front_low = 0, front_high = 0;
  };

  /// Cutters whose lanes have closed forms.
  enum class Form { kAny, kBall, kFlat };

  bool set(const Box& box, const Cutter& cutter, const CutMove& move);
  bool reach_closed(double x, double y, double half, double& back, double& front) const;
  bool inside(double x, double y, double along) const;
  bool reach(double x, double y, double& back, double& front) const;
  double deepest(double x, double y, double low, double high) const;
  double lowest_y(double x) const;
  double engaged_radius() const;
  void lay_lanes(const Grain& grain);
  bool solid(double x, double y, double along) const;
  void walk(const Lane& lane, double phase, const Grain& grain);
  double front_at_side(const Lane& lane, double along) const;
  double edge_between(const Lane& lane, double in, double out) const;
  void add(double from, double to, double mm3);

  const SolidPoints* solid_ = nullptr;
  const Cutter* cutter_ = nullptr;
  Form form_ = Form::kAny;
  Box box_;
  Vec3 start_{0}, along_{1, 0, 0}, beside_{0, 1, 0}, above_{0, 0, 1};
  double length_ = 0, radius_ = 0;
  /// Of the spindle, along above_ and along_.
  double rise_ = 1, lean_ = 0;
  double cell_ = 0, within_ = 0;
  double far_ = 0;  ///< longer than anything here
  mutable double looks_ = 0;
  std::vector<Lane> lanes_;
  std::vector<WaySpan> spans_;
  std::vector<double> bins_;
};

}  // namespace kerf
