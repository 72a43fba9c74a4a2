// viewer/film_writer.h - pictures into a film, by the program ffmpeg.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "base/result.h"
#include "viewer/picture.h"

namespace kerf {

/// What is shown to it becomes a film of kFramesPerS frames a second, as long as it was shown: of
/// pictures that come faster some are left out, others stay for several frames. In a thread of its
/// own; ffmpeg is a process that reads raw pictures from a pipe. The film appears under its name
/// when it is whole.
class FilmWriter {
 public:
  static constexpr int kFramesPerS = 25;

  /// There is an ffmpeg on PATH.
  static bool is_possible();
  /// It ends in .mp4 (H.264) or .webm (VP9).
  static bool can_be_named(const std::string& path);
  /// All pictures get the size of the first one: parts beyond are cut off, or grey.
  /// Error: ffmpeg does not start. `on_end` is called from another thread when no more can be
  /// written: ffmpeg has ended.
  static Result<std::unique_ptr<FilmWriter>> start(const std::string& path, Picture first,
                                                   std::function<void()> on_end);
  FilmWriter(const FilmWriter&) = delete;
  FilmWriter& operator=(const FilmWriter&) = delete;
  /// Without finish(): nothing is left of the film.
  ~FilmWriter();

  void show(Picture picture);
  /// ffmpeg has ended by itself; finish() says why.
  bool has_failed() const { return has_failed_; }
  /// Waits until ffmpeg has packed all, maybe for seconds. Error: what ffmpeg says.
  Done finish();
  const std::string& path() const { return path_; }

 private:
  using Clock = std::chrono::steady_clock;
  FilmWriter(std::string path, Picture first, std::function<void()> on_end);
  Done launch();
  void write(const std::stop_token& stop);
  bool write_frame(const Picture& picture);
  std::string complaint();

  std::string path_, part_path_;
  std::function<void()> on_end_;
  int pipe_ = -1;
  int process_ = -1;
  std::FILE* errors_ = nullptr;  // what ffmpeg says
  std::atomic<bool> has_failed_{false};
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::shared_ptr<const Picture> picture_;
  int width_px_, height_px_;
  std::jthread thread_;
};

}  // namespace kerf
