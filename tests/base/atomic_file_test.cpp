#include "base/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

using Names = std::vector<std::string>;

void write_text(AtomicFile& file, const std::string& text) { file.write(text.data(), text.size()); }

/// Lets this process write no more than `bytes` to a file, as a full disk would.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    old_handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST(AtomicFile, appears_only_on_commit) {
  const TemporaryFolder folder;
  Result<AtomicFile> file = AtomicFile::create(folder / "part.stl");
  ASSERT_TRUE(file);
  write_text(*file, "one ");
  write_text(*file, "two");
  ASSERT_EQ(folder.names().size(), 1u);
  const std::string temporary = folder.names()[0];
  EXPECT_EQ(temporary.substr(0, 10), ".part.stl.");
  EXPECT_EQ(temporary.size(), 16u);
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(folder.names(), Names{"part.stl"});
  EXPECT_EQ(read_file(folder / "part.stl"), "one two");
}

TEST(AtomicFile, keeps_order_across_small_and_large_writes) {
  const TemporaryFolder folder;
  Result<AtomicFile> file = AtomicFile::create(folder / "big");
  ASSERT_TRUE(file);
  std::string expected;
  for (const std::size_t size : {10u, 3000000u, 7u, 1048576u, 1048575u, 1048570u, 20u, 0u, 1u}) {
    const std::string block(size, static_cast<char>('a' + expected.size() % 26));
    expected += block;
    write_text(*file, block);
  }
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(read_file(folder / "big"), expected);
}

TEST(AtomicFile, replaces_and_leaves_a_new_file_as_readable_as_any) {
  const TemporaryFolder folder;
  write_file(folder / "part", "old");
  Result<AtomicFile> file = AtomicFile::create(folder / "part");
  ASSERT_TRUE(file);
  write_text(*file, "new");
  EXPECT_EQ(read_file(folder / "part"), "old");
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(read_file(folder / "part"), "new");
  struct stat written, plain;
  write_file(folder / "plain", "");
  ASSERT_EQ(stat((folder / "part").c_str(), &written), 0);
  ASSERT_EQ(stat((folder / "plain").c_str(), &plain), 0);
  EXPECT_EQ(written.st_mode, plain.st_mode);
}

TEST(AtomicFile, destructor_removes_what_was_not_committed) {
  const TemporaryFolder folder;
  write_file(folder / "part", "old");
  {
    Result<AtomicFile> file = AtomicFile::create(folder / "part");
    ASSERT_TRUE(file);
    write_text(*file, "new");
  }
  EXPECT_EQ(folder.names(), Names{"part"});
  EXPECT_EQ(read_file(folder / "part"), "old");
}

TEST(AtomicFile, moves) {
  const TemporaryFolder folder;
  Result<AtomicFile> a = AtomicFile::create(folder / "a");
  Result<AtomicFile> b = AtomicFile::create(folder / "b");
  ASSERT_TRUE(a && b);
  write_text(*a, "from a");
  *b = std::move(*a);  // what b had begun is dropped
  EXPECT_EQ(folder.names().size(), 1u);
  AtomicFile c(std::move(*b));
  write_text(c, ", more");
  ASSERT_TRUE(c.commit());
  EXPECT_EQ(folder.names(), Names{"a"});
  EXPECT_EQ(read_file(folder / "a"), "from a, more");
}

TEST(AtomicFile, follows_a_symbolic_link) {
  const TemporaryFolder folder;
  const TemporaryFolder elsewhere;
  write_file(elsewhere / "part", "old");
  ASSERT_EQ(symlink((elsewhere / "part").c_str(), (folder / "link").c_str()), 0);
  Result<AtomicFile> file = AtomicFile::create(folder / "link");
  ASSERT_TRUE(file);
  write_text(*file, "new");
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(read_file(elsewhere / "part"), "new");
  struct stat status;
  ASSERT_EQ(lstat((folder / "link").c_str(), &status), 0);
  EXPECT_TRUE(S_ISLNK(status.st_mode));
  EXPECT_EQ(folder.names(), Names{"link"});
}

