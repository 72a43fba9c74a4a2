#include "twin/scene/turned_finding_view.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "stock/turning/turning_stock.h"
#include "twin/scene/held_bodies.h"

namespace kerf {
namespace {

/// Shown of what lies about the place: of the tool's longer side, within these.
constexpr double kAboutOfTool = 0.7, kLeastAboutTurned_mm = 15, kMostAboutTurned_mm = 60;
/// Shown larger: of the picture, and at least.
constexpr double kCloseOfFrame = 0.08, kLeastCloseTurned_mm = 2.5;
/// The material is looked at so far along Z beside the place, and must stand so much higher.
constexpr double kBesidePlace_mm = 0.05, kHigher_mm = 0.2;

Box box_of(const TurnedProfile& profile, const Vec2& at_mm = Vec2(0)) {
  Box box;
  for (const std::vector<Vec2>& chain : profile)
    for (const Vec2& p : chain) box.extend(Vec3(p.y + at_mm.y, 0, p.x + at_mm.x));
  return box;
}

Box common_of(const Box& a, const Box& b) {
  Box box;
  box.min = glm::max(a.min, b.min);
  box.max = glm::min(a.max, b.max);
  return box;
}

/// Material stands between the place and the eye.
bool is_covered(const TurnedProfile& profile, const Vec3& place_mm) {
  const double low = place_mm.z - kBesidePlace_mm, high = place_mm.z + kBesidePlace_mm;
  const double radius = std::abs(place_mm.x) + kHigher_mm;
  for (const std::vector<Vec2>& chain : profile) {
    for (std::size_t i = 0; i < chain.size(); ++i) {
      Vec2 a = chain[i], b = chain[(i + 1) % chain.size()];
      if (a.x > b.x) std::swap(a, b);
      if (b.x < low || a.x > high) continue;
      const auto at = [&](double z) {
        return a.x == b.x ? std::max(a.y, b.y)
                          : a.y + (std::clamp(z, a.x, b.x) - a.x) / (b.x - a.x) * (b.y - a.y);
      };
      if (std::max(at(low), at(high)) > radius) return true;
    }
  }
  return false;
}

/// What the tool touches.
struct TouchedBody {
  TurnedProfile profile;
  std::string name;  ///< empty: the workpiece
};

std::optional<TouchedBody> touched_by(const SceneContact& contact, const BodyWatch& watch,
                                      const TurnedProfile& workpiece) {
  const std::size_t fixtures = watch.fixtures() ? watch.fixtures()->size() : 0;
  if (contact.fixture && *contact.fixture >= fixtures) {
    const std::size_t body = *contact.fixture - fixtures;
    return TouchedBody{watch.held().profile(body), name_of(watch.held().kind(body))};
  }
  if (contact.has_workpiece) return TouchedBody{workpiece, {}};
  return std::nullopt;
}

}  // namespace

bool is_turned_shot(const FindingShot& shot) {
  if (!shot.stock || !shot.stock->turned()) return false;
  return !shot.cutter || !flat_tool(*shot.cutter).cutter.empty();
}

FindingView turned_finding_view(const FindingShot& shot, BodyWatch& watch) {
  FindingView view;
  view.standing = Standing::kInLathe;
  view.is_flat = true;
  view.tool_shape = watch.mount(shot.cutter, shot.nose_z_mm);
  watch.set_link_poses(shot.link_poses);
  view.contact = contact_of(shot.finding, watch.drawn());
  view.place_mm = view.tool_mm = view.axis_mm = shot.tool.tip_mm;
  view.axis = glm::normalize(shot.tool.axis);
  const Vec2 at_mm(shot.tool.tip_mm.z, shot.tool.tip_mm.x);
  const FlatTool& tool = watch.held().tool();
  const TurnedProfile workpiece = shot.stock->turned()->part().profile();
  Box whole = box_of(tool.cutter, at_mm);
  whole.extend(box_of(tool.holder, at_mm));
  whole.extend(shot.tool.tip_mm);
  std::optional<TouchedBody> other;
  if (view.contact) other = touched_by(*view.contact, watch, workpiece);
  const bool by_holder = view.contact && view.contact->piece == ToolPiece::kHolder;
  const TurnedProfile& part = by_holder ? tool.holder : tool.cutter;
  if (other) {
    if (const auto gap = gap_between(part, at_mm, other->profile))
      view.place_mm = {gap->at_mm.y, shot.tool.tip_mm.y, gap->at_mm.x};
    if (other->name.empty()) view.contact->point_mm = view.place_mm;
  }
  const Vec3 size = whole.size();
  const Vec3 about(std::clamp(kAboutOfTool * std::max(size.x, size.z), kLeastAboutTurned_mm,
                              kMostAboutTurned_mm));
  const Box near{view.place_mm - about, view.place_mm + about};
  view.frame_mm = common_of(near, whole);
  view.frame_mm.extend(view.place_mm);
  view.frame_mm.extend(common_of(near, shot.stock->bounds_mm()));
  if (view.contact && view.contact->piece) {
    view.tool_name = name_of(by_holder ? ToolPart::kHolder : ToolPart::kCutter);
    const Box shown = common_of(near, box_of(part, at_mm));
    if (!shown.empty()) {
      view.tool_mm = 0.5 * (shown.min + shown.max);
      view.tool_radius_mm = 0.5 * shown.size().z;
    }
  }
  if (other && !other->name.empty()) {
    const Box shown = common_of(near, box_of(other->profile));
    view.frame_mm.extend(shown);
    view.other_name = other->name;
    view.other_mm = shown.empty() ? view.place_mm : 0.5 * (shown.min + shown.max);
  }
  // The picture is flat: what lies before and behind the plane takes no room.
  view.frame_mm.min.y = view.frame_mm.max.y = 0;
  view.is_inside = is_covered(workpiece, view.place_mm);
  const Vec3 frame = view.frame_mm.size();
  const Vec3 close(std::max(kLeastCloseTurned_mm, kCloseOfFrame * std::max(frame.x, frame.z)));
  if (other) view.close_mm = {view.place_mm - close, view.place_mm + close};
  return view;
}

}  // namespace kerf
