#include "twin/program/shared_reading.h"

#include <algorithm>
#include <utility>

namespace kerf {
namespace {

/// A chunk for which nobody waits is handed over with so many motions.
constexpr std::size_t kChunkMotions = 4096;

}  // namespace

class SharedReading::Reader final : public Program {
 public:
  explicit Reader(std::shared_ptr<SharedReading> reading) : reading_(std::move(reading)) {}
  ~Reader() override { reading_->forget(this); }

  const std::vector<ProgramComment>& comments() const override {
    return reading_->program_->comments();
  }
  double progress() const override { return reading_->program_->progress(); }
  ProgramSummary run(const MotionSink& sink, std::stop_token stop,
                     Diagnostics& diagnostics) override;

  std::size_t taken = 0;  ///< motions; of reading_'s mutex
  bool runs = false;      ///< as well
  bool waits = false;     ///< as well

 private:
  bool next_chunk(const std::stop_token& stop, std::shared_ptr<const Chunk>& chunk);
  bool give(const Chunk& chunk, const MotionSink& sink, const std::stop_token& stop);
  ProgramSummary stopped(Diagnostics& diagnostics);
  ProgramSummary run_rest(const MotionSink& sink, std::stop_token stop, Diagnostics& diagnostics);

  std::shared_ptr<SharedReading> reading_;
  std::size_t chunks_ = 0;  ///< taken
  std::size_t known_files_ = 0;
  std::size_t known_materials_ = 0;
  std::vector<Motion> motions_;
};

std::shared_ptr<SharedReading> SharedReading::of(std::unique_ptr<Program> program, Opener again,
                                                 std::size_t most_kept) {
  return std::shared_ptr<SharedReading>(
      new SharedReading(std::move(program), std::move(again), most_kept));
}

SharedReading::SharedReading(std::unique_ptr<Program> program, Opener again, std::size_t most_kept)
    : program_(std::move(program)), again_(std::move(again)), most_kept_(most_kept) {}

/// No reader is left: each holds it.
SharedReading::~SharedReading() {
  stop_.request_stop();
  if (thread_.joinable()) thread_.join();
}

std::unique_ptr<Program> SharedReading::reader() {
  auto reader = std::make_unique<Reader>(shared_from_this());
  const std::lock_guard lock(mutex_);
  if (state_ == State::kBroken) return nullptr;
  readers_.push_back(reader.get());
  return reader;
}

std::vector<std::string> SharedReading::files() const {
  const std::lock_guard lock(mutex_);
  return files_;
}

void SharedReading::forget(const Reader* reader) {
  const std::lock_guard lock(mutex_);
  std::erase(readers_, reader);
}

/// With the mutex.
void SharedReading::begin() {
  if (state_ != State::kBefore) return;
  state_ = State::kReading;
  thread_ = std::thread([this] { read(); });
}

void SharedReading::read() {
  ProgramSummary summary;
  Diagnostics diagnostics;
  std::exception_ptr failure;
  try {
    summary = program_->run([this](std::span<const Motion> motions) { return add(motions); },
                            stop_.get_token(), diagnostics);
  } catch (...) {
    failure = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  hand_over_batches();
  summary_ = std::move(summary);
  diagnostics_ = std::move(diagnostics);
  failure_ = failure;
  if (state_ == State::kReading) state_ = State::kDone;
  more_.notify_all();
}

/// A reader that runs is near enough. With the mutex.
bool SharedReading::is_wanted() const {
  return std::any_of(readers_.begin(), readers_.end(), [this](const Reader* reader) {
    return reader->runs && reader->taken + kAhead > read_;
  });
}

/// With the mutex.
void SharedReading::hand_over_batches() {
  if (!filling_) return;
  chunks_.push_back(std::exchange(filling_, nullptr));
  more_.notify_all();
}

/// Of the interpreter's thread.
bool SharedReading::add(std::span<const Motion> motions) {
  std::unique_lock lock(mutex_);
  if (read_ + motions.size() > most_kept_) {
    hand_over_batches();
    state_ = State::kTooLong;
    return false;
  }
  if (files_.size() != program_->files().size()) files_ = program_->files();
  if (materials_.size() != program_->materials().size()) materials_ = program_->materials();
  if (!filling_) filling_ = std::make_shared<Chunk>();
  filling_->motions.append(motions);
  filling_->batches.push_back({motions.size(), program_->workpiece_frame()});
  read_ += motions.size();
  const bool awaited = std::any_of(readers_.begin(), readers_.end(),
                                   [](const Reader* reader) { return reader->waits; });
  if (awaited || filling_->motions.size() >= kChunkMotions) hand_over_batches();
  if (is_wanted()) return true;
  hand_over_batches();
  return wanted_.wait(lock, stop_.get_token(), [this] { return is_wanted(); });
}

/// False: there is none any more, or it is to stop.
bool SharedReading::Reader::next_chunk(const std::stop_token& stop,
                                       std::shared_ptr<const Chunk>& chunk) {
  SharedReading& from = *reading_;
  std::unique_lock lock(from.mutex_);
  from.begin();
  if (chunks_ == from.chunks_.size() && from.filling_) from.hand_over_batches();
  waits = true;
  const bool there = from.more_.wait(
      lock, stop, [&] { return chunks_ < from.chunks_.size() || from.state_ != State::kReading; });
  waits = false;
  if (!there || chunks_ == from.chunks_.size()) return false;
  chunk = from.chunks_[chunks_++];
  if (known_files_ != from.files_.size()) files_ = from.files_;
  if (known_materials_ != from.materials_.size()) materials_ = from.materials_;
  known_files_ = from.files_.size();
  known_materials_ = from.materials_.size();
  return true;
}

/// The batches of a chunk. False: the sink, or who stops, wants no more.
bool SharedReading::Reader::give(const Chunk& chunk, const MotionSink& sink,
                                 const std::stop_token& stop) {
  MotionArchive::Reader archive(chunk.motions);
  for (const Batch& batch : chunk.batches) {
    if (stop.stop_requested()) return false;
    motions_.clear();
    archive.take(batch.count, motions_);
    frame_ = batch.frame;
    if (!sink(motions_)) return false;
  }
  const std::lock_guard lock(reading_->mutex_);
  taken += chunk.motions.size();
  reading_->wanted_.notify_all();
  return true;
}

ProgramSummary SharedReading::Reader::run(const MotionSink& sink, std::stop_token stop,
                                          Diagnostics& diagnostics) {
  SharedReading& from = *reading_;
  {
    const std::lock_guard lock(from.mutex_);
    runs = true;
    from.wanted_.notify_all();
  }
  for (std::shared_ptr<const Chunk> chunk; next_chunk(stop, chunk);) {
    if (!give(*chunk, sink, stop)) return stopped(diagnostics);
  }
  if (stop.stop_requested()) return stopped(diagnostics);
  std::unique_lock lock(from.mutex_);
  std::erase(from.readers_, this);
  if (from.failure_) std::rethrow_exception(from.failure_);
  if (from.state_ == State::kTooLong) {
    lock.unlock();
    return run_rest(sink, stop, diagnostics);
  }
  diagnostics.insert(diagnostics.end(), from.diagnostics_.begin(), from.diagnostics_.end());
  files_ = from.summary_.files;
  return from.summary_;
}

/// Before its end. Who is the last to read ends the interpreter, and has its word on what there was
/// until then.
ProgramSummary SharedReading::Reader::stopped(Diagnostics& diagnostics) {
  SharedReading& from = *reading_;
  std::unique_lock lock(from.mutex_);
  std::erase(from.readers_, this);
  const bool last = from.readers_.empty();
  if (last && from.state_ == State::kReading) {
    from.state_ = State::kBroken;
    from.stop_.request_stop();
    lock.unlock();
    from.thread_.join();
    lock.lock();
  }
  if (!last || from.state_ == State::kReading) {
    from.wanted_.notify_all();
    ProgramSummary summary;
    summary.files = from.files_;
    summary.stopped_early = true;
    return summary;
  }
  diagnostics.insert(diagnostics.end(), from.diagnostics_.begin(), from.diagnostics_.end());
  return from.summary_;
}

/// By an interpreter of its own, behind what has been given.
ProgramSummary SharedReading::Reader::run_rest(const MotionSink& sink, std::stop_token stop,
                                               Diagnostics& diagnostics) {
  const std::unique_ptr<Program> own = reading_->again_ ? reading_->again_() : nullptr;
  if (!own) {
    ProgramSummary summary;
    summary.files = files_;
    summary.stopped_early = true;
    return summary;
  }
  std::size_t before = taken;
  return own->run(
      [&](std::span<const Motion> motions) {
        const std::size_t skipped = std::min(before, motions.size());
        before -= skipped;
        files_ = own->files();
        materials_ = own->materials();
        frame_ = own->workpiece_frame();
        return skipped == motions.size() || sink(motions.subspan(skipped));
      },
      stop, diagnostics);
}

}  // namespace kerf
