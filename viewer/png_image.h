// viewer/png_image.h - pictures as PNG bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "viewer/picture.h"

namespace kerf {

/// The whole file, 8-bit RGB, marked as sRGB. Error only when memory runs out. Same bytes for the
/// same picture.
Result<std::vector<std::uint8_t>> encode_png(const Picture& picture);

}  // namespace kerf
