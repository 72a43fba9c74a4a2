#include "machine_io/simulator/state_board.h"

namespace kerf {

void StateBoard::publish(const ServedState& served) {
  const std::lock_guard lock(mutex_);
  served_ = served;
}

ServedState StateBoard::read() const {
  const std::lock_guard lock(mutex_);
  return served_;
}

}  // namespace kerf
