#include "twin/serve/served_scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace kerf {
namespace {

/// One that no run before this one has had.
std::uint64_t first_epoch() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

void put_length(std::string& out, std::size_t length) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(length >> shift & 0xffU);
}

}  // namespace

ServedScene::ServedScene() : epoch_(first_epoch()) {}

void ServedScene::begin_anew() {
  begin_part_anew();
  const std::lock_guard lock(mutex_);
  findings_.clear();
  finding_count_ = 0;
}

void ServedScene::begin_part_anew() {
  const std::lock_guard lock(mutex_);
  ++epoch_;
  ++version_;
  tiles_.clear();
  order_.clear();
  is_whole_ = false;
}

void ServedScene::set_state(std::string members) {
  const std::lock_guard lock(mutex_);
  state_ = std::move(members);
  ++version_;
}

void ServedScene::set_setup(std::string members) {
  const std::lock_guard lock(mutex_);
  if (members == setup_) return;
  setup_ = std::move(members);
  setup_version_ = ++version_;
}

void ServedScene::add_finding(std::string json) {
  const std::lock_guard lock(mutex_);
  ++version_;
  ++finding_count_;
  if (findings_.size() < kMostFindings) findings_.push_back(std::move(json));
}

void ServedScene::set_findings(std::vector<std::string> all, std::uint64_t total) {
  if (all.size() > kMostFindings) all.resize(kMostFindings);
  const std::lock_guard lock(mutex_);
  const bool goes_on =
      findings_.size() <= all.size() && std::equal(findings_.begin(), findings_.end(), all.begin());
  if (goes_on && findings_.size() == all.size() && finding_count_ == total) return;
  ++version_;
  if (!goes_on) findings_anew_ = version_;
  findings_ = std::move(all);
  finding_count_ = total;
}

void ServedScene::set_patch(std::uint32_t tile, std::string bytes) {
  GzipPiece piece = gzip_piece(bytes);
  const std::lock_guard lock(mutex_);
  Tile& kept = tiles_[tile];
  if (kept.number != 0) order_.erase(kept.number);
  kept.number = ++mesh_;
  kept.bytes = std::move(bytes);
  kept.piece = std::move(piece);
  order_.emplace(kept.number, tile);
}

void ServedScene::set_whole(bool is_whole) {
  const std::lock_guard lock(mutex_);
  is_whole_ = is_whole;
}

void ServedScene::publish() {
  const std::lock_guard lock(listener_mutex_);
  if (listener_) listener_();
}

void ServedScene::set_listener(std::function<void()> listener) {
  const std::lock_guard lock(listener_mutex_);
  listener_ = std::move(listener);
}

bool ServedScene::has_news(const SeenByPage& seen) const {
  const std::lock_guard lock(mutex_);
  if (seen.epoch != epoch_) return true;
  return seen.version < version_ || seen.mesh < mesh_;
}

std::string ServedScene::json_for(const SeenByPage& seen, std::uint64_t mesh, bool is_whole) const {
  const std::size_t from = seen.version < findings_anew_
                               ? std::size_t{0}
                               : std::min<std::size_t>(seen.findings, findings_.size());
  std::string json = fmt::format(
      R"({{"epoch":{},"version":{},"mesh":{},"is_whole":{},"findings_count":{},"findings_from":{},)"
      R"("findings":[)",
      epoch_, version_, mesh, is_whole, finding_count_, from);
  for (std::size_t i = from; i < findings_.size(); ++i) {
    if (i > from) json += ',';
    json += findings_[i];
  }
  json += ']';
  if (!setup_.empty() && seen.version < setup_version_) json += ',' + setup_;
  if (!state_.empty()) json += ',' + state_;
  json += '}';
  while (json.size() % 4 != 0) json += ' ';
  return json;
}

std::string ServedScene::answer(const SeenByPage& said, bool as_gzip) {
  const std::lock_guard lock(mutex_);
  asked_at_ = Clock::now();
  was_asked_ = true;
  const SeenByPage seen = said.epoch == epoch_ ? said : SeenByPage{};
  const std::size_t most = seen.mesh <= 1 ? kMostFirst : kMostAnswer;
  std::vector<const Tile*> tiles;
  std::uint64_t mesh = std::max(seen.mesh, std::uint64_t{1});
  std::size_t bytes = 0;
  auto next = order_.upper_bound(mesh);
  for (; next != order_.end(); ++next) {
    const Tile& tile = tiles_.at(next->second);
    bytes += as_gzip ? tile.piece.blocks.size() : tile.bytes.size();
    if (!tiles.empty() && bytes > most) break;
    tiles.push_back(&tile);
    mesh = next->first;
  }
  const bool has_all = next == order_.end();
  if (has_all) mesh = mesh_;
  const std::string json = json_for(seen, mesh, has_all && is_whole_);
  std::string out = "KRF1";
  put_length(out, json.size());
  out += json;
  if (!as_gzip) {
    for (const Tile* tile : tiles) out += tile->bytes;
    return out;
  }
  const GzipPiece head = gzip_piece(out);
  std::vector<const GzipPiece*> pieces{&head};
  for (const Tile* tile : tiles) pieces.push_back(&tile->piece);
  return gzip_of(pieces);
}

bool ServedScene::is_watched() const {
  const std::lock_guard lock(mutex_);
  return was_asked_ && Clock::now() - asked_at_ < kWatched;
}

}  // namespace kerf
