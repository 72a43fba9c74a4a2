#include "interp_bridge/record_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "base/block_copy.h"
#include "base/translate.h"

namespace kerf {
namespace {

/// Holds several of the largest records (a spline of kMaxSplinePoints).
constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
constexpr std::size_t kMaxFiles = 100'000;
constexpr std::size_t kMaxCallers = 100;
constexpr std::size_t kMaxNotes = 100;

/// QtPlasmaC changes the material by M190, and says by an input that it has been changed.
constexpr double kMaterialCode = 190;
constexpr double kMaterialInput = 3;

double number_at(const char* payload, std::size_t index) {
  double value = 0;
  std::memcpy(&value, payload + 8 * index, sizeof value);
  return value;
}

/// A user M-code with the words that its block has: LinuxCNC hands over -1 for one that it has not.
std::string user_code_text(double number, double p, double q) {
  constexpr double kNotGiven = -1;
  std::string out = fmt::format("M{:g}", number);
  if (p != kNotGiven) out += fmt::format(" P{:g}", p);
  if (q != kNotGiven) out += fmt::format(" Q{:g}", q);
  return out;
}

/// Numbers that kerf-interp leaves out where they are zero.
std::uint8_t full_count(CanonicalName name, std::uint8_t count) {
  switch (name) {
    case CanonicalName::kStraightFeed:
    case CanonicalName::kStraightTraverse:
    case CanonicalName::kStraightProbe:
      return count > 6 ? std::uint8_t{9} : std::uint8_t{6};
    default:
      return count;
  }
}

/// Calls whose argument is a text; all others have numbers or nothing.
constexpr bool carries_text(CanonicalName name) {
  switch (name) {
    case CanonicalName::kComment:
    case CanonicalName::kMessage:
    case CanonicalName::kLog:
    case CanonicalName::kLogOpen:
    case CanonicalName::kLogAppend:
    case CanonicalName::kCanonError:
      return true;
    default:
      return false;
  }
}

/// The tool's number, which a listing's line does not have.
bool tool_fits(const CanonicalCommand& command) {
  const bool changes = command.name == CanonicalName::kChangeTool ||
                       command.name == CanonicalName::kChangeToolNumber;
  if (!changes || command.argument_count < 2) return true;
  const double tool = command.number(1);
  return tool == std::floor(tool) && std::abs(tool) <= std::numeric_limits<std::int32_t>::max();
}

static_assert(kCanonicalNameCount <= records::kFile, "codes of calls and of other records meet");

}  // namespace

RecordReader::RecordReader(MotionFeeder& feeder, FileNames file_names, ProgramSummary& summary)
    : feeder_(feeder),
      file_names_(std::move(file_names)),
      summary_(summary),
      buffer_(kBufferBytes) {
  summary_.files.clear();
}

std::span<char> RecordReader::room() { return std::span<char>(buffer_).subspan(filled_); }

bool RecordReader::refuse(const char* what) {
  damage_ = what;
  return false;
}

bool RecordReader::received(std::size_t bytes) {
  filled_ += bytes;
  const char* at = buffer_.data();
  const char* const end = at + filled_;
  if (!begun_) {
    if (filled_ < sizeof records::kMagic) return true;
    if (std::memcmp(at, records::kMagic, sizeof records::kMagic) != 0) {
      return refuse(tr("it does not begin as the records of this version of kerf-interp do"));
    }
    begun_ = true;
    at += sizeof records::kMagic;
  }
  bool go_on = true;
  while (go_on && static_cast<std::size_t>(end - at) >= sizeof(records::Head)) {
    records::Head head;
    std::memcpy(&head, at, sizeof head);
    const std::size_t size = sizeof head + records::payload_bytes(head);
    if (static_cast<std::size_t>(end - at) < size) break;
    go_on = take(head, at + sizeof head);
    at += size;
  }
  filled_ = static_cast<std::size_t>(end - at);
  std::memmove(buffer_.data(), at, filled_);
  return go_on && feeder_.flush_if_old();
}

bool RecordReader::take(const records::Head& head, const char* payload) {
  if (ended_) return refuse(tr("records behind the last one"));
  if (records::is_text(head.code) && head.count > records::kMaxText) {
    return refuse(tr("a text too long"));
  }
  const std::uint8_t name = head.code & std::uint8_t{0x7f};
  if (name < kCanonicalNameCount) return take_command(head, payload);
  return take_special(head, payload);
}

bool RecordReader::take_command(const records::Head& head, const char* payload) {
  place_ = {file_, head.line};
  command_.name = static_cast<CanonicalName>(head.code & 0x7f);
  varies_ = varies_ || command_.name == CanonicalName::kStraightProbe;
  command_.argument_count = 0;
  command_.text = {};
  if (records::is_text(head.code) != carries_text(command_.name)) {
    return refuse(tr("a command of the wrong form"));
  }
  if (records::is_text(head.code)) {
    command_.text = {payload, head.count};
    // As a listing counts them: COMMENT("..") has one argument.
    command_.argument_count = 1;
    command_.arguments[0] = 0;
    return feeder_.take(command_, place_);
  }
  if (head.count > CanonicalCommand::kMaxArguments)
    return refuse(tr("a command with too many numbers"));
  const auto given = static_cast<std::uint8_t>(head.count);
  command_.argument_count = full_count(command_.name, given);
  copy_bytes(command_.arguments.data(), payload, std::size_t{8} * given);
  for (std::size_t i = given; i < command_.argument_count; ++i) command_.arguments[i] = 0;
  if (!canonical_arguments_fit(command_) || !tool_fits(command_)) {
    return refuse(tr("a command whose numbers do not fit"));
  }
  return feeder_.take(command_, place_);
}

bool RecordReader::take_special(const records::Head& head, const char* payload) {
  switch (head.code) {
    case records::kFile:
      return take_file(head, {payload, head.count});
    case records::kSpline:
      return take_spline(head, payload);
    case records::kRead:
      if (reads_.size() >= kMaxFiles) return refuse(tr("too many files"));
      reads_.push_back({std::string(payload, head.count), head.line != 0});
      return true;
    case records::kHidden:
      varies_ = true;
      return true;
    case records::kUserM:
      varies_ = true;
      if (head.count != 3) return refuse(tr("a user M-code whose numbers do not fit"));
      feeder_.take_wait();
      if (number_at(payload, 0) == kMaterialCode &&
          feeder_.take_material_change(number_at(payload, 1), {file_, head.line})) {
        place_ = {file_, head.line};
        return true;
      }
      if (feeder_.take_user_code(number_at(payload, 0), {file_, head.line})) {
        place_ = {file_, head.line};
        return !feeder_.done();
      }
      note(head,
           user_code_text(number_at(payload, 0), number_at(payload, 1), number_at(payload, 2)));
      return true;
    case records::kWait:
      if (head.count != 4) return refuse(tr("an M66 whose numbers do not fit"));
      if (feeder_.is_qtplasmac() && number_at(payload, 0) == kMaterialInput &&
          number_at(payload, 1) == records::kDigitalInput) {
        return true;  // the wait for M190, which is done
      }
      feeder_.take_wait();
      note(head, number_at(payload, 1) == records::kDigitalInput
                     ? trf("M66 of digital input {:g}", number_at(payload, 0))
                     : trf("M66 of analog input {:g}", number_at(payload, 0)));
      return true;
    case records::kRotary:
      return true;
    case records::kProbe:
      return take_probe(head, payload);
    case records::kAt:
      place_ = {file_, head.line};
      return true;
    case records::kMode:
      return take_mode(head, payload);
    case records::kHere:
      feeder_.take_here();
      return true;
    case records::kStore:
      feeder_.take_store({file_, head.line});
      return true;
    case records::kError:
      if (faults_.size() < kMaxNotes) faults_.emplace_back();
      faults_.back().place = place_ = {file_, head.line};
      faults_.back().message.assign(payload, head.count);
      return true;
    case records::kEcho:
      if (faults_.empty()) return refuse(tr("a block without its error"));
      faults_.back().echo.assign(payload, head.count);
      return true;
    case records::kCaller: {
      if (faults_.empty() || head.count != 1) return refuse(tr("a caller without an error"));
      const double file = number_at(payload, 0);
      if (!(file >= 0 && file < static_cast<double>(summary_.files.size()))) {
        return refuse(tr("a caller in an unknown file"));
      }
      if (faults_.back().callers.size() < kMaxCallers) {
        faults_.back().callers.push_back({static_cast<std::uint32_t>(file), head.line});
      }
      return true;
    }
    case records::kEnd:
      ended_ = true;
      came_to_end_ = head.count > 0 && number_at(payload, 0) == 1;
      return true;
    default:
      return refuse(tr("a record of unknown kind"));
  }
}

bool RecordReader::take_mode(const records::Head& head, const char* payload) {
  const double group = head.count == 3 ? number_at(payload, 0) : -1;
  const double begun = head.count == 3 ? number_at(payload, 1) : NAN;
  const double now = head.count == 3 ? number_at(payload, 2) : NAN;
  const bool fits = group == std::floor(group) && group >= 0 && group < kModeGroups &&
                    std::isfinite(begun) && std::isfinite(now);
  if (!fits) return refuse(tr("a mode whose numbers do not fit"));
  summary_.modes.resize(kModeGroups);
  summary_.modes[static_cast<std::size_t>(group)] = {begun, now, head.line};
  return true;
}

bool RecordReader::take_file(const records::Head& head, std::string_view name) {
  std::vector<std::string>& files = summary_.files;
  if (name.empty() ? head.line >= files.size() : head.line != files.size()) {
    return refuse(tr("a file out of order"));
  }
  if (files.size() >= kMaxFiles) return refuse(tr("too many files"));
  if (!name.empty()) files.push_back(file_names_(std::string(name)));
  file_ = head.line;
  return true;
}

bool RecordReader::take_spline(const records::Head& head, const char* payload) {
  place_ = {file_, head.line};
  if (head.count < 4 || head.count % 3 != 1) return refuse(tr("a spline whose numbers do not fit"));
  const double order = number_at(payload, 0);
  points_.clear();
  for (std::size_t i = 1; i < head.count; i += 3) {
    points_.push_back(
        {number_at(payload, i), number_at(payload, i + 1), number_at(payload, i + 2)});
  }
  const bool fits = order >= 0 && order <= static_cast<double>(points_.size());
  return feeder_.take_spline({fits ? static_cast<unsigned>(order) : 0U, points_}, place_);
}

bool RecordReader::take_probe(const records::Head& head, const char* payload) {
  constexpr std::uint16_t kNumbers = 10;
  if (!give_answer_ || head.count != kNumbers) return refuse(tr("a question that nobody expects"));
  varies_ = true;
  place_ = {file_, head.line};
  const double kind = number_at(payload, 0);
  command_.name = CanonicalName::kStraightProbe;
  command_.text = {};
  command_.argument_count = kNumbers - 1;
  std::memcpy(command_.arguments.data(), payload + sizeof(double),
              sizeof(double) * command_.argument_count);
  if (!(kind >= 0 && kind <= 3) || !canonical_arguments_fit(command_)) {
    return refuse(tr("a question whose numbers do not fit"));
  }
  ProbeAnswer answer;
  if (!feeder_.ask_probe(command_, kind >= 2, place_, answer)) return false;
  records::Answer out;
  out.share = answer.share;
  switch (answer.kind) {
    case ProbeAnswer::Kind::kUnknown:
      out.kind = records::Answer::kUnknown;
      break;
    case ProbeAnswer::Kind::kMet:
      out.kind = records::Answer::kMet;
      break;
    case ProbeAnswer::Kind::kMissed:
      out.kind = records::Answer::kMissed;
      break;
    case ProbeAnswer::Kind::kRefused:
      out.kind = records::Answer::kAlready;
      break;
  }
  // A child that does not take it has ended, which its pipes tell.
  give_answer_(out);
  return true;
}

/// Once for every text.
void RecordReader::note(const records::Head& head, std::string text) {
  place_ = {file_, head.line};
  for (ProgramNote& known : summary_.notes) {
    if (known.text != text) continue;
    ++known.count;
    return;
  }
  if (summary_.notes.size() < kMaxNotes) summary_.notes.push_back({place_, std::move(text), 1});
}

}  // namespace kerf
