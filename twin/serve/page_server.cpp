#include "twin/serve/page_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <future>
#include <stop_token>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "twin/serve/shop_page.h"

namespace kerf {
namespace {

using ServeClock = std::chrono::steady_clock;

/// Connections are looked at so often.
constexpr std::chrono::milliseconds kLookRound{250};
constexpr int kBacklog = 64;
constexpr int kNiceness = 10;

/// Nothing from elsewhere, nothing inline, in nobody's frame.
constexpr std::array<std::array<const char*, 2>, 6> kHeaders{{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
     "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cache-Control", "no-store"},
}};

/// A socket that goes on listening when it is handed over.
class ListeningSocket {
 public:
  ListeningSocket() = default;
  ~ListeningSocket() {
    if (fd_ >= 0) ::close(fd_);
  }
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;

  /// False with errno. The port that it gets is put into `address`.
  bool open(ServeAddress& address) {
    sockaddr_storage place{};
    socklen_t length = 0;
    if (address.is_ipv6()) {
      auto* const six = reinterpret_cast<sockaddr_in6*>(&place);
      six->sin6_family = AF_INET6;
      six->sin6_port = htons(address.port);
      inet_pton(AF_INET6, address.host.c_str(), &six->sin6_addr);
      length = sizeof(sockaddr_in6);
    } else {
      auto* const four = reinterpret_cast<sockaddr_in*>(&place);
      four->sin_family = AF_INET;
      four->sin_port = htons(address.port);
      inet_pton(AF_INET, address.host.c_str(), &four->sin_addr);
      length = sizeof(sockaddr_in);
    }
    auto* const bound = reinterpret_cast<sockaddr*>(&place);
    fd_ = ::socket(place.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd_ < 0) return false;
    const int yes = 1;
    ::setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    if (::bind(fd_, bound, length) != 0 || ::listen(fd_, kBacklog) != 0) return false;
    if (::getsockname(fd_, bound, &length) != 0) return false;
    address.port = ntohs(address.is_ipv6() ? reinterpret_cast<sockaddr_in6*>(&place)->sin6_port
                                           : reinterpret_cast<sockaddr_in*>(&place)->sin_port);
    return true;
  }
  int fd() const { return fd_; }
  int hand_over() { return std::exchange(fd_, -1); }

 private:
  int fd_ = -1;
};

std::string name_of_this_computer() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "localhost";
}

std::string_view header_of(MHD_Connection* connection, const char* name) {
  const char* const value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
  return value != nullptr ? value : "";
}

/// What is missing or no number counts as nothing that the page has.
std::uint64_t number_of(MHD_Connection* connection, const char* name) {
  const char* const value = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, name);
  return value != nullptr ? read_seen_number(value).value_or(0) : 0;
}

MHD_Result answer_with(MHD_Connection* connection, unsigned status, const char* type,
                       std::string body, bool is_gzip = false) {
  auto* const kept = new std::string(std::move(body));
  MHD_Response* const response = MHD_create_response_from_buffer_with_free_callback_cls(
      kept->size(), kept->data(), [](void* text) { delete static_cast<std::string*>(text); }, kept);
  if (response == nullptr) {
    delete kept;
    return MHD_NO;
  }
  for (const auto& [name, value] : kHeaders) MHD_add_response_header(response, name, value);
  MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, type);
  if (is_gzip) MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_ENCODING, "gzip");
  if (status == MHD_HTTP_METHOD_NOT_ALLOWED) {
    MHD_add_response_header(response, MHD_HTTP_HEADER_ALLOW, "GET, HEAD");
  }
  if (status == MHD_HTTP_UNAUTHORIZED) {
    MHD_add_response_header(response, MHD_HTTP_HEADER_WWW_AUTHENTICATE, "Bearer");
  }
  const MHD_Result result = MHD_queue_response(connection, status, response);
  MHD_destroy_response(response);
  return result;
}

MHD_Result refuse(MHD_Connection* connection, unsigned status) {
  return answer_with(connection, status, "text/plain; charset=utf-8",
                     fmt::format("{} {}\n", status, MHD_get_reason_phrase_for(status)));
}

