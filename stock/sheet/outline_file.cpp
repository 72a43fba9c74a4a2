#include "stock/sheet/outline_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/atomic_file.h"
#include "stock/sheet/polygon.h"

namespace kerf {
namespace {

Result<std::string> read_text(const std::string& path) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) return Error{path + ": " + std::strerror(ENOENT)};
  if (!std::filesystem::is_regular_file(status)) return Error{path + ": not a regular file"};
  const std::uintmax_t bytes = std::filesystem::file_size(path, code);
  if (!code && bytes > kMaxOutlineBytes) {
    return Error{fmt::format("{}: {} bytes; at most {} are read", path, bytes, kMaxOutlineBytes)};
  }
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) return Error{fmt::format("reading {}: {}", path, std::strerror(errno))};
  return text;
}

Done write_text(const std::string& path, const fmt::memory_buffer& text) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};
  file->write(text.data(), text.size());
  return file->commit();
}

Box bounds_of(const SheetOutline& outline) {
  Box box;
  for (const std::vector<Vec2>& ring : outline.rings) {
    for (const Vec2& p : ring) box.extend(Vec3(p, 0));
  }
  if (box.empty()) box.extend(Vec3(0));
  return box;
}

}  // namespace

Result<SheetOutline> read_outline_file(const std::string& path, OutlineFormat format,
                                       double tolerance_mm) {
  const Result<std::string> text = read_text(path);
  if (!text) return Error{text.error()};
  Result<SheetOutline> outline = format == OutlineFormat::kDxf
                                     ? parse_dxf_outline(*text, path, tolerance_mm)
                                     : parse_svg_outline(*text, path, tolerance_mm);
  if (!outline) return outline;
  const Done done = check_outline(*outline);
  if (!done) return Error{fmt::format("{}: {}", path, done.error())};
  return outline;
}

Done write_outline_dxf(const SheetOutline& outline, const std::string& path) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "0\nSECTION\n2\nENTITIES\n");
  for (const std::vector<Vec2>& ring : outline.rings) {
    fmt::format_to(out, "0\nPOLYLINE\n8\n0\n66\n1\n70\n1\n10\n0\n20\n0\n30\n0\n");
    for (const Vec2& p : ring)
      fmt::format_to(out, "0\nVERTEX\n8\n0\n10\n{:.4f}\n20\n{:.4f}\n30\n0\n", p.x, p.y);
    fmt::format_to(out, "0\nSEQEND\n8\n0\n");
  }
  fmt::format_to(out, "0\nENDSEC\n0\nEOF\n");
  return write_text(path, text);
}

Done write_outline_svg(const SheetOutline& outline, const std::string& path) {
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
  for (const std::vector<Vec2>& ring : outline.rings) {
    char command = 'M';
    for (const Vec2& p : ring) {
      fmt::format_to(out, "{}{:.4f} {:.4f}\n", command, p.x - box.min.x, box.max.y - p.y);
      command = 'L';
    }
    fmt::format_to(out, "Z\n");
  }
  fmt::format_to(out, "\"/>\n</svg>\n");
  return write_text(path, text);
}

}  // namespace kerf
