#include "machine_io/can/dbc_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <unordered_map>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr std::uint32_t kExtendedFlag = 0x80000000U;
constexpr std::uint32_t kNoMessageFlag = 0x40000000U;  // VECTOR__INDEPENDENT_SIG_MSG
constexpr std::uint64_t kLongestTransport = 1785;      // bytes; SAE J1939-21: 255 packets of 7
constexpr std::size_t kExcerptBytes = 200;
constexpr std::size_t kNamesInMessage = 6;

bool is_name_start(char c) { return is_letter(c) || c == '_'; }

std::string utf8_of_latin1(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      text += c;
    } else {
      text += static_cast<char>(0xC0U | byte >> 6U);
      text += static_cast<char>(0x80U | (byte & 0x3FU));
    }
  }
  return text;
}

/// Takes a line apart from left to right. After a failure, `expected` names what was not there.
struct LineCursor {
  std::string_view line;
  std::size_t at = 0;
  const char* expected = nullptr;

  void skip_blanks() {
    while (at < line.size() && is_blank(line[at])) ++at;
  }
  bool at_end() {
    skip_blanks();
    return at == line.size();
  }
  bool peek(char c) {
    skip_blanks();
    return at < line.size() && line[at] == c;
  }
  bool take(char c, const char* what) {
    if (!peek(c)) return expected = what, false;
    ++at;
    return true;
  }
  bool take_name(std::string_view& name, const char* what) {
    skip_blanks();
    std::size_t end = at;
    while (end < line.size() && (is_name_start(line[end]) || (end > at && is_digit(line[end]))))
      ++end;
    if (end == at || end - at > DbcFile::kMaxNameBytes) return expected = what, false;
    name = line.substr(at, end - at);
    at = end;
    return true;
  }
  bool take_count(std::uint64_t& value, const char* what) {
    skip_blanks();
    const char* const first = line.data() + at;
    const auto [end, fault] = std::from_chars(first, line.data() + line.size(), value);
    if (fault != std::errc{}) return expected = what, false;
    at += static_cast<std::size_t>(end - first);
    return true;
  }
  bool take_number(double& value, const char* what) {
    skip_blanks();
    const std::size_t begin = at + (at < line.size() && line[at] == '+' ? 1 : 0);
    const char* const first = line.data() + begin;
    const auto [end, fault] = std::from_chars(first, line.data() + line.size(), value);
    if (fault != std::errc{} || !std::isfinite(value)) return expected = what, false;
    at = begin + static_cast<std::size_t>(end - first);
    return true;
  }
};

struct SignalLine {
  std::string_view name;
  bool is_multiplexor = false;
  bool is_multiplexed = false;
  std::uint64_t mux_value = 0;
  std::uint64_t start = 0;
  std::uint64_t length = 0;
  std::uint64_t order = 0;
  bool is_signed = false;
  double scale = 1.0;
  double offset = 0.0;
  std::string_view unit;
};

bool take_mux(LineCursor& cursor, SignalLine& out) {
  if (cursor.peek(':')) return true;
  constexpr const char* kWhat = tr_noop("M, m and a number, or ':'");
  if (cursor.peek('m')) {
    ++cursor.at;
    out.is_multiplexed = true;
    if (cursor.at >= cursor.line.size() || !is_digit(cursor.line[cursor.at]) ||
        !cursor.take_count(out.mux_value, tr(kWhat))) {
      return cursor.expected = tr(kWhat), false;
    }
    if (cursor.at < cursor.line.size() && cursor.line[cursor.at] == 'M') {
      ++cursor.at;
      out.is_multiplexor = true;
    }
    return true;
  }
  out.is_multiplexor = true;
  return cursor.take('M', tr(kWhat));
}

