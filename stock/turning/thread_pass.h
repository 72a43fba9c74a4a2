// stock/turning/thread_pass.h - a groove that winds: a tool on its way beside a part that turns
// with it.
//
//          s = 0   lead    2 lead         In the half plane at one angle the tool is seen once a
//      ______   ___   ___   ______        turn, its outline a lead farther along the way each time:
//            \_/   \_/   \_/              that is the section of what it leaves.
//
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stock/turning/contour.h"
#include "stock/turning/convex_region.h"
#include "stock/turning/insert_sweep.h"

namespace kerf::turning {

/// Closed convex chain, counter-clockwise, (z, r) in mm.
using ConvexChain = std::vector<Vec2>;

/// What of a convex chain lies between two heights; empty where that is no area.
ConvexChain between_heights(const ConvexChain& chain, double low_r_mm, double high_r_mm);

/// One convex part of an outline that goes straight while the workpiece turns. At the way s the
/// tool is at the angle `from_turns` - s / `lead_mm` of the workpiece, in turns about z by the
/// right-hand rule: a positive lead is M3 (seen along +z the workpiece turns clockwise), and leaves
/// a right-hand groove where the way goes toward -z.
///
/// Exact where the outline is that of the tool in the plane of the axis, its rake face: what its
/// flanks below the rake face would rub away is not looked at.
class ThreadPass {
 public:
  /// Of the part only what lies between the two radii anywhere on the way is kept: nothing else
  /// meets material. None: that is nothing, or no way.
  static std::optional<ThreadPass> create(const GridPart& part, const Vec2& from_mm,
                                          const Vec2& to_mm, double lead_mm, double from_turns,
                                          double low_r_mm, double high_r_mm, std::uint64_t id);

  /// The same of all that it is made of, from a file: none of numbers that no move leaves.
  static std::optional<ThreadPass> restored(ConvexChain corners, const Vec2& from_mm,
                                            const Vec2& to_mm, double lead_mm, double from_turns,
                                            double low_r_mm, double high_r_mm, std::uint64_t id);
  /// As it lies when the part is held the other way round: z becomes `at_z_mm` - z.
  ThreadPass turned_about(double at_z_mm) const;
  /// z becomes `at_z_mm` + z.
  ThreadPass moved(double at_z_mm) const;

  const ConvexChain& corners() const { return corners_; }  ///< about the controlled point
  const Vec2& from_mm() const { return from_; }
  const Vec2& to_mm() const { return to_; }
  double lead_mm() const { return lead_mm_; }
  double from_turns() const { return from_turns_; }
  double low_r_mm() const { return low_r_mm_; }
  double high_r_mm() const { return high_r_mm_; }
  std::uint64_t id() const { return id_; }
  /// The id as edges are marked with it (TurnedPart::keep_cut_ids).
  std::uint32_t mark() const;

  double length_mm() const { return length_mm_; }
  const Vec2& direction() const { return direction_; }
  Vec2 at(double way_mm) const { return from_ + way_mm * direction_; }
  double turns_at(double way_mm) const { return from_turns_ - way_mm / lead_mm_; }
  /// Where it is seen at this angle, a number of turns after the beginning of its turn.
  double way_at(double turns, double n) const { return lead_mm_ * (from_turns_ - turns + n); }
  /// The numbers n whose way_at() is on the way and in this part of it, for one angle or any
  /// between two: from first to last.
  struct Turns {
    std::int64_t first = 0, last = -1;
  };
  Turns turns_seen(double low_turns, double high_turns, double low_way_mm,
                   double high_way_mm) const;

  /// Round the corners, about the controlled point, and round all that it sweeps.
  const Vec2& low_mm() const { return low_; }
  const Vec2& high_mm() const { return high_; }
  Vec2 swept_low_mm() const;
  Vec2 swept_high_mm() const;
  Rect swept_box() const;
  /// All that it sweeps at any angle, on the grid.
  void swept(ConvexRegion& region) const;
  /// What it sweeps at every angle: the tool meets it a turn later once more. With `gap_mm` less
  /// than a lead for passes that lie evenly beside each other. Empty as a rule.
  void swept_all_round(double gap_mm, ConvexRegion& region) const;

  /// How far it goes along z and r in a turn, and which way round.
  Vec2 step_mm() const { return -lead_mm_ * direction_; }

  /// This and nothing else cuts what `other` cuts, but for kThreadFilm_mm.
  bool covers(const ThreadPass& other) const;

 private:
  void set_way(const Vec2& from_mm, const Vec2& to_mm);
  void find_extent();

  ConvexChain corners_;
  Vec2 from_{0}, to_{0}, direction_{0}, low_{0}, high_{0};
  double lead_mm_ = 0, from_turns_ = 0, length_mm_ = 0, low_r_mm_ = 0, high_r_mm_ = 0;
  std::uint64_t id_ = 0;
};

/// Two grooves that differ by less are one: listings give places to 0.1 um.
inline constexpr double kThreadFilm_mm = 2e-4;
/// With less way a turn what is left between turns is below a micrometre: it is a ring.
inline constexpr double kLeastLead_mm = 1e-3;

}  // namespace kerf::turning
