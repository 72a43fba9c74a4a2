#include "stock/zmap/cutter_components.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/geometry.h"
#include "base/portable_math.h"
#include "base/translate.h"

namespace kerf {
namespace {

/// Slopes beyond this make single precision miss the promised height accuracy.
constexpr double kSteepForFloat = 15.0;
/// A slope may fall by this from piece to piece (rounding of tangent joints) and still count as
/// convex.
constexpr double kSlopeSlack = 1e-9;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double slope_at(const ToolPiece& p, double r) {
  if (!p.arc) return p.slope;
  const double y = r - p.center_r;
  const double q2 = p.radius * p.radius - y * y;
  return q2 > 1e-18 * p.radius * p.radius ? y / std::sqrt(q2) : kInfinity;
}

ToolPiece line_piece(double r0, double z0, double r1, double z1) {
  ToolPiece p;
  p.r0 = r0;
  p.r1 = r1;
  p.z0 = z0;
  p.slope = (z1 - z0) / (r1 - r0);
  return p;
}

void append_hollow_arc(const ProfilePiece& arc, std::vector<ToolPiece>& out) {
  const double a0 = portable::atan2(arc.z0 - arc.center_z, arc.r0 - arc.center_r);
  double a1 = portable::atan2(arc.z1 - arc.center_z, arc.r1 - arc.center_r);
  if (a1 - a0 > kPi) a1 -= 2 * kPi;
  if (a1 - a0 < -kPi) a1 += 2 * kPi;
  const double step = 2 * portable::acos(std::max(0.0, 1 - kProfileChord_mm / arc.radius));
  const int n = std::max(1, static_cast<int>(std::ceil(std::abs(a1 - a0) / step)));
  double r = arc.r0, z = arc.z0;
  for (int i = 1; i <= n; ++i) {
    const double a = a0 + (a1 - a0) * i / n;
    const double r_next = i == n ? arc.r1 : arc.center_r + arc.radius * portable::cos(a);
    const double z_next = i == n ? arc.z1 : arc.center_z + arc.radius * portable::sin(a);
    if (r_next - r > 1e-9) {
      out.push_back(line_piece(r, z, r_next, z_next));
      r = r_next;
      z = z_next;
    }
  }
}

/// The profile as lines and bulging arcs, without its vertical parts.
std::vector<ToolPiece> simple_pieces(std::span<const ProfilePiece> profile) {
  std::vector<ToolPiece> out;
  for (const ProfilePiece& piece : profile) {
    if (piece.r1 - piece.r0 < 1e-9) continue;
    if (piece.kind == ProfilePiece::Kind::kLine) {
      out.push_back(line_piece(piece.r0, piece.z0, piece.r1, piece.z1));
    } else if (!piece.convex) {
      append_hollow_arc(piece, out);
    } else {
      ToolPiece p;
      p.arc = true;
      p.r0 = piece.r0;
      p.r1 = piece.r1;
      p.center_r = piece.center_r;
      p.center_z = piece.center_z;
      p.radius = piece.radius;
      p.z0 = piece.z0;
      out.push_back(p);
    }
  }
  return out;
}

ConvexTool make_tool(const std::vector<ToolPiece>& chain) {
  ConvexTool tool;
  tool.radius = chain.back().r1;
  tool.piece_count = static_cast<int>(chain.size());
  std::copy(chain.begin(), chain.end(), tool.pieces);
  tool.wall_slope = slope_at(chain.back(), chain.back().r1);
  const ToolPiece& first = chain.front();
  tool.kind = ConvexTool::Kind::kPieces;
  if (chain.size() == 1 && !first.arc && first.slope == 0) {
    tool.kind = ConvexTool::Kind::kFlat;
    tool.base_z = first.z0;
  } else if (chain.size() == 1 && first.arc && std::abs(first.center_r) < 1e-12 &&
             std::abs(first.r1 - first.radius) < 1e-12) {
    tool.kind = ConvexTool::Kind::kBall;
    tool.base_z = first.center_z - first.radius;
  }
  for (const ToolPiece& p : chain)
    tool.needs_double |= p.arc ? p.center_r < 0 : p.slope > kSteepForFloat;
  return tool;
}

}  // namespace

std::vector<ConvexTool> convex_components(std::span<const ProfilePiece> profile) {
  std::vector<ConvexTool> tools;
  std::vector<ToolPiece> chain;
  double end_z = 0;
  for (const ToolPiece& piece : simple_pieces(profile)) {
    const bool connected =
        !chain.empty() && std::abs(piece.z0 - end_z) < 1e-9 &&
        slope_at(piece, piece.r0) >= slope_at(chain.back(), piece.r0) - kSlopeSlack &&
        chain.size() < ConvexTool::kMaxPieces;
    if (!connected && !chain.empty()) {
      tools.push_back(make_tool(chain));
      chain.clear();
    }
    if (chain.empty() && piece.r0 > 0) chain.push_back(line_piece(0, piece.z0, piece.r0, piece.z0));
    chain.push_back(piece);
    end_z = piece.arc
                ? piece.center_z - std::sqrt(std::max(0.0, piece.radius * piece.radius -
                                                               (piece.r1 - piece.center_r) *
                                                                   (piece.r1 - piece.center_r)))
                : piece.z0 + piece.slope * (piece.r1 - piece.r0);
  }
  tools.push_back(make_tool(chain));
  return tools;
}

Done check_bottom(const Cutter& cutter, const std::string& model) {
  for (const ProfilePiece& piece : cutter.profile()) {
    const bool bulges_down =
        piece.kind == ProfilePiece::Kind::kArc && piece.convex && piece.r0 < piece.center_r - 1e-9;
    if (piece.z1 < piece.z0 - 1e-9 || bulges_down) {
      return Error{
          trf("{} has a hollow bottom (its profile falls from radius {:.6g} outward); {} "
              "cannot cut with it",
              cutter.spec(), piece.r0, model)};
    }
  }
  return std::monostate{};
}

double surface_height(const ConvexTool& tool, double d) {
  if (tool.kind == ConvexTool::Kind::kFlat) return tool.base_z;
  const ToolPiece* piece = &tool.pieces[0];
  for (int i = 1; i < tool.piece_count; ++i)
    if (d >= tool.pieces[i].r0) piece = &tool.pieces[i];
  if (!piece->arc) return piece->z0 + piece->slope * (d - piece->r0);
  const double y = d - piece->center_r;
  return piece->center_z - std::sqrt(std::max(0.0, piece->radius * piece->radius - y * y));
}

}  // namespace kerf
