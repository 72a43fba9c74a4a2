// DXF and SVG outlines, profiles that turn and punch shapes from arbitrary bytes.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/text_scan.h"
#include "stock/plane/outline_file.h"
#include "stock/sheet/punch_shape.h"
#include "stock/sheet/sheet.h"
#include "stock/turning/turned_blank.h"

namespace {

constexpr double kTolerance_mm = 0.1;
constexpr std::size_t kMaxCorners = 2000;

/// What has been read makes a sheet, or has a fault that is told.
void try_outline(const kerf::Result<kerf::PlaneOutline>& outline) {
  if (!outline) {
    if (outline.error().empty()) std::abort();
    return;
  }
  std::size_t corners = 0;
  for (const auto& ring : outline->rings) corners += ring.size();
  if (corners > kMaxCorners) return;
  kerf::SheetOptions options;
  options.outline = *outline;
  options.tiles_each_way = 3;
  const auto sheet = kerf::Sheet::create(options);
  if (sheet && !(std::isfinite((*sheet)->remaining_mm3()))) std::abort();
}

/// The same of a part that turns.
void try_profile(const kerf::Result<kerf::PlaneOutline>& outline) {
  if (!outline || !kerf::check_outline(*outline)) return;
  const auto profile = kerf::profile_of_outline(*outline, "fuzz");
  if (!profile) {
    if (profile.error().empty()) std::abort();
    return;
  }
  const auto part = kerf::TurnedPart::create(*profile);
  if (part && !(part->remaining_mm3() > 0)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  try_outline(kerf::parse_dxf_outline(text, "fuzz", kTolerance_mm));
  try_outline(kerf::parse_svg_outline(text, "fuzz", kTolerance_mm));
  try_profile(
      kerf::parse_dxf_outline(text, "fuzz", kTolerance_mm, kerf::OutlineClosing::kAlongAxis));
  try_profile(kerf::parse_svg_outline(text, "fuzz", kTolerance_mm));
  // Files outside are not the fuzzer's to read.
  const std::string lower = kerf::to_lower(text);
  const bool names_file =
      lower.find("dxf") != std::string::npos || lower.find("svg") != std::string::npos;
  if (!names_file) try_outline(kerf::parse_punch_shape(text, kTolerance_mm));
  return 0;
}
