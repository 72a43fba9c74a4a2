// kerf-interp - LinuxCNC's interpreter in a process of its own: reads an NC program, writes what it
// commands as records (README.md).
#include <unistd.h>

#include <array>
#include <canon.hh>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <interp_base.hh>
#include <interp_return.hh>
#include <optional>
#include <vector>

#include "interp_bridge/canonical.h"
#include "interp_bridge/kerf_interp/fast_numbers.h"
#include "interp_bridge/kerf_interp/mode_watch.h"
#include "interp_bridge/kerf_interp/options.h"
#include "interp_bridge/kerf_interp/reads.h"
#include "interp_bridge/kerf_interp/recording.h"

// ---- What librs274 expects of whoever links it
// ------------------------------------------------------

struct _object;
extern "C" {
_object* PyInit_interpreter(void);
_object* PyInit_emccanon(void);
}
/// Python's own struct; declared here so that its headers are not needed.
struct _inittab {
  const char* name;
  _object* (*function)(void);
};
extern _inittab builtin_modules[3];
_inittab builtin_modules[3] = {
    {"interpreter", PyInit_interpreter}, {"emccanon", PyInit_emccanon}, {nullptr, nullptr}};
extern int _task;
int _task = 0;
USER_DEFINED_FUNCTION_TYPE USER_DEFINED_FUNCTION[USER_DEFINED_FUNCTION_NUM] = {};
int USER_DEFINED_FUNCTION_ADD(USER_DEFINED_FUNCTION_TYPE function, int number) {
  USER_DEFINED_FUNCTION[number] = function;
  return 0;
}

namespace kerf::interp {
namespace {

using Clock = std::chrono::steady_clock;

/// How often the clock is looked at: about every half millisecond.
constexpr unsigned kBlocksPerLook = 256;
constexpr std::chrono::milliseconds kOldRecords{20};
constexpr std::chrono::milliseconds kSignOfLife{200};

/// Whether G28.1, G30.1 or G10 may be among the words; kerf reads them. Most blocks have neither
/// "28", "30" nor "10".
bool may_store(const char* text) {
  for (const char* g = std::strpbrk(text, "gG"); g != nullptr; g = std::strpbrk(g, "gG")) {
    for (++g; *g == ' ' || *g == '\t' || *g == '0';) ++g;
    const char first = *g;
    if (first != '1' && first != '2' && first != '3') continue;
    for (++g; *g == ' ' || *g == '\t';) ++g;
    if (*g == (first == '2' ? '8' : '0')) return true;
  }
  return false;
}

/// M100 to M199: a machine would start a program of that name, which is its own affair.
void user_m(int number, double p, double q) {
  recording().records->numbers(records::kUserM, recording().line_now(), {100.0 + number, p, q});
  World& world = recording().world;
  constexpr int kMaterialChange = 90;
  if (world.qtplasmac && number == kMaterialChange) {
    constexpr double kLargest = 2e9;
    world.materials.select(p >= 0 && p <= kLargest ? static_cast<int>(p) : -1);
  }
}

class Runner {
 public:
  Runner(InterpBase& interpreter, RecordWriter& records)
      : interpreter_(interpreter), records_(records) {}

  bool run(const Options& options) {
    if (!succeeded(interpreter_.init())) return report(0);
    // Only a random tool changer begins with a tool; said as M61 would.
    const int mounted = recording().world.row(0).toolno;
    if (mounted > 0) {
      records_.numbers(static_cast<std::uint8_t>(CanonicalName::kChangeToolNumber), 0,
                       {0.0, static_cast<double>(mounted)});
    }
    if (!options.startup.empty() && !succeeded(interpreter_.execute(options.startup.c_str()))) {
      return report(0);
    }
    if (!succeeded(interpreter_.open(options.program.c_str()))) return report(0);
    first_line_ = options.first_line;
    there_ = options.there;
    records_.leave_out_deeds(first_line_ > 1);
    if (first_line_ > 0) modes_.begin(interpreter_);
    return run_blocks();
  }
  std::uint64_t blocks() const { return blocks_; }

 private:
  /// A block that calls an O-word from outside its own level.
  struct Caller {
    int file;
    int line;
  };

  bool succeeded(int status) {
    status_ = status;
    return status >= 0 && status <= INTERP_MIN_ERROR;
  }

  bool run_blocks() {
    for (;;) {
      // An error unwinds the interpreter's calls before it is returned: its own idea of the line is
      // then that of the outermost call.
      if (!succeeded(interpreter_.read())) {
        return report(callers_.empty() ? interpreter_.sequence_number() : line_ + 1);
      }
      if (status_ == INTERP_ENDFILE) return true;
      line_ = interpreter_.sequence_number();
      recording().begin_block(line_);
      note_store();
      if (!succeeded(interpreter_.execute())) return report(line_);
      if (!recording().refusal.empty()) return report_refusal();
      if (status_ == INTERP_EXIT) return true;
      if (first_line_ > 0) {
        modes_.follow(interpreter_, callers_.empty() ? line_ : callers_.front().line);
      }
      const int level = interpreter_.call_level();
      if (level != static_cast<int>(callers_.size())) {
        recording().block_does_not_move();
        follow_call(level);
      } else if (level > 0) {
        recording().find_file();
      }
      if (first_line_ > 0 && level == 0 && line_ + 1 >= first_line_) begin_here();
      if (++blocks_ % kBlocksPerLook == 0) look_at_clock();
    }
  }

