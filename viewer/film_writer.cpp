#include "viewer/film_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "base/translate.h"

extern char** environ;

namespace kerf {
namespace {

constexpr std::uint8_t kGrey = 128;
/// Of what ffmpeg says, the end is the reason.
constexpr std::size_t kMostComplaint = 400;

std::string program_path() {
  const char* const folders = std::getenv("PATH");
  std::string rest = folders != nullptr ? folders : "";
  while (!rest.empty()) {
    const std::size_t end = rest.find(':');
    const std::string candidate = rest.substr(0, end) + "/ffmpeg";
    if (access(candidate.c_str(), X_OK) == 0) return candidate;
    rest = end == std::string::npos ? "" : rest.substr(end + 1);
  }
  return "";
}

/// Yuv with half the colours wants even edges.
std::vector<std::string> words_for(const std::string& program, const std::string& path,
                                   const std::string& part_path, int width_px, int height_px) {
  std::vector<std::string> words{program,
                                 "-hide_banner",
                                 "-loglevel",
                                 "error",
                                 "-y",
                                 "-f",
                                 "rawvideo",
                                 "-pixel_format",
                                 "rgb24",
                                 "-video_size",
                                 fmt::format("{}x{}", width_px, height_px),
                                 "-framerate",
                                 std::to_string(FilmWriter::kFramesPerS),
                                 "-i",
                                 "pipe:0",
                                 "-an",
                                 "-vf",
                                 "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                 "-pix_fmt",
                                 "yuv420p"};
  const std::vector<std::string> packing =
      path.ends_with(".webm")
          ? std::vector<std::string>{"-c:v", "libvpx-vp9", "-b:v",     "0",  "-crf",
                                     "32",   "-deadline",  "realtime", "-f", "webm"}
          : std::vector<std::string>{"-c:v",     "libx264",   "-crf",       "20", "-preset",
                                     "veryfast", "-movflags", "+faststart", "-f", "mp4"};
  words.insert(words.end(), packing.begin(), packing.end());
  words.push_back(part_path);
  return words;
}

}  // namespace

bool FilmWriter::is_possible() { return !program_path().empty(); }

bool FilmWriter::can_be_named(const std::string& path) {
  return path.ends_with(".mp4") || path.ends_with(".webm");
}

FilmWriter::FilmWriter(std::string path, Picture first, std::function<void()> on_end)
    : path_(std::move(path)),
      part_path_(path_ + ".part"),
      on_end_(std::move(on_end)),
      picture_(std::make_shared<const Picture>(std::move(first))),
      width_px_(picture_->width_px),
      height_px_(picture_->height_px) {}

Result<std::unique_ptr<FilmWriter>> FilmWriter::start(const std::string& path, Picture first,
                                                      std::function<void()> on_end) {
  std::unique_ptr<FilmWriter> film(new FilmWriter(path, std::move(first), std::move(on_end)));
  if (Done done = film->launch(); !done) return Error{done.error()};
  film->thread_ = std::jthread([raw = film.get()](std::stop_token stop) { raw->write(stop); });
  return film;
}

Done FilmWriter::launch() {
  const std::string program = program_path();
  if (program.empty()) return Error{tr("ffmpeg is not installed")};
  std::array<int, 2> ends{};
  errors_ = std::tmpfile();
  if (errors_ == nullptr || pipe2(ends.data(), O_CLOEXEC) != 0) {
    return Error{trf("starting ffmpeg: {}", std::strerror(errno))};
  }
  pipe_ = ends[1];
  std::vector<std::string> words = words_for(program, path_, part_path_, width_px_, height_px_);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, fileno(errors_), STDERR_FILENO);
  // Ctrl-C at the terminal is kerf's, which ends the film.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t process = -1;
  const int error =
      posix_spawn(&process, program.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  close(ends[0]);
  if (error != 0) return Error{trf("starting {}: {}", program, std::strerror(error))};
  process_ = process;
  return std::monostate{};
}

FilmWriter::~FilmWriter() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  if (pipe_ >= 0) close(pipe_);
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    std::error_code ignored;
    std::filesystem::remove(part_path_, ignored);
  }
  if (errors_ != nullptr) std::fclose(errors_);
}

void FilmWriter::show(Picture picture) {
  auto shown = std::make_shared<const Picture>(std::move(picture));
  const std::lock_guard lock(mutex_);
  picture_ = std::move(shown);
}

/// As many frames as have become due; at the end the last picture, once.
void FilmWriter::write(const std::stop_token& stop) {
  // An ffmpeg that is gone is an error of write(), not the end of kerf.
  sigset_t pipe_signal;
  sigemptyset(&pipe_signal);
  sigaddset(&pipe_signal, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe_signal, nullptr);
  constexpr std::chrono::duration<double> kFrame(1.0 / kFramesPerS);
  const Clock::time_point begin = Clock::now();
  for (std::size_t written = 0;;) {
    std::unique_lock lock(mutex_);
    const auto next =
        begin + std::chrono::duration_cast<Clock::duration>(static_cast<double>(written) * kFrame);
    ended_.wait_until(lock, stop, next, [] { return false; });
    const std::shared_ptr<const Picture> picture = picture_;
    lock.unlock();
    const bool is_last = stop.stop_requested();
    if (!write_frame(*picture)) {
      has_failed_ = true;
      if (on_end_) on_end_();
      return;
    }
    ++written;
    if (is_last) return;
  }
}

bool FilmWriter::write_frame(const Picture& picture) {
  const auto width = static_cast<std::size_t>(width_px_),
             height = static_cast<std::size_t>(height_px_);
  std::vector<std::uint8_t> other;
  const std::vector<std::uint8_t>* rgb = &picture.rgb;
  if (picture.width_px != width_px_ || picture.height_px != height_px_) {
    other.assign(3 * width * height, kGrey);
    const auto columns = static_cast<std::ptrdiff_t>(3 * std::min(picture.width_px, width_px_));
    for (int y = 0; y < std::min(picture.height_px, height_px_); ++y) {
      std::copy_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(3) * picture.width_px * y,
                  columns, other.begin() + static_cast<std::ptrdiff_t>(3) * width_px_ * y);
    }
    rgb = &other;
  }
  for (std::size_t at = 0; at < rgb->size();) {
    const ssize_t count = ::write(pipe_, rgb->data() + at, rgb->size() - at);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += static_cast<std::size_t>(count);
  }
  return true;
}

std::string FilmWriter::complaint() {
  std::rewind(errors_);
  std::string said;
  for (int c = 0; (c = std::fgetc(errors_)) != EOF;) said += c == '\n' ? ' ' : static_cast<char>(c);
  while (said.ends_with(' ')) said.pop_back();
  if (said.size() > kMostComplaint) said = "... " + said.substr(said.size() - kMostComplaint);
  return said;
}

Done FilmWriter::finish() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  close(std::exchange(pipe_, -1));
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  std::error_code error;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    std::filesystem::remove(part_path_, error);
    const std::string said = complaint();
    return Error{fmt::format("ffmpeg: {}", said.empty() ? tr("it failed") : said)};
  }
  std::filesystem::rename(part_path_, path_, error);
  if (error) return Error{fmt::format("{}: {}", path_, error.message())};
  return std::monostate{};
}

}  // namespace kerf
