// SHAPE text, --tool arguments, profile files and holders from arbitrary bytes.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>

#include "base/text_scan.h"
#include "stock/cutter/profile_file.h"
#include "stock/cutter/shape_spec.h"
#include "stock/cutter/turning_holder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  // Files outside are not the fuzzer's to read; the bytes stand for the file's text instead.
  const bool names_file = kerf::to_lower(text).find("profile") != std::string::npos;
  if (!names_file) {
    const auto cutter = kerf::parse_shape(text);
    if (cutter) {
      const auto again = kerf::parse_shape(cutter->spec());
      if (!again || again->spec() != cutter->spec()) std::abort();
      if (const auto& insert = cutter->insert()) {
        for (const kerf::InsertPart& part : insert->parts)
          if (part.size() < 2) std::abort();
        if (!(kerf::outline_reach_mm(*insert) <= kerf::kMaxInsertReach_mm)) std::abort();
      }
      for (int i = 0; i <= 16; ++i) {
        const double height = cutter->height_mm(cutter->radius_mm() * i / 16);
        if (!std::isfinite(height) || height < -1e-6) std::abort();
      }
    }
    const auto argument = kerf::parse_tool_argument(text);
    if (argument && argument->tool < 0) std::abort();
  }
  if (const auto holder = kerf::parse_holder_profile(text, "fuzz")) {
    for (const kerf::HolderSection& section : *holder) {
      if (!(section.length_mm > 0 && section.lower_mm > 0 && section.upper_mm > 0)) std::abort();
    }
  }
  if (const auto parts = kerf::parse_turning_holder(text, "fuzz")) {
    if (!(kerf::outline_reach_mm({*parts}) <= kerf::kMaxInsertReach_mm)) std::abort();
  }
  auto file = kerf::parse_profile_text(text, "fuzz");
  if (file) {
    const auto cutter = kerf::Cutter::from_profile("fuzz", std::move(file->pieces));
    if (cutter && !std::isfinite(cutter->height_mm(cutter->radius_mm()))) std::abort();
  }
  return 0;
}
