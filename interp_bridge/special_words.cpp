#include "interp_bridge/special_words.h"

#include <cstdint>
#include <cstring>

#include "base/text_scan.h"

namespace kerf {
namespace {

/// Sixteen neighbouring bytes; what is true of one is 255, else 0.
using Bytes = unsigned char __attribute__((vector_size(16)));
constexpr std::size_t kBytes = sizeof(Bytes);
/// So many bytes behind a letter tell whether it may begin a special word.
constexpr std::size_t kBehind = 4;

Bytes bytes_at(const char* p) {
  Bytes bytes;
  std::memcpy(&bytes, p, sizeof bytes);
  return bytes;
}

Bytes letters(Bytes c) {
  const Bytes from_a = (c | 0x20) - 'a';
  return Bytes(from_a < 26);
}
Bytes blanks(Bytes c) { return Bytes((c == ' ') | (c == '\t') | (c == '\r')); }
Bytes digits(Bytes c) { return Bytes(Bytes(c - '0') < 10); }
Bytes tens_digits(Bytes c) {
  return Bytes((c == '1') | (c == '2') | (c == '3') | (c == '5') | (c == '9'));
}

bool any(Bytes c) {
  std::uint64_t halves[2];
  std::memcpy(halves, &c, sizeof halves);
  return (halves[0] | halves[1]) != 0;
}

/// Letters that may begin a special word. Of the bytes behind them c1 is the next, and so on.
Bytes may_begin(const char* p) {
  const Bytes c0 = bytes_at(p) | 0x20;
  const Bytes begins = Bytes((c0 == 'g') | (c0 == 'm'));
  if (!any(begins)) return begins;
  const Bytes c1 = bytes_at(p + 1), c2 = bytes_at(p + 2);
  const Bytes c3 = bytes_at(p + 3), c4 = bytes_at(p + 4);
  const Bytes letter3 = letters(c3);
  // The number has ended there, and another word begins.
  const Bytes ends2 = letters(c2) | (blanks(c2) & letter3);
  const Bytes ends3 = letter3 | (blanks(c3) & letters(c4));
  const Bytes is_zero = Bytes(c1 == '0'), is_blank = blanks(c1);
  const Bytes g_goes_on =
      is_blank | (tens_digits(c1) & ~ends2) | (is_zero & ~(ends2 | (digits(c2) & ends3)));
  const Bytes m_goes_on = is_blank | is_zero | Bytes(c1 == '6');
  return (Bytes(c0 == 'g') & g_goes_on) | (Bytes(c0 == 'm') & m_goes_on);
}

std::size_t first_of(Bytes c) {
  std::size_t i = 0;
  while (c[i] == 0) ++i;
  return i;
}

}  // namespace

bool may_be_special(std::string_view line) {
  const char* const end = line.data() + line.size();
  for (const char* p = line.data(); p != end; ++p) {
    const char letter = to_lower(*p);
    if (letter != 'g' && letter != 'm') continue;
    const char* at = p + 1;
    while (at != end && (is_line_blank(*at) || *at == '0')) ++at;
    if (at == end) return false;
    if (letter == 'm') {
      if (*at == '6') return true;
      continue;
    }
    if (*at == '1' || *at == '2' || *at == '3' || *at == '5' || *at == '9') {
      ++at;
      while (at != end && is_line_blank(*at)) ++at;
      if (at != end && is_digit(*at)) return true;
    }
  }
  return false;
}

std::size_t find_special(std::string_view text) {
  std::size_t at = 0;
  for (; at + kBytes + kBehind <= text.size(); at += kBytes) {
    const Bytes found = may_begin(text.data() + at);
    if (any(found)) return at + first_of(found);
  }
  for (; at < text.size(); ++at) {
    const char letter = to_lower(text[at]);
    if (letter == 'g' || letter == 'm') return at;
  }
  return text.npos;
}

}  // namespace kerf