bool has_body(MHD_Connection* connection) {
  const std::string_view length = header_of(connection, MHD_HTTP_HEADER_CONTENT_LENGTH);
  return (!length.empty() && length != "0") ||
         !header_of(connection, MHD_HTTP_HEADER_TRANSFER_ENCODING).empty();
}

}  // namespace

struct PageServer::Impl {
  Impl(PageServerOptions with, ServedScene& shown) : options(std::move(with)), scene(shown) {}

  struct Waiting {
    MHD_Connection* connection = nullptr;
    ServeClock::time_point since;
  };
  struct Peer {
    int fd = -1;
    ServeClock::time_point deadline;
  };
  /// Of one request.
  struct Request {
    bool has_waited = false;
  };

  MHD_Result handle(MHD_Connection* connection, std::string_view path, std::string_view method,
                    Request** request) {
    if (*request == nullptr) {
      extend(connection);
      if (method != MHD_HTTP_METHOD_GET && method != MHD_HTTP_METHOD_HEAD) {
        return refuse(connection, MHD_HTTP_METHOD_NOT_ALLOWED);
      }
      if (has_body(connection)) return refuse(connection, MHD_HTTP_CONTENT_TOO_LARGE);
      *request = new Request;
      return MHD_YES;
    }
    const bool is_open = options.token.empty();
    if (is_open && !is_own_host(header_of(connection, MHD_HTTP_HEADER_HOST))) {
      return refuse(connection, MHD_HTTP_FORBIDDEN);
    }
    if (const ShopFile* const file = page.find(path)) {
      return answer_with(connection, MHD_HTTP_OK, file->type, file->body);
    }
    if (path != "/scene") return refuse(connection, MHD_HTTP_NOT_FOUND);
    const std::string_view said = header_of(connection, MHD_HTTP_HEADER_AUTHORIZATION);
    if (!is_open && !is_authorized(said, options.token)) {
      return refuse(connection, MHD_HTTP_UNAUTHORIZED);
    }
    SeenByPage seen;
    seen.epoch = number_of(connection, "epoch");
    seen.version = number_of(connection, "version");
    seen.mesh = number_of(connection, "mesh");
    seen.findings = number_of(connection, "findings");
    if (!(*request)->has_waited && wait(connection, seen)) {
      (*request)->has_waited = true;
      return MHD_YES;
    }
    const bool as_gzip = takes_gzip(header_of(connection, MHD_HTTP_HEADER_ACCEPT_ENCODING));
    return answer_with(connection, MHD_HTTP_OK, "application/octet-stream",
                       scene.answer(seen, as_gzip), as_gzip);
  }

  /// Until something is new; false: something is.
  bool wait(MHD_Connection* connection, const SeenByPage& seen) {
    const std::lock_guard lock(waiting_mutex);
    if (is_stopping || scene.has_news(seen)) return false;
    waiting.push_back({connection, ServeClock::now()});
    MHD_suspend_connection(connection);
    return true;
  }

  void wake_older_than(ServeClock::time_point since) {
    const std::lock_guard lock(waiting_mutex);
    std::erase_if(waiting, [&](const Waiting& one) {
      if (one.since > since) return false;
      MHD_resume_connection(one.connection);
      return true;
    });
  }
  void wake_all() { wake_older_than(ServeClock::time_point::max()); }

  void extend(MHD_Connection* connection) {
    const std::lock_guard lock(peers_mutex);
    if (const auto found = peers.find(connection); found != peers.end()) {
      found->second.deadline = ServeClock::now() + kPatience;
    }
  }

  /// Who has been too slow is cut off; the library then finds the connection ended, and closes it
  /// once notify() has forgotten it.
  void drop_slow() {
    const std::lock_guard lock(peers_mutex);
    const ServeClock::time_point now = ServeClock::now();
    for (auto& [connection, peer] : peers) {
      if (now < peer.deadline) continue;
      ::shutdown(peer.fd, SHUT_RDWR);
      peer.deadline = ServeClock::time_point::max();
    }
  }

  static void notify(void* self, MHD_Connection* connection, void**,
                     MHD_ConnectionNotificationCode code) {
    auto* const impl = static_cast<Impl*>(self);
    const std::lock_guard lock(impl->peers_mutex);
    if (code == MHD_CONNECTION_NOTIFY_CLOSED) {
      impl->peers.erase(connection);
      return;
    }
    const MHD_ConnectionInfo* const info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    if (info == nullptr) return;
    impl->peers[connection] = {info->connect_fd, ServeClock::now() + kPatience};
  }

