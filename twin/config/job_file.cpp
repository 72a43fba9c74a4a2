#include "twin/config/job_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <iterator>
#include <utility>

#include "base/small_file.h"
#include "base/suggest.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/config/config_reader.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

constexpr double kMostTime_s = 1e7, kMostTurn_deg = 360, kMostCoordinate_mm = 100'000;
constexpr std::size_t kMostJobBytes = 1U << 20U;
/// Of what has no file, stl:FILE and the like.
constexpr std::string_view kFileSpecs[] = {
    "state:", "stl:", "obj:", "3mf:", "step:", "profile:", "mesh:"};

/// Keys of a setup that are no options, or options by another name.
struct KeyOfOption {
  std::string_view key, option;
};
constexpr KeyOfOption kOtherNames[] = {
    {"stock", "--stock"},        {"config", "--config"},    {"tools", "--tool"},
    {"tool_library", "--tools"}, {"fixtures", "--fixture"}, {"cell_mm", "--cell"},
};
constexpr std::string_view kOwnKeys[] = {"program", "name",   "flip",   "rotate",
                                         "zero",    "points", "time_s", "work_offset"};
/// What the job says for all of its setups, or a command line for itself.
constexpr std::string_view kNotOfSetups[] = {
    "--compare", "--compare-at", "--compare-fit", "--compare-unit", "--tolerance", "--rest",
    "--units",   "--section",    "--stock",       "--config",       "--tool",      "--tools",
    "--fixture", "--cell",       "--work-offset", "--set"};

