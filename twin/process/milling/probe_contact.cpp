#include "twin/process/milling/probe_contact.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>

#include "base/translate.h"

namespace kerf {
namespace {

/// Nearer to the start than this is where it stands.
constexpr double kHere_mm = 0.0005;
/// The probe is clear where it is less deep than this: far enough above kProbeDepth_mm that a move
/// that has just left may meet again.
constexpr double kClearDepth_mm = kProbeDepth_mm / 10;
constexpr double kDeep_mm = 0.05;

/// Seen from above, the tip comes over the blank's box.
bool comes_over(const Box& blank, const CutMove& move, double radius_mm) {
  for (int axis = 0; axis < 2; ++axis) {
    const double low = std::min(move.from_mm[axis], move.to_mm[axis]) - radius_mm;
    const double high = std::max(move.from_mm[axis], move.to_mm[axis]) + radius_mm;
    if (low >= blank.max[axis] || high <= blank.min[axis]) return false;
  }
  return true;
}

/// Where the move begins.
bool touches(const StockModel& stock, const Cutter& tip, const CutMove& move) {
  CutMove down = move;
  down.to_mm = move.from_mm;
  down.from_mm = move.from_mm + 2 * kProbeDepth_mm * move.axis_from;
  down.axis_to = move.axis_from;
  return stock.first_contact(tip, down, kProbeDepth_mm / 2).has_value();
}

/// Where the move begins it is deeper in the workpiece than any probe goes.
bool is_deep(const StockModel& stock, const Cutter& tip, const CutMove& move) {
  const std::optional<Contact> met = stock.first_contact(tip, move, kDeep_mm);
  return met && glm::length(met->tip_mm - move.from_mm) < kHere_mm;
}

ProbeAnswer met_after(double way_mm, double length_mm) {
  ProbeAnswer answer;
  answer.kind = ProbeAnswer::Kind::kMet;
  answer.share = std::clamp(way_mm / length_mm, 0.0, 1.0);
  return answer;
}

}  // namespace

ProbeAnswer probe_contact(const StockModel& stock, const Cutter& tip, const CutMove& move,
                          bool away) {
  using Kind = ProbeAnswer::Kind;
  ProbeAnswer answer;
  const double length_mm = glm::length(move.to_mm - move.from_mm);
  if (length_mm < kHere_mm) {
    answer.kind = touches(stock, tip, move) == away ? Kind::kMissed : Kind::kRefused;
    return answer;
  }
  if (!away) {
    const std::optional<Contact> met = stock.first_contact(tip, move, kProbeDepth_mm);
    if (met) {
      const double way_mm = glm::length(met->tip_mm - move.from_mm);
      // A little in it already where it comes from the side: cells are not as smooth as a top.
      if (way_mm > kHere_mm || !is_deep(stock, tip, move)) return met_after(way_mm, length_mm);
      answer.kind = Kind::kRefused;
    } else if (comes_over(stock.bounds_mm(), move, tip.radius_mm())) {
      answer.kind = Kind::kMissed;
    } else {
      answer.why = tr("it stays beside the blank, and what stands there nobody has said");
    }
    return answer;
  }
  // Backwards, the place where it leaves is the first that it meets. It trips a little less deep
  // than the move that has brought it here, so that it counts as touching where that one stopped.
  CutMove back = move;
  std::swap(back.from_mm, back.to_mm);
  const std::optional<Contact> left = stock.first_contact(tip, back, kClearDepth_mm);
  if (!left) {
    // Whatever else it may have met before, of that no more would be known by now.
    answer.kind = Kind::kRefused;
    return answer;
  }
  const double way_mm = length_mm - glm::length(left->tip_mm - back.from_mm);
  if (length_mm - way_mm > kHere_mm) return met_after(way_mm, length_mm);
  answer.kind = Kind::kMissed;
  return answer;
}

}  // namespace kerf
