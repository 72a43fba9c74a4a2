#include "stock/turning/mesh_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/portable_math.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr int kSections = 6;
/// So that no corner is in the plane of a section.
constexpr double kFirstAngle = 0.123456789;
/// Triangles whose corners are no farther apart along Z are an end or a shoulder.
constexpr double kLevel_mm = 1e-3;

double radius_of(const Vec3& p) { return portable::hypot(p.x, p.y); }

/// The first place of an edge that is farther from the round surface than kFacet_mm.
std::optional<Vec3> misfit_of(const MeshBody& body) {
  for (const auto& triangle : body.mesh.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = Vec3(body.mesh.positions_mm[triangle[k]]);
    const auto [low, high] = std::minmax({p[0].z, p[1].z, p[2].z});
    if (high - low <= kLevel_mm) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = p[k], &b = p[(k + 1) % 3], middle = 0.5 * (a + b);
      if (std::abs(0.5 * (radius_of(a) + radius_of(b)) - radius_of(middle)) > kFacet_mm)
        return middle;
    }
  }
  return std::nullopt;
}

/// Chains of places where edges of the mesh go through a plane.
class Section {
 public:
  Section(const MeshBody& body, double angle)
      : body_(body), along_(portable::cos(angle), portable::sin(angle)) {}

  /// Empty: it is not closed.
  std::vector<std::vector<Vec2>> rings() {
    for (const auto& triangle : body_.mesh.triangles) add(triangle);
    std::vector<std::vector<Vec2>> out;
    while (!ways_.empty()) {
      std::vector<Vec2> ring;
      const std::uint64_t first = ways_.begin()->first;
      std::uint64_t edge = first;
      do {
        const auto way = ways_.find(edge);
        if (way == ways_.end()) return {};
        ring.push_back(place(edge));
        edge = way->second;
        ways_.erase(way);
      } while (edge != first);
      out.push_back(std::move(ring));
    }
    return out;
  }

 private:
  double side(std::uint32_t n) const {
    const glm::vec3& p = body_.mesh.positions_mm[n];
    return static_cast<double>(p.y) * along_.x - static_cast<double>(p.x) * along_.y;
  }
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
  }
  void add(const std::array<std::uint32_t, 3>& t) {
    std::optional<std::uint64_t> from, to;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if ((side(a) < 0) == (side(b) < 0)) continue;
      (side(a) < 0 ? from : to) = key(a, b);
    }
    // Each edge is left by one triangle and reached by the other.
    if (from && to) ways_.emplace(*from, *to);
  }
  /// Where the round surface through the edge's ends is.
  Vec2 place(std::uint64_t edge) const {
    const auto a = static_cast<std::uint32_t>(edge >> 32U), b = static_cast<std::uint32_t>(edge);
    const Vec3 p(body_.mesh.positions_mm[a]), q(body_.mesh.positions_mm[b]);
    const double t = side(a) / (side(a) - side(b));
    const Vec3 at = p + t * (q - p);
    const double radius = radius_of(p) + t * (radius_of(q) - radius_of(p));
    // Level edges go over an end: only their places count, not the round.
    const bool is_level = std::abs(p.z - q.z) <= kLevel_mm;
    const double out = at.x * along_.x + at.y * along_.y;
    const bool is_facet = radius - std::abs(out) <= kFacet_mm;
    return {at.z, is_level && !is_facet ? out : std::copysign(radius, out)};
  }

  const MeshBody& body_;
  Vec2 along_;
  std::unordered_map<std::uint64_t, std::uint64_t> ways_;
};

}  // namespace

Result<std::vector<PlaneOutline>> sections_of(const MeshBody& body, const std::string& name) {
  const std::string else_text =
      tr("profile:FILE.dxf has a lathe's blank as an outline, cylinder:0,0,Z0:Z1:DIAMETER as a "
         "bar");
  if (body.allowance_mm > 0) {
    return Error{trf("{}: an allowance is for blanks that are milled; {}", name, else_text)};
  }
  if (const std::optional<Vec3> at = misfit_of(body)) {
    return Error{
        trf("{}: does not turn about X0 Y0 along Z within {:g} mm: look at X{:.3f} "
            "Y{:.3f} Z{:.3f}; {}",
            name, kFacet_mm, at->x, at->y, at->z, else_text)};
  }
  std::vector<PlaneOutline> out;
  for (int n = 0; n < kSections; ++n) {
    PlaneOutline& outline = out.emplace_back();
    outline.rings = Section(body, kFirstAngle + n * kPi / kSections).rings();
    if (outline.rings.empty()) {
      return Error{trf("{}: parts of it touch or overlap; a lathe's blank must be one surface; {}",
                       name, else_text)};
    }
  }
  return out;
}

}  // namespace kerf
