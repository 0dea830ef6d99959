// Texts of files that do not say, or say wrongly, how they are encoded.
#pragma once

#include <string>
#include <string_view>

namespace limpid {

// The same text as UTF-8, without a byte order mark. A byte order mark says that a text is UTF-16,
// as do zeros around a leading '<'; what is no UTF-8 either is taken for Latin-1. What is no
// character becomes U+FFFD, and the declaration of an XML text says UTF-8 where it was another one.
std::string utf8_of(std::string_view bytes);

}  // namespace limpid
