// stock/stock_model.h - the only seam between a workpiece model and the rest of kerf.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "base/result.h"
#include "base/triangle_mesh.h"
#include "stock/cutter/cutter.h"

namespace kerf {

/// Circular part of a CutMove: the tip turns about the axis through `center_mm` along `axis` (unit
/// vector) by `sweep_rad` (right-hand rule), and moves along the axis linearly in angle. If start
/// and end lie at different distances from the axis, the radius changes linearly in angle.
struct CutArc {
  Vec3 center_mm{0};
  Vec3 axis{0, 0, 1};
  double sweep_rad = 0;
};

/// One move of the tool tip in the workpiece frame, mm. Straight unless `arc` is set.
struct CutMove {
  Vec3 from_mm{0};
  Vec3 to_mm{0};
  std::optional<CutArc> arc;
  std::uint64_t id = 0;  ///< the caller's; comes back in CutReport
};

/// What one move did to the workpiece.
struct CutReport {
  std::uint64_t id = 0;
  double removed_mm3 = 0;
  double depth_mm = 0;  ///< greatest height of material removed above any one point of the result
};

/// Where a move first meets material.
struct Contact {
  Vec3 tip_mm{0};       ///< tool tip at first contact
  double depth_mm = 0;  ///< greatest depth reached on the whole move
};

/// Workpiece as it is now. One owner thread; snapshots are cheap, immutable in effect and may go to
/// other threads.
class StockModel {
 public:
  virtual ~StockModel() = default;

  /// Removes what `cutter` sweeps on each move, in order, and appends one CutReport a finished move
  /// to `reports` (in order; each id once). A model may hold the last moves back until it has seen
  /// what follows (their reports then come with a later call or finish()). The final workpiece is
  /// bit for bit the same for any division of a sequence of moves into calls, and for any number of
  /// threads.
  virtual void cut(const Cutter& cutter, std::span<const CutMove> moves,
                   std::vector<CutReport>& reports) = 0;

  /// Completes moves held back. Needed before anything below is asked; called by tool changes as
  /// well.
  virtual void finish(std::vector<CutReport>& reports) = 0;

  /// Would this move touch material, deeper than `tolerance_mm` inside the tool's sweep? Changes
  /// nothing.
  virtual std::optional<Contact> first_contact(const Cutter& cutter, const CutMove& move,
                                               double tolerance_mm) const = 0;

  virtual std::unique_ptr<StockModel> snapshot() const = 0;

  virtual std::string name() const = 0;  ///< "zmap", ...
  virtual Box bounds_mm() const = 0;     ///< of the blank
  virtual double cell_mm() const = 0;
  virtual std::size_t cell_count() const = 0;
  virtual double blank_mm3() const = 0;  ///< of the blank as the model holds it
  virtual double remaining_mm3() const = 0;
  virtual std::string digest() const = 0;  ///< hash of the contents, 32 hex digits

  /// Closed surface of the workpiece; deviates from the model by at most `tolerance_mm` (0 = every
  /// cell is kept).
  virtual TriangleMesh mesh(double tolerance_mm) const = 0;
};

}  // namespace kerf
