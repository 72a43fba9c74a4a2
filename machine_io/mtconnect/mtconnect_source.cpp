#include "machine_io/mtconnect/mtconnect_source.h"

#include <time.h>

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "machine_io/mtconnect/agent_time.h"
#include "machine_io/mtconnect/device_state.h"
#include "machine_io/mtconnect/http_get.h"
#include "machine_io/mtconnect/multipart.h"
#include "machine_io/mtconnect/stream_answer.h"
#include "machine_io/source_clock.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kAnswer{2000};
/// Observations in one answer. More are asked for at once.
constexpr std::uint64_t kMostObservations = 1000;
constexpr int kSilentHeartbeats = 5;
/// The time from news to news is the least of so many.
constexpr std::size_t kPeriods = 16;

std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// Without the name and the password that a URL may have.
std::string public_url(const std::string& url) {
  const std::size_t host = url.find("//") + 2;
  const std::size_t at = url.find('@', host);
  const std::size_t end = std::min(url.find('/', host), url.size());
  return at < end ? url.substr(0, host) + url.substr(at + 1) : url;
}

std::string base_of(std::string url) {
  while (url.ends_with('/')) url.pop_back();
  return url;
}

Result<DevicesAnswer> ask_probe(HttpGet& get, const std::string& base) {
  const Result<std::string> text = get.ask(base + "/probe", kAnswer);
  if (!text) return Error{trf("/probe: {}", text.error())};
  Result<DevicesAnswer> probe = parse_probe(*text);
  if (!probe) return Error{trf("/probe: {}", probe.error())};
  return probe;
}

}  // namespace

Result<AgentMachine> ask_machine(const MtconnectSettings& settings) {
  HttpGet get;
  const Result<DevicesAnswer> probe = ask_probe(get, base_of(settings.url));
  if (!probe) return Error{probe.error()};
  const Result<const DeviceModel*> device = choose_device(*probe, settings.device);
  if (!device) return Error{device.error()};
  Result<ItemPlan> plan = plan_items(**device, settings);
  if (!plan) return Error{plan.error()};
  return AgentMachine{**device, std::move(*plan)};
}

struct MtconnectSource::Reader {
  explicit Reader(MtconnectSettings given)
      : settings(std::move(given)), base(base_of(settings.url)) {}

  Next next(AxisSample& sample, milliseconds patience);

 private:
  friend class MtconnectSource;
  enum class Phase : std::uint8_t {
    kUnlinked,  ///< what the machine has is not known
    kUnread,    ///< how it stands is not known
    kAsking,    ///< for what changes, as soon as it is time
    kReading,   ///< the answer comes
    kRefused,   ///< the settings do not fit the agent
  };

  void link();
  void read_current();
  void ask_sample(SteadyClock::time_point deadline);
  void read_answer(SteadyClock::time_point deadline);
  void read_parts();
  void take_answer(const std::string& text, std::optional<std::int64_t> asked_ns);
  bool is_of_this_run(const AgentHeader& header);
  std::uint64_t leave_torn(StreamAnswer& read) const;
  void take_observations(const StreamAnswer& answer, std::int64_t received_ns);
  void confirm(const AgentHeader& header, std::int64_t received_ns);
  void push(AxisSample sample, std::int64_t age_ns, std::int64_t received_ns);
  void note_period(std::int64_t stamp_ns);
  void note_state();
  void failed(std::string trouble);
  milliseconds patience_with_stream() const {
    return std::max(kAnswer, milliseconds(kSilentHeartbeats * settings.heartbeat_ms));
  }

  const MtconnectSettings settings;
  const std::string base;
  HttpGet get;
  SourceStatus status_;
  Phase phase = Phase::kUnlinked;
  BackOff back_off;
  SteadyClock::time_point next_attempt{};
  bool has_connected = false;
  bool is_broken = false;  ///< since the last answer

