// twin/live/idle_loads.h - what a spindle takes in the air, by its speed.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "machine_io/spindle_load.h"

namespace kerf {

/// Two speeds at which a spindle takes about the same: a motor slips under load, and what differs
/// by more than a tenth is another speed.
bool is_same_speed(double a_rpm, double b_rpm);

/// Loads in the air, in the unit of the source: of each speed the last kBins. One thread.
class IdleLoads {
 public:
  /// Of so many the idle load is the lower quartile: spinning up takes more. And the fewest.
  static constexpr std::size_t kBins = 24, kLeastBins = 4;

  struct Idle {
    double load = 0;
    double noise = 0;  ///< its standard deviation
    double doubt = 0;  ///< by how much it may be off where nobody has measured it
  };

  void learn(double rpm, double load);
  /// As it was measured at that speed.
  std::optional<Idle> at(double rpm) const;
  /// The same; where it was not measured at that speed, as it can be by what was at others:
  ///  - between two speeds on the line through both, by kBend of their difference at most beside
  ///    it: friction bends no more, from that of bearings to that of air (speed, and its cube);
  ///  - else of the nearest speed, times (speed ratio)^0 to ^2 of a power, ^0 to ^1 of a torque:
  ///    what does not hang on the speed, to what grows with it as oil does.
  std::optional<Idle> near(double rpm, LoadUnit unit) const;
  static constexpr double kBend = 0.4;

  struct Measured {
    double rpm = 0;
    Idle idle;
  };
  /// Of all speeds of which there is enough, as they were met.
  std::vector<Measured> all() const;

 private:
  struct Speed {
    double rpm = 0;
    std::vector<double> loads;  ///< a ring
    std::size_t next = 0;
    bool is_enough() const { return loads.size() >= kLeastBins; }
    Idle idle() const;
  };
  const Speed* find(double rpm) const;

  std::vector<Speed> speeds_;
};

}  // namespace kerf
