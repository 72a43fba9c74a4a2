#include "twin/config/turret_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/sheet/punch_hits.h"
#include "stock/sheet/punch_shape.h"
#include "twin/config/config_reader.h"

namespace kerf {
namespace {

constexpr double kLastStation = 99999;
constexpr double kFarthest_mm = 1e5;
constexpr double kLeastPitch_mm = 0.01;
constexpr double kMostLines = 4e9;
constexpr double kLongest_s = 3600;
/// Strokes a minute; presses that mark reach a few thousand.
constexpr double kLeastRate = 0.1;
constexpr double kMostRate = 100'000;

struct Range {
  double least, most;
  const char* unit;
};

class TurretReader {
 public:
  TurretReader(ConfigFaults& faults, Turret& out) : faults_(faults), out_(out) {}

  void read(ConfigNode& root) {
    faults_.check_names(root, {"stations", "index", "punch", "frame", "clamps", "regrip", "times"});
    read_index(root);
    read_stations(root);
    if (ConfigNode* const punch = group(root, "punch")) read_punch(*punch);
    if (ConfigNode* const frame = group(root, "frame")) {
      faults_.check_names(*frame, {"moves"});
      out_.sheet_moves = word(*frame, "moves", {"sheet", "head"}) != "head";
    }
    read_clamps(root);
    read_regrips(root);
    if (ConfigNode* const times = group(root, "times")) read_times(*times);
    if (root.child("punch") == nullptr) {
      about_file(tr("punch.trigger is missing; it says what makes the punch strike"),
                 "m3, m62:0, m100 .. m199, g81, z<-1");
    }
  }

 private:
  /// What has no place in it.
  void about_file(std::string message, std::string hint) {
    faults_.diagnostics().push_back(
        faults_.text().diagnostic(0, 0, std::move(message), std::move(hint)));
  }

  static std::string found(const ConfigNode& node) {
    return node.kind == NodeKind::kScalar ? fmt::format("'{}'", shown(node.scalar))
                                          : std::string(to_string(node.kind));
  }

  void refuse(ConfigNode& node, const std::string& allowed, std::string hint = {}) {
    if (node.faulty) return;
    faults_.at_value(node, trf("{} is not allowed; must be {}", found(node), allowed),
                     std::move(hint));
  }

  ConfigNode* group(ConfigNode& node, std::string_view name) {
    return of_kind(node, name, NodeKind::kMap, tr("a group of keys"));
  }
  ConfigNode* list(ConfigNode& node, std::string_view name) {
    return of_kind(node, name, NodeKind::kList, tr("a list"));
  }
  ConfigNode* text(ConfigNode& node, std::string_view name) {
    return of_kind(node, name, NodeKind::kScalar, "a value");
  }
  ConfigNode* of_kind(ConfigNode& node, std::string_view name, NodeKind kind, const char* what) {
    ConfigNode* const child = node.child(name);
    if (child == nullptr || child->faulty) return nullptr;
    if (child->kind == kind) return child;
    refuse(*child, what);
    return nullptr;
  }

  std::optional<double> number(ConfigNode& node, std::string_view name, const Range& range) {
    ConfigNode* const child = text(node, name);
    if (child == nullptr) return std::nullopt;
    const std::optional<double> value = parse_decimal(child->scalar);
    if (value && *value >= range.least && *value <= range.most) return value;
    refuse(*child,
           trf("{} to {} ({})", number_text(range.least), number_text(range.most), range.unit));
    return std::nullopt;
  }

  std::string word(ConfigNode& node, std::string_view name,
                   std::initializer_list<const char*> allowed) {
    ConfigNode* const child = text(node, name);
    if (child == nullptr) return {};
    const std::string given = to_lower(trim(child->scalar));
    if (std::find(allowed.begin(), allowed.end(), given) != allowed.end()) return given;
    refuse(*child, fmt::format("{}", fmt::join(allowed, " or ")));
    return {};
  }

  /// A, B, C or m67:N.
  void read_index(ConfigNode& root) {
    ConfigNode* const node = text(root, "index");
    if (node == nullptr) return;
    const std::string given = to_lower(trim(node->scalar));
    if (given == "a" || given == "b" || given == "c") {
      out_.index.axis = given[0] - 'a';
      return;
    }
    const std::size_t last = TorchState::kAnalogs - 1;
    if (given.size() == 5 && given.substr(0, 4) == "m67:" && given[4] >= '0' &&
        static_cast<std::size_t>(given[4] - '0') <= last) {
      out_.index.analog = given[4] - '0';
      return;
    }
    refuse(*node, trf("A, B, C, or m67:0 to m67:{} (an analog output in degrees)", last));
  }

