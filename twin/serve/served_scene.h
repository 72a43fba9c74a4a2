// twin/serve/served_scene.h - what pages get to see: the newest of everything, once for all of
// them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "twin/serve/gzip_pieces.h"

namespace kerf {

/// What a page has got already, by the numbers that came with it.
struct SeenByPage {
  std::uint64_t epoch = 0;     ///< 0: nothing yet
  std::uint64_t version = 0;   ///< of the state
  std::uint64_t mesh = 0;      ///< of the patches
  std::uint64_t findings = 0;  ///< so many
};

/// Keeps each tile's newest patch and the order in which they have changed. A page says what it has
/// and gets what is newer: nothing is kept of a page, however many there are, and one that is slow
/// gets less often what is newest then, never a queue of what was. Any thread.
class ServedScene {
 public:
  using Clock = std::chrono::steady_clock;
  /// Bytes of patches in one answer, compressed. Pages ask ten times a second, so that each gets
  /// less than a megabyte a second of what changes.
  static constexpr std::size_t kMostAnswer = 90'000;
  /// In the first answer to a page.
  static constexpr std::size_t kMostFirst = 400'000;
  /// Findings that are told one by one; of more their number alone.
  static constexpr std::size_t kMostFindings = 300;

  ServedScene();

  /// Another workpiece, or another session: pages begin anew.
  void begin_anew();
  /// Another workpiece of the same session: its findings stay.
  void begin_part_anew();
  /// JSON members that every answer has, as "\"state\":\"live\",..": without braces.
  void set_state(std::string members);
  /// Members that only who has not had them gets: what stays through an epoch.
  void set_setup(std::string members);
  /// A finding as a JSON object.
  void add_finding(std::string json);
  /// All of them instead, of which `total` are more: where they begin as those before, pages get
  /// what is new alone, else all anew.
  void set_findings(std::vector<std::string> all, std::uint64_t total);
  /// A packed() patch; compressed here, in the caller's thread.
  void set_patch(std::uint32_t tile, std::string bytes);
  /// Whether all tiles of the workpiece have been set; begin_anew() says no.
  void set_whole(bool is_whole);
  /// After a change, once for all that belong together: who waits is answered.
  void publish();

  /// Something is newer than what the page has.
  bool has_news(const SeenByPage& seen) const;
  /// "KRF1", u32 length of the JSON, the JSON, 0 to 3 spaces of it so that the length is a multiple
  /// of 4; then patches (packed_patch.h). The JSON: epoch, version, mesh, findings_count, is_whole
  /// (of the patches: no more are missing), findings (those that the page has not) and
  /// findings_from (what it has of them from here on counts no more), the setup if it is new to it,
  /// and the state. `as_gzip`: compressed (Content-Encoding: gzip).
  std::string answer(const SeenByPage& seen, bool as_gzip);

  /// A page has asked within the last kWatched: else nobody need make patches.
  bool is_watched() const;
  static constexpr std::chrono::seconds kWatched{5};

  /// Called at each publish(), in its thread; brief.
  void set_listener(std::function<void()> listener);

 private:
  mutable std::mutex mutex_;
  std::uint64_t epoch_;
  std::uint64_t version_ = 1;
  std::uint64_t mesh_ = 1;  ///< of the newest patch
  std::string state_, setup_;
  std::uint64_t setup_version_ = 0;
  std::vector<std::string> findings_;
  std::uint64_t finding_count_ = 0;
  std::uint64_t findings_anew_ = 0;  ///< the version since which they begin as they do
  struct Tile {
    std::uint64_t number = 0;
    std::string bytes;
    GzipPiece piece;
  };
  std::string json_for(const SeenByPage& seen, std::uint64_t mesh, bool is_whole) const;
  std::unordered_map<std::uint32_t, Tile> tiles_;
  std::map<std::uint64_t, std::uint32_t> order_;  ///< tiles by when they changed
  bool is_whole_ = false;
  Clock::time_point asked_at_;
  bool was_asked_ = false;
  std::mutex listener_mutex_;
  std::function<void()> listener_;
};

}  // namespace kerf
