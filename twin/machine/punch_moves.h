// twin/machine/punch_moves.h - at which places a program's motions make the punch strike.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/machine/turret.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {

/// Where the clamps are along the sheet. One thread.
class ClampPlace {
 public:
  explicit ClampPlace(TurretPointer turret)
      : turret_(std::move(turret)), line_done_(turret_->regrips.size(), false) {}

  /// In program order. True: the clamps move before this motion.
  bool follow(const Motion& motion);
  /// From where the turret's file has them.
  const Vec2& shift_mm() const { return shift_mm_; }

 private:
  TurretPointer turret_;
  std::vector<bool> line_done_;  ///< of Turret::regrips
  Vec2 shift_mm_{0};
};

/// A stroke within a motion.
struct PunchHit {
  Vec3 place_mm{0};
  double turn_rad = 0;  ///< of the punch
  double share = 0;     ///< of the motion, when it comes
};

/// Strokes of a motion, in order:
///  - where the trigger comes to hold, at the start of the motion or (z<LEVEL) at its end; at a
///    user M-code; at the bottom of a feed straight down
///  - with Turret::strikes_at_ends at the end of every move sideways while it holds
///  - nibbling, on a feed line or arc: at its start unless the last stroke was there, every
///    nibble_pitch_mm along it, and at its end
/// A motion whose start is not known strikes at its end alone, if it would there whatever its start
/// (strikes_at_ends, nibbling) and its end is known; strikes_unseen() tells of what is left out.
/// Values; const calls from any thread.
class PunchMoves {
 public:
  /// So far back it is looked whether the last stroke was at the place where the machine is.
  static constexpr std::size_t kLookBack = 8;
  /// Of one motion: a pitch that wants more is a slip of the pen.
  static constexpr int kMostHits = 100'000;

  explicit PunchMoves(TurretPointer turret) : turret_(std::move(turret)) {}

  const Turret& turret() const { return *turret_; }

  /// Appends those of motion `i`; `motion_at(n)` is the Motion n, for n from i - kLookBack - 1.
  template <class MotionAt>
  void hits(std::size_t i, MotionAt&& motion_at, std::vector<PunchHit>& out) const {
    const Motion& m = motion_at(i);
    // The end of a program has what was on before the interpreter stopped it.
    if (m.kind == MotionKind::kProgramEnd) return;
    if (!m.start_known) {
      if (strikes_at_known_end(m)) out.push_back(hit_at(m, 1));
      return;
    }
    const std::size_t before = out.size();
    const bool comes = is_on_at(m, m.from_mm) && !is_on_after(i, motion_at);
    if (comes && !turret_->strikes_at_ends) out.push_back(hit_at(m, 0));
    if (nibbles(m)) {
      if (out.size() == before && !struck_before(i, motion_at)) out.push_back(hit_at(m, 0));
      append_row(m, out);
    } else if (strikes_at_end(m)) {
      out.push_back(hit_at(m, 1));
    }
  }

  /// The start of the motion is not known, and the punch strikes on it where nobody knows.
  bool strikes_unseen(const Motion& motion) const;
  /// The trigger holds there, or has just struck: what keeps the punch down in a picture.
  bool holds(const Motion& motion, double share) const;
  /// The motion is a feed on which the punch nibbles.
  bool nibbles(const Motion& motion) const;
  /// The trigger holds while the motion goes sideways, and neither nibbling nor strikes at ends
  /// are meant: the punch is down.
  bool drags(const Motion& motion) const;
  /// The punch as it is turned there: radians, the station's own angle included.
  double turn_rad(const Motion& motion, double share) const;

  /// Strokes as moves of the station's punch, up to `fraction` of the motion. Nothing if there is
  /// none in that station.
  template <class MotionAt>
  void append(std::size_t i, MotionAt&& motion_at, double fraction, std::uint64_t id,
              std::vector<CutMove>& out) const {
    if (turret_->station(motion_at(i).tool) == nullptr) return;
    std::vector<PunchHit> strokes;
    hits(i, motion_at, strokes);
    for (const PunchHit& hit : strokes) {
      if (hit.share <= fraction) out.push_back(stroke_of(hit, id));
    }
  }
  static CutMove stroke_of(const PunchHit& hit, std::uint64_t id);

 private:
  bool is_on_at(const Motion& motion, const Vec3& place_mm) const;
  bool strikes_at_end(const Motion& motion) const;
  bool strikes_at_known_end(const Motion& motion) const;
  bool nibbles_from(const Motion& motion) const;
  PunchHit hit_at(const Motion& motion, double share) const;
  void append_row(const Motion& motion, std::vector<PunchHit>& out) const;

  /// The trigger holds at the end of the motion before.
  template <class MotionAt>
  bool is_on_after(std::size_t i, MotionAt&& motion_at) const {
    if (i == 0) return false;
    const Motion& before = motion_at(i - 1);
    const bool ends_somewhere = before.start_known || is_feed(before) || is_traverse(before);
    return ends_somewhere && is_on_at(before, before.to_mm);
  }
  /// The last stroke was where motion i begins.
  template <class MotionAt>
  bool struck_before(std::size_t i, MotionAt&& motion_at) const {
    const std::size_t last = i > kLookBack ? i - kLookBack : 0;
    while (i-- > last) {
      const Motion& before = motion_at(i);
      if (!before.start_known) return strikes_at_known_end(before);
      if (nibbles(before) || strikes_at_end(before)) return true;
      if (moves_sideways(before)) return false;
      const bool on = is_on_at(before, before.from_mm);
      if (on && !is_on_after(i, motion_at) && !turret_->strikes_at_ends) return true;
    }
    return false;
  }

  TurretPointer turret_;
};

}  // namespace kerf