  void read_stations(ConfigNode& root) {
    ConfigNode* const stations = group(root, "stations");
    if (stations == nullptr && root.child("stations") == nullptr) {
      about_file(tr("stations is missing; must be NUMBER: SHAPE for each"),
                 tr("as in 3: round:12"));
    }
    if (stations == nullptr) return;
    if (stations->children.empty()) {
      faults_.at_value(*stations, tr("there are none; must be NUMBER: SHAPE for each"),
                       tr("as in 3: round:12"));
    }
    for (const auto& child : stations->children) {
      const std::optional<double> value = parse_decimal(child->key);
      if (value && *value >= 1 && *value <= kLastStation && *value == std::floor(*value) &&
          child->key.find_first_not_of("0123456789") == std::string::npos) {
        read_station(*child, static_cast<int>(*value));
      } else {
        faults_.at_key(*child, trf("'{}' is no station; must be the number of a tool, 1 to "
                                   "{}",
                                   shown(child->key), kLastStation));
      }
    }
  }

  void read_station(ConfigNode& node, int number) {
    if (node.faulty) return;
    ConfigNode* shape = &node;
    double angle_deg = 0;
    std::string name;
    double pitch_mm = 0;
    bool turns = false;
    if (node.kind == NodeKind::kMap) {
      faults_.check_names(node, {"punch", "name", "angle", "index", "pitch"});
      angle_deg = this->number(node, "angle", {-360, 360, tr("degrees")}).value_or(0);
      if (const ConfigNode* const given = text(node, "name")) name = given->scalar;
      pitch_mm = this->number(node, "pitch", {kLeastPitch_mm, kFarthest_mm, "mm"}).value_or(0);
      turns = word(node, "index", {"true", "false"}) == "true";
      shape = text(node, "punch");
      if (shape == nullptr) {
        if (node.child("punch") == nullptr) {
          faults_.at_value(node, tr("punch is missing; must be a shape, as in round:12"));
        }
        return;
      }
    } else if (node.kind != NodeKind::kScalar) {
      refuse(node,
             tr("a shape, as in round:12, or a group of keys: punch, name, angle, index, pitch"));
      return;
    }
    std::string spec = resolved_spec(*shape, "dxf:", faults_);
    if (spec == trim(shape->scalar)) spec = resolved_spec(*shape, "svg:", faults_);
    const Result<PlaneOutline> outline = parse_punch_shape(spec, kPunchTolerance_mm);
    if (!outline) {
      faults_.at_value(*shape, outline.error());
      return;
    }
    Result<Cutter> punch = punch_cutter(fmt::format("punch:{}", trim(shape->scalar)), *outline);
    if (!punch) {
      faults_.at_value(*shape, fmt::format("{}: {}", shown(shape->scalar), punch.error()));
      return;
    }
    out_.stations.emplace(number,
                          TurretStation{number, std::move(name), std::string(trim(shape->scalar)),
                                        std::move(*punch), angle_deg, turns, pitch_mm});
  }

  void read_punch(ConfigNode& punch) {
    faults_.check_names(punch, {"trigger", "hit", "nibble"});
    ConfigNode* const trigger = text(punch, "trigger");
    if (trigger != nullptr) {
      Result<PunchTrigger> parsed = PunchTrigger::parse(trigger->scalar);
      if (parsed) {
        out_.trigger = std::move(*parsed);
      } else {
        faults_.at_value(*trigger, parsed.error());
      }
    } else if (punch.child("trigger") == nullptr) {
      faults_.at_value(punch, tr("trigger is missing; it says what makes the punch strike"),
                       "m3, m62:0, m100 .. m199, g81, z<-1");
    }
    const bool is_state = out_.trigger.kind() == PunchTrigger::Kind::kState;
    out_.strikes_at_ends = word(punch, "hit", {"once", "ends"}) == "ends";
    if (out_.strikes_at_ends && !is_state) {
      faults_.at_key(*punch.child("hit"),
                     trf("is for triggers that stay on; {} does not", trigger->scalar));
    }
    ConfigNode* const nibble = group(punch, "nibble");
    if (nibble != nullptr) read_nibbling(*nibble);
    const bool nibbles = out_.nibble_pitch_mm > 0 || stations_nibble();
    if (is_state || trigger == nullptr || trigger->faulty || !nibbles || out_.nibbles) return;
    ConfigNode& place = nibble != nullptr ? *nibble : punch;
    if (nibble != nullptr && nibble->child("while") != nullptr) return;  // it is faulty
    faults_.at_value(place,
                     trf("{} is missing: {} does not stay on, so it cannot tell on which "
                         "feeds the punch nibbles",
                         nibble != nullptr ? "while" : "nibble.while", trigger->scalar),
                     tr("as in while: m62:1"));
  }

