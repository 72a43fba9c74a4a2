// twin/serve/shop_page.h - the files of the page for the shop, compiled in from twin/serve/assets/.
#pragma once

#include <string>
#include <string_view>

namespace kerf {

struct ShopFile {
  const char* type = "";  ///< of the Content-Type header
  std::string body;
};

/// In the language of the process when it is made.
class ShopPage {
 public:
  ShopPage();
  /// "/", "/shop.css", "/shop.js", "/icon.svg", exactly so; null: there is no such file.
  const ShopFile* find(std::string_view path) const;

 private:
  ShopFile page_, style_, script_, icon_;
};

}  // namespace kerf
