#include "twin/diff/align.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace kerf {
namespace {

using Size = std::ptrdiff_t;

/// A stretch of both.
struct Stretch {
  Size a = 0, a_end = 0;
  Size b = 0, b_end = 0;
  bool is_done() const { return a == a_end || b == b_end; }
};

/// Collects pairs in ascending order; what lies between them are the gaps.
class Gaps {
 public:
  void match(Size a, Size b) {
    close(a, b);
    a_ = a + 1;
    b_ = b + 1;
  }
  void close(Size a, Size b) {
    if (a == a_ && b == b_) return;
    all.push_back({std::size_t(a_), std::size_t(a), std::size_t(b_), std::size_t(b)});
  }
  std::vector<AlignedGap> all;

 private:
  Size a_ = 0, b_ = 0;  ///< behind the last pair
};

class Aligner {
 public:
  explicit Aligner(const AlignedPair& pair) : pair_(pair) {}

  std::vector<AlignedGap> run() {
    const Stretch all{0, Size(pair_.a_size), 0, Size(pair_.b_size)};
    between(all);
    gaps_.close(all.a_end, all.b_end);
    return std::move(gaps_.all);
  }

 private:
  bool equal(Size a, Size b) const { return pair_.equal(std::size_t(a), std::size_t(b)); }

  /// Equal ends first; what is left by anchors.
  void between(Stretch part) {
    while (!part.is_done() && equal(part.a, part.b)) gaps_.match(part.a++, part.b++);
    Size tail = 0;
    while (!part.is_done() && equal(part.a_end - 1, part.b_end - 1)) {
      --part.a_end;
      --part.b_end;
      ++tail;
    }
    if (!part.is_done()) {
      const std::vector<std::pair<Size, Size>> anchors = anchors_in(part);
      for (const auto& [a, b] : anchors) {
        edits({part.a, a, part.b, b});
        gaps_.match(a, b);
        part.a = a + 1;
        part.b = b + 1;
      }
      edits(part);
    }
    for (Size i = 0; i < tail; ++i) gaps_.match(part.a_end + i, part.b_end + i);
  }

  /// What stands once in each, as far as it is in the same order in both.
  std::vector<std::pair<Size, Size>> anchors_in(const Stretch& part) const {
    struct Place {
      Size a = -1, b = -1;
      int in_a = 0, in_b = 0;
    };
    std::unordered_map<std::uint64_t, Place> places;
    for (Size i = part.a; i < part.a_end; ++i) {
      Place& place = places[pair_.a_key(std::size_t(i))];
      place.a = i;
      ++place.in_a;
    }
    for (Size j = part.b; j < part.b_end; ++j) {
      const auto found = places.find(pair_.b_key(std::size_t(j)));
      if (found == places.end()) continue;
      found->second.b = j;
      ++found->second.in_b;
    }
    std::vector<std::pair<Size, Size>> once;
    for (const auto& [key, place] : places) {
      if (place.in_a == 1 && place.in_b == 1 && equal(place.a, place.b)) {
        once.emplace_back(place.a, place.b);
      }
    }
    std::sort(once.begin(), once.end());
    return longest_rising(once);
  }

  /// Of pairs that rise in A those that rise in B as well, as many as can be.
  static std::vector<std::pair<Size, Size>> longest_rising(
      const std::vector<std::pair<Size, Size>>& pairs) {
    std::vector<std::size_t> ends;                  // of the best sequence of each length
    std::vector<std::size_t> before(pairs.size());  // in the sequence that ends here
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto at =
          std::lower_bound(ends.begin(), ends.end(), pairs[i].second,
                           [&](std::size_t end, Size b) { return pairs[end].second < b; });
      before[i] = at == ends.begin() ? i : *(at - 1);
      if (at == ends.end()) {
        ends.push_back(i);
      } else {
        *at = i;
      }
    }
    std::vector<std::pair<Size, Size>> out(ends.size());
    std::size_t at = ends.empty() ? 0 : ends.back();
    for (std::size_t n = ends.size(); n-- > 0; at = before[at]) out[n] = pairs[at];
    return out;
  }

  /// The pairs of a stretch, by fewest edits.
  void edits(Stretch part) {
    while (!part.is_done() && equal(part.a, part.b)) gaps_.match(part.a++, part.b++);
    while (!part.is_done()) part = some_edits(part);
  }

  /// Up to kMostEdits; what is left.
  Stretch some_edits(const Stretch& part) {
    // reach_[d][k + d]: how far in A diagonal k has come with d edits.
    reach_.clear();
    const Size most_a = part.a_end - part.a, most_b = part.b_end - part.b;
    for (int d = 0; d <= kMostEdits; ++d) {
      std::vector<Size>& now = reach_.emplace_back(std::size_t(2 * d + 1), -1);
      Size best_k = 0, best = -1;
      for (Size k = -d; k <= d; k += 2) {
        Size x = d == 0 ? 0 : first_of(d, k);
        if (x < 0 || x > most_a || x - k > most_b) continue;
        while (x < most_a && x - k < most_b && equal(part.a + x, part.b + x - k)) ++x;
        now[std::size_t(k + d)] = x;
        if (x == most_a && x - k == most_b) {
          trace(part, d, k);
          return {part.a_end, part.a_end, part.b_end, part.b_end};
        }
        if (2 * x - k > best) {
          best = 2 * x - k;
          best_k = k;
        }
      }
      if (d < kMostEdits) continue;
      const Size x = now[std::size_t(best_k + d)];
      trace(part, d, best_k);
      return {part.a + x, part.a_end, part.b + x - best_k, part.b_end};
    }
    return part;
  }

  Size reached(int d, Size k) const {
    return std::abs(k) > d ? -1 : reach_[std::size_t(d)][std::size_t(k + d)];
  }
  /// Where diagonal k begins with its d-th edit: an item of B more, or one of A.
  Size first_of(int d, Size k) const {
    const Size of_b = reached(d - 1, k + 1), of_a = reached(d - 1, k - 1);
    return std::max(of_b, of_a < 0 ? -1 : of_a + 1);
  }

  /// The pairs on the way to there.
  void trace(const Stretch& part, int d, Size k) {
    std::vector<std::pair<Size, Size>> pairs;
    Size x = reached(d, k);
    while (true) {
      const Size first = d == 0 ? 0 : first_of(d, k);
      for (; x > first; --x) pairs.emplace_back(part.a + x - 1, part.b + x - 1 - k);
      if (d == 0) break;
      const Size of_a = reached(d - 1, k - 1);
      const bool took_a = of_a >= 0 && of_a + 1 == first;
      --d;
      k += took_a ? -1 : 1;
      x = reached(d, k);
    }
    for (auto it = pairs.rbegin(); it != pairs.rend(); ++it) gaps_.match(it->first, it->second);
  }

  const AlignedPair& pair_;
  Gaps gaps_;
  std::vector<std::vector<Size>> reach_;
};

}  // namespace

std::vector<AlignedGap> align(const AlignedPair& pair) { return Aligner(pair).run(); }

}  // namespace kerf
