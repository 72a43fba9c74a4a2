#include "twin/scene/held_bodies.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "base/translate.h"
#include "stock/turning/turning_stock.h"
#include "twin/scene/tool_shape.h"

namespace kerf {
namespace {

/// Bluish as fixtures are, and as clear; what turns is a little darker.
constexpr std::uint32_t kHeldColor = 0xa09c8060;
/// Of the facets of what is round.
constexpr double kRound_mm = 0.05;

/// Calls each(from, to) for the edges.
template <class Each>
void each_edge(const TurnedProfile& chains, const Each& each) {
  for (const std::vector<Vec2>& chain : chains) {
    for (std::size_t i = 0; i < chain.size(); ++i) each(chain[i], chain[(i + 1) % chain.size()]);
  }
}

Vec2 nearest_on(const Vec2& a, const Vec2& b, const Vec2& p) {
  const Vec2 way = b - a;
  const double length2 = glm::dot(way, way);
  if (length2 == 0) return a;
  return a + std::clamp(glm::dot(p - a, way) / length2, 0.0, 1.0) * way;
}

bool encloses(const TurnedProfile& chains, const Vec2& p) {
  bool is_in = false;
  each_edge(chains, [&](const Vec2& a, const Vec2& b) {
    if ((a.y > p.y) == (b.y > p.y)) return;
    if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) is_in = !is_in;
  });
  return is_in;
}

bool cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto side = [](const Vec2& p, const Vec2& q, const Vec2& r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  };
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

/// From the corners of one to the edges of the other; `gap` keeps what is nearer, or deeper.
void add_corners(const TurnedProfile& corners, const TurnedProfile& other, FlatGap& gap) {
  for (const std::vector<Vec2>& chain : corners) {
    for (const Vec2& corner : chain) {
      double least = std::numeric_limits<double>::infinity();
      Vec2 nearest = corner;
      each_edge(other, [&](const Vec2& a, const Vec2& b) {
        const Vec2 on = nearest_on(a, b, corner);
        const double mm = glm::distance(on, corner);
        if (mm >= least) return;
        least = mm;
        nearest = on;
      });
      if (encloses(other, corner)) {
        gap.mm = 0;
        if (least <= gap.depth_mm) continue;
        gap.depth_mm = least;
        gap.at_mm = corner;
      } else if (least < gap.mm) {
        gap.mm = least;
        gap.at_mm = 0.5 * (corner + nearest);
      }
    }
  }
}

/// Edges that cross without a corner in the other: as deep as the nearer corner is outside.
void add_crossings(const TurnedProfile& one, const TurnedProfile& other, FlatGap& gap) {
  if (gap.mm == 0) return;
  each_edge(one, [&](const Vec2& a, const Vec2& b) {
    each_edge(other, [&](const Vec2& c, const Vec2& d) {
      if (!cross(a, b, c, d)) return;
      gap.depth_mm = std::max(gap.depth_mm, gap.mm);
      gap.mm = 0;
      gap.at_mm = nearest_on(a, b, 0.5 * (c + d));
    });
  });
}

}  // namespace

std::string name_of(HoldingBody::Kind kind) {
  switch (kind) {
    case HoldingBody::Kind::kChuck:
      return tr("chuck");
    case HoldingBody::Kind::kJaws:
      return tr("jaws");
    case HoldingBody::Kind::kTailstock:
      break;
  }
  return tr("tailstock");
}

std::vector<MachineLink> held_links(const HoldingList& held_by) {
  std::vector<MachineLink> links;
  if (!held_by) return links;
  for (const HoldingBody& body : *held_by) {
    const TurnedPart ring = body.ring;  // of this thread
    links.push_back({to_string(body.kind),
                     std::make_shared<const TriangleMesh>(ring.mesh(kRound_mm)), kHeldColor});
  }
  return links;
}

std::vector<PictureBody> picture_bodies(const HoldingList& held_by) {
  std::vector<PictureBody> bodies;
  for (const MachineLink& link : held_links(held_by))
    bodies.push_back({link.mesh, glm::mat4(1.0f), link.color});
  return bodies;
}

FlatTool flat_tool(const Cutter& cutter) {
  FlatTool tool;
  if (cutter.live()) return tool;
  const std::shared_ptr<const InsertOutline> outline = turning_outline(cutter);
  if (!outline) return tool;
  for (const InsertPart& part : outline->parts) {
    const ToolPlate plate = plate_of(part);
    std::vector<Vec2> chain;
    for (const ToolPlate::Corner& corner : plate.corners) chain.emplace_back(corner.zx_mm);
    (plate.is_holder ? tool.holder : tool.cutter).push_back(std::move(chain));
  }
  return tool;
}

std::optional<FlatGap> gap_between(const TurnedProfile& tool, const Vec2& at_mm,
                                   const TurnedProfile& body) {
  if (tool.empty() || body.empty()) return std::nullopt;
  TurnedProfile placed = tool;
  for (std::vector<Vec2>& chain : placed)
    for (Vec2& corner : chain) corner += at_mm;
  // On the other side of the axis the body is as on this one.
  FlatGap least;
  for (const double side : {1.0, -1.0}) {
    TurnedProfile seen = body;
    for (std::vector<Vec2>& chain : seen)
      for (Vec2& corner : chain) corner.y *= side;
    FlatGap gap;
    gap.mm = std::numeric_limits<double>::infinity();
    // Each part of the tool by itself: they may lie in each other.
    for (const std::vector<Vec2>& chain : placed) {
      const TurnedProfile part{chain};
      add_corners(part, seen, gap);
      add_corners(seen, part, gap);
      add_crossings(part, seen, gap);
    }
    if (side > 0 || gap.mm < least.mm || gap.depth_mm > least.depth_mm) least = gap;
  }
  return least;
}

HeldWatch::HeldWatch(const HoldingList& held_by) {
  if (!held_by) return;
  for (const HoldingBody& body : *held_by) {
    const TurnedPart ring = body.ring;  // of this thread
    bodies_.push_back({body.kind, ring.profile()});
  }
}

void HeldWatch::mount(const Cutter* cutter) { tool_ = cutter ? flat_tool(*cutter) : FlatTool{}; }

}  // namespace kerf
