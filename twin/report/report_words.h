// twin/report/report_words.h - figures of a report as people read them.
#pragma once

#include <cstdint>
#include <string>

#include "twin/findings/finding.h"

namespace kerf {

/// "12.4 s", "3 min 05 s", "2 h 01 min 07 s".
std::string duration_text(double seconds);
/// "12.4 mm"; from 10 m on in m.
std::string distance_text(double mm);
/// In cm3.
std::string volume_text(double mm3);
/// "2 errors, 1 warning"; "no findings". Notes are no verdict.
std::string verdict_text(const FindingLog& log);
/// Of so many: "no errors, 1 warning".
std::string verdict_text(std::uint64_t errors, std::uint64_t warnings);

}  // namespace kerf
