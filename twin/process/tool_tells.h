// twin/process/tool_tells.h - what is told of a tool when it comes to be used.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/job/tool_use.h"
#include "twin/job/tools.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// Of a tool that has done nothing yet; without an origin where there is no cutter: that is told
/// when it first feeds.
ToolUse use_of(const ResolvedTool& tool);
/// tool-assumed and tool-guessed, where it first moves.
void tell_tool(const ResolvedTool& tool, const Motion& motion, FindingLog& log);
/// Which of `uses` is of that tool and that shape: a program may give a number several shapes, each
/// with a row of its own. One that is new is added, and told by tell_tool(). A tool that becomes
/// known takes the row of the number as it was when nobody knew its shape: it has not cut.
std::size_t place_of_use(std::vector<ToolUse>& uses, const ResolvedTool& tool, const Motion& motion,
                         FindingLog& log);
/// tool-undefined, where it first feeds.
void tell_undefined(const ResolvedTool& tool, const Motion& motion, const TimedStep& step,
                    FindingLog& log);

}  // namespace kerf
