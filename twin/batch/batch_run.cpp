#include "twin/batch/batch_run.h"

#include <fcntl.h>
#include <fmt/format.h>
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
#include <thread>

#include "base/atomic_file.h"
#include "base/small_file.h"
#include "base/translate.h"
#include "twin/batch/content_hash.h"
#include "twin/batch/result_log.h"
#include "twin/batch/work_unit.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using Clock = BoundedProcess::Clock;

constexpr std::size_t kMaxResultBytes = 1U << 30U;
/// How long a stop request may stay unseen.
constexpr int kLookMs = 50;
constexpr std::chrono::milliseconds kResultsLook{200};
constexpr std::chrono::seconds kLateResults{5};

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
    if (prepare(lock)) plan_.engine == BatchEngine::kLocal ? work(stop) : hand_over(stop);
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
             running_.size() < static_cast<std::size_t>(std::max(plan_.jobs, 1))) {
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
    note_interruption(stop);
  }

  void note_interruption(const std::stop_token& stop) {
    // Between the last end and here nothing was left to interrupt.
    end_.interrupted = stop.stop_requested() && done_ < results_.size();
  }

  /// By another's hands: files of units out, files of results back.
  void hand_over(const std::stop_token& stop) {
    if (done_ == results_.size()) return;
    std::error_code error;
    const fs::path folder = fs::absolute(plan_.out, error) / "work";
    EngineWork work;
    if (!error && write_units(folder, work)) watch(work, stop);
    if (error) fail(trf("{}: {}", plan_.out, error.message()));
    note_interruption(stop);
    const bool is_whole = end_.fault.empty() && !end_.interrupted && !has_silent_;
    if (is_whole) fs::remove_all(folder, error);
  }

  bool write_units(const fs::path& folder, EngineWork& work) {
    std::error_code error;
    fs::remove_all(folder, error);  // of a batch that was killed
    if (!error) fs::create_directories(folder, error);
    const std::string here = fs::current_path(error).string();
    if (error) return fail(trf("{}: {}", folder.string(), error.message()));
    work.folder = folder.string();
    work.jobs = plan_.jobs;
    for (std::size_t at = 0; at < results_.size(); ++at) {
      if (results_[at]) continue;
      WorkUnit unit = unit_of(at);
      unit.folder = here;
      work.units.push_back((folder / fmt::format("{:05}.unit", at)).string());
      waiting_.emplace(result_name(work.units.back()), at);
      if (const Done done = write_text(work.units.back(), text_of(unit)); !done) {
        return fail(done.error());
      }
    }
    return true;
  }

  void watch(const EngineWork& work, const std::stop_token& stop) {
    Result<EngineCall> call = EngineCall::start(plan_.engine, work);
    if (!call) {
      fail(call.error());
      return;
    }
    while (end_.fault.empty()) {
      const bool ended = call->has_ended();  // first: what it has left then is there
      take_results();
      if (waiting_.empty()) {
        call->finish();
        break;
      }
      if (ended) {
        take_silent(call->refusal());
        break;
      }
      if (stop.stop_requested()) break;
      std::this_thread::sleep_for(kResultsLook);
    }
    call->stop();
  }

  /// Results that are there.
  void take_results() {
    for (auto one = waiting_.begin(); one != waiting_.end() && end_.fault.empty();) {
      std::error_code none;
      if (!fs::exists(one->first, none)) {
        ++one;
        continue;
      }
      const Result<std::string> line = read_small_file(one->first, kMaxResultBytes);
      std::optional<BatchResult> result = line ? result_of_line(*line) : std::nullopt;
      if (!result || result->program != plan_.units[one->second].program) {
        fail(line ? trf("{}: this is no result of a batch", one->first) : line.error());
        return;
      }
      keep(one->second, std::move(*result));
      one = waiting_.erase(one);
    }
  }

  /// The engine has ended. What a file server is slow to show has some seconds more; what has no
  /// result then has failed, by no fault of its program: it is done again the next time.
  void take_silent(const std::string& refusal) {
    if (!refusal.empty() && done_ == end_.reused) {
      fail(trf("--engine {}: {}", to_string(plan_.engine), refusal));
      return;
    }
    const Clock::time_point end = Clock::now() + kLateResults;
    while (!waiting_.empty() && end_.fault.empty() && Clock::now() < end) {
      std::this_thread::sleep_for(kResultsLook);
      take_results();
    }
    for (const auto& [path, at] : waiting_) {
      has_silent_ = true;
      BatchResult result;
      result.program = plan_.units[at].program;
      result.hash = hashes_[at];
      result.bounds = plan_.bounds;
      result.message = trf("{} has left no result of it: see {}", to_string(plan_.engine),
                           (fs::path(plan_.out) / "work").string());
      keep(at, std::move(result));
    }
    waiting_.clear();
  }

  WorkUnit unit_of(std::size_t at) const {
    const BatchUnit& unit = plan_.units[at];
    WorkUnit work;
    work.out = plan_.out;
    work.program = unit.program;
    work.hash = hashes_[at];
    work.words = unit.words;
    work.bounds = plan_.bounds;
    work.threads = plan_.threads_each;
    return work;
  }

  void start(std::size_t at) {
    Result<BoundedProcess> process = start_unit(unit_of(at));
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
      if (!end->stopped) keep(one->unit, result_of_unit(unit_of(one->unit), *end));
      one = running_.erase(one);
    }
  }

  void keep(std::size_t at, BatchResult result) {
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
  std::map<std::string, std::size_t> waiting_;  // files of results that an engine owes, with unit
  bool has_silent_ = false;                     // an engine has left no result of some
  std::size_t done_ = 0;
  BatchEnd end_;
};

}  // namespace

BatchEnd run_batch(const BatchPlan& plan, const std::stop_token& stop,
                   const std::function<void(const BatchResult&, std::size_t)>& told) {
  return BatchRunner(plan, told).run(stop);
}

}  // namespace kerf
