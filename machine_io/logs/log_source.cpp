#include "machine_io/logs/log_source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>

#include "machine_io/can/can_map.h"
#include "machine_io/logs/line_reader.h"
#include "machine_io/logs/log_lines.h"
#include "machine_io/logs/log_opening.h"

namespace kerf {
namespace {

constexpr double kLeastPeriod_s = 1e-6;
constexpr double kMostPeriod_s = 10.0;
constexpr std::size_t kLongestExcerpt = 160;

/// -1, 0, 1: `a` before, at, after `b`; by the device's clock if both have it. 1 if nothing tells.
int compare_times(const AxisSample& a, const AxisSample& b) {
  const auto compare = [](std::int64_t left, std::int64_t right) {
    return left < right ? -1 : (left > right ? 1 : 0);
  };
  if (a.device_ns != AxisSample::kNoTime && b.device_ns != AxisSample::kNoTime) {
    return compare(a.device_ns, b.device_ns);
  }
  if (a.host_ns != AxisSample::kNoTime && b.host_ns != AxisSample::kNoTime) {
    return compare(a.host_ns, b.host_ns);
  }
  return 1;
}

std::string error_text(int number) {
  char buffer[128];
  return strerror_r(number, buffer, sizeof buffer);
}

/// A descriptor, and whether data may come later. Negative: `why` says why.
int open_file(const std::string& path, bool& is_waited_for, std::string& why) {
  // Standard input as a copy, so that the reader may close it.
  const int fd = path == "-" ? ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3)
                             : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  struct stat info {};
  if (fd < 0 || ::fstat(fd, &info) != 0) {
    why = error_text(errno);
    if (fd >= 0) ::close(fd);
    return -1;
  }
  if (S_ISDIR(info.st_mode)) {
    why = error_text(EISDIR);
    ::close(fd);
    return -1;
  }
  is_waited_for = !S_ISREG(info.st_mode);
  return fd;
}

}  // namespace

std::vector<std::string> validate(const LogSettings& settings) {
  std::vector<std::string> faults;
  if (settings.path.empty()) {
    faults.push_back("source.path: empty; a file is needed, or '-' for standard input");
  }
  if (!(settings.period_s >= kLeastPeriod_s && settings.period_s <= kMostPeriod_s)) {
    faults.push_back(
        fmt::format("source.period_s: {} found, 0.000001 to 10 allowed (seconds per sample)",
                    settings.period_s));
  }
  if (settings.rotary_joints >> kMaxPositions != 0) {
    faults.push_back(fmt::format("source.rotary_joints: {:#x} found, bits 0 to 8 allowed",
                                 settings.rotary_joints));
  }
  const bool is_auto = settings.format == LogFormat::kAuto;
  if (settings.format == LogFormat::kHalsampler && settings.pins.empty()) {
    faults.push_back(
        "source.pins: none; halsampler needs the HAL pins in the order of the columns");
  }
  if (settings.format != LogFormat::kHalsampler && !is_auto && !settings.pins.empty()) {
    faults.push_back("source.pins: only for halsampler; other formats name their columns");
  }
  if (settings.format == LogFormat::kCandump && !settings.can_map) {
    faults.push_back("source.map: none; candump needs the id, byte and type of each position");
  }
  if (settings.format != LogFormat::kCandump && !is_auto && settings.can_map) {
    faults.push_back("source.map: only for candump; other formats name their columns");
  }
  if (settings.can_map) {
    for (std::string& fault : validate(*settings.can_map, "source.map")) {
      faults.push_back(std::move(fault));
    }
  }
  return faults;
}

class LogSource::Reading {
 public:
  Reading(LogSettings settings, std::string name, int fd, bool is_waited_for)
      : settings_(std::move(settings)),
        name_(std::move(name)),
        reader_(fd, is_waited_for, kLongestLine_bytes) {}

  bool open(Diagnostics& diagnostics) {
    return open_log(reader_, name_, settings_, log_, notes_, diagnostics);
  }

