#include "stock/cutter/holder_library.h"

#include <array>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr const char* kNut = tr_noop("clamping nut, DIN 6499 (ISO 15488)");
constexpr const char* kMiniNut = tr_noop("slim clamping nut, DIN 6499 (ISO 15488)");
constexpr const char* kBtFlange = tr_noop("flange, MAS 403 (JIS B 6339)");
constexpr const char* kHskFlange = tr_noop("flange, DIN 69893-1 (ISO 12164-1)");

/// Lower and upper diameter, length.
constexpr std::array<HolderSection, 13> kSections = {{
    {19, 19, 11.5},  // er11
    {16, 16, 12},    // er11m
    {28, 28, 17.5},  // er16
    {22, 22, 18},    // er16m
    {34, 34, 19},    // er20
    {28, 28, 19},    // er20m
    {42, 42, 20},    // er25
    {35, 35, 20},    // er25m
    {50, 50, 22.5},  // er32
    {63, 63, 25.5},  // er40
    {46, 46, 20},    // bt30
    {63, 63, 25},    // bt40
    {63, 63, 26},    // hsk-a63
}};

constexpr std::span<const HolderSection> section(std::size_t at) {
  return std::span(kSections).subspan(at, 1);
}

constexpr std::array<NamedHolder, 13> kHolders = {{
    {"er11", section(0), kNut},
    {"er11m", section(1), kMiniNut},
    {"er16", section(2), kNut},
    {"er16m", section(3), kMiniNut},
    {"er20", section(4), kNut},
    {"er20m", section(5), kMiniNut},
    {"er25", section(6), kNut},
    {"er25m", section(7), kMiniNut},
    {"er32", section(8), kNut},
    {"er40", section(9), kNut},
    {"bt30", section(10), kBtFlange},
    {"bt40", section(11), kBtFlange},
    {"hsk-a63", section(12), kHskFlange},
}};

}  // namespace

std::span<const NamedHolder> named_holders() { return kHolders; }

const NamedHolder* find_holder(std::string_view name) {
  for (const NamedHolder& holder : kHolders)
    if (holder.name == to_lower(name)) return &holder;
  return nullptr;
}

}  // namespace kerf
