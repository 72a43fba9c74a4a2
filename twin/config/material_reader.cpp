#include "twin/config/material_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/config/config_reader.h"
#include "twin/config/config_tree.h"
#include "twin/config/key_check.h"
#include "twin/config/materials_text.h"

namespace kerf {
namespace {

constexpr double kMostMc = 0.9, kMostKc11 = 20'000, kMostRake_deg = 45, kMostShare = 2;
constexpr double kMostSpeed_m_per_min = 20'000;

class MaterialReader {
 public:
  MaterialReader(ConfigFaults& faults, std::vector<Material>& out) : faults_(faults), out_(out) {}

  void read(ConfigNode& root) {
    faults_.check_names(root, {"materials"});
    ConfigNode* const list = root.child("materials");
    if (list == nullptr) {
      faults_.diagnostics().push_back(
          faults_.text().diagnostic(0, 0, tr("materials is missing; must be a list"), kExample));
      return;
    }
    if (list->faulty) return;
    if (list->kind != NodeKind::kList || list->children.empty()) {
      faults_.at_value(*list, tr("must be a list of materials"), kExample);
      return;
    }
    for (const auto& row : list->children) read_row(*row);
  }

 private:
  static constexpr const char* kExample =
      "materials: [{name: bronze, kc11: [600, 800, 1100], mc: 0.2, source: ..}]";

  bool number(ConfigNode& node, double least, double most, double& out) {
    if (node.faulty) return false;
    if (node.kind == NodeKind::kScalar && read_number(trim(node.scalar), out) && out >= least &&
        out <= most)
      return true;
    faults_.at_value(node,
                     trf("'{}' is not allowed; must be {} to {}", shown(node.scalar), least, most));
    return false;
  }

  bool need_number(ConfigNode& row, const char* name, double least, double most, double& out) {
    if (ConfigNode* const node = row.child(name)) return number(*node, least, most, out);
    if (!row.faulty)
      faults_.at_value(row, trf("{} is missing; must be {} to {}", name, least, most));
    return false;
  }

  /// Rising numbers.
  bool numbers(ConfigNode& node, std::size_t count, double least, double most, double* out) {
    if (node.faulty) return false;
    const bool is_list = node.kind == NodeKind::kList && node.children.size() == count;
    if (!is_list) {
      faults_.at_value(
          node, trf("must be {} numbers, [low{} high]", count, count == 3 ? ", nominal," : ","));
      return false;
    }
    for (std::size_t n = 0; n < count; ++n) {
      if (!number(*node.children[n], least, most, out[n])) return false;
      if (n == 0 || out[n] >= out[n - 1]) continue;
      faults_.at_value(
          *node.children[n],
          trf("{} is not allowed; must not be below {}, the one before", out[n], out[n - 1]));
      return false;
    }
    return true;
  }

  bool read_text(ConfigNode& row, const char* name, bool is_needed, std::string& out) {
    ConfigNode* const node = row.child(name);
    if (node == nullptr) {
      if (is_needed && !row.faulty) faults_.at_value(row, trf("{} is missing", name), kExample);
      return !is_needed;
    }
    if (node->faulty) return false;
    if (node->kind != NodeKind::kScalar || trim(node->scalar).empty()) {
      faults_.at_value(*node, trf("{} is not allowed; must be a text", to_string(node->kind)));
      return false;
    }
    out = trim(node->scalar);
    return true;
  }

  void read_aliases(ConfigNode& row, Material& material) {
    ConfigNode* const node = row.child("aliases");
    if (node == nullptr || node->faulty) return;
    if (node->kind != NodeKind::kList) {
      faults_.at_value(*node, tr("must be a list of names"));
      return;
    }
    for (const auto& alias : node->children) material.aliases.emplace_back(trim(alias->scalar));
  }

  void read_speed(ConfigNode& row, const char* name, std::optional<SpeedRange>& out) {
    ConfigNode* const node = row.child(name);
    double values[2];
    if (node != nullptr && numbers(*node, 2, 0.1, kMostSpeed_m_per_min, values))
      out = {values[0], values[1]};
  }

  void read_row(ConfigNode& row) {
    if (row.faulty) return;
    if (row.kind != NodeKind::kMap) {
      faults_.at_value(row, tr("must be a group of keys: name, kc11, mc, source"), kExample);
      return;
    }
    faults_.check_names(row, {"name", "aliases", "kc11", "mc", "rake", "normal_share", "speed_hss",
                              "speed_carbide", "source"});
    Material material;
    bool good = read_text(row, "name", true, material.name);
    good = read_text(row, "source", true, material.source) && good;
    good = need_number(row, "mc", 0, kMostMc, material.mc) && good;
    double values[3];
    if (ConfigNode* const node = row.child("kc11")) {
      if (numbers(*node, 3, 1, kMostKc11, values)) {
        material.kc11_n_per_mm2 = {values[0], values[1], values[2]};
      } else {
        good = false;
      }
    } else if (!row.faulty) {
      faults_.at_value(row, tr("kc11 is missing; must be [low, nominal, high], N/mm2"), kExample);
    }
    if (ConfigNode* const node = row.child("rake"))
      good = number(*node, -kMostRake_deg, kMostRake_deg, material.rake_deg) && good;
    if (ConfigNode* const node = row.child("normal_share")) {
      if (numbers(*node, 3, 0, kMostShare, values))
        material.normal_share = {values[0], values[1], values[2]};
    }
    read_aliases(row, material);
    read_speed(row, "speed_hss", material.speed_hss);
    read_speed(row, "speed_carbide", material.speed_carbide);
    if (!good || row.faulty) return;
    if (find_material(out_, material.name) != nullptr) {
      faults_.at_value(row, trf("'{}' is given twice", material.name));
      return;
    }
    out_.push_back(std::move(material));
  }

  ConfigFaults& faults_;
  std::vector<Material>& out_;
};

}  // namespace

std::optional<std::vector<Material>> parse_materials(std::string_view text, const std::string& path,
                                                     Diagnostics& diagnostics) {
  const ConfigText source(text, path);
  Diagnostics said;
  const std::unique_ptr<ConfigNode> root = parse_config_tree(source, said);
  std::vector<Material> materials;
  if (root != nullptr) {
    ConfigFaults faults(source, said);
    MaterialReader(faults, materials).read(*root);
  }
  const bool good = root != nullptr && !has_error(said);
  std::move(said.begin(), said.end(), std::back_inserter(diagnostics));
  if (!good) return std::nullopt;
  return materials;
}

const std::vector<Material>& known_materials() {
  static const std::vector<Material> materials = [] {
    Diagnostics said;
    std::optional<std::vector<Material>> read =
        parse_materials(kMaterialsText, "configs/materials.yaml", said);
    assert(read);
    return read ? std::move(*read) : std::vector<Material>{};
  }();
  return materials;
}

std::optional<std::vector<Material>> read_materials(const std::string& path,
                                                    Diagnostics& diagnostics) {
  const Result<std::string> bytes = read_small_file(path, kMaxConfig_bytes);
  if (!bytes) {
    Diagnostic d;
    d.message = bytes.error();
    diagnostics.push_back(std::move(d));
    return std::nullopt;
  }
  std::optional<std::vector<Material>> materials = parse_materials(*bytes, path, diagnostics);
  if (!materials) return std::nullopt;
  materials->insert(materials->end(), known_materials().begin(), known_materials().end());
  return materials;
}

}  // namespace kerf
