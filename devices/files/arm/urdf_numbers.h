// Numbers in the attributes of a URDF.
#pragma once

#include <Eigen/Core>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

namespace limpid {

template <int N>
using Numbers = Eigen::Matrix<double, N, 1>;

// N finite numbers with spaces between, and nothing else; nothing where it is anything else. Null
// is an empty text.
template <int N>
std::optional<Numbers<N>> numbers_in(const char* text) {
  Numbers<N> out;
  const char* at = text == nullptr ? "" : text;
  const char* const end = at + std::strlen(at);
  const auto skip = [&] {
    while (at != end && std::isspace(static_cast<unsigned char>(*at))) ++at;
  };
  for (double& x : out) {
    skip();
    if (at != end && *at == '+') ++at;
    const auto read = std::from_chars(at, end, x);
    if (read.ec != std::errc() || !std::isfinite(x)) return std::nullopt;
    at = read.ptr;
  }
  skip();
  return at == end ? std::optional(out) : std::nullopt;
}

}  // namespace limpid
