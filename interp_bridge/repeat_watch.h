// interp_bridge/repeat_watch.h - does a program that loops still do anything new?
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interp_bridge/motion.h"

namespace kerf {

/// A step is new if no earlier one of its line has led to the same place. Until the lines go back
/// for the first time every step is new, and nothing is remembered: a program without loops pays
/// nothing. Remembers half a million places (8 MB); of a program that has more, all counts as new.
class RepeatWatch {
 public:
  /// What one command has made; nothing of a command that makes no step.
  void take(SourceRef source, std::span<const Motion> motions);

  /// Grows with all that is new.
  std::uint64_t news() const { return news_; }
  /// Since then: commands, and about how long a machine would take for them.
  std::uint64_t commands() const { return commands_; }
  double machine_s() const { return machine_s_; }
  /// Since then it would have stood still all the while, or run for more than a day: nobody means
  /// that.
  bool seems_endless() const;

 private:
  bool is_new(SourceRef source, const Motion& motion);
  bool insert(std::uint64_t key);
  void grow();

  SourceRef before_;
  bool loops_ = false;
  std::uint64_t same_line_ = 0;        ///< commands of before_, in a row
  std::vector<std::uint64_t> places_;  ///< open addressing, a power of two; 0: free
  std::size_t count_ = 0;
  std::uint64_t news_ = 0;
  std::uint64_t commands_ = 0;
  double machine_s_ = 0;
};

}  // namespace kerf
