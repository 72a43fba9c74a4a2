#include "twin/page/page_printer.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>
#include <thread>
#include <vector>

#include "base/atomic_file.h"
#include "base/small_file.h"
#include "base/spawn.h"
#include "base/translate.h"
#include "interp_bridge/private_folder.h"

namespace kerf {
namespace {

constexpr std::chrono::seconds kPatience{120};
constexpr std::size_t kMostPdf_bytes = std::size_t{256} << 20;
constexpr std::size_t kMostSaid_bytes = 64 << 10;

/// The last line that is one: what it says of itself at the end.
std::string last_line(const std::string& text) {
  std::string last;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin) last = text.substr(begin, end - begin);
    begin = end + 1;
  }
  return last;
}

/// Its status, as of waitpid(); -1: it was not done in time, and is gone.
int wait_for(pid_t child) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) {
      kill(-child, SIGKILL);
      waitpid(child, &status, 0);
      return -1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return status;
}

}  // namespace

std::string printing_browser() {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path ? path : "/usr/local/bin:/usr/bin:/bin";
  std::vector<std::string> folders;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (end > 0) folders.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    for (const std::string& folder : folders) {
      std::string candidate = folder + "/" + name;
      if (access(candidate.c_str(), X_OK) == 0) return candidate;
    }
  }
  return {};
}

Done print_page(const std::string& page, const std::string& path) {
  const std::string browser = printing_browser();
  if (browser.empty()) return Error{trf("printing {}: no browser is installed (chromium)", path)};
  const Result<PrivateFolder> folder = PrivateFolder::create();
  if (!folder) return Error{trf("printing {}: {}", path, folder.error())};
  const std::string html = folder->path() + "/page.html", pdf = folder->path() + "/page.pdf";
  const std::string said = folder->path() + "/said";
  {
    std::ofstream out(html, std::ios::binary);
    out << page;
    if (!out.flush()) return Error{trf("printing {}: {}: {}", path, html, std::strerror(errno))};
  }
  std::vector<std::string> words{browser,
                                 "--headless=new",
                                 "--disable-gpu",
                                 "--enable-unsafe-swiftshader",
                                 "--disable-background-networking",
                                 "--disable-component-update",
                                 "--disable-sync",
                                 "--disable-extensions",
                                 "--no-first-run",
                                 "--no-default-browser-check",
                                 "--user-data-dir=" + folder->path() + "/profile",
                                 "--no-pdf-header-footer",
                                 "--run-all-compositor-stages-before-draw",
                                 "--print-to-pdf=" + pdf};
  if (geteuid() == 0) words.push_back("--no-sandbox");  // it does not start as root otherwise
  words.push_back("file://" + html);
  const pid_t child = spawn_apart(words, said);
  if (child < 0) return Error{trf("printing {}: {}: {}", path, browser, std::strerror(errno))};
  const int status = wait_for(child);
  if (status == -1)
    return Error{trf("printing {}: {} was not done in {} s", path, browser, kPatience.count())};
  const Result<std::string> bytes = read_small_file(pdf, kMostPdf_bytes);
  if (!bytes || bytes->empty()) {
    const Result<std::string> words_of_it = read_small_file(said, kMostSaid_bytes);
    return Error{trf("printing {}: {} has made no file: {}", path, browser,
                     words_of_it ? last_line(*words_of_it) : std::string())};
  }
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};
  file->write(bytes->data(), bytes->size());
  return file->commit();
}

}  // namespace kerf
