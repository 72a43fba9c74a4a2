#include "machine_io/logs/log_opening.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "machine_io/logs/candump_line.h"
#include "machine_io/logs/number_text.h"
#include "machine_io/recording_format.h"

namespace kerf {
namespace {

constexpr std::size_t kLongestHead = 160;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::chrono::milliseconds kAsLongAsItTakes{-1};

struct Magic {
  std::string_view bytes;
  const char* what;
  const char* hint;
};

constexpr std::array<Magic, 8> kMagics{{
    {"\xFD"
     "7zXZ",
     tr_noop("compressed (xz)"), tr_noop("xz -dc FILE gives the text; '-' reads it from a pipe")},
    {"\x1F\x8B", tr_noop("compressed (gzip)"),
     tr_noop("gzip -dc FILE gives the text; '-' reads it from a pipe")},
    {"\x28\xB5\x2F\xFD", tr_noop("compressed (zstd)"),
     tr_noop("zstd -dc FILE gives the text; '-' reads it from a pipe")},
    {"BZh", tr_noop("compressed (bzip2)"),
     tr_noop("bzip2 -dc FILE gives the text; '-' reads it from a pipe")},
    {"PK\x03\x04", tr_noop("a zip archive or a spreadsheet"), tr_noop("export the sheet as CSV")},
    {"\xFF\xFE", tr_noop("UTF-16 text"), tr_noop("save it as UTF-8")},
    {"\xFE\xFF", tr_noop("UTF-16 text"), tr_noop("save it as UTF-8")},
    {"\x7F"
     "ELF",
     tr_noop("a program"), ""},
}};

std::size_t count_words(std::string_view line) {
  std::size_t count = 0;
  bool is_in_word = false;
  for (const char c : line) {
    const bool is_blank = c == ' ' || c == '\t';
    if (!is_blank && !is_in_word) ++count;
    is_in_word = !is_blank;
  }
  return count;
}

/// Numbers between blanks, as halsampler writes them.
bool is_row_of_numbers(std::string_view line) {
  line = trim(line, is_blank);
  if (line.empty()) return false;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    double value = 0.0;
    if (!parse_double(line.substr(0, end), value)) return false;
    line = trim(line.substr(end), is_blank);
  }
  return true;
}

class Opening {
 public:
  Opening(LineReader& reader, const std::string& name, const LogSettings& settings, OpenedLog& log,
          Diagnostics& notes, Diagnostics& diagnostics)
      : reader_(reader),
        name_(name),
        settings_(settings),
        log_(log),
        notes_(notes),
        diagnostics_(diagnostics) {}

  bool run() {
    if (!next_line()) {
      return has_faults_ ? false : fail(0, tr("the file is empty"), "");
    }
    if (line_.starts_with(kByteOrderMark)) line_.remove_prefix(kByteOrderMark.size());
    if (!is_text()) return false;
    const bool is_recording = line_.starts_with("# kerf-recording/");
    if (settings_.format == LogFormat::kRecording ||
        (settings_.format == LogFormat::kAuto && is_recording)) {
      return open_recording();
    }
    while (trim(line_, is_blank).empty() || line_.front() == '#' || line_ == "overrun") {
      if (!next_line()) {
        return has_faults_ ? false : fail(0, tr("the file holds no samples, only comments"), "");
      }
    }
    switch (settings_.format == LogFormat::kAuto ? detect() : settings_.format) {
      case LogFormat::kHalsampler:
        return open_halsampler();
      case LogFormat::kCandump:
        return open_candump();
      default:
        return open_csv();
    }
  }

 private:
  bool fail(int column, std::string message, std::string hint) {
    Diagnostic diagnostic{Severity::kError,   name_, line_number(),  column,
                          std::move(message), {},    std::move(hint)};
    if (column > 0 && line_.size() <= kLongestHead) diagnostic.excerpt = line_;
    diagnostics_.push_back(std::move(diagnostic));
    has_faults_ = true;
    return false;
  }

  int line_number() const { return static_cast<int>(reader_.line_number()); }

  /// False at the end, and after a fault, which is then told.
  bool next_line() {
    if (is_unended_) return false;
    switch (reader_.next(line_, kAsLongAsItTakes)) {
      case LineReader::Got::kLine:
        log_.sum = crc32(crc32(log_.sum, line_), "\n");
        return true;
      case LineReader::Got::kUnended:
        is_unended_ = true;
        return true;
      case LineReader::Got::kTooLong:
        line_ = {};
        return fail(0,
                    trf("a line of more than {} bytes; this is no log that kerf reads",
                        LogSource::kLongestLine_bytes),
                    "");
      case LineReader::Got::kFault:
        line_ = {};
        return fail(0, trf("reading failed: {}", reader_.fault()), "");
      default:
        line_ = {};
        return false;
    }
  }

