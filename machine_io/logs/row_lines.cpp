// Rows of cells: CSV, recordings, halsampler.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "machine_io/logs/log_lines.h"
#include "machine_io/logs/number_text.h"
#include "machine_io/recording_format.h"

namespace kerf {
namespace {

std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  if (text.size() <= kMost) return std::string(text);
  return std::string(text.substr(0, kMost)) + "..";
}

void forget(std::size_t index, AxisSample& sample) {
  sample.known = static_cast<std::uint16_t>(sample.known & ~(1U << index));
}

bool read_count(std::string_view text, std::int32_t& count) {
  return parse_count(text, count) && count >= AxisSample::kUnknown;
}

bool read_finite(std::string_view text, double factor, double& value) {
  double number = 0.0;
  if (!parse_double(text, number)) return false;
  number *= factor;
  if (!std::isfinite(number)) return false;
  value = number;
  return true;
}

bool is_nan(std::string_view text) {
  return text == "nan" || text == "NaN" || text == "NAN" || text == "-nan";
}

/// "-" and "nan": not known.
bool read_unknown(const LogColumn& column, AxisSample& sample) {
  switch (column.role) {
    case ColumnRole::kPosition:
      forget(column.index, sample);
      return true;
    case ColumnRole::kTool:
      sample.tool = AxisSample::kUnknown;
      return true;
    case ColumnRole::kLine:
      sample.line = AxisSample::kUnknown;
      return true;
    case ColumnRole::kToolOffsetZ:
      sample.tool_offset_z_mm = std::numeric_limits<double>::quiet_NaN();
      return true;
    case ColumnRole::kSpindle:
      sample.spindle_rpm = std::numeric_limits<double>::quiet_NaN();
      return true;
    case ColumnRole::kTrigger:
      sample.trigger = AxisSample::kUnknown;
      return true;
    case ColumnRole::kProgram:
      sample.program = ProgramState::kUnknown;
      return true;
    case ColumnRole::kLoad:
      sample.load = std::numeric_limits<double>::quiet_NaN();
      return true;
    default:
      return column.role == ColumnRole::kIgnored;
  }
}

const char* wanted(ColumnRole role) {
  switch (role) {
    case ColumnRole::kHostTime:
    case ColumnRole::kDeviceTime:
      return tr("a time");
    case ColumnRole::kTool:
      return tr("a tool number");
    case ColumnRole::kLine:
      return tr("a line number");
    case ColumnRole::kTrigger:
      return tr("0 or 1");
    case ColumnRole::kProgram:
      return tr("idle, running or paused");
    default:
      return tr("a number");
  }
}

/// The sample that lines build up: an empty cell leaves what is there.
class Rows : public LogLines {
 public:
  bool next_sample(AxisSample& sample) override {
    if (!is_ready_) return false;
    is_ready_ = false;
    sample = sample_;
    return true;
  }
  void forget_values() override { sample_ = AxisSample{}; }

 protected:
  explicit Rows(LogColumns columns) : columns_(std::move(columns.columns)) {}

  void begin() {
    trial_ = sample_;
    trial_.fresh = 0;
    trial_.host_ns = trial_.device_ns = AxisSample::kNoTime;
  }
  LineMeaning accept() {
    sample_ = trial_;
    is_ready_ = true;
    return LineMeaning::kSample;
  }

  std::vector<LogColumn> columns_;
  AxisSample sample_;
  AxisSample trial_;  // becomes sample_ when the whole line is good

 private:
  bool is_ready_ = false;
};

LineMeaning damaged(LineRemark& remark, std::size_t at, std::string message) {
  remark.column = static_cast<int>(at) + 1;
  remark.message = std::move(message);
  return LineMeaning::kDamaged;
}

class DelimitedRows final : public Rows {
 public:
  DelimitedRows(LogColumns columns, char delimiter, bool is_recording)
      : Rows(std::move(columns)), delimiter_(delimiter), is_recording_(is_recording) {}

  LineMeaning read(std::string_view line, LineRemark& remark) override {
    if (line.empty() || line.front() == '#') return read_comment(line, remark);
    if (is_ended_) return damaged(remark, 0, tr("there is something behind the end line"));
    if (trim(line, is_blank).empty()) return LineMeaning::kNothing;
    return read_row(line, remark);
  }

 private:
  LineMeaning read_comment(std::string_view line, LineRemark& remark) {
    if (!is_recording_) return LineMeaning::kNothing;
    if (line.starts_with(kRecordingClock)) return read_clock(line, remark);
    if (line == kRecordingRestarted) {
      is_restarted_ = true;
      return LineMeaning::kNothing;
    }
    const bool is_lost = line.starts_with(kRecordingLost);
    if (!is_lost && !line.starts_with(kRecordingEnd)) return LineMeaning::kNothing;
    line.remove_prefix(is_lost ? kRecordingLost.size() : kRecordingEnd.size());
    if (!read_number(line, remark.count)) {
      return damaged(remark, 0, tr("a count of samples is expected here"));
    }
    is_ended_ = !is_lost;
    return is_lost ? LineMeaning::kLost : LineMeaning::kEnd;
  }

