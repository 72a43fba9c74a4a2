// twin/diff/motion_diff.h - whether two programs make the same motion, and where they do not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "twin/diff/diff_steps.h"

namespace kerf {

/// What two places differ in, as bits.
enum DiffKind : std::uint16_t {
  kDiffPath = 1,      ///< where the tool goes
  kDiffRapid = 2,     ///< a rapid in one is a feed, a thread or a probe in the other
  kDiffEvents = 4,    ///< tool changes, dwells, stops, the end
  kDiffFeed = 8,      ///< feed rate
  kDiffTool = 16,     ///< number of the tool in the spindle
  kDiffSpindle = 32,  ///< direction, speed, surface speed
  kDiffCoolant = 64,
  kDiffOutputs = 128,  ///< what a torch is told: M62 to M68, spindles, material
};
/// Their names for programs: "path", "rapid", "events", "feed", ...
const char* name_of(DiffKind kind);
inline constexpr std::array kDiffKinds{kDiffPath, kDiffRapid,   kDiffEvents,  kDiffFeed,
                                       kDiffTool, kDiffSpindle, kDiffCoolant, kDiffOutputs};

/// One place where they differ: steps [begin, end) of either, one of which may be empty.
struct MotionHunk {
  std::size_t a_begin = 0, a_end = 0;
  std::size_t b_begin = 0, b_end = 0;
  std::uint16_t kinds = 0;  ///< DiffKind
  /// How far apart the ways are, where both have one: path_distance(), and of as many steps in
  /// either the distance of their ends, if that is more.
  std::optional<double> apart_mm;
  Vec3 at_mm{0};         ///< where that is, on the way of either
  SourceRef a_at, b_at;  ///< and whose steps; line 0: not known
};

struct MotionDiff {
  std::vector<MotionHunk> hunks;  ///< in order; the first kMostHunks
  std::size_t hunk_count = 0;     ///< all of them
  std::size_t a_steps = 0, b_steps = 0;
  /// The farthest that ways are apart, also of what counts as the same.
  double apart_mm = 0;
  static constexpr std::size_t kMostHunks = 1000;
  bool is_same() const { return hunk_count == 0; }
};

/// Ways are the same within `tolerance_mm`, however they are divided into lines and arcs; axes that
/// turn count by kTurnLever_mm. Feeds and speeds are the same within a thousandth, dwells within
/// 1 ms.
MotionDiff diff_motions(std::span<const DiffStep> a, std::span<const DiffStep> b,
                        double tolerance_mm);

}  // namespace kerf
