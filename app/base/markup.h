// Text inside HTML and SVG.
#pragma once

#include <string>

namespace limpid {

// Returns `text` with the characters replaced that markup would take for its own.
inline std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

}  // namespace limpid