  std::optional<DeviceModel> device;
  std::optional<DeviceState> state;
  std::uint64_t instance = 0;
  std::uint64_t next_sequence = 0;  ///< 0: not known
  std::uint64_t count = kMostObservations;
  std::uint64_t damaged_before = 0;

  std::optional<MultipartReader> parts;
  std::string answer;  ///< that is not of parts, as far as it has come
  SteadyClock::time_point silent_since{};
  SteadyClock::time_point due{};  ///< of the next question, where the agent does not stream

  StampClock clock;
  HostStamp host_stamp;
  bool clock_told = false;
  std::deque<AxisSample> ready;
  std::int64_t last_host_ns = 0;              ///< of the last sample
  std::optional<std::int64_t> last_stamp_ns;  ///< of news; nothing: none since the last silence
  std::int64_t newest_stamp_ns = 0;           ///< of all that has been told
  std::deque<std::int64_t> periods_ns;
};

void MtconnectSource::Reader::failed(std::string trouble) {
  ++status_.errors;
  status_.trouble = std::move(trouble);
  status_.state = SourceState::kConnecting;
  is_broken = true;
  parts.reset();
  if (phase != Phase::kUnlinked) phase = Phase::kUnread;
  next_attempt = SteadyClock::now() + back_off.next();
}

/// Asks what the machine has.
void MtconnectSource::Reader::link() {
  const Result<DevicesAnswer> probe = ask_probe(get, base);
  if (!probe) return failed(probe.error());
  const auto refuse = [&](const std::string& why) {
    ++status_.errors;
    status_.trouble = why;
    status_.state = SourceState::kFailed;
    phase = Phase::kRefused;
  };
  const Result<const DeviceModel*> chosen = choose_device(*probe, settings.device);
  if (!chosen) return refuse(chosen.error());
  Result<ItemPlan> plan = plan_items(**chosen, settings);
  if (!plan) return refuse(plan.error());
  device = **chosen;
  state.emplace(std::move(*plan), settings.load_unit,
                static_cast<std::int64_t>(settings.gather_ms * 1e6));
  damaged_before = 0;
  instance = probe->header.instance;
  if (probe->header.buffer > 0) count = std::min(kMostObservations, probe->header.buffer);
  phase = Phase::kUnread;
}

/// False: the agent has begun anew, and is asked everything again.
bool MtconnectSource::Reader::is_of_this_run(const AgentHeader& header) {
  if (header.instance == instance && header.next >= next_sequence) return true;
  status_.trouble =
      header.instance != instance
          ? trf("the agent has begun anew (instanceId {}, {} before)", header.instance, instance)
          : trf("the agent has begun anew (it is at observation {}, and was at {})", header.next,
                next_sequence);
  ++status_.errors;
  // Nobody knows how many.
  ++status_.lost;
  next_sequence = 0;
  parts.reset();
  phase = Phase::kUnlinked;
  return false;
}

/// Asks how the machine stands.
void MtconnectSource::Reader::read_current() {
  const Result<std::string> text = get.ask(base + "/current", kAnswer);
  if (!text) return failed(trf("/current: {}", text.error()));
  const Result<StreamAnswer> read = parse_streams(*text, *device);
  if (!read) return failed(trf("/current: {}", read.error()));
  if (!read->error.empty()) return failed(trf("/current: {}", read->error));
  if (!is_of_this_run(read->header)) return;
  if (next_sequence > 0) status_.lost += read->header.next - next_sequence;
  next_sequence = read->header.next;
  if (std::exchange(is_broken, false) && has_connected) ++status_.reconnects;
  has_connected = true;
  back_off.reset();
  clock.heard(get.asked_ns(), get.received_ns(), read->header.created);
  last_stamp_ns.reset();
  status_.errors += read->damaged;
  // What it has been told of long ago still holds.
  std::vector<DeviceState::Stamped> made = state->take(read->observations);
  for (const DeviceState::Stamped& one : state->take({})) made.push_back(one);
  note_state();
  if (state->missing().empty() && !made.empty()) {
    newest_stamp_ns = made.front().stamp_ns;
    for (const DeviceState::Stamped& one : made) {
      newest_stamp_ns = std::max(newest_stamp_ns, one.stamp_ns);
    }
    confirm(read->header, get.received_ns());
  }
  phase = Phase::kAsking;
  due = SteadyClock::now();
}