std::string key_of(std::string_view option) {
  std::string key(option.substr(2));
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

/// The option that a key of a setup stands for; null: none.
const Setting* option_of(std::string_view key) {
  for (const KeyOfOption& other : kOtherNames)
    if (other.key == key) return &setting_of(other.option, kRun);
  for (const Setting& setting : setting_table()) {
    if (!is_passed_on(setting) || key_of(setting.option) != key) continue;
    if (std::ranges::find(kNotOfSetups, setting.option) == std::end(kNotOfSetups)) return &setting;
  }
  return nullptr;
}

std::vector<std::string> setup_keys() {
  std::vector<std::string> keys(std::begin(kOwnKeys), std::end(kOwnKeys));
  for (const KeyOfOption& other : kOtherNames) keys.emplace_back(other.key);
  for (const Setting& setting : setting_table()) {
    if (!is_passed_on(setting)) continue;
    if (std::ranges::find(kNotOfSetups, setting.option) == std::end(kNotOfSetups))
      keys.push_back(key_of(setting.option));
  }
  return keys;
}

class JobReader {
 public:
  JobReader(ConfigFaults& faults, JobFile& out) : faults_(faults), out_(out) {}

  void read(ConfigNode& root) {
    check_names(root, {"setups", "compare"}, true);
    if (ConfigNode* const compare = root.child("compare")) read_compare(*compare);
    ConfigNode* const setups = root.child("setups");
    if (setups == nullptr) {
      faults_.diagnostics().push_back(faults_.text().diagnostic(
          0, 0, tr("setups is missing; must be a list of setups"), kExample));
      return;
    }
    if (setups->faulty) return;
    if (setups->kind != NodeKind::kList || setups->children.empty()) {
      faults_.at_value(*setups, tr("must be a list of setups, each with its program"), kExample);
      return;
    }
    for (const auto& setup : setups->children) read_setup(*setup);
  }

 private:
  static constexpr const char* kExample =
      "setups: [{program: top.ngc, stock: \"box:0,0,-20:80,60,0\"}, {program: bottom.ngc, flip: "
      "x}]";

  void check_names(ConfigNode& node, const std::vector<std::string>& known, bool list_all) {
    for (const auto& child : node.children) {
      if (std::find(known.begin(), known.end(), child->key) != known.end()) continue;
      const std::string near = nearest_word(child->key, known);
      std::string hint;
      if (!near.empty()) {
        hint = trf("did you mean {}?", near);
      } else if (list_all) {
        hint = trf("here may be: {}", fmt::join(known, ", "));
      } else {
        hint =
            trf("here may be: {}, and options of kerf run with _ for -", fmt::join(kOwnKeys, ", "));
      }
      faults_.at_key(*child, tr("unknown key"), std::move(hint));
    }
  }

  static JobPlace place_of(const ConfigNode& node) { return {node.path, node.line, node.column}; }

  /// Null: it is not there, or is no plain value, which is said.
  ConfigNode* value(ConfigNode& node, std::string_view name) {
    ConfigNode* const child = node.child(name);
    if (child == nullptr || child->faulty) return nullptr;
    if (child->kind == NodeKind::kScalar && !trim(child->scalar).empty()) return child;
    faults_.at_value(*child, trf("{} is not allowed; must be a value", to_string(child->kind)));
    return nullptr;
  }

  std::string path_of(const ConfigNode& node, const std::string& file) const {
    return resolved_path(node, file, faults_);
  }

  /// A text of an option, in which files are where the job has them.
  std::string spec_of(const ConfigNode& node, const Setting& setting) const {
    const std::string text(trim(node.scalar));
    if (setting.type == KeyType::kFile || setting.type == KeyType::kFolder)
      return path_of(node, text);
    if (setting.option == "--tool") {
      const std::size_t equals = text.find('=');
      if (equals == text.npos) return text;
      ConfigNode shape;
      shape.scalar = text.substr(equals + 1);
      return text.substr(0, equals + 1) + resolved_shape(shape, faults_);
    }
    if (setting.option != "--stock" && setting.option != "--fixture") return text;
    const std::string lower = to_lower(text);
    for (const std::string_view prefix : kFileSpecs)
      if (lower.starts_with(prefix)) return resolved_spec(node, prefix, faults_);
    const bool is_drawn_sheet = lower.starts_with("sheet:") && (lower.find(".dxf:") != lower.npos ||
                                                                lower.find(".svg:") != lower.npos);
    return is_drawn_sheet ? resolved_spec(node, "sheet:", faults_) : text;
  }

  void read_option(ConfigNode& node, const Setting& setting, WrittenOptions& options,
                   std::map<std::string, JobPlace, std::less<>>& places) {
    if (node.faulty) return;
    places[std::string(setting.option)] = place_of(node);
    if (setting.repeatable && node.kind == NodeKind::kList) {
      for (const auto& one : node.children) {
        if (one->kind == NodeKind::kScalar) {
          options.add(setting.option, spec_of(*one, setting));
        } else {
          faults_.at_value(*one, trf("{} is not allowed; must be a value", to_string(one->kind)));
        }
      }
      return;
    }
    if (node.kind != NodeKind::kScalar || trim(node.scalar).empty()) {
      faults_.at_value(node, setting.repeatable
                                 ? trf("{} is not allowed; must be a value or a list of them",
                                       to_string(node.kind))
                                 : trf("{} is not allowed; must be a value", to_string(node.kind)));
      return;
    }
    if (!setting.flag.empty()) {
      const std::string word = to_lower(trim(node.scalar));
      if (word == setting.flag) options.set_flag(setting.option);
      if (word != "yes" && word != "no")
        faults_.at_value(node, trf("'{}' is not allowed; must be yes or no", shown(node.scalar)));
      return;
    }
    if (setting.repeatable) {
      options.add(setting.option, spec_of(node, setting));
    } else {
      options.set(setting.option, spec_of(node, setting));
    }
  }

  void read_compare(ConfigNode& node) {
    if (node.faulty) return;
    if (node.kind != NodeKind::kMap) {
      faults_.at_value(node, tr("must be a group of keys: design, tolerance_mm, at, fit, unit"),
                       "compare: {design: part.stl, tolerance_mm: 0.05}");
      return;
    }
    constexpr KeyOfOption kKeys[] = {{"design", "--compare"},
                                     {"tolerance_mm", "--tolerance"},
                                     {"at", "--compare-at"},
                                     {"fit", "--compare-fit"},
                                     {"unit", "--compare-unit"}};
    check_names(node, {"design", "tolerance_mm", "at", "fit", "unit"}, true);
    for (const KeyOfOption& key : kKeys) {
      if (ConfigNode* const child = node.child(key.key))
        read_option(*child, setting_of(key.option, kRun), out_.compare, out_.compare_places);
    }
    if (node.child("design") == nullptr)
      faults_.at_value(node, tr("design is missing; must be a mesh file of the part as designed"));
  }

  void read_setup(ConfigNode& node) {
    if (node.faulty) return;
    if (node.kind != NodeKind::kMap) {
      faults_.at_value(node, tr("must be a group of keys, program first"), kExample);
      return;
    }
    static const std::vector<std::string> kKeys = setup_keys();
    check_names(node, kKeys, false);
    JobSetup setup;
    const std::size_t number = out_.setups.size() + 1;
    setup.place = place_of(node);
    setup.name = trf("setup {}", number);
    if (const ConfigNode* const name = value(node, "name")) setup.name = trim(name->scalar);
    read_program(node, setup);
    for (const auto& child : node.children) {
      if (std::ranges::find(kOwnKeys, child->key) != std::end(kOwnKeys)) continue;
      if (const Setting* const setting = option_of(child->key))
        read_option(*child, *setting, setup.options, setup.option_places);
    }
    if (ConfigNode* const offset = node.child("work_offset")) {
      if (const std::optional<Vec3> at = three(*offset, kMostCoordinate_mm, "mm")) {
        setup.options.set("--work-offset", fmt::format("{},{},{}", at->x, at->y, at->z));
        setup.option_places["--work-offset"] = place_of(*offset);
      }
    }
    read_time(node, setup);
    read_turn(node, setup.turn);
    check_place(node, number, setup);
    out_.setups.push_back(std::move(setup));
  }

  void read_program(ConfigNode& node, JobSetup& setup) {
    ConfigNode* const program = value(node, "program");
    if (program == nullptr) {
      if (node.child("program") == nullptr)
        faults_.at_value(node, tr("program is missing; must be an NC file or a listing"), kExample);
      return;
    }
    const std::string path = path_of(*program, std::string(trim(program->scalar)));
    std::error_code none;
    if (!std::filesystem::is_regular_file(path, none)) {
      faults_.at_value(*program, trf("'{}': there is no such file", path),
                       tr("paths are relative to the job file"));
      return;
    }
    setup.options.set("PROGRAM", path);
    setup.option_places["PROGRAM"] = place_of(*program);
  }

  void read_time(ConfigNode& node, JobSetup& setup) {
    ConfigNode* const time = value(node, "time_s");
    if (time == nullptr) return;
    const std::optional<double> seconds = parse_decimal(trim(time->scalar));
    if (seconds && *seconds >= 0 && *seconds <= kMostTime_s) {
      setup.time_s = *seconds;
    } else {
      faults_.at_value(*time, trf("'{}' is not allowed; must be 0 to {:.0f} (s)",
                                  shown(time->scalar), kMostTime_s));
    }
  }

  /// [x, y, z], or "x,y,z".
  std::optional<Vec3> three(ConfigNode& node, double most, const char* unit) {
    if (node.faulty) return std::nullopt;
    std::vector<std::string> texts;
    if (node.kind == NodeKind::kScalar) {
      for (const std::string_view part : split(node.scalar, ',')) texts.emplace_back(trim(part));
    } else {
      for (const auto& child : node.children) texts.push_back(child->scalar);
    }
    Vec3 out(0);
    bool good = texts.size() == 3 && node.kind != NodeKind::kMap;
    for (std::size_t n = 0; good && n < 3; ++n) {
      const std::optional<double> number = parse_decimal(trim(texts[n]));
      good = number && std::abs(*number) <= most;
      if (good) out[static_cast<int>(n)] = *number;
    }
    if (good) return out;
    faults_.at_value(node,
                     trf("'{}' is not allowed; must be three numbers from {:g} to {:g} ({}), "
                         "[x, y, z]",
                         shown(fmt::format("{}", fmt::join(texts, ", "))), -most, most, unit));
    return std::nullopt;
  }

  void read_turn(ConfigNode& node, JobTurn& turn) {
    if (ConfigNode* const flip = value(node, "flip")) {
      const std::string word = to_lower(trim(flip->scalar));
      if (word == "x" || word == "y") {
        turn.flip = word[0];
      } else {
        faults_.at_value(*flip, trf("'{}' is not allowed; must be x or y", shown(flip->scalar)),
                         tr("half a turn about that axis; rotate: [0, 0, A] turns about Z"));
      }
    }
    if (ConfigNode* const rotate = node.child("rotate")) {
      if (const auto degrees = three(*rotate, kMostTurn_deg, "degrees")) turn.rotate_deg = *degrees;
    }
    if (ConfigNode* const zero = node.child("zero")) read_zero(*zero, turn);
    if (ConfigNode* const points = node.child("points")) read_points(node, *points, turn);
  }

  void read_zero(ConfigNode& node, JobTurn& turn) {
    const std::string word = to_lower(trim(node.scalar));
    if (node.kind == NodeKind::kScalar && word.find(',') == word.npos) {
      if (word == "top") turn.zero = JobTurn::Zero::kTop;
      if (word == "corner") turn.zero = JobTurn::Zero::kCorner;
      if (word == "middle") turn.zero = JobTurn::Zero::kMiddle;
      if (turn.zero == JobTurn::Zero::kStays) {
        faults_.at_value(node, trf("'{}' is not allowed; must be top, corner, middle or [x, y, z]",
                                   shown(node.scalar)));
      }
      return;
    }
    const std::optional<Vec3> point = three(node, kMostCoordinate_mm, "mm");
    if (!point) return;
    turn.zero = JobTurn::Zero::kPoint;
    turn.point_mm = *point;
  }

  void read_points(ConfigNode& setup, ConfigNode& node, JobTurn& turn) {
    constexpr const char* kForm = "points: [{was: [0, 0, 0], is: [0.2, -0.1, 0]}, .., ..]";
    if (node.faulty) return;
    for (const char* const other : {"flip", "rotate", "zero"}) {
      if (ConfigNode* const beside = setup.child(other)) {
        faults_.at_key(*beside,
                       tr("three touched points say how the workpiece lies; leave it out"));
        return;
      }
    }
    if (node.kind != NodeKind::kList || node.children.size() != 3) {
      faults_.at_value(node, tr("must be a list of three points, each with was and is"), kForm);
      return;
    }
    JobTurn::Touched touched;
    for (std::size_t n = 0; n < 3; ++n) {
      ConfigNode& point = *node.children[n];
      check_names(point, {"was", "is"}, true);
      ConfigNode* const was = point.child("was");
      ConfigNode* const is = point.child("is");
      if (was == nullptr || is == nullptr) {
        faults_.at_value(point, tr("must have was and is, [x, y, z] each"), kForm);
        return;
      }
      const auto before = three(*was, kMostCoordinate_mm, "mm");
      const auto now = three(*is, kMostCoordinate_mm, "mm");
      if (!before || !now) return;
      touched.was_mm[n] = *before;
      touched.is_mm[n] = *now;
    }
    if (!Placement::by_points(touched.was_mm, touched.is_mm)) {
      faults_.at_value(node,
                       tr("the three points lie on one line; they do not say how it is turned"));
      return;
    }
    for (std::size_t n = 0; n < 3; ++n) {
      const std::size_t m = (n + 1) % 3;
      const double was_mm = glm::distance(touched.was_mm[n], touched.was_mm[m]);
      const double is_mm = glm::distance(touched.is_mm[n], touched.is_mm[m]);
      if (std::abs(was_mm - is_mm) <= kTouchSlack_mm) continue;
      faults_.at_value(node,
                       trf("points {} and {} were {:.3f} mm apart and are {:.3f} mm; at most "
                           "{:g} mm of difference are allowed",
                           n + 1, m + 1, was_mm, is_mm, kTouchSlack_mm),
                       tr("a rigid part keeps its distances: one of them was touched or written "
                          "wrong"));
      return;
    }
    turn.touched = touched;
  }

  void check_place(ConfigNode& node, std::size_t number, const JobSetup& setup) {
    if (number == 1) {
      for (const char* const key : {"flip", "rotate", "zero", "points"}) {
        if (ConfigNode* const child = node.child(key))
          faults_.at_key(*child,
                         tr("is for later setups: in the first one stock says how it lies"));
      }
      return;
    }
    if (ConfigNode* const stock = node.child("stock"); stock && setup.options.has("--stock"))
      faults_.at_key(*stock,
                     tr("is for the first setup: the others get what the one before leaves"));
  }

  ConfigFaults& faults_;
  JobFile& out_;
};

}  // namespace

