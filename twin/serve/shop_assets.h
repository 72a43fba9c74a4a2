// twin/serve/shop_assets.h - files of the page, compiled in from twin/serve/assets/ and desktop/.
#pragma once

namespace kerf::shop_assets {

extern const char* const shop_html;
extern const char* const shop_css;
extern const char* const shop_js;
extern const char* const icon_svg;

}  // namespace kerf::shop_assets
