#include "machine_io/hal/hal_source.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

#include "base/translate.h"
#include "base/units.h"
#include "machine_io/hal/hal_child.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

bool is_executable(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

std::string find_in_path(const std::string& name) {
  const char* folders = std::getenv("PATH");
  std::string_view rest = folders != nullptr ? folders : "/usr/bin";
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    const std::string path = fmt::format("{}/{}", rest.substr(0, colon), name);
    if (is_executable(path)) return path;
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
  return {};
}

/// Up to `deadline`, rounded up so that a poll does not return just before it.
int milliseconds_until(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 3'600'000));
}

HalStatusRecord record_of(const HalStatus& status) {
  HalStatusRecord record;
  record.bytes = sizeof(record);
  record.collision_seconds = status.collision_seconds;
  record.off_path_mm = status.off_path_mm;
  record.finding_line = status.finding_line;
  record.time_left_s = status.time_left_s;
  record.findings = status.findings;
  record.program_ok = status.program_ok ? 1 : 0;
  record.collision_ahead = status.collision_ahead ? 1 : 0;
  record.off_path = status.off_path ? 1 : 0;
  record.stale = status.stale ? 1 : 0;
  return record;
}

/// What halui has of the program. An MDI block runs, too, but not in automatic mode.
ProgramState program_of(const HalSampleRecord& record) {
  const auto known = [&](std::uint32_t bits) { return (record.known & bits) == bits; };
  const auto on = [&](HalBit bit) { return (record.on & bit) != 0; };
  if (!known(kHalProgramIdle | kHalProgramRunning)) return ProgramState::kUnknown;
  if (on(kHalProgramIdle) || (known(kHalModeAuto) && !on(kHalModeAuto))) return ProgramState::kIdle;
  if (known(kHalProgramPaused) && on(kHalProgramPaused)) return ProgramState::kPaused;
  return on(kHalProgramRunning) ? ProgramState::kRunning : ProgramState::kIdle;
}

AxisSample sample_of(const HalSampleRecord& record, const HalSettings& settings) {
  AxisSample sample;
  sample.host_ns = record.realtime_ns;
  sample.device_ns = record.monotonic_ns;
  for (std::size_t i = 0; i < kHalAxes; ++i) {
    if (!std::isfinite(record.joint[i])) continue;
    const bool rotary = (settings.rotary_joints >> i & 1U) != 0;
    sample.set(i, rotary ? record.joint[i] : record.joint[i] * settings.mm_per_unit);
  }
  if ((record.known & kHalToolNumber) != 0 && record.tool_number >= 0) {
    sample.tool = record.tool_number;
  }
  if ((record.known & kHalProgramLine) != 0 && record.program_line >= 0) {
    sample.line = record.program_line;
  }
  sample.program = program_of(record);
  // The lines of MDI blocks are those of no program.
  if (sample.program == ProgramState::kIdle && sample.line > 0) sample.line = 0;
  sample.tool_offset_z_mm = record.tool_offset[2] * settings.mm_per_unit;
  sample.spindle_rpm = record.spindle_rpm;
  if (settings.load) {
    const double load = record.load * settings.load->scale + settings.load->offset;
    if (std::abs(load) <= kMostLoad) sample.load = load;
    sample.load_unit = settings.load->unit;
  }
  return sample;
}

/// What kerf-hal says, in the language in use. What is not in its list stays as it is: HAL's own
/// words, and those of the system.
std::string in_language(std::string_view said) {
  for (int i = 0; i < static_cast<int>(HalMessage::kCount_); ++i) {
    const auto message = static_cast<HalMessage>(i);
    const HalTextParts parts = parts_of(message);
    if (!parts.has_detail && said == parts.before) return tr(text_of(message));
    const std::size_t around = parts.before.size() + parts.after.size();
    if (!parts.has_detail || said.size() < around || !said.starts_with(parts.before) ||
        !said.ends_with(parts.after)) {
      continue;
    }
    const std::string detail = in_language(said.substr(parts.before.size(), said.size() - around));
    return formatted(text_of(message), tr(text_of(message)), fmt::make_format_args(detail));
  }
  return std::string(said);
}

}  // namespace

