#include "twin/config/config_tree.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "base/translate.h"
#include "twin/config/live_config.h"

namespace kerf {
namespace {

constexpr std::size_t kLongestExcerpt_bytes = 200;
/// Keys of a group, or elements of a list: each is compared with those before it.
constexpr std::size_t kMostChildren = 2000;

/// Thrown out of the library's parser where going on makes no sense; the fault is reported.
struct Abandoned {};

int line_of(const YAML::Mark& mark) { return std::max(mark.line, 0) + 1; }
int column_of(const YAML::Mark& mark) { return std::max(mark.column, 0) + 1; }

/// Builds the tree from the parser's events. Events, not the library's own nodes: these would
/// multiply aliases and forget duplicate keys.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(const ConfigText& text, ConfigNode& root, Diagnostics& diagnostics)
      : text_(text), root_(root), diagnostics_(diagnostics) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ > 0) abandon(mark, tr("a second document ('---') is not allowed"));
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(mark, anchor, "", NodeKind::kNothing, {});
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    abandon(mark, tr("aliases ('*') are not allowed"), tr("write the value out"));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    if (!text_.quote_ends_at(line_of(mark), column_of(mark))) {
      abandon(mark, tr("this quote does not end in its line"));
    }
    add(mark, anchor, tag, NodeKind::kScalar, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(add(mark, anchor, tag, NodeKind::kList, {}), mark);
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(add(mark, anchor, tag, NodeKind::kMap, {}), mark);
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  struct Open {
    ConfigNode* node;
    bool awaits_value = false;  // of a map: the key has come
    std::string key;
    YAML::Mark key_mark;
  };

  [[noreturn]] void abandon(const YAML::Mark& mark, std::string message, std::string hint = {}) {
    diagnostics_.push_back(
        text_.diagnostic(line_of(mark), column_of(mark), std::move(message), std::move(hint)));
    throw Abandoned{};
  }

  void open(ConfigNode* node, const YAML::Mark& mark) {
    if (open_.size() >= static_cast<std::size_t>(kMaxConfigDepth)) {
      abandon(mark, trf("nested deeper than {} levels", kMaxConfigDepth));
    }
    open_.push_back({node, false, {}, {}});
  }

  ConfigNode* add(const YAML::Mark& mark, YAML::anchor_t anchor, const std::string& tag,
                  NodeKind kind, const std::string& value) {
    if (anchor != 0) abandon(mark, tr("anchors ('&') are not allowed"), tr("write the value out"));
    if (!tag.empty() && tag != "?" && tag != "!") {
      abandon(mark, trf("tags are not allowed; '{}' found", tag));
    }
    if (open_.empty()) return add_root(mark, kind);
    Open& parent = open_.back();
    if (parent.node->kind == NodeKind::kMap && !parent.awaits_value) {
      if (kind != NodeKind::kScalar) {
        abandon(mark, trf("a key is a word; {} found", to_string(kind)));
      }
      parent = {parent.node, true, value, mark};
      return nullptr;
    }
    return attach(parent, mark, kind, value);
  }

  ConfigNode* add_root(const YAML::Mark& mark, NodeKind kind) {
    if (kind != NodeKind::kMap && kind != NodeKind::kNothing) {
      abandon(mark, trf("{} found; a configuration is keys with values ('source: ...')",
                        to_string(kind)));
    }
    return &root_;
  }

  ConfigNode* attach(Open& parent, const YAML::Mark& mark, NodeKind kind,
                     const std::string& value) {
    if (parent.node->children.size() + duplicates_.size() >= kMostChildren) {
      abandon(mark, trf("more than {} keys or elements in one group or list", kMostChildren));
    }
    auto node = std::make_unique<ConfigNode>();
    node->kind = kind;
    node->scalar = value;
    node->line = line_of(mark);
    node->column = column_of(mark);
    if (parent.node->kind == NodeKind::kMap) {
      parent.awaits_value = false;
      node->key = parent.key;
      node->key_line = line_of(parent.key_mark);
      node->key_column = column_of(parent.key_mark);
      node->path = parent.node->path.empty() ? node->key : parent.node->path + "." + node->key;
      if (kind == NodeKind::kNothing) {
        node->line = node->key_line;
        node->column = node->key_column;
      }
    } else {
      node->path = fmt::format("{}[{}]", parent.node->path, parent.node->children.size() + 1);
    }
    ConfigNode* const added = node.get();
    if (const ConfigNode* before = node->key.empty() ? nullptr : parent.node->child(node->key)) {
      diagnostics_.push_back(text_.diagnostic(
          node->key_line, node->key_column,
          trf("{}: given twice; the first is in line {}", node->path, before->key_line)));
      duplicates_.push_back(std::move(node));  // read on below it, but drop it
    } else {
      parent.node->children.push_back(std::move(node));
    }
    return added;
  }

  const ConfigText& text_;
  ConfigNode& root_;
  Diagnostics& diagnostics_;
  int documents_ = 0;
  std::vector<Open> open_;
  std::vector<std::unique_ptr<ConfigNode>> duplicates_;
};

/// The first byte that is not part of well-formed UTF-8, or npos.
std::size_t find_bad_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = byte < 0x80                   ? 1
                               : byte >= 0xC2 && byte < 0xE0 ? 2
                               : byte >= 0xE0 && byte < 0xF0 ? 3
                               : byte >= 0xF0 && byte < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || i + length > text.size()) return i;
    for (std::size_t k = 1; k < length; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0U) != 0x80U) return i;
    }
    i += length;
  }
  return std::string_view::npos;
}