  bool stations_nibble() const {
    return std::any_of(out_.stations.begin(), out_.stations.end(),
                       [](const auto& entry) { return entry.second.pitch_mm > 0; });
  }

  void read_nibbling(ConfigNode& node) {
    ConfigNode* const nibble = &node;
    faults_.check_names(*nibble, {"pitch", "while"});
    if (nibble->child("pitch") == nullptr && !stations_nibble()) {
      faults_.at_value(*nibble, tr("pitch is missing; must be mm from stroke to stroke"));
    }
    out_.nibble_pitch_mm =
        number(*nibble, "pitch", {kLeastPitch_mm, kFarthest_mm, "mm"}).value_or(0);
    if (ConfigNode* const state = text(*nibble, "while")) {
      Result<BeamTrigger> parsed = BeamTrigger::parse(state->scalar);
      if (parsed) {
        out_.nibbles = std::move(*parsed);
      } else {
        faults_.at_value(*state, parsed.error());
      }
    }
  }

  void read_clamps(ConfigNode& root) {
    ConfigNode* const clamps = list(root, "clamps");
    if (clamps == nullptr) return;
    for (const auto& child : clamps->children) {
      if (child->kind != NodeKind::kMap) {
        refuse(*child, tr("a group of keys: x, y, width, depth, clearance"));
        continue;
      }
      faults_.check_names(*child, {"x", "y", "width", "depth", "clearance"});
      const Range place{-kFarthest_mm, kFarthest_mm, "mm"}, size{0.1, kFarthest_mm, "mm"};
      const auto x = needed(*child, "x", place), y = needed(*child, "y", place);
      const auto width = needed(*child, "width", size), depth = needed(*child, "depth", size);
      const double clearance = number(*child, "clearance", {0, kFarthest_mm, "mm"}).value_or(0);
      if (!x || !y || !width || !depth) continue;
      out_.clamps.push_back({{*x, *y}, {*x + *width, *y + *depth}, clearance});
    }
  }

  std::optional<double> needed(ConfigNode& node, const char* name, const Range& range) {
    if (node.child(name) == nullptr) {
      faults_.at_value(node, trf("{} is missing; must be {} to {} ({})", name,
                                 number_text(range.least), number_text(range.most), range.unit));
    }
    return number(node, name, range);
  }

  void read_regrips(ConfigNode& root) {
    ConfigNode* const regrips = list(root, "regrip");
    if (regrips == nullptr) return;
    for (const auto& child : regrips->children) {
      if (child->kind != NodeKind::kMap) {
        refuse(*child, tr("a group of keys: on or line, x, y"));
        continue;
      }
      faults_.check_names(*child, {"on", "line", "x", "y"});
      Regrip regrip;
      const bool by_code = child->child("on") != nullptr, by_line = child->child("line") != nullptr;
      if (by_code == by_line) {
        faults_.at_value(*child, by_code
                                     ? tr("on and line are both given; must be one of them")
                                     : tr("on or line is missing: the M-code, or the line of the "
                                          "program, at which the clamps move"));
        continue;
      }
      if (by_code) read_code(*child, regrip);
      if (const auto line = number(*child, "line", {1, kMostLines, "lines"})) {
        regrip.line = static_cast<std::uint32_t>(*line);
      }
      const Range shift{-kFarthest_mm, kFarthest_mm, "mm"};
      regrip.shift_mm = {number(*child, "x", shift).value_or(0),
                         number(*child, "y", shift).value_or(0)};
      if (child->child("x") == nullptr && child->child("y") == nullptr) {
        faults_.at_value(*child, tr("x and y are missing: how far the clamps move, in mm"));
      }
      out_.regrips.push_back(regrip);
    }
  }

