// interp_bridge/record_replay.h - records on their way into the cache, and out of it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <stop_token>

#include "interp_bridge/child_listener.h"
#include "interp_bridge/record_cache.h"
#include "interp_bridge/record_reader.h"

namespace kerf {

/// Hands records on to a reader, and keeps what it hands on, if there is a place for it.
class KeepingReader final : public ByteReader {
 public:
  /// Both must outlive it.
  KeepingReader(RecordReader& reader, std::optional<RecordStore>& store)
      : reader_(reader), store_(store) {}
  std::span<char> room() override { return room_ = reader_.room(); }
  bool received(std::size_t bytes) override;

 private:
  RecordReader& reader_;
  std::optional<RecordStore>& store_;
  std::span<char> room_;
};

/// Records that were kept, as if a child sent them. `on_progress` is called after every piece.
ChildEnding replay(CachedRecords& cached, RecordReader& reader, const MotionFeeder& feeder,
                   const std::stop_token& stop, const std::function<void()>& on_progress);

}  // namespace kerf
