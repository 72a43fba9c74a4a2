#include <array>

#include "base/translate.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

using T = KeyType;

constexpr std::array kJobSettings{
    Setting{.option = "JOB",
            .commands = kJob,
            .type = T::kFile,
            .help = tr_noop("YAML file with the setups of a part (docs/several-setups.md)"),
            .required = true},
    Setting{.option = "--check",
            .commands = kJob,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop("look at the file alone; nothing is cut"),
            .flag = "yes"},
    Setting{.option = "--json",
            .commands = kJob,
            .type = T::kFile,
            .help = tr_noop("report over all setups (kerf-job/1), with that of each"),
            .value_name = "FILE"},
    Setting{.option = "--png",
            .commands = kJob,
            .type = T::kFolder,
            .help = tr_noop("pictures of what each setup leaves: setup-1.png .. in this folder"),
            .value_name = "DIR"},
    Setting{.option = "--setup",
            .commands = kView,
            .type = T::kWhole,
            .unit = "setups",
            .least = 1,
            .most = 1000,
            .fallback = "1",
            .help = tr_noop("of a job (a YAML file with setups): begin with this one; those "
                            "before it are run unseen (default {})"),
            .value_name = "N"},
    Setting{.option = "--units",
            .commands = kJob,
            .type = T::kWord,
            .words = "mm|inch",
            .fallback = "mm",
            .help = tr_noop("of lengths that are shown: mm | inch; in the file they are mm"),
            .value_name = "NAME"},
    Setting{.option = "--quiet",
            .commands = kJob,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop("no summaries, no progress bar, no warnings"),
            .flag = "yes"},
};

}  // namespace

std::span<const Setting> job_settings() { return kJobSettings; }

}  // namespace kerf
