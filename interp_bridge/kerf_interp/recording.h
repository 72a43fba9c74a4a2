// interp_bridge/kerf_interp/recording.h - the one interpreter of this process, its world, and where
// its calls go. The interpreter calls free functions without a context, so this is global.
#pragma once

#include <interp_base.hh>
#include <string>
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

  /// Names the program itself, which is file 0.
  void begin(const std::string& program);
  /// O-word calls and returns may lead to another file: the records that follow are of that one.
  void moved_to_level(int level);
  int file() const { return file_; }  ///< index of the present one

 private:
  int file_ = 0;
  std::vector<std::string> files_;
};

Recording& recording();

}  // namespace kerf::interp
