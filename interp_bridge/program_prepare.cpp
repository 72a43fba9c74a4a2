#include "interp_bridge/program_prepare.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "interp_bridge/block_words.h"
#include "interp_bridge/source_text.h"

namespace kerf {
namespace {

/// LinuxCNC's tool table holds 1000 rows.
constexpr std::size_t kMaxNamedTools = 900;
constexpr int kLargestToolNumber = 99'999;

const char* skip_blanks(const char* p, const char* end) {
  while (p != end && is_blank(*p)) ++p;
  return p;
}

/// Past "10", "10.5"; `p` itself if there is no digit.
const char* skip_number(const char* p, const char* end) {
  while (p != end && is_digit(*p)) ++p;
  if (p != end && *p == '.') {
    ++p;
    while (p != end && is_digit(*p)) ++p;
  }
  return p;
}

/// The whole number at the front of `text` (blanks before it do not count), or -1.
long read_number(std::string_view text) {
  const char* const end = text.data() + text.size();
  const char* p = skip_blanks(text.data(), end);
  if (p == end || !is_digit(*p)) return -1;
  long value = 0;
  for (; p != end && is_digit(*p) && value < 100'000'000; ++p) value = value * 10 + (*p - '0');
  return value;
}

void copy(std::string_view text, char*& out) {
  std::memcpy(out, text.data(), text.size());
  out += text.size();
}

}  // namespace

SourceRef source_of_n(std::uint64_t n) {
  const std::uint64_t file = n / kLinesPerFile;
  if (file > 0xffff) return {};
  return {static_cast<std::uint32_t>(file), static_cast<std::uint32_t>(n % kLinesPerFile)};
}

LineNumberer::LineNumberer(std::uint32_t file)
    : counter_(fmt::format("N{}", file * kLinesPerFile + 1)) {}

void LineNumberer::advance() {
  ++line_;
  for (std::size_t i = counter_.size() - 1; i > 0; --i) {
    if (counter_[i] != '9') {
      ++counter_[i];
      return;
    }
    counter_[i] = '0';
  }
  counter_.insert(1, 1, '1');
}

/// False: the line was copied as it is although it may move the machine.
bool LineNumberer::number_line(std::string_view line, char*& out) {
  const char* const end = line.data() + line.size();
  const char* p = skip_blanks(line.data(), end);
  // A closing % must stand alone; ; lines print nothing.
  if (p == end || *p == '%' || *p == ';') return copy(line, out), true;
  const bool slash = *p == '/';
  if (slash) p = skip_blanks(p + 1, end);
  if (p != end && (*p == 'N' || *p == 'n')) {
    const char* const digits = skip_blanks(p + 1, end);
    p = skip_number(digits, end);
    if (p == digits) return copy(line, out), false;
    p = skip_blanks(p, end);
  }
  const auto rest_bytes = static_cast<std::size_t>(end - p);
  const bool merges = p != end && (is_digit(*p) || *p == '.');
  const std::size_t bytes = (slash ? 1 : 0) + counter_.size() + rest_bytes;
  if (merges || line.size() > kMaxLineBytes || bytes > kMaxLineBytes) {
    return copy(line, out), false;
  }
  if (p != end && (*p == 'o' || *p == 'O')) note_o_word({p + 1, rest_bytes - 1});
  if (slash) *out++ = '/';
  copy(counter_, out);
  copy({p, rest_bytes}, out);
  return true;
}

/// Ahead of line_, at out[used].
void LineNumberer::note_store(std::string_view line, std::string& out, std::size_t& used) {
  const char* const p = skip_blanks(line.data(), line.data() + line.size());
  const bool slash = p != line.data() + line.size() && *p == '/';
  const std::string note = fmt::format("{}{}({})\n", slash ? "/" : "", counter_, kStoreComment);
  out.resize(std::max(out.size(), used + note.size()));
  note.copy(out.data() + used, note.size());
  used += note.size();
  ++added_;
}

void LineNumberer::append(std::string_view text, std::string& out) {
  note_words(text);
  const char* p = text.data();
  const char* const end = p + text.size();
  std::size_t used = out.size();
  while (p != end) {
    const auto* newline =
        static_cast<const char*>(std::memchr(p, '\n', static_cast<std::size_t>(end - p)));
    const char* const stop = newline == nullptr ? end : newline;
    std::string_view line(p, static_cast<std::size_t>(stop - p));
    const bool is_store =
        may_store(line) && line.find(kStoreComment) == line.npos && stores(words_of_block(line));
    // A comment of the block's own would be printed instead; a longer line may be too long.
    const bool shares = is_store && line.find_first_of("(;") == line.npos && line.size() < 100;
    if (is_store && !shares) note_store(line, out, used);
    const std::size_t needed =
        used + line.size() + counter_.size() + kStoreComment.size() + 2 + std::size_t{2};
    if (out.size() < needed) out.resize(std::max(needed, used + text.size() + text.size() / 2));
    char* at = out.data() + used;
    // The CR of DOS lines only costs room.
    if (line.size() <= kMaxLineBytes && !line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (!number_line(line, at)) unnumbered_.push_back(line_);
    if (shares) {
      *at++ = '(';
      copy(kStoreComment, at);
      *at++ = ')';
    }
    if (newline != nullptr) *at++ = '\n';
    used = static_cast<std::size_t>(at - out.data());
    advance();
    p = newline == nullptr ? end : newline + 1;
  }
  out.resize(used);
}

/// `<name> call`, `100 sub`, a lone `100` (Fanuc style); o[..] has no name that the text could
/// tell.
void LineNumberer::note_o_word(std::string_view after_o) {
  const char* const end = after_o.data() + after_o.size();
  const char* p = skip_blanks(after_o.data(), end);
  std::string name;
  if (p != end && *p == '<') {
    for (++p; p != end && *p != '>'; ++p) {
      if (!is_blank(*p)) name += to_lower(*p);
    }
    if (p == end) return;
    ++p;
  } else {
    for (; p != end && is_digit(*p); ++p) name += *p;
  }
  if (name.empty()) return;
  p = skip_blanks(p, end);
  std::string keyword;
  for (; p != end && is_letter(*p); ++p) keyword += to_lower(*p);
  if (keyword == "call")
    called_.insert(std::move(name));
  else if (keyword == "sub" || keyword.empty())
    defined_.insert(std::move(name));
}

void LineNumberer::note_words(std::string_view text) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const auto note_tool = [this](long number) {
    if (number > 0 && number <= kLargestToolNumber && tools_.numbers.size() < kMaxNamedTools) {
      tools_.numbers.insert(static_cast<int>(number));
    }
  };
  for (const char letter : {'T', 't', 'H', 'h', 'M', 'm'}) {
    const char* p = begin;
    while (p != end) {
      p = static_cast<const char*>(std::memchr(p, letter, static_cast<std::size_t>(end - p)));
      if (p == nullptr) break;
      const char* const hit = p++;
      if (hit != begin && is_letter(hit[-1])) continue;  // in a word of a comment
      const std::string_view after(p, static_cast<std::size_t>(end - p));
      const long number = read_number(after);
      if (to_lower(letter) == 'm') {
        if (number == 66) note_wait(text, static_cast<std::size_t>(hit - begin));
        if (number != 61 && number != 98) continue;
        const std::string_view line = after.substr(0, after.find('\n'));
        const std::size_t word = line.find_first_of(number == 61 ? "Qq" : "Pp");
        const long argument = word == line.npos ? -1 : read_number(line.substr(word + 1));
        if (argument < 0) continue;
        if (number == 61)
          note_tool(argument);
        else
          called_.insert(std::to_string(argument));
        continue;
      }
      if (number >= 0) note_tool(number);
      const char* const next = skip_blanks(p, end);
      tools_.computed |= next != end && (*next == '#' || *next == '[');
    }
  }
}

/// An M66 at `at`, unless that is within a comment.
void LineNumberer::note_wait(std::string_view text, std::size_t at) {
  const std::size_t newline = text.rfind('\n', at);
  const std::size_t begin = newline == text.npos ? 0 : newline + 1;
  const std::string_view before = text.substr(begin, at - begin);
  if (before.find(';') != before.npos) return;
  const std::size_t open = before.rfind('(');
  if (open != before.npos && before.find(')', open) == before.npos) return;
  const auto stop = text.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto line = line_ + static_cast<std::uint32_t>(std::count(text.begin(), stop, '\n'));
  // Capital letters are looked for before small ones.
  if (waits_.count++ == 0 || line < waits_.first.line) waits_.first.line = line;
}

std::set<std::string> LineNumberer::missing_subroutines() const {
  std::set<std::string> missing;
  std::set_difference(called_.begin(), called_.end(), defined_.begin(), defined_.end(),
                      std::inserter(missing, missing.end()));
  return missing;
}

namespace {

/// A new file, written in full or reported.
class Copy {
 public:
  explicit Copy(std::string path)
      : path_(std::move(path)),
        fd_(open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)) {
    if (fd_ < 0) error_ = errno;
  }
  Copy(const Copy&) = delete;
  Copy& operator=(const Copy&) = delete;
  ~Copy() {
    if (fd_ >= 0) close(fd_);
  }

