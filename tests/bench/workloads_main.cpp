// kerf_workloads FOLDER: writes the NC programs of workloads.h there, and prints how to run each.
#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "base/atomic_file.h"
#include "tests/bench/workloads.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: kerf_workloads FOLDER\n");
    return 2;
  }
  for (const kerf::Workload& workload : kerf::workloads()) {
    const std::string path = fmt::format("{}/{}.ngc", argv[1], workload.name);
    auto file = kerf::AtomicFile::create(path);
    if (!file) {
      fmt::print(stderr, "kerf_workloads: {}\n", file.error());
      return 4;
    }
    const std::string text = workload.program();
    file->write(text.data(), text.size());
    if (const kerf::Done done = file->commit(); !done) {
      fmt::print(stderr, "kerf_workloads: {}\n", done.error());
      return 4;
    }
    fmt::print("# {}\nkerf run {} --stock {} --tool {}\n", workload.about, path, workload.stock,
               workload.tool);
  }
  return 0;
}