  bool is_text() {
    for (const Magic& magic : kMagics) {
      if (line_.starts_with(magic.bytes)) {
        line_ = {};
        return fail(0, trf("the file is {}, not text", tr(magic.what)), tr(magic.hint));
      }
    }
    const auto is_control = [](char c) {
      const auto byte = static_cast<unsigned char>(c);
      return byte < ' ' && c != '\t' && c != '\r';
    };
    if (std::any_of(line_.begin(), line_.end(), is_control)) {
      line_ = {};
      return fail(0, tr("the file is not text: there are control characters in its first line"),
                  tr("kerf reads its recordings, CSV, halsampler's output and candump -l or -L"));
    }
    return true;
  }

  LogFormat detect() const {
    if (!settings_.pins.empty()) return LogFormat::kHalsampler;
    const std::string_view text = trim(line_, is_blank);
    if (text.size() > 1 && text[0] == '(' && is_digit(text[1])) {
      return LogFormat::kCandump;
    }
    return is_row_of_numbers(line_) ? LogFormat::kHalsampler : LogFormat::kCsv;
  }

  void note_ignored(const LogColumns& columns, const char* what) {
    if (columns.ignored.empty()) return;
    std::string list;
    for (const std::string& name : columns.ignored) {
      list += fmt::format("{}{}", list.empty() ? "" : ", ", name);
    }
    notes_.push_back({Severity::kNote, name_, 0, 0, trf("{} not read: {}", what, list), {}, {}});
  }

  bool read_header(const LogSettings& settings, char delimiter, LogColumns& columns) {
    std::vector<ColumnFault> faults;
    if (!find_columns(split_header(line_, delimiter), settings, columns, faults)) {
      for (ColumnFault& fault : faults) {
        fail(fault.column, std::move(fault.message), std::move(fault.hint));
      }
      return false;
    }
    if (!columns.has_time) {
      return fail(
          1, tr("none of the columns is a time"),
          tr("allowed are t, time, timestamp, t_device and t_host; seconds, or with a unit: "
             "t_ms, \"t [us]\", t_ns"));
    }
    log_.contents.positions = columns.positions;
    log_.contents.kind = columns.kind;
    log_.contents.load = columns.load;
    note_ignored(columns, tr("columns"));
    return true;
  }

  bool open_csv() {
    log_.contents.format = LogFormat::kCsv;
    const char delimiter = find_delimiter(line_);
    LogColumns columns;
    if (!read_header(settings_, delimiter, columns)) return false;
    log_.lines = make_csv_lines(std::move(columns), delimiter);
    return true;
  }

  bool open_recording() {
    log_.contents.format = LogFormat::kRecording;
    if (is_unended_) return fail(0, tr("the recording is cut off in its head"), "");
    if (line_ != kRecordingMagic) {
      return fail(1, trf("the first line has to be '{}'", kRecordingMagic),
                  tr("this version of kerf reads kerf-recording/1 alone"));
    }
    RecordingHead head;
    bool has_coordinates = false;
    while (true) {
      if (!next_line() || is_unended_) {
        return has_faults_ ? false : fail(0, tr("the recording is cut off in its head"), "");
      }
      if (!line_.starts_with('#')) break;
      if (!read_recording_head_line(line_, head)) {
        return fail(1, tr("this is no line of a recording's head, or its value is not allowed"),
                    tr("units: mm; coordinates: joints or axes, machine or workpiece; start: "
                       "2026-03-01T09:30:00.000000000Z"));
      }
      has_coordinates |= line_.starts_with("# coordinates: ");
    }
    if (settings_.load) {
      return fail(
          0, tr("source.map.load is for CSV and halsampler; a recording has its load itself"), "");
    }
    LogColumns columns;
    if (!read_header(LogSettings{}, ',', columns)) return false;
    if (!has_coordinates) return fail(0, tr("the head has no line '# coordinates: '"), "");
    if (columns.kind != head.kind) {
      return fail(1,
                  trf("the columns are {}, but the head says {}",
                      columns.kind == CoordinateKind::kJoints ? "joints" : "axes",
                      head.kind == CoordinateKind::kJoints ? "joints" : "axes"),
                  "");
    }
    if (head.sums && !is_head_whole()) return false;
    head.axes = columns.positions;
    head.load = columns.load;
    log_.contents.recording = std::move(head);
    log_.lines = make_recording_lines(std::move(columns));
    return true;
  }

