// twin/playback/mounted_tools.h - the tool in the spindle along a program, without cutting it.
#pragma once

#include <utility>

#include "interp_bridge/motion.h"
#include "twin/motion_geometry.h"
#include "twin/tools.h"

namespace kerf {

/// Asks a ToolBook at the same motions as CutStage does: the order of the questions decides whose a
/// comment without a tool number is. One thread.
class MountedTools {
 public:
  MountedTools(ToolSources sources, ToolBook::CutterCheck can_cut)
      : book_(std::move(sources), can_cut) {}

  /// Motions in program order. The tool that makes this one; null if it does not move, or if
  /// CutStage would not ask for its tool yet. Valid until the next call.
  const ResolvedTool* at(const Motion& m) {
    if (m.kind == MotionKind::kToolChange || m.tool != spindle_tool_) {
      spindle_tool_ = m.tool;
      mounted_ = nullptr;
    }
    const bool feed = is_feed(m);
    if (feed && stands_still(m)) return nullptr;
    if (!feed && !is_traverse(m)) return nullptr;
    if (mounted_) return mounted_;
    if (!feed && m.tool == 0 && !book_.has_arguments()) return nullptr;
    mounted_ = &book_.mount(m.tool, m.source.file == 0 ? m.source.line : 0);
    return mounted_;
  }

 private:
  ToolBook book_;
  const ResolvedTool* mounted_ = nullptr;
  int spindle_tool_ = 0;
};

}  // namespace kerf
