// RTU answers carry no number that ties them to a question: after a timeout the answer to the last
// question can still arrive and pass for the answer to the next, and from then on every value is
// old (measured with libmodbus' own recovery and answers later than two timeouts). Hence, after any
// fault:
//
//     fault -> quiet line -> trial reads ------------------> trusted
//                  ^             |  |                           ^
//                  +--longer-----+  +-- as a whole -> quiet line
//                  ^                                     |
//                  +--bytes------------------------------+
//
// A line that has just been opened must be quiet once: somebody else may have asked.
// An answer says how many registers it holds. So the trials ask for fewer than the polls do, each
// for another number than the one before: three answers in a row, each with the number that was
// just asked for, are no old ones. (Old ones come as far apart as they were asked for, or all at
// once; and the numbers come round again only after kLeastNumbers or more.)
// Where a device refuses parts of what it is polled for, does not answer them, or the poll has too
// few registers, the trial asks for the whole. Then its answer may still be an old one, to question
// j. Then the answer to question j+1 comes as long after it as j+1 was asked after j: the second
// quiet time is the longest time between two questions since the fault, and one timeout more.
#include <fcntl.h>
#include <fmt/format.h>
#include <modbus.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>

#include "base/translate.h"
#include "machine_io/modbus/modbus_link.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;

/// Longest quiet time when nothing ever comes late. It keeps a line free that nobody answers on.
/// Longer only delays the recovery: where trials cannot be told apart, the quiet time behind the
/// first answer is this and two timeouts. (Shorter than a late answer is late, it is safe as well:
/// what counts is that it is longer than questions lie apart.)
constexpr milliseconds kLongestPause{500};
/// Of registers that trials can ask for.
constexpr int kLeastNumbers = 4;
constexpr int kMatches = 3;
/// Trials without an answer until one asks for the whole.
constexpr int kPartsUntilWhole = 3;
/// Longest quiet time for a device that was seen to answer late.
constexpr milliseconds kLongestLateness{10000};

bool is_exception(int error) { return error > MODBUS_ENOBASE && error <= MODBUS_ENOBASE + 11; }

/// Errors of libmodbus itself are about frames, timeouts about answers; all others about the line.
bool line_is_gone(int error) { return error < MODBUS_ENOBASE && error != ETIMEDOUT; }

class RtuLink final : public ModbusLink {
 public:
  explicit RtuLink(const ModbusSettings& settings)
      : ModbusLink(settings), quiet_(settings.timeout_ms) {}

  Answer read(const PollRead& read, std::uint16_t* words) override;
  Settling settle(SteadyClock::time_point deadline) override;

 private:
  enum class Phase { kTrusted, kQuietAtStart, kQuietBeforeTrial, kQuietAfterTrial };
  enum class Line { kQuiet, kDeadline, kBytes, kGone };

  modbus_t* create() const override;
  /// What a driver had buffered, or a master before us asked for, is not our answer.
  void opened() override {
    modbus_flush(context());
    asked_at_ = SteadyClock::now();
    trust();
    begin(Phase::kQuietAtStart);
  }
  void trust() {
    phase_ = Phase::kTrusted;
    quiet_ = timeout();
    longest_gap_ = milliseconds(0);
    heard_late_ = false;
  }
  std::string place() const override { return settings_.device; }

  Answer ask(const PollRead& read, std::uint16_t* words);
  Answer fall_out_of_step(const PollRead& read);
  void heard_bytes();
  void begin(Phase phase);
  Line listen(milliseconds quiet, SteadyClock::time_point deadline);
  bool try_out();
  Answer try_parts();
  Answer ask_trial(const PollRead& read);
  bool asks_parts() const { return !refuses_parts_ && trial_.count > kLeastNumbers; }
  bool discard();

  milliseconds timeout() const { return milliseconds(settings_.timeout_ms); }

  Phase phase_ = Phase::kTrusted;
  milliseconds quiet_;          ///< how long the line must be silent before a trial
  milliseconds longest_gap_{};  ///< between two questions since the fault
  bool heard_late_ = false;     ///< trouble() speaks of late bytes, which says more than a timeout
  SteadyClock::time_point asked_at_{};     ///< the last question
  SteadyClock::time_point quiet_since_{};  ///< last byte, or begin of the phase
  PollRead trial_{};                       ///< the read that failed
  bool refuses_parts_ = false;             ///< this device, of what it is polled for
  int part_ = 0;                           ///< registers that the last trial asked for
  int unanswered_ = 0;                     ///< trials in a row
  std::array<std::uint16_t, kMaxReadRegisters> trial_words_{};
};

modbus_t* RtuLink::create() const {
  modbus_t* made = modbus_new_rtu(settings_.device.c_str(), settings_.baud, settings_.parity,
                                  settings_.data_bits, settings_.stop_bits);
  if (made != nullptr) modbus_set_slave(made, settings_.unit);
  return made;
}

/// One question, with no thought for what happens after a fault.
ModbusLink::Answer RtuLink::ask(const PollRead& read, std::uint16_t* words) {
  int pending = 0;
  if (ioctl(descriptor(), FIONREAD, &pending) == 0 && pending > 0) {
    note(read, tr("bytes arrived without being asked for"));
    errno = EMBBADDATA;
    return Answer::kBroken;
  }
  asked_at_ = SteadyClock::now();
  const int got = read.table == ModbusTable::kHolding
                      ? modbus_read_registers(context(), read.address, read.count, words)
                      : modbus_read_input_registers(context(), read.address, read.count, words);
  const int error = errno;
  if (got == read.count) return Answer::kWords;
  if (is_exception(error)) return refused(read, error - MODBUS_ENOBASE);
  note_errno(read, error);
  errno = error;
  return Answer::kBroken;
}

