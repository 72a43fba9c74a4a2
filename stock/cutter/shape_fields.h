// stock/cutter/shape_fields.h - SHAPE text between its colons.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace kerf {

/// "NAME=" of one of these names, letter case aside.
bool is_shape_option(std::string_view field, std::span<const std::string_view> names);
bool is_holder_file(std::string_view field);  ///< begins with "holder=profile"

/// Between colons; "holder=profile:FILE" is one, up to the next option of these names.
std::vector<std::string_view> shape_fields(std::string_view text,
                                           std::span<const std::string_view> names);

}  // namespace kerf
