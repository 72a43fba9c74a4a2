// interp_bridge/kerf_interp/recording.h - the one interpreter of this process, its world, and where
// its calls go. The interpreter calls free functions without a context, so this is global.
#pragma once

#include <array>
#include <interp_base.hh>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/kerf_interp/record_writer.h"
#include "interp_bridge/kerf_interp/world.h"

namespace kerf::interp {

class Recording {
 public:
  World world;
  InterpBase* interpreter = nullptr;
  RecordWriter* records = nullptr;

  /// Line of the block being executed; canonical calls that are not motions do not bring it.
  int line() const { return interpreter != nullptr ? interpreter->sequence_number() : 0; }

  /// The last USE_TOOL_LENGTH_OFFSET, as its record has it; empty: there was none.
  std::vector<double> length_offset;
  int length_offset_line = 0;

  int answers_fd = -1;  ///< where kerf answers; -1: it is not asked
  /// What the machine refuses to do, in its words; the run ends behind the block. Empty: nothing.
  std::string refusal;
  /// Asks where a probing move to `target` (program coordinates) ends: type 0 to 3 for G38.2 to
  /// G38.5. All records so far go out; waits.
  records::Answer ask_probe(int move_line, const Pose& target, unsigned char type);

  /// Names the program itself, which is file 0.
  void begin(const std::string& program);
  /// O-word calls and returns may lead to another file: the records that follow are of that one.
  void moved_to_level(int level) {
    records->set_level(level);
    find_file();
  }
  /// The same where the level did not change: of two remapped codes in one block, the second one's
  /// subroutine begins where the first one's ends.
  void find_file();
  /// A block has been read and is about to be executed.
  void begin_block(int line) {
    recent_[++blocks_ % kRecent] = {file_, line};
    world.forget_lookup();
  }
  /// The block being executed, as it is written.
  std::string block_text() const;
  /// The block only called or returned: no move is its own.
  void block_does_not_move() { recent_[blocks_ % kRecent].line = 0; }
  /// The line of a move. Moves bring that of their block; those of G70 to G72 bring 0. Cutter
  /// compensation holds moves back, over the edge of a file too: the move is then said to be of the
  /// file of its block.
  int line_of_move(int move_line) {
    const int now = line();
    if (restore_file_) find_file();
    if (move_line <= 0 || move_line == now) {
      moved_ = blocks_;
      return now;
    }
    find_earlier_block(move_line);
    return move_line;
  }
  /// Before every other record with a line.
  int line_now() {
    if (restore_file_) find_file();
    return line();
  }
  int file() const { return file_; }  ///< index of the present one

 private:
  /// Blocks that are remembered, more than compensation holds back.
  static constexpr std::size_t kRecent = 256;
  struct Block {
    int file = 0;
    int line = 0;
  };
  void change_file(int index, std::string_view name);
  void find_earlier_block(int line);

  int file_ = 0;
  bool restore_file_ = false;  ///< file_ is that of an earlier block
  std::vector<std::string> files_;
  std::array<Block, kRecent> recent_{};
  std::size_t blocks_ = 0;
  std::size_t moved_ = 0;  ///< the block of the last move
};

Recording& recording();

}  // namespace kerf::interp
