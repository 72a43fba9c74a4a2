#include "stock/octree/tool_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/geometry.h"
#include "base/portable_math.h"
#include "base/translate.h"

namespace kerf::octree {
namespace {

/// Normals may turn back by this from element to element (rounding of tangent joints) and still
/// count as convex, rad.
constexpr double kAngleSlack_rad = 1e-9;
/// Pieces narrower than this are vertical, mm.
constexpr double kVertical_mm = 1e-9;

struct ChainLink {
  ToolElement element;
  double r0, z0, r1, z1;
};

double first_angle(const ToolElement& e) {
  return e.arc ? portable::atan2(e.n0z, e.n0r) : portable::atan2(e.nz, e.nr);
}
double last_angle(const ToolElement& e) {
  return e.arc ? portable::atan2(e.n1z, e.n1r) : portable::atan2(e.nz, e.nr);
}

ToolElement line_element(double nr, double nz, double offset) {
  ToolElement e;
  e.nr = nr;
  e.nz = nz;
  e.offset = offset;
  return e;
}

ChainLink line_link(double r0, double z0, double r1, double z1) {
  const double length = portable::hypot(r1 - r0, z1 - z0);
  const double nr = (z1 - z0) / length, nz = -(r1 - r0) / length;
  return {line_element(nr, nz, nr * r0 + nz * z0), r0, z0, r1, z1};
}

ChainLink arc_link(const ProfilePiece& p) {
  ToolElement e;
  e.arc = true;
  e.center_r = p.center_r;
  e.center_z = p.center_z;
  e.radius = p.radius;
  const auto unit = [&](double r, double z, double& nr, double& nz) {
    nr = (r - p.center_r) / p.radius;
    nz = (z - p.center_z) / p.radius;
    // Ends that are level or upright but for rounding are so exactly.
    if (std::abs(nr) < 1e-12) nr = 0;
    if (std::abs(nz) < 1e-12) nz = 0;
    const double length = portable::hypot(nr, nz);
    nr /= length;
    nz /= length;
  };
  unit(p.r0, p.z0, e.n0r, e.n0z);
  unit(p.r1, p.z1, e.n1r, e.n1z);
  return {e, p.r0, p.z0, p.r1, p.z1};
}

void append_hollow_arc(const ProfilePiece& arc, std::vector<ChainLink>& out) {
  const double a0 = portable::atan2(arc.z0 - arc.center_z, arc.r0 - arc.center_r);
  double a1 = portable::atan2(arc.z1 - arc.center_z, arc.r1 - arc.center_r);
  if (a1 - a0 > kPi) a1 -= 2 * kPi;
  if (a1 - a0 < -kPi) a1 += 2 * kPi;
  const double step = 2 * portable::acos(std::max(0.0, 1 - kHollowChord_mm / arc.radius));
  const int n = std::max(1, static_cast<int>(std::ceil(std::abs(a1 - a0) / step)));
  double r = arc.r0, z = arc.z0;
  for (int i = 1; i <= n; ++i) {
    const double a = a0 + (a1 - a0) * i / n;
    const double r_next = i == n ? arc.r1 : arc.center_r + arc.radius * portable::cos(a);
    const double z_next = i == n ? arc.z1 : arc.center_z + arc.radius * portable::sin(a);
    if (r_next - r > kVertical_mm) out.push_back(line_link(r, z, r_next, z_next));
    r = r_next;
    z = z_next;
  }
}

/// A profile without its vertical parts, which the walls of the bodies make.
std::vector<ChainLink> links_of(std::span<const ProfilePiece> profile) {
  std::vector<ChainLink> links;
  for (const ProfilePiece& p : profile) {
    if (p.r1 - p.r0 < kVertical_mm) continue;
    if (p.kind == ProfilePiece::Kind::kLine)
      links.push_back(line_link(p.r0, p.z0, p.r1, p.z1));
    else if (p.convex)
      links.push_back(arc_link(p));
    else
      append_hollow_arc(p, links);
  }
  return links;
}

/// A convex stretch of a profile, carried level to the axis: where all elements are negative, up to
/// `radius`.
struct Bowl {
  std::vector<ToolElement> elements;
  double radius = 0, low = 0;
};

/// Room is left for a wall, and for a second bowl on top.
constexpr std::size_t kMaxLinks = (ToolBody::kMaxElements - 1) / 2;

/// The profile as bowls: what is above any of them is above the profile.
std::vector<Bowl> bowls_of(std::span<const ProfilePiece> profile) {
  std::vector<Bowl> bowls;
  double end_z = 0;
  for (const ChainLink& link : links_of(profile)) {
    const bool connected =
        !bowls.empty() && std::abs(link.z0 - end_z) < 1e-9 &&
        first_angle(link.element) >= last_angle(bowls.back().elements.back()) - kAngleSlack_rad &&
        bowls.back().elements.size() < kMaxLinks;
    if (!connected) {
      bowls.emplace_back();
      bowls.back().low = link.z0;
      if (link.r0 > 0) bowls.back().elements.push_back(line_element(0, -1, -link.z0));
    }
    bowls.back().elements.push_back(link.element);
    bowls.back().radius = link.r1;
    end_z = link.z1;
  }
  return bowls;
}

/// Upside down, from the axis outward.
std::vector<ProfilePiece> turned_over(std::span<const ProfilePiece> upper) {
  std::vector<ProfilePiece> pieces;
  for (std::size_t i = upper.size(); i-- > 0;) {
    ProfilePiece p = upper[i];
    std::swap(p.r0, p.r1);
    std::swap(p.z0, p.z1);
    p.z0 = -p.z0;
    p.z1 = -p.z1;
    p.center_z = -p.center_z;
    pieces.push_back(p);
  }
  return pieces;
}

ToolElement turned_over(ToolElement e) {
  e.nz = -e.nz;
  e.center_z = -e.center_z;
  std::swap(e.n0r, e.n1r);
  std::swap(e.n0z, e.n1z);
  e.n0z = -e.n0z;
  e.n1z = -e.n1z;
  return e;
}

bool is_half_ball(const Bowl& bowl) {
  const ToolElement& e = bowl.elements.front();
  return bowl.elements.size() == 1 && e.arc && e.center_r == 0 && e.n0r == 0 && e.n1z == 0;
}

/// What is above `lower` and, if there is one, below `upper` (turned over).
ToolBody body_of(const Bowl& lower, const Bowl* upper) {
  ToolBody body;
  body.radius_mm = upper ? std::min(lower.radius, upper->radius) : lower.radius;
  body.low_mm = lower.low;
  for (const ToolElement& e : lower.elements) body.elements[body.count++] = e;
  // An arc that ends upright carries its own tangent up.
  const ToolElement& tail = lower.elements.back();
  if (!(tail.arc && tail.n1z == 0 && body.radius_mm == lower.radius))
    body.elements[body.count++] = line_element(1, 0, body.radius_mm);
  if (!upper) {
    if (is_half_ball(lower)) body.shape = ToolBody::Shape::kBall;
    return body;
  }
  body.endless = false;
  body.top_mm = -upper->low;
  for (const ToolElement& e : upper->elements) body.elements[body.count++] = turned_over(e);
  return body;
}

/// A lollipop's head: both sides are of one circle about the axis. The cap above the foot of the
/// neck is inside of the neck.
bool is_sphere(const Cutter& cutter, const std::vector<Bowl>& lower) {
  const std::span<const ProfilePiece> upper = cutter.upper_profile();
  if (upper.size() != 1 || lower.size() != 1 || !is_half_ball(lower[0])) return false;
  const ToolElement& e = lower[0].elements[0];
  return upper[0].kind == ProfilePiece::Kind::kArc && upper[0].convex && upper[0].center_r == 0 &&
         std::abs(upper[0].center_z - e.center_z) < 1e-9 &&
         std::abs(upper[0].radius - e.radius) < 1e-9;
}

ToolBody sphere(const Bowl& half) {
  ToolBody body = body_of(half, nullptr);
  body.shape = ToolBody::Shape::kSphere;
  body.endless = false;
  body.elements[0].n1r = 0;
  body.elements[0].n1z = 1;
  body.top_mm = body.elements[0].center_z + body.elements[0].radius;
  return body;
}

ToolBody neck(double radius_mm, double from_z_mm) {
  Bowl bowl;
  bowl.elements.push_back(line_element(0, -1, -from_z_mm));
  bowl.radius = radius_mm;
  bowl.low = from_z_mm;
  return body_of(bowl, nullptr);
}

}  // namespace

Result<std::vector<ToolBody>> tool_bodies(const Cutter& cutter) {
  for (const ProfilePiece& p : cutter.profile()) {
    const bool bulges_down =
        p.kind == ProfilePiece::Kind::kArc && p.convex && p.r0 < p.center_r - 1e-9;
    if (p.z1 < p.z0 - 1e-9 || bulges_down) {
      return Error{trf(
          "{} has a hollow bottom (its profile falls from radius {:.6g} outward); an octree cannot "
          "cut with it",
          cutter.spec(), p.r0)};
    }
  }
  const std::vector<Bowl> lower = bowls_of(cutter.profile());
  std::vector<ToolBody> bodies;
  if (!cutter.undercuts()) {
    for (const Bowl& bowl : lower) bodies.push_back(body_of(bowl, nullptr));
    return bodies;
  }
  if (is_sphere(cutter, lower)) {
    bodies.push_back(sphere(lower[0]));
  } else {
    const std::vector<Bowl> upper = bowls_of(turned_over(cutter.upper_profile()));
    for (const Bowl& below : lower)
      for (const Bowl& above : upper) bodies.push_back(body_of(below, &above));
  }
  // The neck begins inside of the head, so that no film is left between the two.
  bodies.push_back(neck(*cutter.neck_radius_mm(), cutter.profile().back().z1));
  return bodies;
}

}  // namespace kerf::octree