/// What follows "SG_". Limits, unit and receivers may be missing.
bool take_signal(LineCursor& cursor, SignalLine& out) {
  if (!cursor.take_name(out.name, tr("the signal's name, at most 128 letters, digits and _")) ||
      !take_mux(cursor, out) || !cursor.take(':', "':'") ||
      !cursor.take_count(out.start, tr("the start bit")) || !cursor.take('|', "'|'") ||
      !cursor.take_count(out.length, tr("the length in bits")) || !cursor.take('@', "'@'") ||
      !cursor.take_count(out.order, tr("the byte order, 0 or 1"))) {
    return false;
  }
  out.is_signed = cursor.peek('-');
  if (!cursor.take(out.is_signed ? '-' : '+', "'+' or '-'") || !cursor.take('(', "'('") ||
      !cursor.take_number(out.scale, tr("the factor, a finite number")) ||
      !cursor.take(',', "','") ||
      !cursor.take_number(out.offset, tr("the offset, a finite number")) ||
      !cursor.take(')', "')'")) {
    return false;
  }
  if (cursor.peek('[')) {
    const std::size_t close = cursor.line.find(']', cursor.at);
    if (close == cursor.line.npos) return cursor.expected = "']'", false;
    cursor.at = close + 1;
  }
  if (cursor.peek('"')) {
    const std::size_t close = cursor.line.find('"', cursor.at + 1);
    if (close == cursor.line.npos)
      return cursor.expected = tr("the '\"' that ends the unit"), false;
    out.unit = cursor.line.substr(cursor.at + 1, close - cursor.at - 1);
  }
  return true;
}

}  // namespace

/// Reads one text into a DbcFile.
class DbcReader {
 public:
  DbcReader(std::string_view text, const std::string& path, Diagnostics& diagnostics)
      : text_(text), path_(path), diagnostics_(diagnostics), allowed_(kMaxDbcDiagnostics) {}

  DbcFile read();

 private:
  enum class In : std::uint8_t { kNothing, kMessage, kSkipped };

  bool next_line();
  void statement();
  void pass_over(std::size_t from);
  void message(LineCursor& cursor);
  void signal(LineCursor& cursor);
  void value_type(LineCursor& cursor);
  void end_message();
  void report(Severity severity, std::size_t column, std::string message, std::string hint = {});
  void report_expected(const LineCursor& cursor);
  static std::uint64_t message_key(std::uint32_t id, bool extended) {
    return std::uint64_t{id} | (extended ? std::uint64_t{1} << 32U : 0);
  }

  std::string_view text_;
  const std::string& path_;
  Diagnostics& diagnostics_;
  std::size_t allowed_;  // diagnostics that may still be added
  std::size_t next_ = 0;
  std::string_view line_;
  int number_ = 0;

  DbcFile file_;
  std::unordered_map<std::uint64_t, std::size_t> first_signal_;  // by message_key
  In in_ = In::kNothing;
  bool in_new_symbols_ = false;  // the NS_ section lists keywords, one a line
  std::string message_name_;
  int message_line_ = 0;
  std::uint32_t id_ = 0;
  bool extended_ = false;
  int bytes_ = 0;
  std::vector<SignalLine> mux_of_;  // for each signal of the message
};

void DbcReader::report(Severity severity, std::size_t column, std::string message,
                       std::string hint) {
  if (allowed_ == 0) return;
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  diagnostic.file = path_;
  diagnostic.line = number_;
  diagnostic.column = column < kExcerptBytes ? static_cast<int>(column) + 1 : 0;
  diagnostic.message = std::move(message);
  for (const char c : line_.substr(0, kExcerptBytes)) {
    diagnostic.excerpt += static_cast<unsigned char>(c) < 0x80 ? c : '?';
  }
  diagnostic.hint = std::move(hint);
  if (--allowed_ == 0) {
    diagnostic = {};
    diagnostic.file = path_;
    diagnostic.line = number_;
    diagnostic.message = trf("{} faults; the rest is not read", kMaxDbcDiagnostics - 1);
    diagnostic.hint = tr("is it a DBC file?");
    next_ = text_.size();
  }
  diagnostics_.push_back(std::move(diagnostic));
}

void DbcReader::report_expected(const LineCursor& cursor) {
  report(Severity::kError, cursor.at, trf("{} is missing here", cursor.expected));
}

bool DbcReader::next_line() {
  if (next_ >= text_.size()) return false;
  const std::size_t end = text_.find('\n', next_);
  line_ = text_.substr(next_, end == text_.npos ? text_.npos : end - next_);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  next_ = end == text_.npos ? text_.size() : end + 1;
  ++number_;
  return true;
}

