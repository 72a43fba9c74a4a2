#include "twin/mcp/mcp_server.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "base/exit_code.h"
#include "base/small_file.h"
#include "base/translate.h"
#include "interp_bridge/private_folder.h"
#include "twin/mcp/mcp_tools.h"
#include "twin/page/base64.h"

namespace kerf {
namespace {

using Json = nlohmann::json;
using Clock = BoundedProcess::Clock;

constexpr int kNoJson = -32700, kNoRequest = -32600, kNoMethod = -32601, kBadParams = -32602,
              kBusy = -32000;
constexpr std::array kVersions{"2024-11-05", "2025-03-26", "2025-06-18"};
constexpr std::size_t kMostLine_bytes = 1'000'000;
constexpr int kMostLevels = 32;
constexpr std::size_t kMostWaiting = 64;
/// Who takes no answers is not heard any further.
constexpr std::size_t kMostUnread_bytes = 1'000'000;
/// For answers to who has closed his end.
constexpr int kPatience_ms = 3000;
constexpr const char *kSaid = "/said.txt", *kWritten = "/written.png";  // .png: of pictures
constexpr std::size_t kMostSaid_bytes = 16'000, kMostMade_bytes = 16'000'000;
constexpr double kMostWritten_mb = 256;
constexpr std::size_t kMostListed = 200;  ///< findings, motions; all are counted

struct McpCall {
  McpRequest request;
  PrivateFolder folder;  ///< of all that it writes; goes with it
  BoundedProcess process;
};

Result<McpCall> start(McpRequest request, ProcessBounds bounds) {
  Result<PrivateFolder> folder = PrivateFolder::create();
  if (!folder) return Error{folder.error()};
  const Command command = request.tool->command;
  const std::string option = command == kView ? "--png=" : command == kCanon ? "--out=" : "--json=";
  std::vector<std::string> words = request.words;
  words.push_back(option + folder->path() + kWritten);
  bounds.file_mb = kMostWritten_mb;
  Result<BoundedProcess> process = BoundedProcess::start(words, folder->path() + kSaid, bounds);
  if (!process) return Error{process.error()};
  return McpCall{std::move(request), std::move(*folder), std::move(*process)};
}

McpJson content(const char* type, const char* key, const std::string& value) {
  return {{"content", McpJson::array({{{"type", type}, {key, value}}})}, {"isError", false}};
}

McpJson tool_fault(const std::string& said) {
  McpJson result = content("text", "text", said);
  result["isError"] = true;
  return result;
}

std::string text_of(const McpJson& value) {
  return value.dump(-1, ' ', false, McpJson::error_handler_t::replace);
}

/// What is wanted of a report.
McpJson part_of(McpJson report, std::string_view tool, int exit_code) {
  const std::string meaning = exit_code == kExitFindings
                                  ? tr("finished, findings of severity error")
                                  : tr("finished, no findings of severity error");
  McpJson part = {{"exit_code", exit_code}, {"meaning", meaning}};
  McpJson& findings = report["findings"];
  while (findings.size() > kMostListed) findings.erase(findings.size() - 1);
  if (tool == "run") report.erase("findings");
  if (tool == "run") return part.update(report), part;
  for (const char* const key : {"compare", "findings_total", "findings"}) {
    if (report.contains(key)) part[key] = std::move(report[key]);
  }
  return part;
}

/// Of a listing, line by line: it may be long.
McpJson motions_of(const std::string& path, const McpRequest& request) {
  constexpr std::string_view kBegin = "{\"line\":";
  std::ifstream file(path, std::ios::binary);
  McpJson list = McpJson::array();
  std::size_t total = 0;
  for (std::string text; std::getline(file, text);) {
    const auto line =
        text.starts_with(kBegin) ? std::strtoull(&text[kBegin.size()], nullptr, 10) : 0;
    if (line < request.first_line || line > request.last_line) continue;
    if (++total > kMostListed) continue;
    McpJson motion = McpJson::parse(text, nullptr, false);
    if (!motion.is_discarded()) list.push_back(std::move(motion));
  }
  return {{"motions_total", total}, {"motions", std::move(list)}};
}

/// Of a call that has ended: what it has made, or kerf's message.
McpJson result_of(const McpCall& call, const ProcessEnd& end) {
  const std::string path = call.folder.path() + kWritten;
  const McpTool& tool = *call.request.tool;
  std::ifstream file(call.folder.path() + kSaid, std::ios::binary);
  const std::string said = read_up_to(file, kMostSaid_bytes);
  if (end.out_of_time) {
    return tool_fault(said + trf("ended after {:.0f} s (kerf mcp --each-seconds)", end.wall_s));
  }
  if (end.exit_code < 0) return tool_fault(said + trf("ended by signal {}", end.signal));
  if (end.exit_code == kExitUsage || end.exit_code == kExitFailure) return tool_fault(said);
  if (tool.command == kCanon) {
    return content("text", "text", text_of(motions_of(path, call.request)));
  }
  const Result<std::string> made = read_small_file(path, kMostMade_bytes);
  if (!made) return tool_fault(made.error());
  if (tool.command == kView) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(made->data());
    McpJson result = content("image", "data", base64({bytes, made->size()}));
    result["content"][0]["mimeType"] = "image/png";
    return result;
  }
  McpJson report = McpJson::parse(*made, nullptr, false);
  if (!report.is_object()) return tool_fault(tr("the report is no JSON"));
  return content("text", "text", text_of(part_of(std::move(report), tool.name, end.exit_code)));
}

int milliseconds_to(Clock::time_point time) {
  if (time == Clock::time_point::max()) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(time - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, INT_MAX));
}