  /// What comes before the first line has been read. LinuxCNC takes the machine for where it stands
  /// then (emctaskmain.cc: programStartLine), and knows the modes; of tools it knows what M6 said.
  void begin_here() {
    records_.leave_out_deeds(false);
    World& world = recording().world;
    Pose at{};
    for (std::size_t axis = 0; axis < at.size(); ++axis) {
      const double unit = is_length(axis) ? world.unit_mm() : 1.0;
      at[axis] = there_ ? (*there_)[axis] / unit : world.position(axis);
    }
    // Of no line: LinuxCNC would lose a feed of the same block as M61.
    if (const int row = world.loaded_row(); row > 0) {
      records_.numbers(static_cast<std::uint8_t>(CanonicalName::kChangeToolNumber), 0,
                       {static_cast<double>(row), static_cast<double>(world.row(row).toolno)});
    }
    if (const std::vector<double>& offset = recording().length_offset; !offset.empty()) {
      records_.numbers(static_cast<std::uint8_t>(CanonicalName::kUseToolLengthOffset),
                       recording().length_offset_line, offset.data(), offset.size());
    }
    modes_.write(records_);
    records_.numbers(records::kHere, first_line_, {});
    records_.numbers(static_cast<std::uint8_t>(CanonicalName::kStraightTraverse), first_line_,
                     at.data(), at.size());
    world.move_to(at);
    interpreter_.synch();
    first_line_ = 0;
  }

  /// No call comes of what a block keeps for later, so that it is told before it is run.
  void note_store() {
    std::array<char, 260> text;
    text.front() = text.back() = 0;
    interpreter_.line_text(text.data(), text.size() - 1);
    if (!may_store(text.data())) return;
    records_.numbers(records::kStore, recording().line_now(), {});
  }

  void follow_call(int level) {
    callers_.resize(static_cast<std::size_t>(level > 0 ? level : 0),
                    Caller{recording().file(), line_});
    recording().moved_to_level(level);
  }

  void look_at_clock() {
    const Clock::time_point now = Clock::now();
    if (records_.empty()) {
      if (now - flushed_ < kSignOfLife) return;
      records_.numbers(records::kAt, line_, {});
    } else if (now - flushed_ < kOldRecords) {
      return;
    }
    records_.flush();
    flushed_ = now;
  }

  /// The machine stands: it does not do what the block asks for.
  bool report_refusal() {
    records_.text(records::kError, line_, recording().refusal);
    return report_place(line_);
  }

  bool report(int line) {
    std::array<char, 1024> text{};
    interpreter_.error_text(status_, text.data(), text.size() - 1);
    records_.text(records::kError, line, text.data());
    return report_place(line);
  }

  bool report_place(int line) {
    std::array<char, 1024> text{};
    interpreter_.line_text(text.data(), text.size() - 1);
    records_.text(records::kEcho, line, text.data());
    for (auto caller = callers_.rbegin(); caller != callers_.rend(); ++caller) {
      records_.numbers(records::kCaller, caller->line, {static_cast<double>(caller->file)});
    }
    return false;
  }

  InterpBase& interpreter_;
  RecordWriter& records_;
  int status_ = INTERP_OK;
  std::uint64_t blocks_ = 0;
  int line_ = 0;        ///< of the block read last
  int first_line_ = 0;  ///< still to come; 0: none is
  std::optional<Pose> there_;
  ModeWatch modes_;
  std::vector<Caller> callers_;
  Clock::time_point flushed_ = Clock::now();
};

int run(int argc, char** argv) {
  Options options;
  if (!read_options(argc, argv, options, recording().world)) return 2;
  for (USER_DEFINED_FUNCTION_TYPE& function : USER_DEFINED_FUNCTION) function = user_m;
  RecordWriter records(options.records_fd);
  InterpBase* const interpreter = makeInterp();
  recording().records = &records;
  recording().answers_fd = options.answers_fd;
  recording().begin(options.program);
  recording().interpreter = interpreter;
  if (options.fast != Options::Fast::kOff && !use_fast_numbers(*interpreter) &&
      options.fast == Options::Fast::kMust) {
    std::fputs("kerf-interp: --fast must: this LinuxCNC is not one whose numbers it can read\n",
               stderr);
    return 2;
  }
  Runner runner(*interpreter, records);
  const bool ended = runner.run(options);
  write_reads(records);
  records.numbers(records::kEnd, 0, {ended ? 1.0 : 0.0, static_cast<double>(runner.blocks())});
  records.flush();
  std::fflush(nullptr);
  return ended ? 0 : 1;
}

}  // namespace
}  // namespace kerf::interp

int main(int argc, char** argv) {
  const int status = kerf::interp::run(argc, argv);
  // Without the destructors of Python and of the interpreter, which would write the parameters
  // again.
  _exit(status);
}
