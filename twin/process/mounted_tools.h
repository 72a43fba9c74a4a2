// twin/process/mounted_tools.h - the tool in the spindle along a program, without cutting
// it.
#pragma once

#include <span>
#include <utility>

#include "interp_bridge/motion.h"
#include "twin/job/tools.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/process.h"

namespace kerf {

/// Asks a ToolResolver at the same motions as the stages of milling and turning do: the order of
/// the questions decides whose a comment without a tool number is. One thread.
class MountedTools {
 public:
  MountedTools(ToolSources sources, ToolResolver::CutterCheck can_cut)
      : resolver_(std::move(sources), can_cut) {}

  /// Motions in program order. The tool that makes this one; null if it does not move, or if
  /// they would not ask for its tool yet. Valid until the next call.
  const ResolvedTool* at(const Motion& m) {
    if (m.kind == MotionKind::kToolChange || m.tool != spindle_tool_) {
      spindle_tool_ = m.tool;
      mounted_ = nullptr;
    }
    const bool feed = is_feed(m);
    if (feed && stands_still(m)) return nullptr;
    if (!feed && !is_traverse(m)) return nullptr;
    if (mounted_) return mounted_;
    if (!feed && m.tool == 0 && !resolver_.has_arguments()) return nullptr;
    mounted_ = &resolver_.mount(m.tool, m.source.file == 0 ? m.source.line : 0);
    return mounted_;
  }

 private:
  ToolResolver resolver_;
  const ResolvedTool* mounted_ = nullptr;
  int spindle_tool_ = 0;
};

/// They, for lists.
class MountedToolList final : public MotionTools {
 public:
  MountedToolList(const ToolSources& sources, ToolResolver::CutterCheck can_cut)
      : mounted_(sources, can_cut) {}

  Tool of(const Motion& motion, std::span<const TorchMaterial> /*materials*/) override {
    return {mounted_.at(motion)};
  }

 private:
  MountedTools mounted_;
};

}  // namespace kerf
