// interp_bridge/parameter_file.h - LinuxCNC's parameter (var) file: work offsets that outlive a
// run.
#pragma once

#include <array>
#include <map>
#include <string>

#include "base/diagnostic.h"
#include "base/result.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/program.h"

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
  /// Work offset `index` becomes that of `frame`, whose G92 does not count.
  void set_frame(int index, const WorkpieceFrame& frame, double unit_mm);
  /// Lengths times `factor`: G28, G30, G92 and the work offsets; not their angles.
  void scale_lengths(double factor);
  /// As LinuxCNC reads it, with all digits.
  std::string text() const;
};
inline constexpr int kWorkOffsets = 9;  ///< G54 .. G59.3

/// Lines "number value", in the order of their numbers, as LinuxCNC wants them. Lines that are
/// something else, or out of order, are warnings with line and column. Error: "reading mill.var: No
/// such file or directory".
Result<ParameterFile> read_parameter_file(const std::string& path, Diagnostics& diagnostics);

/// The parameters that an interpreter is given: those of `machine`'s file, if it has one, with
/// InterpreterSetup::work_offset in them. `unit_mm`: of their numbers. Error as above.
Result<ParameterFile> parameters_of(const InterpreterSetup& machine, double unit_mm,
                                    Diagnostics& diagnostics);

}  // namespace kerf
