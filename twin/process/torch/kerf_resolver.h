// twin/process/torch/kerf_resolver.h - how wide a torch cuts: kerfs gathered from every source,
// best first.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "interp_bridge/motion.h"
#include "interp_bridge/torch_materials.h"
#include "twin/job/tools.h"

namespace kerf {

/// Answers "how wide is the kerf of this motion" in the order: --tool, --kerf, the material of a
/// QtPlasmaC program, comments of the program, the tool table (remark, then diameter: what G41 is
/// given there). A kerf is a cutter of that diameter. One thread.
class KerfResolver {
 public:
  /// `resolver` must outlive it. `kerf_mm` of --kerf, 0: not given. `by_material`: those of
  /// QtPlasmaC count.
  KerfResolver(ToolResolver& resolver, double kerf_mm, bool by_material)
      : resolver_(resolver), kerf_mm_(kerf_mm), by_material_(by_material) {}

  /// For a motion with the beam on, in program order (see ToolResolver::mount). `materials`: at
  /// least those that motions have named so far. The reference stays valid. Without a cutter
  /// nothing is known, or the kerf is too narrow (`trouble`).
  const ResolvedTool& of(const Motion& motion, std::span<const TorchMaterial> materials);

 private:
  ResolvedTool resolve(const Motion& motion, std::span<const TorchMaterial> materials);

  ToolResolver& resolver_;
  double kerf_mm_;
  bool by_material_;
  std::map<std::pair<int, std::uint16_t>, ResolvedTool> kerfs_;  ///< by tool and material
  const ResolvedTool* last_ = nullptr;
  std::pair<int, std::uint16_t> last_key_;
};

}  // namespace kerf