/// Line and column of a byte.
std::pair<int, int> place_of(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  const auto line = std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n') + 1;  // npos + 1 is 0
  return {static_cast<int>(line) + 1, static_cast<int>(at - start) + 1};
}

/// Bytes that no configuration has, and tabs that indent: the library's words for them help
/// nobody.
bool check_bytes(const ConfigText& text, Diagnostics& diagnostics) {
  const std::string& bytes = text.text();
  const auto fault = [&](std::size_t at, std::string message, std::string hint) {
    const auto [line, column] = place_of(bytes, at);
    diagnostics.push_back(text.diagnostic(line, column, std::move(message), std::move(hint)));
  };
  std::size_t bad = bytes.find('\0');
  if (bad != bytes.npos) {
    fault(bad, tr("a zero byte: this is no text file"),
          tr("a configuration is a YAML text in UTF-8"));
    return false;
  }
  bad = find_bad_utf8(bytes);
  if (bad != bytes.npos) {
    fault(bad, trf("byte 0x{:02X} is not UTF-8", static_cast<unsigned char>(bytes[bad])),
          tr("save the file as UTF-8"));
    return false;
  }
  bool good = true;
  for (std::size_t start = 0; start < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', start), bytes.size());
    const std::size_t first = bytes.find_first_not_of(' ', start);
    if (first < end && bytes[first] == '\t') {
      const std::size_t content = bytes.find_first_not_of(" \t\r", first);
      if (content < end && bytes[content] != '#') {
        fault(first, tr("a tab indents this line"), tr("YAML indents with blanks only"));
        good = false;
      }
    }
    start = end + 1;
  }
  return good;
}

/// The library's messages begin with lower case words already; these say more.
std::string plain_words(const std::string& message) {
  if (message.find("illegal map value") != message.npos) {
    return tr(
        "a ':' cannot stand here: a line begins farther right than the one above, or a text "
        "with ': ' in it lacks its quotes");
  }
  if (message.find("end of map not found") != message.npos) {
    return tr("keys of one group must begin in the same column, and each needs a ':' and a blank");
  }
  if (message.find("end of map flow") != message.npos) return trf("{} without {}", "'{'", "'}'");
  if (message.find("end of sequence flow") != message.npos)
    return trf("{} without {}", "'['", "']'");
  return tr("this is no YAML: ") + message;
}

}  // namespace

const char* to_string(NodeKind kind) {
  switch (kind) {
    case NodeKind::kNothing:
      return tr("nothing");
    case NodeKind::kScalar:
      return tr("a single value");
    case NodeKind::kMap:
      return tr("a group of keys");
    case NodeKind::kList:
      return tr("a list");
  }
  return tr("nothing");
}

ConfigNode* ConfigNode::child(std::string_view name) {
  for (const auto& one : children) {
    if (one->key == name) return one.get();
  }
  return nullptr;
}

const ConfigNode* ConfigNode::child(std::string_view name) const {
  for (const auto& one : children) {
    if (one->key == name) return one.get();
  }
  return nullptr;
}

ConfigText::ConfigText(std::string_view text, std::string path) : path_(std::move(path)) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  text_ = text;
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '\n') line_starts_.push_back(i + 1);
  }
}