  void write(std::string_view text) {
    while (!text.empty() && error_ == 0) {
      const ssize_t written = ::write(fd_, text.data(), text.size());
      if (written >= 0)
        text.remove_prefix(static_cast<std::size_t>(written));
      else if (errno != EINTR)
        error_ = errno;
    }
  }
  Done result() const {
    if (error_ == 0) return std::monostate{};
    return Error{trf("writing {}: {}", path_, std::strerror(error_))};
  }

 private:
  std::string path_;
  int fd_;
  int error_ = 0;
};

Result<LineNumberer> copy_numbered(const std::string& from, std::uint32_t file,
                                   const std::string& to) {
  TextPieces pieces(from);
  LineNumberer numberer(file);
  Copy copy(to);
  std::string numbered;
  std::string_view text;
  while (pieces.next(text)) {
    numbered.clear();
    numberer.append(text, numbered);
    copy.write(numbered);
  }
  if (!pieces.error().empty()) return Error{pieces.error()};
  if (const Done done = copy.result(); !done) return Error{done.error()};
  return numberer;
}

/// Where LinuxCNC would find the subroutine if it ran in the program's folder, or here. Empty:
/// nowhere.
std::string find_subroutine(const std::string& name, const std::filesystem::path& program) {
  if (name.find('/') != name.npos) return {};
  const std::string file = name + ".ngc";
  std::error_code ignored;
  const std::filesystem::path beside = program.parent_path() / file;
  if (std::filesystem::is_regular_file(beside, ignored)) return beside.string();
  if (std::filesystem::is_regular_file(file, ignored)) return file;
  return {};
}

}  // namespace

