// twin/diff/align.h - which items of two sequences belong together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace kerf {

/// Items [a_begin, a_end) of A stand where [b_begin, b_end) of B do; one of them may be empty.
struct AlignedGap {
  std::size_t a_begin = 0, a_end = 0;
  std::size_t b_begin = 0, b_end = 0;
  bool operator==(const AlignedGap&) const = default;
};

/// Two sequences, by what can be asked of their items.
struct AlignedPair {
  std::size_t a_size = 0;
  std::size_t b_size = 0;
  /// Item i of A and item j of B are equal; need not be transitive.
  std::function<bool(std::size_t, std::size_t)> equal;
  /// A key of items: equal ones have mostly, not always, equal keys.
  std::function<std::uint64_t(std::size_t)> a_key;
  std::function<std::uint64_t(std::size_t)> b_key;
};

/// The gaps between the items that belong together, in order; between two gaps lie as many items
/// of A as of B, equal by pairs. As few items in gaps as can be found in O((n + m) log(n + m) +
/// kMostEdits (n + m)) time: first what stands once in each (a longest rising sequence of those,
/// the "patience" of Bram Cohen), then between them E. Myers, "An O(ND) difference algorithm and
/// its variations", Algorithmica 1, 1986; where more than kMostEdits items differ at one place the
/// farthest that it has come to, and on from there.
std::vector<AlignedGap> align(const AlignedPair& pair);
inline constexpr int kMostEdits = 256;

}  // namespace kerf