void MtconnectSource::Reader::ask_sample(SteadyClock::time_point deadline) {
  if (due > deadline) return sleep_until(deadline);
  sleep_until(due);
  due = SteadyClock::now() + milliseconds(settings.interval_ms);
  const std::string url =
      fmt::format("{}/sample?from={}&count={}&interval={}&heartbeat={}", base, next_sequence, count,
                  settings.interval_ms, settings.heartbeat_ms);
  if (Done begun = get.begin(url); !begun) return failed(begun.error());
  parts.reset();
  answer.clear();
  silent_since = SteadyClock::now();
  phase = Phase::kReading;
}

void MtconnectSource::Reader::read_answer(SteadyClock::time_point deadline) {
  const HttpGet::State got = get.wait(deadline);
  if (got == HttpGet::State::kFailed) return failed(trf("/sample: {}", get.trouble()));
  if (got == HttpGet::State::kWaiting) {
    if (SteadyClock::now() - silent_since < patience_with_stream()) return;
    return failed(trf("the agent is silent for {} ms", patience_with_stream().count()));
  }
  if (!parts) {
    if (std::optional<std::string> boundary = MultipartReader::boundary_of(get.content_type())) {
      parts.emplace(std::move(*boundary));
    }
  }
  if (parts) {
    parts->add(get.take_bytes());
    read_parts();
    if (got == HttpGet::State::kDone && phase == Phase::kReading) {
      failed(tr("the agent has ended the stream"));
    }
    return;
  }
  answer += get.take_bytes();
  if (answer.size() > kMostXml_bytes) {
    return failed(trf("/sample: an answer of more than {} bytes", kMostXml_bytes));
  }
  if (got != HttpGet::State::kDone) {
    if (SteadyClock::now() - silent_since < kAnswer) return;
    return failed(trf("/sample: no whole answer within {} ms", kAnswer.count()));
  }
  if (get.status() >= 400 && !contains(answer, "MTConnectError")) {
    return failed(trf("/sample: HTTP {}", get.status()));
  }
  phase = Phase::kAsking;
  take_answer(answer, get.asked_ns());
}

void MtconnectSource::Reader::read_parts() {
  while (parts) {
    const std::optional<std::string> part = parts->next();
    if (!part) break;
    silent_since = SteadyClock::now();
    take_answer(*part, std::nullopt);
  }
  if (!parts) return;
  if (!parts->fault().empty()) return failed(parts->fault());
  // Bytes that make no part are no sign of life.
  if (SteadyClock::now() - silent_since > patience_with_stream()) {
    return failed(trf("the agent is silent for {} ms", patience_with_stream().count()));
  }
  if (parts->is_ended()) failed(tr("the agent has ended the stream"));
}

/// One whole answer to /sample.
void MtconnectSource::Reader::take_answer(const std::string& text,
                                          std::optional<std::int64_t> asked_ns) {
  Result<StreamAnswer> read = parse_streams(text, *device);
  if (!read) return failed(trf("/sample: {}", read.error()));
  if (!read->error.empty()) {
    failed(trf("/sample: {}", read->error));
    // The agent no longer has what comes next: how the machine stands is asked for at once.
    if (read->error.starts_with("OUT_OF_RANGE")) next_attempt = SteadyClock::now();
    return;
  }
  if (!is_of_this_run(read->header)) return;
  if (read->header.first > next_sequence) {
    const std::uint64_t missing = read->header.first - next_sequence;
    status_.lost += missing;
    ++status_.errors;
    status_.trouble =
        trf("{} observations were overwritten before they were read: the agent keeps {}", missing,
            read->header.buffer);
  }
  back_off.reset();
  clock.heard(asked_ns, get.received_ns(), read->header.created);
  // LinuxCNC's agent tells the end of its buffer, also where it has told a part of it alone.
  const bool is_cut = read->count >= count && read->newest >= next_sequence;
  const std::uint64_t then =
      is_cut ? leave_torn(*read) : std::max(read->header.next, read->newest + 1);
  take_observations(*read, get.received_ns());
  next_sequence = then;
  if (is_cut) due = SteadyClock::now();
}

