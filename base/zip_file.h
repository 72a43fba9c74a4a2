// base/zip_file.h - members of zip files that lie in memory. The only user of libzip.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace kerf {

/// Begins as a zip file does.
bool is_zip(std::string_view bytes);

/// What its members are called, in their order; of one without a name "". nullopt: no whole zip
/// file.
std::optional<std::vector<std::string>> names_in_zip(std::string_view bytes);

/// How a member was unpacked.
enum class Unpacked {
  kWhole,
  kDamaged,
  kTooLarge,  ///< than `max_bytes`, whatever the file says of its size
  kStopped,   ///< by `take`
};
/// Hands the member with this number, piece by piece, to `take`, until that returns false.
Unpacked unpack_zip(std::string_view bytes, std::size_t member, std::size_t max_bytes,
                    const std::function<bool(std::string_view)>& take);

}  // namespace kerf
