#include "machine_io/logs/log_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "machine_io/logs/number_text.h"
#include "machine_io/recording_format.h"

namespace kerf {
namespace {

/// More are no log of a machine.
constexpr std::size_t kMostColumns = 1000;
constexpr std::string_view kAxisLetters = "xyzabcuvw";
constexpr std::uint16_t kRotaryAxes = 0b000111000;  // A B C

/// What a name means before units. Of two for the same thing the lower rank is taken.
struct Meaning {
  ColumnRole role = ColumnRole::kIgnored;
  std::size_t index = 0;
  CoordinateKind kind = CoordinateKind::kAxes;
  int rank = 0;
};

enum class Quantity : std::uint8_t { kNone, kTime, kLength, kAngle, kSpeed };

struct Unit {
  std::string_view name;
  Quantity quantity;
  double mm = 1.0;
  std::int64_t ns = 0;
};

constexpr std::array<Unit, 13> kUnits{{
    {"mm", Quantity::kLength, 1.0},
    {"um", Quantity::kLength, 0.001},
    {"m", Quantity::kLength, 1000.0},
    {"in", Quantity::kLength, kMmPerInch},
    {"inch", Quantity::kLength, kMmPerInch},
    {"deg", Quantity::kAngle},
    {"degree", Quantity::kAngle},
    {"degrees", Quantity::kAngle},
    {"s", Quantity::kTime, 0.0, 1'000'000'000},
    {"ms", Quantity::kTime, 0.0, 1'000'000},
    {"us", Quantity::kTime, 0.0, 1'000},
    {"ns", Quantity::kTime, 0.0, 1},
    {"rpm", Quantity::kSpeed},
}};

constexpr const char* kUnitsAllowed =
    tr_noop("mm, um, m, in or inch for lengths, deg for angles, s, ms, us or ns for times");

const Unit* unit_named(std::string_view name) {
  const auto it = std::find_if(kUnits.begin(), kUnits.end(),
                               [name](const Unit& unit) { return unit.name == name; });
  return it == kUnits.end() ? nullptr : &*it;
}

std::optional<std::size_t> joint_number(std::string_view text) {
  if (text.size() != 1 || text[0] < '0' || text[0] > '8') return std::nullopt;
  return static_cast<std::size_t>(text[0] - '0');
}

std::optional<std::size_t> axis_number(std::string_view text) {
  if (text.size() != 1) return std::nullopt;
  const std::size_t at = kAxisLetters.find(text[0]);
  return at == std::string_view::npos ? std::nullopt : std::optional(at);
}

/// joint.N.pos-fb and the like.
std::optional<Meaning> read_hal_pin(std::string_view name) {
  const bool is_halui = take_prefix(name, "halui.");
  const bool is_joint = take_prefix(name, "joint.");
  if (!is_joint && !take_prefix(name, "axis.")) return std::nullopt;
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const auto index =
      is_joint ? joint_number(name.substr(0, dot)) : axis_number(name.substr(0, dot));
  const std::string_view what = name.substr(dot + 1);
  if (!index) return std::nullopt;
  const auto kind = is_joint ? CoordinateKind::kJoints : CoordinateKind::kAxes;
  const auto meaning = [&](int rank) { return Meaning{ColumnRole::kPosition, *index, kind, rank}; };
  if (is_halui) {
    return what == "pos-feedback" ? std::optional(meaning(is_joint ? 1 : 3)) : std::nullopt;
  }
  if (is_joint && what == "pos-fb") return meaning(1);
  if (is_joint && what == "pos-cmd") return meaning(2);
  if (!is_joint && what == "pos-cmd") return meaning(4);
  return std::nullopt;
}

std::optional<Meaning> read_name(std::string_view name) {
  struct Fixed {
    std::string_view name;
    Meaning meaning;
  };
  static constexpr auto kAxes = CoordinateKind::kAxes;
  static constexpr std::array<Fixed, 18> kFixed{{
      {"t", {ColumnRole::kDeviceTime, 0, kAxes, 0}},
      {"time", {ColumnRole::kDeviceTime, 0, kAxes, 0}},
      {"timestamp", {ColumnRole::kDeviceTime, 0, kAxes, 0}},
      {"t_device", {ColumnRole::kDeviceTime, 0, kAxes, 0}},
      {"time_device", {ColumnRole::kDeviceTime, 0, kAxes, 0}},
      {"t_host", {ColumnRole::kHostTime, 0, kAxes, 0}},
      {"time_host", {ColumnRole::kHostTime, 0, kAxes, 0}},
      {"tool", {ColumnRole::kTool, 0, kAxes, 0}},
      {"tool_number", {ColumnRole::kTool, 0, kAxes, 0}},
      {"iocontrol.0.tool-number", {ColumnRole::kTool, 0, kAxes, 1}},
      {"line", {ColumnRole::kLine, 0, kAxes, 0}},
      {"program_line", {ColumnRole::kLine, 0, kAxes, 0}},
      {"motion.program-line", {ColumnRole::kLine, 0, kAxes, 1}},
      {"tool_offset_z", {ColumnRole::kToolOffsetZ, 0, kAxes, 0}},
      {"tloz", {ColumnRole::kToolOffsetZ, 0, kAxes, 0}},
      {"motion.tooloffset.z", {ColumnRole::kToolOffsetZ, 0, kAxes, 1}},
      {"rpm", {ColumnRole::kSpindle, 0, kAxes, 0}},
      {"spindle.0.speed-out", {ColumnRole::kSpindle, 0, kAxes, 1}},
  }};
  for (const Fixed& fixed : kFixed) {
    if (fixed.name == name) return fixed.meaning;
  }
  if (name == "spindle" || name == "spindle_rpm") return Meaning{ColumnRole::kSpindle};
  if (name == "trigger") return Meaning{ColumnRole::kTrigger};
  if (name == "program") return Meaning{ColumnRole::kProgram};
  for (std::size_t unit = 0; unit < kLoadUnits; ++unit) {
    if (name == kLoadColumns[unit]) return Meaning{ColumnRole::kLoad, unit};
  }
  if (const auto axis = axis_number(name)) {
    return Meaning{ColumnRole::kPosition, *axis, CoordinateKind::kAxes, 0};
  }
  std::string_view number = name;
  if (take_prefix(number, "joint") || take_prefix(number, "j")) {
    if (number.starts_with('_') || number.starts_with('.')) number.remove_prefix(1);
    if (const auto joint = joint_number(number)) {
      return Meaning{ColumnRole::kPosition, *joint, CoordinateKind::kJoints, 0};
    }
  }
  return read_hal_pin(name);
}

struct Named {
  Meaning meaning;
  const Unit* unit = nullptr;
  std::string unknown_unit;  // "furlong" of "x [furlong]"
};

bool is_unit_fit(const Meaning& meaning, const Unit& unit) {
  switch (meaning.role) {
    case ColumnRole::kHostTime:
    case ColumnRole::kDeviceTime:
      return unit.quantity == Quantity::kTime;
    case ColumnRole::kPosition:
      return unit.quantity == Quantity::kLength || unit.quantity == Quantity::kAngle;
    case ColumnRole::kToolOffsetZ:
      return unit.quantity == Quantity::kLength;
    case ColumnRole::kSpindle:
      return unit.quantity == Quantity::kSpeed;
    default:
      return false;
  }
}

/// "x [mm]", "x(mm)", "x_mm", "x".
std::optional<Named> read_column_name(std::string_view text) {
  const std::string whole = to_lower(trim(text, is_blank));
  const std::string_view name = whole;
  if (const auto meaning = read_name(name)) return Named{*meaning, nullptr, {}};
  const std::size_t bracket = name.find_first_of("[(");
  if (bracket != std::string_view::npos && (name.back() == ']' || name.back() == ')')) {
    const auto meaning = read_name(trim(name.substr(0, bracket), is_blank));
    if (!meaning) return std::nullopt;
    const std::string_view unit =
        trim(name.substr(bracket + 1, name.size() - bracket - 2), is_blank);
    const Unit* known = unit_named(unit);
    return Named{*meaning, known, known == nullptr ? std::string(unit) : std::string()};
  }
  const std::size_t score = name.rfind('_');
  if (score == std::string_view::npos) return std::nullopt;
  const Unit* unit = unit_named(name.substr(score + 1));
  const auto meaning = read_name(name.substr(0, score));
  // "line_s" is a word of somebody's own, not a program line in seconds.
  if (unit == nullptr || !meaning || !is_unit_fit(*meaning, *unit)) return std::nullopt;
  return Named{*meaning, unit, {}};
}

bool is_length(const Meaning& meaning, const LogSettings& settings) {
  if (meaning.role == ColumnRole::kToolOffsetZ) return true;
  if (meaning.role != ColumnRole::kPosition) return false;
  const std::uint16_t rotary =
      meaning.kind == CoordinateKind::kJoints ? settings.rotary_joints : kRotaryAxes;
  return (rotary >> meaning.index & 1U) == 0;
}

LogColumn column_of(const Named& named, const LogSettings& settings) {
  LogColumn column;
  column.role = named.meaning.role;
  column.index = static_cast<std::uint8_t>(named.meaning.index);
  if (column.role == ColumnRole::kLoad) {
    column.load_unit = static_cast<LoadUnit>(named.meaning.index);
    column.index = 0;
    if (settings.load && named.meaning.rank < 0) {
      column.factor = settings.load->scale;
      column.offset = settings.load->offset;
    }
  }
  if (named.unit != nullptr) {
    if (named.unit->quantity == Quantity::kTime) column.ns_per_unit = named.unit->ns;
    column.factor = named.unit->mm;
  } else if (settings.unit == LogUnit::kInch && is_length(named.meaning, settings)) {
    column.factor = kMmPerInch;
  }
  if (column.role == ColumnRole::kHostTime || column.role == ColumnRole::kDeviceTime) {
    column.factor = 1.0;
  }
  return column;
}

/// One thing that a column can be, positions apart by kind and index.
bool is_same_thing(const Meaning& a, const Meaning& b) {
  if (a.role == ColumnRole::kLoad && b.role == a.role) return true;
  return a.role == b.role && a.index == b.index && a.kind == b.kind;
}

/// Joints or axes: what has the better names. Both as good: nothing.
std::optional<CoordinateKind> better_kind(const std::vector<std::optional<Named>>& named) {
  int joints = 99;
  int axes = 99;
  for (const auto& one : named) {
    if (!one || one->meaning.role != ColumnRole::kPosition) continue;
    int& best = one->meaning.kind == CoordinateKind::kJoints ? joints : axes;
    best = std::min(best, one->meaning.rank);
  }
  if (joints == axes) return std::nullopt;
  return joints < axes ? CoordinateKind::kJoints : CoordinateKind::kAxes;
}

std::string list_of(const std::vector<ColumnName>& names) {
  std::string list;
  for (const ColumnName& name : names) {
    if (!list.empty()) list += ", ";
    if (list.size() > 400) return list + "..";
    list += name.text;
  }
  return list;
}

using AllNamed = std::vector<std::optional<Named>>;

bool is_position(const std::optional<Named>& one) {
  return one && one->meaning.role == ColumnRole::kPosition;
}

void check_units(const std::vector<ColumnName>& names, const AllNamed& named,
                 std::vector<ColumnFault>& faults) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!named[i]) continue;
    const Unit* unit = named[i]->unit;
    const bool is_fit = unit == nullptr || is_unit_fit(named[i]->meaning, *unit);
    if (named[i]->unknown_unit.empty() && is_fit) continue;
    faults.push_back({names[i].column,
                      trf("column '{}': the unit is not one that fits; allowed are {}",
                          names[i].text, tr(kUnitsAllowed)),
                      ""});
  }
}

/// The column that the user calls the load goes before those that are called so themselves.
bool name_load(const std::vector<ColumnName>& names, const LogLoad& load, AllNamed& named) {
  const std::string wanted = to_lower(trim(load.column, is_blank));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (to_lower(trim(names[i].text, is_blank)) != wanted) continue;
    constexpr int kFirst = -1;
    const auto unit = static_cast<std::size_t>(load.unit);
    named[i] = Named{{ColumnRole::kLoad, unit, CoordinateKind::kAxes, kFirst}, nullptr, {}};
    return true;
  }
  return false;
}

