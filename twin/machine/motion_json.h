// twin/machine/motion_json.h - motions as JSON lines, one object a line: what `kerf canon` prints.
//
//     {"line":12,"file":"part.ngc","kind":"feed","from":[0,0,5],"to":[0,0,-1],"feed":300,"tool":1,"t":1.2,"duration":1.2}
//
// mm, mm/min, s, degrees; the tip in the workpiece frame. "kind" is traverse | feed | arc | thread
// | probe | dwell | tool-change | stop | program-end. Only where they apply:
//
//     "from": null           where the motion begins is not known (the first one), or where it ends
//     "to": [50,30,null]     of this axis nothing says where it goes
//     "unknown_from", "unknown_to": "XZ"       the axes of which nothing says where they stand
//     "center", "axis", "sweep_deg"   arcs: the tip turns about the axis by the right-hand rule
//     "from_abc", "to_abc"   A, B or C are not at 0
//     "from_uvw", "to_uvw"   U, V or W are not at 0
//     "feed_per_rev": true   "feed" is mm a revolution (G95, G33)
//     "spindle": "cw" | "ccw", "rpm"  the spindle turns
//     "coolant": ["flood", "mist"]    which of them run
//     "spindles": 3          bit n: M3 $n is on; left out where it is none or the first alone
//     "outputs": [3]         digital outputs that are on (M62, M64)
//     "analog": [0,0,0,50]   analog outputs (M67, M68), if one is not 0
//     "adaptive_feed", "overburn": true   M52; QtPlasmaC's overburn
//     "material": 2          row of QtPlasmaC's materials, if it is not the first
//     "tip_off": [0,0,-15]   the tool is not as long as its offset: so far off is the tip from
//     where
//                            the program has it, in from, to and center already
//     "tip_off_uvw": [0,0,-15]   the same of U, V, W, in from_uvw and to_uvw
//     "path": "exact-stop" | "exact-path"      G61.1, G61; "blend_mm", "merge_mm": G64 P Q
#pragma once

#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// "traverse", "feed", ...
const char* to_string(MotionKind kind);

/// Makes the lines. Numbers are rounded to 1e-6 and written as short as that allows. About 1 us a
/// line; allocates only where the text grows.
class MotionJson {
 public:
  /// `files` as ProgramSummary has them; a motion of a file beyond them has "file": null.
  void set_files(const std::vector<std::string>& files);

  /// Appends the line, newline included, to `out`.
  void append(const Motion& motion, const TimedStep& step, std::string& out) const;

 private:
  std::vector<std::string> quoted_files_;
};

}  // namespace kerf
