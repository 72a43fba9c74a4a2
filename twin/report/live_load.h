// twin/report/live_load.h - the load of a machine's spindle beside what its cuts should take:
// values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "machine_io/spindle_load.h"

namespace kerf {

/// At one moment, in the unit of the source.
struct LoadNow {
  LoadUnit unit = LoadUnit::kPercentOfPower;
  double measured = 0;
  /// Idle and cut together, what they should be; none: nobody knows.
  std::optional<double> low, high;
};

/// "23.1 % (18 to 41.3)": measured, and what should be.
std::string text_of(const LoadNow& load);

/// Of a watch, in the unit of the source.
struct LoadReport {
  LoadUnit unit = LoadUnit::kPercentOfPower;
  std::uint64_t samples = 0;  ///< that had a load
  double least = 0, most = 0;
  /// With the spindle turning in the air, at about this speed.
  struct Idle {
    double rpm = 0;  ///< 0: the source does not tell it
    double load = 0;
  };
  std::vector<Idle> idle;
  /// Over the time that could be judged: means.
  struct Tool {
    int number = 0;
    double judged_s = 0;
    double differs_s = 0;  ///< of it, beyond the band
    double measured = 0;
    double low = 0, high = 0;  ///< idle load and cut together
  };
  std::vector<Tool> tools;
  /// How long tools have cut what nobody knows the load of: threads, driven tools, no teeth=N.
  struct Unjudged {
    int number = 0;
    double seconds = 0;
  };
  std::vector<Unjudged> unjudged;
};

}  // namespace kerf
