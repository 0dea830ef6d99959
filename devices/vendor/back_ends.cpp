#include "devices/vendor/back_end.h"

namespace limpid {

std::span<const BackEndEntry> back_ends() {
#define ENTRY(key, name, maker, ...) {#key, maker, {__VA_ARGS__}, make_##key},
  static const std::vector<BackEndEntry> all{LIMPID_VENDORS(ENTRY)};
#undef ENTRY
  return all;
}

}  // namespace limpid
