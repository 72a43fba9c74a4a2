// interp_bridge/parameter_file.h - LinuxCNC's parameter (var) file: work offsets that outlive a
// run.
#pragma once

#include <array>
#include <map>
#include <string>

#include "base/diagnostic.h"
#include "base/result.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// What a var file says of offsets. Numbers in the machine's unit, as they are written.
struct ParameterFile {
  std::map<int, double> values;  ///< by parameter number

  double value(int number) const {
    const auto found = values.find(number);
    return found == values.end() ? 0.0 : found->second;
  }
  /// 1 = G54 .. 9 = G59.3: the one that was in force when LinuxCNC last wrote the file.
  int work_offset_index() const;
  /// Where the workpiece lies under work offset `index` (1..9), with G92 if it is in force; mm.
  /// `unit_mm`: mm in one unit of the machine, 1 or 25.4.
  WorkpieceFrame frame(int index, double unit_mm) const;
};

/// Lines "number value", in the order of their numbers, as LinuxCNC wants them. Lines that are
/// something else, or out of order, are warnings with line and column. Error: "reading mill.var: No
/// such file or directory".
Result<ParameterFile> read_parameter_file(const std::string& path, Diagnostics& diagnostics);

}  // namespace kerf