class Server {
 public:
  explicit Server(const McpOptions& options) : options_(options) {}

  void serve(int in_fd, int out_fd, int stop_fd) {
    for (bool is_open = true; is_open || call_ || !out_.empty(); go_on()) {
      const bool hears = is_open && out_.size() < kMostUnread_bytes;
      std::array<pollfd, 4> fds{{{stop_fd, POLLIN, 0},
                                 {hears ? in_fd : -1, POLLIN, 0},
                                 {out_.empty() ? -1 : out_fd, POLLOUT, 0},
                                 {call_ ? call_->process.ended_fd() : -1, POLLIN, 0}}};
      const int timeout_ms = call_     ? milliseconds_to(call_->process.next_look())
                             : is_open ? -1
                                       : kPatience_ms;
      const int ready = poll(fds.data(), fds.size(), timeout_ms);
      if (ready == 0 && !is_open && !call_) return;
      if (ready <= 0) continue;
      const bool ends = fds[0].revents != 0 || (fds[2].revents != 0 && !write_some(out_fd));
      if (!ends && (fds[1].revents == 0 || read_some(in_fd))) continue;
      is_open = false;
      waiting_.resize(call_ ? 1 : 0);
      if (call_) cancel(Json(waiting_.front().id));
      if (!ends) continue;
      out_.clear();
      sent_ = 0;
      stop_fd = -1;
    }
  }

  void take_line(std::string_view line) {
    if (line.find_first_not_of(" \t\r") == line.npos) return;
    bool is_deep = false;
    const auto look = [&](int depth, Json::parse_event_t, const Json&) {
      is_deep = is_deep || depth > kMostLevels;
      return !is_deep;
    };
    const bool is_long = line.size() > kMostLine_bytes;
    const Json message = Json::parse(is_long ? "" : line, look, false);
    if (is_long || is_deep || message.is_discarded()) {
      return refuse({}, kNoJson,
                    trf("must be a line of JSON, with at most {} bytes and {} levels",
                        kMostLine_bytes, kMostLevels));
    }
    if (!message.is_array() || message.empty()) return take(message);
    for (const Json& one : message) take(one);  // a batch: each is answered by itself
  }

  const std::string& answers() const { return out_; }

 private:
  struct Waiting {
    Json id;
    McpRequest request;
  };

  /// To what poll() calls writable: so much never blocks. False: nobody takes it.
  bool write_some(int fd) {
    const std::string_view left = std::string_view(out_).substr(sent_);
    const ssize_t written = write(fd, left.data(), std::min<std::size_t>(left.size(), PIPE_BUF));
    if (written > 0) sent_ += static_cast<std::size_t>(written);
    if (sent_ == out_.size()) out_ = std::string(), sent_ = 0;
    return written > 0 || errno == EINTR || errno == EAGAIN;
  }