/// False: no part in a sample, of the other kind of positions, or another column has the same
/// meaning and a better name. Two as good are a fault.
bool is_taken(const std::vector<ColumnName>& names, const AllNamed& named, std::size_t i,
              CoordinateKind kind, std::vector<ColumnFault>& faults) {
  if (!named[i] || (is_position(named[i]) && named[i]->meaning.kind != kind)) return false;
  const Meaning& mine = named[i]->meaning;
  for (std::size_t other = 0; other < named.size(); ++other) {
    if (other == i || !named[other] || !is_same_thing(named[other]->meaning, mine)) continue;
    if (named[other]->meaning.rank < mine.rank) return false;
    if (named[other]->meaning.rank > mine.rank || other > i) continue;
    faults.push_back({names[i].column,
                      trf("columns '{}' and '{}' are the same thing: which is meant is not clear",
                          names[other].text, names[i].text),
                      tr("rename the one that is not wanted")});
    break;  // once a column
  }
  return true;
}

}  // namespace

bool find_columns(const std::vector<ColumnName>& names, const LogSettings& settings,
                  LogColumns& found, std::vector<ColumnFault>& faults) {
  if (names.size() > kMostColumns) {
    faults.push_back({0,
                      trf("the header has {} columns; {} are the most that kerf reads",
                          names.size(), kMostColumns),
                      tr("is this a log of positions?")});
    return false;
  }
  AllNamed named;
  for (const ColumnName& name : names) named.push_back(read_column_name(name.text));
  if (settings.load && !name_load(names, *settings.load, named)) {
    faults.push_back({0,
                      trf("source.map.load.pin: no column is called '{}'; found: {}",
                          settings.load->column, list_of(names)),
                      ""});
    return false;
  }
  check_units(names, named, faults);
  if (std::none_of(named.begin(), named.end(), is_position)) {
    faults.push_back(
        {names.empty() ? 0 : names.front().column,
         trf("none of the columns is a position; found: {}", list_of(names)),
         tr("allowed are x y z a b c u v w, j0 to j8, joint0 to joint8 and HAL's joint.N.pos-fb, "
            "joint.N.pos-cmd, axis.L.pos-cmd; with a unit, if wanted: x_mm, \"x [in]\", x(mm)")});
    return false;
  }
  found.kind = better_kind(named);
  if (!found.kind) {
    faults.push_back({0,
                      tr("there are columns for joints and for axes: which are meant is not clear"),
                      tr("rename those that are not wanted")});
    return false;
  }
  for (std::size_t i = 0; i < named.size(); ++i) {
    found.columns.emplace_back();
    if (!is_taken(names, named, i, *found.kind, faults)) {
      if (!names[i].text.empty()) found.ignored.push_back(names[i].text);
      continue;
    }
    found.columns.back() = column_of(*named[i], settings);
    const ColumnRole role = found.columns.back().role;
    if (role == ColumnRole::kPosition) {
      found.positions = static_cast<std::uint16_t>(found.positions | 1U << named[i]->meaning.index);
    }
    if (role == ColumnRole::kLoad) found.load = found.columns.back().load_unit;
    found.has_time |= role == ColumnRole::kHostTime || role == ColumnRole::kDeviceTime;
  }
  return faults.empty();
}