  /// The computer that recorded was set: later times are put back where they would have been.
  LineMeaning read_clock(std::string_view line, LineRemark& remark) {
    line.remove_prefix(kRecordingClock.size());
    if (line.starts_with('+')) line.remove_prefix(1);
    std::int64_t by_ns = 0;
    std::int64_t set_ns = 0;
    if (!read_number(line, by_ns) || __builtin_add_overflow(clock_set_ns_, by_ns, &set_ns)) {
      return damaged(remark, 0, tr("nanoseconds by which the clock was set are expected here"));
    }
    clock_set_ns_ = set_ns;
    return LineMeaning::kNothing;
  }

  LineMeaning read_row(std::string_view line, LineRemark& remark) {
    begin();
    std::size_t at = 0;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (at > line.size()) {
        return damaged(remark, line.size(),
                       trf("{} cells found, {} expected as in the header", i, columns_.size()));
      }
      const std::size_t begin_at = at;
      std::string_view cell;
      if (!take_cell(line, at, cell)) {
        return damaged(remark, begin_at, tr("the quotation mark is not closed in this line"));
      }
      if (cell.empty() || columns_[i].role == ColumnRole::kIgnored) continue;
      if (!read_any(cell, columns_[i])) {
        return damaged(remark, begin_at,
                       trf("'{}' is not {}", shown(cell), wanted(columns_[i].role)));
      }
    }
    // A delimiter behind the last cell is a habit of some programs.
    if (at < line.size() && !trim(line.substr(at), is_blank).empty()) {
      return damaged(remark, at, trf("more cells than the {} of the header", columns_.size()));
    }
    if (trial_.host_ns == AxisSample::kNoTime && trial_.device_ns == AxisSample::kNoTime) {
      return damaged(remark, 0, tr("the line has no time"));
    }
    if (trial_.host_ns != AxisSample::kNoTime &&
        __builtin_sub_overflow(trial_.host_ns, clock_set_ns_, &trial_.host_ns)) {
      return damaged(remark, 0, tr("the time is beyond what there is"));
    }
    trial_.restarted = std::exchange(is_restarted_, false);
    return accept();
  }

  /// The cell at `at`, which is moved behind its delimiter, or beyond the line behind the last.
  bool take_cell(std::string_view line, std::size_t& at, std::string_view& cell) {
    const char* begin = line.data() + at;
    const std::size_t left = line.size() - at;
    // A cell is a few bytes long: a loop of its own is faster than a call of memchr.
    std::size_t size = 0;
    while (size < left && begin[size] != delimiter_ && begin[size] != '"') ++size;
    if (size < left && begin[size] == '"') return take_quoted(line, at, cell);
    cell = trim(std::string_view(begin, size), is_blank);
    at += size + 1;
    return true;
  }

  /// RFC 4180, but in one line. Cells that kerf reads are numbers, so "" in them need not be
  /// undone.
  bool take_quoted(std::string_view line, std::size_t& at, std::string_view& cell) {
    const std::size_t open = line.find('"', at);
    std::size_t close = open + 1;
    while (true) {
      close = line.find('"', close);
      if (close == std::string_view::npos) return false;
      if (close + 1 >= line.size() || line[close + 1] != '"') break;
      close += 2;
    }
    cell = trim(line.substr(open + 1, close - open - 1), is_blank);
    const std::size_t end = std::min(line.find(delimiter_, close), line.size());
    at = end + 1;
    return true;
  }

  bool read_any(std::string_view cell, const LogColumn& column) {
    if (is_recording_ && column.role == ColumnRole::kPosition && cell.front() == '~') {
      const std::uint16_t fresh = trial_.fresh;
      if (cell.size() < 2 || !read_cell(cell.substr(1), column, trial_)) return false;
      trial_.fresh = fresh;
      return true;
    }
    return read_cell(cell, column, trial_);
  }

  char delimiter_;
  bool is_recording_;
  bool is_ended_ = false;
  bool is_restarted_ = false;      ///< before the next sample
  std::int64_t clock_set_ns_ = 0;  ///< of the computer that recorded, so far
};

class HalsamplerRows final : public Rows {
 public:
  HalsamplerRows(LogColumns columns, bool is_numbered, double period_s)
      : Rows(std::move(columns)),
        is_numbered_(is_numbered),
        period_ns_(static_cast<std::int64_t>(std::llround(period_s * 1e9))) {}

