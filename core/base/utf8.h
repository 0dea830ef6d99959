// Text in UTF-8: decoding of texts whose files do not say, or say wrongly, how they are encoded,
// and counting.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace limpid {

// Returns the text as UTF-8, without a byte order mark. A byte order mark, or zeros around a
// leading '<', mean UTF-16; other text that is not UTF-8 counts as Latin-1. Invalid characters
// become U+FFFD. The declaration of an XML text then says UTF-8.
std::string utf8_of(std::string_view bytes);

// Returns the number of characters of UTF-8, not of its bytes.
std::size_t count_characters(std::string_view text);

}  // namespace limpid