std::vector<std::string> validate(const HalSettings& settings) {
  std::vector<std::string> faults;
  if (!(settings.rate_hz >= HalSettings::kLowestRate_hz &&
        settings.rate_hz <= HalSettings::kHighestRate_hz)) {
    faults.push_back(trf("source.rate_hz: {} found, {} to {} allowed (readings per second)",
                         settings.rate_hz, HalSettings::kLowestRate_hz,
                         HalSettings::kHighestRate_hz));
  }
  if (settings.mm_per_unit != 1.0 && settings.mm_per_unit != kMmPerInch) {
    faults.push_back(
        trf("source.mm_per_unit: {} found, 1 (mm) or 25.4 (inch) allowed", settings.mm_per_unit));
  }
  if (settings.rotary_joints >> kMaxPositions != 0) {
    faults.push_back(trf("source.rotary_joints: bits {:#x} found, joints 0 to {} allowed",
                         settings.rotary_joints, kMaxPositions - 1));
  }
  if (!settings.kerf_hal_path.empty() && find_kerf_hal(settings.kerf_hal_path).empty()) {
    faults.push_back(
        trf("source.kerf_hal_path: {} found, the path of an executable kerf-hal allowed",
            settings.kerf_hal_path));
  }
  return faults;
}

std::string find_hal_program(const std::string& name) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    for (const std::string& place : {name, "../lib/kerf/" + name}) {
      std::string path = (self.parent_path() / place).string();
      if (is_executable(path)) return path;
    }
  }
  return find_in_path(name);
}

std::string find_kerf_hal(const std::string& given) {
  if (given.empty()) return find_hal_program("kerf-hal");
  if (given.find('/') == std::string::npos) return find_in_path(given);
  return is_executable(given) ? given : std::string();
}

/// The source with the child it has at the moment, if any.
struct HalSource::Reading {
  explicit Reading(HalSettings with) : settings(std::move(with)) {}

  void wait_and_start(Clock::time_point deadline);
  void start_child();
  void wait_for_child(Clock::time_point deadline);
  void read_messages();
  bool has_record() const { return child && end - begin >= sizeof(HalSampleRecord); }
  bool take_record();
  void look_for_load();
  void fail(std::string reason);
  void end_child(std::string why, bool is_error);
  void child_has_ended();

  HalSettings settings;
  SourceStatus status;
  HalSampleRecord record;  ///< the last good one
  bool load_is_missing = false;

  std::optional<HalChild> child;
  bool child_has_spoken = false;  ///< at least one record
  bool ever_spoken = false;
  bool is_gone = false;  ///< LinuxCNC has ended since the last record
  Clock::time_point last_bytes;
  Clock::time_point retry_at;  ///< without a child
  milliseconds pause = kShortestPause;

  alignas(HalSampleRecord) std::array<char, 64 * sizeof(HalSampleRecord)> buffer{};
  std::size_t begin = 0;  ///< of the bytes in `buffer` that are not handed out yet
  std::size_t end = 0;
  bool has_messages = false;  ///< its stderr is still open
  std::string message;        ///< the line of kerf-hal's stderr that is not at its end
  std::string last_message;   ///< the last whole one, without "kerf-hal: "

  std::mutex showing;  ///< guards the two below
  HalStatus shown;
  bool is_shown_new = false;
};

void HalSource::Reading::wait_and_start(Clock::time_point deadline) {
  {
    const std::lock_guard lock(showing);
    is_shown_new = false;
  }
  if (Clock::now() < retry_at) poll(nullptr, 0, milliseconds_until(std::min(deadline, retry_at)));
  if (Clock::now() >= retry_at) start_child();
}

