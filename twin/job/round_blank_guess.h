// twin/job/round_blank_guess.h - the bar about X that a program with a rotary axis works on, when
// nobody gave one.
#pragma once

#include <limits>
#include <optional>
#include <span>

#include "base/geometry.h"
#include "interp_bridge/motion.h"
#include "stock/blank.h"
#include "stock/stock_model.h"

namespace kerf {

/// Gathers in one pass over a program's motions whether A goes all the way round while it feeds,
/// about X at Y0 Z0 and with nothing else that turns, and makes a bar of where it feeds.
class RoundBlankGuess {
 public:
  explicit RoundBlankGuess(double margin_mm) : margin_mm_(margin_mm) {}

  /// `moves`: what the motion is cut as; empty for an upright tool over work that lies still.
  void add(const Motion& motion, std::span<const CutMove> moves, double tool_radius_mm);

  /// A cylinder about X:
  ///   ends       the feeds, plus the tool's radius and the margin, in whole mm
  ///   diameter   twice the farthest that a feed along X or around it is from the axis; or as far
  ///              out as feeds begin that plunge, or end that leave, but no farther than halfway to
  ///              where traverses go. To a thousandth of a mm
  /// None: it is no such program.
  std::optional<Blank> blank() const;

 private:
  void add_feed(const Motion& motion, std::span<const CutMove> moves, double tool_radius_mm);

  double margin_mm_;
  bool is_other_ = false;  ///< B or C turn, or A about another line
  double least_a_deg_ = std::numeric_limits<double>::infinity();
  double most_a_deg_ = -std::numeric_limits<double>::infinity();
  double low_mm_ = std::numeric_limits<double>::infinity();  ///< along X, with the tool's radius
  double high_mm_ = -std::numeric_limits<double>::infinity();
  double farthest_mm_ = 0;  ///< from the axis, of feeds beside plunges
  double begun_mm_ = 0;     ///< .. of where plunges begin
  double passed_mm_ = std::numeric_limits<double>::infinity();  ///< .. of traverses' farther ends
};

}  // namespace kerf
