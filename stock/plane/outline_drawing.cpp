#include "stock/plane/outline_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/atomic_file.h"
#include "stock/plane/outline_file.h"

namespace kerf {
namespace {

constexpr double kNoteHeight_mm = 2.5;  // ISO 3098

Done write_text(const std::string& path, const fmt::memory_buffer& text) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};
  file->write(text.data(), text.size());
  return file->commit();
}

Box bounds_of(const PlaneOutline& outline) {
  Box box;
  for (const std::vector<Vec2>& ring : outline.rings) {
    for (const Vec2& p : ring) box.extend(Vec3(p, 0));
  }
  if (box.empty()) box.extend(Vec3(0));
  return box;
}

/// Numbers of -0 are 0: others compare files.
double plain(double value, int digits) {
  return std::abs(value) < 0.5 * std::pow(10.0, -digits) ? 0.0 : value;
}

/// Paths of an SVG, one part a curve.
class SvgPaths {
 public:
  SvgPaths(const plane::DrawingStyle& style, fmt::memory_buffer& text)
      : style_(style), out_(std::back_inserter(text)) {}

  void append(const plane::Curve& curve) {
    if (curve.circle) {
      const auto [center, radius] = *curve.circle;
      const Vec2 right = center + Vec2(radius, 0), left = center - Vec2(radius, 0);
      point("M", right);
      arc(radius, true, left);
      arc(radius, true, right);
    }
    for (std::size_t i = 0; i < curve.corners.size(); ++i) {
      const plane::CurveCorner& from = curve.corners[i];
      const Vec2& to = curve.corners[(i + 1) % curve.corners.size()].point_mm;
      if (i == 0) point("M", from.point_mm);
      if (from.bulge != 0) {
        arc(from.radius_mm(to), from.bulge > 0, to);
      } else if (i + 1 < curve.corners.size()) {
        point("L", to);
      }
    }
    fmt::format_to(out_, "Z\n");
  }
  Vec2 place(const Vec2& p) const {
    return {plain(style_.keeps_x ? p.x : p.x - style_.low_mm.x, style_.digits),
            plain(style_.high_mm.y - p.y, style_.digits)};
  }

 private:
  void point(std::string_view command, const Vec2& p) {
    const Vec2 at = place(p);
    fmt::format_to(out_, "{}{:.{}f} {:.{}f}\n", command, at.x, style_.digits, at.y, style_.digits);
  }
  /// Of at most half a turn; the flag of those that are counter-clockwise is 0 there.
  void arc(double radius, bool is_left, const Vec2& to) {
    fmt::format_to(out_, "A{0:.{1}f} {0:.{1}f} 0 0 {2} ", radius, style_.digits, is_left ? 0 : 1);
    point("", to);
  }

  const plane::DrawingStyle& style_;
  std::back_insert_iterator<fmt::memory_buffer> out_;
};

}  // namespace

