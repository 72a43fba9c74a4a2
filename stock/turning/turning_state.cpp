#include "stock/turning/turning_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/state_bytes.h"

namespace kerf::turning {
namespace {

constexpr std::int64_t kLayoutOfParts = 1;
constexpr std::string_view kPartTag = "PART";
constexpr std::uint32_t kPartVersion = 1;
constexpr std::string_view kThreadTag = "THRD";
constexpr std::uint32_t kThreadVersion = 1;
constexpr std::string_view kFreedTag = "FREE";
constexpr std::uint32_t kFreedVersion = 1;
constexpr std::size_t kFreedBytes = 3 * sizeof(std::uint64_t);  // of each piece, at least
/// From z r, to z r, lead, turns, low and high r.
constexpr std::size_t kThreadNumbers = 8;
constexpr std::size_t kThreadBytes =
    sizeof(std::uint64_t) + kThreadNumbers * sizeof(double) + sizeof(std::uint32_t);
/// Volumes are sums of doubles.
constexpr double kVolumeSlack = 1e-9;

struct PartHead {
  std::int64_t layout = 0, chuck = 0;
  std::int64_t blank[4] = {};
  double blank_mm3 = 0;
  double flats[2] = {};

  bool is_known() const { return layout == kLayoutOfParts; }
  Rect rect() const { return {blank[0], blank[1], blank[2], blank[3]}; }
};

bool is_sane(const PartHead& h) {
  const Unit most_z = to_units(kMaxTurnedZ_mm), most_r = to_units(kMaxTurnedRadius_mm);
  const Rect r = h.rect();
  if (r.min_x < -most_z || r.max_x > most_z || r.min_y < 0 || r.max_y > most_r) return false;
  if (r.min_x >= r.max_x || r.min_y >= r.max_y) return false;
  const double most_mm3 = kPi * to_mm(r.max_x - r.min_x) *
                          (to_mm(r.max_y) * to_mm(r.max_y) - to_mm(r.min_y) * to_mm(r.min_y));
  if (!(h.blank_mm3 > 0) || h.blank_mm3 > most_mm3 * (1 + kVolumeSlack)) return false;
  const bool is_round = h.flats[0] == 0 && h.flats[1] == 0;
  const bool is_bar =
      (h.flats[0] == 4 || h.flats[0] == 6) && h.flats[1] > 0 && h.flats[1] <= kMaxTurnedRadius_mm;
  return (h.chuck == 0 || h.chuck == 1) && (is_round || is_bar);
}

bool read_part_head(StateHead& reader, PartHead& h) {
  if (!reader.numbers("layout", &h.layout, 1)) return false;
  if (!h.is_known()) return h.layout > 0;  // what follows is not known either
  return reader.numbers("chuck", &h.chuck, 1) && reader.numbers("blank", h.blank, 4) &&
         reader.numbers("blank_mm3", &h.blank_mm3, 1) && reader.numbers("flats", h.flats, 2) &&
         reader.line("data") && is_sane(h);
}

/// Takes numbers off the front of bytes.
class PartBytes {
 public:
  explicit PartBytes(std::string_view bytes) : bytes_(bytes) {}
  bool is_at_end() const { return bytes_.empty(); }

  bool take(void* out, std::size_t bytes) {
    if (bytes_.size() < bytes) return false;
    std::memcpy(out, bytes_.data(), bytes);
    bytes_.remove_prefix(bytes);
    return true;
  }
  std::optional<std::string_view> take(std::uint64_t bytes) {
    if (bytes_.size() < bytes) return std::nullopt;
    const std::string_view taken = bytes_.substr(0, bytes);
    bytes_.remove_prefix(bytes);
    return taken;
  }
  /// How many that take so much each may follow; false if there are fewer than it says.
  bool take_count(std::uint32_t& count, std::size_t bytes_each) {
    return take(&count, sizeof count) && count <= bytes_.size() / bytes_each;
  }

