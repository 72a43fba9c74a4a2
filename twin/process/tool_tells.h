// twin/process/tool_tells.h - what is told of a tool when it comes to be used.
#pragma once

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
/// tool-undefined, where it first feeds.
void tell_undefined(const ResolvedTool& tool, const Motion& motion, const TimedStep& step,
                    FindingLog& log);

}  // namespace kerf
