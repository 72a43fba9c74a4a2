// twin/findings/finding_table.h - what each finding is called, how bad it usually is, what it
// means: the one place for reports, lists for other programs (SARIF, JUnit) and documents.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/diagnostic.h"
#include "twin/findings/finding.h"

namespace kerf {

/// What a finding is about; lists for build servers have a check for each.
enum class FindingTopic : std::uint8_t {
  kProgram,
  kTools,
  kBlank,
  kCutter,
  kCollisions,
  kMachine,
  kTurning,
  kBeam,
  kPunch,
  kSource,
  kDesign,
};

struct FindingRow {
  FindingId id;
  const char* name;  ///< "rapid-contact"; never translated
  /// Of a blank and tools that are known; what rests on a guess is milder.
  Severity usual;
  FindingTopic topic;
  const char* meaning;  ///< one sentence; tr() shows it
  const char* remedy;   ///< what to do; may be empty; tr() shows it
};

struct FindingTopicRow {
  FindingTopic topic;
  const char* name;  ///< "collisions"; never translated
};

/// With the last ones of the enums: these numbers grow with them.
inline constexpr std::size_t kFindingIds = static_cast<std::size_t>(FindingId::kLongDwell) + 1;
inline constexpr std::size_t kFindingTopics = static_cast<std::size_t>(FindingTopic::kDesign) + 1;

/// In the order of FindingId.
std::span<const FindingRow> finding_table();
const FindingRow& row_of(FindingId id);
/// In the order of FindingTopic.
std::span<const FindingTopicRow> finding_topics();

}  // namespace kerf