  bool read_some(int fd) {
    std::array<char, 65536> bytes;
    const ssize_t got = read(fd, bytes.data(), bytes.size());
    if (got <= 0) return got < 0 && (errno == EINTR || errno == EAGAIN);
    in_.append(bytes.data(), static_cast<std::size_t>(got));
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = in_.find('\n', begin)) != in_.npos; begin = end + 1) {
      const std::string_view line = std::string_view(in_).substr(begin, end - begin);
      if (!std::exchange(skips_line_, false)) take_line(line);
    }
    in_.erase(0, begin);
    if (!skips_line_ && in_.size() <= kMostLine_bytes) return true;
    if (!std::exchange(skips_line_, true)) take_line(in_);
    in_.clear();
    return true;
  }

  void take(const Json& message) {
    const auto part = [&](const char* name, const Json& none) {
      return message.is_object() ? message.value(name, none) : none;
    };
    const Json id = part("id", nullptr), method = part("method", nullptr);
    const Json params = part("params", Json::object());
    const bool has_id = id.is_number_integer() || id.is_string();
    if (part("jsonrpc", nullptr) != "2.0" || !method.is_string() ||
        (!has_id && message.contains("id"))) {
      return refuse(
          has_id ? id : Json(), kNoRequest,
          tr("a message has jsonrpc \"2.0\", a method, and an id: a whole number or a text"));
    }
    if (has_id && !params.is_object()) return refuse(id, kBadParams, tr("params: no object"));
    if (has_id) return ask(id, method.get<std::string>(), params);
    if (method != "notifications/cancelled" || !params.is_object()) return;
    cancel(params.value("requestId", Json()));
  }

  void ask(const Json& id, const std::string& method, const Json& params) {
    if (method == "initialize") return initialize(id, params);
    if (method == "ping") return say(id, "result", McpJson::object());
    if (method != "tools/list" && method != "tools/call") {
      return refuse(id, kNoMethod, trf("there is no method '{}'", method));
    }
    if (!is_initialized_) return refuse(id, kNoRequest, tr("initialize comes first"));
    if (method == "tools/list") return say(id, "result", mcp_tool_list());
    const Json name = params.value("name", Json());
    const Json arguments = params.value("arguments", Json::object());
    const auto tools = mcp_tools();
    const auto tool = std::find_if(tools.begin(), tools.end(),
                                   [&](const McpTool& one) { return name == one.name; });
    if (tool == tools.end()) return refuse(id, kBadParams, tr("name: there is no such tool"));
    if (!arguments.is_object()) return refuse(id, kBadParams, tr("arguments: no object"));
    if (waiting_.size() >= kMostWaiting) return refuse(id, kBusy, tr("too many calls wait"));
    Result<McpRequest> request = understand_mcp_call(*tool, arguments, options_.folder);
    if (!request) return say(id, "result", tool_fault(request.error()));
    waiting_.push_back({id, std::move(*request)});
  }

  void initialize(const Json& id, const Json& params) {
    const Json wanted = params.value("protocolVersion", Json());
    if (!wanted.is_string()) return refuse(id, kBadParams, tr("protocolVersion: no text"));
    is_initialized_ = true;
    const auto* const known = std::find(kVersions.begin(), kVersions.end(), wanted);
    const char* const version = known == kVersions.end() ? kVersions.back() : *known;
    say(id, "result",
        {{"protocolVersion", version},
         {"capabilities", {{"tools", McpJson::object()}}},
         {"serverInfo", {{"name", "kerf"}, {"version", options_.version}}},
         {"instructions",
          trf("kerf dry-runs NC programs for LinuxCNC, and only reads. Paths are relative to {}; "
              "files outside of it are refused. Lengths are mm.",
              options_.folder.string())}});
  }

  /// It gets no answer.
  void cancel(const Json& id) {
    const auto one = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const Waiting& waiting) { return waiting.id == id; });
    if (one == waiting_.end()) return;
    if (!call_ || one != waiting_.begin()) return static_cast<void>(waiting_.erase(one));
    is_cancelled_ = true;
    call_->process.stop();
  }

  void say(const Json& id, const char* what, McpJson value) {
    const McpJson message = {{"jsonrpc", "2.0"}, {"id", id}, {what, std::move(value)}};
    out_ += text_of(message) + '\n';
  }
  void refuse(const Json& id, int code, const std::string& message) {
    say(id, "error", {{"code", code}, {"message", message}});
  }

  /// Answers the call that has ended, and begins the next one.
  void go_on() {
    if (call_) {
      const std::optional<ProcessEnd> end = call_->process.look(Clock::now());
      if (!end) return;
      if (!std::exchange(is_cancelled_, false)) {
        say(waiting_.front().id, "result", result_of(*call_, *end));
      }
      call_.reset();
      waiting_.pop_front();
    }
    while (!call_ && !waiting_.empty()) {
      Result<McpCall> begun = start(std::move(waiting_.front().request), options_.bounds);
      if (begun) return static_cast<void>(call_.emplace(std::move(*begun)));
      say(waiting_.front().id, "result", tool_fault(begun.error()));
      waiting_.pop_front();
    }
  }

  const McpOptions& options_;
  std::string in_, out_;
  std::size_t sent_ = 0;     ///< of out_
  bool skips_line_ = false;  ///< it was too long: up to its end
  bool is_initialized_ = false;
  std::deque<Waiting> waiting_;  ///< the first one runs, if there is a call
  std::optional<McpCall> call_;
  bool is_cancelled_ = false;  ///< the one that runs
};

}  // namespace

void serve_mcp(const McpOptions& options, int in_fd, int out_fd, int stop_fd) {
  Server(options).serve(in_fd, out_fd, stop_fd);
}

std::string mcp_answer_to(const McpOptions& options, std::string_view line) {
  Server server(options);
  server.take_line(line);
  return server.answers();
}

}  // namespace kerf
