#include "twin/scene/program_text.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

SourceFile text_of(const std::string& path, std::size_t max_bytes) {
  if (path.empty() || path == "-") return {path, tr("(standard input)")};
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) return {path, fmt::format("({})", error.message())};
  if (bytes > max_bytes) return {path, trf("({} MB: too long to be shown)", bytes >> 20)};
  std::ifstream file(path, std::ios::binary);
  SourceFile text(path, file);
  const bool is_read = !file.bad() && (text.line_count() > 0 || bytes == 0);
  return is_read ? std::move(text) : SourceFile(path, fmt::format("({})", std::strerror(errno)));
}

}  // namespace

std::shared_ptr<const ProgramText> read_program_text(const std::vector<std::string>& paths,
                                                     std::size_t max_bytes) {
  auto program = std::make_shared<ProgramText>();
  for (const std::string& path : paths) {
    program->files.push_back(text_of(path, max_bytes));
  }
  return program;
}

}  // namespace kerf