Diagnostic ConfigText::diagnostic(int line, int column, std::string message,
                                  std::string hint) const {
  Diagnostic diagnostic;
  diagnostic.file = path_;
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  const auto index = static_cast<std::size_t>(std::max(line, 1) - 1);
  if (line < 1 || index >= line_starts_.size()) return diagnostic;
  diagnostic.line = line;
  diagnostic.column = column;
  const std::size_t start = line_starts_[index];
  const std::size_t end = std::min(text_.find('\n', start), text_.size());
  diagnostic.excerpt = text_.substr(start, std::min(end - start, kLongestExcerpt_bytes));
  while (!diagnostic.excerpt.empty() && diagnostic.excerpt.back() == '\r') {
    diagnostic.excerpt.pop_back();
  }
  // A caret beyond the excerpt would point at nothing.
  if (static_cast<std::size_t>(column) > diagnostic.excerpt.size() + 1) diagnostic.excerpt.clear();
  return diagnostic;
}

bool ConfigText::quote_ends_at(int line, int column) const {
  const auto index = static_cast<std::size_t>(line - 1);
  if (line < 1 || index >= line_starts_.size()) return true;
  std::size_t at = line_starts_[index] + static_cast<std::size_t>(std::max(column, 1)) - 1;
  if (at >= text_.size() || (text_[at] != '"' && text_[at] != '\'')) return true;
  const char quote = text_[at];
  for (++at; at < text_.size() && text_[at] != '\n'; ++at) {
    if (quote == '"' && text_[at] == '\\') {
      ++at;
    } else if (text_[at] == quote) {
      if (quote == '"' || at + 1 >= text_.size() || text_[at + 1] != quote) return true;
      ++at;  // '' is one quote within
    }
  }
  return false;
}

std::unique_ptr<ConfigNode> parse_config_tree(const ConfigText& text, Diagnostics& diagnostics) {
  auto root = std::make_unique<ConfigNode>();
  root->kind = NodeKind::kMap;
  if (!check_bytes(text, diagnostics)) return nullptr;
  TreeBuilder builder(text, *root, diagnostics);
  try {
    std::istringstream in(text.text());
    YAML::Parser parser(in);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const Abandoned&) {
    return nullptr;
  } catch (const YAML::Exception& fault) {
    diagnostics.push_back(
        text.diagnostic(line_of(fault.mark), column_of(fault.mark), plain_words(fault.msg)));
    return nullptr;
  }
  return root;
}

void set_in_tree(ConfigNode& root, std::string_view assignment, Diagnostics& diagnostics) {
  const std::size_t equals = assignment.find('=');
  const std::string_view key = assignment.substr(0, equals);
  const auto fault = [&](const std::string& message, std::string hint = {}) {
    Diagnostic diagnostic;
    diagnostic.message = "--set " + message;
    diagnostic.hint = std::move(hint);
    diagnostics.push_back(std::move(diagnostic));
  };
  if (equals == assignment.npos || key.empty() || key.front() == '.' || key.back() == '.' ||
      key.find("..") != key.npos || key.size() > 200) {
    fault(trf("{}: must be KEY=VALUE", assignment.substr(0, 60)),
          tr("as in --set source.poll_hz=100"));
    return;
  }
  if (find_bad_utf8(assignment) != assignment.npos || assignment.find('\0') != assignment.npos) {
    fault(tr("value: not UTF-8"));
    return;
  }
  ConfigNode* node = &root;
  for (std::size_t start = 0; start <= key.size();) {
    const std::size_t end = std::min(key.find('.', start), key.size());
    const std::string_view name = key.substr(start, end - start);
    if (node->kind == NodeKind::kNothing) node->kind = NodeKind::kMap;
    if (node->kind != NodeKind::kMap) {
      fault(trf("{}: {} is {} here, so there is no {} below it", key, node->path,
                to_string(node->kind), name));
      return;
    }
    ConfigNode* next = node->child(name);
    if (next == nullptr) {
      auto added = std::make_unique<ConfigNode>();
      added->key = name;
      added->path = key.substr(0, end);
      added->from_set = true;
      next = node->children.emplace_back(std::move(added)).get();
    }
    node = next;
    start = end + 1;
  }
  if (node->kind == NodeKind::kMap || node->kind == NodeKind::kList) {
    fault(trf("{}: {} in the file; only a single value can be set", key, to_string(node->kind)));
    return;
  }
  node->kind = NodeKind::kScalar;
  node->scalar = assignment.substr(equals + 1);
  node->line = node->column = 0;
  node->from_set = true;
}

}  // namespace kerf
