#include "twin/app/work_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

namespace kerf {
namespace {

constexpr OptionRange kCell{0, 1000, true, "mm"};
constexpr OptionRange kMargin{0, 10000, false, "mm"};
constexpr OptionRange kBelow{0, 1000, false, "mm"};
constexpr OptionRange kThreads{1, 256, false, "threads"};

void read_model(const WorkArguments& a, OptionReader& reader, WorkRequest& work) {
  work.stock.additive = a.additive;
  if (a.additive && !a.model.empty() && a.model != "auto" && a.model != "octree") {
    reader.fault("--additive", fmt::format("the model {} only removes; allowed: octree", a.model));
  }
  if (a.model.empty() || a.model == "auto") return;
  if (const StockModelRow* const row = find_stock_model(a.model)) {
    work.stock.kind = row->kind;
  } else {
    reader.fault("--model",
                 fmt::format("'{}' is no model; allowed: {}", a.model, stock_model_names()));
  }
}

void read_tools(const WorkArguments& arguments, OptionReader& reader, WorkRequest& work) {
  for (const std::string& text : arguments.tools) {
    Result<ToolShapeArgument> tool = parse_tool_argument(text, reader.unit());
    if (!tool) {
      reader.fault("--tool", tool.error());
      continue;
    }
    if (tool->tool == 0) {
      reader.fault("--tool",
                   fmt::format("'{}': tool 0 is the empty spindle; numbers begin at 1", text),
                   "--tool 1=SHAPE, if it is the only --tool, is what is in the spindle of a "
                   "program that changes no tool");
      continue;
    }
    if (const Done fit = can_be_cut(work.stock.kind, tool->cutter); !fit) {
      reader.fault("--tool", fmt::format("'{}': {}", text, fit.error()));
      continue;
    }
    bool twice = false;
    for (const ToolShapeArgument& other : work.tools) twice |= other.tool == tool->tool;
    if (twice) {
      reader.fault("--tool", fmt::format("'{}': tool {} is given twice", text, tool->tool));
      continue;
    }
    work.tools.push_back(std::move(tool.value()));
  }
}

void read_stock(const WorkArguments& arguments, OptionReader& reader, WorkRequest& work) {
  if (arguments.stock.empty()) return;
  Result<Blank> blank = parse_blank(arguments.stock, reader.unit());
  if (blank) {
    work.blank = std::move(blank.value());
  } else {
    reader.fault("--stock", blank.error());
  }
}

void read_choices(const WorkArguments& a, OptionReader& reader, WorkRequest& work) {
  if (a.path == "planned") {
    work.planned_path = true;
  } else if (a.path == "programmed") {
    work.planned_path = false;
  } else if (!a.path.empty()) {
    reader.fault("--path", fmt::format("'{}' is no path; allowed: programmed, planned", a.path));
  }
  if (a.kernel == "scalar") {
    work.stock.kernel = ZMapKernel::kScalar;
  } else if (a.kernel == "avx2") {
    work.stock.kernel = ZMapKernel::kAvx2;
    if (!zmap_has_avx2())
      reader.fault("--kernel", "this machine cannot run avx2; allowed: auto, scalar");
  } else if (!a.kernel.empty() && a.kernel != "auto") {
    reader.fault("--kernel",
                 fmt::format("'{}' is no kernel; allowed: auto, scalar, avx2", a.kernel));
  }
}

/// One core is left to the interpreter.
int default_threads() {
  const unsigned cores = std::thread::hardware_concurrency();
  return cores > 2 ? static_cast<int>(std::min(cores - 1, 8U)) : 1;
}

}  // namespace

WorkRequest understand_work(const WorkArguments& a, OptionReader& reader) {
  WorkRequest work;
  read_model(a, reader, work);
  read_tools(a, reader, work);
  read_stock(a, reader, work);
  read_choices(a, reader, work);
  work.stock.cell_mm = reader.length_mm("--cell", a.cell, kCell, 0);
  work.below_mm = reader.length_mm("--below", a.below, kBelow, work.below_mm);
  work.margin_mm = reader.length_mm("--margin", a.margin, kMargin, work.margin_mm);
  work.stock.threads =
      static_cast<int>(reader.whole_number("--threads", a.threads, kThreads, default_threads()));
  return work;
}

}  // namespace kerf
