#include "interp_bridge/canonical_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/program_prepare.h"

namespace kerf {
namespace {

constexpr std::size_t kBufferBytes = 256 * 1024;
constexpr std::uint64_t kMaxMalformedReports = 20;
constexpr std::size_t kExcerptBytes = 200;

bool before(const SourceRef& a, const SourceRef& b) {
  return a.file != b.file ? a.file < b.file : a.line < b.line;
}

}  // namespace

CanonicalReader::CanonicalReader(CanonicalReaderOptions options, const MotionSink& sink,
                                 ProgramSummary& summary, Diagnostics& diagnostics)
    : options_(std::move(options)),
      diagnostics_(diagnostics),
      feeder_(options_.feeder, sink, summary, diagnostics),
      buffer_(kBufferBytes) {}

std::span<char> CanonicalReader::room() { return std::span<char>(buffer_).subspan(filled_); }

bool CanonicalReader::received(std::size_t bytes) {
  filled_ += bytes;
  const char* p = buffer_.data();
  const char* const end = p + filled_;
  bool go_on = true;
  while (go_on && p != end) {
    const auto* newline =
        static_cast<const char*>(std::memchr(p, '\n', static_cast<std::size_t>(end - p)));
    if (newline == nullptr) break;
    go_on = take_line({p, static_cast<std::size_t>(newline - p)});
    p = newline + 1;
  }
  filled_ = static_cast<std::size_t>(end - p);
  std::memmove(buffer_.data(), p, filled_);
  if (go_on && filled_ == buffer_.size()) {
    // No line of a listing is nearly as long.
    filled_ = 0;
    go_on = take_line({buffer_.data(), buffer_.size()});
  }
  return go_on && feeder_.flush_if_old();
}

bool CanonicalReader::take_line(std::string_view line) {
  ++listing_line_;
  parse_canonical_line(line, line_);
  switch (line_.kind) {
    case CanonicalLineKind::kCommand:
      if (options_.numbered_source && line_.command.name == CanonicalName::kComment &&
          line_.command.text == kStoreComment) {
        feeder_.take_store(source_of(line_.command));
        return true;
      }
      return feeder_.take(line_.command, source_of(line_.command));
    case CanonicalLineKind::kUnknown:
      take_unknown();
      break;
    case CanonicalLineKind::kForeign:
      feeder_.add_foreign(line);
      break;
    case CanonicalLineKind::kMalformed:
      take_malformed(line);
      break;
  }
  return !feeder_.done();
}

SourceRef CanonicalReader::source_of(const CanonicalCommand& command) const {
  if (!options_.numbered_source) {
    const bool usable =
        command.has_n && command.n > 0 && command.n <= std::numeric_limits<std::uint32_t>::max();
    return {0, static_cast<std::uint32_t>(usable ? command.n : listing_line_)};
  }
  if (command.has_n) return source_of_n(command.n);
  const SourceRef last = feeder_.last_source();
  if (!options_.unnumbered.empty() && last.line != 0) {
    // A line that was too long to be numbered: the next of them in the same file.
    const auto next =
        std::upper_bound(options_.unnumbered.begin(), options_.unnumbered.end(), last, before);
    if (next != options_.unnumbered.end() && next->file == last.file) return *next;
  }
  return last;
}

void CanonicalReader::take_unknown() {
  const std::string_view name = line_.command.spelling;
  if (!feeder_.take_unknown(name)) return;
  Diagnostic unknown;
  unknown.severity = Severity::kWarning;
  unknown.file = options_.listing_name;
  unknown.line = static_cast<int>(listing_line_);
  unknown.message = trf("unknown canonical command {}; it is counted and passed over",
                        name.substr(0, kExcerptBytes));
  diagnostics_.push_back(std::move(unknown));
}

void CanonicalReader::take_malformed(std::string_view line) {
  if (++malformed_ > kMaxMalformedReports) return;
  Diagnostic malformed;
  malformed.file = options_.listing_name;
  malformed.line = static_cast<int>(listing_line_);
  malformed.column = line_.column;
  malformed.message = fmt::format("{}: {}", line_.command.spelling, line_.message);
  malformed.excerpt = std::string(line.substr(0, kExcerptBytes));
  if (static_cast<std::size_t>(malformed.column) > kExcerptBytes) malformed.excerpt.clear();
  diagnostics_.push_back(std::move(malformed));
}

void CanonicalReader::finish() {
  if (filled_ > 0 && !feeder_.done()) take_line({buffer_.data(), filled_});
  filled_ = 0;
  if (malformed_ > kMaxMalformedReports) {
    Diagnostic more;
    more.file = options_.listing_name;
    more.message = trf("{} more lines could not be read", malformed_ - kMaxMalformedReports);
    diagnostics_.push_back(std::move(more));
  }
  feeder_.finish();
}

}  // namespace kerf
