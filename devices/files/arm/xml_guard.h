// A look through an XML text before it is parsed: TinyXML recurses for each element inside of
// another one, and compares each attribute with all others of its element.
#pragma once

#include <string>

namespace limpid {

inline constexpr std::size_t kLongestXml = 16 << 20;  // [bytes]

// Errors: FileError naming `where` for texts that are too long, nested too deep, or have too many
// attributes in an element, as TinyXML reads them.
void check_xml(const std::string& text, const std::string& where);

}  // namespace limpid
