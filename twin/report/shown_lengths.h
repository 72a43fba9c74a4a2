// twin/report/shown_lengths.h - texts for people in their unit. Texts are made in mm, as reports,
// logs and digests must not depend on what somebody likes to read; they pass through here on their
// way to a person. The one place that knows how lengths are shown.
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "base/length_unit.h"

namespace kerf {

/// A text of kerf's own with its lengths in `unit`; with kMm as it is. What is a length:
///
///     2.31 mm, 300 x 200 x 20 mm, 0.05 to 0.2 mm     also m, mm2, cm2, mm3, cm3, mm/min, mm/s,
///                                                    mm/s2, mm3/s (which becomes in3/min)
///     X12.40 Y3.00 Z-1.20, X0..100, Z0 .. -5, Z75 mm places, ranges, offsets: X, Y and Z alone
///     0.0224 mm (0.0105 to 0.106, line 37)           a range right behind it
///     flat:6, drill:5:118, iso:CNMG432:max_ap=0.5    SHAPE texts
///     --cell 0.02                                    options that take a length
///
/// Everything else stays, so a number whose unit is not beside it stays mm: texts give each of
/// their lengths its unit. Of inches as many digits are shown as of mm, and one more.
std::string in_unit(std::string_view text, LengthUnit unit);

/// Its message and its hint; not the line of the file. Words of the interpreter stay as they are:
/// their numbers are the program's.
Diagnostic in_unit(Diagnostic diagnostic, LengthUnit unit);

}  // namespace kerf
