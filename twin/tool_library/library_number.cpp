#include "twin/tool_library/library_number.h"

#include <cmath>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {

void take_number(const Json* value, LibraryTool& tool) {
  if (value == nullptr) return;
  std::optional<double> number;
  if (value->is_number()) number = value->get<double>();
  if (value->is_string()) number = parse_decimal(trim(value->get_ref<const std::string&>()));
  if (number && *number == 0) return;
  if (number && *number >= 1 && *number <= kMaxToolNumber && *number == std::floor(*number)) {
    tool.number = static_cast<int>(*number);
    return;
  }
  if (!tool.trouble.empty()) return;
  tool.trouble =
      trf("its number {} is not allowed; must be a whole number from 1 to {}",
          shown(value->dump(-1, ' ', false, Json::error_handler_t::replace)), kMaxToolNumber);
  tool.cutter.reset();
}

}  // namespace kerf
