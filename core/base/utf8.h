// Decoding of texts whose files do not say, or say wrongly, how they are encoded.
#pragma once

#include <string>
#include <string_view>

namespace limpid {

// Returns the text as UTF-8, without a byte order mark. A byte order mark, or zeros around a
// leading '<', mean UTF-16; other text that is not UTF-8 counts as Latin-1. Invalid characters
// become U+FFFD. The declaration of an XML text then says UTF-8.
std::string utf8_of(std::string_view bytes);

}  // namespace limpid
