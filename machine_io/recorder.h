// machine_io/recorder.h - writes live positions to a file that replays bit for bit. The format is
// kerf-recording/1, written down in README.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "machine_io/position_source.h"

namespace kerf {

/// What AxisSample::position[i] is.
enum class CoordinateKind : std::uint8_t {
  kJoints,  ///< joint i; columns j0 .. j8
  kAxes,    ///< axis i of X Y Z A B C U V W; columns x .. w
};

/// Where the positions are measured from.
enum class CoordinateFrame : std::uint8_t { kMachine, kWorkpiece };

/// The head of a recording: what a replay has to know beside the samples. Texts go in one line
/// each: line ends and control characters in them are written as spaces.
struct RecordingHead {
  std::string source;  ///< PositionSource::describe() of what is recorded
  CoordinateKind kind = CoordinateKind::kJoints;
  CoordinateFrame frame = CoordinateFrame::kMachine;
  std::uint16_t axes = 0b111;    ///< bit i: position[i] gets a column; others are not recorded
  bool trigger = false;          ///< AxisSample::trigger gets one, too
  bool program = false;          ///< and AxisSample::program
  std::optional<LoadUnit> load;  ///< and AxisSample::load, in this unit
  /// Of a file that is read: it has sums (README.md). The recorder writes them always.
  bool sums = false;
  /// CLOCK_REALTIME, ns; kNoTime: the recorder takes the time at which it creates the file.
  std::int64_t start_ns = AxisSample::kNoTime;
  /// Further `# key: value` lines, in this order: "map", "program", "ini", .. A key is of letters,
  /// digits, '-', '_' and '.', and is none of the format's own.
  std::vector<std::pair<std::string, std::string>> extra;
};

/// All faults, one text each: "axes: 0 found, at least one of the bits 0 to 8 needed".
std::vector<std::string> validate(const RecordingHead& head);

struct RecorderStatus {
  std::uint64_t samples = 0;  ///< in the file, each with its whole line
  std::uint64_t lost = 0;     ///< dropped because the queue was full
  /// Why recording has stopped: "recording run.csv: No space left on device; 1234 samples are
  /// kept". Empty while all is well. Does not go away.
  std::string trouble;
};

/// Records in a thread of its own.
///
/// The file ends at a whole line whenever the operating system lets it: after a fault (full disk)
/// it is cut back to the last whole line, stays as it is, and replays. A process killed at any
/// moment loses the samples of the last kLongestDelay, no more; a power cut also what the kernel
/// had not yet brought to the disk. (Only finish() waits for the disk.)
class Recorder {
 public:
  /// From record() to write(2), also when no sample follows.
  static constexpr std::int64_t kLongestDelay_ms = 500;
  static constexpr std::size_t kDefaultQueue_bytes = std::size_t{8} << 20U;  ///< ~1 min at 1 kHz

  /// Creates the file and writes its head. Error if the head has faults, if the file is there and
  /// not empty (a recording is never overwritten), or if it cannot be created; the text names the
  /// path and says what to do. All memory is taken here.
  static Result<std::unique_ptr<Recorder>> create(const std::string& path,
                                                  const RecordingHead& head,
                                                  std::size_t queue_bytes = kDefaultQueue_bytes);

  /// As finish().
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// From one thread. Never waits, locks or allocates: a full queue drops the sample, counts it,
  /// and the file gets `# lost N` in its place. About 20 ns. After a fault or finish(): nothing.
  void record(const AxisSample& sample);
  /// Before the next sample the source has lost so many: `# lost N` in the file, RecorderStatus
  /// does not count them. From the thread of record().
  void note_lost(std::uint64_t count);
  /// From the next sample on this computer's clock is ahead of where it would be by so much more:
  /// somebody has set it. `# clock +N` in the file. From the thread of record().
  void note_clock_set(std::int64_t by_ns);

  /// From any thread.
  RecorderStatus status() const;

  /// Writes what is queued and the end line, closes the file. From the thread of record(). Calls
  /// after the first one only return the status.
  RecorderStatus finish();

 private:
  struct Writer;
  explicit Recorder(std::unique_ptr<Writer> writer);
  std::unique_ptr<Writer> writer_;
};

}  // namespace kerf
