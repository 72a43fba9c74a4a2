// replay_fuzz_NAME FOLDER: hands each file of FOLDER to a fuzz entry point, and each prefix of the
// small ones: a text cut off at any byte is the fault that files have most often. A crash or a
// failed assert is the failure.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

/// Above this, prefixes cost more time than they find.
constexpr std::size_t kLargestWithPrefixes_bytes = 4096;

void feed(const std::string& bytes, std::size_t size) {
  // A copy of the exact size, so that a sanitizer sees one byte too many.
  const std::vector<std::uint8_t> data(bytes.begin(),
                                       bytes.begin() + static_cast<std::ptrdiff_t>(size));
  LLVMFuzzerTestOneInput(data.data(), data.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) {
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::printf("%s\n", entry.path().c_str());
    std::fflush(stdout);  // The last name printed is the one that crashed.
    feed(bytes, bytes.size());
    if (bytes.size() <= kLargestWithPrefixes_bytes) {
      for (std::size_t size = 0; size < bytes.size(); ++size) feed(bytes, size);
    }
    ++files;
  }
  if (files == 0) {
    std::fprintf(stderr, "%s: no file in %s\n", argv[0], argv[1]);
    return 1;
  }
  return 0;
}
