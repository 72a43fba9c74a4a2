// interp_bridge/block_words.h - what the text of a block says of where it goes: the words that a
// canonical call, which always has all axes, does not tell.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/motion.h"
#include "interp_bridge/source_text.h"

namespace kerf {

struct BlockWords {
  /// What its numbers are measured from.
  enum class Place : std::uint8_t {
    kProgram,
    kMachine,     ///< G53
    kReference,   ///< G28, G30: by way of a place of the program to one of the machine
    kToolChange,  ///< M6: the machine's own moves, if it makes any
  };
  /// What it does to the offsets.
  enum class Offset : std::uint8_t {
    kNone,
    kShift,     ///< G92
    kLocal,     ///< G52
    kUnshift,   ///< G92.1
    kSuspend,   ///< G92.2
    kReshift,   ///< G92.3
    kTouchOff,  ///< G10 L20
    kMachine,   ///< G10 L2
  };
  /// G0 or G1, G2, G3, where the block has the word.
  enum class Speed : std::uint8_t { kUnsaid, kRapid, kFeed };

  /// What it keeps for later, although it moves nothing and no canonical call comes of it.
  enum class Store : std::uint8_t { kNone, kFirst, kSecond };  ///< G28.1; G30.1

  std::uint8_t named = 0;     ///< bit 0: it has an X word, 1: Y, 2: Z
  std::uint8_t computed = 0;  ///< .. whose number is an expression, or a parameter
  Place place = Place::kProgram;
  Offset offset = Offset::kNone;
  Speed speed = Speed::kUnsaid;
  Store store = Store::kNone;
  bool second_reference = false;  ///< of Place::kReference: G30
  int system = 0;                 ///< P of a G10 L2 or L20, 0 the one in force; -1: computed
  double z = 0;                   ///< number of its Z word, in the program's unit; 0 if computed
};

/// Words of one line of NC code. Comments, O-words and what stands in brackets do not count; a G, M
/// or L word whose number is computed is passed over. About 100 ns.
BlockWords words_of_block(std::string_view line);
/// It may be one whose effect shows only later: G28.1, G30.1, G10 L2 and L20. About 5 ns.
bool may_store(std::string_view line);
/// It is.
bool stores(const BlockWords& words);

/// The words of the blocks that motions come from, read from the files as they are needed. A file
/// is looked through once (31 MB: 0.01 s); what is kept of it are the lines that have to do with
/// the machine's own coordinates or with offsets.
class BlockReader {
 public:
  /// `unplaced`: bits of the axes of which it still matters whether a block names them; if it is 0
  /// only blocks whose place or offset is not the usual one are told apart, the others come
  /// empty. `files`: SourceRef::file indexes it. Null: the line is not known, or its file cannot be
  /// read. Until the next call.
  const BlockWords* at(SourceRef source, const std::vector<std::string>& files,
                       std::uint8_t unplaced);
  /// Bits of the axes that the file names anywhere; all, if it calls others or cannot be read.
  std::uint8_t named_in(const std::string& path);

 private:
  struct File;
  File& file(std::size_t index, const std::string& path);

  std::vector<std::shared_ptr<File>> files_;
  BlockWords words_;
};

}  // namespace kerf
