#include "viewer/window/letters.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cstdint>
#include <cstdlib>

#include "base/catalogue_file.h"
#include "base/small_file.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr std::size_t kMostCatalogue_bytes = 8'000'000;
constexpr std::size_t kLetters = 0x10000;
using LetterSet = std::bitset<kLetters>;

constexpr bool is_follower(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }
constexpr unsigned low_bits(char c, unsigned mask) { return static_cast<unsigned char>(c) & mask; }

/// Any bytes: a catalogue is texts with tables of numbers between them.
void add_letters(std::string_view text, LetterSet* letters) {
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    const char first = text[i];
    if (!is_follower(text[i + 1])) continue;
    if (low_bits(first, 0xE0) == 0xC0) {
      const unsigned letter = low_bits(first, 0x1F) << 6 | low_bits(text[i + 1], 0x3F);
      if (letter >= 0x80) letters->set(letter);
    } else if (low_bits(first, 0xF0) == 0xE0 && i + 2 < text.size() && is_follower(text[i + 2])) {
      const unsigned letter = low_bits(first, 0x0F) << 12 | low_bits(text[i + 1], 0x3F) << 6 |
                              low_bits(text[i + 2], 0x3F);
      if (letter >= 0x800) letters->set(letter);
    }
  }
}

std::vector<char16_t> listed(const LetterSet& letters) {
  std::vector<char16_t> out;
  for (std::size_t letter = 0; letter < kLetters; ++letter) {
    if (letters[letter]) out.push_back(static_cast<char16_t>(letter));
  }
  return out;
}

void add_catalogue(const std::string& language, LetterSet* letters) {
  const std::string path = catalogue_file(language);
  if (path.empty()) return;
  // One that cannot be read has no texts either: all is in English then.
  if (const Result<std::string> bytes = read_small_file(path, kMostCatalogue_bytes)) {
    add_letters(*bytes, letters);
  }
}

std::string value_or(const char* variable, const std::string& otherwise) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0' ? value : otherwise;
}

/// Where fonts may lie, the user's own first.
std::vector<std::string> font_folders() {
  std::vector<std::string> folders;
  const std::string home = value_or("HOME", "");
  const std::string own = value_or("XDG_DATA_HOME", home.empty() ? "" : home + "/.local/share");
  std::string rest = value_or("XDG_DATA_DIRS", "/usr/local/share:/usr/share");
  if (!own.empty()) rest = own + ":" + rest;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (end > 0) folders.push_back(rest.substr(0, end) + "/fonts/");
    rest.erase(0, end + 1);
  }
  return folders;
}

}  // namespace

std::vector<char16_t> letters_in(std::string_view text) {
  LetterSet letters;
  add_letters(text, &letters);
  return listed(letters);
}

std::vector<char16_t> letters_of(const std::string& language) {
  LetterSet letters;
  add_catalogue(language, &letters);
  for (const std::string& code : languages()) add_letters(name_of_language(code), &letters);
  return listed(letters);
}

bool is_east_asian(char16_t letter) {
  const bool is_ideograph = letter >= 0x2E80 && letter <= 0xA4CF;  // with kana and their signs
  const bool is_hangul = (letter >= 0xAC00 && letter <= 0xD7FF) || (letter >> 8 == 0x11);
  const bool is_wide = (letter >= 0xF900 && letter <= 0xFAFF) || letter >= 0xFF00;
  return is_ideograph || is_hangul || is_wide;
}

bool has_east_asian(const std::vector<char16_t>& letters) {
  return std::any_of(letters.begin(), letters.end(), is_east_asian);
}

std::optional<FontFace> east_asian_font() {
  // Below the folders of Debian, Fedora, Arch, and of a user who has put a file there. The faces
  // of Noto are Japanese, Korean, simplified Chinese, ..
  struct Known {
    const char* path;
    int face;
  };
  constexpr std::array kKnown{
      Known{"opentype/noto/NotoSansCJK-Regular.ttc", 2},
      Known{"google-noto-sans-cjk-fonts/NotoSansCJK-Regular.ttc", 2},
      Known{"noto-cjk/NotoSansCJK-Regular.ttc", 2},
      Known{"NotoSansCJK-Regular.ttc", 2},
      Known{"truetype/wqy/wqy-zenhei.ttc", 0},
      Known{"wqy-zenhei-fonts/wqy-zenhei.ttc", 0},
      Known{"wenquanyi/wqy-zenhei/wqy-zenhei.ttc", 0},
      Known{"wqy-zenhei.ttc", 0},
      Known{"truetype/droid/DroidSansFallbackFull.ttf", 0},
      Known{"DroidSansFallbackFull.ttf", 0},
  };
  const std::vector<std::string> folders = font_folders();
  for (const Known& known : kKnown) {
    for (const std::string& folder : folders) {
      const std::string path = folder + known.path;
      if (access(path.c_str(), R_OK) == 0) return FontFace{path, known.face};
    }
  }
  return std::nullopt;
}

bool can_show(const std::string& language) {
  LetterSet letters;
  add_catalogue(language, &letters);
  return !has_east_asian(listed(letters)) || east_asian_font();
}

std::string missing_letters_text(const std::string& language) {
  return trf(
      "{}: no font that has its letters is installed; Debian's package fonts-noto-cjk or "
      "fonts-wqy-zenhei has one",
      language);
}

}  // namespace kerf
