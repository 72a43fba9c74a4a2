// interp_bridge/record_reader.h - the records of kerf-interp, as commands with their lines.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interp_bridge/canonical.h"
#include "interp_bridge/child_listener.h"
#include "interp_bridge/motion_feeder.h"
#include "interp_bridge/record_cache.h"
#include "interp_bridge/record_format.h"

namespace kerf {

/// What the interpreter said when it gave up.
struct InterpreterFault {
  SourceRef place;
  std::string message;             ///< in the interpreter's words
  std::string echo;                ///< the block
  std::vector<SourceRef> callers;  ///< O-word calls that led there, innermost first
};

/// Takes the stream apart and gives commands to a MotionFeeder. The bytes are not trusted: what is
/// no record ends the reading with damage(). One thread.
class RecordReader final : public ByteReader {
 public:
  /// What the user calls a file that the interpreter names so.
  using FileNames = std::function<std::string(const std::string&)>;

  /// All references must outlive the reader. `feeder` gets the commands, `summary` the notes and,
  /// as soon as a record names it, every file that SourceRef::file indexes (its list starts anew).
  RecordReader(MotionFeeder& feeder, FileNames file_names, ProgramSummary& summary);

  /// What becomes of the answers to questions about probing moves; without it they are refused as
  /// damage, since nobody has asked for them. False: they cannot be given.
  using GiveAnswer = std::function<bool(const records::Answer&)>;
  void answer_by(GiveAnswer give) { give_answer_ = std::move(give); }

  std::span<char> room() override;
  /// False: the feeder is done, the stream is damaged or at its end.
  bool received(std::size_t bytes) override;

  /// Not empty: what is wrong with the stream.
  const std::string& damage() const { return damage_; }
  bool ended() const { return ended_; }  ///< the last record has come
  const std::vector<InterpreterFault>& faults() const { return faults_; }
  /// What the interpreter has read besides its options, once the last record has come.
  const std::vector<FileRead>& reads() const { return reads_; }
  /// The program came to its end, and would give the same records again while what it has read does
  /// not change: it has not probed, has called no user M-code, has not looked where nobody can tell
  /// what it saw.
  bool can_be_kept() const { return ended_ && came_to_end_ && !varies_ && faults_.empty(); }
  /// Where the interpreter was last heard of.
  SourceRef place() const { return place_; }

 private:
  bool take(const records::Head& head, const char* payload);
  bool take_special(const records::Head& head, const char* payload);
  bool take_command(const records::Head& head, const char* payload);
  bool take_mode(const records::Head& head, const char* payload);
  bool take_file(const records::Head& head, std::string_view name);
  bool take_spline(const records::Head& head, const char* payload);
  bool take_probe(const records::Head& head, const char* payload);
  void note(const records::Head& head, std::string text);
  bool refuse(const char* what);

  MotionFeeder& feeder_;
  FileNames file_names_;
  GiveAnswer give_answer_;
  ProgramSummary& summary_;
  std::vector<char> buffer_;
  std::size_t filled_ = 0;
  bool begun_ = false;
  bool ended_ = false;
  std::string damage_;
  CanonicalCommand command_;
  std::vector<Spline::Point> points_;
  std::vector<InterpreterFault> faults_;
  std::vector<FileRead> reads_;
  bool came_to_end_ = false;
  bool varies_ = false;
  std::uint32_t file_ = 0;
  SourceRef place_;
};

}  // namespace kerf
