// twin/tool_library/fusion_turning.h - the turning tools of Fusion and HSM libraries.
#pragma once

#include <string_view>

#include "twin/tool_library/json_fields.h"
#include "twin/tool_library/tool_library.h"

namespace kerf {

/// "turning general", "turning boring", "turning grooving", "turning threading", as SHAPE texts of
/// inserts, blades and threads. False: it is another kind, and nothing is done.
///
///     geometry  SC: the letter of ISO 1832, or "groove square", "groove round", "thread ..";
///               INSD: its size, of SIZE_SPECIFICATION_MODE IC the inscribed circle, of CE the
///               cutting edge; RE, S, RA, TC, SCTY: corner, thickness, clearance, tolerance, type;
///               tool_grooveWidth, tool_internalThread, thread-profile-angle, TPN, TPX
///     holder    HAND: R L N; THSC: its style, by the letter of ISO 5608, of bars "boring bar l";
///               W, OAL: shank; LH: head; CW: from the axis of a bar to the tip
///
/// The library does not say where LinuxCNC's controlled point is: that of SHAPE is taken.
bool make_fusion_turning_tool(const Json& tool, std::string_view kind, double mm, double holder_mm,
                              LibraryTool& out);

}  // namespace kerf
