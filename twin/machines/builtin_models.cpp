#include "twin/machines/builtin_models.h"

#include <cassert>

#include "twin/machines/builtin_parts.h"

namespace kerf {

std::string_view name_of(MachineKind kind) {
  constexpr std::array<std::string_view, 9> kNames{"none",  "knee-mill",   "gantry",
                                                   "lathe", "trunnion",    "plasma",
                                                   "punch", "bridge-mill", "swivel-mill"};
  return kNames[static_cast<std::size_t>(kind)];
}

MachineModel builtin_machine(MachineKind kind, const MachineRoom& room) {
  switch (kind) {
    case MachineKind::kGantry:
      return build_gantry(room);
    case MachineKind::kLathe:
      return build_lathe(room);
    case MachineKind::kTrunnion:
      return build_trunnion(room);
    case MachineKind::kPlasma:
      return build_plasma(room);
    case MachineKind::kPunch:
      return build_punch(room);
    case MachineKind::kBridgeMill:
      return build_bridge_mill(room);
    case MachineKind::kSwivelMill:
      return build_swivel_mill(room);
    case MachineKind::kNone:
      assert(false);
      [[fallthrough]];
    case MachineKind::kKneeMill:
      break;
  }
  return build_knee_mill(room);
}

}  // namespace kerf
