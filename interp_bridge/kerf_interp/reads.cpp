#include "interp_bridge/kerf_interp/reads.h"

#include <dlfcn.h>
#include <unistd.h>

#include <climits>
#include <cstdlib>
#include <interp_base.hh>
#include <map>
#include <string>

namespace kerf::interp {
namespace {

struct Reads {
  std::map<std::string, bool, std::less<>> files;
  bool hidden = false;
};

Reads& reads() {
  static Reads all;
  return all;
}

/// As the reader, which stands elsewhere, must name it.
std::string absolute(std::string_view path) {
  if (!path.empty() && path.front() == '/') return std::string(path);
  char folder[PATH_MAX];
  if (getcwd(folder, sizeof folder) == nullptr) return {};
  return std::string(folder) + "/" + std::string(path);
}

}  // namespace

void note_read(std::string_view path, bool found) {
  std::string name = absolute(path);
  // What is longer would be cut off.
  if (name.empty() || name.size() > records::kMaxText) return note_hidden();
  const auto [at, is_new] = reads().files.try_emplace(std::move(name), found);
  if (!is_new && at->second != found) note_hidden();  // it came or went during the run
}

void note_hidden() { reads().hidden = true; }

void write_reads(RecordWriter& records) {
  char self[PATH_MAX];
  const ssize_t bytes = readlink("/proc/self/exe", self, sizeof self);
  Dl_info library{};
  if (bytes <= 0 || bytes >= PATH_MAX ||
      dladdr(reinterpret_cast<const void*>(&interp_from_shlib), &library) == 0) {
    note_hidden();
  } else {
    note_read({self, static_cast<std::size_t>(bytes)}, true);
    note_read(library.dli_fname, true);
  }
  for (const auto& [path, found] : reads().files) records.text(records::kRead, found ? 1 : 0, path);
  if (reads().hidden) records.numbers(records::kHidden, 0, {});
}

}  // namespace kerf::interp