ModbusLink::Answer RtuLink::read(const PollRead& read, std::uint16_t* words) {
  const Answer answer = ask(read, words);
  return answer == Answer::kBroken ? fall_out_of_step(read) : answer;
}

/// errno is that of the fault.
ModbusLink::Answer RtuLink::fall_out_of_step(const PollRead& read) {
  if (line_is_gone(errno)) {
    close();
  } else {
    begin(Phase::kQuietBeforeTrial);
    trial_ = read;
  }
  return Answer::kBroken;
}

void RtuLink::begin(Phase phase) {
  phase_ = phase;
  quiet_since_ = SteadyClock::now();
}

/// Bytes where there should be none: a late answer, or the rest of a frame.
void RtuLink::heard_bytes() {
  const auto late = std::chrono::ceil<milliseconds>(SteadyClock::now() - asked_at_);
  if (late > timeout()) {
    note(trf("{}: bytes arrive after timeout_ms {} has passed; is it too short?", settings_.device,
             settings_.timeout_ms));
    heard_late_ = true;
  }
  // After a trial they prove that the quiet time before it was too short.
  const milliseconds wanted = phase_ == Phase::kQuietAfterTrial ? std::max(late, 2 * quiet_) : late;
  quiet_ = std::max(quiet_, std::min(wanted, kLongestLateness));
  begin(phase_ == Phase::kQuietAtStart ? phase_ : Phase::kQuietBeforeTrial);
}

/// Throws away what has arrived. False: the line is gone.
bool RtuLink::discard() {
  std::array<std::uint8_t, 256> bytes;
  const ssize_t got = ::read(descriptor(), bytes.data(), bytes.size());
  return got > 0 || (got < 0 && (errno == EAGAIN || errno == EINTR));
}

/// Waits until the line has been silent for `quiet`.
RtuLink::Line RtuLink::listen(milliseconds quiet, SteadyClock::time_point deadline) {
  for (;;) {
    const SteadyClock::time_point quiet_at = quiet_since_ + quiet;
    const SteadyClock::time_point now = SteadyClock::now();
    // Rounded up: to wake before the time has come would be to spin.
    const auto wait = std::chrono::ceil<milliseconds>(
        std::max(std::min(quiet_at, deadline) - now, SteadyClock::duration{}));
    pollfd asked{descriptor(), POLLIN, 0};
    const int ready = ::poll(&asked, 1, static_cast<int>(wait.count()));
    if (ready > 0) return discard() ? Line::kBytes : Line::kGone;
    if (ready == 0 && SteadyClock::now() >= quiet_at) return Line::kQuiet;
    if (SteadyClock::now() >= deadline) return Line::kDeadline;
  }
}

/// Its words are not used.
ModbusLink::Answer RtuLink::ask_trial(const PollRead& read) {
  const auto gap = std::chrono::ceil<milliseconds>(SteadyClock::now() - asked_at_);
  longest_gap_ = std::max(longest_gap_, std::min(gap, kLongestLateness));
  return ask(read, trial_words_.data());
}

/// Reads of other numbers of registers, one after the other. kWords: every answer had its own.
ModbusLink::Answer RtuLink::try_parts() {
  for (int match = 0; match < kMatches; ++match) {
    part_ = part_ % (trial_.count - 1) + 1;
    PollRead part = trial_;
    part.count = part_;
    const Answer answer = ask_trial(part);
    if (answer != Answer::kWords) return answer;
  }
  return Answer::kWords;
}

/// A trial. False: the line is gone.
bool RtuLink::try_out() {
  const std::string before = trouble();
  const bool by_parts = asks_parts() && unanswered_ < kPartsUntilWhole;
  Answer answer = by_parts ? try_parts() : Answer::kBroken;
  if (by_parts && answer == Answer::kWords) {
    unanswered_ = 0;
    trust();
    return true;
  }
  if (by_parts && answer == Answer::kException) {
    // It is there. The whole tells whether it is in step.
    refuses_parts_ = true;
  }
  if (!by_parts || answer == Answer::kException) {
    // An exception shows as well as words that the device is there.
    answer = ask_trial(trial_);
    unanswered_ = 0;
  }
  const bool answered = answer != Answer::kBroken;
  if (!answered) {
    count_failure();
    if (line_is_gone(errno)) {
      close();
      return false;
    }
    if (by_parts) ++unanswered_;
    quiet_ = std::max(quiet_, std::min(2 * quiet_, kLongestPause));
  }
  begin(answered ? Phase::kQuietAfterTrial : Phase::kQuietBeforeTrial);
  if (heard_late_) note(before);
  return true;
}

ModbusLink::Settling RtuLink::settle(SteadyClock::time_point deadline) {
  while (phase_ != Phase::kTrusted) {
    const bool tried = phase_ == Phase::kQuietAfterTrial;
    const bool needs_trial = phase_ == Phase::kQuietBeforeTrial;
    switch (listen(tried ? longest_gap_ + timeout() : quiet_, deadline)) {
      case Line::kGone:
        note(trf("{}: the line is gone", settings_.device));
        close();
        return Settling::kBroken;
      case Line::kDeadline:
        return Settling::kWaiting;
      case Line::kBytes:
        heard_bytes();
        if (SteadyClock::now() >= deadline) return Settling::kWaiting;
        break;
      case Line::kQuiet:
        if (!needs_trial) {
          trust();
        } else if (!try_out()) {
          return Settling::kBroken;
        }
        break;
    }
  }
  return Settling::kSettled;
}

}  // namespace

std::unique_ptr<ModbusLink> make_rtu_link(const ModbusSettings& settings) {
  return std::make_unique<RtuLink>(settings);
}

}  // namespace kerf
