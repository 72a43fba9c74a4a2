// base/length_unit.h - the unit in which a person gives and reads lengths. Inside, and in every
// file for machines, a length is mm.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/units.h"

namespace kerf {

enum class LengthUnit : std::uint8_t { kMm, kInch };

/// mm in one.
constexpr double mm_of(LengthUnit unit) { return mm_of_unit(unit == LengthUnit::kInch); }

/// "mm", "in".
constexpr const char* name_of(LengthUnit unit) { return unit == LengthUnit::kInch ? "in" : "mm"; }

/// mm of what somebody gave. Of inches to 1e-9 mm: 0.3 in are 7.62 mm, not 7.619999999999999.
inline double to_mm(double value, LengthUnit unit) {
  if (unit == LengthUnit::kMm) return value;
  constexpr double kFinest_per_mm = 1e9;
  const double mm = value * mm_of(unit);
  const double whole = std::round(mm * kFinest_per_mm);
  return std::isfinite(whole) ? whole / kFinest_per_mm : mm;
}

constexpr double from_mm(double mm, LengthUnit unit) { return mm / mm_of(unit); }

}  // namespace kerf