void HalSource::Reading::start_child() {
  const std::string path = find_kerf_hal(settings.kerf_hal_path);
  if (path.empty()) {
    return fail(settings.kerf_hal_path.empty()
                    ? tr("kerf-hal is not installed (it is built where linuxcnc-uspace-dev is)")
                    : trf("{} is no executable file", settings.kerf_hal_path));
  }
  std::vector<std::string> arguments{"--rate", fmt::format("{}", settings.rate_hz)};
  if (settings.load) {
    arguments.emplace_back("--load");
    arguments.push_back(settings.load->pin);
  }
  Result<HalChild> started = HalChild::start(path, arguments);
  if (!started) return fail(started.error());
  child = std::move(*started);
  child_has_spoken = false;
  begin = end = 0;
  has_messages = true;
  message.clear();
  last_message.clear();
  last_bytes = Clock::now();
}

void HalSource::Reading::fail(std::string reason) {
  child.reset();
  ++status.errors;
  status.state = SourceState::kFailed;
  status.trouble = std::move(reason);
}

void HalSource::Reading::end_child(std::string why, bool is_error) {
  child.reset();
  begin = end = 0;
  if (is_error) ++status.errors;
  status.state = SourceState::kConnecting;
  status.trouble = std::move(why);
  retry_at = Clock::now() + pause;
  pause = std::min(pause * 2, kLongestPause);
}

/// kerf-hal has closed its stdout: the reason is in its exit status and its last words.
void HalSource::Reading::child_has_ended() {
  const bool torn = end != begin;
  const HalChild::Exit exit = child->end();
  read_messages();
  if (torn) return end_child(tr("kerf-hal ended in the middle of a record"), true);
  if (exit.signal != 0) {
    return end_child(
        trf("kerf-hal was ended by signal {} ({})", exit.signal, strsignal(exit.signal)), true);
  }
  switch (exit.status) {
    case kHalExitAsked:
      is_gone = ever_spoken;
      return end_child(tr("LinuxCNC has ended (it asked kerf-hal to end)"), false);
    case kHalExitNoLinuxCnc:
      is_gone = ever_spoken;
      return end_child(last_message.empty() ? tr("no LinuxCNC runs") : last_message, false);
    case kHalExitUsage:
      return fail(
          trf("kerf-hal does not understand kerf ({}): both must be of one version", last_message));
    default:
      return end_child(
          last_message.empty() ? trf("kerf-hal ended with status {}", exit.status) : last_message,
          true);
  }
}

/// The last line is what a person wants to see.
void HalSource::Reading::read_messages() {
  constexpr std::size_t kLongestLine = 400;
  constexpr std::string_view kName = "kerf-hal: ";
  std::array<char, 4096> text{};
  const ssize_t got = read(child->messages_fd(), text.data(), text.size());
  if (got == 0) has_messages = false;
  for (ssize_t i = 0; i < got; ++i) {
    const char letter = text[static_cast<std::size_t>(i)];
    if (letter != '\n') {
      if (message.size() < kLongestLine) message.push_back(letter);
      continue;
    }
    const bool is_named = message.starts_with(kName);
    last_message = is_named ? in_language(std::string_view(message).substr(kName.size())) : message;
    status.trouble = last_message;
    message.clear();
  }
}

