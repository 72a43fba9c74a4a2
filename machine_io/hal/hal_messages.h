// machine_io/hal/hal_messages.h - what kerf-hal says on stderr. It has no catalogue: it speaks
// English, and kerf, which shows its words, looks them up here and says them in the language in use
// (in_language()). So every message of kerf-hal stands in this list.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kerf {

namespace hal_text {
/// base/translate.h has the same one, but brings fmt, which kerf-hal does not link.
constexpr const char* tr_noop(const char* text) { return text; }
}  // namespace hal_text

enum class HalMessage {
  kRateRange,
  kRateMissing,
  kLoadMissing,
  kUnknownArgument,
  kTerminal,
  kNoLinuxCnc,
  kForbidden,
  kNoJoints,
  kServoStill,
  kBadStatus,
  kPinsTaken,
  kNoComponent,
  kHalFull,
  kNoPin,
  kNoTimer,
  // of head_fault(), as the detail of kBadStatus
  kNoRecord,
  kOtherVersion,
  kOtherLength,
  kCount_
};

/// In English. A `{}` stands for a detail.
constexpr const char* text_of(HalMessage message) {
  using hal_text::tr_noop;
  switch (message) {
    case HalMessage::kRateRange:
      return tr_noop("--rate {}: a number of readings per second, 1 to 1000");
    case HalMessage::kRateMissing:
      return tr_noop("--rate: a number must follow");
    case HalMessage::kLoadMissing:
      return tr_noop("--load: the name of a pin must follow");
    case HalMessage::kUnknownArgument:
      return tr_noop("unknown argument {} (kerf-hal --help)");
    case HalMessage::kTerminal:
      return tr_noop("stdout is a terminal, the records are binary (kerf-hal --help)");
    case HalMessage::kNoLinuxCnc:
      return tr_noop("no LinuxCNC runs on this computer");
    case HalMessage::kForbidden:
      return tr_noop(
          "the running LinuxCNC belongs to another user: {}; run as the user who started it");
    case HalMessage::kNoJoints:
      return tr_noop("LinuxCNC has no joints (it is starting or ending)");
    case HalMessage::kServoStill:
      return tr_noop(
          "LinuxCNC's servo thread stands still (LinuxCNC was killed, or HAL is stopped)");
    case HalMessage::kBadStatus:
      return tr_noop("stdin holds {}; the pins kerf.* stay stale");
    case HalMessage::kPinsTaken:
      return tr_noop(
          "the pins kerf.* are those of another component (another kerf, or one that was killed "
          "and stays until LinuxCNC restarts): positions are read, findings are not shown");
    case HalMessage::kNoComponent:
      return tr_noop("HAL does not take the component {}");
    case HalMessage::kHalFull:
      return tr_noop("HAL's shared memory is full");
    case HalMessage::kNoPin:
      return tr_noop("HAL does not take a pin kerf.*: {}");
    case HalMessage::kNoTimer:
      return tr_noop("cannot open timer or signals: {}");
    case HalMessage::kNoRecord:
      return tr_noop("not a record (wrong first four bytes)");
    case HalMessage::kOtherVersion:
      return tr_noop("a record of another version");
    case HalMessage::kOtherLength:
      return tr_noop("a record of another length");
    case HalMessage::kCount_:
      break;
  }
  return "";
}

/// A text of text_of() around its detail.
struct HalTextParts {
  std::string_view before, after;
  bool has_detail = false;
};
constexpr HalTextParts parts_of(HalMessage message) {
  const std::string_view text = text_of(message);
  const std::size_t at = text.find("{}");
  if (at == text.npos) return {text, {}, false};
  return {text.substr(0, at), text.substr(at + 2), true};
}

/// In English, with the detail in its place: what kerf-hal writes.
inline std::string filled_in(HalMessage message, std::string_view detail = {}) {
  const HalTextParts parts = parts_of(message);
  std::string text(parts.before);
  if (parts.has_detail) text.append(detail).append(parts.after);
  return text;
}

}  // namespace kerf
