#include "machine_io/recorder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>

#include "base/text_scan.h"
#include "base/translate.h"
#include "machine_io/recording_format.h"

namespace kerf {
namespace {

// The writer looks this often; the rest of kLongestDelay_ms is for the disk.
constexpr int kLook_ms = 100;
static_assert(kLook_ms < Recorder::kLongestDelay_ms);

// One write(2) of so much: large enough to be cheap, small enough to be in L2.
constexpr std::size_t kBlock_bytes = std::size_t{64} << 10U;
// A sum is written after so long, or so much: what is damaged costs no more than that.
constexpr std::chrono::milliseconds kSumEvery{1000};
constexpr std::size_t kSumEvery_bytes = std::size_t{256} << 10U;

constexpr std::size_t kFewestSlots = 64;

std::string error_text(int number) {
  // Not strerror: other threads run.
  char buffer[128];
  return strerror_r(number, buffer, sizeof buffer);
}

std::int64_t realtime_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Retries what signals interrupt. Bytes written before a failure are counted in `written`.
int write_all(int fd, const char* data, std::size_t size, std::size_t& written) {
  written = 0;
  while (written < size) {
    const ssize_t n = ::write(fd, data + written, size - written);
    if (n > 0) {
      written += static_cast<std::size_t>(n);
    } else if (n == 0) {
      return ENOSPC;
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

/// A file that may be written: new, or there and empty, or a device.
Result<int> open_new(const std::string& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOCTTY, 0666);
  if (fd < 0) return Error{trf("recording {}: {}", path, error_text(errno))};
  struct stat info {};
  if (::fstat(fd, &info) != 0) {
    const int number = errno;
    ::close(fd);
    return Error{trf("recording {}: {}", path, error_text(number))};
  }
  if (S_ISREG(info.st_mode) && info.st_size != 0) {
    ::close(fd);
    return Error{
        trf("recording {}: the file is there already ({} bytes), and a recording is never "
            "overwritten; name another file or remove this one",
            path, static_cast<std::int64_t>(info.st_size))};
  }
  return fd;
}

bool is_key(const std::string& key) {
  const auto allowed = [](char c) {
    return is_letter(c) || is_digit(c) || c == '-' || c == '_' || c == '.';
  };
  return !key.empty() && std::all_of(key.begin(), key.end(), allowed);
}

}  // namespace

std::vector<std::string> validate(const RecordingHead& head) {
  std::vector<std::string> faults;
  if (head.axes == 0 || head.axes >> kMaxPositions != 0) {
    faults.push_back(
        trf("axes: {:#x} found, at least one of the bits 0 to 8 and no other allowed", head.axes));
  }
  for (const auto& [key, value] : head.extra) {
    if (key == "source" || key == "units" || key == "coordinates" || key == "start" ||
        key == "sums") {
      faults.push_back(trf("extra: the key {} is one of the format's own", key));
    } else if (!is_key(key)) {
      faults.push_back(
          trf("extra: '{}' is not allowed as a key; letters, digits, '-', '_' and '.' are", key));
    }
  }
  return faults;
}

/// A ring of slots between the one thread that records and the one that writes.
struct Recorder::Writer {
  struct Slot {
    AxisSample sample;
    std::uint64_t lost_before = 0;
    std::int64_t clock_set_ns = 0;
  };

  Writer(std::string file_path, int file, int event, const RecordingHead& head, std::size_t slots)
      : path(std::move(file_path)),
        fd(file),
        wake_fd(event),
        ring(slots),
        lines(head.axes, head.trigger, head.program, head.load.has_value()) {}
  ~Writer() {
    if (fd >= 0) ::close(fd);
    ::close(wake_fd);
  }

  void run();
  bool drain();
  void append_lost(std::uint64_t count);
  bool write_block();
  void add_to_sum();
  void append_sum();
  void fail(int error_number);
  void end();
  void wake() const {
    const std::uint64_t one = 1;
    // It cannot fail but for a counter at 2^64: then the writer is awake anyway.
    [[maybe_unused]] const ssize_t n = ::write(wake_fd, &one, sizeof one);
  }

  const std::string path;
  int fd;
  const int wake_fd;

  std::vector<Slot> ring;  // size a power of two
  alignas(64) std::atomic<std::uint64_t> pushed{0};
  alignas(64) std::atomic<std::uint64_t> taken{0};
  std::atomic<bool> ending{false};
  std::atomic<bool> failed{false};

  // Of the recording thread.
  std::uint64_t lost_pending = 0;
  std::int64_t clock_set_pending_ns = 0;
  bool is_finished = false;

  // Of the writing thread. Lines of `block` from the last whole line in the file on.
  RecordingLines lines;
  std::string block;
  std::uint64_t block_samples = 0;
  std::int64_t file_bytes = 0;  // up to the last whole block
  std::size_t summed = 0;       // of `block`, in `sum`
  std::uint32_t sum = 0;        // of all since the last sum line
  std::size_t sum_bytes = 0;
  std::chrono::steady_clock::time_point sum_since = std::chrono::steady_clock::now();
  std::thread thread;

  std::atomic<std::uint64_t> samples{0};
  std::atomic<std::uint64_t> lost{0};
  mutable std::mutex trouble_mutex;
  std::string trouble;
  int cause = 0;  ///< errno of `trouble`
};

void Recorder::Writer::append_lost(std::uint64_t count) {
  block += fmt::format("{}{}\n", kRecordingLost, count);
}

/// Everything queued, as lines into the file. False after a fault.
bool Recorder::Writer::drain() {
  std::uint64_t at = taken.load(std::memory_order_relaxed);
  while (at != pushed.load(std::memory_order_acquire)) {
    const Slot& slot = ring[at & (ring.size() - 1)];
    if (slot.lost_before != 0) append_lost(slot.lost_before);
    if (slot.clock_set_ns != 0)
      block += fmt::format("{}{:+}\n", kRecordingClock, slot.clock_set_ns);
    if (slot.sample.restarted) block += fmt::format("{}\n", kRecordingRestarted);
    char line[RecordingLines::kLongestLine_bytes];
    block.append(line, static_cast<std::size_t>(lines.append(slot.sample, line) - line));
    ++block_samples;
    taken.store(++at, std::memory_order_release);
    if (block.size() < kBlock_bytes) continue;
    add_to_sum();
    if (sum_bytes >= kSumEvery_bytes) append_sum();
    if (!write_block()) return false;
  }
  add_to_sum();
  if (std::chrono::steady_clock::now() - sum_since >= kSumEvery) append_sum();
  return write_block();
}

void Recorder::Writer::add_to_sum() {
  const std::string_view more = std::string_view(block).substr(summed);
  sum = crc32(sum, more);
  sum_bytes += more.size();
  summed = block.size();
}

/// Nothing without lines.
void Recorder::Writer::append_sum() {
  sum_since = std::chrono::steady_clock::now();
  if (sum_bytes == 0) return;
  block += recording_sum_line(sum);
  summed = block.size();
  sum = 0;
  sum_bytes = 0;
  lines.restart();
}

bool Recorder::Writer::write_block() {
  std::size_t written = 0;
  const int error_number = write_all(fd, block.data(), block.size(), written);
  if (error_number != 0) {
    // What is there up to the last line end is worth keeping.
    const std::string_view there = std::string_view(block).substr(0, written);
    const std::size_t whole = there.rfind('\n') + 1;  // npos + 1 = 0
    std::uint64_t kept = 0;
    for (std::size_t at = 0; at < whole; at = there.find('\n', at) + 1) {
      if (there[at] != '#') ++kept;
    }
    samples.fetch_add(kept, std::memory_order_relaxed);
    file_bytes += static_cast<std::int64_t>(whole);
    fail(error_number);
    return false;
  }
  file_bytes += static_cast<std::int64_t>(block.size());
  samples.fetch_add(block_samples, std::memory_order_relaxed);
  block_samples = 0;
  block.clear();
  summed = 0;
  return true;
}

void Recorder::Writer::fail(int error_number) {
  // Devices and pipes cannot be cut back; nothing is there to cut back either.
  [[maybe_unused]] const int ignored = ::ftruncate(fd, file_bytes);
  const std::lock_guard lock(trouble_mutex);
  cause = error_number;
  trouble = trf("recording {}: {}; {} samples are kept", path, error_text(error_number),
                samples.load(std::memory_order_relaxed));
  failed.store(true, std::memory_order_release);
}

void Recorder::Writer::end() {
  if (lost_pending != 0) append_lost(lost_pending);
  add_to_sum();
  append_sum();
  block += fmt::format("{}{}\n", kRecordingEnd, samples.load(std::memory_order_relaxed));
  if (!write_block()) return;
  // The only time: nobody is disturbed by it any more. Devices and pipes cannot be synced.
  if (::fsync(fd) != 0 && errno == EIO) fail(errno);
  // NFS and quotas tell some faults only here.
  const int result = ::close(std::exchange(fd, -1));
  if (result != 0 && errno != EINTR) fail(errno);
}

void Recorder::Writer::run() {
  while (!ending.load(std::memory_order_acquire)) {
    pollfd wait{wake_fd, POLLIN, 0};
    if (::poll(&wait, 1, kLook_ms) > 0) {
      std::uint64_t count = 0;
      [[maybe_unused]] const ssize_t n = ::read(wake_fd, &count, sizeof count);
    }
    if (!drain()) return;
  }
  if (drain()) end();
}

Result<std::unique_ptr<Recorder>> Recorder::create(const std::string& path,
                                                   const RecordingHead& head,
                                                   std::size_t queue_bytes) {
  if (const auto faults = validate(head); !faults.empty()) {
    return Error{trf("recording {}: {}", path, faults.front())};
  }
  std::size_t slots = kFewestSlots;
  while (slots * 2 * sizeof(Writer::Slot) <= queue_bytes) slots *= 2;

  const auto file = open_new(path);
  if (!file) return Error{file.error()};
  const int event = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (event < 0) {
    const int number = errno;
    ::close(*file);
    return Error{trf("recording {}: {}", path, error_text(number))};
  }
  RecordingHead dated = head;
  dated.sums = true;
  if (dated.start_ns == AxisSample::kNoTime) dated.start_ns = realtime_ns();
  auto writer = std::make_unique<Writer>(path, *file, event, dated, slots);
  writer->block.reserve(kBlock_bytes + 2 * RecordingLines::kLongestLine_bytes);
  writer->block = recording_head_text(dated);
  writer->add_to_sum();
  writer->append_sum();
  if (!writer->write_block()) {
    // A head without samples tells nobody anything.
    const int cause = writer->cause;
    struct stat info {};
    if (::fstat(writer->fd, &info) == 0 && S_ISREG(info.st_mode)) ::unlink(path.c_str());
    return Error{trf("recording {}: {}", path, error_text(cause))};
  }
  writer->thread = std::thread([w = writer.get()] { w->run(); });
  return std::unique_ptr<Recorder>(new Recorder(std::move(writer)));
}

Recorder::Recorder(std::unique_ptr<Writer> writer) : writer_(std::move(writer)) {}

Recorder::~Recorder() { finish(); }

void Recorder::record(const AxisSample& sample) {
  Writer& w = *writer_;
  if (w.is_finished || w.failed.load(std::memory_order_relaxed)) return;
  const std::uint64_t at = w.pushed.load(std::memory_order_relaxed);
  const std::uint64_t queued = at - w.taken.load(std::memory_order_acquire);
  if (queued == w.ring.size()) {
    ++w.lost_pending;
    w.lost.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  Writer::Slot& slot = w.ring[at & (w.ring.size() - 1)];
  slot.sample = sample;
  slot.lost_before = std::exchange(w.lost_pending, 0);
  slot.clock_set_ns = std::exchange(w.clock_set_pending_ns, 0);
  w.pushed.store(at + 1, std::memory_order_release);
  // Only on the way up, and only here: waking costs a system call.
  if (queued + 1 == w.ring.size() / 4) w.wake();
}

void Recorder::note_lost(std::uint64_t count) {
  if (!writer_->is_finished) writer_->lost_pending += count;
}

void Recorder::note_clock_set(std::int64_t by_ns) {
  if (!writer_->is_finished) writer_->clock_set_pending_ns += by_ns;
}

RecorderStatus Recorder::status() const {
  const Writer& w = *writer_;
  RecorderStatus status;
  status.samples = w.samples.load(std::memory_order_relaxed);
  status.lost = w.lost.load(std::memory_order_relaxed);
  const std::lock_guard lock(w.trouble_mutex);
  status.trouble = w.trouble;
  return status;
}

RecorderStatus Recorder::finish() {
  Writer& w = *writer_;
  if (!w.is_finished) {
    w.is_finished = true;
    w.ending.store(true, std::memory_order_release);
    w.wake();
    w.thread.join();
  }
  return status();
}

}  // namespace kerf