 private:
  std::string_view bytes_;
};

bool read_contour(PartBytes& bytes, const Rect& blank, ContourBuilder& builder, Contour& contour) {
  std::uint32_t count = 0;
  if (!bytes.take_count(count, 2 * sizeof(std::int32_t)) || count < 3) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::int32_t zr[2];
    if (!bytes.take(zr, sizeof zr)) return false;
    const Point p{zr[0], zr[1]};
    if (!blank.holds(p)) return false;
    builder.append(p);
  }
  contour = builder.close();
  return contour.corner_count() == count && contour.area2() != 0;
}

bool read_contours(std::string_view section, const Rect& blank, std::vector<Contour>& contours) {
  PartBytes bytes(section);
  std::uint32_t count = 0;
  if (!bytes.take_count(count, sizeof count)) return false;
  ContourBuilder builder;
  for (std::uint32_t i = 0; i < count; ++i) {
    Contour contour;
    if (!read_contour(bytes, blank, builder, contour)) return false;
    if (contour.is_outer() != (i == 0)) return false;
    contours.push_back(std::move(contour));
    const Rect &outer = contours[0].box(), &box = contours.back().box();
    if (!outer.holds({box.min_x, box.min_y}) || !outer.holds({box.max_x, box.max_y})) return false;
  }
  return bytes.is_at_end();
}

void put_section(StateWriter& file, std::string_view tag, std::uint32_t version,
                 const std::string& bytes) {
  const std::uint64_t size = bytes.size();
  file.put(tag.data(), tag.size());
  file.put(&version, sizeof version);
  file.put(&size, sizeof size);
  file.put(bytes.data(), bytes.size());
}

template <class Number>
void append_number(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

bool read_threads(std::string_view section,
                  std::vector<std::shared_ptr<const ThreadPass>>& threads) {
  PartBytes bytes(section);
  std::uint32_t count = 0;
  if (!bytes.take_count(count, kThreadBytes) || count == 0) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint64_t id = 0;
    double n[kThreadNumbers];
    std::uint32_t corner_count = 0;
    if (!bytes.take(&id, sizeof id) || !bytes.take(n, sizeof n) ||
        !bytes.take_count(corner_count, 2 * sizeof(double)))
      return false;
    ConvexChain corners;
    for (std::uint32_t k = 0; k < corner_count; ++k) {
      double zr[2];
      if (!bytes.take(zr, sizeof zr)) return false;
      corners.emplace_back(zr[0], zr[1]);
    }
    std::optional<ThreadPass> pass = ThreadPass::restored(std::move(corners), {n[0], n[1]},
                                                          {n[2], n[3]}, n[4], n[5], n[6], n[7], id);
    if (!pass) return false;
    threads.push_back(std::make_shared<const ThreadPass>(std::move(*pass)));
  }
  return bytes.is_at_end();
}

std::string thread_bytes(const std::vector<std::shared_ptr<const ThreadPass>>& threads) {
  std::string bytes;
  append_number(bytes, static_cast<std::uint32_t>(threads.size()));
  for (const auto& pass : threads) {
    append_number(bytes, pass->id());
    for (const double number :
         {pass->from_mm().x, pass->from_mm().y, pass->to_mm().x, pass->to_mm().y, pass->lead_mm(),
          pass->from_turns(), pass->low_r_mm(), pass->high_r_mm()})
      append_number(bytes, number);
    append_number(bytes, static_cast<std::uint32_t>(pass->corners().size()));
    for (const Vec2& p : pass->corners()) {
      append_number(bytes, p.x);
      append_number(bytes, p.y);
    }
  }
  return bytes;
}

std::string contour_bytes(const std::vector<Contour>& contours) {
  std::string bytes;
  append_number(bytes, static_cast<std::uint32_t>(contours.size()));
  const auto append = [&bytes](const Contour& contour) {
    const Ring ring = contour.ring();
    append_number(bytes, static_cast<std::uint32_t>(ring.size()));
    for (const Point& p : ring) {
      append_number(bytes, static_cast<std::int32_t>(p.X));
      append_number(bytes, static_cast<std::int32_t>(p.Y));
    }
  };
  for (const bool outer : {true, false}) {
    for (const Contour& contour : contours) {
      if (contour.is_outer() == outer) append(contour);
    }
  }
  return bytes;
}

std::string freed_bytes(const std::vector<SavedPiece>& pieces) {
  std::string bytes;
  append_number(bytes, static_cast<std::uint32_t>(pieces.size()));
  for (const SavedPiece& piece : pieces) {
    append_number(bytes, piece.freed_by);
    for (const std::string& part :
         {contour_bytes(piece.contours),
          piece.threads.empty() ? std::string() : thread_bytes(piece.threads)}) {
      append_number(bytes, static_cast<std::uint64_t>(part.size()));
      bytes += part;
    }
  }
  return bytes;
}

bool read_freed(std::string_view section, const Rect& blank, std::vector<SavedPiece>& pieces) {
  PartBytes bytes(section);
  std::uint32_t count = 0;
  if (!bytes.take_count(count, kFreedBytes) || count == 0) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    SavedPiece& piece = pieces.emplace_back();
    if (!bytes.take(&piece.freed_by, sizeof piece.freed_by)) return false;
    std::string_view parts[2];
    for (std::string_view& part : parts) {
      std::uint64_t size = 0;
      if (!bytes.take(&size, sizeof size)) return false;
      const std::optional<std::string_view> taken = bytes.take(size);
      if (!taken) return false;
      part = *taken;
    }
    if (!read_contours(parts[0], blank, piece.contours) || piece.contours.empty()) return false;
    if (!parts[1].empty() && !read_threads(parts[1], piece.threads)) return false;
  }
  return bytes.is_at_end();
}

