#include "machine_io/mtconnect/http_get.h"

#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "machine_io/mtconnect/curl_library.h"
#include "machine_io/mtconnect/xml_tree.h"

namespace kerf {
namespace {

constexpr long kConnect_ms = 2000;

std::int64_t steady_ns() {
  return std::chrono::nanoseconds(SteadyClock::now().time_since_epoch()).count();
}

}  // namespace

struct HttpGet::Transfer {
  ~Transfer() {
    if (curl == nullptr) return;
    if (is_running) curl->multi_remove_handle(multi, easy);
    if (easy != nullptr) curl->easy_cleanup(easy);
    if (multi != nullptr) curl->multi_cleanup(multi);
  }

  static std::size_t receive(char* bytes, std::size_t size, std::size_t count, void* self) {
    auto& to = *static_cast<Transfer*>(self);
    if (to.body.size() + size * count > kMostXml_bytes) {
      to.is_too_long = true;
      return 0;
    }
    to.body.append(bytes, size * count);
    to.received_ns = steady_ns();
    return size * count;
  }

  Done open() {
    if (curl != nullptr) return std::monostate{};
    const Result<const CurlFunctions*> opened = open_curl();
    if (!opened) return Error{opened.error()};
    curl = *opened;
    easy = curl->easy_init();
    multi = curl->multi_init();
    if (easy != nullptr && multi != nullptr) return std::monostate{};
    return Error{tr("libcurl cannot begin: no memory")};
  }

  void stop() {
    if (std::exchange(is_running, false)) curl->multi_remove_handle(multi, easy);
  }

  State fail(std::string why) {
    stop();
    trouble = std::move(why);
    return State::kFailed;
  }

  /// The transfer has ended, one way or the other.
  State end(CURLcode code) {
    stop();
    if (code == CURLE_OK) return State::kDone;
    if (is_too_long) return fail(trf("an answer of more than {} bytes", kMostXml_bytes));
    return fail(error[0] != 0 ? error : curl->easy_strerror(code));
  }

  const CurlFunctions* curl = nullptr;
  CURL* easy = nullptr;
  CURLM* multi = nullptr;
  bool is_running = false;
  bool is_too_long = false;
  std::string body;
  std::int64_t asked_ns = 0, received_ns = 0;
  char error[CURL_ERROR_SIZE] = {};
  std::string trouble;
};

HttpGet::HttpGet() : transfer_(std::make_unique<Transfer>()) {}
HttpGet::~HttpGet() = default;

Done HttpGet::begin(const std::string& url) {
  Transfer& t = *transfer_;
  if (Done opened = t.open(); !opened) return opened;
  t.stop();
  t.body.clear();
  t.is_too_long = false;
  t.error[0] = 0;
  const auto set = t.curl->easy_setopt;
  t.curl->easy_reset(t.easy);
  bool good = set(t.easy, CURLOPT_URL, url.c_str()) == CURLE_OK;
  good &= set(t.easy, CURLOPT_HTTPGET, 1L) == CURLE_OK;
  // Else a URL of the configuration could read files, or send mail.
  good &= set(t.easy, CURLOPT_PROTOCOLS, static_cast<long>(CURLPROTO_HTTP | CURLPROTO_HTTPS)) ==
          CURLE_OK;
  set(t.easy, CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_1_1));
  set(t.easy, CURLOPT_PROXY, "");
  set(t.easy, CURLOPT_NOSIGNAL, 1L);
  set(t.easy, CURLOPT_CONNECTTIMEOUT_MS, kConnect_ms);
  set(t.easy, CURLOPT_USERAGENT, "kerf");
  set(t.easy, CURLOPT_ERRORBUFFER, t.error);
  set(t.easy, CURLOPT_WRITEFUNCTION, &Transfer::receive);
  set(t.easy, CURLOPT_WRITEDATA, &t);
  good = good && t.curl->multi_add_handle(t.multi, t.easy) == CURLM_OK;
  if (!good) return Error{trf("libcurl does not take '{}'", shown(url))};
  t.is_running = true;
  t.asked_ns = t.received_ns = steady_ns();
  return std::monostate{};
}

HttpGet::State HttpGet::wait(SteadyClock::time_point deadline) {
  Transfer& t = *transfer_;
  if (!t.is_running) return State::kFailed;
  for (;;) {
    int running = 0;
    if (t.curl->multi_perform(t.multi, &running) != CURLM_OK) {
      return t.fail(tr("libcurl cannot go on"));
    }
    int left = 0;
    while (const CURLMsg* const message = t.curl->multi_info_read(t.multi, &left)) {
      if (message->msg == CURLMSG_DONE) return t.end(message->data.result);
    }
    if (!t.body.empty()) return State::kBytes;
    const auto now = SteadyClock::now();
    if (now >= deadline) return State::kWaiting;
    const auto left_ms = std::chrono::ceil<std::chrono::milliseconds>(deadline - now).count();
    t.curl->multi_poll(t.multi, nullptr, 0, static_cast<int>(std::min<std::int64_t>(left_ms, 1000)),
                       nullptr);
  }
}

std::string HttpGet::take_bytes() { return std::exchange(transfer_->body, {}); }

long HttpGet::status() const {
  long code = 0;
  const Transfer& t = *transfer_;
  if (t.curl != nullptr) t.curl->easy_getinfo(t.easy, CURLINFO_RESPONSE_CODE, &code);
  return code;
}

std::string HttpGet::content_type() const {
  const char* type = nullptr;
  const Transfer& t = *transfer_;
  if (t.curl != nullptr) t.curl->easy_getinfo(t.easy, CURLINFO_CONTENT_TYPE, &type);
  return type != nullptr ? type : "";
}

std::int64_t HttpGet::asked_ns() const { return transfer_->asked_ns; }
std::int64_t HttpGet::received_ns() const { return transfer_->received_ns; }
const std::string& HttpGet::trouble() const { return transfer_->trouble; }

Result<std::string> HttpGet::ask(const std::string& url, std::chrono::milliseconds timeout) {
  if (Done begun = begin(url); !begun) return Error{begun.error()};
  const auto deadline = SteadyClock::now() + timeout;
  std::string answer;
  for (;;) {
    const State state = wait(deadline);
    if (state == State::kFailed) return Error{trouble()};
    answer += take_bytes();
    if (answer.size() > kMostXml_bytes) {
      transfer_->stop();
      return Error{trf("an answer of more than {} bytes", kMostXml_bytes)};
    }
    if (state == State::kDone) break;
    if (state == State::kWaiting) {
      transfer_->stop();
      return Error{trf("no whole answer within {} ms", timeout.count())};
    }
  }
  // An agent tells its errors in XML, with a status that fits.
  if (status() >= 400 && answer.find("MTConnectError") == answer.npos) {
    return Error{trf("HTTP {}", status())};
  }
  return answer;
}

}  // namespace kerf
