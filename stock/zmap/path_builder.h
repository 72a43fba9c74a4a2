// stock/zmap/path_builder.h - from moves to elementary sweeps, each part of a path exactly once.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "stock/stock_model.h"
#include "stock/zmap/sweep_ops.h"

namespace kerf {

/// Arcs that are not level circles or helices in XY (arcs in other planes, spirals) are cut as
/// chords that stay within this distance of them, mm.
inline constexpr double kChordTolerance_mm = 0.001;

/// Start and end of an arc may lie at distances from the centre that differ by this much, mm, and
/// it still counts as a circle: the rounding of four printed decimals in an inch program, twice.
/// The centre is then moved to fit both ends.
inline constexpr double kArcRadiusSlack_mm = 0.006;

/// Turns a sequence of moves of one cutter into sweeps. Holds back the last straight segment until
/// it knows whether the next one continues it (then the joint needs no full cap); the sweeps depend
/// on the sequence of moves only, not on how it is divided into calls.
class PathBuilder {
 public:
  /// Appends the sweeps that `move` completes. `report` is stored in those that belong to this
  /// move.
  void add(const CutMove& move, std::uint32_t report, std::vector<SweepOp>& ops);
  /// Appends what is held back. The path may go on afterwards from where it ended.
  void finish(std::vector<SweepOp>& ops);
  /// Forgets where the tool stands: the next move begins with a cap of its own (tool change).
  void restart() { standing_.reset(); }

  bool holds_back() const { return pending_.has_value(); }
  /// A move straight up or down, before which finish() changes nothing.
  static bool is_vertical(const CutMove& move);
  /// The way that is held back; only where there is one.
  std::pair<Vec3, Vec3> held_back() const { return {pending_->from, pending_->to}; }
  /// Moves held back keep their sweeps' report index; the owner renumbers it when it starts a new
  /// batch.
  void set_pending_report(std::uint32_t report) { pending_->report = report; }

 private:
  struct Segment {
    Vec3 from{0}, to{0};
    std::uint32_t report = 0;
    double length = 0, cos = 1, sin = 0, slope = 0, slope_m = 1;
  };
  void add_segment(const Vec3& from, const Vec3& to, std::uint32_t report,
                   std::vector<SweepOp>& ops);
  void add_chords(const CutMove& move, std::uint32_t report, std::vector<SweepOp>& ops);
  void add_level_arc(const CutMove& move, std::uint32_t report, std::vector<SweepOp>& ops);
  SweepOp& push_strip(std::vector<SweepOp>& ops);  ///< of pending_
  void stand_at(const Vec3& tip, std::uint32_t report, std::vector<SweepOp>& ops);

  std::optional<Segment> pending_;
  std::optional<Vec3> standing_;  ///< the tool's own shape is already cut here
};

/// Whether an arc is cut as a level circle or helix, not as chords.
bool is_circle_in_xy(const CutMove& move);

/// `count` points of an arc after its start at even angles, ending exactly at move.to_mm.
std::vector<Vec3> arc_points(const CutMove& move, int count);

/// Points of an arc after its start, ending exactly at move.to_mm, so that chords stay within
/// `tolerance_mm`.
std::vector<Vec3> arc_chord_points(const CutMove& move, double tolerance_mm);

}  // namespace kerf
