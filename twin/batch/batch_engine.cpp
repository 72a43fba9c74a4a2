#include "twin/batch/batch_engine.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <thread>

#include "base/atomic_file.h"
#include "base/shell_word.h"
#include "base/small_file.h"
#include "base/spawn.h"
#include "base/translate.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

/// Slurm's own MaxArraySize is 1001 where nobody has set it: indices 0 to 1000.
constexpr std::size_t kMostOfAnArray = 1000;
constexpr std::size_t kMaxSaidBytes = 1U << 20U;
constexpr std::chrono::seconds kPatience{15};
constexpr std::chrono::milliseconds kLook{50};

std::string text_of_file(const std::string& path) {
  Result<std::string> text = read_small_file(path, kMaxSaidBytes);
  return text ? std::move(*text) : std::string();
}

/// The first line of what `sbatch --parsable` prints: "12" or "12;cluster".
std::string slurm_job(const std::string& said) {
  const std::string text = text_of_file(said);
  const std::string job = text.substr(0, text.find_first_of(";\n"));
  const bool is_number = !job.empty() && std::all_of(job.begin(), job.end(),
                                                     [](char c) { return c >= '0' && c <= '9'; });
  return is_number ? job : std::string();
}

/// The lines `first` on of the list are one array's; each task takes its own.
std::string slurm_script(const std::string& kerf, const std::string& list, std::size_t first) {
  return "#!/bin/sh\nunit=$(sed -n \"$((SLURM_ARRAY_TASK_ID + " + std::to_string(first + 1) +
         "))p\" " + shell_word(list) + ")\nexec " + shell_word(kerf) + " batch-unit \"$unit\"\n";
}

}  // namespace

const char* to_string(BatchEngine engine) {
  constexpr std::array kNames{"local", "parallel", "slurm"};
  return kNames[static_cast<std::size_t>(engine)];
}

Done EngineCall::begin(const std::vector<std::string>& words, const std::string& said) {
  Process process;
  process.said = said;
  process.pid = spawn_apart(words, said);
  if (process.pid < 0) {
    return Error{errno == ENOENT
                     ? trf("--engine {}: {} is not installed here", to_string(engine_), words[0])
                     : trf("{}: {}", words[0], std::strerror(errno))};
  }
  processes_.push_back(std::move(process));
  return std::monostate{};
}

Result<EngineCall> EngineCall::start(BatchEngine engine, const EngineWork& work) {
  std::error_code error;
  const std::string kerf = fs::read_symlink("/proc/self/exe", error).string();
  if (error) return Error{trf("{}: {}", "/proc/self/exe", error.message())};
  const fs::path folder = work.folder;
  const std::string list = (folder / "units").string();
  std::string lines;
  for (const std::string& unit : work.units) lines += unit + "\n";
  if (Done done = write_text(list, lines); !done) return Error{done.error()};
  EngineCall call(engine);
  if (engine == BatchEngine::kParallel) {
    // Quoted (-q) as whole words; time enough to end before they are killed.
    std::vector<std::string> words{"parallel", "-q",        "--arg-file",
                                   list,       "--termseq", "TERM,4000,KILL,25"};
    if (work.jobs > 0) words.insert(words.end(), {"--jobs", std::to_string(work.jobs)});
    words.insert(words.end(), {kerf, "batch-unit", "{}"});
    if (Done done = call.begin(words, (folder / "parallel.txt").string()); !done) {
      return Error{done.error()};
    }
    return call;
  }
  for (std::size_t first = 0; first < work.units.size(); first += kMostOfAnArray) {
    const std::string number = std::to_string(first / kMostOfAnArray);
    const std::string script = (folder / ("array-" + number + ".sh")).string();
    if (Done done = write_text(script, slurm_script(kerf, list, first)); !done) {
      return Error{done.error()};
    }
    const std::size_t last = std::min(work.units.size() - first, kMostOfAnArray) - 1;
    std::string array = "--array=0-" + std::to_string(last);
    if (work.jobs > 0) array += "%" + std::to_string(work.jobs);
    const std::vector<std::string> words{
        "sbatch",     "--wait",
        "--parsable", "--job-name=kerf",
        array,        "--output=" + (folder / ("task-" + number + "-%a.txt")).string(),
        script};
    if (Done done = call.begin(words, (folder / ("sbatch-" + number + ".txt")).string()); !done) {
      return Error{done.error()};  // the destructor ends those that have begun
    }
  }
  return call;
}

bool EngineCall::has_ended() {
  bool all = true;
  for (Process& process : processes_) {
    if (process.pid > 0 && waitpid(process.pid, &process.status, WNOHANG) == process.pid) {
      process.pid = -1;
    }
    all = all && process.pid < 0;
  }
  return all;
}

void EngineCall::cancel() const {
  for (const Process& process : processes_) {
    if (process.pid < 0) continue;
    if (engine_ == BatchEngine::kParallel) {
      // Asked once it would wait for what runs; asked twice it ends that.
      kill(process.pid, SIGTERM);
      std::this_thread::sleep_for(kLook);
      kill(process.pid, SIGTERM);
    } else if (const std::string job = slurm_job(process.said); !job.empty()) {
      const pid_t scancel = spawn_apart({"scancel", job}, "/dev/null");
      if (scancel > 0) waitpid(scancel, nullptr, 0);
    } else {
      kill(process.pid, SIGTERM);  // not submitted yet
    }
  }
}

void EngineCall::await_end() {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!has_ended() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kLook);
  for (Process& process : processes_) {
    if (process.pid < 0) continue;
    kill(-process.pid, SIGKILL);
    waitpid(process.pid, &process.status, 0);
    process.pid = -1;
  }
}

void EngineCall::stop() {
  if (has_ended()) return;
  cancel();
  await_end();
}

void EngineCall::finish() {
  // sbatch looks every some seconds, and the job ends without it.
  if (engine_ == BatchEngine::kSlurm && !has_ended()) {
    for (const Process& process : processes_) {
      if (process.pid > 0) kill(process.pid, SIGTERM);
    }
  }
  await_end();
}

EngineCall::~EngineCall() { stop(); }

std::string EngineCall::refusal() const {
  for (const Process& process : processes_) {
    const bool refused = engine_ == BatchEngine::kSlurm
                             ? slurm_job(process.said).empty()
                             : !WIFEXITED(process.status) || WEXITSTATUS(process.status) == 255;
    if (!refused) continue;
    std::string text = text_of_file(process.said);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    if (const std::size_t line = text.rfind('\n'); line != text.npos) text.erase(0, line + 1);
    return text.empty() ? std::string(to_string(engine_)) : text;
  }
  return {};
}

}  // namespace kerf
