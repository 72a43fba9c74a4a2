// twin/config/materials_text.h - configs/materials.yaml, compiled in.
#pragma once

namespace kerf {

extern const char* const kMaterialsText;

}  // namespace kerf
