#include "twin/batch/batch_run.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <list>
#include <map>
#include <optional>

#include "base/small_file.h"
#include "base/translate.h"
#include "twin/batch/content_hash.h"
#include "twin/batch/result_log.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using Clock = BoundedProcess::Clock;

constexpr std::size_t kMaxResultBytes = 1U << 30U;
/// How long a stop request may stay unseen.
constexpr int kLookMs = 50;

/// The folder is this batch's alone as long as this lives.
class FolderLock {
 public:
  Done take(const std::string& folder) {
    fd_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd_ < 0) return Error{trf("{}: {}", folder, std::strerror(errno))};
    if (flock(fd_, LOCK_EX | LOCK_NB) == 0) return std::monostate{};
    if (errno != EWOULDBLOCK) return Error{trf("{}: {}", folder, std::strerror(errno))};
    return Error{trf("{}: another kerf batch is at work in this folder", folder)};
  }
  FolderLock() = default;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock() {
    if (fd_ >= 0) close(fd_);
  }

 private:
  int fd_ = -1;
};

class BatchRunner {
 public:
  BatchRunner(const BatchPlan& plan,
              const std::function<void(const BatchResult&, std::size_t)>& told)
      : plan_(plan), told_(told), results_(plan.units.size()) {}

  BatchEnd run(const std::stop_token& stop) {
    FolderLock lock;
    if (prepare(lock)) work(stop);
    for (std::optional<BatchResult>& result : results_) {
      if (result) end_.results.push_back(std::move(*result));
    }
    return std::move(end_);
  }

 private:
  struct Running {
    std::size_t unit;
    BoundedProcess process;
  };

  bool fail(std::string message) {
    if (end_.fault.empty()) end_.fault = std::move(message);
    return false;
  }

  bool prepare(FolderLock& lock) {
    std::error_code error;
    fs::create_directories(fs::path(plan_.out) / "programs", error);
    if (error) return fail(trf("{}: {}", plan_.out, error.message()));
    if (const Done locked = lock.take(plan_.out); !locked) return fail(locked.error());
    for (const BatchUnit& unit : plan_.units) {
      hashes_.push_back(content_hash(unit.program, unit.words));
    }
    const std::string path = (fs::path(plan_.out) / "results.jsonl").string();
    std::string text;
    if (fs::exists(path, error)) {
      Result<std::string> read = read_small_file(path, kMaxResultBytes);
      if (!read) return fail(read.error());
      text = std::move(*read);
    }
    bool changed = false;
    const std::vector<BatchResult> kept = take_kept(parse_results(text, changed), changed);
    Result<ResultLog> log = ResultLog::open(path, kept, !changed);
    if (!log) return fail(log.error());
    log_.emplace(std::move(*log));
    return true;
  }

  /// Those of this batch that hold are its results already; those that do not are left out.
  std::vector<BatchResult> take_kept(std::vector<BatchResult> there, bool& changed) {
    std::map<std::string, std::size_t> units;
    for (std::size_t i = 0; i < plan_.units.size(); ++i) units[plan_.units[i].program] = i;
    std::vector<BatchResult> kept;
    for (BatchResult& result : there) {
      const auto at = units.find(result.program);
      if (at != units.end()) {
        if (plan_.again || !still_holds(result, plan_.out, hashes_[at->second], plan_.bounds)) {
          changed = true;
          continue;
        }
        results_[at->second] = result;
        ++end_.reused;
      }
      kept.push_back(std::move(result));
    }
    done_ = end_.reused;
    return kept;
  }

  void work(const std::stop_token& stop) {
    std::size_t next = 0;
    while (true) {
      const bool goes_on = !stop.stop_requested() && end_.fault.empty();
      while (goes_on && end_.fault.empty() &&
             running_.size() < static_cast<std::size_t>(plan_.jobs)) {
        while (next < results_.size() && results_[next]) ++next;
        if (next == results_.size()) break;
        start(next++);
      }
      if (!goes_on) {
        for (Running& one : running_) one.process.stop();
      }
      if (running_.empty()) break;
      wait();
      take_ended();
    }
    // Between the last end and here nothing was left to interrupt.
    end_.interrupted = stop.stop_requested() && done_ < results_.size();
  }

  void start(std::size_t at) {
    const BatchUnit& unit = plan_.units[at];
    const fs::path folder = fs::path(plan_.out) / folder_of(unit.program);
    std::error_code error;
    fs::remove_all(folder, error);  // what is there is of another run
    if (!error) fs::create_directories(folder, error);
    if (error) {
      fail(trf("{}: {}", folder.string(), error.message()));
      return;
    }
    std::vector<std::string> words{
        "run", unit.program.front() == '-' ? "./" + unit.program : unit.program};
    words.insert(words.end(), unit.words.begin(), unit.words.end());
    const auto says_threads = [](const std::string& w) { return w.starts_with("--threads="); };
    if (std::none_of(words.begin(), words.end(), says_threads)) {
      words.push_back("--threads=" + std::to_string(plan_.threads_each));
    }
    for (std::string& word : output_words(plan_.out, unit.program))
      words.push_back(std::move(word));
    Result<BoundedProcess> process =
        BoundedProcess::start(words, (folder / "said.txt").string(), plan_.bounds);
    if (!process) {
      fail(process.error());
      return;
    }
    running_.push_back({at, std::move(*process)});
  }

  void wait() {
    std::vector<pollfd> ends;
    Clock::time_point look = Clock::now() + std::chrono::milliseconds(kLookMs);
    for (const Running& one : running_) {
      ends.push_back({one.process.ended_fd(), POLLIN, 0});
      look = std::min(look, one.process.next_look());
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(look - Clock::now()).count();
    poll(ends.data(), ends.size(), static_cast<int>(std::max<long>(left, 0)));
  }

  void take_ended() {
    const Clock::time_point now = Clock::now();
    for (auto one = running_.begin(); one != running_.end();) {
      const std::optional<ProcessEnd> end = one->process.look(now);
      if (!end) {
        ++one;
        continue;
      }
      if (!end->stopped) keep(one->unit, *end);
      one = running_.erase(one);
    }
  }

  void keep(std::size_t at, const ProcessEnd& end) {
    BatchResult result =
        result_of_run(plan_.out, plan_.units[at].program, hashes_[at], plan_.bounds, end);
    if (const Done done = log_->append(result); !done) {
      fail(done.error());
      return;
    }
    told_(result, ++done_);
    results_[at] = std::move(result);
  }

  const BatchPlan& plan_;
  const std::function<void(const BatchResult&, std::size_t)>& told_;
  std::vector<std::string> hashes_;
  std::vector<std::optional<BatchResult>> results_;
  std::optional<ResultLog> log_;
  std::list<Running> running_;
  std::size_t done_ = 0;
  BatchEnd end_;
};

}  // namespace

BatchEnd run_batch(const BatchPlan& plan, const std::stop_token& stop,
                   const std::function<void(const BatchResult&, std::size_t)>& told) {
  return BatchRunner(plan, told).run(stop);
}

}  // namespace kerf
