// twin/config/job_file.h - a part that is made in several setups, as a YAML file says it.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/placement.h"
#include "twin/config/written_options.h"

namespace kerf {

/// Where something stands in the file.
struct JobPlace {
  std::string path;  ///< "setups[2].stock"
  int line = 0, column = 0;
};

/// How the workpiece lies in a setup, seen from how it lay in the one before.
struct JobTurn {
  enum class Zero : std::uint8_t { kStays, kTop, kCorner, kMiddle, kPoint };

  char flip = 0;       ///< 'x', 'y': half a turn about that axis, through the middle of its box
  Vec3 rotate_deg{0};  ///< then about X, Y and Z through that middle
  Zero zero = Zero::kStays;
  Vec3 point_mm{0};  ///< kPoint: what becomes the origin, as it lies once it is turned
  /// Three points of it, as they lay and as they were touched: they say all there is to say.
  struct Touched {
    std::array<Vec3, 3> was_mm{}, is_mm{};
  };
  std::optional<Touched> touched;

  /// It only goes on: nobody has moved it.
  bool is_none() const {
    return flip == 0 && rotate_deg == Vec3(0) && zero == Zero::kStays && !touched;
  }
  /// `solid_mm`: the box of what the setup before has left. Where Z0 is to be on top, it is on top
  /// of what is there once it is turned.
  Placement placement(const Box& solid_mm) const;
  /// The turn alone, which is known before anything is cut.
  Placement turn() const;
};

struct JobSetup {
  std::string name;        ///< of the file, or "setup 2"
  WrittenOptions options;  ///< of `kerf run`, the program as well; of the first one with --stock
  JobTurn turn;            ///< of the first one none
  double time_s = 0;       ///< to set it up
  JobPlace place;
  std::map<std::string, JobPlace, std::less<>> option_places;  ///< by option
};

struct JobFile {
  std::string path;
  std::vector<JobSetup> setups;
  WrittenOptions compare;  ///< --compare and what goes with it, of the last one; empty: none
  std::map<std::string, JobPlace, std::less<>> compare_places;
};

/// Points that were touched may lie so much otherwise to each other than they did.
inline constexpr double kTouchSlack_mm = 0.1;

/// All faults at once, each at its place, with what is allowed. Nothing if there is one. Files are
/// relative to `path`; programs must be there.
std::optional<JobFile> parse_job(std::string_view text, const std::string& path,
                                 Diagnostics& diagnostics);

/// Faults of options of a setup ("--cell: ..") where the file says them ("setups[2].cell_mm: ..").
/// `text` is the file's, for excerpts.
void place_faults(const JobFile& job, std::string_view text,
                  const std::map<std::string, JobPlace, std::less<>>& places,
                  Diagnostics& diagnostics);

/// A YAML file with setups.
bool is_job_file(const std::string& path);

}  // namespace kerf
