// base/newline_count.h - how many lines a text ends.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace kerf {

/// Newlines in `text`, many times as fast as std::count where that is not compiled for vectors.
inline std::size_t newline_count(std::string_view text) {
  // Sixteen bytes at once; each adds up its own, and may do so 255 times.
  using Bytes = unsigned char __attribute__((vector_size(16)));
  constexpr std::size_t kMostTurns = 255;
  std::size_t count = 0;
  while (text.size() >= sizeof(Bytes)) {
    const std::size_t turns = std::min(text.size() / sizeof(Bytes), kMostTurns);
    Bytes sums{};
    for (std::size_t i = 0; i < turns; ++i) {
      Bytes bytes;
      std::memcpy(&bytes, text.data() + i * sizeof bytes, sizeof bytes);
      sums += (bytes == static_cast<unsigned char>('\n')) & 1;
    }
    for (std::size_t i = 0; i < sizeof sums; ++i) count += sums[i];
    text.remove_prefix(turns * sizeof sums);
  }
  return count + static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace kerf
