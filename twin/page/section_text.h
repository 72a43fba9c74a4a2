// twin/page/section_text.h - a section of a page: tables, facts, texts.
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/length_unit.h"
#include "twin/report/finding_lists.h"
#include "twin/report/shown_lengths.h"

namespace kerf {

struct PageColumn {
  const char* heading;
  bool has_numbers = false;
};

/// A section of its own, with cells whose lengths are in the reader's unit.
class SectionText {
 public:
  SectionText(std::string heading, LengthUnit units) : units_(units) {
    html_ = fmt::format("<section><h2>{}</h2>\n", xml_text(heading));
  }

  void paragraph(std::string_view text) {
    html_ += fmt::format("<p>{}</p>\n", shown(text));
    is_empty_ = false;
  }
  void pre(std::string_view text) {
    html_ += fmt::format("<pre>{}</pre>\n", shown(text));
    is_empty_ = false;
  }
  void table(const std::vector<PageColumn>& columns) {
    html_ += "<table><thead><tr>";
    numbers_.clear();
    for (const PageColumn& column : columns) {
      numbers_.push_back(column.has_numbers);
      html_ += fmt::format("<th{}>{}</th>", column.has_numbers ? " class=\"n\"" : "",
                           xml_text(column.heading));
    }
    html_ += "</tr></thead><tbody>\n";
  }
  void row(const std::vector<std::string>& cells) { add_row(cells, {}); }
  /// With one cell more at the end, of HTML.
  void row(const std::vector<std::string>& cells, std::string_view html) {
    add_row(cells, fmt::format("<td class=\"n\">{}</td>", html));
  }
  void end_table() { html_ += "</tbody></table>\n"; }
  void facts(std::span<const std::pair<std::string, std::string>> facts) {
    html_ += "<dl class=\"facts\">\n";
    for (const auto& [name, value] : facts)
      html_ += fmt::format("<dt>{}</dt><dd>{}</dd>\n", xml_text(name), shown(value));
    html_ += "</dl>\n";
    is_empty_ = is_empty_ && facts.empty();
  }
  void raw(std::string_view html) {
    html_ += html;
    is_empty_ = is_empty_ && html.empty();
  }

  std::string done() && { return is_empty_ ? std::string() : std::move(html_) + "</section>\n"; }

 private:
  void add_row(const std::vector<std::string>& cells, std::string_view last) {
    html_ += "<tr>";
    std::size_t column = 0;
    for (const std::string& cell : cells) {
      const bool is_number = column < numbers_.size() && numbers_[column++];
      html_ += fmt::format("<td{}>{}</td>", is_number ? " class=\"n\"" : "", shown(cell));
    }
    html_ += fmt::format("{}</tr>\n", last);
    is_empty_ = false;
  }
  std::string shown(std::string_view text) const { return xml_text(in_unit(text, units_)); }

  LengthUnit units_;
  std::string html_;
  std::vector<bool> numbers_;
  bool is_empty_ = true;
};

}  // namespace kerf
