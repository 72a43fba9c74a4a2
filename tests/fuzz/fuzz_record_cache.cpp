// Any bytes as an entry of the cache of records. The first byte says how much of the entry is right
// already: 0: nothing, 1: its hash, 2: what is before the records too, and how long they and the
// rows of files are.
#define XXH_INLINE_ALL
#include <unistd.h>
#include <xxhash.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "interp_bridge/record_cache.h"

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kKey = "a program of six bytes";
constexpr std::uint64_t kRoom = 1 << 20;

void append(std::string& out, std::uint64_t number) {
  out.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// A folder with one entry that counts; gone at the end.
class Place {
 public:
  Place() : folder_((fs::temp_directory_path() / "kerf-fuzz-XXXXXX").string()) {
    if (mkdtemp(folder_.data()) == nullptr) std::abort();
    auto store = kerf::RecordCache(folder_, kRoom).begin(kKey);
    if (!store) std::abort();
    store->write(std::string_view("records"));
    store->commit({});
    store.reset();
    for (const auto& file : fs::directory_iterator(folder_)) entry_ = file.path();
    if (!kerf::RecordCache(folder_, kRoom).find(kKey)) std::abort();
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  ~Place() {
    std::error_code error;
    fs::remove_all(folder_, error);
  }
  void put(std::string_view bytes) const {
    std::ofstream(entry_, std::ios::binary | std::ios::trunc) << bytes;
  }
  std::optional<kerf::CachedRecords> find() const {
    return kerf::RecordCache(folder_, kRoom).find(kKey);
  }

 private:
  std::string folder_;
  fs::path entry_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Place place;
  if (size < 2) return 0;
  const int right = data[0] % 3;
  // Rows begin behind this part of the rest.
  const std::size_t cut = (size - 2) * data[1] / 255;
  std::string entry(reinterpret_cast<const char*>(data) + 2, size - 2);
  if (right == 2) {
    std::string head("kerfmem1");
    append(head, kKey.size());
    append(entry, cut);
    append(entry, size - 2 - cut);
    entry = head.append(kKey) + entry;
  }
  if (right >= 1) {
    const XXH128_hash_t hash = XXH3_128bits(entry.data(), entry.size());
    append(entry, hash.low64);
    append(entry, hash.high64);
  }
  place.put(entry);
  std::optional<kerf::CachedRecords> records = place.find();
  if (!records) return 0;
  // Only an entry with a hash can be believed, and it gives what lies between key and rows.
  if (right == 0) std::abort();
  std::string read;
  std::array<char, 100> room;
  while (const std::size_t bytes = records->read(room)) read.append(room.data(), bytes);
  if (right == 2 && read != std::string_view(reinterpret_cast<const char*>(data) + 2, cut)) {
    std::abort();
  }
  return 0;
}
