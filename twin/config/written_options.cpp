#include "twin/config/written_options.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace kerf {
namespace {

[[maybe_unused]] const Setting* any_setting_of(std::string_view option) {
  const std::span<const Setting> table = setting_table();
  const auto row = std::find_if(table.begin(), table.end(),
                                [&](const Setting& one) { return one.option == option; });
  return row == table.end() ? nullptr : &*row;
}

}  // namespace

const WrittenOptions::Slot* WrittenOptions::find(std::string_view option) const {
  const auto at = slots_.find(option);
  return at == slots_.end() ? nullptr : &at->second;
}

bool WrittenOptions::has(std::string_view option) const {
  const Slot* const slot = find(option);
  return slot != nullptr && (slot->is_set || !slot->text.empty() || !slot->list.empty());
}

const std::string& WrittenOptions::text(std::string_view option) const {
  static const std::string kNone;
  const Slot* const slot = find(option);
  if (slot == nullptr) return kNone;
  return slot->list.empty() ? slot->text : slot->list.front();
}

const std::vector<std::string>& WrittenOptions::texts(std::string_view option) const {
  static const std::vector<std::string> kNone;
  const Slot* const slot = find(option);
  return slot == nullptr ? kNone : slot->list;
}

WrittenOptions::Slot& WrittenOptions::slot(std::string_view option) {
  const auto at = slots_.find(option);
  if (at != slots_.end()) return at->second;
  assert(any_setting_of(option) != nullptr && "an option that the table does not have");
  return slots_[std::string(option)];
}

void WrittenOptions::set(std::string_view option, std::string text) {
  Slot& one = slot(option);
  one.list.clear();
  one.text = std::move(text);
}

void WrittenOptions::set_all(std::string_view option, std::vector<std::string> texts) {
  slot(option).list = std::move(texts);
}

void WrittenOptions::add(std::string_view option, std::string text) {
  slot(option).list.push_back(std::move(text));
}

void WrittenOptions::set_flag(std::string_view option) { slot(option).is_set = true; }

void WrittenOptions::clear(std::string_view option) { slot(option) = Slot{}; }

}  // namespace kerf
