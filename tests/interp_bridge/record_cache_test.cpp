#include "interp_bridge/record_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <thread>

#include "tests/interp_bridge/program_test_support.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

/// What a file system's clock cannot tell from now is over.
void let_clock_tick() { std::this_thread::sleep_for(std::chrono::milliseconds(40)); }

void keep(const RecordCache& cache, const std::string& key, const std::string& records,
          const std::vector<FileRead>& reads = {}) {
  auto store = cache.begin(key);
  ASSERT_TRUE(store);
  store->write(std::span<const char>(records).first(records.size() / 2));
  store->write(std::span<const char>(records).subspan(records.size() / 2));
  store->commit(reads);
}

/// "-" where nothing is found.
std::string found(const RecordCache& cache, const std::string& key) {
  auto records = cache.find(key);
  if (!records) return "-";
  std::string text;
  std::array<char, 7> piece{};
  while (const std::size_t got = records->read(piece)) text.append(piece.data(), got);
  return text;
}

std::vector<fs::path> entries(const std::string& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path());
  return out;
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
void overwrite(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

constexpr std::uint64_t kRoom = 1U << 20U;

TEST(RecordCache, GivesBackWhatWasKeptForTheVeryKey) {
  const TestFolder folder;
  const RecordCache cache(folder.path("cache/kerf/interp"), kRoom);
  EXPECT_EQ(found(cache, "key"), "-");
  keep(cache, "key", "the records of a program");
  EXPECT_EQ(found(cache, "key"), "the records of a program");
  EXPECT_EQ(found(cache, "kex"), "-");
  keep(cache, "key", "other records");
  EXPECT_EQ(found(cache, "key"), "other records");
  EXPECT_EQ(entries(folder.path("cache/kerf/interp")).size(), 1U);
}

TEST(RecordCache, WhatIsNotCommittedLeavesNothing) {
  const TestFolder folder;
  const RecordCache cache(folder.path("cache"), kRoom);
  {
    auto store = cache.begin("key");
    ASSERT_TRUE(store);
    store->write(std::string(5000, 'r'));
  }
  EXPECT_EQ(found(cache, "key"), "-");
  EXPECT_TRUE(entries(folder.path("cache")).empty());
}

TEST(RecordCache, NoChangedByteAndNoCutIsBelieved) {
  const TestFolder folder;
  const RecordCache cache(folder.path("cache"), kRoom);
  const std::string sub = folder.write("sub.ngc", "o<sub> sub\n");
  let_clock_tick();
  keep(cache, "key", "records", {{sub, true}, {folder.path("none.ngc"), false}});
  ASSERT_EQ(found(cache, "key"), "records");
  const fs::path entry = entries(folder.path("cache")).at(0);
  const std::string whole = text_of(entry);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const char bit : {'\x01', '\x80'}) {
      std::string changed = whole;
      changed[i] = static_cast<char>(changed[i] ^ bit);
      overwrite(entry, changed);
      EXPECT_EQ(found(cache, "key"), "-") << "byte " << i;
    }
    overwrite(entry, whole.substr(0, i));
    EXPECT_EQ(found(cache, "key"), "-") << "cut at " << i;
  }
  overwrite(entry, whole + whole);
  EXPECT_EQ(found(cache, "key"), "-");
  overwrite(entry, whole);
  EXPECT_EQ(found(cache, "key"), "records");
}

TEST(RecordCache, AnEntryOfAnotherKeyIsNotBelievedUnderThisName) {
  const TestFolder folder;
  const RecordCache cache(folder.path("cache"), kRoom);
  keep(cache, "one", "of one");
  const fs::path one = entries(folder.path("cache")).at(0);
  const std::string text = text_of(one);
  fs::remove(one);
  keep(cache, "two", "of two");
  overwrite(entries(folder.path("cache")).at(0), text);
  EXPECT_EQ(found(cache, "two"), "-");
}

TEST(RecordCache, LinksAndWhatOthersMayWriteAreNotBelieved) {
  const TestFolder folder;
  const RecordCache cache(folder.path("cache"), kRoom);
  keep(cache, "key", "records");
  const fs::path entry = entries(folder.path("cache")).at(0);
  ASSERT_EQ(chmod(entry.c_str(), 0666), 0);
  EXPECT_EQ(found(cache, "key"), "-");
  ASSERT_EQ(chmod(entry.c_str(), 0644), 0);
  EXPECT_EQ(found(cache, "key"), "records");
  fs::rename(entry, folder.path("elsewhere"));
  fs::create_symlink(folder.path("elsewhere"), entry);
  EXPECT_EQ(found(cache, "key"), "-");
  // Nor is anything kept in a folder that others may write to.
  ASSERT_EQ(chmod(folder.path("cache").c_str(), 0777), 0);
  EXPECT_FALSE(cache.begin("key"));
}