/// Goes over the rest of a statement that is not needed. Its texts may hold line ends, and behind
/// them what looks like statements.
void DbcReader::pass_over(std::size_t from) {
  bool in_text = false;
  const std::string_view first_line = line_;
  const int first_number = number_;
  std::size_t opened = 0;
  for (std::size_t at = from;;) {
    for (; at < line_.size(); ++at) {
      if (in_text && line_[at] == '\\' && at + 1 < line_.size() && line_[at + 1] == '"') {
        ++at;
      } else if (line_[at] == '"') {
        in_text = !in_text;
        opened = at;
      }
    }
    if (!in_text) return;
    if (!next_line()) break;
    at = 0;
  }
  line_ = first_line;
  number_ = first_number;
  report(Severity::kError, opened, tr("a text begins in this statement and never ends"));
}

void DbcReader::statement() {
  LineCursor cursor{line_};
  std::string_view keyword;
  if (cursor.at_end()) return;
  if (!cursor.take_name(keyword, "")) {
    pass_over(0);
    return;
  }
  if (keyword == "SG_") {
    signal(cursor);
    return;
  }
  if (keyword == "NS_") in_new_symbols_ = true;
  if (keyword == "BO_" || keyword == "BS_" || keyword == "BU_") in_new_symbols_ = false;
  if (in_new_symbols_) return;
  if (in_ != In::kNothing) end_message();
  if (keyword == "BO_") {
    message(cursor);
  } else if (keyword == "SIG_VALTYPE_") {
    value_type(cursor);
  } else {
    pass_over(cursor.at);
  }
}

void DbcReader::message(LineCursor& cursor) {
  in_ = In::kSkipped;
  std::uint64_t id = 0;
  std::string_view name;
  std::uint64_t bytes = 0;
  const auto id_column = [&] { return line_.find_first_of("0123456789"); };
  if (!cursor.take_count(id, tr("the message's id, a decimal number")) ||
      !cursor.take_name(name, tr("the message's name, at most 128 letters, digits and _")) ||
      !cursor.take(':', "':'")) {
    report_expected(cursor);
    return;
  }
  cursor.skip_blanks();
  const std::size_t bytes_column = cursor.at;
  if (!cursor.take_count(bytes, tr("the message's length in bytes"))) {
    report_expected(cursor);
    return;
  }
  if (id == (kExtendedFlag | kNoMessageFlag)) return;
  extended_ = (id & kExtendedFlag) != 0;
  const std::uint64_t plain_id = extended_ ? id & ~std::uint64_t{kExtendedFlag} : id;
  if (plain_id > (extended_ ? kMaxExtendedCanId : kMaxStandardCanId)) {
    report(Severity::kError, id_column(),
           trf("{} is no message id; allowed are 0 to {}, and {} to {} for extended ones", id,
               kMaxStandardCanId, kExtendedFlag, kExtendedFlag | kMaxExtendedCanId));
    return;
  }
  id_ = static_cast<std::uint32_t>(plain_id);
  if (bytes > kMaxCanBytes) {
    const bool possible = bytes <= kLongestTransport;
    report(possible ? Severity::kWarning : Severity::kError, bytes_column,
           trf("a message of {} bytes; a frame has at most {}: its signals are left out", bytes,
               kMaxCanBytes));
    return;
  }
  if (!first_signal_.emplace(message_key(id_, extended_), file_.signals_.size()).second) {
    report(Severity::kError, id_column(),
           trf("a second message with the id {}; the first one counts", id));
    return;
  }
  in_ = In::kMessage;
  message_name_ = name;
  message_line_ = number_;
  bytes_ = static_cast<int>(bytes);
}

