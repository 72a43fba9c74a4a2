// twin/report/finding_lists.h - findings as lists that build servers, code hosts and editors read:
// SARIF 2.1.0 and JUnit. Both are made of the same findings; ids, severities and help come from
// twin/findings/finding_table.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "twin/findings/finding_table.h"
#include "twin/report/report.h"

namespace kerf {

/// One program with what was found in it.
struct ListedProgram {
  std::string path;                ///< as the user wrote it
  std::vector<std::string> files;  ///< what SourceRef::file means
  FindingLog findings;
  std::string partial_reason;  ///< not empty: it was not run to its end, and why
  Diagnostics faults;          ///< beyond its findings: what kept it from being run or written
  double total_s = 0;          ///< what the run took
  std::array<bool, kFindingTopics> looked_at{};  ///< topics that this workpiece has
};

/// Of a run that has come to a report.
ListedProgram listed_program(const Report& report);

/// What code hosts take of one SARIF file: GitHub refuses more results than kMostResults, and
/// more than 10 MB of it by gzip, which so many results stay far below; it shows kShownResults.
inline constexpr std::size_t kMostResults = 25'000;
inline constexpr std::size_t kShownResults = 5'000;

/// SARIF 2.1.0, one run. Rules: those ids that occur. Results: errors before warnings before
/// notes where there are more than `most`, else in the order in which they were found; what is
/// left out, here or beyond FindingLog::kMaxKept, is told as a notification. Each with its file
/// (relative to `folder` where it lies below it, else absolute), its line (the first, of what is
/// about the program as a whole), and properties position_mm, depth_mm, tool, time_s, bodies.
/// One in a subroutine has the lines that call it as relatedLocations (call_sites.h).
/// partialFingerprints "kerf/v1" depend on id, file, tool and the words of the line, not on its
/// number: they stay where lines move or are numbered anew. Reads the programs for that.
/// `folder`: absolute; what %SRCROOT% stands for.
std::string sarif_text(std::span<const ListedProgram> programs, const std::string& version,
                       const std::string& folder, std::size_t most = kMostResults);

/// JUnit as Jenkins and GitLab read it: a test suite for each program. Its test cases: "finished"
/// (an error where the program was not run to its end), and one for each topic that was looked at
/// (failed where it has findings of severity error; milder ones are its output).
std::string junit_text(std::span<const ListedProgram> programs, const std::string& version);

/// What junit_text() has made of some programs each, as one list of all. nullopt: one of them is
/// not its work.
std::optional<std::string> join_junit(std::span<const std::string> texts,
                                      const std::string& version);

/// As XML takes it in texts and in values: what is no character of XML, or no UTF-8, is U+FFFD.
std::string xml_text(std::string_view text);

}  // namespace kerf
