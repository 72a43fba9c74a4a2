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

std::string text_of(const std::string& path, std::size_t max_bytes) {
  if (path.empty() || path == "-") return tr("(standard input)");
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) return fmt::format("({})", error.message());
  if (bytes > max_bytes) {
    return trf("({} MB: too long to be shown)", bytes >> 20);
  }
  std::string text(static_cast<std::size_t>(bytes), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad() || (!file && text.empty())) return fmt::format("({})", std::strerror(errno));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

}  // namespace

std::shared_ptr<const ProgramText> read_program_text(const std::vector<std::string>& paths,
                                                     std::size_t max_bytes) {
  auto program = std::make_shared<ProgramText>();
  for (const std::string& path : paths) {
    program->files.emplace_back(path, text_of(path, max_bytes));
  }
  return program;
}

}  // namespace kerf