void DbcReader::signal(LineCursor& cursor) {
  if (in_ == In::kSkipped) return;
  if (in_ == In::kNothing) {
    report(Severity::kError, line_.find('S'), tr("a signal outside of a message"));
    return;
  }
  SignalLine parts;
  if (!take_signal(cursor, parts)) {
    report_expected(cursor);
    return;
  }
  const std::size_t column = static_cast<std::size_t>(parts.name.data() - line_.data());
  if (parts.order > 1) {
    report(Severity::kError, column,
           trf("byte order {} of {}; allowed are 1 (little-endian) and 0 (big-endian)", parts.order,
               parts.name));
    return;
  }
  CanBits bits;
  bits.endian = parts.order == 1 ? CanEndian::kLittle : CanEndian::kBig;
  bits.start_bit = static_cast<int>(std::min<std::uint64_t>(parts.start, kMaxCanBytes * 8));
  bits.length = static_cast<int>(std::min<std::uint64_t>(parts.length, 65));
  if (bits.length < 1 || bits.length > 64) {
    report(Severity::kError, column,
           trf("{} has {} bits; allowed are 1 to 64", parts.name, parts.length));
    return;
  }
  if (!can_bits_fit(bits, bytes_)) {
    report(Severity::kError, column,
           trf("{}: {} bits from bit {} on do not fit into the {} bytes of {}", parts.name,
               parts.length, parts.start, bytes_, message_name_));
    return;
  }
  if (file_.signals_.size() == DbcFile::kMaxSignals) {
    report(Severity::kError, column,
           trf("more than {} signals; the rest is not read", DbcFile::kMaxSignals));
    next_ = text_.size();
    return;
  }
  DbcSignal found;
  found.message = message_name_;
  found.name = parts.name;
  found.unit = utf8_of_latin1(parts.unit);
  found.line = number_;
  found.signal.id = id_;
  found.signal.extended = extended_;
  found.signal.bits = bits;
  found.signal.type = parts.is_signed ? CanType::kSigned : CanType::kUnsigned;
  found.signal.scale = parts.scale;
  found.signal.offset = parts.offset;
  file_.signals_.push_back(std::move(found));
  mux_of_.push_back(parts);
}

/// Gives the multiplexed signals of the message that ends here their multiplexor.
void DbcReader::end_message() {
  const In was = std::exchange(in_, In::kNothing);
  const std::vector<SignalLine> mux_of = std::exchange(mux_of_, {});
  if (was != In::kMessage || mux_of.empty()) return;
  const std::size_t first = file_.signals_.size() - mux_of.size();
  std::size_t multiplexors = 0;
  std::size_t multiplexed = 0;
  bool nested = false;
  CanBits mux_bits;
  for (std::size_t i = 0; i < mux_of.size(); ++i) {
    multiplexors += mux_of[i].is_multiplexor ? 1 : 0;
    multiplexed += mux_of[i].is_multiplexed ? 1 : 0;
    nested = nested || (mux_of[i].is_multiplexor && mux_of[i].is_multiplexed);
    if (mux_of[i].is_multiplexor) mux_bits = file_.signals_[first + i].signal.bits;
  }
  if (multiplexed == 0) return;
  const int number = std::exchange(number_, message_line_);
  const std::string_view line = std::exchange(line_, {});
  if (multiplexors == 0) {
    report(Severity::kError, kExcerptBytes,
           trf("{} has multiplexed signals (m0 ...) but no multiplexor (M)", message_name_));
  } else if (nested || multiplexors > 1) {
    report(Severity::kWarning, kExcerptBytes,
           trf("{}: extended multiplexing is not read; its multiplexed signals are left "
               "out",
               message_name_));
  }
  number_ = number;
  line_ = line;
  const bool usable = multiplexors == 1 && !nested;
  std::size_t kept = first;
  for (std::size_t i = 0; i < mux_of.size(); ++i) {
    if (mux_of[i].is_multiplexed) {
      if (!usable) continue;
      file_.signals_[first + i].signal.mux = CanMux{mux_bits, mux_of[i].mux_value};
    }
    if (kept != first + i) file_.signals_[kept] = std::move(file_.signals_[first + i]);
    ++kept;
  }
  file_.signals_.resize(kept);
}

