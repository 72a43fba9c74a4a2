// stock/blank_place.h - where a blank from a file lies, and how that is written.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/geometry.h"
#include "base/length_unit.h"
#include "base/placement.h"
#include "base/result.h"

namespace kerf {

/// Turned about the axes through the file's own zero, then shifted.
struct BlankPlace {
  char flip = 0;       ///< 'x', 'y': at first by half a turn about that axis; 0: not
  Vec3 rotate_deg{0};  ///< then about X, then Y, then Z, right-handed
  Vec3 at_mm{0};       ///< there its zero lies in the end

  bool is_as_saved() const { return flip == 0 && rotate_deg == Vec3(0) && at_mm == Vec3(0); }
  Placement placement() const;
  /// ", flipped about X, turned by 90, 0, 0 degrees about X, Y, Z, Z0 at .."; empty as it was
  /// saved.
  std::string text() const;
  bool operator==(const BlankPlace&) const = default;
};

/// Takes flip=x|y, rotate=A,B,C and at=x,y,z from the end of `text`, where they stand behind
/// colons in any order, each once; and any of `words`, which come back in `found`. What is left is
/// the name of a file, which may hold any other character, ':' too.
Result<BlankPlace> take_place(std::string_view& text, LengthUnit unit,
                              const std::vector<std::string_view>& words = {},
                              std::string* found = nullptr);

}  // namespace kerf
