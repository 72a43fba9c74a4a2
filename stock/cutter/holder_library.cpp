#include "stock/cutter/holder_library.h"

#include <array>

#include "base/text_scan.h"

namespace kerf {
namespace {

constexpr std::array<NamedHolder, 10> kHolders = {{
    {"er11", 19, 11.5},
    {"er11m", 16, 12},
    {"er16", 28, 17.5},
    {"er16m", 22, 18},
    {"er20", 34, 19},
    {"er20m", 28, 19},
    {"er25", 42, 20},
    {"er25m", 35, 20},
    {"er32", 50, 22.5},
    {"er40", 63, 25.5},
}};

}  // namespace

std::span<const NamedHolder> named_holders() { return kHolders; }

const NamedHolder* find_holder(std::string_view name) {
  for (const NamedHolder& holder : kHolders)
    if (holder.name == to_lower(name)) return &holder;
  return nullptr;
}

}  // namespace kerf