Placement JobTurn::turn() const {
  if (touched) {
    Placement all = *Placement::by_points(touched->was_mm, touched->is_mm);
    all.at_mm = Vec3(0);
    return all;
  }
  const Placement first = flip != 0 ? Placement::flipped(flip) : Placement();
  return first.then(Placement::turned(rotate_deg));
}

Placement JobTurn::placement(const Box& solid_mm) const {
  if (touched) return *Placement::by_points(touched->was_mm, touched->is_mm);
  Placement out = turn().about((solid_mm.min + solid_mm.max) / 2.0);
  const Box box = out.placed(solid_mm);
  Vec3 origin(0);
  switch (zero) {
    case Zero::kStays:
      break;
    case Zero::kTop:
      origin.z = box.max.z;
      break;
    case Zero::kCorner:
      origin = Vec3(box.min.x, box.min.y, box.max.z);
      break;
    case Zero::kMiddle:
      origin = Vec3((box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, box.max.z);
      break;
    case Zero::kPoint:
      origin = point_mm;
      break;
  }
  out.at_mm -= origin;
  return out;
}

std::optional<JobFile> parse_job(std::string_view text, const std::string& path,
                                 Diagnostics& diagnostics) {
  const ConfigText source(text, path);
  Diagnostics said;
  const std::unique_ptr<ConfigNode> root = parse_config_tree(source, said);
  JobFile job;
  job.path = path;
  if (root != nullptr) {
    ConfigFaults faults(source, said);
    JobReader(faults, job).read(*root);
  }
  const bool good = root != nullptr && !has_error(said);
  std::ranges::stable_sort(said, {},
                           [](const Diagnostic& d) { return std::pair(d.line, d.column); });
  std::move(said.begin(), said.end(), std::back_inserter(diagnostics));
  if (!good) return std::nullopt;
  return job;
}

void place_faults(const JobFile& job, std::string_view text,
                  const std::map<std::string, JobPlace, std::less<>>& places,
                  Diagnostics& diagnostics) {
  const ConfigText source(text, job.path);
  for (Diagnostic& d : diagnostics) {
    if (!d.file.empty()) continue;
    const std::size_t colon = d.message.find(": ");
    if (colon == d.message.npos) continue;
    const auto place = places.find(d.message.substr(0, colon));
    if (place == places.end()) continue;
    const Severity severity = d.severity;
    d = source.diagnostic(place->second.line, place->second.column,
                          place->second.path + d.message.substr(colon), std::move(d.hint));
    d.severity = severity;
  }
}

bool is_job_file(const std::string& path) {
  const std::string lower = to_lower(path);
  if (!lower.ends_with(".yaml") && !lower.ends_with(".yml")) return false;
  const Result<std::string> text = read_small_file(path, kMostJobBytes);
  if (!text) return false;
  Diagnostics unheard;
  const std::unique_ptr<ConfigNode> root = parse_config_tree(ConfigText(*text, path), unheard);
  return root != nullptr && root->child("setups") != nullptr;
}

}  // namespace kerf