TEST(AtomicFile, takes_a_name_of_the_greatest_length) {
  const TemporaryFolder folder;
  const std::string name(255, 'n');
  Result<AtomicFile> file = AtomicFile::create(folder / name);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(folder.names(), Names{name});
}

TEST(AtomicFile, writes_to_a_pipe_as_it_comes) {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  Result<AtomicFile> file = AtomicFile::create(pipe);
  ASSERT_TRUE(file);
  write_text(*file, "bytes");
  ASSERT_TRUE(file->commit());
  char text[16] = {};
  EXPECT_EQ(read(reader, text, sizeof text), 5);
  EXPECT_STREQ(text, "bytes");
  close(reader);
  EXPECT_EQ(folder.names(), Names{"pipe"});
}

TEST(AtomicFile, dash_is_standard_output) {
  const TemporaryFolder folder;
  const std::string captured = folder / "captured";
  const int kept = dup(STDOUT_FILENO);
  const int to = open(captured.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(to, STDOUT_FILENO);
  close(to);
  Result<AtomicFile> file = AtomicFile::create("-");
  const bool opened = static_cast<bool>(file);
  if (opened) write_text(*file, "to stdout");
  const bool committed = opened && file->commit();
  dup2(kept, STDOUT_FILENO);
  close(kept);
  EXPECT_TRUE(committed);
  EXPECT_EQ(read_file(captured), "to stdout");
}

TEST(AtomicFile, an_open_descriptor_goes_on_where_it_is) {
  const TemporaryFolder folder;
  const std::string path = folder / "log";
  const int log = open(path.c_str(), O_RDWR | O_CREAT, 0600);
  ASSERT_EQ(write(log, "before ", 7), 7);
  for (const char* name : {"/dev/fd/", "/proc/self/fd/"}) {
    EXPECT_TRUE(written_as_it_comes(name + std::to_string(log)));
    Result<AtomicFile> file = AtomicFile::create(name + std::to_string(log));
    ASSERT_TRUE(file) << file.error();
    write_text(*file, "kerf ");
    ASSERT_TRUE(file->commit());
  }
  ASSERT_EQ(write(log, "after", 5), 5);
  close(log);
  EXPECT_EQ(read_file(path), "before kerf kerf after");
  EXPECT_EQ(folder.names(), Names{"log"});
  EXPECT_TRUE(written_as_it_comes("/dev/stderr"));
  EXPECT_TRUE(written_as_it_comes("/dev/null"));
  EXPECT_FALSE(written_as_it_comes(path));
  EXPECT_FALSE(written_as_it_comes(folder / "not there"));
  EXPECT_FALSE(written_as_it_comes("/dev/fd/3x"));
}

// ---- Failures -----------------------------------------------------------------------------------

TEST(AtomicFile, without_a_folder_is_an_error) {
  const TemporaryFolder folder;
  const Result<AtomicFile> file = AtomicFile::create(folder / "none/part.stl");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error(), "writing " + (folder / "none/part.stl") + ": No such file or directory");
}

TEST(AtomicFile, a_file_in_place_of_a_folder_is_an_error) {
  const TemporaryFolder folder;
  write_file(folder / "file", "");
  const Result<AtomicFile> file = AtomicFile::create(folder / "file/part.stl");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error(), "writing " + (folder / "file/part.stl") + ": Not a directory");
}

TEST(AtomicFile, a_folder_as_target_is_an_error) {
  const TemporaryFolder folder;
  for (const std::string& path : {folder.path(), folder / "new/"}) {
    const Result<AtomicFile> file = AtomicFile::create(path);
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error(), "writing " + path + ": Is a directory");
  }
  EXPECT_EQ(folder.names(), Names{});
}

TEST(AtomicFile, no_name_is_an_error) {
  const Result<AtomicFile> file = AtomicFile::create("");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error(), "no file name given to write to");
}

TEST(AtomicFile, a_full_device_is_an_error) {
  Result<AtomicFile> file = AtomicFile::create("/dev/full");
  ASSERT_TRUE(file);
  write_text(*file, "bytes");
  const Done done = file->commit();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error(), "writing /dev/full: No space left on device");
}

