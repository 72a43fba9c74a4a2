#include "twin/config/tool_list_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "base/length_unit.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/shape_spec.h"
#include "twin/config/config_reader.h"

namespace kerf {
namespace {

class ToolListReader {
 public:
  ToolListReader(ConfigFaults& faults, ToolLibrary& out) : faults_(faults), out_(out) {}

  void read(ConfigNode& root) {
    faults_.check_names(root, {"tools", "units"});
    read_units(root);
    ConfigNode* const tools = root.child("tools");
    if (tools == nullptr) {
      faults_.diagnostics().push_back(faults_.text().diagnostic(
          0, 0, tr("tools is missing; must be a list of tools"), kExample));
      return;
    }
    if (tools->faulty) return;
    if (tools->kind != NodeKind::kList || tools->children.empty()) {
      faults_.at_value(*tools, tr("must be a list of tools, each with number and shape"), kExample);
      return;
    }
    for (const auto& tool : tools->children) read_tool(*tool);
  }

 private:
  static constexpr const char* kExample = "tools: [{number: 3, shape: \"flat:6:flute=20\"}]";

  /// Null: it is not there, or is no plain value, which is said.
  ConfigNode* text(ConfigNode& node, std::string_view name) {
    ConfigNode* const child = node.child(name);
    if (child == nullptr || child->faulty) return nullptr;
    if (child->kind == NodeKind::kScalar) return child;
    faults_.at_value(*child, trf("{} is not allowed; must be a value", to_string(child->kind)));
    return nullptr;
  }

  void read_units(ConfigNode& root) {
    ConfigNode* const node = text(root, "units");
    if (node == nullptr) return;
    const std::string word = to_lower(trim(node->scalar));
    if (word == "inch") unit_ = LengthUnit::kInch;
    if (word == "inch" || word == "mm") return;
    faults_.at_value(*node,
                     trf("'{}' is not allowed; must be one of mm, inch", shown(node->scalar)));
  }

  void read_tool(ConfigNode& node) {
    if (node.faulty) return;
    if (node.kind != NodeKind::kMap) {
      faults_.at_value(node, tr("must be a group of keys: number, shape, name"), kExample);
      return;
    }
    faults_.check_names(node, {"number", "shape", "name"});
    LibraryTool tool;
    tool.path = out_.path;
    if (const ConfigNode* const name = text(node, "name")) tool.name = trim(name->scalar);
    const bool has_number = read_number(node, tool);
    if (read_shape(node, tool) && has_number) out_.tools.push_back(std::move(tool));
  }

  bool read_number(ConfigNode& node, LibraryTool& tool) {
    ConfigNode* const number = text(node, "number");
    if (number == nullptr) {
      if (node.child("number") == nullptr) {
        faults_.at_value(node, trf("number is missing; must be 1 to {}", kMaxToolNumber));
      }
      return false;
    }
    int value = 0;
    if (!kerf::read_number(trim(number->scalar), value) || value < 1 || value > kMaxToolNumber) {
      faults_.at_value(*number, trf("'{}' is not allowed; must be a whole number from 1 to {}",
                                    shown(number->scalar), kMaxToolNumber));
      return false;
    }
    const bool twice = std::any_of(out_.tools.begin(), out_.tools.end(),
                                   [&](const LibraryTool& other) { return other.number == value; });
    if (twice) faults_.at_value(*number, trf("tool {} is given twice", value));
    tool.number = value;
    return !twice;
  }

  bool read_shape(ConfigNode& node, LibraryTool& tool) {
    ConfigNode* const shape = text(node, "shape");
    if (shape == nullptr) {
      if (node.child("shape") == nullptr) {
        faults_.at_value(node, tr("shape is missing; `kerf tools` lists the shapes"), kExample);
      }
      return false;
    }
    Result<Cutter> cutter = parse_shape(resolved_shape(*shape, faults_), unit_);
    if (!cutter) {
      faults_.at_value(*shape, cutter.error());
      return false;
    }
    tool.cutter = std::move(cutter.value());
    return true;
  }

  ConfigFaults& faults_;
  ToolLibrary& out_;
  LengthUnit unit_ = LengthUnit::kMm;
};

}  // namespace

std::optional<ToolLibrary> parse_tool_list(std::string_view text, const std::string& path,
                                           Diagnostics& diagnostics) {
  const ConfigText source(text, path);
  Diagnostics said;
  const std::unique_ptr<ConfigNode> root = parse_config_tree(source, said);
  ToolLibrary library{path, "kerf", {}};
  if (root != nullptr) {
    ConfigFaults faults(source, said);
    ToolListReader(faults, library).read(*root);
  }
  const bool good = root != nullptr && !has_error(said);
  std::move(said.begin(), said.end(), std::back_inserter(diagnostics));
  if (!good) return std::nullopt;
  return library;
}

}  // namespace kerf
