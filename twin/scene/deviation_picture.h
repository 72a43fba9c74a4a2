// twin/scene/deviation_picture.h - a finished part coloured by its deviations from the design.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <string>

#include "base/result.h"
#include "stock/stock_model.h"
#include "twin/compare/comparison.h"
#include "twin/compare/design_part.h"
#include "viewer/picture.h"

namespace kerf {

/// By the window's renderer, in its colours, from front right above; or from behind, the side or
/// below, if the worst place is seen from there alone. With the legend, rings about the worst gouge
/// and the worst excess, and what the comparison came to. `name`: of the program, for the caption.
/// One thread, which must not have another OpenGL context. Error: no OpenGL, and why.
Result<Picture> deviation_picture(const StockModel& stock,
                                  const std::shared_ptr<const DesignPart>& design,
                                  const Comparison& comparison, const std::string& name,
                                  glm::ivec2 size_px = glm::ivec2(1280, 960));

}  // namespace kerf
