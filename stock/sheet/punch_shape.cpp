#include "stock/sheet/punch_shape.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/portable_math.h"
#include "base/suggest.h"
#include "base/translate.h"
#include "stock/cutter/scan.h"
#include "stock/plane/outline_file.h"
#include "stock/sheet/kerf_contour.h"

namespace kerf {
namespace {

constexpr double kMinSize_mm = 0.1;
constexpr double kMaxSize_mm = 1000;
constexpr double kMinCorners = 3, kMaxCorners = 100;
constexpr std::array<std::string_view, 7> kKinds = {"round",   "square", "rectangle", "obround",
                                                    "polygon", "dxf",    "svg"};

using Fields = std::vector<std::string_view>;

Result<double> size_of(std::string_view name, std::string_view text) {
  return parse_within(name, trim(text), kMinSize_mm, kMaxSize_mm, "mm");
}

Done check_count(const Fields& fields, std::size_t count, std::string_view form) {
  if (fields.size() == count) return std::monostate{};
  return Error{trf("{} {} after '{}'; the form is {}", fields.size() - 1,
                   fields.size() == 2 ? "value" : "values", to_lower(trim(fields[0])), form)};
}

PlaneOutline rectangle(double a, double b) {
  return rectangle_outline({-a / 2, -b / 2}, {a / 2, b / 2});
}

Vec2 direction(double angle_rad) { return {portable::cos(angle_rad), portable::sin(angle_rad)}; }

/// Both ends lie on the circle, where straight edges go on; the corners between them so far outside
/// that the polygon has the area of the half disc: with n triangles of angle a,
///     sin a ((n - 2) c^2 + 2 c r) / 2 = pi r^2 / 2
void append_half_circle(const Vec2& center, double r, double from_rad, double tolerance_mm,
                        std::vector<Vec2>& ring) {
  const int n = sheet::CirclePolygon::within(r, tolerance_mm).count / 2;
  const double a = kPi / n;
  const double c = r * (std::sqrt(1 + (n - 2) * kPi / portable::sin(a)) - 1) / (n - 2);
  for (int i = 0; i <= n; ++i) {
    ring.push_back(center + (i == 0 || i == n ? r : c) * direction(from_rad + i * a));
  }
}

Result<PlaneOutline> parse_round(const Fields& fields, double tolerance_mm) {
  const Done count = check_count(fields, 2, "round:D");
  if (!count) return Error{count.error()};
  const Result<double> d = size_of("diameter D", fields[1]);
  if (!d) return Error{d.error()};
  const auto polygon = sheet::CirclePolygon::within(*d / 2, tolerance_mm);
  PlaneOutline shape;
  std::vector<Vec2>& ring = shape.rings.emplace_back();
  for (int i = 0; i < polygon.count; ++i) {
    ring.push_back(polygon.corner_mm * direction(2 * kPi * i / polygon.count));
  }
  return shape;
}

Result<PlaneOutline> parse_square(const Fields& fields) {
  const Done count = check_count(fields, 2, "square:A");
  if (!count) return Error{count.error()};
  const Result<double> a = size_of("edge A", fields[1]);
  if (!a) return Error{a.error()};
  return rectangle(*a, *a);
}

Result<PlaneOutline> parse_two_edges(const Fields& fields, bool round, double tolerance_mm) {
  const Done count = check_count(fields, 3, round ? "obround:A:B" : "rectangle:A:B");
  if (!count) return Error{count.error()};
  const Result<double> a = size_of("length A", fields[1]);
  if (!a) return Error{a.error()};
  const Result<double> b = size_of("length B", fields[2]);
  if (!b) return Error{b.error()};
  if (!round) return rectangle(*a, *b);
  const double radius = std::min(*a, *b) / 2, reach = std::max(*a, *b) / 2 - radius;
  const double turned = *a < *b ? kPi / 2 : 0;
  const Vec2 end = reach * Vec2(*a < *b ? 0 : 1, *a < *b ? 1 : 0);
  PlaneOutline shape;
  std::vector<Vec2>& ring = shape.rings.emplace_back();
  for (const double side : {0.0, kPi}) {
    const Vec2 center = side == 0 ? end : -end;
    const double from = turned + side - kPi / 2;
    append_half_circle(center, radius, from, tolerance_mm, ring);
  }
  return shape;
}

Result<PlaneOutline> parse_polygon(const Fields& fields) {
  const Done count = check_count(fields, 3, "polygon:N:D");
  if (!count) return Error{count.error()};
  const Result<double> n =
      parse_within(tr("corners N"), trim(fields[1]), kMinCorners, kMaxCorners, tr("whole number"));
  if (!n) return Error{n.error()};
  if (*n != std::floor(*n)) {
    return Error{trf("corners N: {} is not a whole number", shown(trim(fields[1])))};
  }
  const Result<double> d = size_of("diameter D", fields[2]);
  if (!d) return Error{d.error()};
  PlaneOutline shape;
  std::vector<Vec2>& ring = shape.rings.emplace_back();
  for (int i = 0; i < static_cast<int>(*n); ++i) {
    const double angle = 2 * kPi * i / *n;
    ring.push_back(*d / 2 * Vec2(portable::cos(angle), portable::sin(angle)));
  }
  return shape;
}

Result<PlaneOutline> parse_fields(std::string_view spec, double tolerance_mm) {
  const Fields fields = split(spec, ':');
  const std::string kind = to_lower(trim(fields[0]));
  if (kind == "round") return parse_round(fields, tolerance_mm);
  if (kind == "square") return parse_square(fields);
  if (kind == "rectangle") return parse_two_edges(fields, false, tolerance_mm);
  if (kind == "obround") return parse_two_edges(fields, true, tolerance_mm);
  if (kind == "polygon") return parse_polygon(fields);
  if (kind == "dxf" || kind == "svg") {
    // A file name may hold colons.
    const std::string file(trim(spec.substr(std::min(spec.size(), spec.find(':') + 1))));
    if (fields.size() < 2 || file.empty())
      return Error{trf("the file name is missing; the form is {}:FILE", kind)};
    return read_outline_file(file, kind == "dxf" ? OutlineFormat::kDxf : OutlineFormat::kSvg,
                             tolerance_mm);
  }
  return Error{trf("unknown shape '{}'{} Forms:\n{}", shown(kind), did_you_mean(kind, kKinds),
                   punch_shape_help())};
}

}  // namespace

Result<PlaneOutline> parse_punch_shape(std::string_view spec, double tolerance_mm) {
  spec = trim(spec);
  if (spec.empty()) return Error{trf("no shape is given; forms:\n{}", punch_shape_help())};
  Result<PlaneOutline> shape = parse_fields(spec, tolerance_mm);
  if (!shape) return Error{fmt::format("{}: {}", shown(spec), shape.error())};
  return shape;
}

std::string_view punch_shape_help() {
  return tr(
      "round:D          diameter D\n"
      "square:A         edge A\n"
      "rectangle:A:B    edges A along x, B along y\n"
      "obround:A:B      A x B over all, round at the ends of the longer one\n"
      "polygon:N:D      N corners, D across them\n"
      "dxf:FILE         closed contours of a drawing\n"
      "svg:FILE         closed contours of a picture\n");
}

}  // namespace kerf
