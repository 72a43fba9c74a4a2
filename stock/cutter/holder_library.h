// stock/cutter/holder_library.h - holders that have a name: holder=er20.
#pragma once

#include <span>
#include <string_view>

namespace kerf {

/// What is nearest to the workpiece: the clamping nut, a cylinder about it. mm.
struct NamedHolder {
  std::string_view name;  ///< "er20"
  double diameter_mm;
  double length_mm;
};

/// Clamping nuts of collet chucks by DIN 6499 (ISO 15488), whose diameters makers keep; erNNm are
/// the slim ("mini") nuts. Lengths as common catalogues have them, to the millimetre's half. What
/// follows above the nut (chuck, spindle nose) differs from machine to machine: it is not in the
/// table.
std::span<const NamedHolder> named_holders();
/// Letter case does not matter; null: there is none of this name.
const NamedHolder* find_holder(std::string_view name);

}  // namespace kerf