char find_delimiter(std::string_view line) {
  static constexpr std::array<char, 3> kDelimiters{',', ';', '\t'};
  std::array<std::size_t, 3> count{};
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') is_quoted = !is_quoted;
    const auto it = std::find(kDelimiters.begin(), kDelimiters.end(), c);
    if (!is_quoted && it != kDelimiters.end()) {
      ++count[static_cast<std::size_t>(it - kDelimiters.begin())];
    }
  }
  const auto most = std::max_element(count.begin(), count.end());
  return kDelimiters[static_cast<std::size_t>(most - count.begin())];
}

std::vector<ColumnName> split_header(std::string_view line, char delimiter) {
  std::vector<ColumnName> names;
  std::size_t at = 0;
  while (true) {
    ColumnName name;
    while (at < line.size() && line[at] == ' ') ++at;
    name.column = static_cast<int>(at) + 1;
    bool is_quoted = false;
    for (; at < line.size() && (is_quoted || line[at] != delimiter); ++at) {
      if (line[at] != '"') {
        name.text += line[at];
      } else if (is_quoted && at + 1 < line.size() && line[at + 1] == '"') {
        name.text += line[++at];
      } else {
        is_quoted = !is_quoted;
      }
    }
    name.text = trim(name.text, is_blank);
    names.push_back(std::move(name));
    if (at >= line.size()) return names;
    ++at;
  }
}

}  // namespace kerf
