// viewer/csg/depth_picture.h - how far away each pixel is.
#pragma once

#include <vector>

namespace kerf {

/// Window depth (0 near .. 1 far, as OpenGL has it) of the pixel centres, rows from the top. 1
/// where there is nothing.
struct DepthPicture {
  int width_px = 0;
  int height_px = 0;
  std::vector<float> depths;
};

}  // namespace kerf
