#include "machine_io/logs/log_source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "machine_io/can/can_map.h"
#include "machine_io/logs/line_reader.h"
#include "machine_io/logs/log_lines.h"
#include "machine_io/logs/log_opening.h"
#include "machine_io/recording_format.h"

namespace kerf {
namespace {

constexpr double kLeastPeriod_s = 1e-6;
constexpr double kMostPeriod_s = 10.0;
constexpr std::size_t kLongestExcerpt = 160;
/// A recorder writes a sum every second; a file that has none behind so many samples is damaged.
constexpr std::size_t kMostUnsummed = 100'000;

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

/// The same reading once more.
bool is_same(const AxisSample& a, const AxisSample& b) {
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  if (a.known != b.known || a.tool != b.tool || a.trigger != b.trigger || a.line != b.line ||
      !same(a.tool_offset_z_mm, b.tool_offset_z_mm) || !same(a.spindle_rpm, b.spindle_rpm) ||
      !same(a.load, b.load)) {
    return false;
  }
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (a.has(i) && a.position[i] != b.position[i]) return false;
  }
  return true;
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
    faults.push_back(tr("source.path: empty; a file is needed, or '-' for standard input"));
  }
  if (!(settings.period_s >= kLeastPeriod_s && settings.period_s <= kMostPeriod_s)) {
    faults.push_back(trf("source.period_s: {} found, 0.000001 to 10 allowed (seconds per sample)",
                         settings.period_s));
  }
  if (settings.rotary_joints >> kMaxPositions != 0) {
    faults.push_back(
        trf("source.rotary_joints: {:#x} found, bits 0 to 8 allowed", settings.rotary_joints));
  }
  const bool is_auto = settings.format == LogFormat::kAuto;
  if (settings.format == LogFormat::kHalsampler && settings.pins.empty()) {
    faults.push_back(
        tr("source.pins: none; halsampler needs the HAL pins in the order of the columns"));
  }
  if (settings.format != LogFormat::kHalsampler && !is_auto && !settings.pins.empty()) {
    faults.push_back(tr("source.pins: only for halsampler; other formats name their columns"));
  }
  if (settings.format == LogFormat::kCandump && !settings.can_map) {
    faults.push_back(tr("source.map: none; candump needs the id, byte and type of each position"));
  }
  if (settings.format != LogFormat::kCandump && !is_auto && settings.can_map) {
    faults.push_back(tr("source.map: only for candump; other formats name their columns"));
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
        is_waited_for_(is_waited_for),
        reader_(fd, is_waited_for, kLongestLine_bytes) {}

  bool open(Diagnostics& diagnostics) {
    return open_log(reader_, name_, settings_, log_, notes_, diagnostics);
  }

  Next next(AxisSample& sample, std::chrono::milliseconds patience) {
    while (true) {
      while (next_parsed(sample)) {
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
          damaged({0, trf("a line of more than {} bytes", kLongestLine_bytes), 0}, line);
          break;
        case LineReader::Got::kFault:
          status_.state = SourceState::kFailed;
          status_.trouble = trf("reading {}: {}", name_, reader_.fault());
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
      note(Severity::kNote, 0, tr("further lines that could not be used are only counted"), {});
      return;
    }
    const bool is_short = column > 0 && line.size() <= kLongestExcerpt;
    note(Severity::kWarning, column, message, is_short ? std::string(line) : std::string());
  }

  void damaged(const LineRemark& remark, std::string_view line) {
    ++status_.errors;
    describe_line(remark.column, remark.message, line);
  }

  bool has_sums() const { return contents().recording && contents().recording->sums; }

  /// Of a file with sums: as soon as the sum of its part has been found right.
  bool next_parsed(AxisSample& sample) {
    if (!has_sums()) return log_.lines->next_sample(sample);
    if (part_at_ == part_good_) return false;
    sample = part_[part_at_++];
    return true;
  }

  /// The part of a recording up to its sum.
  void end_part(bool is_good, std::string_view line) {
    part_good_ = part_.size();
    if (is_good) return;
    ++status_.errors;
    status_.damaged += part_.size() - part_at_;
    status_.lost += part_.size() - part_at_;
    describe_line(1,
                  trf("the {} samples before this line are damaged: their sum is wrong; "
                      "they are dropped",
                      part_.size() - part_at_),
                  line);
    part_at_ = part_good_;
    log_.lines->forget_values();
  }

  /// False: the line is one of a recording's sums.
  bool is_summed(std::string_view line) {
    if (part_at_ == part_good_) {
      part_.erase(part_.begin(), part_.begin() + static_cast<std::ptrdiff_t>(part_at_));
      part_at_ = part_good_ = 0;
    }
    if (line.starts_with(kRecordingSum)) {
      std::uint32_t sum = 0;
      end_part(parse_recording_sum(line, sum) && sum == log_.sum, line);
      log_.sum = 0;
      return false;
    }
    log_.sum = crc32(crc32(log_.sum, line), "\n");
    return true;
  }

  void take(std::string_view line) {
    if (!has_sums()) return take_line(line);
    if (!is_summed(line)) return;
    take_line(line);
    AxisSample sample;
    while (log_.lines->next_sample(sample)) part_.push_back(sample);
    if (part_.size() - part_good_ >= kMostUnsummed) {
      end_part(false, line);
      log_.sum = 0;
    }
  }

  void take_line(std::string_view line) {
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
        // The last sum stands before it.
        if (part_.size() != part_good_) end_part(false, {});
        check_count(remark_.count);
        break;
    }
    complain();
    note_incomplete();
  }

  void note_incomplete() {
    const std::uint64_t incomplete = log_.lines->incomplete();
    if (incomplete == status_.incomplete) return;
    status_.incomplete = incomplete;
    describe_line(0, log_.lines->incomplete_text(), {});
  }

  void take_unended(std::string_view line) {
    if (contents().format == LogFormat::kRecording) {
      is_torn_ = true;
      return;
    }
    take(line);
    note(Severity::kNote, 0,
         tr("the last line has no line end; if the log was cut off there, its last value may be "
            "short"),
         {});
  }

  void check_count(std::uint64_t count) {
    if (count == rows_) return;
    ++status_.errors;
    describe_line(1, trf("the end line says {} samples, {} could be read", count, rows_), {});
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
      std::string text = trf("cut off after {} samples{}", rows_,
                             is_torn_ ? tr("; the piece of a line behind them is dropped") : "");
      if (const std::size_t unsummed = part_.size() - part_good_; unsummed > 0) {
        text += trf("; the last {} have no sum that tells whether they are damaged", unsummed);
        part_good_ = part_.size();
      }
      status_.trouble = fmt::format("{}: {}", name_, text);
      // What came behind is missing, nobody knows how much.
      ++status_.errors;
      note(Severity::kWarning, 0, text, {});
    }
  }

