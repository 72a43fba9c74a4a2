// Arbitrary bytes as what torch programs bring along; the first byte says which: f a material file,
// p prefs, c material comments and numbers line by line, n a program, b beam triggers line by line.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "interp_bridge/beam_trigger.h"
#include "interp_bridge/torch_setup.h"

namespace {

using kerf::MaterialTable;
using kerf::TorchMaterial;

void check(bool holds) {
  if (!holds) std::abort();
}

void check_material(const TorchMaterial& row) {
  for (const double value :
       {row.kerf_width_mm, row.pierce_height_mm, row.pierce_delay_s, row.puddle_jump_height_mm,
        row.puddle_jump_delay_s, row.cut_height_mm, row.feed_mm_per_min, row.cut_amps,
        row.cut_volts, row.pause_at_end_s, row.gas_pressure, row.cut_mode}) {
    check(std::isfinite(value));
  }
}

void check_said(const kerf::Diagnostics& diagnostics) {
  check(diagnostics.size() <= 50);
  for (const kerf::Diagnostic& diagnostic : diagnostics) {
    check(!kerf::to_string(diagnostic).empty() && diagnostic.line > 0);
  }
}

template <class Take>
void for_lines(std::string_view text, Take take) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    take(text.substr(0, end));
    text.remove_prefix(std::min(text.size(), end + 1));
  }
}

void edit_materials(std::string_view text) {
  MaterialTable table;
  for_lines(text, [&](std::string_view line) {
    double number = 0;
    const TorchMaterial first = table.rows()[0];
    if (kerf::read_material_number(line, number)) {
      table.select(static_cast<int>(number));
    } else {
      table.edit(line, 25.4);
    }
    check(table.current_index() < table.rows().size() && table.rows()[0] == first);
    check_material(table.current());
  });
}

/// The same in one piece and line by line.
void scan_program(std::string_view text) {
  kerf::TorchTextScanner whole;
  kerf::TorchTextScanner parts;
  whole.add(text);
  for (std::string_view left = text; !left.empty();) {
    const std::size_t end = std::min(left.find('\n'), left.size() - 1) + 1;
    parts.add(left.substr(0, end));
    left.remove_prefix(end);
  }
  const kerf::TorchText a = whole.take();
  const kerf::TorchText b = parts.take();
  check(a.is_qtplasmac == b.is_qtplasmac && a.hal_line == b.hal_line);
  check(a.changes.size() == b.changes.size());
  std::uint32_t line = 0;
  for (std::size_t i = 0; i < a.changes.size(); ++i) {
    check(a.changes[i].line == b.changes[i].line && a.changes[i].modes == b.changes[i].modes);
    check(a.changes[i].line > line);
    line = a.changes[i].line;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  kerf::Diagnostics diagnostics;
  kerf::TorchRun run;
  switch (data[0]) {
    case 'f':
      kerf::parse_material_file(text, "fuzz.cfg", 25.4, run.materials, diagnostics);
      check(!run.materials.empty());
      break;
    case 'p':
      run.materials.emplace_back();
      kerf::parse_plasma_prefs(text, "fuzz.prefs", 1, run.materials[0], run.hal_values,
                               diagnostics);
      break;
    case 'c':
      edit_materials(text);
      break;
    case 'n':
      scan_program(text);
      break;
    default:
      for_lines(text, [](std::string_view line) {
        const auto trigger = kerf::BeamTrigger::parse(line);
        check(trigger ? !trigger->terms().empty() : !trigger.error().empty());
      });
      break;
  }
  check_said(diagnostics);
  for (const TorchMaterial& row : run.materials) check_material(row);
  check(!kerf::torch_run_text(run).empty());
  return 0;
}
