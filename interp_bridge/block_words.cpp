#include "interp_bridge/block_words.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "base/newline_count.h"
#include "base/text_scan.h"
#include "interp_bridge/special_words.h"
#include "interp_bridge/word_scanner.h"

namespace kerf {
namespace {

constexpr std::uint8_t kAllThree = 7;
constexpr std::uint32_t kFirstLine = 1;

/// G92.1 as 921; 0 for what is no code.
int code_of(const std::optional<double>& number) {
  return number && *number >= 0 && *number < 1000 ? static_cast<int>(std::lround(*number * 10)) : 0;
}

struct Codes {
  bool g10 = false;
  int l = -1;
  int p = 0;
};

void take_g(int code, BlockWords& words, Codes& codes) {
  switch (code) {
    case 0:
      words.speed = BlockWords::Speed::kRapid;
      break;
    case 10:
    case 20:
    case 30:
      words.speed = BlockWords::Speed::kFeed;
      break;
    case 100:
      codes.g10 = true;
      break;
    case 280:
    case 300:
      words.place = BlockWords::Place::kReference;
      words.second_reference = code == 300;
      break;
    case 281:
      words.store = BlockWords::Store::kFirst;
      break;
    case 301:
      words.store = BlockWords::Store::kSecond;
      break;
    case 520:
      words.offset = BlockWords::Offset::kLocal;
      break;
    case 530:
      words.place = BlockWords::Place::kMachine;
      break;
    case 920:
      words.offset = BlockWords::Offset::kShift;
      break;
    case 921:
      words.offset = BlockWords::Offset::kUnshift;
      break;
    case 922:
      words.offset = BlockWords::Offset::kSuspend;
      break;
    case 923:
      words.offset = BlockWords::Offset::kReshift;
      break;
    default:
      break;
  }
}

bool is_special(const BlockWords& words) {
  return words.place != BlockWords::Place::kProgram || words.offset != BlockWords::Offset::kNone ||
         words.store != BlockWords::Store::kNone;
}

/// Whether such a block calls others: M98, O.. CALL.
bool calls(std::string_view line) {
  for (std::size_t i = 0; i + 3 < line.size(); ++i) {
    const char c = to_lower(line[i]);
    if (c == 'c' && to_lower(line[i + 1]) == 'a' && to_lower(line[i + 2]) == 'l' &&
        to_lower(line[i + 3]) == 'l') {
      return true;
    }
    if (c == 'm' && line[i + 1] == '9' && line[i + 2] == '8') return true;
  }
  return false;
}

}  // namespace

BlockWords words_of_block(std::string_view line) {
  BlockWords words;
  Codes codes;
  WordScanner scanner(line);
  char letter = 0;
  std::optional<double> number;
  while (scanner.next(letter, number)) {
    switch (letter) {
      case 'o':
        return {};
      case 'x':
      case 'y':
      case 'z':
        words.named = static_cast<std::uint8_t>(words.named | 1U << (letter - 'x'));
        if (!number) {
          words.computed = static_cast<std::uint8_t>(words.computed | 1U << (letter - 'x'));
        }
        if (letter == 'z') words.z = number.value_or(0);
        break;
      case '@':
      case '^':
        words.named |= 3;
        break;
      case 'g':
        if (number) take_g(*number == 0 ? 0 : std::max(code_of(number), 1), words, codes);
        break;
      case 'm':
        if (code_of(number) == 60 && words.place == BlockWords::Place::kProgram) {
          words.place = BlockWords::Place::kToolChange;
        }
        break;
      case 'l':
        codes.l = code_of(number);
        break;
      case 'p':
        codes.p = number && *number >= 0 && *number < 100 ? static_cast<int>(*number) : -1;
        break;
      default:
        break;
    }
  }
  if (codes.g10 && codes.l == 20) words.offset = BlockWords::Offset::kMachine;
  if (codes.g10 && codes.l == 200) words.offset = BlockWords::Offset::kTouchOff;
  if (codes.g10) words.system = codes.p;
  return words;
}

bool may_store(std::string_view line) {
  // G10 has an L, the others have a point.
  const bool told = line.find_first_of(".lL") != line.npos;
  return told && may_be_special(line);
}

bool stores(const BlockWords& words) {
  return words.store != BlockWords::Store::kNone || words.offset == BlockWords::Offset::kMachine ||
         words.offset == BlockWords::Offset::kTouchOff;
}

/// What is known of one file, and where it was read last.
struct BlockReader::File {
  std::string path;
  bool readable = false;
  std::uint8_t named = 0;
  std::vector<std::uint32_t> special;  ///< lines, rising
  // The line that was asked for last, and the piece of the file that it stands in.
  std::unique_ptr<TextPieces> pieces;
  std::string_view piece;
  std::uint32_t piece_line = 0;  ///< of its first line
  std::size_t at = 0;            ///< in the piece: where line `line` begins
  std::uint32_t line = 0;