  Next next(AxisSample& sample, std::chrono::milliseconds patience) {
    while (true) {
      while (log_.lines->next_sample(sample)) {
        if (hand_out(sample)) return Next::kSample;
      }
      if (is_at_end_) {
        if (status_.state != SourceState::kFailed) status_.state = SourceState::kEnded;
        return Next::kEnd;
      }
      std::string_view line;
      switch (next_line(line, patience)) {
        case LineReader::Got::kNothing:
          return Next::kNothing;
        case LineReader::Got::kLine:
          take(line);
          break;
        case LineReader::Got::kUnended:
          take_unended(line);
          break;
        case LineReader::Got::kTooLong:
          damaged({0, fmt::format("a line of more than {} bytes", kLongestLine_bytes), 0}, line);
          break;
        case LineReader::Got::kFault:
          status_.state = SourceState::kFailed;
          status_.trouble = fmt::format("reading {}: {}", name_, reader_.fault());
          is_at_end_ = true;
          return Next::kEnd;
        case LineReader::Got::kEnd:
          end();
          break;
      }
    }
  }

  const SourceStatus& status() const { return status_; }
  const LogContents& contents() const { return log_.contents; }
  const Diagnostics& notes() const { return notes_; }
  std::string describe() const { return "log " + name_; }

 private:
  LineReader::Got next_line(std::string_view& line, std::chrono::milliseconds patience) {
    if (!log_.has_first_line) return reader_.next(line, patience);
    log_.has_first_line = false;
    line = log_.first_line;
    return log_.is_first_unended ? LineReader::Got::kUnended : LineReader::Got::kLine;
  }

  void note(Severity severity, int column, std::string message, std::string excerpt) {
    notes_.push_back({severity,
                      name_,
                      static_cast<int>(reader_.line_number()),
                      column,
                      std::move(message),
                      std::move(excerpt),
                      {}});
  }

  /// About a line. After kMostDescribed they are only counted.
  void describe_line(int column, const std::string& message, std::string_view line) {
    status_.trouble = fmt::format("{}:{}: {}", name_, reader_.line_number(), message);
    if (described_ > kMostDescribed) return;
    if (described_++ == kMostDescribed) {
      note(Severity::kNote, 0, "further lines that could not be used are only counted", {});
      return;
    }
    const bool is_short = column > 0 && line.size() <= kLongestExcerpt;
    note(Severity::kWarning, column, message, is_short ? std::string(line) : std::string());
  }

  void damaged(const LineRemark& remark, std::string_view line) {
    ++status_.errors;
    describe_line(remark.column, remark.message, line);
  }

  void take(std::string_view line) {
    remark_.count = 0;
    switch (log_.lines->read(line, remark_)) {
      case LineMeaning::kNothing:
        break;
      case LineMeaning::kSample:
        ++rows_;
        status_.lost += remark_.count;
        break;
      case LineMeaning::kDamaged:
        damaged(remark_, line);
        break;
      case LineMeaning::kLate:
        ++status_.disordered;
        break;
      case LineMeaning::kClockSet:
        ++status_.disordered;
        note_clock_set();
        has_last_ = false;
        break;
      case LineMeaning::kLost:
        status_.lost += remark_.count;
        break;
      case LineMeaning::kEnd:
        has_end_line_ = true;
        check_count(remark_.count);
        break;
    }
    complain();
  }

  void take_unended(std::string_view line) {
    if (contents().format == LogFormat::kRecording) {
      is_torn_ = true;
      return;
    }
    take(line);
    note(Severity::kNote, 0,
         "the last line has no line end; if the log was cut off there, its last value may be short",
         {});
  }

  void check_count(std::uint64_t count) {
    if (count == rows_) return;
    describe_line(1, fmt::format("the end line says {} samples, {} could be read", count, rows_),
                  {});
  }

  void complain() {
    std::string text;
    while (log_.lines->take_complaint(text)) {
      status_.trouble = fmt::format("{}: {}", name_, text);
      note(Severity::kWarning, 0, text, {});
    }
  }

