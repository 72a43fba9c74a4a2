// viewer/window/code_words.h - what the parts of a line of a program are, for its colours.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace kerf {

enum class CodeKind {
  kOther,    ///< numbers that belong to no word, expressions, operators
  kMotion,   ///< G words
  kMachine,  ///< M, T, S words: spindle, coolant, tools
  kFeed,     ///< F words
  kPlace,    ///< X Y Z A B C U V W, I J K R, P Q D E H L
  kControl,  ///< O words with their if, while, call; assignments and names of parameters
  kNumber,   ///< N words: they do nothing
  kComment,
};

struct CodeWord {
  std::size_t begin = 0;  ///< in the line
  std::size_t length = 0;
  CodeKind kind = CodeKind::kOther;
  bool operator==(const CodeWord&) const = default;
};

/// All of a line as words in its order, blanks with the word before them. By looks alone: faulty
/// lines have words, too. O(characters).
std::vector<CodeWord> code_words(std::string_view line);

/// The place of `wanted` in the line, whatever the letters' case; npos: it is not there. An empty
/// one is nowhere.
std::size_t find_text(std::string_view line, std::string_view wanted);

}  // namespace kerf
