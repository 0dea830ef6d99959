// Words that people may have meant.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limpid {

// The candidate nearest to `word` in spelling, or nothing if none resembles it.
std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& among);

// The words that are allowed in place of `word`, for a message: "linear, log; did you mean log?"
std::string allowed_for(std::string_view word, const std::vector<std::string>& words);

}  // namespace limpid