  void end() {
    is_at_end_ = true;
    log_.lines->end();
    complain();
    if (contents().format == LogFormat::kRecording && !has_end_line_) {
      const std::string text =
          fmt::format("cut off after {} samples{}", rows_,
                      is_torn_ ? "; the piece of a line behind them is dropped" : "");
      status_.trouble = fmt::format("{}: {}", name_, text);
      note(Severity::kWarning, 0, text, {});
    }
  }

  void note_clock_set() {
    if (clock_notes_++ == kMostDescribed) return;
    if (clock_notes_ > kMostDescribed) return;
    note(Severity::kWarning, 0,
         "the log's clock was set back here, or another log begins: samples follow on the new time",
         {});
  }

  /// False: not in its order.
  bool is_in_order(const AxisSample& sample) {
    if (!has_last_) return true;
    const int order = compare_times(sample, last_);
    if (order > 0) {
      disorder_run_ = 0;
      return true;
    }
    if (order == 0) {
      ++status_.duplicates;
      return false;
    }
    // The assembler of frames has judged already.
    if (log_.lines->judges_order()) return true;
    disorder_run_ =
        disorder_run_ > 0 && compare_times(sample, disordered_) > 0 ? disorder_run_ + 1 : 1;
    if (disorder_run_ > kClockSet) {
      disorder_run_ = 0;
      note_clock_set();
      log_.lines->clock_was_set();
      return true;
    }
    disordered_ = sample;
    ++status_.disordered;
    if (status_.disordered <= kMostDescribed) {
      status_.trouble = fmt::format("{}:{}: the stamp is before that of an earlier line", name_,
                                    reader_.line_number());
    }
    return false;
  }

  bool hand_out(AxisSample& sample) {
    if (!is_in_order(sample)) return false;
    has_last_ = true;
    last_.host_ns = sample.host_ns;
    last_.device_ns = sample.device_ns;
    // A recording says itself when its samples were read.
    const bool is_recorded = contents().format == LogFormat::kRecording;
    if (sample.host_ns == AxisSample::kNoTime && !is_recorded) sample.host_ns = reader_.read_ns();
    ++status_.samples;
    status_.state = SourceState::kReading;
    return true;
  }

  LogSettings settings_;
  std::string name_;
  LineReader reader_;
  OpenedLog log_;
  SourceStatus status_;
  Diagnostics notes_;
  LineRemark remark_;
  std::size_t described_ = 0;
  std::size_t clock_notes_ = 0;

  bool is_at_end_ = false;
  bool is_torn_ = false;  // a recording's last line has no LF
  bool has_end_line_ = false;
  std::uint64_t rows_ = 0;  // lines that are samples, in order or not

  bool has_last_ = false;
  AxisSample last_;        // its times alone
  AxisSample disordered_;  // the last one that went back
  int disorder_run_ = 0;
};

std::unique_ptr<LogSource> LogSource::open(LogSettings settings, Diagnostics& diagnostics) {
  const auto faults = validate(settings);
  for (const std::string& fault : faults) {
    diagnostics.push_back({Severity::kError, {}, 0, 0, fault, {}, {}});
  }
  if (!faults.empty()) return nullptr;
  const std::string name = settings.path == "-" ? "standard input" : settings.path;
  bool is_waited_for = false;
  std::string why;
  const int fd = open_file(settings.path, is_waited_for, why);
  if (fd < 0) {
    diagnostics.push_back({Severity::kError, name, 0, 0, why, {}, {}});
    return nullptr;
  }
  auto reading = std::make_unique<Reading>(std::move(settings), name, fd, is_waited_for);
  if (!reading->open(diagnostics)) return nullptr;
  return std::unique_ptr<LogSource>(new LogSource(std::move(reading)));
}

LogSource::LogSource(std::unique_ptr<Reading> reading) : reading_(std::move(reading)) {}

LogSource::~LogSource() = default;

LogSource::Next LogSource::next(AxisSample& sample, std::chrono::milliseconds patience) {
  return reading_->next(sample, patience);
}

const SourceStatus& LogSource::status() const { return reading_->status(); }

std::string LogSource::describe() const { return reading_->describe(); }

const LogContents& LogSource::contents() const { return reading_->contents(); }

const Diagnostics& LogSource::notes() const { return reading_->notes(); }

}  // namespace kerf
