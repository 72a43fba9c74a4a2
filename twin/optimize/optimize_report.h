// twin/optimize/optimize_report.h - what other feeds have made of a program, for people and as
// JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "twin/optimize/feed_plan.h"
#include "twin/optimize/feed_survey.h"

namespace kerf {

/// One of the two programs, as the planner runs it.
struct OptimizedRun {
  double duration_s = 0;
  std::map<int, double> seconds_by_tool;
  PerLimit<PeakLoad> peaks;
};

struct OptimizeReport {
  std::string program, out;
  FeedAims aims;
  std::string time_model;
  std::string digest;  ///< of either workpiece
  OptimizedRun before, after;
  std::map<int, std::string> shapes;               ///< of tools, by number
  std::size_t blocks = 0;                          ///< of PROGRAM, with moves at a feed
  std::size_t changed = 0;                         ///< of them, those that run at another feed
  std::size_t split_blocks = 0, split_pieces = 0;  ///< divided, and what has come of them
  /// Loops and subroutines that are written out, and of each line of that the program's.
  std::size_t unrolled_passes = 0, unrolled_calls = 0;
  std::vector<std::uint32_t> unrolled_lines;
  std::size_t elsewhere = 0;  ///< motions of subroutines in other files
  /// Lines whose feeds are left as they are, by why.
  std::map<FeedLeft, std::vector<std::uint32_t>> left;
  /// A block that is run several times, with the tool engaged in different ways: it gets what the
  /// slowest of them may have.
  struct Shared {
    std::uint32_t line = 0;
    std::size_t motions = 0;
    double slowest_mm_per_min = 0, fastest_mm_per_min = 0;
  };
  std::vector<Shared> shared;
};

/// Fills in what a plan tells.
void add_plan(const FeedBlocks& blocks, const FeedPlan& plan, OptimizeReport& report);

/// A page. In mm.
std::string optimize_text(const OptimizeReport& report);

/// kerf-optimize/1: schema, version, optimize: program, out, limits (by their
/// keys, of key_of(CutLimit); feed_mm_per_min, air_feed_mm_per_min, of those that were given),
/// blocks, changed, unroll (passes, calls, line_before: of each line of the program written out
/// that of PROGRAM, 0 for remarks), motions_elsewhere, time_s (before, after, model), tools
/// (number, shape, before_s, after_s), peaks (by limit: before, before_line, after, after_line, at
/// the speed that the planner reaches), left (reason, blocks, lines: the first kMostLines), shared
/// (line, motions, slowest_mm_per_min, fastest_mm_per_min), digest.
std::string optimize_json(const OptimizeReport& report, const std::string& version);
inline constexpr std::size_t kMostLines = 1000;

}  // namespace kerf
