// Anything as what a request of a page, or --serve, says.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "twin/serve/serve_address.h"
#include "twin/serve/shop_page.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto address = kerf::read_serve_address(text)) {
    // What is said of it leads there again.
    if (kerf::read_serve_address(kerf::to_string(*address)) != *address) std::abort();
  }
  static const kerf::ShopPage page;
  static const std::string token = "0123456789abcdef0123456789abcdef";
  if (kerf::is_authorized(text, token) && text != "Bearer " + token) std::abort();
  kerf::is_own_host(text);
  kerf::takes_gzip(text);
  kerf::read_seen_number(text);
  page.find(text);
  return 0;
}
