// twin/serve/packed_patch.h - a tile of the workpiece as bytes that a browser hands to its graphics
// card as they are.
#pragma once

#include <cstddef>
#include <string>

#include "base/mesh_patch.h"

namespace kerf {

/// Numbers are little-endian:
///
///     u32 tile
///     u32 corners n
///     u32 indices m                three a triangle
///     f32 x, y, z                  of the patch's box, its least; mm, workpiece frame
///     f32 dx, dy, dz               of the box
///     n times 10 bytes             u16 x, y, z in 65535ths of the box; i8 normal x, y, z in
///                                  127ths; u8 1: a move has cut there, 0: none, or it is not kept
///     m times u16, or u32 where n > 65536
///     0 to 3 bytes                 up to a multiple of 4
///
/// A patch of nothing has n = m = 0. A place is off by 1/131070 of the box at most.
std::string packed(const MeshPatch& patch);

inline constexpr std::size_t kPackedHead = 36;
inline constexpr std::size_t kPackedCorner = 10;

}  // namespace kerf
