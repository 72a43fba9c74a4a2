// interp_bridge/canonical_reader.h - a canonical listing that arrives in bytes, handed on in
// batches of motions.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/canonical.h"
#include "interp_bridge/motion_fold.h"
#include "interp_bridge/program.h"

namespace kerf {

struct CanonicalReaderOptions {
  std::string
      listing_name;  ///< for diagnostics of the text: "part.canon", "stdin", "rs274's output"
  bool numbered_source =
      false;  ///< the N column was made by LineNumberer; otherwise it is the user's
  std::vector<SourceRef> unnumbered;  ///< of PreparedProgram
  std::vector<int> tool_by_index;     ///< of MotionFold
  bool diameters_known =
      true;  ///< false: warn of cutter compensation, whose radius the interpreter took as 0
  std::uint64_t max_commands = 0;
};

/// Splits, parses, counts, folds; collects the diagnostics that the text gives rise to. Any bytes
/// are accepted: what is not canonical is kept as foreign text, and an incomplete last line is
/// reported. One thread.
class CanonicalReader {
 public:
  /// All references must outlive the reader. Counts and diagnostics are appended as they come.
  CanonicalReader(CanonicalReaderOptions options, const MotionSink& sink, ProgramSummary& summary,
                  Diagnostics& diagnostics);

  /// Where to put the next bytes; never empty.
  std::span<char> room();
  /// Takes `bytes` of room(). False: the sink has had enough, or there were too many commands.
  bool received(std::size_t bytes);
  /// Hands over what has waited for longer than a screen would forgive (about 40 ms). False as
  /// above.
  bool flush_if_old();
  /// The listing is complete. Takes an unfinished last line, hands over the rest, closes the
  /// counts.
  void finish();

  void add_foreign(std::string_view line);

  std::uint64_t commands() const { return commands_; }
  std::uint64_t listing_lines() const { return listing_line_; }
  bool too_many_commands() const { return too_many_; }
  /// Of the last command.
  SourceRef last_source() const { return source_; }
  /// A batch is waiting to be handed over.
  bool has_batch() const { return !batch_.empty(); }

 private:
  bool take_line(std::string_view line);
  void take_command();
  void take_unknown();
  void take_malformed(std::string_view line);
  void remark(FoldRemark remark);
  void remark_on_text(const CanonicalCommand& command);
  void locate(const CanonicalCommand& command);
  Diagnostic at_source(Severity severity, std::string message) const;
  bool hand_over();

  CanonicalReaderOptions options_;
  const MotionSink& sink_;
  ProgramSummary& summary_;
  Diagnostics& diagnostics_;
  MotionFold fold_;
  CanonicalLine line_;
  std::vector<char> buffer_;
  std::size_t filled_ = 0;
  std::vector<Motion> batch_;
  std::chrono::steady_clock::time_point batch_since_;
  std::array<std::uint64_t, kCanonicalNameCount> counts_{};
  std::uint64_t commands_ = 0;
  std::uint64_t listing_line_ = 0;
  std::uint64_t malformed_ = 0;
  std::uint64_t splines_lost_ = 0;
  bool plane_reported_ = false;
  bool compensation_reported_ = false;
  bool too_many_ = false;
  bool sink_done_ = false;
  SourceRef source_;
};

}  // namespace kerf
