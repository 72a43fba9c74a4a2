// stock/cutter/turning_hints.h - turning tools that CAM systems and people write into comments.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "stock/cutter/tool_hints.h"
#include "stock/cutter/turning_text.h"

namespace kerf {

/// As find_tool_hints(), for programs of lathes:
///     "T3 = groove 3mm", "TOOL 2: DNMG 150608", "T1 M6 (CNMG 432)": comments that begin with a
///         tool's number, or stand in the block of a T word, as turning_shape_in_text() reads them
///     "CNMG120408 roughing", "iso:CNMG120408": a designation or a SHAPE, wherever it stands
/// Words without a tool's number ("thread M20", "groove 3 deep") say what is done, not by what:
/// they are passed over. A text that names several tools is about none.
///
/// `rows`: what the tool table says of a tool; orientation and angles that a text leaves out come
/// from there.
std::vector<ToolHint> find_turning_hints(std::span<const CommentText> comments,
                                         const std::map<int, TurningFacts>& rows = {});

}  // namespace kerf
