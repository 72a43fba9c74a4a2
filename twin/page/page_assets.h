// twin/page/page_assets.h - style and script of the page, compiled in from twin/page/assets/.
#pragma once

namespace kerf::page_assets {

extern const char* const page_css;
extern const char* const page_js;

}  // namespace kerf::page_assets
