// tests/bench/workloads.h - the NC programs that every figure of kerf is measured on.
//
// Their bytes never change (check_workloads.cmake holds the SHA-256), so figures of different years
// and of other programs can be compared. One more, w1, is LinuxCNC's own 3D_Chips.ngc.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace kerf {

/// One generated program, with the blank and the cutter that belong to it (as `kerf run` takes
/// them).
struct Workload {
  std::string_view name;   ///< "w2_finish_100k"; the file is NAME.ngc
  std::string_view about;  ///< one line
  std::string_view stock;  ///< --stock
  std::string_view tool;   ///< --tool
  std::string (*program)();
  bool turns = false;  ///< --model turning
};

/// w2_finish_100k, w2_finish_1m: raster finishing of a wavy surface, 100 651 and 1 002 001 lines of
/// G1. w3_trochoid: slots by full circles that advance 0.5 mm, half of its moves are arcs.
/// w4_lathe: a shaft that is turned (--model turning), 100 007 lines that move.
std::span<const Workload> workloads();

}  // namespace kerf
