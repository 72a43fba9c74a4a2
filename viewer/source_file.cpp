#include "viewer/source_file.h"

#include <zlib.h>

#include <array>
#include <cassert>
#include <istream>
#include <utility>

namespace kerf {
namespace {

constexpr int kLevel = 1;  // 6 saves a seventh more and takes three times as long

/// Empty: it does not get smaller.
std::string packed(std::string_view text) {
  std::string data(compressBound(static_cast<uLong>(text.size())), '\0');
  uLongf size = static_cast<uLongf>(data.size());
  const int status = compress2(reinterpret_cast<Bytef*>(data.data()), &size,
                               reinterpret_cast<const Bytef*>(text.data()),
                               static_cast<uLong>(text.size()), kLevel);
  if (status != Z_OK || size >= text.size()) return {};
  // Not resized in place: what was reserved for the worst case would stay.
  return std::string(data.data(), size);
}

}  // namespace

SourceFile::SourceFile(std::string path, std::string_view text) : path_(std::move(path)) {
  add(text);
  finish();
}

SourceFile::SourceFile(std::string path, std::istream& text) : path_(std::move(path)) {
  std::array<char, 1 << 16> part;
  while (text) {
    text.read(part.data(), static_cast<std::streamsize>(part.size()));
    add({part.data(), static_cast<std::size_t>(text.gcount())});
  }
  finish();
}

void SourceFile::add(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::size_t size = end == std::string_view::npos ? text.size() : end + 1;
    open_ += text.substr(0, size);
    text.remove_prefix(size);
    if (end != std::string_view::npos && ++line_count_ % kBlockLines == 0) close_block();
  }
}

void SourceFile::close_block() {
  Block& block = blocks_.emplace_back();
  if (open_.size() <= kMostPacked) block.data = packed(open_);
  if (block.data.empty()) {
    block.data = open_;
  } else {
    block.text_size = open_.size();
  }
  open_.clear();
}

void SourceFile::finish() {
  if (!open_.empty()) {
    if (open_.back() != '\n') ++line_count_;
    close_block();
  }
  std::string().swap(open_);
  blocks_.shrink_to_fit();
}

std::string SourceFile::line(int number) const {
  return std::string(SourceLines(*this).line(number));
}

std::size_t SourceFile::bytes() const {
  std::size_t sum = sizeof *this + blocks_.capacity() * sizeof(Block);
  for (const Block& block : blocks_) sum += block.data.capacity();
  return sum;
}

void SourceLines::unpack(std::size_t block) {
  const SourceFile::Block& from = file_.blocks_[block];
  block_ = block;
  text_ = from.data;
  if (from.text_size > 0) {
    unpacked_.resize(from.text_size);
    uLongf size = static_cast<uLongf>(unpacked_.size());
    [[maybe_unused]] const int status = uncompress(
        reinterpret_cast<Bytef*>(unpacked_.data()), &size,
        reinterpret_cast<const Bytef*>(from.data.data()), static_cast<uLong>(from.data.size()));
    assert(status == Z_OK && size == from.text_size);
    text_ = unpacked_;
  }
  starts_.clear();
  for (std::size_t start = 0; start < text_.size();) {
    starts_.push_back(start);
    const std::size_t end = text_.find('\n', start);
    if (end == std::string_view::npos) break;
    start = end + 1;
  }
}

std::string_view SourceLines::line(int number) {
  if (number < 1 || number > file_.line_count()) return {};
  const auto index = static_cast<std::size_t>(number - 1);
  const std::size_t block = index / SourceFile::kBlockLines;
  if (starts_.empty() || block != block_) unpack(block);
  const std::size_t within = index % SourceFile::kBlockLines;
  const std::size_t end = within + 1 < starts_.size() ? starts_[within + 1] : text_.size();
  std::string_view text = text_.substr(starts_[within], end - starts_[within]);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

}  // namespace kerf