  void read_times(ConfigNode& node) {
    faults_.check_names(node, {"stroke", "rate", "turret", "regrip"});
    const Range seconds{0, kLongest_s, "s"};
    PunchTimes& times = out_.times;
    times.stroke_s = number(node, "stroke", seconds).value_or(0);
    times.regrip_s = number(node, "regrip", seconds).value_or(0);
    if (ConfigNode* const rates = group(node, "rate")) read_rates(*rates);
    ConfigNode* const turret = group(node, "turret");
    if (turret == nullptr) return;
    faults_.check_names(*turret, {"places", "step", "lock"});
    times.step_s = number(*turret, "step", seconds).value_or(0);
    times.lock_s = number(*turret, "lock", seconds).value_or(0);
    const auto places = number(*turret, "places", {1, kLastStation, "places"});
    if (!places) return;
    times.places = static_cast<int>(*places);
    const int last = out_.stations.empty() ? 0 : out_.stations.rbegin()->first;
    if (*places != std::floor(*places)) {
      refuse(*turret->child("places"), tr("a whole number"));
    } else if (last > times.places) {
      faults_.at_value(*turret->child("places"),
                       trf("{} are too few: there is a station {}", times.places, last));
    }
  }

  /// Strokes a minute, by the pitch.
  void read_rates(ConfigNode& rates) {
    if (rates.children.empty()) {
      faults_.at_value(rates, tr("there are none; must be PITCH: STROKES a minute for each"),
                       tr("as in 4: 600"));
    }
    for (const auto& child : rates.children) {
      const std::optional<double> pitch = parse_decimal(child->key);
      if (!pitch || *pitch < kLeastPitch_mm || *pitch > kFarthest_mm) {
        faults_.at_key(*child, trf("'{}' is no pitch; must be {} to {} (mm)", shown(child->key),
                                   number_text(kLeastPitch_mm), number_text(kFarthest_mm)));
        continue;
      }
      const auto rate = number(rates, child->key, {kLeastRate, kMostRate, tr("strokes a minute")});
      if (rate && !out_.times.period_by_pitch_s.emplace(*pitch, 60 / *rate).second) {
        faults_.at_key(*child, tr("this pitch is given twice"));
      }
    }
  }

  void read_code(ConfigNode& node, Regrip& regrip) {
    ConfigNode* const on = text(node, "on");
    if (on == nullptr) return;
    const Result<PunchTrigger> code = PunchTrigger::parse(on->scalar);
    if (!code || code->kind() != PunchTrigger::Kind::kUserCode) {
      refuse(*on, "m100 to m199");
    } else if (code->user_code() == out_.trigger.user_code()) {
      faults_.at_value(*on, trf("{} makes the punch strike already", on->scalar));
    } else {
      regrip.user_code = code->user_code();
    }
  }

  ConfigFaults& faults_;
  Turret& out_;
};

}  // namespace

TurretPointer parse_turret(std::string_view text, const std::string& path,
                           Diagnostics& diagnostics) {
  const ConfigText source(text, path);
  Diagnostics said;
  const std::unique_ptr<ConfigNode> root = parse_config_tree(source, said);
  auto turret = std::make_shared<Turret>();
  turret->path = path;
  if (root != nullptr) {
    ConfigFaults faults(source, said);
    TurretReader(faults, *turret).read(*root);
  }
  const bool good = root != nullptr && !has_error(said);
  std::move(said.begin(), said.end(), std::back_inserter(diagnostics));
  return good ? turret : nullptr;
}

TurretPointer read_turret(const std::string& path, Diagnostics& diagnostics) {
  struct stat facts {};
  const bool is_there = stat(path.c_str(), &facts) == 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  Diagnostic fault;
  fault.file = path;
  if (is_there && S_ISDIR(facts.st_mode)) {
    fault.message = tr("is a folder; a turret is a file");
  } else if (!is_there || !file) {
    fault.message = trf("cannot read the turret: {}", std::strerror(errno));
  } else {
    text = read_up_to(file, kMaxConfig_bytes + 1);
    if (text.find_first_not_of(" \t\r\n") == text.npos) fault.message = tr("is empty");
    if (text.size() > kMaxConfig_bytes) {
      fault.message = trf("is longer than {} bytes; a turret is not", kMaxConfig_bytes);
    }
  }
  if (fault.message.empty()) return parse_turret(text, path, diagnostics);
  diagnostics.push_back(std::move(fault));
  return nullptr;
}

}  // namespace kerf
