// interp_bridge/tool_table.h - LinuxCNC's tool table: reading text, and writing the one that rs274
// is given.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/program.h"
#include "interp_bridge/program_prepare.h"

namespace kerf {

/// The rows of a table's text; `path` names it in the diagnostics. Any bytes are accepted.
std::vector<ToolTableRow> parse_tool_table(std::string_view text, const std::string& path,
                                           Diagnostics& diagnostics);

/// For which tools the interpreter knows how far G41 and G42 go off the path.
struct ToolDiameters {
  bool all = true;                    ///< nothing is to be said of any
  std::set<int> known;                ///< a D of the table, be it 0, or of a shape
  std::map<int, std::string> doubts;  ///< what a user of compensation must be told of a tool
};

/// The rows with the diameters of `known` where they have none of their own, and a row for each
/// other tool of it. Fills in `told`.
std::vector<ToolTableRow> with_known_diameters(std::vector<ToolTableRow> rows, bool has_table,
                                               const std::map<int, KnownDiameter>& known,
                                               ToolDiameters& told);

/// A tool table for rs274, and how its answers name the rows.
struct InterpreterToolTable {
  std::string text;
  std::vector<int> tool_by_index;  ///< [0] = 0: no tool
};

/// The given rows, and one for every named tool without a row so that its M6 runs. rs274 2.9 takes
/// every table for inches, so a diameter of 6 mm is written as 6 / 25.4. Length offsets are all 0
/// in X Y Z: with these the printed points are what the program writes (and rs274's wrong Z after
/// M6 behind a G43 cannot show). U and W say whose row it is (coded_offset()).
InterpreterToolTable interpreter_tool_table(const std::vector<ToolTableRow>& rows,
                                            const NamedTools& named);

}  // namespace kerf