  void note_clock_set() {
    if (clock_notes_++ == kMostDescribed) return;
    if (clock_notes_ > kMostDescribed) return;
    note(Severity::kWarning, 0,
         tr("the log's clock was set back here, or another log begins: samples follow on the new "
            "time"),
         {});
  }

  /// When the sample was received: a recording says it, a pipe shows it.
  std::int64_t received_ns(const AxisSample& sample) const {
    if (contents().format == LogFormat::kRecording) return sample.host_ns;
    return is_waited_for_ ? reader_.read_ns() : AxisSample::kNoTime;
  }

  /// What passed since the last sample by the times of receipt; 0 without them.
  std::int64_t received_step_ns(std::int64_t received_ns) const {
    const bool known =
        received_ns != AxisSample::kNoTime && last_received_ns_ != AxisSample::kNoTime;
    return known ? std::max<std::int64_t>(0, received_ns - last_received_ns_) : 0;
  }

  /// Goes on by the times of receipt while the device's clock stands. False: the same once more.
  bool mend_time(AxisSample& sample, std::int64_t received_ns) {
    const std::int64_t device_ns = sample.device_ns;
    if (device_ns == AxisSample::kNoTime || !has_last_ || last_.device_ns == AxisSample::kNoTime) {
      return true;
    }
    const std::int64_t step_ns = received_step_ns(received_ns);
    if (device_ns == last_stamp_ns_) {
      if (step_ns == 0 && is_same(sample, last_)) return false;
      sample.device_ns = last_.device_ns + step_ns;
      stood_ns_ += step_ns;
      note_standing();
    } else {
      // A clock that goes on has stood, or only its stamps have: the times of receipt tell.
      const std::int64_t went_ns = device_ns - last_stamp_ns_;
      const bool caught_up = std::abs(went_ns - stood_ns_ - step_ns) < std::abs(went_ns - step_ns);
      sample.device_ns = last_.device_ns + went_ns - (caught_up ? stood_ns_ : 0);
      stood_ns_ = 0;
      standing_run_ = 0;
    }
    return true;
  }

