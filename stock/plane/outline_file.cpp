#include "stock/plane/outline_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/atomic_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/plane/outline_arcs.h"
#include "stock/plane/polygon.h"

namespace kerf {
namespace {

Result<std::string> read_text(const std::string& path) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) return Error{path + ": " + std::strerror(ENOENT)};
  if (!std::filesystem::is_regular_file(status)) return Error{path + tr(": not a regular file")};
  const std::uintmax_t bytes = std::filesystem::file_size(path, code);
  if (!code && bytes > kMaxOutlineBytes) {
    return Error{trf("{}: {} bytes; at most {} are read", path, bytes, kMaxOutlineBytes)};
  }
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) return Error{trf("reading {}: {}", path, std::strerror(errno))};
  return text;
}

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

/// A part of a path; `corner` is the picture's upper left one.
void append_svg(const plane::Curve& curve, const Vec2& corner, fmt::memory_buffer& text) {
  const auto out = std::back_inserter(text);
  const auto place = [&corner](const Vec2& p) { return Vec2(p.x - corner.x, corner.y - p.y); };
  // Arcs of at most half a turn; the flag of those that are counter-clockwise is 0 there.
  const auto arc = [&](double radius, bool is_left, const Vec2& to) {
    fmt::format_to(out, "A{0:.4f} {0:.4f} 0 0 {1} {2:.4f} {3:.4f}\n", radius, is_left ? 0 : 1,
                   place(to).x, place(to).y);
  };
  if (curve.circle) {
    const auto [center, radius] = *curve.circle;
    const Vec2 right = center + Vec2(radius, 0), left = center - Vec2(radius, 0);
    fmt::format_to(out, "M{:.4f} {:.4f}\n", place(right).x, place(right).y);
    arc(radius, true, left);
    arc(radius, true, right);
  }
  for (std::size_t i = 0; i < curve.corners.size(); ++i) {
    const plane::CurveCorner& from = curve.corners[i];
    const Vec2& to = curve.corners[(i + 1) % curve.corners.size()].point_mm;
    const Vec2 at = place(from.point_mm);
    if (i == 0) fmt::format_to(out, "M{:.4f} {:.4f}\n", at.x, at.y);
    if (from.bulge != 0) {
      arc(from.radius_mm(to), from.bulge > 0, to);
    } else if (i + 1 < curve.corners.size()) {
      fmt::format_to(out, "L{:.4f} {:.4f}\n", place(to).x, place(to).y);
    }
  }
  fmt::format_to(out, "Z\n");
}

}  // namespace

OutlineFormat outline_format_of(const std::string& path) {
  return to_lower(path).ends_with(".svg") ? OutlineFormat::kSvg : OutlineFormat::kDxf;
}

Result<PlaneOutline> read_outline_file(const std::string& path, OutlineFormat format,
                                       double tolerance_mm, OutlineClosing closing) {
  const Result<std::string> text = read_text(path);
  if (!text) return Error{text.error()};
  Result<PlaneOutline> outline = format == OutlineFormat::kDxf
                                     ? parse_dxf_outline(*text, path, tolerance_mm, closing)
                                     : parse_svg_outline(*text, path, tolerance_mm);
  if (!outline) return outline;
  const Done done = check_outline(*outline);
  if (!done) return Error{fmt::format("{}: {}", path, done.error())};
  return outline;
}

Done write_outline_dxf(const PlaneOutline& outline, double arc_tolerance_mm,
                       const std::string& path) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "0\nSECTION\n2\nENTITIES\n");
  for (const plane::Curve& curve : plane::curves_of(outline, arc_tolerance_mm)) {
    if (curve.circle) {
      fmt::format_to(out, "0\nCIRCLE\n8\n0\n10\n{:.4f}\n20\n{:.4f}\n30\n0\n40\n{:.4f}\n",
                     curve.circle->center_mm.x, curve.circle->center_mm.y, curve.circle->radius_mm);
      continue;
    }
    fmt::format_to(out, "0\nPOLYLINE\n8\n0\n66\n1\n70\n1\n10\n0\n20\n0\n30\n0\n");
    for (const plane::CurveCorner& corner : curve.corners) {
      fmt::format_to(out, "0\nVERTEX\n8\n0\n10\n{:.4f}\n20\n{:.4f}\n30\n0\n", corner.point_mm.x,
                     corner.point_mm.y);
      if (corner.bulge != 0) fmt::format_to(out, "42\n{:.9f}\n", corner.bulge);
    }
    fmt::format_to(out, "0\nSEQEND\n8\n0\n");
  }
  fmt::format_to(out, "0\nENDSEC\n0\nEOF\n");
  return write_text(path, text);
}

Done write_outline_svg(const PlaneOutline& outline, double arc_tolerance_mm,
                       const std::string& path) {
  const Box box = bounds_of(outline);
  const Vec3 size = box.size();
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.4f}mm\" "
                 "height=\"{1:.4f}mm\" viewBox=\"0 0 {0:.4f} {1:.4f}\">\n"
                 "<path fill=\"#b8bcc2\" fill-rule=\"evenodd\" stroke=\"#303030\" "
                 "stroke-width=\"0.1\" d=\"",
                 std::max(size.x, 1e-4), std::max(size.y, 1e-4));
  const Vec2 corner(box.min.x, box.max.y);
  for (const plane::Curve& curve : plane::curves_of(outline, arc_tolerance_mm))
    append_svg(curve, corner, text);
  fmt::format_to(out, "\"/>\n</svg>\n");
  return write_text(path, text);
}

}  // namespace kerf
