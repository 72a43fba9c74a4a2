// twin/program/shared_reading.h - a program that is interpreted once, for any number of readers.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "twin/program/motion_archive.h"

namespace kerf {

/// Each reader is a Program that gives the motions from the beginning, in the same batches, with
/// the same frames, files and materials, whether the interpreter is ahead of it or was long ago;
/// summary and diagnostics are those of the one reading.
///
/// The interpreter runs in a thread of its own from the first Program::run() of a reader on, waits
/// while it is kAhead motions ahead of all readers that run, and ends when none is left that wants
/// more. What it has given is kept, packed (MotionArchive), up to kMostKept motions: of a longer
/// program each reader reads the rest by an interpreter of its own, from the beginning.
///
/// Any thread; each reader in one.
class SharedReading : public std::enable_shared_from_this<SharedReading> {
 public:
  static constexpr std::size_t kAhead = 65'536;
  static constexpr std::size_t kMostKept = 2'000'000;

  using Opener = std::function<std::unique_ptr<Program>()>;
  /// `program` has not run yet. `again` opens it once more; null if that fails.
  static std::shared_ptr<SharedReading> of(std::unique_ptr<Program> program, Opener again,
                                           std::size_t most_kept = kMostKept);
  ~SharedReading();
  SharedReading(const SharedReading&) = delete;
  SharedReading& operator=(const SharedReading&) = delete;

  /// For what is known without interpreting, and for Program::give_tools() before the first
  /// reader runs. It must not be run.
  Program& source() { return *program_; }
  /// From the program's beginning. Null: the interpreter was ended before the program was, since
  /// nobody wanted more; the program has to be opened anew.
  std::unique_ptr<Program> reader();
  /// That have been named so far: main program and subroutines.
  std::vector<std::string> files() const;

 private:
  class Reader;
  friend class Reader;
  struct Batch {
    std::size_t count = 0;
    WorkpieceFrame frame;
  };
  struct Chunk {
    MotionArchive motions;
    std::vector<Batch> batches;
  };
  enum class State : std::uint8_t {
    kBefore,
    kReading,
    kDone,     ///< to the program's end, or as far as the interpreter went by itself
    kTooLong,  ///< kMostKept motions are here, and no more will be
    kBroken,   ///< it was ended, since nobody wanted more
  };
  SharedReading(std::unique_ptr<Program> program, Opener again, std::size_t most_kept);
  void read();
  bool add(std::span<const Motion> motions);
  void hand_over_batches();
  bool is_wanted() const;
  void forget(const Reader* reader);
  void begin();

  std::unique_ptr<Program> program_;
  Opener again_;
  std::size_t most_kept_;

  mutable std::mutex mutex_;            // of all that follows but thread_
  std::condition_variable_any more_;    ///< there are chunks, or the end
  std::condition_variable_any wanted_;  ///< readers have come nearer, or it is to stop
  State state_ = State::kBefore;
  std::vector<std::shared_ptr<const Chunk>> chunks_;
  std::shared_ptr<Chunk> filling_;  ///< not in chunks_ yet
  std::size_t read_ = 0;            ///< motions
  std::vector<std::string> files_;
  std::vector<TorchMaterial> materials_;
  std::vector<const Reader*> readers_;  ///< that have not come to their end
  ProgramSummary summary_;
  Diagnostics diagnostics_;
  std::exception_ptr failure_;
  std::stop_source stop_;
  std::thread thread_;  ///< begun and joined by readers, one at a time (mutex_ is not held)
};

}  // namespace kerf
