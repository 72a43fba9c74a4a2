// twin/live/source_watch.h - which samples of a watched machine count, and what lies between two of
// them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "machine_io/position_source.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/live/live_cut_options.h"
#include "twin/live/reading.h"
#include "twin/live/reading_bounds.h"
#include "twin/live/sample_gate.h"
#include "twin/report/live_facts.h"

namespace kerf {

/// A finding of a watch, at a place of the workpiece. `tool` < 0: it is not known.
Finding live_finding(FindingId id, Severity severity, double t_s, const Vec3& place_mm, int tool);

/// Readings that no machine can have are dropped (ReadingBounds, SampleGate) and told of, once each
/// kind. Between those that are left a gap, a jump or a restart of the controller is found and told
/// of. One thread.
class SourceWatch {
 public:
  /// The references must outlive it. `facts` gets gaps, jumps and wild readings.
  SourceWatch(const StockModel& stock, const LiveCutOptions& options, FindingLog& log,
              LiveFacts& facts);

  /// A reading where no machine is: it moves nothing, and is told of.
  bool drops(const AxisSample& sample, double t_s);
  /// The next sample; those that may pass, until the next call.
  std::span<const SampleGate::Timed> sift(const AxisSample& sample, double t_s, bool lost);
  /// No other comes: what waits.
  std::span<const SampleGate::Timed> finish();
  /// The sample has a position that no machine has.
  bool is_beyond(const AxisSample& sample) const { return bounds_.fault_of(sample).has_value(); }

  /// Time between two samples in which some are missing.
  bool is_long(double elapsed_s) const;
  enum class Break : std::uint8_t { kNone, kGap, kJump, kRestart };
  /// What is between two readings, the second of which is the newest. Once a reading: it learns
  /// from it how often they come. `lost`: others are known to be missing between them.
  Break break_between(const Reading& before, const Reading& now, bool lost);
  /// What a controller that did not run has moved is nothing; where it ended in a program is not
  /// known. `runs`: it may have been in a program. `line`: of the program, where it was last.
  void note_restart(const Reading& before, const Reading& now, bool runs, SourceRef line);
  /// `jump`: it is a Break::kJump; `by_program`: the way between is cut as the program has it.
  void note_gap(const Reading& before, const Reading& now, bool jump, bool by_program,
                SourceRef line);

 private:
  double way_between(const Reading& before, const Reading& now) const;
  bool too_fast(const Reading& before, const Reading& now) const;
  void note_wild(std::size_t count, double t_s);

  const StockModel& stock_;
  const LiveCutOptions& options_;
  FindingLog& log_;
  LiveFacts& facts_;
  ReadingBounds bounds_;
  SampleGate gate_;
  std::vector<SampleGate::Timed> passed_;  ///< by the gate
  bool wild_told_ = false;
  bool quick_told_ = false;
  double period_s_ = 0;    ///< usual time between samples
  bool was_fast_ = false;  ///< between the last two samples, faster than the machine can be
};

}  // namespace kerf