  /// The line behind the header row is the sum of all up to there.
  bool is_head_whole() {
    const std::uint32_t sum = std::exchange(log_.sum, 0);
    std::uint32_t found = 0;
    if (!next_line() || is_unended_) {
      return has_faults_ ? false : fail(0, tr("the recording is cut off in its head"), "");
    }
    log_.sum = 0;
    if (parse_recording_sum(line_, found) && found == sum) return true;
    return fail(1, tr("the recording's head is damaged: its sum is wrong"),
                tr("what the positions are is not certain; kerf reads the file without the line "
                   "'# sums: crc32', and checks nothing then"));
  }

  void keep_line() {
    log_.first_line = line_;
    log_.has_first_line = true;
    log_.is_first_unended = is_unended_;
  }

  bool open_halsampler() {
    log_.contents.format = LogFormat::kHalsampler;
    if (settings_.pins.empty()) {
      return fail(1, tr("these are halsampler's numbers, and which pins they are is not said"),
                  tr("source.pins: the HAL pins in the order of the columns, or source.pins_from: "
                     "the .hal file with the sampler's net lines"));
    }
    std::vector<ColumnName> names;
    for (const std::string& pin : settings_.pins) names.push_back({pin, 0});
    LogColumns columns;
    std::vector<ColumnFault> faults;
    if (!find_columns(names, settings_, columns, faults)) {
      for (const ColumnFault& fault : faults) {
        diagnostics_.push_back(
            {Severity::kError, {}, 0, 0, tr("source.pins: ") + fault.message, {}, fault.hint});
      }
      return false;
    }
    for (LogColumn& column : columns.columns) {
      // Times are the sample numbers; a pin that is called "time" is some component's.
      if (column.role == ColumnRole::kHostTime || column.role == ColumnRole::kDeviceTime) {
        column.role = ColumnRole::kIgnored;
      }
    }
    const std::size_t words = count_words(line_);
    const std::size_t pins = names.size();
    if (words != pins && words != pins + 1) {
      return fail(1,
                  trf("{} values found; {} pins are given, so {} are allowed, or {} with "
                      "the sample number of halsampler -t",
                      words, pins, pins, pins + 1),
                  tr("source.pins must name every pin of the sampler, in its order"));
    }
    log_.contents.positions = columns.positions;
    log_.contents.kind = columns.kind;
    log_.contents.load = columns.load;
    note_ignored(columns, tr("pins"));
    log_.lines = make_halsampler_lines(std::move(columns), words == pins + 1, settings_.period_s);
    keep_line();
    return true;
  }

  bool open_candump() {
    log_.contents.format = LogFormat::kCandump;
    CandumpLine line;
    CandumpFault fault;
    if (!is_unended_ && !read_candump_line(line_, line, fault)) {
      const bool is_screen = line_.find("   [") != std::string_view::npos ||
                             line_.find("  [") != std::string_view::npos;
      return fail(fault.column, fault.text,
                  is_screen
                      ? tr("this is what candump shows on the screen; candump -l writes a log, "
                           "candump -L shows one")
                      : "");
    }
    if (!settings_.can_map) {
      return fail(1, tr("this is a log of candump, and what its frames mean is not said"),
                  tr("source.map: the id, byte and type of each position"));
    }
    for (std::size_t i = 0; i < kMaxPositions; ++i) {
      if (!settings_.can_map->axes[i]) continue;
      log_.contents.positions = static_cast<std::uint16_t>(log_.contents.positions | 1U << i);
    }
    if (settings_.can_map->load) log_.contents.load = settings_.can_map->load_unit;
    log_.lines = make_candump_lines(settings_);
    keep_line();
    return true;
  }

  LineReader& reader_;
  const std::string& name_;
  const LogSettings& settings_;
  OpenedLog& log_;
  Diagnostics& notes_;
  Diagnostics& diagnostics_;
  std::string_view line_;
  bool is_unended_ = false;
  bool has_faults_ = false;
};

}  // namespace

bool open_log(LineReader& reader, const std::string& name, const LogSettings& settings,
              OpenedLog& log, Diagnostics& notes, Diagnostics& diagnostics) {
  return Opening(reader, name, settings, log, notes, diagnostics).run();
}

}  // namespace kerf