TEST(RecordCache, FilesThatWereReadMustBeAsTheyWere) {
  const TestFolder folder;
  const RecordCache cache(folder.path("cache"), kRoom);
  const std::string sub = folder.write("sub.ngc", "G1 X1\n");
  const std::string sooner = folder.path("sooner.ngc");
  let_clock_tick();
  keep(cache, "key", "records", {{sub, true}, {sooner, false}});
  EXPECT_EQ(found(cache, "key"), "records");
  folder.write("sub.ngc", "G1 X2\n");
  EXPECT_EQ(found(cache, "key"), "-");
  folder.write("sub.ngc", "G1 X1\n");
  EXPECT_EQ(found(cache, "key"), "records");
  folder.write("sooner.ngc", "");
  EXPECT_EQ(found(cache, "key"), "-");
  fs::remove(sooner);
  EXPECT_EQ(found(cache, "key"), "records");
  fs::remove(sub);
  EXPECT_EQ(found(cache, "key"), "-");
}

TEST(RecordCache, AFileThatChangedDuringTheRunIsNotTakenForWhatWasRead) {
  const TestFolder folder;
  const RecordCache cache(folder.path("cache"), kRoom);
  const std::string sub = folder.write("sub.ngc", "G1 X1\n");
  let_clock_tick();
  auto store = cache.begin("key");
  ASSERT_TRUE(store);
  store->write(std::string("records"));
  folder.write("sub.ngc", "G1 X2\n");
  store->commit({{sub, true}});
  EXPECT_EQ(found(cache, "key"), "-");
}

TEST(RecordCache, WhatWasUsedLongestAgoGoesFirst) {
  const TestFolder folder;
  const RecordCache cache(folder.path("cache"), 10'000);
  const std::string records(2'000, 'r');
  for (const char* key : {"a", "b", "c", "d"}) {
    keep(cache, key, records);
    let_clock_tick();
  }
  EXPECT_EQ(found(cache, "a"), records);  // used now
  let_clock_tick();
  keep(cache, "e", records);
  EXPECT_EQ(found(cache, "a"), records);
  EXPECT_EQ(found(cache, "b"), "-");
  EXPECT_EQ(found(cache, "c"), records);
  EXPECT_EQ(found(cache, "e"), records);
  // One that would push out the others is not kept at all.
  keep(cache, "large", std::string(2'501, 'r'));
  EXPECT_EQ(found(cache, "large"), "-");
  EXPECT_EQ(entries(folder.path("cache")).size(), 4U);
}

/// A folder of many small programs would make each new one wait.
TEST(RecordCache, ThereAreAThousandAtMost) {
  const TestFolder folder;
  const RecordCache cache(folder.path("cache"), kRoom);
  keep(cache, "old", "records");
  for (int i = 0; i < 1200; ++i) folder.write(fmt::format("cache/{:04}.records", i), "x");
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(48);
  for (const fs::path& path : entries(folder.path("cache"))) fs::last_write_time(path, long_ago);
  EXPECT_EQ(found(cache, "old"), "records");  // used now
  let_clock_tick();
  keep(cache, "new", "records");
  EXPECT_EQ(entries(folder.path("cache")).size(), 1000U);
  EXPECT_EQ(found(cache, "old"), "records");
  EXPECT_EQ(found(cache, "new"), "records");
}

TEST(RecordCache, WhatAKilledWriterLeftGoesWhenItIsOld) {
  const TestFolder folder;
  const RecordCache cache(folder.path("cache"), kRoom);
  keep(cache, "key", "records");
  const std::string old = folder.write("cache/.0123.records.AbCdEf", "half");
  const std::string young = folder.write("cache/.4567.records.AbCdEf", "half");
  const std::string foreign = folder.write("cache/notes.txt", "mine");
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(2));
  keep(cache, "more", "records");
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(young));
  EXPECT_TRUE(fs::exists(foreign));
}

TEST(RecordCache, AFolderThatCannotBeIsNone) {
  const TestFolder folder;
  folder.write("file", "");
  const RecordCache cache(folder.path("file/cache"), kRoom);
  EXPECT_EQ(found(cache, "key"), "-");
  EXPECT_FALSE(cache.begin("key"));
}

TEST(RecordCache, StandsWhereXdgSays) {
  setenv("XDG_CACHE_HOME", "/there", 1);
  EXPECT_EQ(record_cache_folder(), "/there/kerf/interp");
  setenv("XDG_CACHE_HOME", "relative", 1);
  setenv("HOME", "/home/me", 1);
  EXPECT_EQ(record_cache_folder(), "/home/me/.cache/kerf/interp");
  unsetenv("XDG_CACHE_HOME");
  unsetenv("HOME");
  EXPECT_EQ(record_cache_folder(), "");
}

}  // namespace
}  // namespace kerf