/// None if a part of it is less than nothing.
std::optional<double> volume_of(const std::vector<Contour>& contours,
                                const std::optional<BarFlats>& flats) {
  double volume_mm3 = 0;
  for (const Contour& contour : contours) {
    volume_mm3 += turning::volume_mm3(contour.moment6());
    if (flats) volume_mm3 -= missing_mm3(contour, *flats);
  }
  if (!(volume_mm3 >= 0)) return std::nullopt;
  return volume_mm3;
}

/// With all that has come off no more than the blank had.
bool is_of_its_blank(const SavedPart& saved) {
  std::optional<double> sum_mm3 = volume_of(saved.contours, saved.flats);
  for (const SavedPiece& piece : saved.pieces) {
    const std::optional<double> volume_mm3 = volume_of(piece.contours, saved.flats);
    if (!volume_mm3 || !sum_mm3) return false;
    *sum_mm3 += *volume_mm3;
  }
  return sum_mm3 && *sum_mm3 <= saved.blank_mm3 * (1 + kVolumeSlack) + kVolumeSlack;
}

void put_part(StateWriter& file, const SavedPart& saved) {
  const Rect& b = saved.blank;
  const BarFlats flats = saved.flats.value_or(BarFlats{});
  const std::string head = fmt::format(
      "{}model turning\nlayout {}\nchuck {}\nblank {} {} {} {}\nblank_mm3 {}\nflats {} {}\n"
      "data\n",
      kStateMagic, kLayoutOfParts, saved.chuck == ChuckSide::kHighZ ? 1 : 0, b.min_x, b.min_y,
      b.max_x, b.max_y, saved.blank_mm3, flats.count, flats.inner_radius_mm);
  file.put(head.data(), head.size());
  put_section(file, kPartTag, kPartVersion, contour_bytes(saved.contours));
  if (!saved.threads.empty())
    put_section(file, kThreadTag, kThreadVersion, thread_bytes(saved.threads));
  if (!saved.pieces.empty()) put_section(file, kFreedTag, kFreedVersion, freed_bytes(saved.pieces));
}

}  // namespace

Done write_part(const std::string& path, const SavedPart& saved) {
  Result<StateWriter> file = StateWriter::create(path);
  if (!file) return Error{file.error()};
  put_part(*file, saved);
  return file->commit();
}

std::string bytes_of_part(const SavedPart& saved) {
  std::string bytes;
  StateWriter writer = StateWriter::into(bytes);
  put_part(writer, saved);
  (void)writer.commit();  // memory takes it all
  return bytes;
}

