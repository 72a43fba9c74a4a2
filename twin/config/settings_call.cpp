#include <array>

#include "base/translate.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

using T = KeyType;

constexpr std::array kCallSettings{
    Setting{.option = "PROGRAM",
            .commands = kRun,
            .type = T::kFile,
            .help = tr_noop(
                "NC file, saved canonical listing (.canon), or - (either of them on stdin); "
                "several are run one after the other, and the exit code is the worst of them"),
            .repeatable = true,
            .required = true},
    Setting{.option = "PROGRAM",
            .commands = kView,
            .type = T::kFile,
            .help = tr_noop("NC file, saved canonical listing (.canon), a log, or a saved "
                            "workpiece; without: an empty window, from which one can be opened")},
    Setting{.option = "PROGRAM",
            .commands = kCanon,
            .type = T::kFile,
            .help = tr_noop(
                "NC file, saved canonical listing (.canon), or - (either of them on stdin)"),
            .required = true},
    Setting{.option = "PROGRAM",
            .commands = kMachine,
            .type = T::kFile,
            .help = tr_noop("NC file, saved listing (.canon), or -"),
            .required = true},
    Setting{.option = "A",
            .commands = kDiff,
            .type = T::kFile,
            .help = tr_noop("NC file, saved canonical listing (.canon), or saved workpiece"),
            .required = true},
    Setting{.option = "B",
            .commands = kDiff,
            .type = T::kFile,
            .help = tr_noop("another one, to be held against it"),
            .required = true},
    Setting{.option = "ACTION",
            .commands = kConfig,
            .type = T::kWord,
            .words = "check|print|schema|completion|man",
            .help = tr_noop("check | print | schema; completion or man, of kerf itself"),
            .required = true},
    Setting{.option = "FILE",
            .commands = kConfig,
            .type = T::kFile,
            .help = tr_noop("the configuration; after completion the shell: bash | zsh; after man "
                            "a page: kerf-run")},
    Setting{.option = "--config",
            .commands = kRun | kDiff | kOptimize,
            .type = T::kFile,
            .help = tr_noop("configuration: machine, beam, tools, stock"),
            .value_name = "FILE",
            .short_name = "-c"},
    Setting{.option = "--config",
            .commands = kView,
            .type = T::kFile,
            .help = tr_noop("configuration: machine (its model), tools, stock, view"),
            .value_name = "FILE",
            .short_name = "-c"},
    Setting{.option = "--config",
            .commands = kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("configuration: source, machine, tools, stock"),
            .value_name = "FILE",
            .short_name = "-c"},
    Setting{.option = "--set",
            .commands = kCutting | kConfig,
            .type = T::kText,
            .help = tr_noop("any key of the configuration, repeatable"),
            .value_name = "KEY=VALUE",
            .repeatable = true},
    Setting{.key = "units",
            .option = "--units",
            .commands = kCutting | kCanon,
            .type = T::kWord,
            .words = "mm|inch",
            .fallback = "mm",
            .purpose = tr_noop("of lengths that options give, and of what is shown; those of a "
                               "configuration are mm"),
            .help = tr_noop("unit of every LENGTH and of the figures in SPEC, SHAPE and X,Y,Z, and "
                            "of what is shown (default {}; files that are read or written are not "
                            "touched: JSON is mm)"),
            .value_name = "mm|inch"},
    Setting{.option = "FILE",
            .commands = kTools,
            .type = T::kFile,
            .help = tr_noop("a tool library: what its tools are understood as")},
    Setting{.option = "--holders",
            .commands = kTools,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop("list the holders that have a name"),
            .flag = "yes"},
    Setting{.option = "--inserts",
            .commands = kTools,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop("list the indexable inserts that iso:CODE knows, with their sizes"),
            .flag = "yes"},
    Setting{.option = "--json",
            .commands = kTools,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop("for programs: one JSON document, in mm"),
            .flag = "yes"},
    Setting{.option = "--units",
            .commands = kTools,
            .type = T::kWord,
            .words = "mm|inch",
            .fallback = "mm",
            .help = tr_noop("of the lengths (default {})"),
            .value_name = "mm|inch"},
};

}  // namespace

std::span<const Setting> call_settings() { return kCallSettings; }

}  // namespace kerf
