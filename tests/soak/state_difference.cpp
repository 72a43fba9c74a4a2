// soak_state_difference A B BY_MM: the share of the cells of two saved workpieces (--state) whose
// heights differ by more than BY_MM, on stdout; status 1 if the two are not of one grid.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "stock/zmap/zmap.h"

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: soak_state_difference A B BY_MM\n");
    return 2;
  }
  const auto a = kerf::ZMap::load(argv[1]);
  const auto b = kerf::ZMap::load(argv[2]);
  if (!a || !b) {
    fmt::print(stderr, "soak_state_difference: {}\n", !a ? a.error() : b.error());
    return 1;
  }
  const kerf::ZMap& left = **a;
  const kerf::ZMap& right = **b;
  if (left.nx() != right.nx() || left.ny() != right.ny()) {
    fmt::print(stderr, "soak_state_difference: grids of {} x {} and {} x {} cells\n", left.nx(),
               left.ny(), right.nx(), right.ny());
    return 1;
  }
  const double by_mm = std::atof(argv[3]);
  std::size_t different = 0;
  double most_mm = 0;
  for (int j = 0; j < left.ny(); ++j) {
    for (int i = 0; i < left.nx(); ++i) {
      const double difference = std::abs(left.height_mm(i, j) - right.height_mm(i, j));
      most_mm = std::max(most_mm, difference);
      different += difference > by_mm ? 1 : 0;
    }
  }
  const double cells = static_cast<double>(left.nx()) * left.ny();
  fmt::print("{:.6f} {:.4f}\n", static_cast<double>(different) / cells, most_mm);
  return 0;
}
