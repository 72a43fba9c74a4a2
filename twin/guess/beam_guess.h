// twin/guess/beam_guess.h - whether a program is for a torch, a laser or a jet, by its words.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// What is taken of such a program.
struct BeamGuess {
  std::string trigger;  ///< as BeamTrigger::parse() takes it; empty: that of a QtPlasmaC machine
  double kerf_mm = 0;
  std::string reason;
};

/// Watches a program in its order. What says that a beam cuts: Z never goes down to cut, and the
/// spindle, its speed, or one output, digital or analog (M67), is on while it feeds and off while
/// it travels; or Z never moves, and an analog output says how strong.
class BeamWatch {
 public:
  void add(const Motion& motion);

  /// Nothing: it is for a tool that turns. `is_qtplasmac`: the text says so.
  std::optional<BeamGuess> guess(bool is_qtplasmac) const;

  /// Of the feed moves in X and Y, whatever Z; empty: there are none.
  const Box& feeds_mm() const { return feeds_mm_; }

 private:
  /// Ways of feeds and of travels, mm, with something on and off.
  struct Switched {
    double fed_on_mm = 0, fed_off_mm = 0;
    double travelled_on_mm = 0, travelled_off_mm = 0;
    std::uint64_t starts = 0;
    bool was_on = false;
    void add(bool on, bool feed, double mm);
    /// On for most of what is fed and off for most of what is travelled.
    bool is_beam() const;
  };

  Switched spindle_, speed_;
  Switched output_[TorchState::kOutputs];
  Switched analog_[TorchState::kAnalogs];
  std::set<float> powers_[TorchState::kAnalogs];  ///< above 0, of feeds; at most a few
  std::uint64_t outputs_seen_ = 0;                ///< bits of those that have ever been set
  double fed_mm_ = 0;
  double slanted_mm_ = 0;  ///< of that, where Z changes on the way
  double plunged_mm_ = 0;  ///< fed straight down
  bool z_moves_ = false;
  bool turns_ = false;       ///< A, B or C move: no sheet lies still under that
  bool dwells_lit_ = false;  ///< G4 with the spindle on: it pierces
  std::set<double> speeds_;  ///< of feeds; at most a few
  Box feeds_mm_;
};

}  // namespace kerf
