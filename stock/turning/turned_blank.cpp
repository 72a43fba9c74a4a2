#include "stock/turning/turned_blank.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/portable_math.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/plane/outline_file.h"
#include "stock/turning/mesh_profile.h"

namespace kerf {
namespace {

using turning::Point;
using turning::Rings;

/// What is nearer to the axis is on it.
constexpr double kOnAxis_mm = 1e-6;

std::string number_of(double mm) { return number_text(std::round(mm * 1e4) / 1e4); }

std::string spec_of(const BlankBody& body) {
  Blank alone;
  alone.bodies.push_back(body);
  return describe(alone);
}

/// Why a lathe does not turn it about Z; empty: it does.
std::string fault_of(const BlankBody& body) {
  if (body.kind == BlankBody::Kind::kBox) {
    return tr(
        "a lathe turns no box; cylinder:0,0,z0:z1:d, tube:0,0,z0:z1:d:inner, hex:0,0,z0:z1:FLATS "
        "and square:0,0,z0:z1:FLATS are what it holds");
  }
  if (body.axis != 'z')
    return trf("it lies along {}; on a lathe it turns about Z", to_upper(body.axis));
  if (portable::hypot(body.center_mm.x, body.center_mm.y) > kOnAxis_mm) {
    return trf("its axis is at X{} Y{}; on a lathe it turns about X0 Y0",
               number_of(body.center_mm.x), number_of(body.center_mm.y));
  }
  return {};
}

double outer_radius_mm(const BlankBody& body) {
  const double half = body.diameter_mm / 2;
  return body.kind == BlankBody::Kind::kBar ? half / portable::cos(kPi / body.flats) : half;
}

std::vector<Vec2> ring_of(const BlankBody& body) {
  const double low = body.bounds_mm.min.z, high = body.bounds_mm.max.z;
  const double inner = body.kind == BlankBody::Kind::kTube ? body.inner_diameter_mm / 2 : 0;
  const double outer = outer_radius_mm(body);
  return {{low, inner}, {high, inner}, {high, outer}, {low, outer}};
}

/// Nothing lies so far out that the grid does not hold it.
std::string reach_fault(const TurnedProfile& profile) {
  for (const std::vector<Vec2>& ring : profile) {
    for (const Vec2& p : ring) {
      if (std::abs(p.x) > kMaxTurnedZ_mm || !std::isfinite(p.x))
        return trf("it reaches Z{}; must be within {} mm of Z0", number_of(p.x), kMaxTurnedZ_mm);
      if (std::abs(p.y) > kMaxTurnedRadius_mm || !std::isfinite(p.y))
        return trf("its radius is {} mm; must be at most {} mm", number_of(std::abs(p.y)),
                   kMaxTurnedRadius_mm);
    }
  }
  return {};
}

Rings units_of(const TurnedProfile& profile) {
  Rings rings;
  for (const std::vector<Vec2>& ring : profile) {
    turning::Ring& points = rings.emplace_back();
    for (const Vec2& p : ring) points.push_back(turning::to_units(p));
  }
  return rings;
}

TurnedProfile profile_of(const Rings& rings) {
  TurnedProfile profile;
  for (const turning::Ring& ring : rings) {
    std::vector<Vec2>& points = profile.emplace_back();
    for (const Point& p : ring) points.push_back(turning::to_mm(p));
  }
  return profile;
}

Rings clipped(const Rings& subject, ClipperLib::ClipType type, const Rings& clip,
              ClipperLib::PolyFillType fill) {
  ClipperLib::Clipper clipper;
  clipper.AddPaths(subject, ClipperLib::ptSubject, true);
  clipper.AddPaths(clip, ClipperLib::ptClip, true);
  Rings result;
  clipper.Execute(type, result, fill, ClipperLib::pftNonZero);
  return result;
}

/// What lies above the axis of rings that are even-odd.
Rings above_axis(const Rings& rings) {
  const turning::Unit z = turning::to_units(kMaxTurnedZ_mm + 1),
                      r = turning::to_units(kMaxTurnedRadius_mm + 1);
  const Rings half{{{-z, 0}, {z, 0}, {z, r}, {-z, r}}};
  return clipped(rings, ClipperLib::ctIntersection, half, ClipperLib::pftEvenOdd);
}

/// Where the two are apart by more than kHalves_mm on the average of a piece that one has and the
/// other has not.
std::optional<Vec2> difference_of(const Rings& a, const Rings& b) {
  for (const turning::Ring& ring : clipped(a, ClipperLib::ctXor, b, ClipperLib::pftNonZero)) {
    double around = 0, area2 = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 p = turning::to_mm(ring[i]), q = turning::to_mm(ring[(i + 1) % ring.size()]);
      around += portable::hypot(q.x - p.x, q.y - p.y);
      area2 += p.x * q.y - q.x * p.y;
    }
    if (std::abs(area2) > kHalves_mm * around) return turning::to_mm(ring.front());
  }
  return std::nullopt;
}

Error halves_differ(const std::string& path, const Vec2& at) {
  return Error{
      trf("{}: the halves above and below the axis differ at X{} Y{}; draw the upper half alone, "
          "or both equal",
          path, number_of(at.x), number_of(at.y))};
}

/// How many pieces that lie apart.
std::size_t piece_count(const TurnedProfile& profile) {
  std::size_t pieces = 0;
  for (const turning::Ring& ring :
       clipped(units_of(profile), ClipperLib::ctUnion, {}, ClipperLib::pftEvenOdd)) {
    if (plane::twice_area(ring) > 0) ++pieces;
  }
  return pieces;
}

struct TurnedBlank {
  TurnedProfile profile;
  std::optional<BarFlats> flats;
};

Result<TurnedBlank> blank_of_bodies(const std::vector<BlankBody>& bodies) {
  TurnedBlank blank;
  TurnedProfile all;
  for (const BlankBody& body : bodies) {
    if (const std::string fault = fault_of(body); !fault.empty())
      return Error{fmt::format("{}: {}", spec_of(body), fault)};
    const std::vector<Vec2> ring = ring_of(body);
    if (const std::string fault = reach_fault({ring}); !fault.empty())
      return Error{fmt::format("{}: {}", spec_of(body), fault)};
    all.push_back(ring);
    if (body.kind != BlankBody::Kind::kBar) continue;
    const BarFlats flats{body.flats, body.diameter_mm / 2};
    if (blank.flats && !(*blank.flats == flats))
      return Error{trf("{}: there is another bar of flats already", spec_of(body))};
    blank.flats = flats;
  }
  for (const BlankBody& body : bodies) {
    if (blank.flats && body.kind != BlankBody::Kind::kBar &&
        body.diameter_mm / 2 > blank.flats->inner_radius_mm) {
      return Error{trf("{}: beside a bar of flats nothing may reach beyond these, diameter {} mm",
                       spec_of(body), number_of(2 * blank.flats->inner_radius_mm))};
    }
  }
  blank.profile =
      profile_of(clipped(units_of(all), ClipperLib::ctUnion, {}, ClipperLib::pftNonZero));
  if (const std::size_t pieces = piece_count(blank.profile); pieces != 1)
    return Error{trf("the bodies lie apart, in {} pieces; must be one", pieces)};
  return blank;
}

/// Sections in all directions are the same.
Result<TurnedProfile> profile_of_mesh(const MeshBody& body, const std::string& name) {
  const Result<std::vector<PlaneOutline>> sections = sections_of(body, name);
  if (!sections) return Error{sections.error()};
  TurnedProfile first;
  for (const PlaneOutline& section : *sections) {
    if (const std::string fault = reach_fault(section.rings); !fault.empty())
      return Error{fmt::format("{}: {}", name, fault)};
    Result<TurnedProfile> profile = profile_of_outline(section, name);
    if (!profile) {
      return Error{
          trf("{}: does not turn about X0 Y0 along Z in one piece; :at=x,y,z and :rotate= "
              "place it on the axis",
              name)};
    }
    if (first.empty()) first = *profile;
    if (const auto at = difference_of(units_of(first), units_of(*profile))) {
      return Error{
          trf("{}: does not turn about X0 Y0 along Z: sections through the axis differ at "
              "Z{} and the radius {}",
              name, number_of(at->x), number_of(at->y))};
    }
  }
  return first;
}

Result<TurnedBlank> turned_blank_of(const Blank& blank) {
  if (!blank.state_file.empty() || blank.sheet)
    return Error{trf("{}: is no bar that a lathe could turn", describe(blank))};
  if (blank.mesh && blank.mesh->body) {
    Result<TurnedProfile> profile = profile_of_mesh(*blank.mesh->body, blank.mesh->file);
    if (!profile) return Error{profile.error()};
    return TurnedBlank{std::move(profile.value()), std::nullopt};
  }
  if (blank.profile_file.empty()) return blank_of_bodies(blank.bodies);
  Result<TurnedProfile> profile = read_profile(blank.profile_file);
  if (!profile) return Error{profile.error()};
  return TurnedBlank{std::move(profile.value()), std::nullopt};
}

}  // namespace

