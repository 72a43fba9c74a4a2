// machine_io/logs/log_lines.h - what one line of a log says, per format. No files here.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "machine_io/logs/log_columns.h"
#include "machine_io/logs/log_source.h"

namespace kerf {

/// What became of a line.
enum class LineMeaning : std::uint8_t {
  kNothing,   ///< comment, blank, what is not asked for
  kSample,    ///< taken; next_sample() may have some. LineRemark::count are missing before
  kDamaged,   ///< LineRemark says what is wrong; next_sample() may still have some of before
  kLate,      ///< stamp before one that was read; not used
  kClockSet,  ///< the log's clock went back for good; what next_sample() has comes after that
  kLost,      ///< LineRemark::count samples are missing here
  kEnd,       ///< the end line of a recording, LineRemark::count samples
};

struct LineRemark {
  int column = 0;       ///< of damage, in bytes, from 1
  std::string message;  ///< set for kDamaged alone, so that good lines allocate nothing
  std::uint64_t count = 0;
};

/// Reads the lines of one log in their order.
class LogLines {
 public:
  virtual ~LogLines() = default;
  /// One line without its end. All samples of the line before have been taken.
  virtual LineMeaning read(std::string_view line, LineRemark& remark) = 0;
  /// Samples that the lines up to now have made, each once; host_ns is set only if the log has it.
  virtual bool next_sample(AxisSample& sample) = 0;
  /// No line follows: next_sample() may have one more.
  virtual void end() {}
  /// True if samples are in order by themselves, and the reader's order is not to be judged again.
  virtual bool judges_order() const { return false; }
  /// What was read last is not believed: an empty cell does not stand for it.
  virtual void forget_values() {}
  /// The last sample is from after the log's clock was set back; numbers begin anew there.
  virtual void clock_was_set() {}
  /// Cycles of a bus that were dropped because a frame was missing, and about the last of them.
  virtual std::uint64_t incomplete() const { return 0; }
  virtual std::string incomplete_text() const { return {}; }
  /// Said once each, when there is something to say: what the lines as a whole lack.
  virtual bool take_complaint(std::string&) { return false; }
};

/// CSV and recordings: cells between delimiters.
std::unique_ptr<LogLines> make_csv_lines(LogColumns columns, char delimiter);
std::unique_ptr<LogLines> make_recording_lines(LogColumns columns);

/// halsampler: `is_numbered`: each line begins with the sample number (`-t`).
std::unique_ptr<LogLines> make_halsampler_lines(LogColumns columns, bool is_numbered,
                                                double period_s);

/// candump, by the settings' map, which must be valid.
std::unique_ptr<LogLines> make_candump_lines(const LogSettings& settings);

/// One value into a sample. `text` is not empty. False: no number that is allowed there.
bool read_cell(std::string_view text, const LogColumn& column, AxisSample& sample);

}  // namespace kerf