  /// A few in a row are a burst that was stamped at once, or a coarse clock.
  void note_standing() {
    if (++standing_run_ < kStanding) return;
    status_.standing += standing_run_ == kStanding ? kStanding : 1;
    if (standing_run_ != kStanding) return;
    describe_line(0, tr("the device's clock stands still: its stamp is that of the line before"),
                  {});
  }

  /// False: not in its order.
  bool is_in_order(const AxisSample& sample) {
    if (!has_last_) return true;
    const int order = compare_times(sample, last_);
    const bool stands = order == 0 && standing_run_ > 0;
    if (order > 0 || stands) {
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
      status_.trouble =
          trf("{}:{}: the stamp is before that of an earlier line", name_, reader_.line_number());
    }
    return false;
  }

  bool hand_out(AxisSample& sample) {
    const std::int64_t stamp_ns = sample.device_ns;
    const std::int64_t received = received_ns(sample);
    if (!mend_time(sample, received)) {
      ++status_.duplicates;
      return false;
    }
    if (!is_in_order(sample)) return false;
    has_last_ = true;
    last_ = sample;
    last_stamp_ns_ = stamp_ns;
    last_received_ns_ = received;
    // A recording says itself when its samples were read.
    const bool is_recorded = contents().format == LogFormat::kRecording;
    if (sample.host_ns == AxisSample::kNoTime && !is_recorded) sample.host_ns = reader_.read_ns();
    ++status_.samples;
    status_.state = SourceState::kReading;
    return true;
  }

  LogSettings settings_;
  std::string name_;
  bool is_waited_for_;
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
  AxisSample last_;                                   // as it was handed out
  std::int64_t last_stamp_ns_ = AxisSample::kNoTime;  // its device_ns as the log has it
  std::int64_t last_received_ns_ = AxisSample::kNoTime;
  std::int64_t stood_ns_ = 0;  // that has passed while the device's clock stands
  int standing_run_ = 0;       // samples in a row with one stamp, but the first

  /// Of a recording with sums: what has been read since the last sum, and before that what has not
  /// been handed out yet.
  std::vector<AxisSample> part_;
  std::size_t part_at_ = 0;    // the next to be handed out
  std::size_t part_good_ = 0;  // so many may be

  AxisSample disordered_;  // the last one that went back
  int disorder_run_ = 0;
};

std::unique_ptr<LogSource> LogSource::open(LogSettings settings, Diagnostics& diagnostics) {
  const auto faults = validate(settings);
  for (const std::string& fault : faults) {
    diagnostics.push_back({Severity::kError, {}, 0, 0, fault, {}, {}});
  }
  if (!faults.empty()) return nullptr;
  const std::string name = settings.path == "-" ? tr("standard input") : settings.path;
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
