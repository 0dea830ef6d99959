#include "app/run/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "app/base/markup.h"
#include "app/base/version.h"
#include "app/run/run_key.h"
#include "devices/files/config_file.h"

namespace limpid {

std::string settings_digest(const std::set<std::string>& configs) {
  Digest digest;
  for (const std::string& config : configs) digest.add(config);
  return fmt::format("{:016x}", digest.value()).substr(0, 8);
}

std::string settings_digest(const Parameters& p) {
  return settings_digest(std::set<std::string>{config_text(p)});
}

std::string today() {
  std::time_t seconds = std::time(nullptr);
  if (const char* set = std::getenv("SOURCE_DATE_EPOCH"); set != nullptr) {
    std::from_chars(set, set + std::strlen(set), seconds);
  }
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(seconds));
}

namespace {

std::string line_of(const std::string& version, const std::string& settings,
                    std::optional<std::uint64_t> seed, const std::string& date) {
  std::string line = "limpid " + version;
  if (!settings.empty()) line += ", settings " + settings;
  if (seed) line += fmt::format(", seed {}", *seed);
  if (!date.empty()) line += ", " + date;
  return line;
}

}  // namespace

std::string provenance(const std::string& settings, std::optional<std::uint64_t> seed,
                       const std::string& date) {
  return line_of(program_version(), settings, seed, date);
}

std::string provenance_of(const SessionInfo& info) {
  return line_of(info.app_version, settings_digest(std::set<std::string>{info.config}), info.seed,
                 info.created.substr(0, std::string_view("2026-11-26").size()));
}

std::string with_metadata(const std::string& svg, const std::string& line) {
  const std::size_t root = svg.find("<svg");
  const std::size_t end = root == std::string::npos ? root : svg.find('>', root);
  if (line.empty() || end == std::string::npos) return svg;
  return svg.substr(0, end + 1) + "\n<metadata>" + escaped(line) + "</metadata>" +
         svg.substr(end + 1);
}

}  // namespace limpid
