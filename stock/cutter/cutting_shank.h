// stock/cutter/cutting_shank.h - a cutter whose shank takes away what it touches.
#pragma once

#include <optional>

#include "stock/cutter/cutter.h"

namespace kerf {

/// A neck or the shank is wider than all below it.
bool has_wider_shank(const Cutter& cutter);

/// The same tool; its profile goes on with what of neck and shank is wider than all below it. Its
/// SHAPE text ends with "+shank", which parse_shape() does not know. Nothing where nobody says how
/// long the flutes are, where nothing is wider, and of a cutter that undercuts: its neck has a
/// profile of its own, which does not become wider again.
std::optional<Cutter> with_cutting_shank(const Cutter& cutter);

}  // namespace kerf
