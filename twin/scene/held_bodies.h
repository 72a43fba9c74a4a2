// twin/scene/held_bodies.h - chuck, jaws and tailstock as the viewer draws them, and how near a
// turning tool is to them.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stock/cutter/cutter.h"
#include "stock/turning/turned_part.h"
#include "twin/job/work_holding.h"
#include "viewer/picture.h"
#include "viewer/scene.h"

namespace kerf {

/// For sentences: "chuck", in the user's language.
std::string name_of(HoldingBody::Kind kind);

/// A link each, in the frame of the workpiece: the rings that they sweep, seen through. Null: none.
std::vector<MachineLink> held_links(const HoldingList& held_by);

/// The same for pictures of a part.
std::vector<PictureBody> picture_bodies(const HoldingList& held_by);

/// Parts of a turning tool in the plane of the axis: chains of (z, x) about the controlled point,
/// arcs as chords within a micrometre. Of a drill it is as it stands along the axis.
struct FlatTool {
  TurnedProfile cutter, holder;
};
/// Empty: it does not turn (a driven tool), or has no outline.
FlatTool flat_tool(const Cutter& cutter);

/// How near two regions of the half plane are.
struct FlatGap {
  double mm = 0;        ///< 0: they overlap
  double depth_mm = 0;  ///< so deep is a corner of one in the other
  Vec2 at_mm{0};        ///< (z, x): half way between them, or the corner that is deepest
};
/// A tool at (z, x) against profiles, even-odd: x below 0 is on the other side of the axis. None:
/// one of the two is empty. O(corners of both, multiplied).
std::optional<FlatGap> gap_between(const TurnedProfile& tool, const Vec2& at_mm,
                                   const TurnedProfile& body);

/// The tool in use against what holds the workpiece, as it stands. One thread.
class HeldWatch {
 public:
  /// Null: nothing holds it.
  explicit HeldWatch(const HoldingList& held_by);

  std::size_t size() const { return bodies_.size(); }
  HoldingBody::Kind kind(std::size_t body) const { return bodies_[body].kind; }
  /// (z, r)
  const TurnedProfile& profile(std::size_t body) const { return bodies_[body].profile; }

  /// Null: none that is known.
  void mount(const Cutter* cutter);
  const FlatTool& tool() const { return tool_; }
  bool is_mounted() const { return !tool_.cutter.empty() || !tool_.holder.empty(); }

 private:
  struct Body {
    HoldingBody::Kind kind = HoldingBody::Kind::kChuck;
    TurnedProfile profile;
  };
  std::vector<Body> bodies_;
  FlatTool tool_;
};

}  // namespace kerf
