// twin/process/contact_grounds.h - from which depth on a contact counts, and how sure it is.
#pragma once

#include <string>

#include "twin/findings/finding.h"

namespace kerf {

/// A contact less deep than this is none. Programs carry 4 decimals (0.1 um in mm, 2.54 um in
/// inches), posts round to 3 (1 um, 25 um in inches at worst along a diagonal), heights are kept in
/// single precision: 0.01 mm is above all that happens to a rapid that only retraces a cut surface,
/// and below anything that marks a part.
inline constexpr double kContactTolerance_mm = 0.01;
/// Where a contact begins, a body counts as so much thinner: what a program writes down is rounded,
/// and what runs along another body does not touch it.
inline constexpr double kContactRounding_mm = 1e-4;

/// What a finding about a contact rests on.
struct Grounds {
  bool blank_guessed = false;
  bool tool_guessed = false;
};
/// Errors, unless they rest on a guess: rapid-contact and spindle-off-contact on the blank or the
/// shape of the tool, below-stock on the blank alone (a tip is where it is, whatever its shape).
/// These are warnings.
Severity severity_of(FindingId id, const Grounds& grounds);
/// " (of a guessed blank)", ..: ends the finding's text where severity_of() says warning.
std::string doubt_of(FindingId id, const Grounds& grounds);

}  // namespace kerf