Result<TurnedProfile> read_profile(const std::string& path) {
  Result<PlaneOutline> outline = read_outline_file(
      path, outline_format_of(path), kProfileTolerance_mm, OutlineClosing::kAlongAxis);
  if (!outline) return Error{outline.error()};
  return profile_of_outline(*outline, path);
}

Result<TurnedProfile> profile_of_outline(const PlaneOutline& outline, const std::string& name) {
  if (const std::string fault = reach_fault(outline.rings); !fault.empty())
    return Error{fmt::format("{}: {}", name, fault)};
  Rings rings = units_of(outline.rings);
  const Rings upper = above_axis(rings);
  for (turning::Ring& ring : rings) {
    for (Point& p : ring) p.Y = -p.Y;
  }
  const Rings lower = above_axis(rings);
  if (upper.empty())
    return Error{trf("{}: nothing lies above the axis, which is Y0 of the drawing", name)};
  if (!lower.empty()) {
    if (const std::optional<Vec2> at = difference_of(upper, lower)) return halves_differ(name, *at);
  }
  TurnedProfile profile = profile_of(upper);
  if (const std::size_t pieces = piece_count(profile); pieces != 1)
    return Error{trf("{}: the contours lie apart, in {} pieces; must be one", name, pieces)};
  return profile;
}

Result<TurnedProfile> turned_profile_of(const Blank& blank) {
  Result<TurnedBlank> turned = turned_blank_of(blank);
  if (!turned) return Error{turned.error()};
  return std::move(turned->profile);
}

Result<std::unique_ptr<TurningStock>> turning_stock_of(const Blank& blank, ChuckSide chuck) {
  const Result<TurnedBlank> turned = turned_blank_of(blank);
  if (!turned) return Error{turned.error()};
  std::optional<TurnedPart> part = TurnedPart::create(turned->profile, chuck, turned->flats);
  // Refused above with the reason, but for less than the grid holds.
  if (!part) return Error{trf("{}: there is nothing to turn", describe(blank))};
  return std::make_unique<TurningStock>(std::move(*part));
}

}  // namespace kerf
