#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "base/atomic_file.h"
#include "base/translate.h"
#include "twin/report/motion_table.h"

namespace kerf {
namespace {

constexpr std::size_t kBlock_bytes = std::size_t{1} << 16;

/// Copies a table's rows with one column more. Its heading goes in once.
class TableJoiner {
 public:
  explicit TableJoiner(AtomicFile& out) : out_(out) {}

  void add(std::ifstream& in, const std::string& column) {
    const bool keeps_heading = std::exchange(is_first_, false);
    const std::string heading = ",setup\r\n", end = "," + column + "\r\n";
    bool is_quoted = false, is_heading = true;
    std::string text;
    std::array<char, kBlock_bytes> block;
    while (in.read(block.data(), block.size()), in.gcount() > 0) {
      text.clear();
      for (std::streamsize n = 0; n < in.gcount(); ++n) {
        const char c = block[static_cast<std::size_t>(n)];
        if (c == '"') is_quoted = !is_quoted;
        const bool ends_row = !is_quoted && c == '\n';
        const bool is_shown = !is_heading || keeps_heading;
        if (is_shown && (is_quoted || (c != '\r' && c != '\n'))) text += c;
        if (!ends_row) continue;
        if (is_shown) text += is_heading ? heading : end;
        is_heading = false;
      }
      out_.write(text.data(), text.size());
    }
  }

 private:
  AtomicFile& out_;
  bool is_first_ = true;
};

}  // namespace

Done join_motion_tables(const std::string& path, const std::vector<std::string>& tables) {
  Result<AtomicFile> out = AtomicFile::create(path);
  if (!out) return Error{out.error()};
  TableJoiner joiner(*out);
  for (std::size_t n = 0; n < tables.size(); ++n) {
    if (tables[n].empty()) continue;
    std::ifstream in(tables[n], std::ios::binary);
    if (!in) return Error{trf("reading {}: {}", tables[n], std::strerror(errno))};
    joiner.add(in, fmt::format("{}", n + 1));
    if (in.bad()) return Error{trf("reading {}: {}", tables[n], std::strerror(errno))};
  }
  return out->commit();
}

}  // namespace kerf