  LineMeaning read(std::string_view line, LineRemark& remark) override {
    const std::string_view words = trim(line, is_blank);
    if (words.empty() || words.front() == '#') return LineMeaning::kNothing;
    if (words == "overrun") {
      // With numbers, their gap says how many.
      if (is_numbered_) return LineMeaning::kNothing;
      remark.count = 1;
      return LineMeaning::kLost;
    }
    begin();
    std::size_t at = 0;
    std::int64_t number = 0;
    if (is_numbered_ && !take_number(line, at, number, remark)) return LineMeaning::kDamaged;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::string_view cell = take_word(line, at);
      if (cell.empty()) {
        return damaged(remark, line.size(),
                       trf("{} values found, {} expected, one for each pin", i, columns_.size()));
      }
      if (!read_cell(cell, columns_[i], trial_)) {
        return damaged(remark, at - cell.size(),
                       trf("'{}' is not {}", shown(cell), wanted(columns_[i].role)));
      }
    }
    if (!take_word(line, at).empty()) {
      return damaged(remark, at - 1, trf("more values than the {} pins", columns_.size()));
    }
    if (!is_numbered_) number = next_number_;
    return place(number, remark);
  }

  void clock_was_set() override { next_number_ = last_number_ + 1; }

 private:
  bool take_number(std::string_view line, std::size_t& at, std::int64_t& number,
                   LineRemark& remark) {
    const std::string_view word = take_word(line, at);
    if (read_number(word, number) && number >= 0 &&
        number < std::numeric_limits<std::int64_t>::max() / period_ns_) {
      return true;
    }
    damaged(remark, at - word.size(), trf("'{}' is not a sample number", shown(word)));
    return false;
  }

  static std::string_view take_word(std::string_view line, std::size_t& at) {
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
    const std::size_t begin = at;
    while (at < line.size() && line[at] != ' ' && line[at] != '\t') ++at;
    return line.substr(begin, at - begin);
  }

  LineMeaning place(std::int64_t number, LineRemark& remark) {
    trial_.device_ns = number * period_ns_;
    last_number_ = number;
    const bool is_gap = is_numbered_ && has_number_ && number > next_number_;
    if (is_gap) remark.count = static_cast<std::uint64_t>(number - next_number_);
    // A line from before its time, or the same again, makes no gap behind it.
    if (!has_number_ || number >= next_number_) next_number_ = number + 1;
    has_number_ = true;
    return accept();
  }

  bool is_numbered_;
  std::int64_t period_ns_;
  std::int64_t last_number_ = 0;
  std::int64_t next_number_ = 0;
  bool has_number_ = false;
};

}  // namespace

bool read_cell(std::string_view text, const LogColumn& column, AxisSample& sample) {
  if (text == "-" || is_nan(text)) return read_unknown(column, sample);
  switch (column.role) {
    case ColumnRole::kIgnored:
      return true;
    case ColumnRole::kHostTime:
      return parse_stamp(text, column.ns_per_unit, sample.host_ns);
    case ColumnRole::kDeviceTime:
      return parse_stamp(text, column.ns_per_unit, sample.device_ns);
    case ColumnRole::kPosition: {
      double value = 0.0;
      if (!read_finite(text, column.factor, value)) return false;
      sample.set(column.index, value);
      return true;
    }
    case ColumnRole::kTool:
      return read_count(text, sample.tool);
    case ColumnRole::kLine:
      return read_count(text, sample.line);
    case ColumnRole::kToolOffsetZ:
      return read_finite(text, column.factor, sample.tool_offset_z_mm);
    case ColumnRole::kSpindle:
      return read_finite(text, column.factor, sample.spindle_rpm);
    case ColumnRole::kTrigger:
      return read_count(text, sample.trigger);
    case ColumnRole::kProgram:
      return parse_program_state(text, sample.program);
    case ColumnRole::kLoad:
      sample.load_unit = column.load_unit;
      if (!read_finite(text, column.factor, sample.load)) return false;
      sample.load += column.offset;
      return std::abs(sample.load) <= kMostLoad;
  }
  return false;
}

std::unique_ptr<LogLines> make_csv_lines(LogColumns columns, char delimiter) {
  return std::make_unique<DelimitedRows>(std::move(columns), delimiter, false);
}

std::unique_ptr<LogLines> make_recording_lines(LogColumns columns) {
  return std::make_unique<DelimitedRows>(std::move(columns), ',', true);
}

std::unique_ptr<LogLines> make_halsampler_lines(LogColumns columns, bool is_numbered,
                                                double period_s) {
  return std::make_unique<HalsamplerRows>(std::move(columns), is_numbered, period_s);
}

}  // namespace kerf