Result<PreparedProgram> prepare_program(const std::string& path, const std::string& folder) {
  PreparedProgram prepared;
  prepared.main_name = std::filesystem::path(path).filename().string();
  prepared.files.push_back(path);
  std::deque<std::pair<std::string, std::string>> waiting = {{path, prepared.main_name}};
  std::set<std::string> taken = {prepared.main_name};
  for (std::uint32_t file = 0; !waiting.empty(); ++file) {
    const auto [from, name] = waiting.front();
    waiting.pop_front();
    const auto numberer = copy_numbered(from, file, folder + "/" + name);
    if (!numberer) return Error{numberer.error()};
    if (file == 0) prepared.lines = numberer->lines();
    for (const std::uint32_t line : numberer->unnumbered()) {
      prepared.unnumbered.push_back({file, line});
    }
    prepared.tools.numbers.insert(numberer->tools().numbers.begin(),
                                  numberer->tools().numbers.end());
    prepared.tools.computed |= numberer->tools().computed;
    const InputWaits& waits = numberer->waits();
    if (prepared.waits.count == 0) prepared.waits.first = {file, waits.first.line};
    prepared.waits.count += waits.count;
    for (const std::string& called : numberer->missing_subroutines()) {
      const std::string found = find_subroutine(called, path);
      if (found.empty() || !taken.insert(called + ".ngc").second) continue;
      prepared.files.push_back(found);
      waiting.emplace_back(found, called + ".ngc");
    }
  }
  return prepared;
}

}  // namespace kerf
