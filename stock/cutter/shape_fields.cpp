#include "stock/cutter/shape_fields.h"

#include <algorithm>

#include "base/text_scan.h"

namespace kerf {

bool is_shape_option(std::string_view field, std::span<const std::string_view> names) {
  const std::size_t equals = field.find('=');
  if (equals == std::string_view::npos) return false;
  return std::find(names.begin(), names.end(), to_lower(field.substr(0, equals))) != names.end();
}

bool is_holder_file(std::string_view field) {
  constexpr std::string_view kBegin = "holder=profile";
  return to_lower(field.substr(0, kBegin.size())) == kBegin;
}

std::vector<std::string_view> shape_fields(std::string_view text,
                                           std::span<const std::string_view> names) {
  std::vector<std::string_view> fields;
  for (const std::string_view field : split(text, ':')) {
    const bool goes_on =
        !fields.empty() && is_holder_file(fields.back()) && !is_shape_option(field, names);
    if (goes_on) {
      const char* const begin = fields.back().data();
      fields.back() = {begin, static_cast<std::size_t>(field.data() + field.size() - begin)};
    } else {
      fields.push_back(field);
    }
  }
  return fields;
}

}  // namespace kerf
