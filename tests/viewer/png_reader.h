// tests/viewer/png_reader.h - pictures that kerf wrote, read by libpng's simple interface.
#pragma once

#include <string>

#include "viewer/picture.h"

namespace kerf {

/// Of an empty size if the file is no whole PNG.
Picture read_png_file(const std::string& path);

}  // namespace kerf
