// twin/machine/torch_moves.h - which motions of a torch program cut a sheet, and as which moves.
#pragma once

#include <cstdint>
#include <vector>

#include "interp_bridge/beam_trigger.h"
#include "interp_bridge/motion.h"
#include "stock/stock_model.h"

namespace kerf {

/// A motion cuts while the beam is on, at whatever height: feeds, arcs, threads and traverses.
/// Where the beam comes on the sheet is pierced, at the start of the motion; a dwell with the beam
/// on pierces, too. Values; const calls from any number of threads.
class TorchMoves {
 public:
  /// `pierce_mm`: diameter of the hole that piercing leaves; 0, or not above the kerf: the kerf's.
  TorchMoves(BeamTrigger beam, double pierce_mm) : beam_(std::move(beam)), pierce_mm_(pierce_mm) {}

  /// The beam is on, and it is known where.
  bool is_lit(const Motion& motion) const { return motion.start_known && beam_.on(motion); }
  /// It is on while the head moves or dwells: the motion cuts or pierces.
  bool burns(const Motion& motion) const { return moves_or_dwells(motion) && is_lit(motion); }
  /// Appends the moves of a motion that burns, all with this id and for a cutter that is as wide as
  /// the kerf: `pierces`: first the hole, as circles within each other. Nothing for a dwell that
  /// does not pierce.
  void append(const Motion& motion, bool pierces, const Cutter& kerf, std::uint64_t id,
              std::vector<CutMove>& out) const;

  /// Whether motion `i` pierces: it burns, and no motion since the beam was last off does.
  /// `motion_at(n)` is the Motion n.
  template <class MotionAt>
  bool pierces(std::size_t i, MotionAt&& motion_at) const {
    if (!burns(motion_at(i))) return false;
    while (i-- > 0) {
      const Motion& before = motion_at(i);
      if (!is_lit(before)) return true;
      if (burns(before)) return false;
    }
    return true;
  }

 private:
  static bool moves_or_dwells(const Motion& motion);
  void append_hole(const Vec3& place_mm, double kerf_mm, std::uint64_t id,
                   std::vector<CutMove>& out) const;

  BeamTrigger beam_;
  double pierce_mm_;
};

}  // namespace kerf
