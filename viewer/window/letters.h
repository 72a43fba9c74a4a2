// viewer/window/letters.h - which letters the texts of a language need, and which installed font
// has them. Knows files and languages, no OpenGL and no Dear ImGui.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// The letters beyond ASCII in UTF-8, each once, in order; bytes that are none are passed over.
/// Those beyond U+FFFF are left out, for which the window has no room.
std::vector<char16_t> letters_in(std::string_view text);

/// Of the catalogue of a language, which it reads, and of the names of all languages.
std::vector<char16_t> letters_of(const std::string& language);

/// Chinese, Japanese or Korean, which the fonts for other languages do not have.
bool is_east_asian(char16_t letter);
bool has_east_asian(const std::vector<char16_t>& letters);

/// One face of a file of fonts.
struct FontFace {
  std::string path;
  int face = 0;
};

/// For Chinese, Japanese and Korean: fonts-noto-cjk, fonts-wqy-zenhei or fonts-droid-fallback,
/// below fonts/ in the folders of XDG_DATA_HOME and XDG_DATA_DIRS (as the XDG Base Directory
/// Specification has them). None where none is installed.
std::optional<FontFace> east_asian_font();

/// Whether the fonts that are installed have the letters of this one of languages().
bool can_show(const std::string& language);

/// What is to be said where they have not.
std::string missing_letters_text(const std::string& language);

}  // namespace kerf
