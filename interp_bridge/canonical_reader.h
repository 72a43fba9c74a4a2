// interp_bridge/canonical_reader.h - a canonical listing that arrives in bytes, handed on in
// batches of motions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/canonical.h"
#include "interp_bridge/child_listener.h"
#include "interp_bridge/motion_feeder.h"
#include "interp_bridge/program.h"

namespace kerf {

struct CanonicalReaderOptions {
  std::string
      listing_name;  ///< for diagnostics of the text: "part.canon", "stdin", "rs274's output"
  bool numbered_source =
      false;  ///< the N column was made by LineNumberer; otherwise it is the user's
  std::vector<SourceRef> unnumbered;  ///< of PreparedProgram
  MotionFeederOptions feeder;
};

/// Splits and parses text, and gives the commands to a MotionFeeder. Any bytes are accepted: what
/// is not canonical is kept as foreign text, and an incomplete last line is reported. One thread.
class CanonicalReader final : public ByteReader {
 public:
  /// All references must outlive the reader. Counts and diagnostics are appended as they come.
  CanonicalReader(CanonicalReaderOptions options, const MotionSink& sink, ProgramSummary& summary,
                  Diagnostics& diagnostics);

  std::span<char> room() override;
  /// False: the sink has had enough, or there were too many commands.
  bool received(std::size_t bytes) override;
  /// The listing is complete. Takes an unfinished last line, hands over the rest, closes the
  /// counts.
  void finish();

  MotionFeeder& feeder() { return feeder_; }
  std::uint64_t commands() const { return feeder_.commands(); }
  std::uint64_t listing_lines() const { return listing_line_; }

 private:
  bool take_line(std::string_view line);
  SourceRef source_of(const CanonicalCommand& command) const;
  void take_unknown();
  void take_malformed(std::string_view line);

  CanonicalReaderOptions options_;
  Diagnostics& diagnostics_;
  MotionFeeder feeder_;
  CanonicalLine line_;
  std::vector<char> buffer_;
  std::size_t filled_ = 0;
  std::uint64_t listing_line_ = 0;
  std::uint64_t malformed_ = 0;
};

}  // namespace kerf
