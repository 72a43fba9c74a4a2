#include "twin/process/holding_texts.h"

#include "base/translate.h"

namespace kerf {

FindingId holding_contact_id(HoldingBody::Kind kind) {
  switch (kind) {
    case HoldingBody::Kind::kChuck:
      return FindingId::kChuckContact;
    case HoldingBody::Kind::kJaws:
      return FindingId::kJawContact;
    case HoldingBody::Kind::kTailstock:
      break;
  }
  return FindingId::kFixtureContact;
}

std::string holding_contact_text(ToolPart part, HoldingBody::Kind kind) {
  const bool holder = part == ToolPart::kHolder, shank = part == ToolPart::kShank;
  switch (kind) {
    case HoldingBody::Kind::kChuck:
      return holder  ? tr("the tool's holder touches the chuck")
             : shank ? tr("the tool's shank touches the chuck")
                     : tr("the tool touches the chuck");
    case HoldingBody::Kind::kJaws:
      return holder  ? tr("the tool's holder touches the jaws of the chuck")
             : shank ? tr("the tool's shank touches the jaws of the chuck")
                     : tr("the tool touches the jaws of the chuck");
    case HoldingBody::Kind::kTailstock:
      break;
  }
  return holder  ? tr("the tool's holder touches the tailstock")
         : shank ? tr("the tool's shank touches the tailstock")
                 : tr("the tool touches the tailstock");
}

std::string holding_near_text(ToolPart part, HoldingBody::Kind kind, double mm) {
  const bool holder = part == ToolPart::kHolder, shank = part == ToolPart::kShank;
  switch (kind) {
    case HoldingBody::Kind::kChuck:
      return holder  ? trf("the tool's holder comes as near as {:.2f} mm to the chuck", mm)
             : shank ? trf("the tool's shank comes as near as {:.2f} mm to the chuck", mm)
                     : trf("the tool comes as near as {:.2f} mm to the chuck", mm);
    case HoldingBody::Kind::kJaws:
      return holder
                 ? trf("the tool's holder comes as near as {:.2f} mm to the jaws of the chuck", mm)
             : shank
                 ? trf("the tool's shank comes as near as {:.2f} mm to the jaws of the chuck", mm)
                 : trf("the tool comes as near as {:.2f} mm to the jaws of the chuck", mm);
    case HoldingBody::Kind::kTailstock:
      break;
  }
  return holder  ? trf("the tool's holder comes as near as {:.2f} mm to the tailstock", mm)
         : shank ? trf("the tool's shank comes as near as {:.2f} mm to the tailstock", mm)
                 : trf("the tool comes as near as {:.2f} mm to the tailstock", mm);
}

}  // namespace kerf