Result<SavedPart> parse_part(const std::string& bytes, const std::string& name) {
  PartHead head;
  const Result<StateHead> reader = head_of_state(
      bytes, name, "turning", [&head](StateHead& lines) { return read_part_head(lines, head); });
  if (!reader) return Error{reader.error()};
  if (!head.is_known()) {
    return Error{trf("{}: a turned part of layout {}; layout {} can be read", name, head.layout,
                     kLayoutOfParts)};
  }
  const Result<std::string_view> data = data_of_state(*reader, name);
  if (!data) return Error{data.error()};
  const std::string damaged = trf("{}: the contours are damaged", name);
  SavedPart saved;
  saved.chuck = head.chuck == 1 ? ChuckSide::kHighZ : ChuckSide::kLowZ;
  saved.blank = head.rect();
  saved.blank_mm3 = head.blank_mm3;
  if (head.flats[0] != 0) saved.flats = BarFlats{static_cast<int>(head.flats[0]), head.flats[1]};
  bool has_part = false;
  for (PartBytes rest(*data); !rest.is_at_end();) {
    char tag[4] = {};
    std::uint32_t version = 0;
    std::uint64_t size = 0;
    if (!rest.take(tag, sizeof tag) || !rest.take(&version, sizeof version) ||
        !rest.take(&size, sizeof size))
      return Error{damaged};
    const std::optional<std::string_view> section = rest.take(size);
    if (!section) return Error{damaged};
    if (std::string_view(tag, sizeof tag) == kThreadTag && version == kThreadVersion) {
      if (!saved.threads.empty() || !read_threads(*section, saved.threads)) {
        return Error{trf("{}: the threads are damaged", name)};
      }
      continue;
    }
    if (std::string_view(tag, sizeof tag) == kFreedTag && version == kFreedVersion) {
      if (!saved.pieces.empty() || !read_freed(*section, saved.blank, saved.pieces)) {
        return Error{trf("{}: the pieces that have come off are damaged", name)};
      }
      continue;
    }
    if (std::string_view(tag, sizeof tag) != kPartTag || version != kPartVersion) {
      return Error{trf("{}: has a section '{}' of version {}, which this kerf cannot read", name,
                       shown(std::string_view(tag, sizeof tag)), version)};
    }
    if (has_part || !read_contours(*section, saved.blank, saved.contours)) return Error{damaged};
    has_part = true;
  }
  if (!has_part) return Error{damaged};
  if (!is_of_its_blank(saved)) return Error{damaged};
  return saved;
}

}  // namespace kerf::turning

namespace kerf {

turning::SavedPart TurnedPart::saved() const {
  const auto passes_of = [](const TurnedPart& part) {
    return std::vector(part.threads_.passes().begin(), part.threads_.passes().end());
  };
  turning::SavedPart saved{chuck_, blank_, blank_mm3_, flats_, contours_, passes_of(*this), {}};
  for (const TurnedPiece& piece : freed_) {
    if (piece.part)
      saved.pieces.push_back({piece.freed_by, piece.part->contours_, passes_of(*piece.part)});
  }
  return saved;
}

TurnedPart TurnedPart::restored(turning::SavedPart saved) {
  TurnedPart part;
  part.contours_ = std::move(saved.contours);
  part.blank_ = saved.blank;
  part.blank_mm3_ = saved.blank_mm3;
  part.chuck_ = saved.chuck;
  part.flats_ = saved.flats;
  part.threads_.restore(std::move(saved.threads), part.contours_);
  part.touch_all();
  for (turning::SavedPiece& piece : saved.pieces) {
    const turning::Rect box = piece.contours.front().box();
    auto off = std::make_shared<const TurnedPart>(restored({saved.chuck,
                                                            saved.blank,
                                                            saved.blank_mm3,
                                                            saved.flats,
                                                            std::move(piece.contours),
                                                            std::move(piece.threads),
                                                            {}}));
    part.freed_.push_back({piece.freed_by, off->remaining_mm3(), turning::to_mm(box.min_x),
                           turning::to_mm(box.max_x), turning::to_mm(box.min_y),
                           turning::to_mm(box.max_y), off});
  }
  return part;
}

std::optional<TurnedPart> TurnedPart::placed(double at_z_mm, bool turned_about) const {
  if (!(std::abs(at_z_mm) <= 2 * kMaxTurnedZ_mm)) return std::nullopt;
  const turning::Unit at = turning::to_units(at_z_mm), most = turning::to_units(kMaxTurnedZ_mm);
  turning::SavedPart lies = saved();
  lies.pieces.clear();  // they stay where they have fallen
  lies.blank.min_x = at + (turned_about ? -blank_.max_x : blank_.min_x);
  lies.blank.max_x = at + (turned_about ? -blank_.min_x : blank_.max_x);
  if (lies.blank.min_x < -most || lies.blank.max_x > most) return std::nullopt;
  turning::ContourBuilder builder;
  for (turning::Contour& contour : lies.contours) {
    turning::Ring ring = contour.ring();
    if (turned_about) std::reverse(ring.begin(), ring.end());
    for (const turning::Point& p : ring) builder.append({at + (turned_about ? -p.X : p.X), p.Y});
    contour = builder.close();
  }
  for (auto& pass : lies.threads) {
    pass = std::make_shared<const turning::ThreadPass>(turned_about ? pass->turned_about(at_z_mm)
                                                                    : pass->moved(at_z_mm));
  }
  return restored(std::move(lies));
}

std::optional<TurnedPart> TurnedPart::turned_about(double at_z_mm) const {
  return placed(at_z_mm, true);
}

std::optional<TurnedPart> TurnedPart::moved(double at_z_mm) const { return placed(at_z_mm, false); }

}  // namespace kerf