  void look_through();
  void look_through(std::string_view text);
  void look_at(std::string_view text);
  void rewind();
  bool find(std::uint32_t wanted, std::string_view& text);
};

void BlockReader::File::look_at(std::string_view text) {
  if (text.empty()) return;
  if (named == kAllThree && !may_be_special(text)) return;
  const BlockWords words = words_of_block(text);
  named |= words.named;
  if (named != kAllThree && calls(text)) named = kAllThree;
  if (is_special(words)) special.push_back(line);
}

void BlockReader::File::look_through() {
  TextPieces whole(path);
  std::string_view text;
  line = kFirstLine;
  while (whole.next(text)) look_through(text);
  readable = whole.error().empty();
  if (!readable) named = kAllThree;
  line = 0;
}

/// From one line that may tell something to the next, once the axes that it names are known.
void BlockReader::File::look_through(std::string_view text) {
  while (!text.empty()) {
    if (named == kAllThree) {
      const std::size_t found = find_special(text);
      if (found == text.npos) {
        line += static_cast<std::uint32_t>(newline_count(text));
        return;
      }
      const std::size_t before = text.substr(0, found).rfind('\n');
      const std::size_t begin = before == text.npos ? 0 : before + 1;
      line += static_cast<std::uint32_t>(newline_count(text.substr(0, begin)));
      text.remove_prefix(begin);
    }
    look_at(take_line(text));
    ++line;
  }
}

void BlockReader::File::rewind() {
  pieces = std::make_unique<TextPieces>(path);
  piece = {};
  piece_line = line = kFirstLine;
  at = 0;
}

bool BlockReader::File::find(std::uint32_t wanted, std::string_view& text) {
  if (!pieces || wanted < piece_line) rewind();
  if (wanted < line) {
    line = piece_line;
    at = 0;
  }
  for (;;) {
    while (at < piece.size()) {
      const std::size_t end = std::min(piece.find('\n', at), piece.size());
      if (line == wanted) {
        text = piece.substr(at, end - at);
        return true;
      }
      at = end + 1;
      ++line;
    }
    if (!pieces->next(piece)) {
      pieces.reset();
      return false;
    }
    piece_line = line;
    at = 0;
  }
}

BlockReader::File& BlockReader::file(std::size_t index, const std::string& path) {
  if (index >= files_.size()) files_.resize(index + 1);
  std::shared_ptr<File>& found = files_[index];
  if (!found) {
    found = std::make_shared<File>();
    found->path = path;
    found->look_through();
  }
  return *found;
}

const BlockWords* BlockReader::at(SourceRef source, const std::vector<std::string>& files,
                                  std::uint8_t unplaced) {
  if (source.line == 0 || source.file >= files.size()) return nullptr;
  File& in = file(source.file, files[source.file]);
  if (!in.readable) return nullptr;
  words_ = {};
  if (unplaced == 0 && !std::binary_search(in.special.begin(), in.special.end(), source.line)) {
    return &words_;
  }
  std::string_view text;
  if (!in.find(source.line, text)) return nullptr;
  words_ = words_of_block(text);
  return &words_;
}

std::uint8_t BlockReader::named_in(const std::string& path) { return file(0, path).named; }

}  // namespace kerf
