// Arbitrary bytes as a DBC file; the signals that were read must be usable, and be found again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "machine_io/can/dbc_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  kerf::Diagnostics diagnostics;
  const kerf::DbcFile file = kerf::parse_dbc(text, "fuzz.dbc", diagnostics);
  if (diagnostics.size() > kerf::kMaxDbcDiagnostics) std::abort();
  for (const kerf::Diagnostic& diagnostic : diagnostics) {
    if (kerf::to_string(diagnostic).empty()) std::abort();
  }
  kerf::CanFrame frame;
  frame.length = kerf::kMaxCanBytes;
  for (std::size_t i = 0; i < frame.data.size() && i < size; ++i) frame.data[i] = data[i];
  for (const kerf::DbcSignal& signal : file.signals()) {
    frame.id = signal.signal.id;
    frame.extended = signal.signal.extended;
    if (kerf::read_can_signal(frame, signal.signal).fit == kerf::CanFit::kTooShort) std::abort();
  }
  if (!file.signals().empty()) {
    const kerf::DbcSignal& first = file.signals().front();
    const auto found = file.find(first.message + "." + first.name);
    if (found && found.value().line != first.line) std::abort();
    if (!found && found.error().find("signals are called") == std::string::npos) std::abort();
  }
  return 0;
}
