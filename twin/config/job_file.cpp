#include "twin/config/job_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/config/config_reader.h"
#include "twin/config/job_nodes.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

constexpr double kMostTime_s = 1e7;
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
    check_job_names(root, {"setups", "compare"}, {}, faults_);
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

  static JobPlace place_of(const ConfigNode& node) { return {node.path, node.line, node.column}; }

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
    check_job_names(node, {"design", "tolerance_mm", "at", "fit", "unit"}, {}, faults_);
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
    std::vector<std::string> known = setup_keys();
    for (const auto& child : node.children)
      if (refuse_option(*child, known)) known.push_back(child->key);
    check_job_names(
        node, known,
        trf("here may be: {}, and options of kerf run with _ for -", fmt::join(kOwnKeys, ", ")),
        faults_);
    JobSetup setup;
    const std::size_t number = out_.setups.size() + 1;
    setup.place = place_of(node);
    if (const ConfigNode* const name = job_value(node, "name", faults_))
      setup.name = trim(name->scalar);
    read_program(node, setup);
    for (const auto& child : node.children) {
      if (std::ranges::find(kOwnKeys, child->key) != std::end(kOwnKeys)) continue;
      if (const Setting* const setting = option_of(child->key))
        read_option(*child, *setting, setup.options, setup.option_places);
    }
    if (ConfigNode* const offset = node.child("work_offset")) {
      if (const std::optional<Vec3> at = job_three(*offset, kMostJobCoordinate_mm, "mm", faults_)) {
        setup.options.set("--work-offset", fmt::format("{},{},{}", at->x, at->y, at->z));
        setup.option_places["--work-offset"] = place_of(*offset);
      }
    }
    read_time(node, setup);
    read_job_turn(node, setup.turn, faults_);
    check_place(node, number, setup);
    out_.setups.push_back(std::move(setup));
  }

  /// Of `kerf run`, and not for a setup of a job. False: it is none.
  bool refuse_option(ConfigNode& node, const std::vector<std::string>& known) {
    if (std::ranges::find(known, node.key) != known.end()) return false;
    const auto has_key = [&](const Setting& setting) {
      return !setting.option.empty() && !setting.is_positional() &&
             key_of(setting.option) == node.key;
    };
    const std::span<const Setting> table = setting_table();
    const auto of_run = std::ranges::find_if(
        table, [&](const Setting& s) { return (s.commands & kRun) != 0 && has_key(s); });
    if (of_run == table.end()) return false;
    const bool is_of_job = std::ranges::any_of(
        table, [&](const Setting& s) { return (s.commands & kJob) != 0 && has_key(s); });
    const bool is_compared =
        of_run->option.starts_with("--compare") || of_run->option == "--tolerance";
    if (is_of_job && of_run->option != "--compare-png") {
      faults_.at_key(node, tr("is for all setups, not for one"),
                     trf("kerf job {} {} says it", out_.path, of_run->option));
    } else if (is_compared) {
      faults_.at_key(node, tr("is for what the last setup leaves, not for one of them"),
                     tr("beside setups: compare: {design: part.stl, tolerance_mm: 0.05}"));
    } else {
      faults_.at_key(node, tr("is for a single program, not for a part in several setups"),
                     trf("kerf run has {}", of_run->option));
    }
    return true;
  }

  void read_program(ConfigNode& node, JobSetup& setup) {
    ConfigNode* const program = job_value(node, "program", faults_);
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
    ConfigNode* const time = job_value(node, "time_s", faults_);
    if (time == nullptr) return;
    const std::optional<double> seconds = parse_decimal(trim(time->scalar));
    if (seconds && *seconds >= 0 && *seconds <= kMostTime_s) {
      setup.time_s = *seconds;
    } else {
      faults_.at_value(*time, trf("'{}' is not allowed; must be 0 to {:.0f} (s)",
                                  shown(time->scalar), kMostTime_s));
    }
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

std::string JobFile::name_of(std::size_t setup) const {
  const std::string& name = setups[setup].name;
  return name.empty() ? trf("setup {}", setup + 1) : name;
}

std::string JobFile::words_of(std::size_t setup) const {
  const std::string& name = setups[setup].name;
  return name.empty() ? trf("setup {}", setup + 1) : trf("setup {} ({})", setup + 1, name);
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
