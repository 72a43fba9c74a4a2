#include <array>

#include "base/translate.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

using T = KeyType;

constexpr std::array kFollowSettings{
    Setting{.key = "follow", .purpose = tr_noop("the program that the machine runs")},
    Setting{.key = "follow.program",
            .option = "--program",
            .commands = kBesideMachine,
            .key_counts_for = kBesideMachine,
            .type = T::kFile,
            .purpose = "NC program",
            .help = tr_noop("the program that the machine runs: its path is cut, what it does "
                            "beside it is found, and what it would hit is told beforehand"),
            .value_name = "FILE"},
    Setting{.option = "--ignore-loaded",
            .commands = kShadow,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop("beside LinuxCNC without --program: do not follow the program that it "
                            "has loaded"),
            .flag = "yes"},
    Setting{.option = "--next-program",
            .commands = kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("another program that the machine may run, repeatable: which one it "
                            "is, its path tells"),
            .value_name = "FILE",
            .repeatable = true},
    Setting{
        .key = "follow.path",
        .option = "--path",
        .commands = kAnyProcess,
        .key_counts_for = kBesideMachine,
        .type = T::kWord,
        .words = "programmed|planned",
        .purpose = tr_noop("what is cut: the path as written, or with the corners that G64 rounds"),
        .help =
            tr_noop("what is cut: programmed | planned, with corners rounded as the machine does "
                    "under G64 (default programmed; beside a machine whose INI is given: planned)"),
        .value_name = "NAME",
        .refusal = tr_noop("'{}' is no path; allowed: {}")},
    Setting{.key = "follow.off_path_mm",
            .option = "--off-path",
            .commands = kBesideMachine,
            .key_counts_for = kBesideMachine,
            .type = T::kNumber,
            .unit = "mm",
            .least = 0,
            .most = 1000,
            .least_excluded = true,
            .fallback = "0.5",
            .purpose = tr_noop("a tip farther from the path is off it"),
            .help = tr_noop("how far from the program's path the tip may be (default {})"),
            .value_name = "LENGTH"},
    Setting{.key = "follow.off_path_s",
            .type = T::kNumber,
            .unit = "s",
            .least = 0,
            .most = 3600,
            .least_excluded = true,
            .fallback = "2",
            .purpose =
                tr_noop("a machine that has cut for so long, and never been on it, runs another")},
    Setting{
        .key = "follow.joined_late",
        .option = "--joined-late",
        .commands = kBesideMachine,
        .key_counts_for = kBesideMachine,
        .type = T::kWord,
        .words = "cut|keep",
        .fallback = "cut",
        .purpose = tr_noop("of a program that runs already, what comes before is in the workpiece"),
        .help = tr_noop("what a program that runs already cuts before the machine is first seen: "
                        "cut | keep (default {}: it is in the workpiece)"),
        .value_name = "POLICY",
        .refusal = tr_noop("'{}' is no policy; allowed: {}")},
    Setting{
        .key = "follow.look_ahead_s",
        .option = "--look-ahead",
        .commands = kBesideMachine,
        .key_counts_for = kBesideMachine,
        .type = T::kNumber,
        .unit = "s",
        .least = 0,
        .most = 3600,
        .fallback = "10",
        .purpose = tr_noop("collisions are announced so long before; 0: never"),
        .help = tr_noop("how far ahead of the machine the program is run (default {}, 0 = not)"),
        .value_name = "SECONDS"},
    Setting{.key = "follow.on_program_end",
            .option = "--on-program-end",
            .commands = kBesideMachine,
            .key_counts_for = kBesideMachine,
            .type = T::kWord,
            .words = "keep|new-blank",
            .fallback = "keep",
            .purpose = tr_noop("the next program works on, or begins in a new blank"),
            .help = tr_noop("the workpiece when a program has come to its end: keep | new-blank, "
                            "for the next one to begin with (default {})"),
            .value_name = "POLICY",
            .refusal = tr_noop("'{}' is no policy; allowed: {}")},
    Setting{.option = "--from-line",
            .commands = kRun,
            .type = T::kWhole,
            .unit = "lines",
            .least = 1,
            .most = 4e9,
            .help = tr_noop("cut what comes before line N without a word, report from there"),
            .value_name = "N"},
    Setting{
        .option = "--enter",
        .commands = kRun,
        .type = T::kYesNo,
        .fallback = "no",
        .help = tr_noop("with --from-line: as LinuxCNC's \"run from here\" would go from there"),
        .flag = "yes"},
    Setting{.option = "--at",
            .commands = kRun,
            .type = T::kText,
            .help = tr_noop("with --enter: where the machine stands, in the program's coordinates; "
                            "live: by the configuration's source, as it is now (default: where the "
                            "program has it)"),
            .value_name = "X,Y,Z|live"},
    Setting{.option = "--until-line",
            .commands = kRun,
            .type = T::kWhole,
            .unit = "lines",
            .least = 1,
            .most = 4e9,
            .help = tr_noop("stop before the first move beyond line N"),
            .value_name = "N"},
    Setting{.option = "--until-line",
            .commands = kView,
            .type = T::kWhole,
            .unit = "lines",
            .least = 1,
            .most = 4e9,
            .help = tr_noop("nothing beyond line N"),
            .value_name = "N"},
    Setting{.option = "--at-line",
            .commands = kView,
            .type = T::kWhole,
            .unit = "lines",
            .least = 1,
            .most = 4e9,
            .help = tr_noop("begin at line N"),
            .value_name = "N"},
};

}  // namespace

std::span<const Setting> follow_settings() { return kFollowSettings; }

}  // namespace kerf
