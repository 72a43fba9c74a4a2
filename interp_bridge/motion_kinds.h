// interp_bridge/motion_kinds.h - what the kind of a motion says of it.
#pragma once

#include "interp_bridge/motion.h"

namespace kerf {

/// At the rate of a feed: a feed, an arc that is no traverse, a thread.
constexpr bool is_feed(const Motion& m) {
  return m.kind == MotionKind::kFeed || (m.kind == MotionKind::kArc && !m.rapid) ||
         m.kind == MotionKind::kThread;
}

/// At the machine's own rate, straight or along an arc.
constexpr bool is_traverse(const Motion& m) {
  return m.kind == MotionKind::kTraverse || (m.kind == MotionKind::kArc && m.rapid);
}

/// The kind is one that takes the tool somewhere, if only to where it is: a traverse, a feed, a
/// probe.
constexpr bool is_move(MotionKind kind) {
  return kind == MotionKind::kTraverse || kind == MotionKind::kFeed || kind == MotionKind::kArc ||
         kind == MotionKind::kThread || kind == MotionKind::kProbe;
}
constexpr bool is_move(const Motion& m) { return is_move(m.kind); }

}  // namespace kerf
