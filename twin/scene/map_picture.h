// twin/scene/map_picture.h - maps of a workpiece from above: how tools were engaged, and what is
// left for rest machining.
#pragma once

#include <string>

#include "twin/compare/rest.h"
#include "twin/process/engagement.h"
#include "viewer/picture.h"

namespace kerf {

/// X to the right, Y upward, with the limits of what is shown, a legend of its colours and a line
/// of words; 1280 pixels wide. Drawn on the CPU: needs no OpenGL. `name`: of the program.
///
/// The engagement: in steps of 30 degrees of the edge of the tool that cut a place last.
Picture engagement_picture(const Engagement& engagement, const std::string& name);

/// Rest: what is done, what a tool clears (the widest that does, in a colour of its own), and what
/// none does.
Picture rest_picture(const Rest& rest, const std::string& name);

}  // namespace kerf
