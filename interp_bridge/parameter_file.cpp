#include "interp_bridge/parameter_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

// Numbers of LinuxCNC's parameters (manual: "Numbered parameters").
constexpr int kG28First = 5161;
constexpr int kG30First = 5181;
constexpr int kG92Active = 5210;
constexpr int kG92First = 5211;
constexpr int kWorkOffset = 5220;
constexpr int kWorkOffsetFirst = 5221;
constexpr int kWorkOffsetStride = 20;
constexpr int kRotation = 9;  // after the nine axes
constexpr int kMostParameters = 5602;

const char* skip_blanks(const char* at, const char* end) {
  while (at != end && is_line_blank(*at)) ++at;
  return at;
}

struct Line {
  int number = 0;
  double value = 0;
};

/// False with `column` where the line stops being "number value".
bool read_line(const std::string& text, Line& line, int& column) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const char* at = skip_blanks(begin, end);
  const auto number = std::from_chars(at, end, line.number);
  column = static_cast<int>(at - begin) + 1;
  if (number.ec != std::errc{} || line.number < 1 || line.number >= kMostParameters) return false;
  at = skip_blanks(number.ptr, end);
  const auto value = std::from_chars(at, end, line.value);
  column = static_cast<int>(at - begin) + 1;
  if (value.ec != std::errc{}) return false;
  at = skip_blanks(value.ptr, end);
  column = static_cast<int>(at - begin) + 1;
  return at == end;
}

}  // namespace

int ParameterFile::work_offset_index() const {
  const double written = value(kWorkOffset);
  return written >= 1 && written <= 9 ? static_cast<int>(written) : 1;
}

WorkpieceFrame ParameterFile::frame(int index, double unit_mm) const {
  WorkpieceFrame frame;
  const int first = kWorkOffsetFirst + (index - 1) * kWorkOffsetStride;
  const bool shifted = value(kG92Active) != 0;
  for (int i = 0; i < 3; ++i) {
    frame.g5x_mm[i] = value(first + i) * unit_mm;
    if (shifted) frame.g92_mm[i] = value(kG92First + i) * unit_mm;
    frame.offset_abc_deg[static_cast<std::size_t>(i)] =
        value(first + 3 + i) + (shifted ? value(kG92First + 3 + i) : 0.0);
    frame.offset_uvw_mm[i] =
        (value(first + 6 + i) + (shifted ? value(kG92First + 6 + i) : 0.0)) * unit_mm;
  }
  frame.rotation_deg = value(first + kRotation);
  return frame;
}

void ParameterFile::set_frame(int index, const WorkpieceFrame& frame, double unit_mm) {
  const int first = kWorkOffsetFirst + (index - 1) * kWorkOffsetStride;
  for (int i = 0; i < 3; ++i) {
    values[first + i] = frame.g5x_mm[i] / unit_mm;
    values[first + 3 + i] = frame.offset_abc_deg[static_cast<std::size_t>(i)];
    values[first + 6 + i] = frame.offset_uvw_mm[i] / unit_mm;
  }
  values[first + kRotation] = frame.rotation_deg;
  values.try_emplace(kWorkOffset, 1);
}

void ParameterFile::scale_lengths(double factor) {
  const auto scale_axes = [&](int first) {
    for (const int axis : {0, 1, 2, 6, 7, 8}) {
      const auto found = values.find(first + axis);
      if (found != values.end()) found->second *= factor;
    }
  };
  for (const int first : {kG28First, kG30First, kG92First}) scale_axes(first);
  for (int i = 0; i < kWorkOffsets; ++i) scale_axes(kWorkOffsetFirst + i * kWorkOffsetStride);
}

std::string ParameterFile::text() const {
  std::string out;
  for (const auto& [number, value] : values) out += fmt::format("{} {:.17g}\n", number, value);
  return out;
}

Result<ParameterFile> read_parameter_file(const std::string& path, Diagnostics& diagnostics) {
  errno = 0;
  std::ifstream file(path);
  const auto unreadable = [&] {
    return Error{trf("reading {}: {}", path, std::strerror(errno != 0 ? errno : EIO))};
  };
  if (!file) return unreadable();
  ParameterFile out;
  std::string text;
  int before = 0;
  for (int number = 1; std::getline(file, text); ++number) {
    if (trim(text, is_line_blank).empty()) continue;
    Line line;
    Diagnostic fault;
    fault.severity = Severity::kWarning;
    fault.file = path;
    fault.line = number;
    if (!read_line(text, line, fault.column)) {
      fault.message = tr("is not a parameter: a number from 1 to 5601 and its value are expected");
      fault.excerpt = text.substr(0, 80);
      diagnostics.push_back(std::move(fault));
      continue;
    }
    if (line.number <= before) {
      fault.column = 1;
      fault.message =
          trf("parameter {} after {}: LinuxCNC wants them in rising order", line.number, before);
      fault.excerpt = text.substr(0, 80);
      diagnostics.push_back(std::move(fault));
    }
    before = line.number;
    out.values[line.number] = line.value;
  }
  if (file.bad()) return unreadable();
  return out;
}

Result<ParameterFile> parameters_of(const InterpreterSetup& machine, double unit_mm,
                                    Diagnostics& diagnostics) {
  ParameterFile file;
  const bool has_file = !machine.parameter_path.empty();
  if (has_file) {
    Result<ParameterFile> given = read_parameter_file(machine.parameter_path, diagnostics);
    if (!given) return given;
    file = std::move(*given);
  }
  if (!machine.work_offset) return file;
  if (has_file) {
    file.set_frame(file.work_offset_index(), *machine.work_offset, unit_mm);
    return file;
  }
  for (int i = 1; i <= kWorkOffsets; ++i) file.set_frame(i, *machine.work_offset, unit_mm);
  return file;
}

}  // namespace kerf
