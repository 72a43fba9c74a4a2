#include "twin/optimize/nc_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "base/text_scan.h"
#include "interp_bridge/source_text.h"
#include "interp_bridge/word_scanner.h"

namespace kerf {
namespace {

/// What stays in force from one line to the next.
struct Modes {
  bool inch = false, inverse_time = false, per_turn = false, synchronous = false;
  bool incremental = false, compensated = false;
  bool spaced = true, lower = false;
};

/// G33.1 as 331.
int tenths(const std::optional<double>& number) {
  return number && *number >= 0 && *number < 1000 ? static_cast<int>(std::lround(*number * 10))
                                                  : -1;
}

bool is_motion_code(int code) {
  return code <= 50 || code == 51 || code == 52 || (code >= 382 && code <= 385) ||
         (code >= 730 && code <= 890);
}

void take_code(int code, Modes& modes) {
  switch (code) {
    case 200:
      modes.inch = true;
      return;
    case 210:
      modes.inch = false;
      return;
    case 930:
    case 940:
    case 950:
      modes.inverse_time = code == 930;
      modes.per_turn = code == 950;
      return;
    case 900:
    case 910:
      modes.incremental = code == 910;
      return;
    case 400:
      modes.compensated = false;
      return;
    case 410:
    case 411:
    case 420:
    case 421:
      modes.compensated = true;
      return;
    case 330:
    case 331:
    case 740:
    case 760:
    case 840:
      modes.synchronous = true;
      return;
    default:
      // G4, G10 and G17 .. are of other groups.
      if (code >= 0 && code != 40 && is_motion_code(code)) modes.synchronous = false;
  }
}

NcLine line_of(std::string_view text, Modes& modes) {
  NcLine line;
  line.text = text;
  WordScanner scanner(text);
  char letter = 0;
  std::optional<double> number;
  bool plain = !trim(text, is_line_blank).starts_with('/');
  std::size_t words = 0, ends_before = 0;
  while (scanner.next(letter, number)) {
    if (letter == 'o') {
      line.is_control = true;
      plain = false;
      break;
    }
    const std::size_t at = scanner.word_at();
    if (words > 0) modes.spaced = at > ends_before;
    modes.lower = text[at] == letter && is_letter(letter);
    ++words;
    ends_before = line.words_end = scanner.word_end();
    const int code = tenths(number);
    if (letter == 'g') {
      take_code(code, modes);
      line.names_g1 = line.names_g1 || code == 10;
    }
    const bool is_fit = letter == 'n' || (letter == 'g' && code == 10) ||
                        (number && (letter == 'f' || (letter >= 'x' && letter <= 'z')));
    plain = plain && is_fit;
    if (letter != 'f') continue;
    line.feed = number ? NcLine::Feed::kNumber : NcLine::Feed::kComputed;
    line.feed_number = number.value_or(0);
    line.feed_at = scanner.value_at();
    line.feed_end = scanner.word_end();
  }
  line.is_spaced = modes.spaced;
  line.is_lower = modes.lower;
  line.is_inch = modes.inch;
  line.inverse_time = modes.inverse_time;
  line.per_turn = modes.per_turn;
  line.is_synchronous = modes.synchronous;
  line.is_plain_line =
      plain && words > 0 && !modes.incremental && !modes.compensated && text.find('#') == text.npos;
  return line;
}

}  // namespace

NcText::NcText(std::string text, bool inch)
    : text_(std::make_unique<const std::string>(std::move(text))) {
  Modes modes;
  modes.inch = inch;
  std::string_view rest = *text_;
  while (!rest.empty()) lines_.push_back(line_of(take_line(rest), modes));
}

Result<NcText> NcText::read(const std::string& path, bool inch) {
  TextPieces pieces(path);
  std::string whole;
  std::string_view piece;
  while (pieces.next(piece)) whole += piece;
  if (!pieces.error().empty()) return Error{pieces.error()};
  return NcText(std::move(whole), inch);
}

std::string NcText::with(const std::map<std::uint32_t, NcEdit>& edits) const {
  std::string out;
  out.reserve(text_->size() + 8 * edits.size());
  std::size_t copied = 0;
  const auto copy_to = [&](std::size_t end) {
    out.append(*text_, copied, end - copied);
    copied = end;
  };
  for (const auto& [number, edit] : edits) {
    if (number == 0 || number > lines_.size()) continue;
    const NcLine& line = lines_[number - 1];
    const auto begin = static_cast<std::size_t>(line.text.data() - text_->data());
    copy_to(begin);
    out += edit.before;
    if (edit.number.empty()) continue;
    if (line.feed == NcLine::Feed::kNumber) {
      copy_to(begin + line.feed_at);
      out += edit.number;
      copied = begin + line.feed_end;
    } else {
      copy_to(begin + line.words_end);
      if (line.is_spaced) out += ' ';
      out += line.is_lower ? 'f' : 'F';
      out += edit.number;
    }
  }
  copy_to(text_->size());
  return out;
}

std::string feed_text(double feed) {
  const double finest = std::pow(10, std::floor(std::log10(feed)) - 2);
  const double step = std::min(1.0, finest);
  // What is a whole number of steps but for its last bits stays that.
  const double steps = std::floor(feed / step * (1 + 1e-12));
  const int digits = std::max(0, static_cast<int>(std::lround(-std::log10(step))));
  std::string text = fmt::format("{:.{}f}", steps * step, digits);
  if (digits > 0) {
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

}  // namespace kerf