TEST(AtomicFile, a_write_cut_short_is_an_error_and_leaves_nothing) {
  for (const std::size_t bytes : {70000u, 3000000u}) {  // buffered, and past the buffer
    const TemporaryFolder folder;
    write_file(folder / "part", "old");
    const FileSizeLimit limit(65536);
    Result<AtomicFile> file = AtomicFile::create(folder / "part");
    ASSERT_TRUE(file);
    write_text(*file, std::string(bytes, 'x'));
    write_text(*file, "after the error");
    const Done done = file->commit();
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error(), "writing " + (folder / "part") + ": File too large");
    EXPECT_EQ(folder.names(), Names{"part"});
    EXPECT_EQ(read_file(folder / "part"), "old");
  }
}

/// In a process of its own, in a mount namespace of its own. 0: as expected.
int fill_a_disk(const std::string& disk) {
  if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return 77;
  if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return 77;
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=65536") != 0) return 77;
  Result<AtomicFile> file = AtomicFile::create(disk + "/part");
  if (!file) return 1;
  write_text(*file, std::string(100000, 'x'));
  const Done done = file->commit();
  if (done || done.error() != "writing " + disk + "/part: No space left on device") return 2;
  return std::filesystem::is_empty(disk) ? 0 : 3;
}

TEST(AtomicFile, a_full_disk_is_an_error_and_leaves_nothing) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) _exit(fill_a_disk(folder.path()));
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "this system lets us mount no disk";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(AtomicFile, a_target_that_became_a_folder_is_an_error_and_leaves_nothing) {
  const TemporaryFolder folder;
  Result<AtomicFile> file = AtomicFile::create(folder / "part");
  ASSERT_TRUE(file);
  ASSERT_EQ(mkdir((folder / "part").c_str(), 0700), 0);
  const Done done = file->commit();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error(), "writing " + (folder / "part") + ": Is a directory");
  EXPECT_EQ(folder.names(), Names{"part"});
}

// ---- The way out --------------------------------------------------------------------------------

TEST(RemoveUncommittedFiles, removes_all_of_them_and_nothing_else) {
  const TemporaryFolder folder;
  Result<AtomicFile> done = AtomicFile::create(folder / "done");
  Result<AtomicFile> a = AtomicFile::create(folder / "a");
  Result<AtomicFile> b = AtomicFile::create(folder / "b");
  ASSERT_TRUE(done && a && b);
  ASSERT_TRUE(done->commit());
  AtomicFile moved(std::move(*b));
  EXPECT_EQ(folder.names().size(), 3u);
  remove_uncommitted_files();
  EXPECT_EQ(folder.names(), Names{"done"});
  const Done late = a->commit();
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error(), "writing " + (folder / "a") + ": Operation canceled");
  remove_uncommitted_files();  // nothing left: nothing happens
  EXPECT_EQ(folder.names(), Names{"done"});
}

TEST(RemoveUncommittedFiles, works_from_a_signal_handler) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGINT, [](int) {
      remove_uncommitted_files();
      _exit(5);
    });
    Result<AtomicFile> file = AtomicFile::create(folder / "part");
    if (!file || folder.names().size() != 1) _exit(1);
    std::raise(SIGINT);
    _exit(2);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 5);
  EXPECT_EQ(folder.names(), Names{});
}

TEST(RemoveUncommittedFiles, entries_are_used_again) {
  const TemporaryFolder folder;
  for (int i = 0; i < 50; ++i) {
    Result<AtomicFile> a = AtomicFile::create(folder / "a");
    Result<AtomicFile> b = AtomicFile::create(folder / "b");
    ASSERT_TRUE(a && b);
    if (i % 2 == 0) {
      ASSERT_TRUE(a->commit());
    }
  }
  Result<AtomicFile> last = AtomicFile::create(folder / "last");
  ASSERT_TRUE(last);
  remove_uncommitted_files();
  EXPECT_EQ(folder.names(), Names{"a"});
}

}  // namespace
}  // namespace kerf
