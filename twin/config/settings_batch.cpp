#include <array>

#include "base/translate.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

using T = KeyType;

constexpr std::array kBatchSettings{
    Setting{.option = "WHAT",
            .commands = kBatch,
            .type = T::kFile,
            .help = tr_noop("programs, folders of programs, patterns in quotes ('parts/*.ngc'), or "
                            "lists: files with one of these a line; - is a list on stdin"),
            .repeatable = true,
            .required = true},
    Setting{.option = "--out",
            .commands = kBatch,
            .type = T::kFolder,
            .help = tr_noop("folder of all results; with those of an earlier batch that still "
                            "hold, these are not made again"),
            .value_name = "DIR",
            .required = true},
    Setting{.option = "--jobs",
            .commands = kBatch,
            .type = T::kWhole,
            .unit = "programs",
            .least = 1,
            .most = 1024,
            .help = tr_noop("programs that run at a time (default: as many as there are cores, or "
                            "as the engine likes)"),
            .value_name = "N"},
    Setting{.option = "--engine",
            .commands = kBatch,
            .type = T::kWord,
            .words = "local|parallel|slurm",
            .fallback = "local",
            .help = tr_noop("who runs them: local | parallel (GNU parallel, also by ssh) | slurm "
                            "(an array of jobs); default {}"),
            .value_name = "ENGINE",
            .refusal = tr_noop("'{}' is no engine; allowed: {}")},
    Setting{.option = "--each-seconds",
            .commands = kBatch,
            .type = T::kNumber,
            .unit = "s",
            .least = 0,
            .most = 1e6,
            .least_excluded = true,
            .fallback = "3600",
            .help = tr_noop("a program that takes longer is ended, and that is its result "
                            "(default {})"),
            .value_name = "S"},
    Setting{.option = "--folder",
            .commands = kMcp,
            .type = T::kFolder,
            .fallback = ".",
            .help = tr_noop("what the client may name lies in this folder; files outside of it "
                            "are refused (default: the current one)"),
            .value_name = "DIR"},
    Setting{.option = "--each-seconds",
            .commands = kMcp,
            .type = T::kNumber,
            .unit = "s",
            .least = 0,
            .most = 1e6,
            .least_excluded = true,
            .fallback = "120",
            .help = tr_noop("a call that takes longer is ended, and that is its result "
                            "(default {})"),
            .value_name = "S"},
    Setting{.option = "--each-memory",
            .commands = kBatch | kMcp,
            .type = T::kNumber,
            .unit = "MB",
            .least = 64,
            .most = 1e7,
            .help = tr_noop("memory that each process of a run may allocate; one that wants more "
                            "ends, and that is its result (default: no bound)"),
            .value_name = "MB"},
    Setting{.option = "--options",
            .commands = kBatch,
            .type = T::kFile,
            .help = tr_noop("options by program, lines of PATTERN: OPTIONS; each line that fits "
                            "counts, a later one before an earlier one"),
            .value_name = "FILE"},
    Setting{.option = "--again",
            .commands = kBatch,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop("run all programs, those with a result that holds as well"),
            .flag = "yes"},
};

}  // namespace

std::span<const Setting> batch_settings() { return kBatchSettings; }

}  // namespace kerf
