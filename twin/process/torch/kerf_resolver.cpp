#include "twin/process/torch/kerf_resolver.h"

#include <fmt/format.h>

#include "base/translate.h"
#include "stock/cutter/shape_spec.h"
#include "stock/sheet/sheet.h"

namespace kerf {
namespace {

constexpr const char* kByArgument = "--tool";

void give_width(ResolvedTool& tool, double kerf_mm, std::string origin) {
  tool.cutter.reset();
  tool.guessed = tool.assumed = false;
  tool.origin = std::move(origin);
  tool.trouble.clear();
  if (!(kerf_mm >= Sheet::kMinKerf_mm)) {
    tool.trouble = trf("its kerf is {:g} mm ({}); must be at least {:g} mm", kerf_mm, tool.origin,
                       Sheet::kMinKerf_mm);
    return;
  }
  Result<Cutter> cutter = parse_shape(fmt::format("kerf:{:.6g}", kerf_mm));
  if (cutter) {
    tool.cutter = std::move(cutter.value());
  } else {
    tool.trouble = fmt::format("{} ({})", cutter.error(), tool.origin);
  }
}

}  // namespace

const ResolvedTool& KerfResolver::of(const Motion& m, std::span<const TorchMaterial> materials) {
  const std::pair key(m.tool, by_material_ ? m.torch.material : std::uint16_t{0});
  if (last_ && key == last_key_) return *last_;
  auto known = kerfs_.find(key);
  if (known == kerfs_.end()) known = kerfs_.emplace(key, resolve(m, materials)).first;
  last_key_ = key;
  last_ = &known->second;
  return *last_;
}

ResolvedTool KerfResolver::resolve(const Motion& m, std::span<const TorchMaterial> materials) {
  ResolvedTool tool = resolver_.mount(m.tool, m.source.file == 0 ? m.source.line : 0);
  if (tool.cutter && tool.origin == kByArgument) return tool;
  if (kerf_mm_ > 0) {
    give_width(tool, kerf_mm_, "--kerf");
  } else if (by_material_ && m.torch.material < materials.size()) {
    const TorchMaterial& material = materials[m.torch.material];
    give_width(
        tool, material.kerf_width_mm,
        trf("material {}{}{}", material.number, material.name.empty() ? "" : " ", material.name));
  } else if (tool.cutter) {
    tool.guessed = tool.from_moves;  // whatever else the tool is: of a kerf the diameter is all
  }
  return tool;
}

}  // namespace kerf
