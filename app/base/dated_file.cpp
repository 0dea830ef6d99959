#include "app/base/dated_file.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <string>

namespace limpid {

std::filesystem::path dated_file(const std::filesystem::path& folder, std::string_view name,
                                 std::string_view extension) {
  const std::string dated =
      fmt::format("{}-{:%Y%m%d-%H%M%S}", name, fmt::localtime(std::time(nullptr)));
  const std::string dot = extension.empty() ? "" : ".";
  std::filesystem::path file = folder / fmt::format("{}{}{}", dated, dot, extension);
  std::error_code unknown;
  for (int number = 2; std::filesystem::exists(file, unknown); ++number) {
    file = folder / fmt::format("{}-{}{}{}", dated, number, dot, extension);
  }
  return file;
}

}  // namespace limpid