/// An answer that ends because it is full may end between two axes of one time: these are left for
/// the next one. Returns what that begins with.
std::uint64_t MtconnectSource::Reader::leave_torn(StreamAnswer& read) const {
  std::vector<Observation>& all = read.observations;
  if (all.empty()) return read.newest + 1;
  const std::int64_t last_ns = all.back().stamp_ns;
  const auto is_of_last = [&](const Observation& one) {
    return std::abs(one.stamp_ns - last_ns) <= static_cast<std::int64_t>(settings.gather_ms * 1e6);
  };
  std::size_t kept = all.size();
  while (kept > 0 && is_of_last(all[kept - 1])) --kept;
  if (kept == 0 || all[kept].sequence <= next_sequence) return read.newest + 1;
  const std::uint64_t then = all[kept].sequence;
  all.resize(kept);
  return then;
}

void MtconnectSource::Reader::take_observations(const StreamAnswer& read,
                                                std::int64_t received_ns) {
  status_.errors += read.damaged;
  if (read.damaged > 0) status_.trouble = tr("an observation without a time or a number");
  auto first = std::find_if(read.observations.begin(), read.observations.end(),
                            [&](const Observation& one) { return one.sequence >= next_sequence; });
  status_.duplicates += static_cast<std::uint64_t>(first - read.observations.begin());
  const std::vector<DeviceState::Stamped> made = state->take({first, read.observations.end()});
  for (const DeviceState::Stamped& one : made) clock.observed(one.stamp_ns, received_ns);
  note_state();
  for (const DeviceState::Stamped& one : made) {
    if (!one.is_whole) {
      last_stamp_ns.reset();
      continue;
    }
    note_period(one.stamp_ns);
    push(one.sample, clock.age_ns(one.stamp_ns, received_ns), received_ns);
  }
  const bool is_known = state->missing().empty();
  if (made.empty() && !state->is_waiting() && is_known) confirm(read.header, received_ns);
}

/// From one piece of news to the next, where they come one after the other.
void MtconnectSource::Reader::note_period(std::int64_t stamp_ns) {
  if (last_stamp_ns && stamp_ns > *last_stamp_ns) {
    periods_ns.push_back(stamp_ns - *last_stamp_ns);
    if (periods_ns.size() > kPeriods) periods_ns.pop_front();
  }
  last_stamp_ns = stamp_ns;
  newest_stamp_ns = std::max(newest_stamp_ns, stamp_ns);
}

/// A sign of life: what was told still holds. The machine may have moved since it was last looked
/// at, which is a period ago at most, and not before the newest of what was told.
void MtconnectSource::Reader::confirm(const AgentHeader& header, std::int64_t received_ns) {
  const std::int64_t heartbeat_ns = settings.heartbeat_ms * 1'000'000LL;
  std::int64_t period_ns = heartbeat_ns;
  if (!periods_ns.empty()) {
    period_ns = std::min(*std::min_element(periods_ns.begin(), periods_ns.end()), period_ns);
  }
  const std::int64_t age_ns =
      std::min(clock.answer_age_ns(header.created.ns, received_ns) + period_ns,
               clock.age_ns(newest_stamp_ns, received_ns));
  const std::int64_t real_ns =
      host_stamp.stamp(clock_ns(CLOCK_REALTIME), clock_ns(CLOCK_MONOTONIC));
  const std::int64_t since_ns = clock_ns(CLOCK_MONOTONIC) - received_ns;
  const std::int64_t host_ns = real_ns - since_ns - age_ns;
  if (last_host_ns != 0 && host_ns - last_host_ns < heartbeat_ns / 10 * 9) return;
  push(state->sample(), age_ns, received_ns);
}