/// SIG_VALTYPE_ id name : type ;
void DbcReader::value_type(LineCursor& cursor) {
  std::uint64_t id = 0;
  std::string_view name;
  std::uint64_t type = 0;
  if (!cursor.take_count(id, tr("the message's id, a decimal number")) ||
      !cursor.take_name(name, tr("the signal's name"))) {
    report_expected(cursor);
    return;
  }
  const std::size_t column = static_cast<std::size_t>(name.data() - line_.data());
  if (cursor.peek(':')) ++cursor.at;  // older files have none
  if (!cursor.take_count(type, tr("the value type, 0 to 2"))) {
    report_expected(cursor);
    return;
  }
  if (type > 2) {
    report(
        Severity::kError, column,
        trf("value type {} of {}; allowed are 0 (integer), 1 (float32), 2 (float64)", type, name));
    return;
  }
  const bool extended = (id & kExtendedFlag) != 0;
  const auto plain_id = static_cast<std::uint32_t>(id & ~std::uint64_t{kExtendedFlag});
  const auto message = first_signal_.find(message_key(plain_id, extended));
  if (message == first_signal_.end()) return;  // a message that was left out
  for (std::size_t i = message->second; i < file_.signals_.size(); ++i) {
    DbcSignal& candidate = file_.signals_[i];
    if (candidate.signal.id != plain_id || candidate.signal.extended != extended) break;
    if (candidate.name != name || type == 0) continue;
    const int length = type == 1 ? 32 : 64;
    if (candidate.signal.bits.length != length) {
      report(Severity::kError, column,
             trf("{} is a float{} of {} bits", name, length, candidate.signal.bits.length));
      return;
    }
    candidate.signal.type = type == 1 ? CanType::kFloat32 : CanType::kFloat64;
  }
}

DbcFile DbcReader::read() {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  file_.path_ = path_;
  if (text_.size() > DbcFile::kMaxFileBytes) {
    report(Severity::kError, kExcerptBytes,
           trf("more than {} MiB, which no DBC file has", DbcFile::kMaxFileBytes >> 20U));
    return std::move(file_);
  }
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
  while (next_line()) statement();
  end_message();
  return std::move(file_);
}

DbcFile parse_dbc(std::string_view text, const std::string& path, Diagnostics& diagnostics) {
  return DbcReader(text, path, diagnostics).read();
}

DbcFile read_dbc_file(const std::string& path, Diagnostics& diagnostics) {
  std::string text;
  std::ifstream in(path, std::ios::binary);
  std::array<char, 65536> piece;
  while (in && text.size() <= DbcFile::kMaxFileBytes) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (!in.is_open() || in.bad()) {
    Diagnostic diagnostic;
    diagnostic.file = path;
    diagnostic.message = tr("the DBC file cannot be read");
    diagnostics.push_back(std::move(diagnostic));
    return {};
  }
  return parse_dbc(text, path, diagnostics);
}

Result<DbcSignal> DbcFile::find(std::string_view name) const {
  const std::size_t dot = name.find('.');
  const std::string_view message = dot == name.npos ? std::string_view{} : name.substr(0, dot);
  const std::string_view signal = dot == name.npos ? name : name.substr(dot + 1);
  std::vector<const DbcSignal*> found;
  std::vector<std::string> near;
  for (const DbcSignal& candidate : signals_) {
    const bool same_message = dot == name.npos || candidate.message == message;
    if (same_message && candidate.name == signal) found.push_back(&candidate);
    if ((dot != name.npos && candidate.message == message) || candidate.name == signal) {
      near.push_back(candidate.message + "." + candidate.name);
    }
  }
  if (found.size() == 1) return *found.front();
  const std::size_t listed = std::min(near.size(), kNamesInMessage);
  const std::string names = fmt::format(
      "{}{}", fmt::join(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(listed), ", "),
      near.size() > listed ? trf(" and {} more", near.size() - listed) : "");
  if (found.size() > 1) {
    return Error{trf("{}: {} signals are called {}: {}{}", path_, found.size(), name, names,
                     dot == name.npos ? tr("; write Message.Signal") : "")};
  }
  return Error{trf("{}: no signal is called {}; there {}", path_, name,
                   near.empty() ? trf("are {} others", signals_.size()) : trf("is {}", names))};
}

}  // namespace kerf