Done plane::write_curves_dxf(const std::vector<Curve>& curves, const DrawingStyle& style,
                             const std::string& path) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  const int digits = style.digits;
  const auto point = [&](int code, const Vec2& p) {
    fmt::format_to(out, "{}\n{:.{}f}\n{}\n{:.{}f}\n{}\n0\n", code, plain(p.x, digits), digits,
                   code + 10, plain(p.y, digits), digits, code + 20);
  };
  fmt::format_to(out, "0\nSECTION\n2\nENTITIES\n");
  for (const Curve& curve : curves) {
    if (curve.circle) {
      fmt::format_to(out, "0\nCIRCLE\n8\n{}\n", style.layer);
      point(10, curve.circle->center_mm);
      fmt::format_to(out, "40\n{:.{}f}\n", curve.circle->radius_mm, digits);
      continue;
    }
    fmt::format_to(out, "0\nPOLYLINE\n8\n{}\n66\n1\n70\n1\n10\n0\n20\n0\n30\n0\n", style.layer);
    for (const CurveCorner& corner : curve.corners) {
      fmt::format_to(out, "0\nVERTEX\n8\n{}\n", style.layer);
      point(10, corner.point_mm);
      if (corner.bulge != 0) fmt::format_to(out, "42\n{:.{}f}\n", corner.bulge, digits + 5);
    }
    fmt::format_to(out, "0\nSEQEND\n8\n{}\n", style.layer);
  }
  if (style.centre_line) {
    fmt::format_to(out, "0\nLINE\n8\nCENTER\n");
    point(10, style.centre_line->first);
    point(11, style.centre_line->second);
  }
  for (const auto& [from, to] : style.flats) {
    fmt::format_to(out, "0\nLINE\n8\nFLATS\n6\nDASHED\n");
    point(10, from);
    point(11, to);
    fmt::format_to(out, "0\nTEXT\n8\nFLATS\n");
    point(10, from);
    fmt::format_to(out, "40\n{}\n1\n{}\n", kNoteHeight_mm, style.flats_note);
  }
  fmt::format_to(out, "0\nENDSEC\n0\nEOF\n");
  return write_text(path, text);
}

Done plane::write_curves_svg(const std::vector<Curve>& curves, const DrawingStyle& style,
                             const std::string& path) {
  const Vec2 size = style.high_mm - style.low_mm;
  const double least = std::pow(10.0, -style.digits);
  const int digits = style.digits;
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  SvgPaths paths(style, text);
  const std::string left =
      style.keeps_x ? fmt::format("{:.{}f}", plain(style.low_mm.x, digits), digits) : "0";
  fmt::format_to(out,
                 "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.{2}f}mm\" "
                 "height=\"{1:.{2}f}mm\" viewBox=\"{3} 0 {0:.{2}f} {1:.{2}f}\">\n"
                 "<path fill=\"#b8bcc2\" fill-rule=\"evenodd\" stroke=\"#303030\" "
                 "stroke-width=\"0.1\" d=\"",
                 std::max(size.x, least), std::max(size.y, least), digits, left);
  for (const Curve& curve : curves) paths.append(curve);
  fmt::format_to(out, "\"/>\n");
  const auto line = [&](std::string_view kind, const std::pair<Vec2, Vec2>& ends,
                        std::string_view dashes, const std::string& title) {
    const Vec2 a = paths.place(ends.first), b = paths.place(ends.second);
    fmt::format_to(out,
                   "<line class=\"{}\" x1=\"{:.{}f}\" y1=\"{:.{}f}\" x2=\"{:.{}f}\" "
                   "y2=\"{:.{}f}\" stroke=\"#303030\" stroke-width=\"0.1\" "
                   "stroke-dasharray=\"{}\"",
                   kind, a.x, digits, a.y, digits, b.x, digits, b.y, digits, dashes);
    if (title.empty()) {
      fmt::format_to(out, "/>\n");
    } else {
      fmt::format_to(out, "><title>{}</title></line>\n", title);
    }
  };
  if (style.centre_line) line("axis", *style.centre_line, "4 1 0.5 1", "");
  for (const auto& ends : style.flats) line("flats", ends, "2 1", style.flats_note);
  fmt::format_to(out, "</svg>\n");
  return write_text(path, text);
}

Done write_outline_dxf(const PlaneOutline& outline, double arc_tolerance_mm,
                       const std::string& path) {
  return plane::write_curves_dxf(plane::curves_of(outline, arc_tolerance_mm), {}, path);
}

Done write_outline_svg(const PlaneOutline& outline, double arc_tolerance_mm,
                       const std::string& path) {
  const Box box = bounds_of(outline);
  plane::DrawingStyle style;
  style.low_mm = Vec2(box.min);
  style.high_mm = Vec2(box.max);
  return plane::write_curves_svg(plane::curves_of(outline, arc_tolerance_mm), style, path);
}

}  // namespace kerf
