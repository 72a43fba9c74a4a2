#include "stock/cutter/holder_library.h"

#include <array>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr const char* kNut = tr_noop("clamping nut, DIN 6499 (ISO 15488)");
constexpr const char* kMiniNut = tr_noop("slim clamping nut, DIN 6499 (ISO 15488)");
constexpr const char* kWeldon = tr_noop("side-lock holder (Weldon), DIN 6359");
constexpr const char* kShrink = tr_noop("shrink-fit chuck, 4.5 degrees, DIN 69882-8");
constexpr const char* kBtFlange = tr_noop("flange, MAS 403 (JIS B 6339)");
constexpr const char* kHskFlange = tr_noop("flange, DIN 69893-1 (ISO 12164-1)");

// Of Weldon holders the length is what a DIN 69871 taper leaves of it below its flange: A less
// 19.1. Of shrink-fit chucks it is what 4.5 degrees need from the nose's diameter to the other.
constexpr std::array kHolders = {
    NamedHolder{"er11", {19, 19, 11.5}, kNut},
    NamedHolder{"er11m", {16, 16, 12}, kMiniNut},
    NamedHolder{"er16", {28, 28, 17.5}, kNut},
    NamedHolder{"er16m", {22, 22, 18}, kMiniNut},
    NamedHolder{"er20", {34, 34, 19}, kNut},
    NamedHolder{"er20m", {28, 28, 19}, kMiniNut},
    NamedHolder{"er25", {42, 42, 20}, kNut},
    NamedHolder{"er25m", {35, 35, 20}, kMiniNut},
    NamedHolder{"er32", {50, 50, 22.5}, kNut},
    NamedHolder{"er40", {63, 63, 25.5}, kNut},
    NamedHolder{"weldon6", {25, 25, 30.9}, kWeldon},
    NamedHolder{"weldon8", {28, 28, 30.9}, kWeldon},
    NamedHolder{"weldon10", {35, 35, 30.9}, kWeldon},
    NamedHolder{"weldon12", {42, 42, 30.9}, kWeldon},
    NamedHolder{"weldon14", {44, 44, 30.9}, kWeldon},
    NamedHolder{"weldon16", {48, 48, 43.9}, kWeldon},
    NamedHolder{"weldon18", {50, 50, 43.9}, kWeldon},
    NamedHolder{"weldon20", {52, 52, 43.9}, kWeldon},
    NamedHolder{"weldon25", {65, 65, 80.9}, kWeldon},
    NamedHolder{"weldon32", {72, 72, 80.9}, kWeldon},
    NamedHolder{"shrink6", {21, 27, 38.1}, kShrink},
    NamedHolder{"shrink8", {21, 27, 38.1}, kShrink},
    NamedHolder{"shrink10", {24, 32, 50.8}, kShrink},
    NamedHolder{"shrink12", {24, 32, 50.8}, kShrink},
    NamedHolder{"shrink14", {27, 34, 44.5}, kShrink},
    NamedHolder{"shrink16", {27, 34, 44.5}, kShrink},
    NamedHolder{"shrink18", {33, 42, 57.2}, kShrink},
    NamedHolder{"shrink20", {33, 42, 57.2}, kShrink},
    NamedHolder{"shrink25", {44, 53, 57.2}, kShrink},
    NamedHolder{"shrink32", {44, 53, 57.2}, kShrink},
    NamedHolder{"bt30", {46, 46, 20}, kBtFlange},
    NamedHolder{"bt40", {63, 63, 25}, kBtFlange},
    NamedHolder{"hsk-a63", {63, 63, 26}, kHskFlange},
};

}  // namespace

std::span<const NamedHolder> named_holders() { return kHolders; }

const NamedHolder* find_holder(std::string_view name) {
  for (const NamedHolder& holder : kHolders)
    if (holder.name == to_lower(name)) return &holder;
  return nullptr;
}

}  // namespace kerf
