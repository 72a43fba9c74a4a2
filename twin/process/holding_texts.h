// twin/process/holding_texts.h - what is said of a tool and what holds a workpiece that turns.
#pragma once

#include <string>

#include "twin/collision/tool_bodies.h"
#include "twin/findings/finding.h"
#include "twin/job/work_holding.h"

namespace kerf {

/// chuck-contact, jaw-contact; of the tailstock fixture-contact.
FindingId holding_contact_id(HoldingBody::Kind kind);
/// "the tool's holder touches the jaws of the chuck"
std::string holding_contact_text(ToolPart part, HoldingBody::Kind kind);
std::string holding_near_text(ToolPart part, HoldingBody::Kind kind, double mm);

}  // namespace kerf