void MtconnectSource::Reader::push(AxisSample sample, std::int64_t age_ns,
                                   std::int64_t received_ns) {
  const std::int64_t steady_ns = clock_ns(CLOCK_MONOTONIC);
  const std::int64_t real_ns = host_stamp.stamp(clock_ns(CLOCK_REALTIME), steady_ns);
  if (host_stamp.stepped_back_ns() > 0) {
    ++status_.disordered;
    status_.trouble = trf("this computer's clock was set back by {:.3f} s",
                          static_cast<double>(host_stamp.stepped_back_ns()) * 1e-9);
  }
  // What is known at one moment is known later, too: stamps of two adapters may lie crosswise.
  last_host_ns = std::max(last_host_ns, real_ns - (steady_ns - received_ns) - age_ns);
  sample.host_ns = last_host_ns;
  ready.push_back(sample);
}

/// What is wrong with what is told, or with its stamps.
void MtconnectSource::Reader::note_state() {
  if (state->damaged() > damaged_before) {
    status_.errors += state->damaged() - damaged_before;
    damaged_before = state->damaged();
    status_.trouble = state->trouble();
  }
  const std::string missing = state->missing();
  if (!missing.empty()) {
    status_.state = SourceState::kConnecting;
    status_.trouble = missing;
    last_stamp_ns.reset();
  }
  const std::optional<double> behind_s = clock.behind_s();
  if (!behind_s || std::exchange(clock_told, true)) return;
  ++status_.disordered;
  status_.trouble =
      *behind_s > 0
          ? trf("the stamps are {:.1f} s behind the agent's clock: ages are by when they come",
                *behind_s)
          : trf("the stamps are {:.1f} s ahead of the agent's clock: ages are by when they come",
                -*behind_s);
}

PositionSource::Next MtconnectSource::Reader::next(AxisSample& sample, milliseconds patience) {
  const SteadyClock::time_point deadline = SteadyClock::now() + patience;
  for (;;) {
    if (!ready.empty()) {
      sample = ready.front();
      ready.pop_front();
      sample.age_ns =
          host_stamp.stamp(clock_ns(CLOCK_REALTIME), clock_ns(CLOCK_MONOTONIC)) - sample.host_ns;
      ++status_.samples;
      status_.state = SourceState::kReading;
      return Next::kSample;
    }
    const std::uint64_t errors = status_.errors;
    switch (phase) {
      case Phase::kUnlinked:
      case Phase::kUnread:
        if (next_attempt > deadline) {
          sleep_until(deadline);
          return Next::kNothing;
        }
        sleep_until(next_attempt);
        phase == Phase::kUnlinked ? link() : read_current();
        break;
      case Phase::kAsking:
        ask_sample(deadline);
        break;
      case Phase::kReading:
        read_answer(deadline);
        break;
      case Phase::kRefused:
        return Next::kEnd;
    }
    if (ready.empty() && (status_.errors != errors || SteadyClock::now() >= deadline)) {
      return phase == Phase::kRefused ? Next::kEnd : Next::kNothing;
    }
  }
}

MtconnectSource::MtconnectSource(MtconnectSettings settings)
    : reader_(std::make_unique<Reader>(std::move(settings))) {}
MtconnectSource::~MtconnectSource() = default;

PositionSource::Next MtconnectSource::next(AxisSample& sample, milliseconds patience) {
  return reader_->next(sample, patience);
}

const SourceStatus& MtconnectSource::status() const { return reader_->status_; }

std::string MtconnectSource::describe() const {
  const MtconnectSettings& s = reader_->settings;
  const std::string url = public_url(reader_->base);
  return s.device.empty() ? fmt::format("mtconnect {}", url)
                          : trf("mtconnect {} device {}", url, s.device);
}

}  // namespace kerf
