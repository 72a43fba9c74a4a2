// machine_io/simulator/load_profile.h - the spindle's load of the simulated machine, by time.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"

namespace kerf {

/// Straight on from place to place, and level before the first and behind the last. A small ripple
/// rides on it, of 1 % of it and the step of its register: a drive's number never stands still.
class LoadProfile {
 public:
  /// None: 0, without a ripple.
  LoadProfile() = default;

  /// "0:4.5,10:4.5,10.2:31": seconds of the program and the load there, times that do not go back,
  /// loads of -327 to 327. Error: what was found and what is allowed.
  static Result<LoadProfile> parse(std::string_view text);

  /// `count`: number of the update, for the ripple.
  double at(double time_s, unsigned count) const;

 private:
  std::vector<std::pair<double, double>> places_;
};

}  // namespace kerf
