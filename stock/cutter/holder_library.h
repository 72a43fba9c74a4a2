// stock/cutter/holder_library.h - holders that have a name: holder=er20.
#pragma once

#include <span>
#include <string_view>

namespace kerf {

/// A cylinder about the axis, or a cone. mm.
struct HolderSection {
  double lower_mm = 0;  ///< diameter at its lower end
  double upper_mm = 0;  ///< at its upper end
  double length_mm = 0;
};

/// What is nearest to the workpiece, upward from its nose.
struct NamedHolder {
  std::string_view name;  ///< "er20"
  HolderSection section;
  const char* source;  ///< by which standard; tr() shows it
};

/// Clamping nuts of collet chucks by DIN 6499 (ISO 15488), whose diameters makers keep; erNNm are
/// the slim ("mini") nuts. Lengths as common catalogues have them, to the millimetre's half.
/// weldonD and shrinkD hold a shank of D mm. Flanges of tapers, as thick as they are: to be stacked
/// on what sits on them. What follows above differs from machine to machine: it is not in the
/// table.
std::span<const NamedHolder> named_holders();
/// Letter case does not matter; null: there is none of this name.
const NamedHolder* find_holder(std::string_view name);

}  // namespace kerf