/// Sends what is to be shown, waits for bytes, reads them. Ends the child where it must.
void HalSource::Reading::wait_for_child(Clock::time_point deadline) {
  {
    const std::lock_guard lock(showing);
    if (is_shown_new) child->send(record_of(shown));
    is_shown_new = false;
  }
  const Clock::time_point silence_ends = last_bytes + kSilence;
  std::array<pollfd, 2> waits{
      {{child->records_fd(), POLLIN, 0}, {has_messages ? child->messages_fd() : -1, POLLIN, 0}}};
  if (poll(waits.data(), waits.size(), milliseconds_until(std::min(deadline, silence_ends))) < 0) {
    return;
  }
  if (waits[1].revents != 0) read_messages();
  if (waits[0].revents == 0) {
    if (Clock::now() >= silence_ends) {
      end_child(trf("kerf-hal has been silent for {} s", kSilence.count() / 1000), true);
    }
    return;
  }
  std::memmove(buffer.data(), buffer.data() + begin, end - begin);
  end -= begin;
  begin = 0;
  const ssize_t got = read(child->records_fd(), buffer.data() + end, buffer.size() - end);
  if (got > 0) {
    end += static_cast<std::size_t>(got);
    last_bytes = Clock::now();
  } else if (got == 0) {
    child_has_ended();
  }
}

/// The next whole record of the buffer into `record`. false: there is none.
bool HalSource::Reading::take_record() {
  if (!has_record()) return false;
  HalSampleRecord next;
  std::memcpy(&next, buffer.data() + begin, sizeof(next));
  begin += sizeof(next);
  if (const auto fault = head_fault(next)) {
    const char* const what = tr(text_of(*fault));
    if (next.magic == kHalSampleMagic) {
      fail(trf("kerf-hal sent {}: kerf and kerf-hal must be of one version", what));
    } else {
      end_child(trf("kerf-hal sent {}", what), true);
    }
    return false;
  }
  const std::uint64_t expected = child_has_spoken ? record.sequence + 1 : next.sequence;
  if (next.sequence < expected || (child_has_spoken && next.monotonic_ns < record.monotonic_ns)) {
    end_child(tr("kerf-hal sent a record older than the one before"), true);
    return false;
  }
  status.lost += next.sequence - expected;
  if (!child_has_spoken) {
    if (ever_spoken) ++status.reconnects;
    if ((next.on & kHalPinsTaken) == 0) status.trouble.clear();
    child_has_spoken = ever_spoken = true;
    status.state = SourceState::kReading;
    pause = kShortestPause;
  }
  ++status.samples;
  record = next;
  return true;
}

/// LinuxCNC itself has no such pin: a name that nobody has is a wrong one.
void HalSource::Reading::look_for_load() {
  if (!settings.load) return;
  const bool is_missing = std::isnan(record.load);
  if (is_missing == load_is_missing) return;
  load_is_missing = is_missing;
  status.trouble.clear();
  if (!is_missing) return;
  status.trouble =
      trf("HAL has no number under the name {} (source.map.load.pin)", settings.load->pin);
}

HalSource::HalSource(HalSettings settings)
    : reading_(std::make_unique<Reading>(std::move(settings))) {}

HalSource::~HalSource() = default;

PositionSource::Next HalSource::next(AxisSample& sample, milliseconds patience) {
  Reading& reading = *reading_;
  const Clock::time_point deadline = Clock::now() + patience;
  do {
    if (reading.status.state == SourceState::kFailed) return Next::kEnd;
    if (!reading.child) reading.wait_and_start(deadline);
    if (reading.child && !reading.has_record()) reading.wait_for_child(deadline);
    if (reading.take_record()) {
      sample = sample_of(reading.record, reading.settings);
      sample.restarted = std::exchange(reading.is_gone, false);
      reading.look_for_load();
      return Next::kSample;
    }
  } while (Clock::now() < deadline);
  return reading.status.state == SourceState::kFailed ? Next::kEnd : Next::kNothing;
}

const SourceStatus& HalSource::status() const { return reading_->status; }

std::string HalSource::describe() const {
  return trf("LinuxCNC's HAL at {} Hz", reading_->settings.rate_hz);
}

void HalSource::show(const HalStatus& status) {
  const std::lock_guard lock(reading_->showing);
  reading_->shown = status;
  reading_->is_shown_new = true;
}

const HalSampleRecord& HalSource::last_record() const { return reading_->record; }

}  // namespace kerf
