#include "interp_bridge/record_replay.h"

#include <algorithm>

namespace kerf {

bool KeepingReader::received(std::size_t bytes) {
  if (store_) store_->write(room_.first(bytes));
  return reader_.received(bytes);
}

ChildEnding replay(CachedRecords& cached, RecordReader& reader, const MotionFeeder& feeder,
                   const std::stop_token& stop, const std::function<void()>& on_progress) {
  // As a pipe gives them: what follows begins with the first.
  constexpr std::size_t kReplayBytes = std::size_t{64} * 1024;
  for (;;) {
    if (stop.stop_requested()) return ChildEnding::kStopped;
    std::span<char> room = reader.room();
    room = room.first(std::min(room.size(), kReplayBytes));
    const std::size_t got = cached.read(room);
    if (got == 0) return ChildEnding::kComplete;
    if (!reader.received(got)) {
      return feeder.too_many_commands() ? ChildEnding::kTooMany : ChildEnding::kStopped;
    }
    on_progress();
  }
}

}  // namespace kerf
