// Tables of a report, as they are read.
#pragma once

#include <string>
#include <vector>

namespace limpid::test {

// Words of each cell of all rows of a page's tables, without tags.
inline std::vector<std::vector<std::string>> cells_of_page(const std::string& html) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t at = html.find("<tr>"); at != std::string::npos; at = html.find("<tr>", at)) {
    const std::size_t end = html.find("</tr>", at);
    rows.emplace_back();
    for (std::size_t tag = html.find('<', at + 1); tag < end; tag = html.find('<', tag + 1)) {
      if (html[tag + 1] != 't') continue;  // of <td> and <th>
      const std::size_t from = html.find('>', tag) + 1;
      std::string words = html.substr(from, html.find("</t", from) - from);
      for (std::size_t a = words.find('<'); a != std::string::npos; a = words.find('<')) {
        words.erase(a, words.find('>', a) + 1 - a);
      }
      rows.back().push_back(words);
    }
    at = end;
  }
  return rows;
}

}  // namespace limpid::test
