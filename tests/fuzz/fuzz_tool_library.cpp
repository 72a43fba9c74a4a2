// Arbitrary bytes as a tool library: JSON of FreeCAD and Fusion, zip files, YAML.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "stock/cutter/shape_spec.h"
#include "twin/config/tool_library_reader.h"

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  // Outlines from files have a fuzzer of their own (fuzz_shape); escapes may spell their name.
  for (const char* const word : {"rofile", "ROFILE", "\\"}) {
    if (bytes.find(word) != bytes.npos) return 0;
  }
  kerf::Diagnostics diagnostics;
  const auto library = kerf::parse_tool_library(bytes, "/nowhere/shop", diagnostics);
  check(library.has_value() != kerf::has_error(diagnostics));
  for (const kerf::Diagnostic& one : diagnostics) {
    check(!kerf::to_string(one).empty() && !one.message.empty());
  }
  if (!library) return 0;
  for (const kerf::LibraryTool& tool : library->tools) {
    check(!kerf::title_of(tool).empty());
    check(!tool.number || (*tool.number >= 1 && *tool.number <= kerf::kMaxToolNumber));
    // Either is understood, or it says why not.
    check(tool.cutter.has_value() == tool.trouble.empty());
    if (tool.cutter)
      check(kerf::parse_shape(tool.cutter->spec()).value().spec() == tool.cutter->spec());
  }
  return 0;
}
