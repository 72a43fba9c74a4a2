#include "stock/turning/tap.h"

#include <cmath>

#include "base/portable_math.h"

namespace kerf {
namespace {

constexpr double kTapDepth = 0.61343, kTapRoot = 0.125;  // pitches
const double kTapSlope = portable::tan(kPi / 6);

}  // namespace

std::optional<TapTools> tap_tools(double diameter_mm, double pitch_mm, double length_mm) {
  const double radius = diameter_mm / 2, core = radius - kTapDepth * pitch_mm;
  if (!(pitch_mm > 0) || !(core > 0) || radius > kMaxInsertReach_mm) return std::nullopt;
  InsertOutline body, groove;
  body.parts.push_back({{{0, -core}, std::nullopt, InsertSide::kNose},
                        {{length_mm, -core}, std::nullopt, InsertSide::kFront},
                        {{length_mm, core}, std::nullopt, InsertSide::kBody},
                        {{0, core}, std::nullopt, InsertSide::kFront}});
  // The last turn ends at the tip.
  const double middle = pitch_mm / 2, root = kTapRoot * pitch_mm / 2;
  const double foot = root + kTapSlope * (radius - core);
  groove.parts.push_back({{{middle + foot, core}, std::nullopt, InsertSide::kBack},
                          {{middle + root, radius}, std::nullopt, InsertSide::kBack},
                          {{middle - root, radius}, std::nullopt, InsertSide::kNose},
                          {{middle - foot, core}, std::nullopt, InsertSide::kFront}});
  return TapTools{TurningTool(body), TurningTool(groove)};
}

}  // namespace kerf
