#include "twin/cli/serve_option.h"

#include <string>

#include "base/translate.h"

namespace kerf {

std::optional<ServeAddress> understand_serve(OptionReader& reader) {
  const std::string text = reader.text("--serve");
  if (text.empty()) return std::nullopt;
  const std::optional<ServeAddress> address = read_serve_address(text);
  if (!address) {
    reader.fault("--serve", trf("'{}' is no address of this computer", text),
                 tr("192.168.1.5:8734, [fd00::5]:8734, 192.168.1.5, 8734; 0.0.0.0 is all addresses "
                    "that it has; --serve alone is for this computer"));
  }
  return address;
}

}  // namespace kerf
