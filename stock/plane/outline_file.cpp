#include "stock/plane/outline_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/text_scan.h"
#include "base/translate.h"

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

}  // namespace kerf