  static void completed(void* self, MHD_Connection* connection, void** request,
                        MHD_RequestTerminationCode) {
    delete static_cast<Request*>(*request);
    *request = nullptr;
    static_cast<Impl*>(self)->extend(connection);
  }

  static MHD_Result access(void* self, MHD_Connection* connection, const char* url,
                           const char* method, const char*, const char*, std::size_t* upload_size,
                           void** request) {
    if (*upload_size != 0) return MHD_NO;
    return static_cast<Impl*>(self)->handle(connection, url, method,
                                            reinterpret_cast<Request**>(request));
  }

  /// Threads that it starts have this one's priority.
  bool start_daemon() {
    if (::nice(kNiceness) == -1) errno = 0;  // as low as it can be
    const unsigned flags = MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME;
    daemon =
        MHD_start_daemon(flags, 0, nullptr, nullptr, &Impl::access, this,  //
                         MHD_OPTION_LISTEN_SOCKET, listener.fd(),          //
                         MHD_OPTION_CONNECTION_LIMIT, kMostConnections,    //
                         MHD_OPTION_PER_IP_CONNECTION_LIMIT, kMostOfOneAddress,
                         MHD_OPTION_CONNECTION_MEMORY_LIMIT, kMostHead,  //
                         MHD_OPTION_CONNECTION_TIMEOUT, static_cast<unsigned>(kPatience.count()),
                         MHD_OPTION_NOTIFY_CONNECTION, &Impl::notify, this,    //
                         MHD_OPTION_NOTIFY_COMPLETED, &Impl::completed, this,  //
                         MHD_OPTION_END);
    if (daemon != nullptr) listener.hand_over();
    return daemon != nullptr;
  }

  void look_round(const std::stop_token& stop) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any round;
    while (!stop.stop_requested()) {
      round.wait_for(lock, stop, kLookRound, [] { return false; });
      wake_older_than(ServeClock::now() - kMostWait);
      drop_slow();
    }
  }

  void stop() {
    scene.set_listener({});
    watch = {};
    {
      const std::lock_guard lock(waiting_mutex);
      is_stopping = true;
    }
    wake_all();
    if (daemon != nullptr) MHD_stop_daemon(daemon);
    daemon = nullptr;
  }

  PageServerOptions options;
  ServedScene& scene;
  ShopPage page;
  ListeningSocket listener;
  MHD_Daemon* daemon = nullptr;
  std::mutex waiting_mutex;
  std::vector<Waiting> waiting;
  bool is_stopping = false;
  std::mutex peers_mutex;
  std::unordered_map<MHD_Connection*, Peer> peers;
  std::jthread watch;
};

PageServer::PageServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

PageServer::~PageServer() { impl_->stop(); }

Result<std::unique_ptr<PageServer>> PageServer::start(const PageServerOptions& options,
                                                      ServedScene& scene) {
  auto impl = std::make_unique<Impl>(options, scene);
  Impl* const started = impl.get();
  const std::string wanted = to_string(options.address);
  if (!started->listener.open(started->options.address)) {
    return Error{fmt::format("{}: {}", wanted, std::strerror(errno))};
  }
  std::promise<bool> is_up;
  std::future<bool> answer = is_up.get_future();
  started->watch = std::jthread([started, &is_up](const std::stop_token& stop) {
    const bool is_started = started->start_daemon();
    is_up.set_value(is_started);
    if (is_started) started->look_round(stop);
  });
  if (!answer.get()) return Error{trf("{}: no server could be started", wanted)};
  scene.set_listener([started] { started->wake_all(); });
  return std::unique_ptr<PageServer>(new PageServer(std::move(impl)));
}

const ServeAddress& PageServer::address() const { return impl_->options.address; }

std::string PageServer::link() const {
  const ServeAddress& at = address();
  const std::string where =
      at.is_any() ? fmt::format("{}:{}", name_of_this_computer(), at.port) : to_string(at);
  const std::string& token = impl_->options.token;
  return fmt::format("http://{}/{}", where, token.empty() ? "" : "#" + token);
}

}  // namespace kerf
